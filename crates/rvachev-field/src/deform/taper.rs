//! Linear taper along z.
//!
//! ```text
//!     t = clamp(2z/h, −1, 1),  s = 1 + K t     X = s_x x, Y = s_y y, Z = z
//! ```
//!
//! Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).

use glam::DVec3;

use super::Warp;
use crate::{Bounds, Real};
use crate::{ParamError, check};

/// Linear taper along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// How much wider x is at the top, and narrower at the bottom.
    pub kx: f64,
    /// The same for y.
    pub ky: f64,
    /// From where t is −1 to where it is 1.
    pub height: f64,
}

impl Warp for Taper {
    const NAME: &'static str = "taper";

    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let one = z.lift(1.0);
        let t = (z * (2.0 / self.height)).min(one).max(-one);
        [x / t.scale_add(self.kx, one), y / t.scale_add(self.ky, one), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let t = (2.0 * p.z / self.height).clamp(-1.0, 1.0);
        DVec3::new(p.x * (1.0 + self.kx * t), p.y * (1.0 + self.ky * t), p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        // Linear in t for fixed (x, y): extremes are at the ends of t's range.
        let t = [b.min.z, b.max.z].map(|z| (2.0 * z / self.height).clamp(-1.0, 1.0));
        let mut out = Bounds::new(DVec3::INFINITY, DVec3::NEG_INFINITY);
        for t in t {
            let s = DVec3::new(1.0 + self.kx * t, 1.0 + self.ky * t, 1.0);
            out = out.union(&Bounds::new(b.min * s, b.max * s));
        }
        out
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        // The direction as the sections see it is linear in t, the support function convex.
        let t = [-own(-DVec3::Z), own(DVec3::Z)].map(|z| (2.0 * z / self.height).clamp(-1.0, 1.0));
        let along = |t: f64| own(direction * DVec3::new(1.0 + self.kx * t, 1.0 + self.ky * t, 1.0));
        along(t[0]).max(along(t[1]))
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        check::length("height", self.height)?;
        for (name, k) in [("kx", self.kx), ("ky", self.ky)] {
            if k.is_nan() || k.abs() > 0.999 {
                return Err(ParamError::new(
                    name,
                    k,
                    "-0.999 to 0.999 (beyond, the section shrinks to a point or turns inside out)",
                ));
            }
        }
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let stretch = 1.0 / (1.0 - self.kx.abs().max(self.ky.abs()));
        5e-7 * reach * stretch
    }
}
