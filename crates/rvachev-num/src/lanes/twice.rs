//! Two vectors side by side.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::ops::norm_methods;
use super::{Lanes, LogSpace, norms};
use crate::{Norm, NormKind, Real};

/// Two numbers of one kind, every operation done on both: a formula has two chains of
/// dependent instructions instead of one, and the processor's pipelines stay full.
#[derive(Clone, Copy, Debug)]
pub struct Twice<T>(pub T, pub T);

impl<T: Neg<Output = T>> Neg for Twice<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Twice(-self.0, -self.1)
    }
}

/// A binary operator, with another such number and with a parameter.
macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl<T: $operator<Output = T>> $operator for Twice<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Twice($operator::$method(self.0, other.0), $operator::$method(self.1, other.1))
            }
        }
    };
    ($operator:ident<f64>, $method:ident) => {
        impl<T: $operator<f64, Output = T>> $operator<f64> for Twice<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, k: f64) -> Self {
                Twice($operator::$method(self.0, k), $operator::$method(self.1, k))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);
operator!(Add<f64>, add);
operator!(Sub<f64>, sub);
operator!(Mul<f64>, mul);

impl<T: LogSpace> Real for Twice<T> {
    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        Twice(self.0.lift(c), self.1.lift(c))
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Twice(self.0.mul_add(a.0, b.0), self.1.mul_add(a.1, b.1))
    }

    #[inline(always)]
    fn scale_add(self, k: f64, b: Self) -> Self {
        Twice(self.0.scale_add(k, b.0), self.1.scale_add(k, b.1))
    }

    #[inline(always)]
    fn square(self) -> Self {
        Twice(self.0.square(), self.1.square())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Twice(self.0.abs(), self.1.abs())
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Twice(self.0.min(other.0), self.1.min(other.1))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Twice(self.0.max(other.0), self.1.max(other.1))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Twice(self.0.sqrt(), self.1.sqrt())
    }

    #[inline(always)]
    fn exp2(self) -> Self {
        Twice(self.0.exp2(), self.1.exp2())
    }

    #[inline(always)]
    fn log2(self) -> Self {
        Twice(self.0.log2(), self.1.log2())
    }

    #[inline(always)]
    fn pow(self, p: f64) -> Self {
        Twice(self.0.pow(p), self.1.pow(p))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin0, cos0) = self.0.sin_cos();
        let (sin1, cos1) = self.1.sin_cos();
        (Twice(sin0, sin1), Twice(cos0, cos1))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Twice(self.0.atan2(x.0), self.1.atan2(x.1))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Twice(self.0.floor(), self.1.floor())
    }

    #[inline(always)]
    fn select(self, nonneg: Self, neg: Self) -> Self {
        Twice(self.0.select(nonneg.0, neg.0), self.1.select(nonneg.1, neg.1))
    }

    norm_methods!();
}

/// Doing the norms through these steps, rather than once per half, is what puts the halves'
/// instructions next to one another.
impl<T: LogSpace> LogSpace for Twice<T> {
    const LOG2_OF_ZERO: f64 = T::LOG2_OF_ZERO;

    #[inline(always)]
    fn power_below(self) -> Self {
        Twice(self.0.power_below(), self.1.power_below())
    }

    #[inline(always)]
    fn power_recip(self) -> Self {
        Twice(self.0.power_recip(), self.1.power_recip())
    }

    #[inline(always)]
    fn log2_over(self, power: Self) -> Self {
        Twice(self.0.log2_over(power.0), self.1.log2_over(power.1))
    }

    #[inline(always)]
    fn exp2_within(self) -> Self {
        Twice(self.0.exp2_within(), self.1.exp2_within())
    }

    #[inline(always)]
    fn exp2_weight(self) -> Self {
        Twice(self.0.exp2_weight(), self.1.exp2_weight())
    }

    #[inline(always)]
    fn times_power(self, rounded: Self) -> Self {
        Twice(self.0.times_power(rounded.0), self.1.times_power(rounded.1))
    }

    #[inline(always)]
    fn join<U: LogSpace>(a: U, b: U, p: f64, inv: f64) -> U {
        T::join(a, b, p, inv)
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Twice(self.0.copysign(sign.0), self.1.copysign(sign.1))
    }

    #[inline(always)]
    fn vanish_with(self, key: Self) -> Self {
        Twice(self.0.vanish_with(key.0), self.1.vanish_with(key.1))
    }

    #[inline(always)]
    fn log_vanish_with(self, key: Self) -> Self {
        Twice(self.0.log_vanish_with(key.0), self.1.log_vanish_with(key.1))
    }

    #[inline(always)]
    fn above(self, other: Self) -> Self {
        Twice(self.0.above(other.0), self.1.above(other.1))
    }

    #[inline(always)]
    fn finite(self) -> Self {
        Twice(self.0.finite(), self.1.finite())
    }
}

impl<T: Lanes> Lanes for Twice<T> {
    type Element = T::Element;
    type Token = T::Token;
    const WIDTH: usize = 2 * T::WIDTH;

    #[inline(always)]
    fn splat(simd: T::Token, c: f64) -> Self {
        Twice(T::splat(simd, c), T::splat(simd, c))
    }

    #[inline(always)]
    fn load(simd: T::Token, from: &[T::Element]) -> Self {
        let (head, tail) = from.split_at(T::WIDTH);
        Twice(T::load(simd, head), T::load(simd, tail))
    }

    #[inline(always)]
    fn store(self, to: &mut [T::Element]) {
        let (head, tail) = to.split_at_mut(T::WIDTH);
        self.0.store(head);
        self.1.store(tail);
    }
}
