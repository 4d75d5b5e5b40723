//! Revolution about the z axis: the half-plane x ≥ 0 of a profile, carried round.
//!
//! ```text
//!     (X, Y, Z)  →  x = √(X² + Y²),  y = Z
//! ```
//!
//! Distances stay what they are.

use glam::DVec3;

use super::super::ParamError;
use super::super::deform::Warp;
use crate::{Bounds, Euclid, Real};

/// The map from space to the half-plane of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution;

impl Warp for Revolution {
    const NAME: &'static str = "revolve";
    const SWEEPS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        [x.norm_as(y, Euclid), z, z.lift(0.0)]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, 0.0, p.y)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        if b.max.x < 0.0 {
            return Bounds::EMPTY;
        }
        Bounds::new(DVec3::new(-b.max.x, -b.max.x, b.min.y), DVec3::new(b.max.x, b.max.x, b.max.y))
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        own(DVec3::new(direction.truncate().length(), direction.z, 0.0))
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        5e-7 * reach
    }
}
