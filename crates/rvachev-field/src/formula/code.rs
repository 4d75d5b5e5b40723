//! A formula as a list of operations, operands before operators.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use fidget::context::{self, BinaryOpcode, Context, Tree, TreeOp, UnaryOpcode};
use fidget::var::Var;

use super::arithmetic::Arithmetic;
use super::jumps;
use super::op::Op;
use super::plan::Plan;

/// What makes a formula no solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Flaw {
    /// So many variables other than x, y and z.
    Variables(usize),
    /// A constant that is NaN.
    NotANumber,
}

/// The operations of a formula; the last is its value. They are kept as a list or as a plan, and in
/// the other form as well once somebody has asked for that.
#[derive(Debug)]
pub(super) struct Code {
    ops: OnceLock<Vec<Op>>,
    /// How many there are.
    pub(super) len: usize,
    pub(super) flaw: Option<Flaw>,
    /// Which axes the value depends on.
    pub(super) axes: [bool; 3],
    /// How many operations choose one of their operands.
    pub(super) choices: usize,
    /// Whether an operation may jump at planes.
    pub(super) jumps: bool,
    /// No two codes have the same.
    pub(super) number: u64,
    plan: OnceLock<Plan>,
}

/// Builds a list; what is constant is evaluated at once.
#[derive(Default)]
pub(super) struct Builder {
    ops: Vec<Op>,
    axes: [Option<u32>; 3],
}

impl Builder {
    pub(super) fn with_capacity(len: usize) -> Builder {
        Builder { ops: Vec::with_capacity(len), axes: [None; 3] }
    }

    /// Goes on from a list.
    pub(super) fn of(ops: &[Op]) -> Builder {
        Builder { ops: ops.to_vec(), axes: [None; 3] }
    }

    fn push(&mut self, op: Op) -> u32 {
        self.ops.push(op);
        (self.ops.len() - 1) as u32
    }

    pub(super) fn axis(&mut self, axis: u8) -> u32 {
        let known = self.axes[usize::from(axis)];
        let at = known.unwrap_or_else(|| self.push(Op::Axis(axis)));
        self.axes[usize::from(axis)] = Some(at);
        at
    }

    pub(super) fn constant(&mut self, c: f64) -> u32 {
        self.push(Op::Const(c))
    }

    fn fixed(&self, at: u32) -> Option<f64> {
        match self.ops[at as usize] {
            Op::Const(c) => Some(c),
            _ => None,
        }
    }

    pub(super) fn unary(&mut self, op: UnaryOpcode, a: u32) -> u32 {
        match self.fixed(a) {
            Some(c) => self.constant(f64::unary(op, c)),
            None => self.push(Op::Unary(op, a)),
        }
    }

    pub(super) fn binary(&mut self, op: BinaryOpcode, a: u32, b: u32) -> u32 {
        match (self.fixed(a), self.fixed(b)) {
            (Some(c), Some(d)) => self.constant(f64::binary(op, c, d)),
            // The square is known to be no less than 0.
            _ if op == BinaryOpcode::Mul && a == b => self.push(Op::Unary(UnaryOpcode::Square, a)),
            _ => self.push(Op::Binary(op, a, b)),
        }
    }

    /// The code whose value is that of operation number `root`.
    pub(super) fn finish(self, root: u32) -> Code {
        let ops = &self.ops[..=root as usize];
        Code::new(live(ops, ops.len(), |_| None).unwrap_or_default(), None)
    }
}

/// The operations that the last one needs, if they are at most `most`; `choice` gives the operand
/// that an operation is equal to, where it is to one.
pub(super) fn live(ops: &[Op], most: usize, choice: impl Fn(usize) -> Option<u32>) -> Option<Vec<Op>> {
    // What stands for each operation: itself, an operand, or nothing where it is not needed.
    const UNUSED: u32 = u32::MAX;
    let mut stand_in = vec![UNUSED; ops.len()];
    *stand_in.last_mut()? = 0;
    let mut count = 0;
    for at in (0..ops.len()).rev() {
        if stand_in[at] == UNUSED {
            continue;
        }
        if let Some(operand) = choice(at) {
            (stand_in[at], stand_in[operand as usize]) = (operand, 0);
            continue;
        }
        stand_in[at] = at as u32;
        count += 1;
        if count > most {
            return None;
        }
        match ops[at] {
            Op::Unary(_, a) => stand_in[a as usize] = 0,
            Op::Binary(_, a, b) => (stand_in[a as usize], stand_in[b as usize]) = (0, 0),
            Op::Axis(_) | Op::Const(_) => {}
        }
    }
    // From here on, where each has gone to.
    let mut moved = stand_in;
    let mut kept = Vec::with_capacity(count);
    for (at, op) in ops.iter().enumerate() {
        if moved[at] == UNUSED {
            continue;
        }
        if moved[at] != at as u32 {
            moved[at] = moved[moved[at] as usize];
            continue;
        }
        let to = |a: u32| moved[a as usize];
        let op = match *op {
            Op::Unary(op, a) => Op::Unary(op, to(a)),
            Op::Binary(op, a, b) => Op::Binary(op, to(a), to(b)),
            op => op,
        };
        moved[at] = kept.len() as u32;
        kept.push(op);
    }
    Some(kept)
}

/// The number of the next code.
fn next() -> u64 {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    NUMBER.fetch_add(1, Ordering::Relaxed)
}

