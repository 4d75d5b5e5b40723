//! Ranges over many boxes at once, operation by operation.
//!
//! The parts that a box is divided into are asked for one after the other. To walk the operations
//! once for all of them costs little more than to walk them for one: what an operation is is looked
//! up once, and its two ends for all boxes are loops that the compiler makes vectors of.
//!
//! ```text
//!     operation        box 0    box 1    box 2  ..         One walk in place of sixteen; at a min
//!     r₃ = r₁ − r₂     [a, b]   [a, b]   [a, b]            or max a bit for every box in which one
//!     r₁ = min r₃, r₂  [a, b]   [a, b]   [a, b]            of the operands is the result.
//! ```
//!
//! Only finite ranges of what is defined throughout are dealt with here; a box in which anything else
//! turns up is *lost*, and walked by itself with [`Sure`]. Ends are moved outward by between one and
//! two units in the last place, which covers the rounding to nearest of one operation:
//! with s = fl(e), `|s − e| ≤ 2⁻⁵³·|s| + 2⁻¹⁰⁷⁵ < 2⁻⁵²·|s| + 2⁻¹⁰²²`, and what is subtracted from s
//! is at least the next float away.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::{Arithmetic, each_binary, each_unary};
use super::code::{Code, Op};
use super::plan::{Plan, Slot, Source, Step};
use super::sure::Sure;
use crate::Interval;
use crate::num::kernel::{Task, dispatched};

/// So many boxes are walked at once.
pub(crate) const BOXES: usize = 16;

/// The ranges of one value in all boxes.
#[derive(Clone, Copy)]
struct Many {
    lo: [f64; BOXES],
    hi: [f64; BOXES],
}

/// In which boxes, a bit each, the first and the second operand of an operation is its result.
pub(super) type Choice = [u16; 2];

/// A walk over up to [`BOXES`] boxes: its ranges and choices.
pub(super) struct Survey {
    /// Which code was walked; that of no code if none was.
    number: u64,
    /// The plan of a code that has none, and the operations of one that has nothing else.
    plan: Plan,
    ops: Vec<Op>,
    boxes: Vec<[Interval; 3]>,
    registers: Vec<Many>,
    /// By operation.
    choices: Vec<Choice>,
    value: Many,
    lost: [bool; BOXES],
    live: Live,
}

/// What narrowing leaves of the operations, in all boxes at once.
struct Live {
    /// Whether it is up to date.
    known: bool,
    uses: Vec<Uses>,
    /// The operations that are needed in each box, the last one first.
    needed: [Vec<Needed>; BOXES],
    /// How many of them are left in each box, and how many of these are no axes or constants.
    left: [[usize; BOXES]; 2],
    /// Where operations have gone to in one box.
    moved: Vec<Moved>,
    /// Registers that are free there.
    free: Vec<u32>,
}

/// How an operation is used, a bit for every box.
#[derive(Clone, Copy, Default)]
struct Uses {
    /// Where anything needs it.
    some: u16,
    /// Where it is the last to need its first and its second operand as such.
    last: [u16; 2],
    /// Where it is not known what needs it last: something does as such, and something as the result of an
    /// operation that it is equal to.
    unclear: u16,
}

/// An operation that is needed in a box, be it for the operand that it is equal to there.
#[derive(Clone, Copy)]
enum Needed {
    Itself(u32),
    First(u32),
    Second(u32),
}

/// Where the value of an operation is.
#[derive(Clone, Copy)]
struct Moved {
    slot: Slot,
    /// Whether its register is never free again.
    held: bool,
}

impl Survey {
    pub(super) const fn new() -> Survey {
        Survey {
            number: u64::MAX,
            plan: Plan::EMPTY,
            ops: Vec::new(),
            boxes: Vec::new(),
            registers: Vec::new(),
            choices: Vec::new(),
            value: Many::ZERO,
            lost: [true; BOXES],
            live: Live {
                known: false,
                uses: Vec::new(),
                needed: [const { Vec::new() }; BOXES],
                left: [[0; BOXES]; 2],
                moved: Vec::new(),
                free: Vec::new(),
            },
        }
    }

