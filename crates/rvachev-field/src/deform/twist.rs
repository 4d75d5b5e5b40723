//! Twist about z in proportion to z.
//!
//! ```text
//!     φ = ω z      rotation by φ about z
//! ```
//!
//! Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).

use glam::DVec3;

use super::{Warp, turned_box, turned_support};
use crate::{Angle, Bounds, Interval, Real};
use crate::{ParamError, check};

/// Rotation about z in proportion to z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Angle per length unit.
    pub rate: Angle,
}

impl Warp for Twist {
    const NAME: &'static str = "twist";

    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let (sin, cos) = (z * self.rate.radians()).sin_cos();
        [x.mul_add(cos, y * sin), y.mul_add(cos, -(x * sin)), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let (sin, cos) = (p.z * self.rate.radians()).sin_cos();
        DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        turned_box(b, Interval::new(b.min.z, b.max.z) * self.rate.radians())
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        turned_support(own, direction)
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        check::angle("rate", self.rate, -1e9, 1e9)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // The angle is rounded relative to itself; beyond some thousand radians the lanes'
        // argument reduction adds its part.
        5e-7 * reach * (1.0 + (self.rate.radians() * reach).abs())
    }
}
