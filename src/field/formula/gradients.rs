//! Values and gradients of formulas over chunks of points.
//!
//! As for values, every operation is a loop over the chunk; so is the derivative of its result
//! along each axis that it depends on. Most parts of most formulas depend on one or two.

use std::cell::RefCell;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::Formula;
use super::arithmetic::{Arithmetic, Float, each_binary, each_unary};
use super::bulk::{self, SINGLE};
use super::erased::{turned, turned_slope};
use super::plan::{Plan, Source, Step};
use super::slope::Slope;
use crate::field::Chunk;
use crate::num::kernel::{CHUNK, Task, dispatched};

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
}

thread_local! {
    static SCRATCH: RefCell<Scratch> =
        const { RefCell::new(Scratch { registers: Vec::new(), constants: [[0.0; CHUNK]; 2] }) };
}

const ZEROS: [f32; CHUNK] = [0.0; CHUNK];
const ONES: [f32; CHUNK] = [1.0; CHUNK];

pub(super) fn gradients(formula: &Formula, chunk: Chunk<'_, f32, 4>) {
    let plan = formula.0.code.plan();
    let Chunk { points, placement, out: [value, dx, dy, dz] } = chunk;
    let len = value.len();
    SINGLE.with_borrow_mut(|single| {
        single.place(points, placement);
        SCRATCH.with_borrow_mut(|Scratch { registers, constants }| {
            registers.resize_with(plan.registers.max(registers.len()), Register::default);
            for register in &mut registers[..plan.registers] {
                register.value.resize(len, 0.0);
                register.slopes.iter_mut().for_each(|slope| slope.resize(len, 0.0));
            }
            let points = single.points();
            dispatched(Differentiate { plan, points, registers, constants });
            let [constant, _] = constants;
            let all = operand(plan.result, points, registers, constant);
            for at in 0..len {
                let v = f64::from(all.value[at]);
                let defined = f64::from(u8::from(!v.is_nan()));
                let slope = all.slopes.map(|slopes| turned_slope(f64::from(slopes[at])) * defined);
                let pulled = placement.pull(slope);
                value[at] = f32::narrow(placement.finish(turned(v)));
                [dx[at], dy[at], dz[at]] = pulled.map(|d| f32::narrow(d * placement.scale));
            }
        });
    });
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

fn operand<'a>(
    source: Source,
    points: [&'a [f32]; 3],
    registers: &'a [Register],
    constant: &'a mut [f32; CHUNK],
) -> Operand<'a> {
    let len = points[0].len();
    match source {
        Source::Axis(number) => {
            let unit = |axis| if axis == usize::from(number) { &ONES[..len] } else { &ZEROS[..len] };
            Operand { value: points[usize::from(number)], slopes: [0, 1, 2].map(unit), moves: 1 << number }
        }
        Source::Const(c) => {
            constant[..len].fill(f32::narrow(c));
            Operand { value: &constant[..len], slopes: [&ZEROS[..len]; 3], moves: 0 }
        }
        Source::Register(number) => {
            let Register { value, slopes, moves } = &registers[number as usize];
            let slope = |axis: usize| if moves >> axis & 1 == 1 { &*slopes[axis] } else { &ZEROS[..len] };
            Operand { value, slopes: [0, 1, 2].map(slope), moves: *moves }
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
            let mut result = std::mem::take(&mut registers[to as usize]);
            let Register { value, slopes, moves } = &mut result;
            match *step {
                Step::Unary(op, a, _) => {
                    let a = operand(a, points, registers, first);
                    *moves = a.moves;
                    each_unary!(op, OP => {
                        bulk::unary(OP, bulk::Operand::Slice(a.value), value);
                        for axis in axes(*moves) {
                            unary(OP, a.value, a.slopes[axis], &mut slopes[axis]);
                        }
                    });
                }
                Step::Binary(op, a, b, _) => {
                    let a = operand(a, points, registers, first);
                    let b = operand(b, points, registers, second);
                    *moves = a.moves | b.moves;
                    each_binary!(op, OP => {
                        bulk::binary(OP, bulk::Operand::Slice(a.value), bulk::Operand::Slice(b.value), value);
                        for axis in axes(*moves) {
                            binary(OP, [a.value, a.slopes[axis]], [b.value, b.slopes[axis]], &mut slopes[axis]);
                        }
                    });
                }
            }
            registers[to as usize] = result;
        }
    }
}

fn axes(moves: u8) -> impl Iterator<Item = usize> {
    (0..3).filter(move |axis| moves >> axis & 1 == 1)
}

#[inline(always)]
fn unary(op: UnaryOpcode, value: &[f32], slope: &[f32], out: &mut [f32]) {
    for ((out, &v), &d) in out.iter_mut().zip(value).zip(slope) {
        [*out] = Slope::unary(op, Slope { v, d: [d] }).d;
    }
}

#[inline(always)]
fn binary(op: BinaryOpcode, [va, da]: [&[f32]; 2], [vb, db]: [&[f32]; 2], out: &mut [f32]) {
    for ((((out, &va), &da), &vb), &db) in out.iter_mut().zip(va).zip(da).zip(vb).zip(db) {
        [*out] = Slope::binary(op, Slope { v: va, d: [da] }, Slope { v: vb, d: [db] }).d;
    }
}
