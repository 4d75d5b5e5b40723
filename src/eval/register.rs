//! Order of evaluation and registers.
//!
//! A program is run over chunks of points, one instruction at a time; every value is a
//! register of a chunk's size, so few registers mean that the work stays in the cache. Of the
//! operands of a join the one that needs most registers goes first (Sethi and Ullman), and
//! every other is folded in as soon as it is known: a chain needs two registers whatever its
//! length, a balanced tree as many as it is deep.
//!
//! ```text
//!     max(A, B, min(C, D))      D dear:   where max(A, B) is positive, or C is negative,
//!                                         D decides nothing
//! ```
//!
//! Small joins that hold a dear leaf go last, and such a leaf is told which registers hold what it
//! is joined with: beyond their band it need not be known ([`Guard`]).

use std::cmp::Reverse;

use super::program::{Edge, Kind, Program};
use rvachev_field::Op;
use rvachev_field::Rule;

#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// Evaluates a leaf of the scene; these of the guards tell where it decides nothing.
    Leaf { leaf: u32, to: u32, guards: [u32; 2] },
    /// Joins register `from`, or its negative, to register `to`.
    Fold { op: Op, rule: Rule, negate: bool, from: u32, to: u32 },
    /// Copies a register.
    Copy { from: u32, to: u32 },
    /// Negates a register.
    Negate { register: u32 },
    /// Adds a number to the values of a register.
    Shift { register: u32, by: f64 },
}

/// What a leaf is joined with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    pub(super) register: u32,
    pub(super) op: Op,
    /// Whether the leaf counts negated in that join.
    pub(super) negated: bool,
}

/// Joins that hold a dear leaf go last if they need no more registers.
const SMALL: u32 = 3;

/// The steps of a program, how many registers they use, and the one with the result.
pub(super) struct Schedule {
    pub(super) steps: Vec<Step>,
    pub(super) guards: Vec<Guard>,
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
    let is_dear = |leaf: u32| program.instance(leaf).field.cost() > 1;
    // Which nodes hold a dear leaf and are small, and which joins go last.
    let (mut dear, mut late) = (vec![false; count], vec![false; count]);
    uses[program.root.node()] += 1;
    for (at, node) in program.nodes.iter().enumerate() {
        if let Some(leaf) = node.valued_by() {
            dear[at] = is_dear(leaf);
            continue;
        }
        let mut own: Vec<(bool, Reverse<u32>)> = Vec::with_capacity(node.len as usize);
        for edge in program.list(node) {
            uses[edge.node()] += 1;
            own.push((late[edge.node()], Reverse(needs[edge.node()])));
            dear[at] |= dear[edge.node()];
        }
        own.sort_unstable();
        // All but the first are computed beside one register that holds what is joined.
        let beside = own.iter().skip(1).map(|(_, needed)| needed.0 + 1);
        needs[at] = beside.chain(own.first().map(|(_, needed)| needed.0)).max().unwrap_or(1);
        dear[at] &= needs[at] <= SMALL;
        late[at] = dear[at] && matches!(node.kind, Kind::Join { rule: Rule::MinMax, .. });
    }
    // One for each leaf, and one for each operand.
    let mut steps = Vec::with_capacity(2 * count);
    let mut registers = Registers::default();
    // Where a node's value is kept while uses remain.
    let mut kept: Vec<Option<u32>> = vec![None; count];
    let mut open: Vec<Open> = Vec::new();
    let mut guards: Vec<Guard> = Vec::new();
    let start = |node: usize| {
        let mut operands = program.list(&program.nodes[node]).to_vec();
        // Blends tell their operands apart.
        if !matches!(program.nodes[node].kind, Kind::Join { rule, .. } if rule.reads_values()) {
            operands.sort_by_key(|edge| (late[edge.node()], Reverse(needs[edge.node()])));
        }
        Open { node, operands, next: 0, all: None }
    };
    let mut pending = Some(program.root.node());
    loop {
        if let Some(node) = pending.take() {
            match program.nodes[node].valued_by() {
                Some(leaf) => {
                    let first = guards.len();
                    if is_dear(leaf) {
                        guards.extend(guards_of(program, &open, &uses));
                    }
                    let to = registers.take();
                    steps.push(Step::Leaf { leaf, to, guards: [first, guards.len()].map(|at| at as u32) });
                    kept[node] = Some(to);
                }
                None => open.push(start(node)),
            }
        }
        let Some(top) = open.last_mut() else { break };
        let Some(&edge) = top.operands.get(top.next) else {
            kept[top.node] = top.all;
            open.pop();
            continue;
        };
        let Some(from) = kept[edge.node()] else {
            pending = Some(edge.node());
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
    Schedule { steps, guards, registers: registers.count.max(1) as usize, result }
}

/// What the next operand of the innermost of open joins is joined with: in that one, and in those
/// around it as long as each has no other use.
fn guards_of(program: &Program, open: &[Open], uses: &[u32]) -> Vec<Guard> {
    let (mut guards, mut negated) = (Vec::new(), false);
    for join in open.iter().rev() {
        let Some(edge) = join.operands.get(join.next) else { break };
        let Kind::Join { op, rule: Rule::MinMax, .. } = program.nodes[join.node].kind else { break };
        if uses[edge.node()] > 1 {
            break;
        }
        negated ^= edge.negated();
        guards.extend(join.all.map(|register| Guard { register, op, negated }));
    }
    guards
}
