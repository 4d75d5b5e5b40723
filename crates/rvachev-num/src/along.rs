//! A value with one derivative: what a function of one number makes of it.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::dual::{SMALLEST, by_chain_rule};
use super::{Monotone, Monotone3, Norm, NormKind, Real};

/// A value and its derivative with respect to one variable (see [`Dual`](crate::Dual)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<T> {
    /// The value.
    pub v: T,
    /// Its derivative.
    pub d: T,
}

impl<T: Real> Along<T> {
    #[inline(always)]
    fn constant(v: T) -> Self {
        Along { v, d: v.lift(0.0) }
    }

    /// Value `v`, derivative `a` times that of `self`.
    #[inline(always)]
    fn chain(self, v: T, a: T) -> Self {
        Along { v, d: self.d * a }
    }

    /// The same of two arguments.
    #[inline(always)]
    fn chain2(self, o: Self, v: T, a: T, b: T) -> Self {
        Along { v, d: self.d.mul_add(a, o.d * b) }
    }

    /// The same of three.
    #[inline(always)]
    fn chain3(self, y: Self, z: Self, v: T, [a, b, c]: [T; 3]) -> Self {
        Along { v, d: z.d.mul_add(c, self.d.mul_add(a, y.d * b)) }
    }

    /// Component-wise choice by the sign of `by`.
    #[inline(always)]
    fn choose(by: T, nonneg: Self, neg: Self) -> Self {
        Along { v: by.select(nonneg.v, neg.v), d: by.select(nonneg.d, neg.d) }
    }
}

impl<T: Real> Neg for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Along { v: -self.v, d: -self.d }
    }
}

impl<T: Real> Add for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Along { v: self.v + o.v, d: self.d + o.d }
    }
}

impl<T: Real> Sub for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Along { v: self.v - o.v, d: self.d - o.d }
    }
}

impl<T: Real> Mul for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.chain2(o, self.v * o.v, o.v, self.v)
    }
}

impl<T: Real> Div for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let inverse = self.v.lift(1.0) / o.v;
        let v = self.v * inverse;
        self.chain2(o, v, inverse, -(v * inverse))
    }
}

impl<T: Real> Add<f64> for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, k: f64) -> Self {
        Along { v: self.v + k, d: self.d }
    }
}

impl<T: Real> Sub<f64> for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, k: f64) -> Self {
        Along { v: self.v - k, d: self.d }
    }
}

impl<T: Real> Mul<f64> for Along<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        Along { v: self.v * k, d: self.d * k }
    }
}

impl<T: Real> Real for Along<T> {
    by_chain_rule!(Along);
}
