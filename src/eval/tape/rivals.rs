//! A plain min or max of leaves, taken apart: at a point one of them decides, and it can be
//! evaluated alone.

use super::{LeafStep, Tape};
use crate::Bounds;
use crate::eval::program::{Edge, Kind, Program};
use crate::eval::register::Step;
use rvachev_field::Op;
use rvachev_field::Rule;

/// What a plain min or max of leaves, in the order of their steps, is made of.
#[derive(Clone)]
pub(super) struct Rivals {
    op: Op,
    leaves: Vec<Rival>,
}

/// One of them.
#[derive(Clone)]
struct Rival {
    /// Whether it counts negated.
    negated: bool,
    /// Nothing beyond is inside of it.
    reach: Bounds,
}

impl Rivals {
    /// The bytes that they take.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.leaves)
    }

    /// Those of a program, if its tape has as many leaves: none of them is used twice.
    pub(super) fn of(program: &Program, leaves: usize) -> Option<Rivals> {
        let root = &program.nodes[program.root.node()];
        let Kind::Join { op, rule: Rule::MinMax, .. } = root.kind else { return None };
        let flip = program.root.negated();
        let operands = program.list(root);
        let leaf = |edge: &Edge| match program.nodes[edge.node()].kind {
            Kind::Leaf(leaf) => {
                let instance = program.instance(leaf);
                let reach = if program.frames.is_empty() { instance.bounds } else { Bounds::ALL };
                Some(Rival { negated: edge.negated() != flip, reach })
            }
            _ => None,
        };
        let leaves = if operands.len() == leaves { operands.iter().map(leaf).collect() } else { None };
        Some(Rivals { op: op.flip_if(flip), leaves: leaves? })
    }
}

impl Tape {
    /// Calls `visit` with each leaf, alone, and its place among those of the scene.
    pub(crate) fn each_leaf(&self, mut visit: impl FnMut(u32, &Tape)) {
        let Some(first) = self.leaves.first() else { return };
        let mut alone = self.alone(first, false);
        for (n, leaf) in self.leaves.iter().enumerate() {
            if n > 0 {
                alone.become_alone(self, leaf, false);
            }
            visit(leaf.leaf, &alone);
        }
    }

    /// The leaves of a plain min or max of them, if that is what the program is: the value is the
    /// least of theirs for a conjunction, the largest for a disjunction. They come in place of
    /// others whose memory they take.
    pub(crate) fn rivals_into<'m>(&self, others: &'m mut Vec<Tape>) -> Option<(Op, &'m [Tape])> {
        let Rivals { op, leaves } = self.rivals.as_ref()?;
        for (n, (leaf, rival)) in self.leaves.iter().zip(leaves).enumerate() {
            match others.get_mut(n) {
                Some(other) => other.become_alone(self, leaf, rival.negated),
                None => others.push(self.alone(leaf, rival.negated)),
            }
        }
        Some((*op, &others[..leaves.len()]))
    }

    /// Marks the leaves of a union that nothing of `region` is inside of.
    pub(super) fn mark_far(&self, region: &Bounds, far: &mut Vec<bool>) {
        far.clear();
        if let Some(Rivals { op: Op::Or, leaves }) = &self.rivals {
            far.extend(leaves.iter().map(|rival| !rival.negated && !rival.reach.intersects(region)));
        }
    }

    /// Whether it is a leaf, or a min or max of leaves, and the value surely changes by at most 1
    /// per length unit.
    pub(crate) fn is_gentle(&self) -> bool {
        let is_gentle = |leaf: &LeafStep| leaf.slot == 0 && (leaf.field.convex() || leaf.field.exact());
        let is_choice = self.rivals.is_some() || self.leaves.len() == 1;
        is_choice && self.leaves.iter().all(is_gentle)
    }

    /// The tape of one of its leaves, or of its complement.
    fn alone(&self, leaf: &LeafStep, negated: bool) -> Tape {
        let (frames, leaves, steps) = (Vec::new(), Vec::with_capacity(1), Vec::with_capacity(2));
        let mut alone = Tape { frames, leaves, steps, guards: Vec::new(), rivals: None, ..*self };
        alone.become_alone(self, leaf, negated);
        alone
    }

    /// Becomes the tape of one of the leaves of `all`, or of its complement.
    fn become_alone(&mut self, all: &Tape, leaf: &LeafStep, negated: bool) {
        let Tape { frames, leaves, steps, .. } = self;
        frames.clear();
        if leaf.slot != 0 {
            frames.extend_from_slice(&all.frames);
        }
        leaves.clear();
        leaves.push(leaf.clone());
        steps.clear();
        steps.push(Step::Leaf { leaf: 0, to: 0, guards: [0; 2] });
        steps.extend(negated.then_some(Step::Negate { register: 0 }));
        let (frames, leaves, steps) = (std::mem::take(frames), std::mem::take(leaves), std::mem::take(steps));
        *self = Tape { frames, leaves, steps, guards: Vec::new(), registers: 1, result: 0, rivals: None, ..*all };
    }
}
