//! Quadrics by longitude and latitude polygons.
//!
//! ```text
//!     ellipsoid         profile  diamond of (a₁, a₃)-circle·π/2    path  ellipse (1, a₂/a₁)
//!     one sheet         the same arc, moved by (r, h) → (a₁²/r, a₁h/r)
//!     two sheets        the same arc, moved by (r, h) → (a₃r/h, a₃²/h)
//!     elliptic torus    profile  ring + π/2·tube                   path  ellipse (1, κ)
//!     elliptic cylinder profile  a straight line                   path  ellipse (a₁, a₂)
//! ```
//!
//! The moves take points of the limit curve: raw points of a level would end up off the quadric.
//!
//! Source: G. Wei, J. Feng, F. Chen; their final equation of the one-sheet hyperboloid has a
//! factor of π/2 too much, and the ring of a torus takes the factor π/2 once only.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::conic::length;
use super::{ControlPolygon, ProfileEnd, SubdivisionError, SubdivisionRevolution, Tension};
use crate::{Angle, rad};

/// What a profile's points are moved by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ProfileMap {
    None,
    /// `(a²/r, a·h/r)`: secant and tangent.
    Secant(f64),
    /// `(c·r/h, c²/h)`: tangent and secant.
    Tangent(f64),
}

impl ProfileMap {
    /// Moves points, and tangents with them.
    pub(super) fn apply(self, points: &mut [DVec2], mut tangents: Option<&mut [DVec2]>) {
        for (i, point) in points.iter_mut().enumerate() {
            let DVec2 { x: r, y: h } = *point;
            let moved = |t: DVec2| match self {
                ProfileMap::None => t,
                ProfileMap::Secant(a) => DVec2::new(-a * a * t.x, a * (t.y * r - h * t.x)) / (r * r),
                ProfileMap::Tangent(c) => DVec2::new(c * (t.x * h - r * t.y), -c * c * t.y) / (h * h),
            };
            if let Some(tangents) = &mut tangents {
                tangents[i] = moved(tangents[i]);
            }
            *point = match self {
                ProfileMap::None => *point,
                ProfileMap::Secant(a) => DVec2::new(a * a, a * h) / r,
                ProfileMap::Tangent(c) => DVec2::new(c * r, c * c) / h,
            };
        }
    }
}

/// An arc of the ellipse `(a·cos θ, c·sin θ)`, θ from `first`·step to `last`·step, with what
/// steers its ends.
fn arc(a: f64, c: f64, step: f64, first: i32, last: i32) -> Result<ControlPolygon<DVec2>, SubdivisionError> {
    let grown = step / step.sin();
    let at = |k: i32| {
        let (sin, cos) = rad(step * f64::from(k)).sin_cos();
        DVec2::new(a * cos, c * sin) * grown
    };
    ControlPolygon::open(&(first - 1..=last + 1).map(at).collect::<Vec<_>>(), Tension::trigonometric(rad(step))?)
}

fn lengths(semi_axes: DVec3) -> Result<(), SubdivisionError> {
    length("semi_axes.x", semi_axes.x)?;
    length("semi_axes.y", semi_axes.y)?;
    length("semi_axes.z", semi_axes.z)
}

/// The length of a hyperboloid, at least and at most so many times its semi-axis.
const SHORTEST: f64 = 1e-6;
const LONGEST: f64 = 2000.0;

fn check_length(value: f64, above: f64, semi_axis: f64) -> Result<(), SubdivisionError> {
    if value > above * semi_axis && value >= SHORTEST * semi_axis && value <= LONGEST * semi_axis {
        return Ok(());
    }
    let allowed =
        if above > 0.0 { "above twice semi_axes.z, up to 2000 times it" } else { "0.000001 to 2000 times semi_axes.z" };
    Err(SubdivisionError::Parameter { parameter: "length", value, allowed })
}

impl SubdivisionRevolution {
    /// The ellipsoid inscribed in a box of twice these semi-axes; its cage is the octahedron of
    /// the box's face centres, grown.
    ///
    /// # Errors
    /// A semi-axis out of its range.
    pub fn ellipsoid(semi_axes: impl Into<DVec3>) -> Result<SubdivisionRevolution, SubdivisionError> {
        let a = semi_axes.into();
        lengths(a)?;
        let profile = arc(a.x, a.z, FRAC_PI_2, -1, 1)?;
        let path = ControlPolygon::ellipse(DVec2::new(1.0, a.y / a.x))?;
        Ok(SubdivisionRevolution::new(profile, path)?.with_ends(ProfileEnd::Pole, ProfileEnd::Pole))
    }