    /// Walks over `boxes`, of which as many as there is room for are looked at.
    pub(super) fn walk(&mut self, code: &Code, boxes: impl Iterator<Item = [Interval; 3]>) {
        self.boxes.clear();
        self.boxes.extend(boxes.take(BOXES));
        let Some(&last) = self.boxes.last() else { return };
        let at = |lane: usize| self.boxes.get(lane).copied().unwrap_or(last);
        let mut axes = [Many::ZERO; 3];
        for lane in 0..BOXES {
            for (axis, side) in at(lane).into_iter().enumerate() {
                (axes[axis].lo[lane], axes[axis].hi[lane]) = (side.lo(), side.hi());
            }
        }
        let plan = code.known_plan().unwrap_or_else(|| {
            self.plan.make(code.ops());
            &self.plan
        });
        if code.known_ops().is_none() {
            plan.list(&mut self.ops);
        }
        let ops = code.known_ops().unwrap_or(&self.ops);
        self.number = code.number;
        self.registers.resize(self.registers.len().max(plan.registers), Many::ZERO);
        self.choices.clear();
        self.choices.resize(ops.len(), [0; 2]);
        // Minima would lose a constant that is no number.
        let mut doubt = [plan.constants().iter().map(|c| c - c).sum(); BOXES];
        for axis in &axes {
            axis.test(&mut doubt);
        }
        let (registers, choices) = (&mut self.registers[..], &mut self.choices[..]);
        let walk = Walk { ops, plan, axes: &axes, registers, choices, value: &mut self.value, doubt: &mut doubt };
        dispatched(walk);
        self.value.test(&mut doubt);
        self.lost = doubt.map(|doubt| doubt != 0.0);
        self.live.known = false;
    }

    /// The lane of a box that the code was walked over.
    pub(super) fn lane(&self, code: &Code, hull: &[Interval; 3]) -> Option<usize> {
        if self.number != code.number {
            return None;
        }
        self.boxes.iter().position(|own| own == hull).filter(|&lane| !self.lost[lane])
    }

    /// The range of the value in a lane: it is defined throughout.
    pub(super) fn range(&self, lane: usize) -> Sure {
        Sure { range: Interval::new(self.value.lo[lane], self.value.hi[lane]), sure: true }
    }

    /// The plan of the operations that are left in a lane, if they are at most `most`, and how many they are.
    pub(super) fn narrowed(&mut self, code: &Code, lane: usize, most: usize) -> Option<(Plan, usize)> {
        let ops = code.known_ops().unwrap_or(&self.ops);
        if !self.live.known {
            self.live.find(ops, &self.choices);
        }
        let Live { uses, needed, left: [left, steps], moved, free, .. } = &mut self.live;
        if left[lane] > most {
            return None;
        }
        let mut plan = Plan::with_room(steps[lane], left[lane] - steps[lane]);
        free.clear();
        for &needed in needed[lane].iter().rev() {
            let (Needed::Itself(at) | Needed::First(at) | Needed::Second(at)) = needed;
            let op = ops[at as usize];
            let Uses { last, unclear, .. } = uses[at as usize];
            let held = unclear >> lane & 1 == 1;
            if let (Needed::First(_), Op::Unary(_, operand) | Op::Binary(_, operand, _))
            | (Needed::Second(_), Op::Binary(_, _, operand)) = (needed, op)
            {
                let stand_in = moved[operand as usize];
                moved[at as usize] = Moved { held: stand_in.held || held, ..stand_in };
                continue;
            }
            let ends = |number: usize, of: Moved| last[number] >> lane & 1 == 1 && !of.held;
            let (operands, ends) = match op {
                Op::Axis(_) | Op::Const(_) => ([Slot::NONE; 2], [false; 2]),
                Op::Unary(_, a) => {
                    let a = moved[a as usize];
                    ([a.slot; 2], [ends(0, a), false])
                }
                Op::Binary(_, a, b) => {
                    let (a, b) = (moved[a as usize], moved[b as usize]);
                    ([a.slot, b.slot], [ends(0, a), ends(1, b)])
                }
            };
            moved[at as usize] = Moved { slot: plan.add(op, operands, ends, free), held };
        }
        Some((plan, left[lane]))
    }
}

/// Calls `visit` with the numbers of the bits that are set.
#[inline(always)]
fn bits(mut all: u16, mut visit: impl FnMut(usize)) {
    while all != 0 {
        visit(all.trailing_zeros() as usize);
        all &= all - 1;
    }
}

