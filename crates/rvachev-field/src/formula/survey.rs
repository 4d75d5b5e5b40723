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
//! Only finite ranges of what is defined throughout are dealt with here; a box in which anything
//! else turns up is *lost*, and walked by itself with [`Sure`].

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::{each_binary, each_unary};
use super::code::Code;
use super::live::Live;
use super::many::{Choice, Doubt, Many, binary, unary};
use super::op::Op;
use super::plan::{Plan, Source, Step};
use super::sure::Sure;
use crate::kernel::{Task, dispatched};
use crate::{BOXES, Interval};

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
            live: Live::new(),
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
        let mut doubt = [plan.constants().iter().map(|c| c * 0.0).sum(); BOXES];
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

    /// The plan of the operations that are left in a lane, if they are at most `most`, and how many
    /// they are.
    pub(super) fn narrowed(&mut self, code: &Code, lane: usize, most: usize) -> Option<(Plan, usize)> {
        let ops = code.known_ops().unwrap_or(&self.ops);
        if !self.live.known {
            self.live.find(ops, &self.choices);
        }
        self.live.plan(ops, lane, most)
    }
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
