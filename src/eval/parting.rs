//! A program taken apart by the sign of one leaf.
//!
//! What is inside of a solid is told by the signs of its leaves. Where that of one leaf L is known,
//! the program is another without it:
//!
//! ```text
//!     L outside        P₋          of a plate L ∧ S that is nothing, and S alone
//!     L inside         P₊
//! ```
//!
//! That is of use where L is long and does not change along rays, as the outline of a plate that is
//! seen from above: one value of it per ray tells which of the two the ray is in from end to end.

use super::pass::{Asked, Pass};
use super::program::{Edge, Node, Program, Region};
use crate::Bounds;
use crate::field::{Pieces, Zone};

/// A program in parts.
pub(crate) struct Parting {
    /// The axes of the world that the leaf depends on.
    pub(crate) axes: [bool; 3],
    /// The leaf alone.
    pub(crate) leaf: Program,
    /// The program where the leaf is outside, and where it is inside.
    pub(crate) sides: [Region; 2],
}

impl Program {
    /// The program parted, within `bounds`, by a leaf that costs more than `dear` ordinary ones and
    /// goes on without end along an axis of the world, if it has one.
    pub(crate) fn parting(&self, bounds: &Bounds, dear: usize) -> Option<Parting> {
        for (at, node) in self.nodes.iter().enumerate() {
            let Some(leaf) = node.valued_by().filter(|_| node.len == 0) else { continue };
            let instance = self.instance(leaf);
            let axes = self.axes_of(leaf);
            let ends = |axis: usize| instance.bounds.min[axis].is_finite() || instance.bounds.max[axis].is_finite();
            if instance.field.cost() <= dear || (0..3).all(|axis| axes[axis] || ends(axis)) {
                continue;
            }
            let axes = [0, 1, 2].map(|axis| axes[axis] || ends(axis));
            let [Some(outside), Some(inside)] = [false, true].map(|sign| self.given((at, sign), bounds)) else {
                continue;
            };
            let leaf = vec![Node::leaf(leaf)];
            let leaf =
                Program::assemble(self.scene.clone(), leaf, Vec::new(), Edge::new(0), self.simpler.to_vec());
            return Some(Parting { axes, leaf, sides: [outside, inside] });
        }
        None
    }

    /// What `bounds` hold of the solid where the leaf of a node is inside or outside; `None` if its
    /// sign does not tell.
    fn given(&self, given: (usize, bool), bounds: &Bounds) -> Option<Region> {
        let world = &Pieces::one(Zone::of_bounds(bounds));
        let zones = self.zones(world);
        let mut pass = Pass::new(self, &zones, world);
        pass.by_boxes = true;
        pass.given = Some(given);
        pass.run(Asked { sign: true, value: false });
        (!pass.is_value(given.0)).then(|| self.region(pass))
    }
}
