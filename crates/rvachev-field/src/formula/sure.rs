//! Ranges of formulas: intervals that know whether the value is defined.
//!
//! `√[−1, 1]` has the range [0, 1] where it has one. A minimum may be decided for one operand
//! only if the other is a number throughout, so the interval carries that along. A range
//! that is not finite counts as perhaps undefined: infinities breed NaN.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::{Arithmetic, Scalar};
use crate::{Interval, Real};

/// The range of a value, where it is a number; `sure` if it is one throughout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sure {
    pub(super) range: Interval,
    pub(super) sure: bool,
}

/// What may be anything, or not be at all.
const UNSURE: Sure = Sure { range: Interval::ALL, sure: false };

impl Sure {
    pub(super) fn new(range: Interval, sure: bool) -> Sure {
        Sure { range, sure: sure && range.lo() > f64::NEG_INFINITY && range.hi() < f64::INFINITY }
    }

    fn is(self, c: f64) -> bool {
        self.sure && self.range.lo() == c && self.range.hi() == c
    }

    /// Whether it is never 0. (What is undefined is not 0 either.)
    pub(super) fn excludes_zero(self) -> bool {
        !self.range.contains(0.0)
    }
}

/// `[lo, hi]` as library functions returned them, with their error on each side.
fn library(lo: f64, hi: f64) -> Interval {
    let wide = Interval::new(lo, hi);
    let size = wide.magnitude();
    // What is 0 may have underflowed.
    let error = (Interval::LIBRARY_ULPS * f64::EPSILON * size).max(Interval::TINY);
    if size.is_finite() { wide.inflate(error) } else { wide }
}

fn within(range: Interval, lo: f64, hi: f64) -> Interval {
    Interval::new(range.lo().clamp(lo, hi), range.hi().clamp(lo, hi))
}

/// The tangent: it rises between poles, which are at odd multiples of π/2.
fn tangent(a: Interval) -> Option<Interval> {
    use std::f64::consts::{FRAC_PI_2, PI};
    if a.magnitude().is_nan() || a.magnitude() > 1e9 {
        return None;
    }
    let margin = 1e-15 * (1.0 + a.magnitude());
    let turn = |x: f64| ((x + FRAC_PI_2) / PI).floor();
    (turn(a.lo() - margin) == turn(a.hi() + margin)).then(|| library(a.lo().tan(), a.hi().tan()))
}

/// A range of what is known not to be negative, or not to be positive: rounding outward does
/// not step over 0, where roots and choices change.
fn signed(range: Interval, nonneg: bool, nonpos: bool) -> Interval {
    let lo = if nonneg { range.lo().max(0.0) } else { range.lo() };
    let hi = if nonpos { range.hi().min(0.0) } else { range.hi() };
    if lo <= hi { Interval::new(lo, hi) } else { range }
}

/// The range of a product or quotient of `a` and `b`.
fn of_sign_of_product(range: Interval, a: Interval, b: Interval) -> Interval {
    let same = a.lo() >= 0.0 && b.lo() >= 0.0 || a.hi() <= 0.0 && b.hi() <= 0.0;
    let opposite = a.lo() >= 0.0 && b.hi() <= 0.0 || a.hi() <= 0.0 && b.lo() >= 0.0;
    signed(range, same, opposite)
}

fn quotient(a: Interval, b: Interval) -> Interval {
    // 0 has either sign as a divisor.
    if b.contains(0.0) { Interval::ALL } else { of_sign_of_product(a / b, a, b) }
}

/// The remainder, from 0 up to `|b|`: within one step of the quotient it is `a − |b|·steps`.
fn remainder(a: Sure, b: Sure) -> Interval {
    let (r, size) = (a.range, b.range.abs());
    let whole = Interval::new(0.0, size.hi());
    let quotient = r / size;
    // A quotient near a whole number may round to it.
    let margin = 1e-15 * (1.0 + quotient.magnitude());
    let steps = (quotient.lo() - margin).floor();
    if !(a.sure && b.sure && steps.is_finite() && steps == (quotient.hi() + margin).floor()) {
        return whole;
    }
    let exact = r - size * steps;
    exact.inflate(1e-15 * (r.magnitude() + size.hi())).narrowed_by(whole)
}

impl Arithmetic for Sure {
    #[inline(always)]
    fn constant(c: f64) -> Sure {
        Sure { range: Interval::point(c), sure: !c.is_nan() }
    }

