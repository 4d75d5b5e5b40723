//! How far single precision may be from the truth: a bound carried along the operations.
//!
//! For every operation, over a box: the range of the true value t, the range of what single
//! precision computes for it, c, and a bound e on |c − t|. With u = 2⁻²⁴ the error of one rounding,
//!
//! ```text
//!     x + y    e_x + e_y + u·|c|
//!     x · y    e_x·|c_y| + |t_x|·e_y + u·|c|
//!     √x       e_x / (√c_x + √t_x) + u·|c|,  at most √e_x
//!     min      max(e_x, e_y)
//!     sin x    e_x + 4u                      (and so on: the slope between c and t times e)
//! ```
//!
//! The root of a sum of squares deserves better than its terms say: its slope is unbounded at
//! 0, and yet ‖(a, b)‖ is off by no more than ‖(e_a, e_b)‖. So sums of squares
//! carry a bound on |√c − √t| beside e.
//!
//! A bound holds for what narrowing makes of a formula in a part of the box as well: all that it
//! does is to put an operand in the place of a minimum or so that it is equal to there, whose e is
//! no larger. So the copies of minima, maxima and absolute values are given room for t ± e, and
//! narrowed formulas share the bound of the one that they all come from.
//!
//! Where a step, a pole or a place where the value is undefined comes too near there is no
//! bound: it is infinite, and every sample is settled in double precision.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::Formula;
use super::arithmetic::Arithmetic;
use super::functions::single::LARGEST_ANGLE;
use super::sure::Sure;
use crate::{Interval, Real};

/// The relative error of one rounding to single precision, a little more than 2⁻²⁴.
const UNIT: f64 = 6e-8;

/// That of a function of single precision ([`functions`](super::functions)) or of the library.
const LIBRARY: f64 = 4.0 * UNIT;

/// Numbers below this may lose digits, or all: it is added to every error.
const UNDERFLOW: f64 = 1e-37;

/// What is known of a value and of its copy in single precision.
#[derive(Clone, Copy)]
struct Error {
    truth: Sure,
    seen: Sure,
    error: f64,
    /// Bounds |√seen − √truth|; infinite if nothing is known.
    root: f64,
}

impl Error {
    fn both(&self) -> Interval {
        self.truth.range.hull(self.seen.range)
    }

    /// Whether operation and operands are numbers for sure.
    fn is_sure(&self) -> bool {
        self.truth.sure && self.seen.sure
    }
}

/// A range of results after rounding to single precision; the sign stays.
fn rounded(value: Sure) -> Sure {
    let step = |x: f64, outward: f64| {
        let wide = x + outward * (2.0 * UNIT * x.abs() + UNDERFLOW);
        // Rounding does not cross 0.
        if wide * x <= 0.0 && x * outward < 0.0 { 0.0 } else { wide }
    };
    let (lo, hi) = (value.range.lo(), value.range.hi());
    let lo = if lo == 0.0 { 0.0 } else { step(lo, -1.0) };
    let hi = if hi == 0.0 { 0.0 } else { step(hi, 1.0) };
    let finite = lo >= -f64::from(f32::MAX) && hi <= f64::from(f32::MAX);
    Sure { range: Interval::new(lo, hi), sure: value.sure && finite }
}

/// The smallest absolute value in an interval.
fn least(range: Interval) -> f64 {
    range.abs().lo()
}

impl Arithmetic for Error {
    #[expect(clippy::cast_possible_truncation, reason = "the rounding is what is measured")]
    fn constant(c: f64) -> Error {
        let single = f64::from(c as f32);
        let error = (single - c).abs();
        let root = if c >= 0.0 { (single.sqrt() - c.sqrt()).abs() * 1.01 } else { f64::INFINITY };
        Error { truth: Sure::constant(c), seen: Sure::constant(single), error, root }
    }

    fn unary(op: UnaryOpcode, a: Error) -> Error {
        use UnaryOpcode as U;
        let truth = Sure::unary(op, a.truth);
        let seen = rounded(Sure::unary(op, a.seen));
        let e = a.error;
        let (both, size) = (a.both(), seen.range.magnitude());
        let one_piece = |f: fn(f64) -> f64| f(both.lo()) == f(both.hi());
        let mut root = f64::INFINITY;
        let error = match op {
            U::Neg | U::Abs => e,
            U::Recip => e / (least(a.seen.range) * least(a.truth.range)) + UNIT * size,
            U::Sqrt => {
                let slope = e / (a.seen.range.lo().max(0.0).sqrt() + a.truth.range.lo().max(0.0).sqrt());
                a.root.min(e.sqrt()).min(if slope.is_nan() { f64::INFINITY } else { slope }) + UNIT * size
            }
            U::Square => {
                root = e + UNIT * a.seen.range.magnitude() + UNDERFLOW.sqrt();
                e * (a.truth.range.magnitude() + a.seen.range.magnitude()) + UNIT * size
            }
            U::Floor if one_piece(f64::floor) => 0.0,
            U::Ceil if one_piece(f64::ceil) => 0.0,
            U::Round if one_piece(f64::round) => 0.0,
            U::Floor | U::Ceil | U::Round => e + 1.0,
            U::Sin | U::Cos if a.seen.range.magnitude() > LARGEST_ANGLE => 2.0,
            U::Sin | U::Cos => e.min(2.0) + LIBRARY,
            U::Tan => {
                let tangent = Sure::unary(U::Tan, Sure::new(both, true)).range.magnitude();
                e * (1.0 + tangent * tangent) + LIBRARY * size
            }
            U::Asin | U::Acos => {
                let steep = 1.0 - both.magnitude() * both.magnitude();
                if steep > 0.0 { e / steep.sqrt() + LIBRARY * 4.0 } else { f64::INFINITY }
            }
            U::Atan => e + LIBRARY * size,
            U::Exp => e * both.hi().exp() + LIBRARY * size,
            U::Ln if both.lo() > 0.0 => e / both.lo() + LIBRARY * size,
            U::Ln => f64::INFINITY,
            U::Not if !both.contains(0.0) => 0.0,
            U::Not | U::Rand => 1.0,
        };
        let whole = Error { truth, seen, error, root };
        if op == U::Abs { whole.or_operand() } else { whole }.checked(a.is_sure())
    }

