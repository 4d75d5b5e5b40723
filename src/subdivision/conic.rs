//! Conics and graphs as control polygons.
//!
//! ```text
//!     ellipse     m points at R·β/sin β of a regular polygon, β = 2π/m
//!     hyperbola   β/sinh β·(a·cosh kβ, b·sinh kβ)                          α₀ = cosh β
//!     parabola    (k, k² − 1/3)                                            α₀ = 1
//!     graphs      (kβ, β/sin β·cos kβ)                                     β = π/2
//! ```
//!
//! By the limit stencil their points are exact at every level; without it the error falls
//! by 4 a level.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec2;
use rvachev_num::order;

use super::{ControlPolygon, SubdivisionError, Tension, check_coordinates};
use crate::{Angle, rad, turns};

pub(super) fn length(parameter: &'static str, value: f64) -> Result<(), SubdivisionError> {
    if (1e-9..=1e9).contains(&value) {
        Ok(())
    } else {
        Err(SubdivisionError::Parameter { parameter, value, allowed: "0.000000001 to 1000000000" })
    }
}

impl ControlPolygon<DVec2> {
    /// The ellipse inscribed in the rectangle `2a × 2b`, from the diamond of its sides' middles.
    ///
    /// # Errors
    /// A semi-axis out of its range.
    pub fn ellipse(semi_axes: impl Into<DVec2>) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        ControlPolygon::ellipse_of(4, semi_axes)
    }

    /// The same ellipse from a polygon of `sides` control points, 3 to 1000, the first on the x
    /// axis.
    ///
    /// # Errors
    /// A semi-axis or the number of points out of its range.
    pub fn ellipse_of(sides: u32, semi_axes: impl Into<DVec2>) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        let semi_axes = semi_axes.into();
        length("semi_axes.x", semi_axes.x)?;
        length("semi_axes.y", semi_axes.y)?;
        if !(3..=1000).contains(&sides) {
            return Err(SubdivisionError::Parameter {
                parameter: "sides",
                value: f64::from(sides),
                allowed: "3 to 1000",
            });
        }
        let step = TAU / f64::from(sides);
        let tension = Tension::trigonometric(rad(step))?;
        let grown = step / step.sin();
        let points: Vec<DVec2> = (0..sides)
            .map(|k| {
                let (sin, cos) = turns(f64::from(k) / f64::from(sides)).sin_cos();
                semi_axes * DVec2::new(cos, sin) * grown
            })
            .collect();
        ControlPolygon::closed(&points, tension)
    }

    /// The branch of the hyperbola `x²/a² − y²/b² = 1` at x > 0, for |y| up to `reach`, with
    /// `segments` control intervals on each half, 1 to 1000.
    ///
    /// # Errors
    /// A length or the number of segments out of its range; a reach of more than 10⁶·b.
    pub fn hyperbola(
        semi_axes: impl Into<DVec2>,
        reach: f64,
        segments: u32,
    ) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        let semi_axes = semi_axes.into();
        length("semi_axes.x", semi_axes.x)?;
        length("semi_axes.y", semi_axes.y)?;
        let end = reach / semi_axes.y;
        if !(end > 1e-6 && end <= 1e6) {
            let allowed = "0.000001 to 1000000 times semi_axes.y";
            return Err(SubdivisionError::Parameter { parameter: "reach", value: reach, allowed });
        }
        check_segments(segments)?;
        let step = end.asinh() / f64::from(segments);
        let tension = Tension::hyperbolic(step)?;
        let grown = step / step.sinh();
        let last = segments as i32 + 1;
        let at = |k: i32| {
            let angle = step * f64::from(k);
            semi_axes * DVec2::new(angle.cosh(), angle.sinh()) * grown
        };
        ControlPolygon::open(&(-last..=last).map(at).collect::<Vec<_>>(), tension)
    }

    /// The parabola `y = x²/(4f)` with focal length f, for |x| up to `reach`, with `segments`
    /// control intervals on each half, 1 to 1000.
    ///
    /// # Errors
    /// A length or the number of segments out of its range.
    pub fn parabola(focal_length: f64, reach: f64, segments: u32) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        length("focal_length", focal_length)?;
        length("reach", reach)?;
        check_segments(segments)?;
        let step = reach / f64::from(segments);
        let last = segments as i32 + 1;
        let at = |k: i32| {
            let k = f64::from(k);
            DVec2::new(k * step, (k * k - 1.0 / 3.0) * step * step / (4.0 * focal_length))
        };
        ControlPolygon::open(&(-last..=last).map(at).collect::<Vec<_>>(), Tension::CUBIC)
    }

    /// The graph of the cosine from 0 to `quarters`·π/2, 1 to 1000 quarters.
    ///
    /// # Errors
    /// A number of quarters out of its range.
    pub fn cosine_graph(quarters: u32) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        graph(quarters, 0.0)
    }

    /// The graph of the sine from 0 to `quarters`·π/2, 1 to 1000 quarters.
    ///
    /// # Errors
    /// A number of quarters out of its range.
    pub fn sine_graph(quarters: u32) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
        graph(quarters, -FRAC_PI_2)
    }
}

