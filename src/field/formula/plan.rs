//! Operations with registers given to them: the order that they run in is that of the list.
//!
//! A formula of thousands of operations has few values alive at a time. The result of an
//! operation never shares a register with its operands, so that whole slices can be run.

use std::cell::RefCell;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::Arithmetic;
use super::code::Op;

/// Where an operand is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    Axis(u8),
    Const(f64),
    Register(u32),
}

/// An operation, its operands and the register of its result.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Unary(UnaryOpcode, Source, u32),
    Binary(BinaryOpcode, Source, Source, u32),
}

#[derive(Debug)]
pub(super) struct Plan {
    pub(super) steps: Vec<Step>,
    pub(super) registers: usize,
    pub(super) result: Source,
}

/// What a thread needs to make a plan.
struct Scratch {
    /// The operation that needs each one last.
    last_use: Vec<u32>,
    sources: Vec<Source>,
    free: Vec<u32>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> =
        const { RefCell::new(Scratch { last_use: Vec::new(), sources: Vec::new(), free: Vec::new() }) };
}

impl Plan {
    pub(super) fn new(ops: &[Op]) -> Plan {
        SCRATCH.with_borrow_mut(|scratch| scratch.plan(ops))
    }
}

impl Scratch {
    fn plan(&mut self, ops: &[Op]) -> Plan {
        let Scratch { last_use, sources, free } = self;
        last_use.clear();
        last_use.resize(ops.len(), 0);
        let mut count = 0;
        for (at, op) in ops.iter().enumerate() {
            match *op {
                Op::Unary(_, a) => last_use[a as usize] = at as u32,
                Op::Binary(_, a, b) => {
                    last_use[a as usize] = at as u32;
                    last_use[b as usize] = at as u32;
                }
                Op::Axis(_) | Op::Const(_) => continue,
            }
            count += 1;
        }
        let mut plan = Plan { steps: Vec::with_capacity(count), registers: 0, result: Source::Const(0.0) };
        free.clear();
        sources.clear();
        sources.reserve(ops.len());
        for (at, op) in (0u32..).zip(ops) {
            let mut out = || match free.pop() {
                Some(register) => register,
                None => {
                    plan.registers += 1;
                    plan.registers as u32 - 1
                }
            };
            let (step, to, a, b) = match *op {
                Op::Axis(axis) => {
                    sources.push(Source::Axis(axis));
                    continue;
                }
                Op::Const(c) => {
                    sources.push(Source::Const(c));
                    continue;
                }
                Op::Unary(op, a) => {
                    let to = out();
                    (Step::Unary(op, sources[a as usize], to), to, a, a)
                }
                Op::Binary(op, a, b) => {
                    let to = out();
                    (Step::Binary(op, sources[a as usize], sources[b as usize], to), to, a, b)
                }
            };
            plan.steps.push(step);
            sources.push(Source::Register(to));
            // From here on their registers serve others.
            if let (true, Source::Register(register)) = (last_use[a as usize] == at, sources[a as usize]) {
                free.push(register);
            }
            if let (true, Source::Register(register)) = (a != b && last_use[b as usize] == at, sources[b as usize]) {
                free.push(register);
            }
        }
        plan.result = sources.last().copied().unwrap_or(Source::Const(0.0));
        plan
    }
}

impl Plan {
    /// The value at a point; `registers` is scratch.
    pub(super) fn value<N: Arithmetic>(&self, p: [N; 3], registers: &mut Vec<N>) -> N {
        let zero = N::constant(0.0);
        registers.resize(self.registers.max(registers.len()), zero);
        for step in &self.steps {
            match *step {
                Step::Unary(op, a, out) => registers[out as usize] = N::unary(op, read(a, &p, registers)),
                Step::Binary(op, a, b, out) => {
                    registers[out as usize] = N::binary(op, read(a, &p, registers), read(b, &p, registers));
                }
            }
        }
        read(self.result, &p, registers)
    }
}

fn read<N: Arithmetic>(source: Source, p: &[N; 3], registers: &[N]) -> N {
    match source {
        Source::Axis(axis) => p[usize::from(axis)],
        Source::Const(c) => N::constant(c),
        Source::Register(register) => registers[register as usize],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_chain_needs_two_registers() {
        let mut ops = vec![Op::Axis(0), Op::Const(1.5)];
        for at in 0..1000 {
            ops.push(Op::Binary(BinaryOpcode::Add, if at == 0 { 0 } else { at + 1 }, 1));
        }
        let plan = Plan::new(&ops);
        assert_eq!(plan.registers, 2);
        assert_eq!(plan.value([2.0, 0.0, 0.0], &mut Vec::new()), 1502.0);
    }
}