    fn binary(op: BinaryOpcode, a: Error, b: Error) -> Error {
        use BinaryOpcode as B;
        let truth = Sure::binary(op, a.truth, b.truth);
        let seen = rounded(Sure::binary(op, a.seen, b.seen));
        let size = seen.range.magnitude();
        let mut root = f64::INFINITY;
        let error = match op {
            B::Add => {
                // The norm of two roots is off by no more than the norm of their errors.
                root = a.root.hypot(b.root) + UNIT * size.sqrt();
                a.error + b.error + UNIT * size
            }
            B::Sub => a.error + b.error + UNIT * size,
            B::Mul => a.error * b.seen.range.magnitude() + a.truth.range.magnitude() * b.error + UNIT * size,
            B::Div => (a.error + truth.range.magnitude() * b.error) / least(b.seen.range) + UNIT * size,
            B::Min | B::Max => {
                root = a.root.max(b.root);
                a.error.max(b.error)
            }
            B::Atan => {
                let (y, x) = (a.both(), b.both());
                if x.lo() <= 0.0 && y.contains(0.0) {
                    f64::INFINITY
                } else {
                    (a.error + b.error) / least(x).hypot(least(y)) + LIBRARY * 4.0
                }
            }
            B::Compare if seen.range == truth.range && seen.range.width() == 0.0 => 0.0,
            B::Compare => 2.0,
            B::Mod => b.both().magnitude(),
            B::And | B::Or => {
                let other = |first: bool| if first { a } else { b };
                if a.both().contains(0.0) {
                    let all = truth.range.hull(seen.range);
                    all.width()
                } else {
                    let kept = other(op == B::Or);
                    root = kept.root;
                    kept.error
                }
            }
            B::Mix => f64::INFINITY,
        };
        let whole = Error { truth, seen, error, root };
        let chooses = matches!(op, B::Min | B::Max | B::And | B::Or);
        if chooses { whole.or_operand() } else { whole }.checked(a.is_sure() && b.is_sure())
    }
}

impl Error {
    /// What an operand in the place of the operation may be computed to, where it is equal to it.
    fn or_operand(mut self) -> Error {
        self.seen.range = self.seen.range.hull(self.truth.range.inflate(self.error));
        self
    }

    /// No bound where anything is undefined; never more than the two ranges are apart.
    fn checked(mut self, operands: bool) -> Error {
        if !(operands && self.is_sure()) || self.error.is_nan() {
            self.error = f64::INFINITY;
            self.root = f64::INFINITY;
            return self;
        }
        // The sums of this analysis are themselves rounded.
        self.error = (self.error * (1.0 + 1e-12) + UNDERFLOW).min(self.both().width());
        self
    }
}

/// A bound that is taken from another formula is at most this part of the range of values: of
/// points in a thousand one is settled in double precision for nothing.
const SHARED: f64 = 1e-3;

impl Formula {
    /// The bound within `reach` of the origin, for coordinates that are off by up to 10⁻⁶ of it.
    pub(super) fn roundoff_within(&self, reach: f64) -> f64 {
        if !reach.is_finite() {
            return f64::INFINITY;
        }
        let shared = self.0.elder.as_ref().and_then(|elder| {
            let region = elder.0.region;
            let far = region.iter().fold(0.0f64, |far, side| far.max(side.magnitude()));
            let bound = *elder.0.roundoff.get_or_init(|| elder.bound_within(far));
            (reach <= far && bound <= SHARED * self.0.range.width()).then_some(bound)
        });
        shared.unwrap_or_else(|| self.bound_within(reach))
    }

    fn bound_within(&self, reach: f64) -> f64 {
        let off = 1e-6 * reach;
        let point = self.0.region.map(|region| {
            let truth = Interval::new(-reach, reach).narrowed_by(region);
            let sure = |range| Sure { range, sure: true };
            let seen = rounded(sure(truth.inflate(off)));
            Error { truth: sure(truth), seen, error: off, root: f64::INFINITY }
        });
        let value = self.0.code.plan().value(point, &mut Vec::new());
        if value.error.is_nan() { f64::INFINITY } else { value.error }
    }
}
