//! Sixteen ranges at once, and what every operation does to them.
//!
//! Only finite ranges of what is defined throughout are dealt with; a lane in which anything else
//! turns up becomes doubtful. Ends are moved outward by between one and two units in the last
//! place, which covers the rounding to nearest of one operation: with s = fl(e),
//! `|s − e| ≤ 2⁻⁵³·|s| + 2⁻¹⁰⁷⁵ < 2⁻⁵²·|s| + 10⁻²⁷⁰`, and what is subtracted from s is at least the
//! next float away.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::Arithmetic;
use super::sure::Sure;
use crate::{BOXES, Interval};
use rvachev_num::{least, most};

/// The ranges of one value in all boxes.
#[derive(Clone, Copy)]
pub(super) struct Many {
    pub(super) lo: [f64; BOXES],
    pub(super) hi: [f64; BOXES],
}

/// In which boxes, a bit each, the first and the second operand of an operation is its result.
pub(super) type Choice = [u16; 2];

impl Many {
    pub(super) const ZERO: Many = Many { lo: [0.0; BOXES], hi: [0.0; BOXES] };

    pub(super) fn constant(&mut self, c: f64) {
        (self.lo, self.hi) = ([c; BOXES], [c; BOXES]);
    }

    fn sure(&self, lane: usize) -> Sure {
        Sure { range: Interval::new(self.lo[lane], self.hi[lane]), sure: true }
    }

    /// Lanes that are not known to be finite numbers.
    fn put(&mut self, lane: usize, value: Sure) {
        let lost = |end: f64| if value.sure { end } else { f64::NAN };
        (self.lo[lane], self.hi[lane]) = (lost(value.range.lo()), lost(value.range.hi()));
    }

    /// Makes doubtful the lanes whose ends are not finite: 0 times them is no number, nor is a sum
    /// with that.
    #[inline(always)]
    pub(super) fn test(&self, doubt: &mut Doubt) {
        for (doubt, (lo, hi)) in doubt.iter_mut().zip(self.lo.iter().zip(&self.hi)) {
            *doubt += lo * 0.0 + hi * 0.0;
        }
    }
}

/// By how much the end of a range is moved outward.
#[inline(always)]
fn step(x: f64) -> f64 {
    x.abs() * f64::EPSILON + Interval::TINY
}

/// Ends rounded outward, though not across 0 where the sign is known: roots and choices change
/// there.
#[inline(always)]
fn signed(lo: f64, hi: f64, nonneg: bool, nonpos: bool) -> (f64, f64) {
    let (lo, hi) = (lo - step(lo), hi + step(hi));
    (if nonneg && lo < 0.0 { 0.0 } else { lo }, if nonpos && hi > 0.0 { 0.0 } else { hi })
}

/// The range of a product, or of a quotient, whose ends are among those of `all`.
#[inline(always)]
fn product(all: [f64; 4], [p, q]: [f64; 2], [r, s]: [f64; 2]) -> (f64, f64) {
    let lo = least(least(all[0], all[1]), least(all[2], all[3]));
    let hi = most(most(all[0], all[1]), most(all[2], all[3]));
    let same = (p >= 0.0) & (r >= 0.0) | (q <= 0.0) & (s <= 0.0);
    let opposite = (p >= 0.0) & (s <= 0.0) | (q <= 0.0) & (r >= 0.0);
    signed(lo, hi, same, opposite)
}

/// Calls `each` for every lane with the ends of its operand; the ends that it gives are the
/// result's.
#[inline(always)]
fn map(a: &Many, result: &mut Many, each: impl Fn(f64, f64) -> (f64, f64)) {
    for i in 0..BOXES {
        (result.lo[i], result.hi[i]) = each(a.lo[i], a.hi[i]);
    }
}

/// The same with two operands.
#[inline(always)]
fn join(a: &Many, b: &Many, result: &mut Many, each: impl Fn([f64; 2], [f64; 2]) -> (f64, f64)) {
    for i in 0..BOXES {
        (result.lo[i], result.hi[i]) = each([a.lo[i], a.hi[i]], [b.lo[i], b.hi[i]]);
    }
}

