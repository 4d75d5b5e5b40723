//! Values of formulas over chunks of points.
//!
//! The operations are run one after the other, each over the whole chunk, in a loop of its
//! own that the compiler makes vectors of.

use std::cell::RefCell;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::Formula;
use super::arithmetic::{Float, each_binary, each_unary};
use super::plan::{Plan, Source, Step};
use crate::Real;
use crate::kernel::{self, Element, Task, dispatched};
use crate::{Chunk, Placement, VALUE_LIMIT};

/// What a thread needs for chunks of one precision.
pub(super) struct Scratch<E> {
    /// The chunk's points in the formula's frame.
    points: [Vec<E>; 3],
    registers: Vec<Vec<E>>,
}

impl<E: Element> Scratch<E> {
    const fn new() -> Scratch<E> {
        Scratch { points: [const { Vec::new() }; 3], registers: Vec::new() }
    }

    /// Fills in the points of the formula's frame.
    pub(super) fn place(&mut self, points: [&[E]; 3], placement: &Placement) {
        let len = points[0].len();
        for axis in &mut self.points {
            axis.resize(len, E::default());
        }
        kernel::run(&Place(placement), points, self.points.each_mut().map(Vec::as_mut_slice));
    }

    pub(super) fn points(&self) -> [&[E]; 3] {
        self.points.each_ref().map(Vec::as_slice)
    }

    /// Makes room for a plan.
    fn fit(&mut self, plan: &Plan) {
        let len = self.points[0].len();
        self.registers.resize_with(plan.registers.max(self.registers.len()), Vec::new);
        for register in &mut self.registers[..plan.registers] {
            register.resize(len, E::default());
        }
    }
}

thread_local! {
    pub(super) static SINGLE: RefCell<Scratch<f32>> = const { RefCell::new(Scratch::new()) };
    static DOUBLE: RefCell<Scratch<f64>> = const { RefCell::new(Scratch::new()) };
}

/// The map to the formula's frame.
struct Place<'a>(&'a Placement);

impl kernel::Formula<3, 3> for Place<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        self.0.apply(p)
    }
}

pub(super) fn single(formula: &Formula, chunk: Chunk<'_, f32, 1>) {
    let [out] = chunk.out;
    SINGLE.with_borrow_mut(|scratch| {
        scratch.place(chunk.points, chunk.placement);
        let points = scratch.points();
        if !formula.0.native.run(&formula.0.code, points, out) {
            interpret(formula.0.code.plan(), scratch, out);
        }
    });
    finish(out, chunk.placement);
}

pub(super) fn double(formula: &Formula, chunk: Chunk<'_, f64, 1>) {
    let [out] = chunk.out;
    DOUBLE.with_borrow_mut(|scratch| {
        scratch.place(chunk.points, chunk.placement);
        interpret(formula.0.code.plan(), scratch, out);
    });
    finish(out, chunk.placement);
}

/// Turns the sign, and holds values within their limits; what is undefined is outside.
pub(super) fn finish<E: Element + Float>(out: &mut [E], placement: &Placement) {
    let (factor, shift) = (E::narrow(-placement.scale), E::narrow(placement.shift));
    dispatched(Finish { out, factor, shift, limit: E::narrow(VALUE_LIMIT) });
}

struct Finish<'a, E> {
    out: &'a mut [E],
    factor: E,
    shift: E,
    limit: E,
}

impl<E: Element + Float> Task for Finish<'_, E> {
    #[inline(always)]
    fn run(self) {
        let low = self.limit.negated();
        for value in self.out {
            let turned = E::apply2(BinaryOpcode::Mul, *value, self.factor).plus(self.shift);
            // Nothing is above NaN.
            let held = if turned > low { turned } else { low };
            *value = if held < self.limit { held } else { self.limit };
        }
    }
}

fn interpret<E: Element + Float>(plan: &Plan, scratch: &mut Scratch<E>, out: &mut [E]) {
    scratch.fit(plan);
    let Scratch { points, registers } = scratch;
    dispatched(Interpret { plan, points, registers, out });
}

struct Interpret<'a, E> {
    plan: &'a Plan,
    points: &'a [Vec<E>; 3],
    registers: &'a mut [Vec<E>],
    out: &'a mut [E],
}

/// An operand of a chunk.
pub(super) enum Operand<'a, E> {
    Slice(&'a [E]),
    Const(E),
}

impl<E: Element + Float> Task for Interpret<'_, E> {
    #[inline(always)]
    fn run(self) {
        let Interpret { plan, points, registers, out } = self;
        for step in &plan.steps {
            let (Step::Unary(.., to) | Step::Binary(.., to)) = *step;
            // No operand is in the register of the result.
            let mut result = std::mem::take(&mut registers[to as usize]);
            match *step {
                Step::Unary(op, a, _) => {
                    let a = operand(plan.source(a), points, registers);
                    each_unary!(op, OP => unary::<E>(OP, a, &mut result));
                }
                Step::Binary(op, a, b, _) => {
                    let (a, b) =
                        (operand(plan.source(a), points, registers), operand(plan.source(b), points, registers));
                    each_binary!(op, OP => binary::<E>(OP, a, b, &mut result));
                }
            }
            registers[to as usize] = result;
        }
        match operand(plan.result(), points, registers) {
            Operand::Slice(values) => out.copy_from_slice(values),
            Operand::Const(c) => out.fill(c),
        }
    }
}

#[inline(always)]
fn operand<'a, E: Element + Float>(source: Source, points: &'a [Vec<E>; 3], registers: &'a [Vec<E>]) -> Operand<'a, E> {
    match source {
        Source::Axis(axis) => Operand::Slice(&points[usize::from(axis)]),
        Source::Const(c) => Operand::Const(E::narrow(c)),
        Source::Register(register) => Operand::Slice(&registers[register as usize]),
    }
}

#[inline(always)]
pub(super) fn unary<E: Float>(op: UnaryOpcode, a: Operand<'_, E>, result: &mut [E]) {
    let len = result.len();
    match a {
        Operand::Slice(a) => {
            let a = &a[..len];
            if E::are_near(op, a) {
                for i in 0..len {
                    result[i] = E::apply_near(op, a[i]);
                }
            } else {
                for i in 0..len {
                    result[i] = E::apply1(op, a[i]);
                }
            }
        }
        Operand::Const(a) => result.fill(E::apply1(op, a)),
    }
}

#[inline(always)]
pub(super) fn binary<E: Float>(op: BinaryOpcode, a: Operand<'_, E>, b: Operand<'_, E>, result: &mut [E]) {
    let len = result.len();
    match (a, b) {
        (Operand::Slice(a), Operand::Slice(b)) => {
            let (a, b) = (&a[..len], &b[..len]);
            for i in 0..len {
                result[i] = E::apply2(op, a[i], b[i]);
            }
        }
        (Operand::Slice(a), Operand::Const(b)) => {
            let a = &a[..len];
            for i in 0..len {
                result[i] = E::apply2(op, a[i], b);
            }
        }
        (Operand::Const(a), Operand::Slice(b)) => {
            let b = &b[..len];
            for i in 0..len {
                result[i] = E::apply2(op, a, b[i]);
            }
        }
        (Operand::Const(a), Operand::Const(b)) => result.fill(E::apply2(op, a, b)),
    }
}
