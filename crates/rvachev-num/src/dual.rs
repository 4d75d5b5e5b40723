//! Dual numbers: a value with its three partial derivatives (forward differentiation).
//!
//! `Dual<f64>` gives the gradient at a point, `Dual` of SIMD lanes gradients in bulk, and
//! `Dual<Interval>` the range of the gradient over a box, that is, local Lipschitz bounds.
//!
//! At kinks one side's derivative is taken; where a derivative is unbounded (`√x` and `|x|^p`,
//! p < 1, at 0) a large finite one. A gradient is always finite.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::along::Along;
use super::{Monotone, Monotone3, Norm, NormKind, OfOne, Real};

/// A value and its derivatives with respect to three variables.
///
/// ```
/// use rvachev::field::{Dual, Real};
///
/// let (x, y) = (Dual::variable(3.0, 0), Dual::variable(4.0, 1));
/// let length = (x.square() + y.square()).sqrt();
/// assert_eq!(length.value(), 5.0);
/// let [dx, dy, dz] = length.gradient();
/// assert!((dx - 0.6).abs() < 1e-15 && (dy - 0.8).abs() < 1e-15 && dz == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T> {
    /// The value.
    pub v: T,
    /// Its derivatives.
    pub d: [T; 3],
}

impl<T: Real> Dual<T> {
    /// The value `v` with derivatives `d`.
    #[must_use]
    #[inline(always)]
    pub fn new(v: T, d: [T; 3]) -> Self {
        Dual { v, d }
    }

    /// A constant: all derivatives are 0.
    #[must_use]
    #[inline(always)]
    pub fn constant(v: T) -> Self {
        let zero = v.lift(0.0);
        Dual { v, d: [zero; 3] }
    }

    /// The variable number `axis` (0, 1 or 2; another number is a constant): its derivative
    /// with respect to itself is 1.
    #[must_use]
    #[inline(always)]
    pub fn variable(v: T, axis: usize) -> Self {
        let mut dual = Dual::constant(v);
        if axis < 3 {
            dual.d[axis] = v.lift(1.0);
        }
        dual
    }

    /// The point as three variables.
    #[must_use]
    #[inline(always)]
    pub fn point(p: [T; 3]) -> [Self; 3] {
        [Dual::variable(p[0], 0), Dual::variable(p[1], 1), Dual::variable(p[2], 2)]
    }

    /// The value.
    #[must_use]
    #[inline(always)]
    pub fn value(self) -> T {
        self.v
    }

    /// The three derivatives.
    #[must_use]
    #[inline(always)]
    pub fn gradient(self) -> [T; 3] {
        self.d
    }

    /// Value `v`, derivatives `a` times those of `self`.
    #[inline(always)]
    fn chain(self, v: T, a: T) -> Self {
        Dual { v, d: T::chain(self.d, a) }
    }

    /// Value `v`, derivatives `a` times those of `self` plus `b` times those of `o`.
    #[inline(always)]
    fn chain2(self, o: Self, v: T, a: T, b: T) -> Self {
        Dual { v, d: T::chain2(self.d, a, o.d, b) }
    }

    /// Value `v`, derivatives `a` times those of `self` plus `b` and `c` times those of `y`
    /// and `z`.
    #[inline(always)]
    fn chain3(self, y: Self, z: Self, v: T, [a, b, c]: [T; 3]) -> Self {
        let mut sum = self.chain2(y, v, a, b);
        for axis in 0..3 {
            sum.d[axis] = z.d[axis].mul_add(c, sum.d[axis]);
        }
        sum
    }

    /// Component-wise choice by the sign of `by`.
    #[inline(always)]
    fn choose(by: T, nonneg: Self, neg: Self) -> Self {
        Dual { v: by.select(nonneg.v, neg.v), d: by.choose(nonneg.d, neg.d) }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { v: -self.v, d: [-self.d[0], -self.d[1], -self.d[2]] }
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Dual { v: self.v + o.v, d: [self.d[0] + o.d[0], self.d[1] + o.d[1], self.d[2] + o.d[2]] }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Dual { v: self.v - o.v, d: [self.d[0] - o.d[0], self.d[1] - o.d[1], self.d[2] - o.d[2]] }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.chain2(o, self.v * o.v, o.v, self.v)
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let inverse = self.v.lift(1.0) / o.v;
        let v = self.v * inverse;
        self.chain2(o, v, inverse, -(v * inverse))
    }
}

impl<T: Real> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, k: f64) -> Self {
        Dual { v: self.v + k, d: self.d }
    }
}

impl<T: Real> Sub<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, k: f64) -> Self {
        Dual { v: self.v - k, d: self.d }
    }
}

impl<T: Real> Mul<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        Dual { v: self.v * k, d: [self.d[0] * k, self.d[1] * k, self.d[2] * k] }
    }
}

/// Below this size a denominator of a derivative is held, so that it stays finite.
pub(crate) const SMALLEST: f64 = 1e-30;