/// The lanes where `a ≥ b`; those of 0 and −0 may be left out. Written so that the compiler makes
/// vectors of it: the sign of the difference, spread over a word, leaves a bit of it.
#[inline(always)]
fn at_least(a: &[f64; BOXES], b: &[f64; BOXES]) -> u16 {
    const BITS: [u64; BOXES] = {
        let mut bits = [0; BOXES];
        let mut lane = 0;
        while lane < BOXES {
            bits[lane] = 1 << lane;
            lane += 1;
        }
        bits
    };
    let mut below = 0;
    for i in 0..BOXES {
        below |= ((a[i] - b[i]).to_bits().cast_signed() >> 63).cast_unsigned() & BITS[i];
    }
    !(below as u16)
}

/// Adds up what no number comes of.
pub(super) type Doubt = [f64; BOXES];

#[inline(always)]
pub(super) fn unary(op: UnaryOpcode, a: &Many, result: &mut Many, choice: &mut Choice, doubt: &mut Doubt) {
    use UnaryOpcode as U;
    match op {
        U::Neg => return map(a, result, |lo, hi| (-hi, -lo)),
        U::Abs => {
            *choice = [at_least(&a.lo, &Many::ZERO.lo), 0];
            return map(a, result, |lo, hi| (most(most(lo, -hi), 0.0), most(-lo, hi)));
        }
        U::Square => map(a, result, |lo, hi| {
            let (lo, hi) = (most(most(lo, -hi), 0.0), most(-lo, hi));
            signed(lo * lo, hi * hi, true, false)
        }),
        // The root of what is below 0 is no number.
        U::Sqrt => map(a, result, |lo, hi| signed(lo.sqrt(), hi.sqrt(), true, false)),
        _ => {
            for lane in 0..BOXES {
                result.put(lane, Sure::unary(op, a.sure(lane)));
            }
        }
    }
    result.test(doubt);
}

#[inline(always)]
pub(super) fn binary(op: BinaryOpcode, [a, b]: [&Many; 2], result: &mut Many, choice: &mut Choice, doubt: &mut Doubt) {
    use BinaryOpcode as B;
    match op {
        B::Add => {
            join(a, b, result, |[p, q], [r, s]| signed(p + r, q + s, (p >= 0.0) & (r >= 0.0), (q <= 0.0) & (s <= 0.0)))
        }
        B::Sub => join(a, b, result, |[p, q], [r, s]| signed(p - s, q - r, p >= s, q <= r)),
        B::Mul => join(a, b, result, |[p, q], [r, s]| product([p * r, p * s, q * r, q * s], [p, q], [r, s])),
        B::Div => join(a, b, result, |[p, q], [r, s]| {
            let (lo, hi) = product([p / r, p / s, q / r, q / s], [p, q], [r, s]);
            // By what may be 0 nothing is divided.
            if (r > 0.0) | (s < 0.0) { (lo, hi) } else { (f64::NAN, f64::NAN) }
        }),
        B::Min => {
            let first = at_least(&b.lo, &a.hi);
            *choice = [first, at_least(&a.lo, &b.hi) & !first];
            return join(a, b, result, |[p, q], [r, s]| (least(p, r), least(q, s)));
        }
        B::Max => {
            let first = at_least(&a.lo, &b.hi);
            *choice = [first, at_least(&b.lo, &a.hi) & !first];
            return join(a, b, result, |[p, q], [r, s]| (most(p, r), most(q, s)));
        }
        _ => {
            for lane in 0..BOXES {
                result.put(lane, Sure::binary(op, a.sure(lane), b.sure(lane)));
            }
            let is_other = |lane: usize| a.lo[lane] > 0.0 || a.hi[lane] < 0.0;
            let other = (0..BOXES).fold(0, |all, lane| all | u16::from(is_other(lane)) << lane);
            *choice = match op {
                B::And => [0, other],
                B::Or => [other, 0],
                _ => [0; 2],
            };
        }
    }
    result.test(doubt);
}
