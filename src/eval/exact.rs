//! Where a solid's own value is the true distance, so that lengths need nothing else.
//!
//! ```text
//!                              inside                outside
//!     leaf by distance         yes                   yes
//!     union                    no                    if it is outside of all operands
//!     intersection             if inside of all      no
//!     complement               as outside            as inside
//!     rigid map, uniform scale as the operand        as the operand
//!     offset outwards          no                    always
//!     offset inwards           always                no
//! ```
//!
//! R-functions count as min and max, which is what lengths make of them. Of all else nothing is
//! known: deformations, blends, repetitions in a deformed space.

use std::collections::HashMap;

use super::context::is_similarity;
use crate::Solid;
use crate::solid::{Length, Node, Operation};

/// On which side a value is the true distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Exact {
    pub(super) inside: bool,
    pub(super) outside: bool,
}

impl Exact {
    const BOTH: Exact = Exact { inside: true, outside: true };

    fn complement(self) -> Exact {
        Exact { inside: self.outside, outside: self.inside }
    }
}

/// What is known of the nodes of a graph.
#[derive(Default)]
pub(super) struct Exactness(HashMap<usize, Exact>);

impl Exactness {
    /// Finds it out for a solid and all that it is made of, operands first.
    pub(super) fn add(&mut self, root: &Solid) {
        let mut pending = vec![(root, false)];
        while let Some((solid, is_open)) = pending.pop() {
            if self.0.contains_key(&solid.address()) {
                continue;
            }
            if is_open {
                let found = self.found(solid);
                self.0.insert(solid.address(), found);
            } else {
                pending.push((solid, true));
                pending.extend(solid.node().parts().iter().chain(solid.node().ball()).map(|part| (part, false)));
            }
        }
    }

    /// Where the value of a solid is a distance.
    pub(super) fn of(&self, solid: &Solid) -> Exact {
        self.0.get(&solid.address()).copied().unwrap_or_default()
    }

    /// Whether a length is a matter of its operand's own value.
    pub(super) fn is_closed(&self, solid: &Solid) -> bool {
        let Node::Length { operand, length, .. } = solid.node() else { return false };
        let exact = self.of(operand);
        match *length {
            Length::Level(_) => true,
            Length::Offset(d) => d == 0.0 || if d > 0.0 { exact.outside } else { exact.inside },
            Length::Shell(_) => exact.inside,
            Length::Rounded(_) | Length::Filleted(_) => false,
        }
    }

    fn found(&self, solid: &Solid) -> Exact {
        let node = solid.node();
        let mut operands = node.parts().iter().map(|part| self.of(part));
        match node {
            Node::Leaf(field) => {
                if field.exact() && !field.jumps() {
                    Exact::BOTH
                } else {
                    Exact::default()
                }
            }
            Node::Affine { forward, .. } if !is_similarity(&forward.matrix3) => Exact::default(),
            Node::Affine { .. }
            | Node::Named { .. }
            | Node::Painted { .. }
            | Node::Repeated { .. }
            | Node::Swept { .. } => operands.next().unwrap_or_default(),
            Node::Complement(_) => operands.next().unwrap_or_default().complement(),
            Node::Join { operation: Operation::Union, .. } => {
                Exact { inside: false, outside: operands.all(|exact| exact.outside) }
            }
            Node::Join { operation: Operation::Intersection, .. } => {
                Exact { inside: operands.all(|exact| exact.inside), outside: false }
            }
            Node::Join { operation: Operation::Difference, .. } => {
                let first = operands.next().unwrap_or_default();
                Exact { inside: first.inside && operands.all(|exact| exact.outside), outside: false }
            }
            Node::Length { length: Length::Offset(d), .. } => match *d {
                d if d > 0.0 => Exact { inside: false, outside: true },
                d if d < 0.0 => Exact { inside: true, outside: false },
                _ => operands.next().unwrap_or_default(),
            },
            Node::Warp { .. } | Node::Join { .. } | Node::Blend { .. } | Node::Length { .. } | Node::Rim { .. } => {
                Exact::default()
            }
        }
    }
}