fn check_segments(segments: u32) -> Result<(), SubdivisionError> {
    if (1..=1000).contains(&segments) {
        return Ok(());
    }
    let value = f64::from(segments);
    Err(SubdivisionError::Parameter { parameter: "segments", value, allowed: "1 to 1000" })
}

/// The graph of `cos(x + phase)`.
fn graph(quarters: u32, phase: f64) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
    if !(1..=1000).contains(&quarters) {
        let value = f64::from(quarters);
        return Err(SubdivisionError::Parameter { parameter: "quarters", value, allowed: "1 to 1000" });
    }
    let points: Vec<DVec2> = (-1..=quarters as i32 + 1)
        .map(|k| {
            let x = FRAC_PI_2 * f64::from(k);
            DVec2::new(x, FRAC_PI_2 * rad(x + phase).sin_cos().1)
        })
        .collect();
    ControlPolygon::open(&points, Tension::trigonometric(Angle::QUARTER_TURN)?)
}

/// The points of an ellipse `(a cos θ, b sin θ)` with |θ| < π/2 moved to the hyperbola
/// `x²/a² − y²/b² = 1`: `(a sec θ, b tan θ) = (a²/x, a·y/x)`. Points on the y axis and beyond (x up
/// to 10⁻⁹·a) are left out; the result runs from below to above.
///
/// Right only for points of the limit curve: raw points of level 5 end up 1.4·10⁻² off.
///
/// ```
/// use glam::DVec2;
/// use rvachev::subdivision::{ControlPolygon, hyperbola_of_ellipse};
///
/// let ellipse = ControlPolygon::ellipse(DVec2::new(2.0, 1.0))?;
/// for p in hyperbola_of_ellipse(&ellipse.limit(4)?, 2.0)? {
///     let (x, y) = (p.x / 2.0, p.y);
///     assert!((x * x - y * y - 1.0).abs() < 1e-12 * x * x);
/// }
/// # Ok::<(), rvachev::subdivision::SubdivisionError>(())
/// ```
///
/// # Errors
/// [`SubdivisionError::Parameter`] for a semi-axis a out of its range,
/// [`SubdivisionError::Coordinate`] for a point that is not finite or beyond 10¹².
pub fn hyperbola_of_ellipse(points: &[DVec2], a: f64) -> Result<Vec<DVec2>, SubdivisionError> {
    length("a", a)?;
    check_coordinates(points.iter().map(DVec2::to_array))?;
    let right = points.iter().filter(|p| p.x > 1e-9 * a);
    let mut moved: Vec<DVec2> = right.map(|p| DVec2::new(a * a / p.x, a * p.y / p.x)).collect();
    order::rising(&mut moved, |p| p.y);
    Ok(moved)
}
