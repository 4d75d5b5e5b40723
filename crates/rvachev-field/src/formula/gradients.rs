//! Values and gradients of formulas over chunks of points.
//!
//! As for values, every operation is a loop over the chunk; so is the derivative of its result
//! along each axis that it depends on. Most parts of most formulas depend on one or two.

use std::cell::RefCell;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::Formula;
use super::arithmetic::{Arithmetic, Float, each_binary, each_unary};
use super::bulk::{self, SINGLE};
use super::plan::{Plan, Source, Step};
use super::slope::Slope;
use crate::Real;
use crate::kernel::{self, CHUNK, Task, dispatched};
use crate::{Chunk, Placement};

/// Steeper derivatives are of no use as a direction, and their squares would overflow.
pub(super) const STEEPEST: f32 = 1e15;

/// A value and its derivatives; only those along the axes of `moves`, a bit each, are not 0.
#[derive(Default)]
struct Register {
    value: Vec<f32>,
    slopes: [Vec<f32>; 3],
    moves: u8,
}

/// What a thread needs.
struct Scratch {
    registers: Vec<Register>,
    constants: [[f32; CHUNK]; 2],
    turned: [[f32; CHUNK]; 3],
}

thread_local! {
    static SCRATCH: RefCell<Scratch> =
        const { RefCell::new(Scratch { registers: Vec::new(), constants: [[0.0; CHUNK]; 2], turned: [[0.0; CHUNK]; 3] }) };
}

const ZEROS: [f32; CHUNK] = [0.0; CHUNK];
const ONES: [f32; CHUNK] = [1.0; CHUNK];

pub(super) fn gradients(formula: &Formula, chunk: Chunk<'_, f32, 4>) {
    let plan = formula.0.code.plan();
    let Chunk { points, placement, out: [value, dx, dy, dz] } = chunk;
    let len = value.len();
    SINGLE.with_borrow_mut(|single| {
        single.place(points, placement);
        SCRATCH.with_borrow_mut(|Scratch { registers, constants, turned }| {
            registers.resize_with(plan.registers.max(registers.len()), Register::default);
            for register in &mut registers[..plan.registers] {
                register.value.resize(len, 0.0);
                register.slopes.iter_mut().for_each(|slope| slope.resize(len, 0.0));
            }
            let points = single.points();
            dispatched(Differentiate { plan, points, registers, constants });
            let [constant, _] = constants;
            let all = operand(plan.result(), points, [registers, &[]], constant);
            value.copy_from_slice(all.value);
            let turned = &mut *turned;
            for (slopes, turned) in all.slopes.into_iter().zip(&mut *turned) {
                dispatched(Turn { value, slopes, turned: &mut turned[..len], scale: f32::narrow(placement.scale) });
            }
            let turned = turned.each_ref().map(|slopes| &slopes[..len]);
            kernel::run(&Pull(placement), turned, [dx, dy, dz]);
        });
    });
    bulk::finish(value, placement);
}

/// Derivatives of the solid from those of the formula.
struct Turn<'a> {
    value: &'a [f32],
    slopes: &'a [f32],
    turned: &'a mut [f32],
    scale: f32,
}

impl Task for Turn<'_> {
    #[inline(always)]
    fn run(self) {
        let len = self.turned.len();
        let (value, slopes) = (&self.value[..len], &self.slopes[..len]);
        for i in 0..len {
            let held = (-slopes[i]).clamp(-STEEPEST, STEEPEST);
            let defined = !(value[i].is_nan() || slopes[i].is_nan());
            self.turned[i] = if defined { held * self.scale } else { 0.0 };
        }
    }
}

/// Derivatives in the frame of the points.
struct Pull<'a>(&'a Placement);

impl kernel::Formula<3, 3> for Pull<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, d: [R; 3]) -> [R; 3] {
        self.0.pull(d)
    }
}