impl Code {
    pub(super) fn new(ops: Vec<Op>, flaw: Option<Flaw>) -> Code {
        let (mut flaw, mut axes, mut choices, mut jumps) = (flaw, [false; 3], 0, false);
        for op in &ops {
            match *op {
                Op::Axis(axis) => axes[usize::from(axis)] = true,
                Op::Const(c) if c.is_nan() => flaw = flaw.or(Some(Flaw::NotANumber)),
                Op::Binary(BinaryOpcode::Min | BinaryOpcode::Max, ..) => choices += 1,
                op => jumps |= jumps::has_steps(&op),
            }
        }
        Code { len: ops.len(), ops: ops.into(), flaw, axes, choices, jumps, number: next(), plan: OnceLock::new() }
    }

    /// What is left of a code, `len` operations.
    pub(super) fn narrowed(&self, plan: Plan, len: usize) -> Code {
        let (axes, choices) = (plan.axes(), plan.choices());
        let (flaw, jumps) = (self.flaw, self.jumps);
        Code { ops: OnceLock::new(), len, flaw, axes, choices, jumps, number: next(), plan: plan.into() }
    }

    pub(super) fn ops(&self) -> &[Op] {
        self.ops.get_or_init(|| {
            let mut ops = Vec::with_capacity(self.len);
            self.plan().list(&mut ops);
            ops
        })
    }

    /// The list, if it was made.
    pub(super) fn known_ops(&self) -> Option<&[Op]> {
        self.ops.get().map(Vec::as_slice)
    }

    /// The operations of a fidget tree.
    pub(super) fn of_tree(tree: &Tree) -> Code {
        let mut context = Context::new();
        let root = context.import(tree);
        let mut builder = Builder::with_capacity(context.len());
        let mut built: HashMap<context::Node, u32> = HashMap::new();
        let mut foreign = 0;
        let mut pending = vec![root];
        while let Some(&node) = pending.last() {
            if built.contains_key(&node) {
                pending.pop();
                continue;
            }
            let Some(op) = context.get_op(node) else {
                unreachable!("nodes of a context are in it");
            };
            let open = pending.len();
            pending.extend(op.iter_children().filter(|child| !built.contains_key(child)));
            if pending.len() > open {
                continue;
            }
            let at = match *op {
                context::Op::Input(Var::X) => builder.axis(0),
                context::Op::Input(Var::Y) => builder.axis(1),
                context::Op::Input(Var::Z) => builder.axis(2),
                context::Op::Input(Var::V(_)) => {
                    foreign += 1;
                    builder.constant(0.0)
                }
                context::Op::Const(c) => builder.constant(c.0.into()),
                context::Op::Unary(op, a) => builder.unary(op, built[&a]),
                context::Op::Binary(op, a, b) => builder.binary(op, built[&a], built[&b]),
            };
            built.insert(node, at);
            pending.pop();
        }
        let mut code = builder.finish(built[&root]);
        if foreign > 0 {
            code.flaw = Some(Flaw::Variables(foreign));
        }
        code
    }

    /// The formula as a fidget tree of x, y and z, its constants in single precision.
    pub(super) fn tree(&self) -> Tree {
        let axes = [Var::X, Var::Y, Var::Z].map(|var| Arc::new(TreeOp::Input(var)));
        let mut built: Vec<Arc<TreeOp>> = Vec::with_capacity(self.len);
        let made = |op: &Op, built: &[Arc<TreeOp>]| match *op {
            Op::Axis(axis) => TreeOp::Input([Var::X, Var::Y, Var::Z][usize::from(axis)]),
            #[expect(clippy::cast_possible_truncation, reason = "fidget's constants are f32")]
            Op::Const(c) => TreeOp::Const(c as f32),
            Op::Unary(op, a) => TreeOp::Unary(op, built[a as usize].clone()),
            Op::Binary(op, a, b) => TreeOp::Binary(op, built[a as usize].clone(), built[b as usize].clone()),
        };
        let Some((root, rest)) = self.ops().split_last() else {
            return Tree::constant(0.0);
        };
        for op in rest {
            let next = match op {
                Op::Axis(axis) => axes[usize::from(*axis)].clone(),
                op => Arc::new(made(op, &built)),
            };
            built.push(next);
        }
        Tree::from(made(root, &built))
    }

    /// Registers and steps for evaluation, made on first use.
    pub(super) fn plan(&self) -> &Plan {
        self.plan.get_or_init(|| Plan::new(self.ops()))
    }

    /// The plan, if it was made.
    pub(super) fn known_plan(&self) -> Option<&Plan> {
        self.plan.get()
    }

    /// Whether every operation is an instruction of the processor, not a function.
    #[cfg(feature = "jit")]
    pub(super) fn is_elementary(&self) -> bool {
        use BinaryOpcode as B;
        use UnaryOpcode as U;
        !self.ops().iter().any(|op| {
            matches!(
                op,
                Op::Unary(U::Sin | U::Cos | U::Tan | U::Asin | U::Acos | U::Atan | U::Exp | U::Ln | U::Rand, _)
                    | Op::Binary(B::Atan | B::Mod | B::Mix, ..)
            )
        })
    }

    /// The values of all operations, in order.
    pub(super) fn values<N: Arithmetic>(&self, p: [N; 3], all: &mut Vec<N>) {
        all.clear();
        all.reserve(self.len);
        for op in self.ops() {
            let value = match *op {
                Op::Axis(axis) => p[usize::from(axis)],
                Op::Const(c) => N::constant(c),
                Op::Unary(op, a) => N::unary(op, all[a as usize]),
                Op::Binary(op, a, b) => N::binary(op, all[a as usize], all[b as usize]),
            };
            all.push(value);
        }
    }
}