/// The methods of [`Real`] by the chain rule, however many derivatives there are.
macro_rules! by_chain_rule {
    ($dual:ident) => {
        #[inline(always)]
        fn lift(self, c: f64) -> Self {
            $dual::constant(self.v.lift(c))
        }

        #[inline(always)]
        fn square(self) -> Self {
            self.chain(self.v.square(), self.v * 2.0)
        }

        #[inline(always)]
        fn abs(self) -> Self {
            let one = self.v.lift(1.0);
            self.chain(self.v.abs(), self.v.select(one, -one))
        }

        #[inline(always)]
        fn min(self, o: Self) -> Self {
            let mut least = $dual::choose(o.v - self.v, self, o);
            least.v = self.v.min(o.v);
            least
        }

        #[inline(always)]
        fn max(self, o: Self) -> Self {
            let mut most = $dual::choose(self.v - o.v, self, o);
            most.v = self.v.max(o.v);
            most
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            let root = self.v.sqrt();
            let tiny = root.lift(1e-15);
            self.chain(root, root.lift(0.5) / root.max(tiny))
        }

        #[inline(always)]
        fn exp2(self) -> Self {
            let v = self.v.exp2();
            self.chain(v, v * std::f64::consts::LN_2)
        }

        #[inline(always)]
        fn log2(self) -> Self {
            // Held higher than other denominators: the slope is multiplied by that of an angle,
            // which is large near its axis, and must not overflow single precision.
            let tiny = self.v.lift(1e-18);
            self.chain(self.v.log2(), self.v.lift(std::f64::consts::LOG2_E) / self.v.max(tiny))
        }

        #[inline(always)]
        fn pow(self, p: f64) -> Self {
            let v = self.v.pow(p);
            let slope = if p >= 1.0 {
                if p == 1.0 { self.v.lift(1.0) } else { self.v.pow(p - 1.0) * p }
            } else {
                // v/|x| is 0 at 0, where the derivative is unbounded.
                let tiny = self.v.lift(SMALLEST);
                v * p / self.v.abs().max(tiny)
            };
            self.chain(v, self.v.select(slope, -slope))
        }

        #[inline(always)]
        fn sin_cos(self) -> (Self, Self) {
            let (sin, cos) = self.v.sin_cos();
            (self.chain(sin, cos), self.chain(cos, -sin))
        }

        #[inline(always)]
        fn atan2(self, x: Self) -> Self {
            let tiny = self.v.lift(SMALLEST);
            let squared = (self.v.square() + x.v.square()).max(tiny);
            self.chain2(x, self.v.atan2(x.v), x.v / squared, -self.v / squared)
        }

        #[inline(always)]
        fn floor(self) -> Self {
            let (v, slope) = self.v.floor_parts();
            self.chain(v, slope)
        }

        #[inline(always)]
        fn select(self, nonneg: Self, neg: Self) -> Self {
            $dual::choose(self.v, nonneg, neg)
        }

        #[inline(always)]
        fn log2_sum_exp2(self, o: Self) -> Self {
            // The weights are shares of a whole; intervals do not know it of themselves.
            let v = self.v.log2_sum_exp2(o.v);
            let one = v.lift(1.0);
            self.chain2(o, v, (self.v - v).exp2().min(one), (o.v - v).exp2().min(one))
        }

        #[inline(always)]
        fn norm(self, o: Self, norm: Norm) -> Self {
            let (v, a, b) = self.v.norm_parts(o.v, norm);
            self.chain2(o, v, a, b)
        }

        #[inline(always)]
        fn norm_as<N: NormKind>(self, o: Self, norm: N) -> Self {
            let (v, a, b) = self.v.norm_parts_as(o.v, norm);
            self.chain2(o, v, a, b)
        }

        #[inline(always)]
        fn norm_parts_as<N: NormKind>(self, o: Self, norm: N) -> (Self, Self, Self) {
            let (v, a, b) = self.v.norm_parts_as(o.v, norm);
            (self.chain2(o, v, a, b), $dual::constant(a), $dual::constant(b))
        }

        #[inline(always)]
        fn nested_as<N: NormKind>(self, y: Self, z: Self, inner: N, outer: N) -> Self {
            let (v, slopes) = self.v.nested_parts_as(y.v, z.v, inner, outer);
            self.chain3(y, z, v, slopes)
        }

        #[inline(always)]
        fn norm_parts(self, o: Self, norm: Norm) -> (Self, Self, Self) {
            // Second derivatives are unbounded for most norms and are asked of by nobody: the
            // slopes are constants to this number.
            let (v, a, b) = self.v.norm_parts(o.v, norm);
            (self.chain2(o, v, a, b), $dual::constant(a), $dual::constant(b))
        }

        #[inline(always)]
        fn nested(self, y: Self, z: Self, inner: Norm, outer: Norm) -> Self {
            let (v, slopes) = self.v.nested_parts(y.v, z.v, inner, outer);
            self.chain3(y, z, v, slopes)
        }

        #[inline(always)]
        fn monotone<M: Monotone>(self, o: Self, function: &M) -> Self {
            let (v, a, b) = function.parts(self.v, o.v);
            self.chain2(o, v, a, b)
        }

        #[inline(always)]
        fn monotone3<M: Monotone3>(self, y: Self, z: Self, function: &M) -> Self {
            let (v, slopes) = function.parts(self.v, y.v, z.v);
            self.chain3(y, z, v, slopes)
        }
    };
}

impl<T: Real> Real for Dual<T> {
    by_chain_rule!(Dual);

    #[inline(always)]
    fn scale_add(self, k: f64, b: Self) -> Self {
        let all = |dual: Self| [dual.v, dual.d[0], dual.d[1], dual.d[2]];
        let [v, x, y, z] = T::scale_add_all(all(self), k, all(b));
        Dual { v, d: [x, y, z] }
    }

    #[inline(always)]
    fn of_one<F: OfOne>(self, function: &F) -> Self {
        let Along { v, d } = function.value(Along { v: self.v, d: self.v.lift(1.0) });
        self.chain(v, d)
    }
}

pub(crate) use by_chain_rule;
