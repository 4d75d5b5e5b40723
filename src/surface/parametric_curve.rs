//! Parametric curves of the plane: superellipses, Gielis curves, conics.

use glam::DVec2;

use super::curve::{By, Curve, Local};
use crate::{Field, Gielis, ParamError, Radius, Superellipse, Superpolygon};
use rvachev_field::check;

/// A curve of the plane by a parameter t, with its exact normal.
///
/// | curve | point | t |
/// |---|---|---|
/// | [`of`](ParametricCurve::of) a superellipse | `(a·cos^e t, b·sin^e t)`, signed powers | −π to π |
/// | [`gielis`](ParametricCurve::gielis) | `r(t)·(cos t, sin t)` | −π to π |
/// | [`ellipse`](ParametricCurve::ellipse) | `(a·cos t, b·sin t)` | −π to π |
/// | [`hyperbola`](ParametricCurve::hyperbola) | `(a·sec t, b·tan t)` | between its ends |
/// | [`parabola`](ParametricCurve::parabola) | `(2f·t, f·t²)` | between its ends |
///
/// The parameter is a plain number, as a parabola's is no angle; where t is an angle it is in
/// radians. Quarter turns are exact, whatever the exponents.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use glam::DVec2;
/// use rvachev::surface::ParametricCurve;
/// use rvachev::Superellipse;
///
/// let curve = ParametricCurve::of(&Superellipse::new([2.0, 1.0], 0.1))?;
/// assert_eq!(curve.point(FRAC_PI_2), DVec2::Y);
/// assert_eq!(curve.normal(FRAC_PI_2), DVec2::Y);
/// let bow = ParametricCurve::hyperbola([2.0, 1.0], 3.0)?;
/// let p = bow.point(0.7);
/// assert!(((p.x / 2.0).powi(2) - p.y.powi(2) - 1.0).abs() < 1e-15);
/// # Ok::<(), rvachev::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParametricCurve {
    curve: Curve,
    scale: DVec2,
}

impl ParametricCurve {
    /// The curve of a superellipse, by its angle.
    ///
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn of(superellipse: &Superellipse) -> Result<ParametricCurve, ParamError> {
        superellipse.check()?;
        let curve = Curve::Superellipse { e: superellipse.exponent(), ring: 0.0 };
        Ok(ParametricCurve { curve, scale: superellipse.semi_axes() })
    }

    /// A Gielis curve by its polar angle, of unit size; of several turns that which counts.
    ///
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn gielis(curve: &Gielis, radius: Radius) -> Result<ParametricCurve, ParamError> {
        Superpolygon::new(*curve, 1.0).check()?;
        if radius == Radius::Rational {
            for (parameter, value) in [("curve.a", curve.a), ("curve.b", curve.b)] {
                if value != 1.0 {
                    return Err(ParamError::new(parameter, value, "1 for the rational radius"));
                }
            }
        }
        Ok(ParametricCurve { curve: Curve::gielis(*curve, radius), scale: DVec2::ONE })
    }

    /// The ellipse with these semi-axes.
    ///
    /// # Errors
    /// A semi-axis out of its range.
    pub fn ellipse(semi_axes: impl Into<DVec2>) -> Result<ParametricCurve, ParamError> {
        ParametricCurve::of(&Superellipse::new(semi_axes, 1.0))
    }

    /// The branch of the hyperbola `x²/a² − y²/b² = 1` at x > 0, for |y| up to `reach`.
    ///
    /// # Errors
    /// A length out of its range.
    pub fn hyperbola(semi_axes: impl Into<DVec2>, reach: f64) -> Result<ParametricCurve, ParamError> {
        let scale = semi_axes.into();
        check::length("semi_axes.x", scale.x)?;
        check::length("semi_axes.y", scale.y)?;
        check::length("reach", reach)?;
        Ok(ParametricCurve { curve: Curve::Hyperbola { e: 1.0, end: reach / scale.y }, scale })
    }

    /// The parabola `y = x²/(4f)` with focal length f, for |x| up to `reach`.
    ///
    /// # Errors
    /// A length out of its range.
    pub fn parabola(focal_length: f64, reach: f64) -> Result<ParametricCurve, ParamError> {
        check::length("focal_length", focal_length)?;
        check::length("reach", reach)?;
        let size = 2.0 * focal_length;
        Ok(ParametricCurve { curve: Curve::Parabola { end: reach / size }, scale: DVec2::splat(size) })
    }

    /// First and last parameter.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        self.curve.range(By::Angle)
    }

    /// Whether the ends meet.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        matches!(self.curve, Curve::Superellipse { .. } | Curve::Gielis { .. })
    }

    /// The point at t, in length units.
    #[must_use]
    pub fn point(&self, t: f64) -> DVec2 {
        // No negative zeros.
        self.curve.at(t, By::Angle).point * self.scale + DVec2::ZERO
    }

    /// The exact unit normal at t, on the right of the direction of rising t: outwards on closed
    /// curves. In a corner that of the symmetric bisector.
    #[must_use]
    pub fn normal(&self, t: f64) -> DVec2 {
        let Local { normal, .. } = self.curve.at(t, By::Angle);
        (normal / self.scale).normalize() + DVec2::ZERO
    }

    /// The unit tangent at t, in the direction of rising t.
    #[must_use]
    pub fn tangent(&self, t: f64) -> DVec2 {
        self.normal(t).perp()
    }
}
