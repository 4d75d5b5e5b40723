//! Operations with registers given to them: the order that they run in is that of the list.
//!
//! A formula of thousands of operations has few values alive at a time. The result of an
//! operation never shares a register with its operands, so that whole slices can be run.

use std::cell::RefCell;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::Arithmetic;
use super::op::Op;

/// Where an operand is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    Axis(u8),
    Const(f64),
    Register(u32),
}

/// The same in four bytes: plans are many, and most of what they take is operands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot(u32);

impl Slot {
    /// Of an operand that there is none of.
    pub(super) const NONE: Slot = Slot(0);

    #[inline(always)]
    fn axis(axis: u8) -> Slot {
        Slot(u32::from(axis) << 2)
    }

    #[inline(always)]
    fn constant(number: usize) -> Slot {
        Slot((number as u32) << 2 | 1)
    }

    #[inline(always)]
    fn register(number: u32) -> Slot {
        Slot(number << 2 | 2)
    }

    #[inline(always)]
    fn as_register(self) -> Option<u32> {
        (self.0 & 3 == 2).then_some(self.0 >> 2)
    }
}

/// An operation, its operands and the register of its result.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Unary(UnaryOpcode, Slot, u32),
    Binary(BinaryOpcode, Slot, Slot, u32),
}

#[derive(Debug)]
pub(super) struct Plan {
    pub(super) steps: Vec<Step>,
    constants: Vec<f64>,
    pub(super) registers: usize,
    result: Slot,
}

/// What a thread needs to make a plan.
struct Scratch {
    /// The operation that needs each one last.
    last_use: Vec<u32>,
    slots: Vec<Slot>,
    free: Vec<u32>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> =
        const { RefCell::new(Scratch { last_use: Vec::new(), slots: Vec::new(), free: Vec::new() }) };
}

impl Plan {
    /// That of no operations.
    pub(super) const EMPTY: Plan = Plan { steps: Vec::new(), constants: Vec::new(), registers: 0, result: Slot(0) };

    pub(super) fn new(ops: &[Op]) -> Plan {
        let mut plan = Plan::EMPTY;
        plan.make(ops);
        plan
    }

    /// Becomes that of other operations.
    pub(super) fn make(&mut self, ops: &[Op]) {
        SCRATCH.with_borrow_mut(|scratch| scratch.plan(ops, self));
    }

    /// One with room for so many steps and constants.
    pub(super) fn with_room(steps: usize, constants: usize) -> Plan {
        Plan { steps: Vec::with_capacity(steps), constants: Vec::with_capacity(constants), ..Plan::EMPTY }
    }

    /// Forgets its steps.
    fn clear(&mut self) {
        self.steps.clear();
        self.constants.clear();
        self.registers = 0;
    }

    /// Which axes its steps take.
    pub(super) fn axes(&self) -> [bool; 3] {
        let mut axes = [false; 3];
        let mut take = |slot: Slot| {
            if slot.0 & 3 == 0 {
                axes[slot.0 as usize >> 2] = true;
            }
        };
        for step in &self.steps {
            match *step {
                Step::Unary(_, a, _) => take(a),
                Step::Binary(_, a, b, _) => {
                    take(a);
                    take(b);
                }
            }
        }
        take(self.result);
        axes
    }

    /// How many steps choose one of their operands.
    pub(super) fn choices(&self) -> usize {
        use BinaryOpcode as B;
        self.steps.iter().filter(|step| matches!(step, Step::Binary(B::Min | B::Max, ..))).count()
    }

    /// Writes the operations out as a list: axes and constants before what needs them.
    pub(super) fn list(&self, ops: &mut Vec<Op>) {
        const NONE: u32 = u32::MAX;
        ops.clear();
        let mut axes = [NONE; 3];
        let mut constants = vec![NONE; self.constants.len()];
        let mut registers = vec![NONE; self.registers];
        let mut find = |slot: Slot, registers: &[u32], ops: &mut Vec<Op>| {
            let (known, op) = match self.source(slot) {
                Source::Register(register) => return registers[register as usize],
                Source::Axis(axis) => (&mut axes[usize::from(axis)], Op::Axis(axis)),
                Source::Const(c) => (&mut constants[slot.0 as usize >> 2], Op::Const(c)),
            };
            if *known == NONE {
                *known = ops.len() as u32;
                ops.push(op);
            }
            *known
        };
        for step in &self.steps {
            let (op, to) = match *step {
                Step::Unary(op, a, to) => (Op::Unary(op, find(a, &registers, ops)), to),
                Step::Binary(op, a, b, to) => {
                    let a = find(a, &registers, ops);
                    (Op::Binary(op, a, find(b, &registers, ops)), to)
                }
            };
            registers[to as usize] = ops.len() as u32;
            ops.push(op);
        }
        if self.steps.is_empty() {
            find(self.result, &registers, ops);
        }
    }

