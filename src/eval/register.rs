//! Order of evaluation and registers.
//!
//! A program is run over chunks of points, one instruction at a time; every value is a
//! register of a chunk's size, so few registers mean that the work stays in the cache. Of the
//! operands of a join the one that needs most registers goes first (Sethi and Ullman), and
//! every other is folded in as soon as it is known: a chain needs two registers whatever its
//! length, a balanced tree as many as it is deep.

use super::program::{Edge, Kind, Program};
use rvachev_field::Op;
use rvachev_field::Rule;

#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// Evaluates a leaf of the scene.
    Leaf { leaf: u32, to: u32 },
    /// Joins register `from`, or its negative, to register `to`.
    Fold { op: Op, rule: Rule, negate: bool, from: u32, to: u32 },
    /// Copies a register.
    Copy { from: u32, to: u32 },
    /// Negates a register.
    Negate { register: u32 },
    /// Adds a number to the values of a register.
    Shift { register: u32, by: f64 },
}

/// The steps of a program, how many registers they use, and the one with the result.
pub(super) struct Schedule {
    pub(super) steps: Vec<Step>,
    pub(super) registers: usize,
    pub(super) result: u32,
}

/// A join in progress.
struct Open {
    node: usize,
    /// Its operands, the neediest first.
    operands: Vec<Edge>,
    next: usize,
    all: Option<u32>,
}

#[derive(Default)]
struct Registers {
    free: Vec<u32>,
    count: u32,
}

impl Registers {
    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        })
    }
}

pub(super) fn schedule(program: &Program) -> Schedule {
    let count = program.nodes.len();
    let mut uses = vec![0u32; count];
    let mut needs = vec![1u32; count];
    uses[program.root.node()] += 1;
    for (at, node) in program.nodes.iter().enumerate() {
        if node.valued_by().is_some() {
            continue;
        }
        let mut own: Vec<u32> = Vec::with_capacity(node.len as usize);
        for edge in program.list(node) {
            uses[edge.node()] += 1;
            own.push(needs[edge.node()]);
        }
        own.sort_unstable_by(|a, b| b.cmp(a));
        // All but the first are computed beside one register that holds what is joined.
        needs[at] = own.first().copied().unwrap_or(1).max(own.get(1).map_or(0, |second| second + 1));
    }
    // One for each leaf, and one for each operand.
    let mut steps = Vec::with_capacity(2 * count);
    let mut registers = Registers::default();
    // Where a node's value is kept while uses remain.
    let mut kept: Vec<Option<u32>> = vec![None; count];
    let mut open: Vec<Open> = Vec::new();
    let start = |node: usize, steps: &mut Vec<Step>, registers: &mut Registers, kept: &mut Vec<Option<u32>>| {
        if let Some(leaf) = program.nodes[node].valued_by() {
            let to = registers.take();
            steps.push(Step::Leaf { leaf, to });
            kept[node] = Some(to);
            return None;
        }
        let mut operands = program.list(&program.nodes[node]).to_vec();
        // Blends tell their operands apart.
        if !matches!(program.nodes[node].kind, Kind::Join { rule, .. } if rule.reads_values()) {
            operands.sort_by_key(|edge| std::cmp::Reverse(needs[edge.node()]));
        }
        Some(Open { node, operands, next: 0, all: None })
    };
    open.extend(start(program.root.node(), &mut steps, &mut registers, &mut kept));
    while let Some(top) = open.last_mut() {
        let Some(&edge) = top.operands.get(top.next) else {
            kept[top.node] = top.all;
            open.pop();
            continue;
        };
        let Some(from) = kept[edge.node()] else {
            let deeper = start(edge.node(), &mut steps, &mut registers, &mut kept);
            open.extend(deeper);
            continue;
        };
        top.next += 1;
        uses[edge.node()] -= 1;
        let last_use = uses[edge.node()] == 0;
        match (top.all, &program.nodes[top.node].kind) {
            (Some(to), Kind::Join { op, rule, .. }) => {
                steps.push(Step::Fold { op: *op, rule: *rule, negate: edge.negated(), from, to });
                if last_use {
                    registers.free.push(from);
                }
            }
            _ => {
                let all = if last_use {
                    from
                } else {
                    let to = registers.take();
                    steps.push(Step::Copy { from, to });
                    to
                };
                if edge.negated() {
                    steps.push(Step::Negate { register: all });
                }
                if let Kind::Shift(by) = program.nodes[top.node].kind {
                    steps.push(Step::Shift { register: all, by });
                }
                top.all = Some(all);
            }
        }
        if last_use {
            kept[edge.node()] = None;
        }
    }
    let result = kept[program.root.node()].unwrap_or_default();
    if program.root.negated() {
        steps.push(Step::Negate { register: result });
    }
    Schedule { steps, registers: registers.count.max(1) as usize, result }
}
