//! The trait of real arithmetic that formulas are generic over.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Monotone, Monotone3, Norm, NormKind, OfOne};

/// A number that a formula can be evaluated on.
///
/// Parameters of a formula are `f64`; coordinates and values are `Self`. There is no
/// comparison and no conversion to `bool`: a formula branches on its parameters as it likes,
/// and on values only by [`select`](Real::select), [`min`](Real::min) and [`max`](Real::max),
/// so that one text serves points, ranges, gradients, vectors of points and expression trees.
///
/// For SIMD lanes inlining is all or nothing: one helper in a formula that is not
/// `#[inline(always)]`, or a closure bound by `let`, costs a factor of about 18.
///
/// ```
/// use rvachev::field::{Dual, Real};
/// use rvachev::Interval;
///
/// #[inline(always)]
/// fn circle<R: Real>(x: R, y: R) -> R {
///     -(x.square() + y.square()).sqrt() + 1.0
/// }
///
/// assert_eq!(circle(0.6, 0.8), 0.0);
/// let range = circle(Interval::new(0.0, 0.5), Interval::new(0.0, 0.5));
/// assert!(range.lo() > 0.29 && range.hi() >= 1.0);
/// let slope = circle(Dual::variable(2.0, 0), Dual::constant(0.0));
/// assert_eq!(slope.gradient(), [-1.0, 0.0, 0.0]);
/// ```
pub trait Real:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The constant `c` as a number of this value's kind. (What a kind needs to make a
    /// constant, a SIMD token or an arena, travels in the value.)
    fn lift(self, c: f64) -> Self;

    /// `self · a + b`, fused where the hardware fuses.
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }

    /// `self · k + b` with a parameter `k`.
    #[inline(always)]
    fn scale_add(self, k: f64, b: Self) -> Self {
        self * k + b
    }

    /// `self²`; an interval knows that it is not negative.
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }

    /// Absolute value.
    fn abs(self) -> Self;

    /// The smaller of the two.
    fn min(self, other: Self) -> Self;

    /// The larger of the two.
    fn max(self, other: Self) -> Self;

    /// Square root; of a negative number 0.
    fn sqrt(self) -> Self;

    /// `2^self`: 0 where it underflows, the largest finite number where it overflows.
    fn exp2(self) -> Self;

    /// Binary logarithm of a number ≥ 0. At 0 it is a finite number so far below every
    /// other logarithm (−10⁵ or less for `f64`, −10⁴ for `f32` lanes) that `exp2` of any
    /// sensible multiple of it is 0.
    fn log2(self) -> Self;

    /// `|self|^p` for p > 0, with `0^p = 0`.
    fn pow(self, p: f64) -> Self;

    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// The angle of the vector `(x, self)` in radians, in [−π, π]; 0 at the origin.
    fn atan2(self, x: Self) -> Self;

    /// The largest integer that is not above `self`. Its slope is 0; an interval that holds an
    /// integer, where the value jumps, has all slopes.
    fn floor(self) -> Self;

    /// [`floor`](Real::floor) and its derivative.
    #[inline(always)]
    fn floor_parts(self) -> (Self, Self) {
        (self.floor(), self.lift(0.0))
    }

    /// `nonneg` where `self ≥ 0`, else `neg`; on an undecided interval the hull of both.
    fn select(self, nonneg: Self, neg: Self) -> Self;

    /// This number, of which `other` is the same by another formula that loses more digits: an
    /// interval takes what both of them hold.
    #[doc(hidden)]
    #[inline(always)]
    fn meet(self, _other: Self) -> Self {
        self
    }

    /// `log2(2^self + 2^other)` without overflow.
    #[inline(always)]
    fn log2_sum_exp2(self, other: Self) -> Self {
        let hi = self.max(other);
        let lo = self.min(other);
        hi + ((lo - hi).exp2() + 1.0).log2()
    }

    /// The norm of the pair `(self, other)`.
    fn norm(self, other: Self, norm: Norm) -> Self;

    /// [`norm`](Real::norm) and its derivatives with respect to `self` and `other`
    /// (0 where the norm is 0).
    fn norm_parts(self, other: Self, norm: Norm) -> (Self, Self, Self);

    /// The norm of a superellipsoid: `‖(‖(self, y)‖_inner, z)‖_outer`.
    #[inline(always)]
    fn nested(self, y: Self, z: Self, inner: Norm, outer: Norm) -> Self {
        self.norm(y, inner).norm(z, outer)
    }

    /// [`nested`](Real::nested) and its derivatives with respect to `self`, `y` and `z`.
    #[inline(always)]
    fn nested_parts(self, y: Self, z: Self, inner: Norm, outer: Norm) -> (Self, [Self; 3]) {
        let (rho, rho_x, rho_y) = self.norm_parts(y, inner);
        let (value, value_rho, value_z) = rho.norm_parts(z, outer);
        (value, [value_rho * rho_x, value_rho * rho_y, value_z])
    }

    /// [`norm`](Real::norm) by a kind that is known when the formula is compiled.
    #[doc(hidden)]
    #[inline(always)]
    fn norm_as<N: NormKind>(self, other: Self, norm: N) -> Self {
        self.norm(other, norm.norm())
    }

    /// The same of [`norm_parts`](Real::norm_parts).
    #[doc(hidden)]
    #[inline(always)]
    fn norm_parts_as<N: NormKind>(self, other: Self, norm: N) -> (Self, Self, Self) {
        self.norm_parts(other, norm.norm())
    }

    /// The same of [`nested`](Real::nested).
    #[doc(hidden)]
    #[inline(always)]
    fn nested_as<N: NormKind>(self, y: Self, z: Self, inner: N, outer: N) -> Self {
        self.nested(y, z, inner.norm(), outer.norm())
    }

    /// The same of [`nested_parts`](Real::nested_parts).
    #[doc(hidden)]
    #[inline(always)]
    fn nested_parts_as<N: NormKind>(self, y: Self, z: Self, inner: N, outer: N) -> (Self, [Self; 3]) {
        self.nested_parts(y, z, inner.norm(), outer.norm())
    }

    /// A function of this number alone: gradients need its slope once, not for each variable.
    #[doc(hidden)]
    #[inline(always)]
    fn of_one<F: OfOne>(self, function: &F) -> Self {
        function.value(self)
    }

    /// Derivatives `d`, each times `a`: the chain rule of [`Dual`](crate::Dual) numbers over these.
    #[doc(hidden)]
    #[inline(always)]
    fn chain(d: [Self; 3], a: Self) -> [Self; 3] {
        [d[0] * a, d[1] * a, d[2] * a]
    }

    /// The same of two arguments: `a` times `d` plus `b` times `e`.
    #[doc(hidden)]
    #[inline(always)]
    fn chain2(d: [Self; 3], a: Self, e: [Self; 3], b: Self) -> [Self; 3] {
        [d[0].mul_add(a, e[0] * b), d[1].mul_add(a, e[1] * b), d[2].mul_add(a, e[2] * b)]
    }

    /// [`scale_add`](Real::scale_add) of values and derivatives.
    #[doc(hidden)]
    #[inline(always)]
    fn scale_add_all(a: [Self; 4], k: f64, b: [Self; 4]) -> [Self; 4] {
        [a[0] * k + b[0], a[1] * k + b[1], a[2] * k + b[2], a[3] * k + b[3]]
    }

    /// [`select`](Real::select) of derivatives.
    #[doc(hidden)]
    #[inline(always)]
    fn choose(self, nonneg: [Self; 3], neg: [Self; 3]) -> [Self; 3] {
        [self.select(nonneg[0], neg[0]), self.select(nonneg[1], neg[1]), self.select(nonneg[2], neg[2])]
    }

    /// A function that rises with both of its arguments: an interval needs its endpoints
    /// only, a dual number its two slopes.
    #[inline(always)]
    fn monotone<M: Monotone>(self, other: Self, function: &M) -> Self {
        function.value(self, other)
    }

    /// A function that rises with all three of its arguments.
    #[inline(always)]
    fn monotone3<M: Monotone3>(self, y: Self, z: Self, function: &M) -> Self {
        function.value(self, y, z)
    }
}
