//! Elongation: a straight piece inserted at each coordinate plane.
//!
//! ```text
//!     x ↦ x − clamp(x, −h, h) = max(x − h, 0) + min(x + h, 0)        h half the length
//!
//!         ___          ______
//!        /   \   →    /      \      each half moves outward by h, what lies in the
//!        \___/        \______/      plane x = 0 is drawn out between them
//! ```
//!
//! The inverse map moves no two points apart, so values stay 1-Lipschitz.

use glam::DVec3;

use super::Warp;
use crate::{Bounds, Real};
use crate::{ParamError, check};

/// Lengths of the pieces to insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elongate {
    /// What is inserted along each axis, in length units.
    pub lengths: DVec3,
}

impl Elongate {
    #[inline(always)]
    fn half(&self) -> DVec3 {
        0.5 * self.lengths
    }
}

#[inline(always)]
fn closed<R: Real>(x: R, half: f64) -> R {
    // At 0 both terms would have the slope of x.
    if half == 0.0 {
        return x;
    }
    let zero = x.lift(0.0);
    (x - half).max(zero) + (x + half).min(zero)
}

impl Warp for Elongate {
    const NAME: &'static str = "elongate";

    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let half = self.half();
        [closed(x, half.x), closed(y, half.y), closed(z, half.z)]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        p + DVec3::select(p.cmpge(DVec3::ZERO), self.half(), -self.half())
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        // A plane at 0 is drawn out to both sides.
        let min = b.min + DVec3::select(b.min.cmpgt(DVec3::ZERO), self.half(), -self.half());
        let max = b.max + DVec3::select(b.max.cmplt(DVec3::ZERO), -self.half(), self.half());
        Bounds::new(min, max)
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        own(direction) + direction.abs().dot(self.half())
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        for (axis, length) in ["x", "y", "z"].into_iter().zip(self.lengths.to_array()) {
            check::within(&format!("lengths.{axis}"), length, 0.0, 1e9)?;
        }
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        2e-7 * reach
    }
}
