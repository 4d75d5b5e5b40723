//! Twist about z by a user's law of z.
//!
//! ```text
//!     φ = angle · law(z)      rotation by φ about z
//! ```

use glam::DVec3;

use super::law::{Law, check_law, law_range, slices};
use super::{Warp, turned_box, turned_support};
use crate::{Angle, Bounds, Dual, Interval, Real};
use crate::{ParamError, check};

/// Rotation about z by an angle that is a function of z.
#[derive(Clone, Debug)]
pub struct TwistBy<L> {
    /// The angle that the law is multiplied by.
    pub angle: Angle,
    /// The law, of z.
    pub law: L,
}

/// Angles are held within 1600 turns, here in degrees: more is noise in single precision.
const LARGEST: f64 = 576e3;

/// A law times a number.
#[derive(Clone, Debug)]
struct Times<L>(L, f64);

impl<L: Law> Law for Times<L> {
    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        self.0.at(z) * self.1
    }
}

impl<L: Law> TwistBy<L> {
    #[inline(always)]
    fn turn<R: Real>(&self, z: R) -> R {
        let most = LARGEST.to_radians();
        (self.law.at(z) * self.angle.radians()).max(z.lift(-most)).min(z.lift(most))
    }
}

impl<L: Law> Warp for TwistBy<L> {
    const NAME: &'static str = "twist_by";

    const CONTINUOUS: bool = L::CONTINUOUS;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let (sin, cos) = self.turn(z).sin_cos();
        [x.mul_add(cos, y * sin), y.mul_add(cos, -(x * sin)), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let (sin, cos) = self.turn(p.z).sin_cos();
        DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let mut out = Bounds::EMPTY;
        for slice in slices(b) {
            let angle = law_range(|z| self.turn(z), Interval::new(slice.min.z, slice.max.z));
            out = out.union(&turned_box(&slice, angle));
        }
        out
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        turned_support(own, direction)
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        self.law.check()?;
        check::angle("angle", self.angle, -1e9, 1e9)?;
        check_law("angle (degrees)", &Times(self.law.clone(), self.angle.degrees()), b, -LARGEST, LARGEST)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.roundoff_over([Interval::new(-reach, reach); 3])
    }

    fn roundoff_over(&self, [x, y, z]: [Interval; 3]) -> f64 {
        let (across, reach) = (x.magnitude() + y.magnitude(), z.magnitude());
        let angle = self.turn(Dual::variable(z, 2));
        // The law is off by some rounding errors of itself and of what its slope makes of
        // those of z.
        let off = angle.value().magnitude() + angle.gradient()[2].magnitude() * reach;
        5e-7 * across * (1.0 + off)
    }
}
