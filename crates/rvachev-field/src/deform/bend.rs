//! Bend of the z axis to a circle.
//!
//! ```text
//!     r = along u = (cos α, sin α) of (x, y), γ = κ z
//!     inverse: R = u·(X, Y),  h = √((1 − κR)² + (κZ)²),  γ = atan2(κZ, 1 − κR)
//!              r = (2R − κ(R² + Z²))/(1 + h),  z = γ/κ
//! ```
//!
//! Sources: A. H. Barr, *Global and local deformations of solid primitives* (1984);
//! F. Solina and R. Bajcsy (1990), with their bend put right for κ < 0, |γ| > π/2 and κ → 0.

use glam::DVec3;

use super::Warp;
use crate::{Angle, Bounds, Euclid, Interval, Real};
use crate::{ParamError, check};

/// Bend of the z axis to a circle, in the plane of z and (cos angle, sin angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Curvature of the bent axis, per length unit.
    pub curvature: f64,
    /// Direction towards the centre of curvature, from the x axis towards y.
    pub angle: Angle,
}

impl Bend {
    /// Below this curvature a bend moves nothing that could be seen.
    const FLAT: f64 = 1e-30;
}

impl Warp for Bend {
    const NAME: &'static str = "bend";

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let k = self.curvature;
        if k.abs() < Bend::FLAT {
            return [x, y, z];
        }
        let (sin, cos) = self.angle.radians().sin_cos();
        let big_r = x.scale_add(cos, y * sin);
        let opposite = z * k;
        let adjacent = big_r.scale_add(-k, z.lift(1.0));
        let h = adjacent.norm_as(opposite, Euclid);
        let bow = big_r.mul_add(big_r, z.square());
        let r = (big_r * 2.0 - bow * k) / (h + 1.0);
        let shift = r - big_r;
        [shift.scale_add(cos, x), shift.scale_add(sin, y), opposite.atan2(adjacent) * (1.0 / k)]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let k = self.curvature;
        let (sin, cos) = self.angle.radians().sin_cos();
        let r = p.x * cos + p.y * sin;
        let gamma = k * p.z;
        let shift = (1.0 - k * r) * p.z * (0.5 * gamma).sin() * sinc(0.5 * gamma);
        DVec3::new(p.x + cos * shift, p.y + sin * shift, (1.0 - k * r) * p.z * sinc(gamma))
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        if !b.is_finite() {
            return Bounds::ALL;
        }
        let k = self.curvature;
        let (sin, cos) = self.angle.radians().sin_cos();
        let (x, y) = (Interval::new(b.min.x, b.max.x), Interval::new(b.min.y, b.max.y));
        let r = x * cos + y * sin;
        let across = (y * cos - x * sin).inflate(0.0);
        // Slices of z keep the dependence of sine and cosine on z small.
        const SLICES: u32 = 64;
        let mut bounds = Bounds::EMPTY;
        for slice in 0..SLICES {
            let at = |i: u32| b.min.z + (b.max.z - b.min.z) * f64::from(i) / f64::from(SLICES);
            let z = Interval::new(at(slice), at(slice + 1)).inflate(1e-12 * b.max.z.abs());
            let left = (-r * k) + 1.0;
            let half_turn = z * (0.5 * k);
            let big_r = r + left * z * half_turn.sin_cos().0 * sinc_range(half_turn);
            let big_z = left * z * sinc_range(z * k);
            let x = big_r * cos - across * sin;
            let y = big_r * sin + across * cos;
            bounds = bounds
                .union(&Bounds::new(DVec3::new(x.lo(), y.lo(), big_z.lo()), DVec3::new(x.hi(), y.hi(), big_z.hi())));
        }
        bounds
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        check::finite("curvature", self.curvature)?;
        check::angle("angle", self.angle, -1e9, 1e9)?;
        if self.curvature.abs() < Bend::FLAT {
            return Ok(());
        }
        // Conservative: the box of the solid, rather than the solid, must stay on this side
        // of the centre of curvature and within half a turn.
        let (sin, cos) = self.angle.radians().sin_cos();
        let inward = self.curvature.signum() * DVec3::new(cos, sin, 0.0);
        let reach = b.corners().into_iter().map(|c| c.dot(inward)).fold(f64::NEG_INFINITY, f64::max);
        let reach = if reach.is_nan() { f64::INFINITY } else { reach };
        let height = b.min.z.abs().max(b.max.z.abs());
        let by_reach = if reach > 0.0 { 1.0 / reach } else { f64::INFINITY };
        let limit = by_reach.min(std::f64::consts::PI / height);
        if self.curvature.abs() < limit {
            return Ok(());
        }
        Err(ParamError::new(
            "curvature",
            self.curvature,
            format_args!(
                "below {limit:.6} in absolute value: the box of the bent solid reaches {reach:.6} towards the \
                 centre of curvature (1/curvature must be beyond) and {height:.6} along z (a half turn at most)"
            ),
        ))
    }

    fn roundoff(&self, reach: f64) -> f64 {
        1e-6 * reach * (1.0 + (self.curvature * reach).abs())
    }
}

/// Range of `sin(x)/x`, which falls from 1 at 0 to 0 at ±π.
fn sinc_range(x: Interval) -> Interval {
    let a = x.abs();
    let lo = if a.hi() < std::f64::consts::PI { sinc(a.hi()) } else { -0.25 };
    let hi = if a.lo() < std::f64::consts::PI { sinc(a.lo()) } else { 0.25 };
    Interval::new(lo, hi).inflate(1e-15)
}

/// `sin(x)/x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}
