//! Interval arithmetic: ranges that are sound, rounded outward.
//!
//! An [`Interval`] `[lo, hi]` holds every value that an expression takes while its arguments
//! run over theirs. `+ − × ÷ √` are rounded correctly by the hardware, so one step outward to
//! the next float on each side covers them. The transcendental functions of the platform's
//! mathematics library stay within one unit in the last place; their results are inflated by
//! [`Interval::LIBRARY_ULPS`] such units on each side.
//!
//! A sum or a root that is 0 is exact, and so is a product one of whose factors is 0: it stays 0.
//! The step from 0 would lead to a denormal number, which processors take fifty times as long to
//! multiply, and every derivative by a variable that a formula does not have is 0. Only what
//! underflows to 0 is rounded, and that to a normal number.
//!
//! Where a value is undefined (∞ − ∞, 0 · ∞, division by an interval that holds 0) the result
//! is the whole line, never NaN.
//!
//! What takes more than a few operations is not inlined: a call costs little beside it, and
//! formulas on intervals and on their dual numbers are as many as the leaves.
//!
//! Source: R. E. Moore, *Interval Analysis* (1966).

mod ops;
mod slopes;

use slopes::{cosine, slope};

use super::{Monotone, Monotone3, Norm, Real};

/// A closed interval of real numbers, `lo ≤ hi`; either end may be infinite.
///
/// ```
/// use rvachev::field::Real;
/// use rvachev::Interval;
///
/// let x = Interval::new(-1.0, 2.0);
/// assert_eq!(x.square().lo(), 0.0);
/// assert!(x.square().contains(4.0));
/// assert_eq!(x.select(Interval::point(1.0), Interval::point(5.0)), Interval::new(1.0, 5.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    /// The whole line.
    pub const ALL: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// Nothing but 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };

    /// By how many units in the last place the transcendental functions are inflated.
    pub const LIBRARY_ULPS: f64 = 4.0;

    /// What has underflowed to 0 is rounded to this, or to its negative: no denormal number comes
    /// of it by some steps more.
    pub const TINY: f64 = 1e-270;

    /// The interval from `a` to `b`, in either order; the whole line if one is NaN.
    #[must_use]
    #[inline(always)]
    pub fn new(a: f64, b: f64) -> Interval {
        if a <= b {
            Interval { lo: a, hi: b }
        } else if b < a {
            Interval { lo: b, hi: a }
        } else {
            Interval::ALL
        }
    }

    /// The single point `x`.
    #[must_use]
    #[inline(always)]
    pub fn point(x: f64) -> Interval {
        Interval::new(x, x)
    }

    /// The interval `centre ± radius`, rounded outward.
    #[must_use]
    #[inline(always)]
    pub fn around(centre: f64, radius: f64) -> Interval {
        Interval::outward(centre - radius, centre + radius)
    }

    /// The lower end.
    #[must_use]
    #[inline(always)]
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The upper end.
    #[must_use]
    #[inline(always)]
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// The middle; 0 if both ends are infinite.
    #[must_use]
    #[inline(always)]
    pub fn mid(self) -> f64 {
        if self.lo == f64::NEG_INFINITY && self.hi == f64::INFINITY {
            0.0
        } else {
            (0.5 * self.lo + 0.5 * self.hi).clamp(-f64::MAX, f64::MAX)
        }
    }

    /// `hi − lo`.
    #[must_use]
    #[inline(always)]
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The largest absolute value in the interval.
    #[must_use]
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        most(self.lo.abs(), self.hi.abs())
    }

    /// Whether `x` lies in the interval.
    #[must_use]
    #[inline(always)]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// The smallest interval that holds both.
    #[must_use]
    #[inline(always)]
    pub fn hull(self, other: Interval) -> Interval {
        Interval { lo: least(self.lo, other.lo), hi: most(self.hi, other.hi) }
    }

    /// What both hold. Both must be sound ranges of one value; should rounding leave
    /// nothing in common, `self` is returned.
    #[must_use]
    #[inline(always)]
    pub fn narrowed_by(self, other: Interval) -> Interval {
        let (lo, hi) = (most(self.lo, other.lo), least(self.hi, other.hi));
        if lo <= hi { Interval { lo, hi } } else { self }
    }

    /// The product, which is 0 where a factor is nothing but 0, however large the other.
    ///
    /// ```
    /// use rvachev_num::Interval;
    ///
    /// assert_eq!(Interval::ZERO * Interval::ALL, Interval::ALL);
    /// assert_eq!(Interval::ZERO.times(Interval::ALL), Interval::ZERO);
    /// ```
    #[must_use]
    #[inline]
    pub fn times(self, other: Interval) -> Interval {
        if self == Interval::ZERO || other == Interval::ZERO { Interval::ZERO } else { self * other }
    }

    /// The sum; 0 adds no rounding.
    ///
    /// ```
    /// use rvachev_num::Interval;
    ///
    /// assert_eq!(Interval::ZERO.plus(Interval::point(0.1)), Interval::point(0.1));
    /// ```
    #[must_use]
    #[inline]
    pub fn plus(self, other: Interval) -> Interval {
        if self == Interval::ZERO {
            other
        } else if other == Interval::ZERO {
            self
        } else {
            self + other
        }
    }

    /// The interval widened by `margin` on each side.
    #[must_use]
    #[inline(always)]
    pub fn inflate(self, margin: f64) -> Interval {
        Interval::outward(self.lo - margin, self.hi + margin)
    }

    /// `[lo, hi]`, each end but 0 moved to the next float outward.
    #[inline(always)]
    fn outward(lo: f64, hi: f64) -> Interval {
        if lo <= hi { Interval { lo: 0.0 - next_up(-lo), hi: next_up(hi) } } else { Interval::ALL }
    }

    /// The same of what has underflowed where an end is 0 though there are values below it, or
    /// above it, as `signs` tells.
    #[inline(always)]
    fn signed(mut lo: f64, mut hi: f64, signs: impl FnOnce() -> (bool, bool)) -> Interval {
        if lo == 0.0 || hi == 0.0 {
            let (below, above) = signs();
            lo = if lo == 0.0 && below { -Interval::TINY } else { lo };
            hi = if hi == 0.0 && above { Interval::TINY } else { hi };
        }
        Interval::outward(lo, hi)
    }

    /// The interval whose ends are among products, or quotients, of ends.
    #[inline(always)]
    fn among([a, b, c, d]: [f64; 4], signs: impl FnOnce() -> (bool, bool)) -> Interval {
        // Both infinities have no sum either, and the whole line between them.
        if (a + b + (c + d)).is_nan() {
            return Interval::ALL;
        }
        Interval::signed(least(least(a, b), least(c, d)), most(most(a, b), most(c, d)), signs)
    }

    /// Whether there are numbers below 0, and above it.
    #[inline(always)]
    fn signs(self) -> (bool, bool) {
        (self.lo < 0.0, self.hi > 0.0)
    }

    /// `[lo, hi]` as a library function returned them, with its error on each side.
    #[inline(always)]
    fn library(lo: f64, hi: f64) -> Interval {
        const RELATIVE: f64 = Interval::LIBRARY_ULPS * f64::EPSILON;
        let (lo, hi) = (lo - lo.abs().min(f64::MAX) * RELATIVE, hi + hi.abs().min(f64::MAX) * RELATIVE);
        Interval::signed(lo, hi, || (true, true))
    }

    /// Like `library`, for a function with values in `[min, max]`.
    #[inline(always)]
    fn library_within(lo: f64, hi: f64, min: f64, max: f64) -> Interval {
        let wide = Interval::library(lo, hi);
        Interval { lo: wide.lo.max(min), hi: wide.hi.min(max) }
    }
}

