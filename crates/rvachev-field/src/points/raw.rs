//! Points by angles: method 1, scalar and on SIMD lanes.

use super::explicit::over_slices;
use super::{PointError, check_exponent};
use crate::kernel::Formula;
use crate::power::signed_power;
use crate::{Angle, Real};

/// Points of a superellipsoid of unit size by their angles (method 1): four sines and cosines,
/// four signed powers.
///
/// ```text
/// (cos^e₁ η·cos^e₂ ω, cos^e₁ η·sin^e₂ ω, sin^e₁ η)        exact zeros at quarter turns
/// ```
///
/// Exact but for rounding, and the slowest of the six. At equal angles the points of a squarish
/// shape (e below 0.5) crowd at its edges.
///
/// ```
/// use rvachev::points::RawParametric;
/// use rvachev::rad;
///
/// let [x, y, z] = RawParametric::new(0.5, 0.5)?.point(rad(0.3), rad(0.4));
/// assert!((x.powi(4) + y.powi(4) + z.powi(4) - 1.0).abs() < 1e-15);
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawParametric {
    e1: f64,
    e2: f64,
}

impl RawParametric {
    /// Points for the exponents e1 of the meridians and e2 of the horizontal sections, each
    /// 0.0002 to 10.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(e1: f64, e2: f64) -> Result<RawParametric, PointError> {
        check_exponent(2.0 / e1)?;
        check_exponent(2.0 / e2)?;
        Ok(RawParametric { e1, e2 })
    }

    /// The point at the latitude η and the longitude ω.
    #[must_use]
    pub fn point(&self, eta: impl Into<Angle>, omega: impl Into<Angle>) -> [f64; 3] {
        let ((sin_h, cos_h), (sin_w, cos_w)) = (eta.into().sin_cos(), omega.into().sin_cos());
        let across = signed_power(cos_h, self.e1);
        let power = |w| signed_power(w, self.e2);
        [across * power(cos_w), across * power(sin_w), signed_power(sin_h, self.e1)]
    }

    /// x, y and z of many points of the first octant, on SIMD lanes of `f32`: angles in radians,
    /// from 0 to π/2. To 3·10⁻⁶ where both exponents are 0.5 or more; a small exponent magnifies
    /// the rounding of angles near quarter turns.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn octant_single(&self, eta: &[f32], omega: &[f32], out: [&mut [f32]; 3]) {
        over_slices(self, [eta, omega], out);
    }
}

impl Formula<2, 3> for RawParametric {
    #[inline(always)]
    fn run<R: Real>(&self, [eta, omega]: [R; 2]) -> [R; 3] {
        let ((sin_h, cos_h), (sin_w, cos_w)) = (eta.sin_cos(), omega.sin_cos());
        let across = cos_h.pow(self.e1);
        [across * cos_w.pow(self.e2), across * sin_w.pow(self.e2), sin_h.pow(self.e1)]
    }
}
