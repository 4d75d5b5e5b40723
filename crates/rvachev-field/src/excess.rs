//! How much a norm is above the larger coordinate, to full relative precision.
//!
//! ```text
//!     ‖(x, y)‖ − M,   M = max(|x|, |y|),  m = min(|x|, |y|),  u = (m / M)^p
//!     p = 2:          m · m / (M + ‖(x, y)‖)
//!     any p:          M · ((1 + u)^(1/p) − 1), by the binomial series where u is small
//! ```
//!
//! The conjunction R_p is x + y − ‖(x, y)‖: near an edge the difference of two numbers that are all
//! but equal, which this is the small part of.

use crate::{Euclid, Norm, NormKind, Powers, Real};

/// A denominator is held above this.
pub(super) const TINY: f64 = 1e-37;

/// Series are summed below this.
const SMALL: f64 = 1.0 / 64.0;

/// A norm of which it is known how much it is above the larger coordinate.
pub(super) trait ExcessKind: NormKind {
    /// `‖(x, y)‖ − max(|x|, |y|)`, to full relative precision.
    fn excess<R: Real>(self, x: R, y: R) -> R;

    /// `1 − slope`, to full relative precision, of the slope of the norm by x.
    fn rest<R: Real>(self, x: R, y: R, slope: R) -> R;
}

impl ExcessKind for Euclid {
    #[inline(always)]
    fn excess<R: Real>(self, x: R, y: R) -> R {
        let (a, b) = (x.abs(), y.abs());
        let (hi, lo) = (a.max(b), a.min(b));
        let length = hi.mul_add(hi, lo.square()).sqrt();
        lo * (lo / (hi + length).max(x.lift(TINY)))
    }

    #[inline(always)]
    fn rest<R: Real>(self, x: R, y: R, slope: R) -> R {
        let direct = x.lift(1.0) - slope;
        let length = x.norm_as(y, self);
        let tiny = x.lift(TINY);
        let small = (y / length.max(tiny)) * (y / (length + x).max(tiny));
        x.select(small.meet(direct), direct)
    }
}

impl<const STEEP: bool> ExcessKind for Powers<STEEP> {
    #[inline(always)]
    fn excess<R: Real>(self, x: R, y: R) -> R {
        let (a, b) = (x.abs(), y.abs());
        let (hi, lo) = (a.max(b), a.min(b));
        let Powers { p, inv } = self;
        let u = (lo / hi.max(x.lift(TINY))).pow(p);
        let direct = ((u + 1.0).log2() * inv).exp2() - 1.0;
        hi * (u - SMALL).select(direct, binomial(u, inv))
    }

    #[inline(always)]
    fn rest<R: Real>(self, x: R, y: R, slope: R) -> R {
        let direct = x.lift(1.0) - slope;
        let Powers { p, inv } = self;
        let u = (y.abs() / x.abs().max(x.lift(TINY))).min(x.lift(1.0)).pow(p);
        // The slope is (1 + u)^(1/p − 1) where x is positive.
        let small = -binomial(u, inv - 1.0);
        x.select((u - SMALL).select(direct, small.meet(direct)), direct)
    }
}

/// `(1 + u)^power − 1` by the binomial series, for u of at most [`SMALL`] and powers from −1 to 1:
/// what is left out is less than 2⁻⁵⁴ of it.
#[inline(always)]
fn binomial<R: Real>(u: R, power: f64) -> R {
    const TERMS: u32 = 9;
    let mut series = u.lift(0.0);
    for k in (1..=TERMS).rev() {
        let k = f64::from(k);
        // s_k = u·(power − k + 1)/k·(1 + s_{k+1})
        series = (series + 1.0) * u * ((power - k + 1.0) / k);
    }
    series
}

impl ExcessKind for Norm {
    #[inline(always)]
    fn excess<R: Real>(self, x: R, y: R) -> R {
        match self {
            Norm::Sum => x.abs().min(y.abs()),
            Norm::Max => x.lift(0.0),
            Norm::Euclid => Euclid.excess(x, y),
            Norm::P { p, inv } | Norm::Steep { p, inv } => Powers::<true> { p, inv }.excess(x, y),
        }
    }

    #[inline(always)]
    fn rest<R: Real>(self, x: R, y: R, slope: R) -> R {
        match self {
            Norm::Sum | Norm::Max => x.lift(1.0) - slope,
            Norm::Euclid => Euclid.rest(x, y, slope),
            Norm::P { p, inv } | Norm::Steep { p, inv } => Powers::<true> { p, inv }.rest(x, y, slope),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_keeps_all_digits() {
        for power in [-0.999, -0.5, 0.3, 0.999] {
            let exact = f64::exp_m1(power * SMALL.ln_1p());
            assert!((binomial(SMALL, power) / exact - 1.0).abs() < 1e-15, "{power}");
        }
    }
}
