//! How a program's value bends along straight lines: what tells how many crossings a ray may have.
//!
//! A concave value is above 0 on one piece of any line, a convex one on all but one. Minima keep
//! concave values concave and maxima convex ones convex; a negation exchanges the two.

use super::program::{Kind, Node, Program};
use super::scene::Instance;
use rvachev_field::{Op, Rule, Zone};

/// How the value bends along straight lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// It lies above its chords: what is inside is convex.
    Concave,
    /// It lies below its chords: what is outside is convex.
    Convex,
}

impl Bend {
    fn flip_if(self, negate: bool) -> Bend {
        match (self, negate) {
            (Bend::Concave, false) | (Bend::Convex, true) => Bend::Concave,
            _ => Bend::Convex,
        }
    }

    /// That of the negated value.
    pub(crate) fn turned(self) -> Bend {
        self.flip_if(true)
    }
}

impl Program {
    /// How the value bends along straight lines, where that is known: leaves that are not
    /// deformed, their intersections and the complements of these.
    pub(crate) fn bend(&self) -> Option<Bend> {
        self.bend_by(|leaf| leaf.field.convex().then_some(Bend::Concave))
    }

    /// How it does along those lines that lie in a zone.
    pub(crate) fn bend_over(&self, zone: &Zone) -> Option<Bend> {
        self.bend_by(|leaf| {
            let is_concave = leaf.field.is_concave_over(&zone.mapped(&leaf.to_local))?;
            Some(Bend::Concave.flip_if(!is_concave))
        })
    }

    /// Whether it may bend one way in parts of a region if it does not in all of it: copies, which
    /// are seen one by one there, and polygons.
    pub(crate) fn bends_in_parts(&self) -> bool {
        let is_folded = |frame: &u32| self.scene.frame(*frame).is_some_and(|frame| frame.warp.folds());
        let may_bend = |leaf: u32| {
            let field = &self.instance(leaf).field;
            field.is_steady() && (field.is_faceted() || field.convex())
        };
        self.frames.iter().all(is_folded) && self.nodes.iter().filter_map(Node::valued_by).all(may_bend)
    }

    fn bend_by(&self, of_leaf: impl Fn(&Instance) -> Option<Bend>) -> Option<Bend> {
        if !self.frames.is_empty() {
            return None;
        }
        let mut bends: Vec<Option<Bend>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes[..] {
            let mut operands = self.list(node).iter().map(|e| bends[e.node()].map(|bend| bend.flip_if(e.negated())));
            let bend = match &node.kind {
                Kind::Leaf(leaf) => of_leaf(self.instance(*leaf)),
                Kind::Shift(_) => operands.next().flatten(),
                Kind::Join { op, rule: Rule::MinMax, .. } => {
                    let bend = if *op == Op::And { Bend::Concave } else { Bend::Convex };
                    operands.all(|operand| operand == Some(bend)).then_some(bend)
                }
                Kind::Join { .. } => None,
            };
            bends.push(bend);
        }
        bends[self.root.node()].map(|bend| bend.flip_if(self.root.negated()))
    }

    /// The operands of a union of concave values: from outside, the first crossing of a ray is the
    /// nearest of theirs, and each of them has one at most on the way in. One operand may be
    /// another, the last, if it is expensive: a ray looks for it up to where it meets the others.
    pub(crate) fn united(&self) -> Option<Vec<Program>> {
        let root = &self.nodes[self.root.node()];
        if self.root.negated() || !matches!(root.kind, Kind::Join { op: Op::Or, rule: Rule::MinMax, .. }) {
            return None;
        }
        let (mut parts, mut last) = (Vec::new(), None);
        for &edge in self.list(root) {
            let part = self.trimmed(self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec(), edge);
            if part.bend() == Some(Bend::Concave) {
                parts.push(part);
            } else if last.is_none() && part.cost() > part.leaf_count() {
                last = Some(part);
            } else {
                return None;
            }
        }
        parts.extend(last);
        Some(parts)
    }

    /// Whether its root reads more of its operands than their signs.
    pub(crate) fn is_blend(&self) -> bool {
        matches!(&self.nodes[self.root.node()].kind, Kind::Join { rule, .. } if *rule != Rule::MinMax)
    }

    /// The number of its leaf, if it is one leaf and nothing else.
    pub(crate) fn only_leaf(&self) -> Option<u32> {
        match &self.nodes[..] {
            [Node { kind: Kind::Leaf(leaf), .. }] => Some(self.instance(*leaf).number),
            _ => None,
        }
    }
}