impl Live {
    /// Backwards from the value: what is needed for it.
    fn find(&mut self, ops: &[Op], choices: &[Choice]) {
        let Live { known, uses, needed, left, moved, .. } = self;
        *known = true;
        *left = [[0; BOXES]; 2];
        uses.clear();
        uses.resize(ops.len(), Uses::default());
        needed.iter_mut().for_each(Vec::clear);
        moved.resize(moved.len().max(ops.len()), Moved { slot: Slot::NONE, held: false });
        if let Some(value) = uses.last_mut() {
            value.some = u16::MAX;
        }
        for (at, op) in ops.iter().enumerate().rev() {
            let here = uses[at].some;
            if here == 0 {
                continue;
            }
            let [first, second] = choices[at].map(|boxes| boxes & here);
            let itself = here & !(first | second);
            // Operands that are needed by the operation as such, and those that it is equal to.
            let mut operand = |number: usize, operand: u32, equal: u16| {
                let used = &mut uses[operand as usize];
                let last = itself & !used.some;
                used.unclear |= equal & used.some;
                used.some |= itself | equal;
                uses[at].last[number] = last;
            };
            match *op {
                Op::Unary(_, a) => operand(0, a, first),
                Op::Binary(_, a, b) => {
                    operand(0, a, first);
                    operand(1, b, second);
                }
                Op::Axis(_) | Op::Const(_) => {}
            }
            let is_step = usize::from(!matches!(op, Op::Axis(_) | Op::Const(_)));
            let at = at as u32;
            bits(first, |lane| needed[lane].push(Needed::First(at)));
            bits(second, |lane| needed[lane].push(Needed::Second(at)));
            bits(itself, |lane| {
                needed[lane].push(Needed::Itself(at));
                left[0][lane] += 1;
                left[1][lane] += is_step;
            });
        }
    }
}

impl Many {
    const ZERO: Many = Many { lo: [0.0; BOXES], hi: [0.0; BOXES] };

    fn constant(&mut self, c: f64) {
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

    /// Makes doubtful the lanes whose ends are not finite: what is no number stays none in a sum.
    #[inline(always)]
    fn test(&self, doubt: &mut Doubt) {
        for i in 0..BOXES {
            doubt[i] += (self.lo[i] - self.lo[i]) + (self.hi[i] - self.hi[i]);
        }
    }
}

/// By how much the end of a range is moved outward.
#[inline(always)]
fn step(x: f64) -> f64 {
    x.abs() * f64::EPSILON + f64::MIN_POSITIVE
}

#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
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

struct Walk<'a> {
    ops: &'a [Op],
    plan: &'a Plan,
    axes: &'a [Many; 3],
    registers: &'a mut [Many],
    choices: &'a mut [Choice],
    value: &'a mut Many,
    doubt: &'a mut Doubt,
}

impl Task for Walk<'_> {
    #[inline(always)]
    fn run(self) {
        let Walk { ops, plan, axes, registers, choices, value, doubt } = self;
        let mut constants = [Many::ZERO; 2];
        let mut steps = plan.steps.iter();
        for (at, op) in ops.iter().enumerate() {
            if matches!(op, Op::Axis(_) | Op::Const(_)) {
                continue;
            }
            let Some(&step) = steps.next() else { break };
            let (Step::Unary(.., to) | Step::Binary(.., to)) = step;
            // No operand is in the register of the result.
            let (before, rest) = registers.split_at_mut(to as usize);
            let [result, after @ ..] = rest else { continue };
            let registers = [&*before, &*after];
            let [first, second] = &mut constants;
            match step {
                Step::Unary(op, a, _) => {
                    let a = operand(plan.source(a), axes, registers, first);
                    each_unary!(op, OP => unary(OP, a, result, &mut choices[at], doubt));
                }
                Step::Binary(op, a, b, _) => {
                    let a = operand(plan.source(a), axes, registers, first);
                    let b = operand(plan.source(b), axes, registers, second);
                    each_binary!(op, OP => binary(OP, [a, b], result, &mut choices[at], doubt));
                }
            }
        }
        *value = *operand(plan.result(), axes, [registers, &[]], &mut constants[0]);
    }
}

#[inline(always)]
fn operand<'a>(
    source: Source,
    axes: &'a [Many; 3],
    [before, after]: [&'a [Many]; 2],
    constant: &'a mut Many,
) -> &'a Many {
    match source {
        Source::Axis(axis) => &axes[usize::from(axis)],
        Source::Const(c) => {
            constant.constant(c);
            constant
        }
        Source::Register(number) => {
            let number = number as usize;
            if number < before.len() { &before[number] } else { &after[number - before.len() - 1] }
        }
    }
}

/// Calls `each` for every lane with the ends of its operand; the ends that it gives are the result's.
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

/// The lanes where `a ≥ b`; those of 0 and −0 may be left out. Written so that the compiler makes vectors of
/// it: the sign of the difference, spread over a word, leaves a bit of it.
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
type Doubt = [f64; BOXES];

#[inline(always)]
fn unary(op: UnaryOpcode, a: &Many, result: &mut Many, choice: &mut Choice, doubt: &mut Doubt) {
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
fn binary(
    op: BinaryOpcode,
    [a, b]: [&Many; 2],
    result: &mut Many,
    choice: &mut Choice,
    doubt: &mut Doubt,
) {
    use BinaryOpcode as B;
    match op {
        B::Add => join(a, b, result, |[p, q], [r, s]| {
            signed(p + r, q + s, (p >= 0.0) & (r >= 0.0), (q <= 0.0) & (s <= 0.0))
        }),
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
