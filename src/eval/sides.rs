//! Boxes around what is inside and what is outside.

use super::program::{Kind, Op, Program};
use crate::Bounds;
use crate::field::Rule;

/// A box that holds what is inside, and one that holds what is outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    pub(crate) inside: Bounds,
    pub(crate) outside: Bounds,
}

impl Default for Sides {
    fn default() -> Sides {
        Sides { inside: Bounds::ALL, outside: Bounds::ALL }
    }
}

impl Sides {
    /// Those of the complement, if `negate`.
    pub(crate) fn flip_if(self, negate: bool) -> Sides {
        if negate { Sides { inside: self.outside, outside: self.inside } } else { self }
    }

    /// Those of a join of two.
    pub(crate) fn join(self, op: Op, other: Sides) -> Sides {
        match op {
            Op::Or => {
                Sides { inside: self.inside.union(&other.inside), outside: self.outside.intersection(&other.outside) }
            }
            Op::And => {
                Sides { inside: self.inside.intersection(&other.inside), outside: self.outside.union(&other.outside) }
            }
        }
    }

    /// Where an operand of `op` decides anything: outside of it the operand is the neutral
    /// element of the operation.
    pub(crate) fn decisive(self, op: Op) -> Bounds {
        match op {
            Op::Or => self.inside,
            Op::And => self.outside,
        }
    }
}

impl Program {
    /// A box around what is inside, of the region that the program is narrowed to.
    pub(crate) fn reach(&self) -> Bounds {
        let mut sides: Vec<Sides> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes[..] {
            let operands = self.list(node).iter().map(|e| sides[e.node()].flip_if(e.negated()));
            let found = match &node.kind {
                Kind::Leaf(leaf) => {
                    let instance = self.instance(*leaf);
                    let is_placed = self.frames.binary_search(&instance.frame).is_err();
                    let inside = if is_placed { instance.bounds } else { Bounds::ALL };
                    Sides { inside, outside: Bounds::ALL }
                }
                Kind::Join { op, rule: Rule::MinMax, .. } => {
                    operands.reduce(|all, next| all.join(*op, next)).unwrap_or_default()
                }
                Kind::Join { .. } | Kind::Edge { .. } | Kind::Shift(_) => Sides::default(),
            };
            sides.push(found);
        }
        sides[self.root.node()].flip_if(self.root.negated()).inside
    }
}
