//! A program taken apart by the signs of what is searched for.
//!
//! ```text
//!     rest       the program where none of it is: most rays meet what it says
//!     added      fillets that are material: where one is met before the rest
//!     cut        fillets, chamfers and cavities: where one is at what a ray meets of the rest
//! ```
//!
//! With `added` fillets outside along a ray, up to a point, the solid is as the rest there, or less
//! by what is `cut`; so a crossing of the rest that nothing of `cut` is at is the solid's.

use super::partial::Given;
use super::program::{Edge, Kind, Node, Program, Region};
use crate::Bounds;
use rvachev_field::{Op, Rule};

/// A program in parts.
pub(crate) struct Fillets {
    pub(crate) rest: Region,
    pub(crate) added: Vec<Program>,
    /// Whether what is added is inside wherever it is: all of it are operands of a union.
    pub(crate) are_operands: bool,
    pub(crate) cut: Vec<Program>,
}

/// How a node counts: as it is, as its complement.
#[derive(Clone, Copy, Default)]
struct Counts([bool; 2]);

impl Program {
    /// The program without what is searched for, within `bounds`, if some of it can be told apart.
    pub(crate) fn fillets(&self, bounds: &Bounds) -> Option<Fillets> {
        let tops = self.searched();
        if tops.is_empty() {
            return None;
        }
        let (counts, root) = (self.counts(), &self.nodes[self.root.node()]);
        let is_union = !self.root.negated() && matches!(root.kind, Kind::Join { op: Op::Or, rule: Rule::MinMax, .. });
        let mut found = Fillets { rest: Region::Outside, added: Vec::new(), are_operands: is_union, cut: Vec::new() };
        let mut given: Given = Vec::new();
        for at in tops {
            let alone =
                || self.trimmed(self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec(), Edge::new(at));
            match counts[at] {
                Counts([true, false]) if self.are_below(at, Op::Or, &counts) => {
                    let Some(alone) = Some(alone()).filter(|alone| alone.rolled().is_some()) else { continue };
                    found.are_operands &= self.list(root).iter().any(|edge| edge.node() == at && !edge.negated());
                    found.added.push(alone);
                }
                Counts([false, true]) if self.are_below(at, Op::And, &counts) => found.cut.push(alone()),
                Counts(_) => continue,
            }
            given.extend(self.leaves_below(at).into_iter().map(|leaf| (leaf, false)));
        }
        if given.is_empty() {
            return None;
        }
        found.rest = self.given(given, bounds)?;
        Some(found)
    }

    /// The nodes of leaves that are searched for, and of no other such node.
    fn searched(&self) -> Vec<usize> {
        let mut are_searched = Vec::with_capacity(self.nodes.len());
        let mut tops = Vec::new();
        for (at, node) in self.nodes.iter().enumerate() {
            let is_searched = match node.kind {
                Kind::Leaf(leaf) => {
                    let field = &self.instance(leaf).field;
                    field.cost() > 1 && !field.is_steady()
                }
                Kind::Join { op: Op::And, rule: Rule::MinMax, .. } => {
                    self.list(node).iter().all(|edge| !edge.negated() && are_searched[edge.node()])
                }
                _ => false,
            };
            are_searched.push(is_searched);
            if is_searched {
                tops.retain(|top| self.list(node).iter().all(|edge| edge.node() != *top));
                tops.push(at);
            }
        }
        tops
    }

    /// The leaves that a node is made of.
    fn leaves_below(&self, at: usize) -> Vec<usize> {
        let node = &self.nodes[at];
        match node.kind {
            Kind::Leaf(_) => vec![at],
            _ => self.list(node).iter().flat_map(|edge| self.leaves_below(edge.node())).collect(),
        }
    }

    /// Whether a node is joined with others by an operation, as these count, and by no other.
    fn are_below(&self, at: usize, op: Op, counts: &[Counts]) -> bool {
        let is_other = |(node, Counts(own)): (&Node, &Counts)| {
            let Kind::Join { op: by, rule: Rule::MinMax, .. } = node.kind else { return true };
            [false, true].into_iter().zip(own).any(|(turn, counts)| *counts && by.flip_if(turn) != op)
        };
        let parents = self.nodes.iter().zip(counts).filter(|(node, _)| self.list(node).iter().any(|e| e.node() == at));
        !parents.into_iter().any(is_other)
    }

    /// How the nodes count.
    fn counts(&self) -> Vec<Counts> {
        let mut counts = vec![Counts::default(); self.nodes.len()];
        counts[self.root.node()].0[usize::from(self.root.negated())] = true;
        for at in (0..self.nodes.len()).rev() {
            let Counts(own) = counts[at];
            for edge in self.list(&self.nodes[at]) {
                for (turn, counted) in own.into_iter().enumerate() {
                    counts[edge.node()].0[turn ^ usize::from(edge.negated())] |= counted;
                }
            }
        }
        counts
    }
}
