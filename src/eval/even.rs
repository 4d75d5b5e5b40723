//! Which axes a value depends on: along the others it is the same everywhere, and a section tells
//! all of it.

use glam::DVec3;

use super::program::{Node, Program};
use crate::{Bounds, Dual, Interval};
use rvachev_field::Zone;

/// The axes that one or the other depends on.
pub(super) fn either(a: [bool; 3], b: [bool; 3]) -> [bool; 3] {
    [0, 1, 2].map(|axis| a[axis] || b[axis])
}

/// The axes along which a box ends.
pub(super) fn ends(bounds: &Bounds) -> [bool; 3] {
    let is_open = bounds.min.cmpeq(-DVec3::INFINITY) & bounds.max.cmpeq(DVec3::INFINITY);
    [0, 1, 2].map(|axis| !is_open.test(axis))
}

impl Program {
    /// The axes of the world that the value may depend on.
    pub(super) fn axes(&self) -> [bool; 3] {
        let leaves = self.nodes.iter().filter_map(Node::valued_by);
        leaves.map(|leaf| self.axes_of(leaf)).fold([false; 3], either)
    }

    /// Whether the value is found to be the same all along an axis, over a box.
    pub(crate) fn is_even_along(&self, axis: usize, region: &Bounds) -> bool {
        let by_slope = || {
            let over = self.evaluate(Dual::point(Zone::of_bounds(region).hull()), &mut Vec::new());
            over.gradient()[axis] == Interval::ZERO
        };
        !self.axes()[axis] || by_slope()
    }

    /// The axes of the world that a leaf depends on.
    pub(super) fn axes_of(&self, leaf: u32) -> [bool; 3] {
        let instance = self.instance(leaf);
        let own = instance.field.axes();
        let matrix = instance.to_local.matrix3;
        // A deformation mixes the axes.
        [0, 1, 2].map(|axis| instance.frame != 0 || (0..3).any(|to| own[to] && matrix.col(axis)[to] != 0.0))
    }
}
