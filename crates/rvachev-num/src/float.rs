//! [`Real`] on `f64`: the reference that every other number is tested against.

use super::{Norm, Real};

/// The logarithm that stands for that of 0 (see [`Real::log2`]).
pub const LOG2_OF_ZERO: f64 = -1e5;

impl Real for f64 {
    #[inline(always)]
    fn lift(self, c: f64) -> f64 {
        c
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        f64::min(self, other)
    }

    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        f64::max(self, other)
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self.max(0.0))
    }

    #[inline(always)]
    fn exp2(self) -> f64 {
        f64::exp2(self).min(f64::MAX)
    }

    #[inline(always)]
    fn log2(self) -> f64 {
        f64::log2(self).max(LOG2_OF_ZERO)
    }

    #[inline(always)]
    fn pow(self, p: f64) -> f64 {
        self.abs().powf(p)
    }

    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) {
        f64::sin_cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: f64) -> f64 {
        // −0 would turn the angle on the negative x axis by a whole turn.
        f64::atan2(self + 0.0, x + 0.0)
    }

    #[inline(always)]
    fn floor(self) -> f64 {
        f64::floor(self)
    }

    #[inline(always)]
    fn select(self, nonneg: f64, neg: f64) -> f64 {
        if self >= 0.0 { nonneg } else { neg }
    }

    #[inline(always)]
    fn norm(self, other: f64, norm: Norm) -> f64 {
        let (a, b) = (self.abs(), other.abs());
        match norm {
            Norm::Sum => a + b,
            Norm::Euclid => (a * a + b * b).sqrt(),
            Norm::Max => a.max(b),
            Norm::P { p, inv } | Norm::Steep { p, inv } => {
                let (hi, lo) = (a.max(b), a.min(b));
                if hi == 0.0 {
                    return 0.0;
                }
                hi * ((lo / hi).powf(p).ln_1p() * inv).exp()
            }
        }
    }

    #[inline(always)]
    fn norm_parts(self, other: f64, norm: Norm) -> (f64, f64, f64) {
        let value = self.norm(other, norm);
        if value == 0.0 {
            return (0.0, 0.0, 0.0);
        }
        let (a, b) = (self.abs(), other.abs());
        let (da, db) = match norm {
            Norm::Sum => (1.0, 1.0),
            Norm::Euclid => (a / value, b / value),
            Norm::Max if a == b => (0.5, 0.5),
            Norm::Max => (f64::from(a > b), f64::from(b > a)),
            Norm::P { p, .. } | Norm::Steep { p, .. } => (slope(a / value, p), slope(b / value, p)),
        };
        (value, da.copysign(self), db.copysign(other))
    }
}

/// `t^(p − 1)`, the slope of a norm; finite where p < 1 and t = 0.
#[inline(always)]
fn slope(t: f64, p: f64) -> f64 {
    if t == 0.0 && p < 1.0 { 0.0 } else { t.powf(p - 1.0) }
}
