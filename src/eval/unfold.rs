//! Copies where they stand.
//!
//! ```text
//!     o   o   o   o        Rows and rings of copies are one leaf in a folded space. In a region without an
//!           +---+          edge of the fold it is a leaf of the world, moved to where its copy is: points need
//!     o   o | o |  o       not be folded, nor do zones.
//!           +---+
//! ```

use glam::DAffine3;

use super::program::{Kind, Node, Program};
use super::scene::Instance;
use rvachev_field::{Pieces, Placement, Zone};

impl Program {
    /// The program for a zone that lies across no edge of a fold, if all its deformations are
    /// folds.
    pub(crate) fn unfolded(&self, zone: &Zone) -> Option<Program> {
        if self.frames.is_empty()
            || self.nodes.iter().any(|node| matches!(node.kind, Kind::Join { hierarchy: Some(_), .. }))
        {
            return None;
        }
        let world = Pieces::one(*zone);
        let zones = self.zones(&world);
        // From the world into each frame.
        let mut into: Vec<DAffine3> = Vec::with_capacity(self.frames.len());
        for &number in &self.frames[..] {
            let frame = self.scene.frame(number)?;
            let above = self.zone_in(&zones, frame.parent, &world).only()?.mapped(&frame.to_local);
            let (fold, None) = frame.warp.branches(above.hull())? else { return None };
            let outer = self.in_frame(&into, frame.parent, DAffine3::IDENTITY);
            into.push(fold * frame.to_local * outer);
        }
        let first = self.scene.leaves.len();
        let mut simpler = Vec::new();
        let place = |leaf: u32| {
            let old = self.instance(leaf);
            let map = self.in_frame(&into, old.frame, DAffine3::IDENTITY);
            let to_local = old.to_local * map;
            Instance {
                frame: 0,
                to_local,
                placement: Placement::new(&to_local, old.placement.scale, old.placement.shift),
                bounds: old.bounds.transformed(&map.inverse()),
                ..old.clone()
            }
        };
        let moved = |node: &Node| {
            let Kind::Leaf(leaf) = node.kind else { return node.clone() };
            simpler.push(place(leaf));
            Node { kind: Kind::Leaf((first + simpler.len() - 1) as u32), ..node.clone() }
        };
        let nodes: Vec<Node> = self.nodes.iter().map(moved).collect();
        Some(Program::assemble(self.scene.clone(), nodes, self.operands.to_vec(), self.root, simpler))
    }
}