    /// The hyperboloid of one sheet `x²/a₁² + y²/a₂² − z²/a₃² = 1` for |z| up to `length/2`, by
    /// the secant and tangent of an ellipsoid's meridian; flat at its ends.
    ///
    /// # Errors
    /// A semi-axis out of its range, a length below 10⁻⁶ or above 2000 semi-axes.
    pub fn one_sheet(semi_axes: impl Into<DVec3>, length: f64) -> Result<SubdivisionRevolution, SubdivisionError> {
        let a = semi_axes.into();
        lengths(a)?;
        check_length(length, 0.0, a.z)?;
        let profile = arc(a.x, a.z, (0.5 * length / a.z).atan(), -1, 1)?;
        let path = ControlPolygon::ellipse(DVec2::new(1.0, a.y / a.x))?;
        let revolution = SubdivisionRevolution::new(profile, path)?.with_ends(ProfileEnd::Flat, ProfileEnd::Flat);
        Ok(revolution.mapped(ProfileMap::Secant(a.x), false))
    }

    /// The hyperboloid of two sheets `z²/a₃² − x²/a₁² − y²/a₂² = 1` for |z| up to `length/2`,
    /// both bowls, flat at their ends.
    ///
    /// # Errors
    /// A semi-axis out of its range, a length of two semi-axes or less or of more than 2000.
    pub fn two_sheets(semi_axes: impl Into<DVec3>, length: f64) -> Result<SubdivisionRevolution, SubdivisionError> {
        let a = semi_axes.into();
        lengths(a)?;
        check_length(length, 2.0, a.z)?;
        // From the apex at θ = 0 of (a₁ sin θ, a₃ cos θ).
        let turned = arc(a.z, a.x, 0.5 * (2.0 * a.z / length).acos(), 0, 2)?;
        let points: Vec<DVec2> = turned.points().iter().map(|p| DVec2::new(p.y, p.x)).collect();
        let profile = ControlPolygon::open(&points, turned.tension())?;
        let path = ControlPolygon::ellipse(DVec2::new(1.0, a.y / a.x))?;
        let revolution = SubdivisionRevolution::new(profile, path)?.with_ends(ProfileEnd::Pole, ProfileEnd::Flat);
        Ok(revolution.mapped(ProfileMap::Tangent(a.z), true))
    }

    /// The elliptic torus: a tube of semi-axes `tube` (across and along z) whose core is the
    /// ellipse of semi-axes `ring` and `ratio·ring`. Equals the supertoroid of exponents 1 with
    /// semi-axes `(tube.x, ratio·tube.x, tube.y)` and ring `ring/tube.x`.
    ///
    /// # Errors
    /// A length out of its range, a ring below `tube.x`, a ratio outside 10⁻³ to 10³.
    pub fn elliptic_torus(
        tube: impl Into<DVec2>,
        ring: f64,
        ratio: f64,
    ) -> Result<SubdivisionRevolution, SubdivisionError> {
        let tube = tube.into();
        length("tube.x", tube.x)?;
        length("tube.y", tube.y)?;
        length("ring", ring)?;
        if ring < tube.x {
            return Err(SubdivisionError::Parameter { parameter: "ring", value: ring, allowed: "tube.x or more" });
        }
        if !(1e-3..=1e3).contains(&ratio) {
            return Err(SubdivisionError::Parameter { parameter: "ratio", value: ratio, allowed: "0.001 to 1000" });
        }
        let section = ControlPolygon::ellipse(tube)?;
        let points: Vec<DVec2> = section.points().iter().map(|p| *p + DVec2::new(ring, 0.0)).collect();
        let profile = ControlPolygon::closed(&points, section.tension())?;
        SubdivisionRevolution::new(profile, ControlPolygon::ellipse(DVec2::new(1.0, ratio))?)
    }

    /// The cylinder on the ellipse with these semi-axes, `height` along z, flat at its ends.
    /// Straight lines need no levels: 0 along the profile will do.
    ///
    /// # Errors
    /// A length out of its range.
    pub fn elliptic_cylinder(
        semi_axes: impl Into<DVec2>,
        height: f64,
    ) -> Result<SubdivisionRevolution, SubdivisionError> {
        length("height", height)?;
        let half_height = 0.5 * height;
        let path = ControlPolygon::ellipse(semi_axes)?;
        let ends = [DVec2::new(1.0, -half_height), DVec2::new(1.0, half_height)];
        let profile = ControlPolygon::clamped(&ends, Tension::trigonometric(Angle::QUARTER_TURN)?)?;
        Ok(SubdivisionRevolution::new(profile, path)?.with_ends(ProfileEnd::Flat, ProfileEnd::Flat))
    }
}