struct Differentiate<'a> {
    plan: &'a Plan,
    points: [&'a [f32]; 3],
    registers: &'a mut [Register],
    constants: &'a mut [[f32; CHUNK]; 2],
}

/// An operand of a chunk.
struct Operand<'a> {
    value: &'a [f32],
    slopes: [&'a [f32]; 3],
    moves: u8,
}

/// An operand of the operation whose result is in the register between those `before` and `after`.
#[inline(always)]
fn operand<'a>(
    source: Source,
    points: [&'a [f32]; 3],
    [before, after]: [&'a [Register]; 2],
    constant: &'a mut [f32; CHUNK],
) -> Operand<'a> {
    let len = points[0].len();
    match source {
        Source::Axis(number) => {
            let unit = |axis| if axis == usize::from(number) { &ONES[..len] } else { &ZEROS[..len] };
            Operand { value: points[usize::from(number)], slopes: [unit(0), unit(1), unit(2)], moves: 1 << number }
        }
        Source::Const(c) => {
            constant[..len].fill(f32::narrow(c));
            Operand { value: &constant[..len], slopes: [&ZEROS[..len]; 3], moves: 0 }
        }
        Source::Register(number) => {
            let number = number as usize;
            let register = if number < before.len() { &before[number] } else { &after[number - before.len() - 1] };
            let Register { value, slopes, moves } = register;
            let slope = |axis: usize| if moves >> axis & 1 == 1 { &*slopes[axis] } else { &ZEROS[..len] };
            Operand { value, slopes: [slope(0), slope(1), slope(2)], moves: *moves }
        }
    }
}

impl Task for Differentiate<'_> {
    #[inline(always)]
    fn run(self) {
        let Differentiate { plan, points, registers, constants: [first, second] } = self;
        for step in &plan.steps {
            let (Step::Unary(.., to) | Step::Binary(.., to)) = *step;
            // No operand is in the register of the result.
            let (before, rest) = registers.split_at_mut(to as usize);
            let [Register { value, slopes, moves }, after @ ..] = rest else { continue };
            let registers = [&*before, &*after];
            match *step {
                Step::Unary(op, a, _) => {
                    let a = operand(plan.source(a), points, registers, first);
                    *moves = a.moves;
                    each_unary!(op, OP => {
                        bulk::unary(OP, bulk::Operand::Slice(a.value), value);
                        for axis in (0..3).filter(|axis| *moves >> axis & 1 == 1) {
                            unary(OP, a.value, a.slopes[axis], &mut slopes[axis]);
                        }
                    });
                }
                Step::Binary(op, a, b, _) => {
                    let a = operand(plan.source(a), points, registers, first);
                    let b = operand(plan.source(b), points, registers, second);
                    *moves = a.moves | b.moves;
                    each_binary!(op, OP => {
                        bulk::binary(OP, bulk::Operand::Slice(a.value), bulk::Operand::Slice(b.value), value);
                        for axis in (0..3).filter(|axis| *moves >> axis & 1 == 1) {
                            binary(OP, [a.value, a.slopes[axis]], [b.value, b.slopes[axis]], &mut slopes[axis]);
                        }
                    });
                }
            }
        }
    }
}

#[inline(always)]
fn unary(op: UnaryOpcode, value: &[f32], slope: &[f32], out: &mut [f32]) {
    let len = out.len();
    let (value, slope) = (&value[..len], &slope[..len]);
    for i in 0..len {
        [out[i]] = Slope::unary(op, Slope { v: value[i], d: [slope[i]] }).d;
    }
}

#[inline(always)]
fn binary(op: BinaryOpcode, a: [&[f32]; 2], b: [&[f32]; 2], out: &mut [f32]) {
    let len = out.len();
    let ([va, da], [vb, db]) = ([&a[0][..len], &a[1][..len]], [&b[0][..len], &b[1][..len]]);
    for i in 0..len {
        [out[i]] = Slope::binary(op, Slope { v: va[i], d: [da[i]] }, Slope { v: vb[i], d: [db[i]] }).d;
    }
}
