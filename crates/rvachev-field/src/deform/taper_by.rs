//! Taper along z by two laws of z.
//!
//! ```text
//!     X = s_x(z) x,  Y = s_y(z) y,  Z = z
//! ```

use glam::DVec3;

use super::Warp;
use super::law::{Law, check_law, law_range, slices};
use crate::ParamError;
use crate::{Bounds, Dual, Interval, Real};

/// Scaling across z by factors that are functions of z.
#[derive(Clone, Debug)]
pub struct TaperBy<X, Y> {
    /// The factor of x, by z.
    pub x: X,
    /// The factor of y, by z.
    pub y: Y,
}

/// Factors are held within this range; over the solid they have to be in it.
const SMALLEST: f64 = 1e-3;
const LARGEST: f64 = 1e3;

#[inline(always)]
fn held<R: Real>(factor: R) -> R {
    factor.max(factor.lift(SMALLEST)).min(factor.lift(LARGEST))
}

impl<X: Law, Y: Law> Warp for TaperBy<X, Y> {
    const NAME: &'static str = "taper_by";

    const CONTINUOUS: bool = X::CONTINUOUS && Y::CONTINUOUS;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        [x / held(self.x.at(z)), y / held(self.y.at(z)), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x * held(self.x.at(p.z)), p.y * held(self.y.at(p.z)), p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let mut out = Bounds::EMPTY;
        for slice in slices(b) {
            let z = Interval::new(slice.min.z, slice.max.z);
            let x = Interval::new(b.min.x, b.max.x) * law_range(|z| held(self.x.at(z)), z);
            let y = Interval::new(b.min.y, b.max.y) * law_range(|z| held(self.y.at(z)), z);
            let low = DVec3::new(x.lo(), y.lo(), slice.min.z);
            out = out.union(&Bounds::new(low, DVec3::new(x.hi(), y.hi(), slice.max.z)));
        }
        out
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        self.x.check()?;
        self.y.check()?;
        check_law("x_law", &self.x, b, SMALLEST, LARGEST)?;
        check_law("y_law", &self.y, b, SMALLEST, LARGEST)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.roundoff_over([Interval::new(-reach, reach); 3])
    }

    fn roundoff_over(&self, [x, y, z]: [Interval; 3]) -> f64 {
        let reach = z.magnitude();
        let z = Dual::variable(z, 2);
        let error = |across: Interval, factor: Dual<Interval>| {
            // The law is off by some rounding errors of itself and of what its slope makes of
            // those of z; a quotient is as wrong as its divisor.
            let off = factor.value().magnitude() + factor.gradient()[2].magnitude() * reach;
            let least = factor.value().lo().max(SMALLEST);
            5e-7 * across.magnitude() / least * (1.0 + off / least)
        };
        error(x, held(self.x.at(z))).max(error(y, held(self.y.at(z))))
    }
}