    /// Adds an operation, whose value counts until another is added, with its operands where they
    /// are; `ends` tells which of them nothing needs after it. Gives where its own value is. `free`
    /// are the registers that are free at the moment, of no use to anybody else.
    #[inline(always)]
    pub(super) fn add(&mut self, op: Op, [a, b]: [Slot; 2], ends: [bool; 2], free: &mut Vec<u32>) -> Slot {
        let mut out = || match free.pop() {
            Some(register) => register,
            None => {
                self.registers += 1;
                self.registers as u32 - 1
            }
        };
        self.result = match op {
            Op::Axis(axis) => Slot::axis(axis),
            Op::Const(c) => {
                self.constants.push(c);
                Slot::constant(self.constants.len() - 1)
            }
            Op::Unary(op, _) => {
                let to = out();
                self.steps.push(Step::Unary(op, a, to));
                Slot::register(to)
            }
            Op::Binary(op, ..) => {
                let to = out();
                self.steps.push(Step::Binary(op, a, b, to));
                Slot::register(to)
            }
        };
        for (slot, ends) in [(a, ends[0]), (b, ends[1])] {
            if let (true, Some(register)) = (ends, slot.as_register()) {
                free.push(register);
            }
        }
        self.result
    }
}

impl Scratch {
    fn plan(&mut self, ops: &[Op], plan: &mut Plan) {
        let Scratch { last_use, slots, free } = self;
        last_use.clear();
        last_use.resize(ops.len(), 0);
        for (at, op) in ops.iter().enumerate() {
            match *op {
                Op::Unary(_, a) => last_use[a as usize] = at as u32,
                Op::Binary(_, a, b) => {
                    last_use[a as usize] = at as u32;
                    last_use[b as usize] = at as u32;
                }
                Op::Axis(_) | Op::Const(_) => {}
            }
        }
        plan.clear();
        plan.steps.reserve(ops.len());
        free.clear();
        slots.clear();
        for (at, op) in (0u32..).zip(ops) {
            let is_last = |operand: u32| last_use[operand as usize] == at;
            let (operands, ends) = match *op {
                Op::Axis(_) | Op::Const(_) => ([Slot::NONE; 2], [false; 2]),
                Op::Unary(_, a) => ([slots[a as usize]; 2], [is_last(a), false]),
                Op::Binary(_, a, b) => ([slots[a as usize], slots[b as usize]], [is_last(a), a != b && is_last(b)]),
            };
            slots.push(plan.add(*op, operands, ends, free));
        }
    }
}

impl Plan {
    pub(super) fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// What is in a slot.
    #[inline(always)]
    pub(super) fn source(&self, Slot(slot): Slot) -> Source {
        match slot & 3 {
            0 => Source::Axis((slot >> 2) as u8),
            1 => Source::Const(self.constants[slot as usize >> 2]),
            _ => Source::Register(slot >> 2),
        }
    }

    /// Where the value is in the end.
    pub(super) fn result(&self) -> Source {
        self.source(self.result)
    }

    /// The value at a point; `registers` is scratch.
    pub(super) fn value<N: Arithmetic>(&self, p: [N; 3], registers: &mut Vec<N>) -> N {
        let zero = N::constant(0.0);
        registers.resize(self.registers.max(registers.len()), zero);
        for step in &self.steps {
            match *step {
                Step::Unary(op, a, out) => registers[out as usize] = N::unary(op, read(self.source(a), &p, registers)),
                Step::Binary(op, a, b, out) => {
                    let (a, b) = (read(self.source(a), &p, registers), read(self.source(b), &p, registers));
                    registers[out as usize] = N::binary(op, a, b);
                }
            }
        }
        read(self.result(), &p, registers)
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
    fn a_plan_is_written_out_as_the_list_that_it_came_of() {
        use BinaryOpcode as B;
        let ops = vec![
            Op::Axis(1),
            Op::Const(2.0),
            Op::Binary(B::Mul, 0, 1),
            Op::Axis(0),
            Op::Binary(B::Min, 2, 3),
            Op::Unary(UnaryOpcode::Neg, 2),
            Op::Binary(B::Add, 4, 5),
        ];
        let mut list = Vec::new();
        Plan::new(&ops).list(&mut list);
        assert_eq!(list, ops);
        Plan::new(&[Op::Const(3.0)]).list(&mut list);
        assert_eq!(list, [Op::Const(3.0)]);
    }

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