    #[inline]
    fn unary(op: UnaryOpcode, a: Sure) -> Sure {
        use UnaryOpcode as U;
        let Sure { range: r, sure } = a;
        let (range, sure) = match op {
            U::Neg => (-r, sure),
            U::Abs => (r.abs(), sure),
            U::Recip => (quotient(Interval::point(1.0), r), sure),
            U::Sqrt => (r.sqrt(), sure && r.lo() >= 0.0),
            U::Square => (r.square(), sure),
            U::Floor => (Interval::new(r.lo().floor(), r.hi().floor()), sure),
            U::Ceil => (Interval::new(r.lo().ceil(), r.hi().ceil()), sure),
            U::Round => (Interval::new(r.lo().round(), r.hi().round()), sure),
            U::Sin => (r.sin_cos().0, sure),
            U::Cos => (r.sin_cos().1, sure),
            U::Tan => (tangent(r).unwrap_or(Interval::ALL), sure),
            U::Asin | U::Acos => {
                let held = within(r, -1.0, 1.0);
                let image = match op {
                    U::Asin => library(held.lo().asin(), held.hi().asin()),
                    _ => library(held.lo().acos(), held.hi().acos()),
                };
                (image, sure && r.lo() >= -1.0 && r.hi() <= 1.0)
            }
            U::Atan => (library(r.lo().atan(), r.hi().atan()), sure),
            U::Exp => {
                let image = library(r.lo().exp(), r.hi().exp());
                (Interval::new(image.lo().max(0.0), image.hi()), sure)
            }
            U::Ln => (library(r.lo().max(0.0).ln(), r.hi().max(0.0).ln()), sure && r.lo() > 0.0),
            U::Not if a.excludes_zero() => (Interval::point(0.0), sure),
            U::Not if a.is(0.0) => (Interval::point(1.0), sure),
            U::Not | U::Rand => (Interval::new(0.0, 1.0), sure),
        };
        Sure::new(range, sure)
    }

    #[inline]
    fn binary(op: BinaryOpcode, a: Sure, b: Sure) -> Sure {
        use BinaryOpcode as B;
        let (r, s) = (a.range, b.range);
        let sure = a.sure && b.sure;
        let (range, sure) = match op {
            B::Add => (signed(r + s, r.lo() >= 0.0 && s.lo() >= 0.0, r.hi() <= 0.0 && s.hi() <= 0.0), sure),
            B::Sub => (signed(r - s, r.lo() >= s.hi(), r.hi() <= s.lo()), sure),
            B::Mul => (of_sign_of_product(r * s, r, s), sure),
            B::Div => (quotient(r, s), sure),
            B::Atan => (r.atan2(s), sure),
            B::Min => (r.min(s), sure),
            B::Max => (r.max(s), sure),
            B::Compare if r.lo() > s.hi() => (Interval::point(1.0), sure),
            B::Compare if r.hi() < s.lo() => (Interval::point(-1.0), sure),
            B::Compare if sure && r.width() == 0.0 && r == s => (Interval::point(0.0), sure),
            B::Compare => (Interval::new(-1.0, 1.0), sure),
            B::Mod => (remainder(a, b), sure && b.excludes_zero()),
            B::And if a.excludes_zero() => (s, sure),
            B::And if a.is(0.0) => (r, true),
            B::And => (s.hull(Interval::point(0.0)), sure),
            B::Or if a.excludes_zero() => (r, a.sure),
            B::Or if a.is(0.0) => (s, b.sure),
            B::Or => (r.hull(s), sure),
            B::Mix => (Interval::ALL, false),
        };
        Sure::new(range, sure)
    }
}

impl Scalar for Sure {
    fn select(self, nonneg: Sure, neg: Sure) -> Sure {
        if !self.sure {
            return hull(nonneg, neg);
        }
        // At the kink itself either side counts.
        if self.range.lo() > 0.0 {
            nonneg
        } else if self.range.hi() < 0.0 {
            neg
        } else {
            hull(nonneg, neg)
        }
    }

    fn if_zero(self, zero: Sure, other: Sure) -> Sure {
        // An undecided choice may jump.
        if self.is(0.0) {
            zero
        } else if self.sure && self.excludes_zero() {
            other
        } else {
            UNSURE
        }
    }

    fn flat(self) -> Sure {
        if self.sure && self.range.width() == 0.0 { Sure::constant(0.0) } else { UNSURE }
    }

    fn off_the_cut(slope: Sure, y: Sure, x: Sure) -> Sure {
        if y.range.contains(0.0) && x.range.lo() <= 0.0 { UNSURE } else { slope }
    }

    #[inline(always)]
    fn vanishes(self) -> bool {
        self.is(0.0)
    }
}

fn hull(a: Sure, b: Sure) -> Sure {
    Sure::new(a.range.hull(b.range), a.sure && b.sure)
}