/// `f64::next_up` of a number that is not NaN, without its branches: most of what an interval
/// operation takes, and most of what it is compiled to. 0 stays.
#[inline(always)]
fn next_up(x: f64) -> f64 {
    // −0 becomes 0. The bits of a float are its place among those of its sign.
    let bits = (x + 0.0).to_bits();
    let step = ((bits as i64) >> 63) as u64 | u64::from(bits != 0);
    least(f64::from_bits(bits.wrapping_add(step)), f64::INFINITY)
}

/// The lesser of two numbers, and the second where one is NaN: what processors have an
/// instruction for.
#[doc(hidden)]
#[must_use]
#[inline(always)]
pub fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
#[doc(hidden)]
#[must_use]
#[inline(always)]
pub fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The signs of the products of numbers of these signs.
#[inline(always)]
fn product((below, above): (bool, bool), (o_below, o_above): (bool, bool)) -> (bool, bool) {
    (below & o_above | above & o_below, below & o_below | above & o_above)
}

/// How far beyond ±π the range of `atan2` may reach.
const PI_UP: f64 = std::f64::consts::PI + 1e-15;

impl Real for Interval {
    #[inline(always)]
    fn lift(self, c: f64) -> Interval {
        Interval::point(c)
    }

    /// Most maps move a point, or exchange its coordinates: what they have none of is left out.
    #[inline]
    fn scale_add(self, k: f64, b: Interval) -> Interval {
        if k == 0.0 {
            b
        } else if k == 1.0 {
            self.plus(b)
        } else {
            (self * k).plus(b)
        }
    }

