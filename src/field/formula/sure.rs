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
    if size.is_finite() { wide.inflate(Interval::LIBRARY_ULPS * f64::EPSILON * size) } else { wide }
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

impl Arithmetic for Sure {
    fn constant(c: f64) -> Sure {
        Sure { range: Interval::point(c), sure: !c.is_nan() }
    }

    fn unary(op: UnaryOpcode, a: Sure) -> Sure {
        use UnaryOpcode as U;
        let Sure { range: r, sure } = a;
        let (range, sure) = match op {
            U::Neg => (-r, sure),
            U::Abs => (r.abs(), sure),
            U::Recip => (Interval::point(1.0) / r, sure),
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

    fn binary(op: BinaryOpcode, a: Sure, b: Sure) -> Sure {
        use BinaryOpcode as B;
        let (r, s) = (a.range, b.range);
        let sure = a.sure && b.sure;
        let (range, sure) = match op {
            B::Add => (r + s, sure),
            B::Sub => (r - s, sure),
            B::Mul => (r * s, sure),
            B::Div => (r / s, sure),
            B::Atan => (r.atan2(s), sure),
            B::Min => (r.min(s), sure),
            B::Max => (r.max(s), sure),
            B::Compare if r.lo() > s.hi() => (Interval::point(1.0), sure),
            B::Compare if r.hi() < s.lo() => (Interval::point(-1.0), sure),
            B::Compare if sure && r.width() == 0.0 && r == s => (Interval::point(0.0), sure),
            B::Compare => (Interval::new(-1.0, 1.0), sure),
            B::Mod => {
                let turns = Sure::unary(UnaryOpcode::Floor, Sure::new(r / s, sure));
                let size = s.magnitude();
                let whole = Interval::new(0.0, size);
                let range = if turns.sure && turns.range.width() == 0.0 {
                    // What rounding may put on the other side of a step is still in the whole.
                    let exact = (r - s * turns.range).inflate(1e-15 * (r.magnitude() + size));
                    exact.narrowed_by(whole)
                } else {
                    whole
                };
                // A quotient near a whole number may round to it.
                let near_step = turns.range.width() == 0.0 && {
                    let quotient = r / s;
                    let margin = 1e-15 * (1.0 + quotient.magnitude());
                    (quotient.lo() - margin).floor() != (quotient.hi() + margin).floor()
                };
                (if near_step { whole } else { range }, sure && b.excludes_zero())
            }
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

    fn vanishes(self) -> bool {
        self.is(0.0)
    }
}

fn hull(a: Sure, b: Sure) -> Sure {
    Sure::new(a.range.hull(b.range), a.sure && b.sure)
}
