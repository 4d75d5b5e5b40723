//! What narrowing leaves of a formula's operations, in many boxes at once.
//!
//! ```text
//!     operation            needed in the boxes     Backwards from the value: an operation that is needed
//!     r₃ = min r₁, r₂      1111                    needs its operands, or in boxes where it is equal to
//!     r₂ = …               1101                    one of them that one. Then forwards in one box: what is
//!     r₁ = …               0111                    needed there gets registers, and is a plan.
//! ```
//!
//! A register is free after the last operation that needs its value. Backwards that is the first
//! one that is met, unless the value also stands in for operations that are equal to it, which
//! others need: its register is then held to the end.

use super::many::Choice;
use super::op::Op;
use super::plan::{Plan, Slot};
use crate::BOXES;

/// What narrowing leaves of the operations, in all boxes at once.
pub(super) struct Live {
    /// Whether it is up to date.
    pub(super) known: bool,
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
    /// Where it is not known what needs it last: something does as such, and something as the
    /// result of an operation that it is equal to.
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

/// Calls `visit` with the numbers of the bits that are set.
#[inline(always)]
fn bits(mut all: u16, mut visit: impl FnMut(usize)) {
    while all != 0 {
        visit(all.trailing_zeros() as usize);
        all &= all - 1;
    }
}

impl Live {
    pub(super) const fn new() -> Live {
        Live {
            known: false,
            uses: Vec::new(),
            needed: [const { Vec::new() }; BOXES],
            left: [[0; BOXES]; 2],
            moved: Vec::new(),
            free: Vec::new(),
        }
    }

    /// Backwards from the value: what is needed for it.
    pub(super) fn find(&mut self, ops: &[Op], choices: &[Choice]) {
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

    /// The plan of what is left in a box, if that is at most `most` operations, and how many they
    /// are.
    pub(super) fn plan(&mut self, ops: &[Op], lane: usize, most: usize) -> Option<(Plan, usize)> {
        let Live { uses, needed, left: [left, steps], moved, free, .. } = self;
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