    #[inline(always)]
    fn square(self) -> Interval {
        let a = self.abs();
        Interval::signed(a.lo * a.lo, a.hi * a.hi, || a.signs())
    }

    #[inline(always)]
    fn abs(self) -> Interval {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Interval { lo: 0.0, hi: most(self.hi, -self.lo) }
        }
    }

    #[inline(always)]
    fn min(self, o: Interval) -> Interval {
        Interval { lo: least(self.lo, o.lo), hi: least(self.hi, o.hi) }
    }

    #[inline(always)]
    fn max(self, o: Interval) -> Interval {
        Interval { lo: most(self.lo, o.lo), hi: most(self.hi, o.hi) }
    }

    #[inline(always)]
    fn sqrt(self) -> Interval {
        Interval::outward(most(self.lo, 0.0).sqrt(), most(self.hi, 0.0).sqrt())
    }

    #[inline(never)]
    fn exp2(self) -> Interval {
        Interval::library_within(self.lo.exp2(), self.hi.exp2(), 0.0, f64::INFINITY)
    }

    #[inline(never)]
    fn log2(self) -> Interval {
        Interval::library(Real::log2(self.lo.max(0.0)), Real::log2(self.hi.max(0.0)))
    }

    #[inline(never)]
    fn pow(self, p: f64) -> Interval {
        let a = self.abs();
        let most = if a.hi == 0.0 && p > 0.0 { 0.0 } else { f64::INFINITY };
        Interval::library_within(a.lo.powf(p), a.hi.powf(p), 0.0, most)
    }

    fn sin_cos(self) -> (Interval, Interval) {
        (cosine(self - std::f64::consts::FRAC_PI_2), cosine(self))
    }

    fn atan2(self, x: Interval) -> Interval {
        let y = self;
        if x.contains(0.0) && y.contains(0.0) || (x.lo < 0.0 && y.contains(0.0)) {
            return Interval { lo: -PI_UP, hi: PI_UP };
        }
        // Away from the cut and the origin the extremes are at corners of the box.
        let corners = [y.lo.atan2(x.lo), y.lo.atan2(x.hi), y.hi.atan2(x.lo), y.hi.atan2(x.hi)];
        let lo = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Interval::library_within(lo, hi, -PI_UP, PI_UP)
    }

    #[inline(always)]
    fn floor(self) -> Interval {
        Interval { lo: self.lo.floor(), hi: self.hi.floor() }
    }

    #[inline(always)]
    fn floor_parts(self) -> (Interval, Interval) {
        let floor = Real::floor(self);
        // A point at an integer is on the right side of the jump; what is rounded may be on
        // either, and its interval is no point.
        (floor, if floor.lo == floor.hi { Interval::point(0.0) } else { Interval::ALL })
    }

    #[inline(always)]
    fn select(self, nonneg: Interval, neg: Interval) -> Interval {
        if self.lo >= 0.0 {
            nonneg
        } else if self.hi < 0.0 {
            neg
        } else {
            nonneg.hull(neg)
        }
    }

    #[inline(always)]
    fn meet(self, o: Interval) -> Interval {
        Interval { lo: most(self.lo, o.lo), hi: least(self.hi, o.hi) }
    }

    #[inline(never)]
    fn log2_sum_exp2(self, o: Interval) -> Interval {
        // It rises with both arguments.
        Interval::library(Real::log2_sum_exp2(self.lo, o.lo), Real::log2_sum_exp2(self.hi, o.hi)).inflate(1e-15)
    }

    #[inline(never)]
    fn norm(self, other: Interval, norm: Norm) -> Interval {
        // It rises with |a| and |b|: two evaluations are the exact range. A norm by powers
        // and logarithms takes three library calls.
        let (a, b) = (self.abs(), other.abs());
        // Of one number it is exact.
        if a.hi == 0.0 || b.hi == 0.0 {
            return if a.hi == 0.0 { b } else { a };
        }
        let wide = Interval::library(a.lo.norm(b.lo, norm), a.hi.norm(b.hi, norm));
        let wide =
            if let Norm::P { .. } | Norm::Steep { .. } = norm { Interval::library(wide.lo, wide.hi) } else { wide };
        // What underflows is no less than either.
        Interval { lo: wide.lo.max(0.0), hi: wide.hi.max(a.hi).max(b.hi) }
    }

    #[inline(always)]
    fn norm_parts(self, other: Interval, norm: Norm) -> (Interval, Interval, Interval) {
        let value = self.norm(other, norm);
        (value, slope(self, other, norm), slope(other, self, norm))
    }

    #[inline(never)]
    fn chain(d: [Interval; 3], a: Interval) -> [Interval; 3] {
        [d[0].times(a), d[1].times(a), d[2].times(a)]
    }

    #[inline(never)]
    fn chain2(d: [Interval; 3], a: Interval, e: [Interval; 3], b: Interval) -> [Interval; 3] {
        let both = |axis: usize| d[axis].times(a).plus(e[axis].times(b));
        [both(0), both(1), both(2)]
    }

    #[inline(never)]
    fn scale_add_all(a: [Interval; 4], k: f64, b: [Interval; 4]) -> [Interval; 4] {
        [a[0].scale_add(k, b[0]), a[1].scale_add(k, b[1]), a[2].scale_add(k, b[2]), a[3].scale_add(k, b[3])]
    }

    #[inline(never)]
    fn choose(self, nonneg: [Interval; 3], neg: [Interval; 3]) -> [Interval; 3] {
        [self.select(nonneg[0], neg[0]), self.select(nonneg[1], neg[1]), self.select(nonneg[2], neg[2])]
    }

    #[inline(always)]
    fn monotone<M: Monotone>(self, other: Interval, function: &M) -> Interval {
        let (lo, hi) = (function.value(self.lo, other.lo), function.value(self.hi, other.hi));
        if lo.is_nan() || hi.is_nan() {
            return Interval::ALL;
        }
        // The formula's own rounding is relative to its operands.
        let rounding = 16.0 * f64::EPSILON;
        let (lo_size, hi_size) = (self.lo.abs().max(other.lo.abs()), self.hi.abs().max(other.hi.abs()));
        let (lo, hi) = (lo - rounding * (lo_size + lo.abs()), hi + rounding * (hi_size + hi.abs()));
        Interval::signed(lo, hi, || (true, true))
    }

    #[inline(always)]
    fn monotone3<M: Monotone3>(self, y: Interval, z: Interval, function: &M) -> Interval {
        let (lo, hi) = (function.value(self.lo, y.lo, z.lo), function.value(self.hi, y.hi, z.hi));
        if lo.is_nan() || hi.is_nan() {
            return Interval::ALL;
        }
        // What the trait allows the formula to be off by.
        const INEXACT: f64 = 1e-13;
        let lo_size = self.lo.abs().max(y.lo.abs()).max(z.lo.abs());
        let hi_size = self.hi.abs().max(y.hi.abs()).max(z.hi.abs());
        let (lo, hi) = (lo - INEXACT * (lo_size + lo.abs()), hi + INEXACT * (hi_size + hi.abs()));
        Interval::signed(lo, hi, || (true, true))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_0_have_their_ends_in_order() {
        for p in [-2.0, -0.5, 0.0, 0.5, 2.0] {
            for x in [Interval::ZERO, Interval::new(0.0, 2.0), Interval::new(-1.0, 0.0), Interval::new(1.0, 2.0)] {
                let power = x.pow(p);
                assert!(power.lo <= power.hi, "{x:?} to {p}: {power:?}");
            }
        }
    }
    use crate::Dual;

    #[test]
    fn the_next_number_is_that_of_the_library_but_of_0() {
        assert_eq!([next_up(0.0), next_up(-0.0)].map(f64::to_bits), [0; 2]);
        let mut numbers = vec![f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, 1.0, 1.5, f64::EPSILON, 5e-324, 1e-323];
        numbers.extend((1..2000u64).map(|n| f64::from_bits(n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 1)));
        numbers.retain(|number| !number.is_nan());
        for number in numbers {
            for number in [number, -number] {
                assert_eq!(next_up(number).to_bits(), number.next_up().to_bits(), "{number:e}");
                assert_eq!((-next_up(-number)).to_bits(), number.next_down().to_bits(), "{number:e}");
            }
        }
    }

    #[test]
    fn nothing_that_is_0_is_rounded() {
        let (zero, one, both) = (Interval::ZERO, Interval::new(0.5, 1.0), Interval::new(-2.0, 3.0));
        for other in [one, -one, both, zero] {
            for found in [zero * other, other * zero, zero * 2.0, other * 0.0, other * -0.0, zero / one, zero / -one] {
                assert_eq!(found, zero, "{other:?}");
            }
            assert_eq!((zero + zero, zero - zero, other + other * 0.0), (zero, zero, other + zero), "{other:?}");
        }
        for p in [0.3, 1.0, 1.7, 2.0, 6.0] {
            assert_eq!((zero.pow(p), zero.norm(zero, Norm::new(p))), (zero, zero), "{p}");
        }
        assert_eq!((zero.square(), zero.sqrt()), (zero, zero));
        // Ends too.
        let from = Interval::new(0.0, 0.25);
        for found in [from + from, from * from, from * one, from / one, from * 3.0, from.square(), from.sqrt()] {
            assert_eq!(found.lo(), 0.0, "{found:?}");
        }
        for found in [from * -one, -from / one, from * -3.0] {
            assert_eq!(found.hi(), 0.0, "{found:?}");
        }
    }

    /// A function of x alone has no slope along y and z, whatever it has along x.
    #[test]
    fn derivatives_that_are_0_stay_so() {
        let x = Dual::variable(Interval::new(0.5, 1.5), 0);
        assert_eq!(x.floor().d, [Interval::ALL, Interval::ZERO, Interval::ZERO]);
        assert_eq!((x * x.exp2() + x.floor()).d[1..], [Interval::ZERO; 2]);
    }

    /// A map adds no rounding for what it has none of.
    #[test]
    fn maps_that_move_nothing_change_nothing() {
        let point = Dual::point([Interval::new(-0.1, 0.3), Interval::point(0.7), Interval::ALL]);
        let zero = Dual::constant(Interval::ZERO);
        let [x, y, z] = point;
        for (n, side) in point.into_iter().enumerate() {
            let row = [0, 1, 2].map(|m| f64::from(m == n));
            assert_eq!(x.scale_add(row[0], y.scale_add(row[1], z.scale_add(row[2], zero))), side);
        }
        let moved = x.scale_add(1.0, y.scale_add(0.0, Dual::constant(Interval::point(0.1))));
        assert_eq!((moved.v, moved.d), (x.v + 0.1, x.d));
    }

    #[test]
    fn what_underflows_is_rounded_to_normal_numbers() {
        let (small, huge) = (Interval::point(1e-200), Interval::point(1e200));
        let about = Interval::new(-1e-200, 1e-200);
        for found in [small * small, small * 1e-200, small / huge, small.square(), small.pow(2.0)] {
            assert!(found.lo() == 0.0 && found.hi() >= f64::MIN_POSITIVE, "{found:?}");
        }
        for found in [small * -small, small * -1e-200, -small / huge] {
            assert!(found.lo() <= -f64::MIN_POSITIVE && found.hi() == 0.0, "{found:?}");
        }
        for found in [about * small, small * about, about * about, about * 1e-200, about * -1e-200, about / huge] {
            assert!(found.lo() <= -f64::MIN_POSITIVE && found.hi() >= f64::MIN_POSITIVE, "{found:?}");
        }
        assert!(small.norm(Interval::ZERO, Norm::Euclid).contains(1e-200));
        let gone = Interval::point(-1e5).exp2();
        assert!(gone.lo() == 0.0 && gone.hi() >= f64::MIN_POSITIVE, "{gone:?}");
    }
}
