//! The blocks of a lattice that are meshed in halved cells.

use std::collections::BTreeSet;

use crate::mesh::lattice::Lattice;
use crate::mesh::resolve::Unresolved;
use crate::mesh::signs::BLOCK;

/// How far, in cells, an unresolved cell is from the nearest block that is not in the inset, at
/// least.
const MARGIN: usize = 2;

/// Blocks, by their numbers along the axes: their first cells over [`BLOCK`].
#[derive(Clone, Default)]
pub(super) struct Inset {
    blocks: BTreeSet<[u32; 3]>,
    /// How many blocks the lattice has along each axis.
    counts: [u32; 3],
}

impl Inset {
    /// No blocks of a lattice.
    pub(super) fn none(lattice: &Lattice) -> Inset {
        let counts = lattice.cells().map(|cells| cells.div_ceil(BLOCK as u32));
        Inset { blocks: BTreeSet::new(), counts }
    }

    /// The blocks that have unresolved cells, or are close to one.
    pub(super) fn around(lattice: &Lattice, unresolved: &[Unresolved]) -> Inset {
        let mut inset = Inset::none(lattice);
        for found in unresolved {
            let block = found.block.map(|cell| cell / BLOCK as u32);
            found.cells.iter().for_each(|cell| inset.add_near(block, *cell));
        }
        inset
    }

    /// Adds a block for a cell of it, and the blocks that this is close to.
    pub(super) fn add_near(&mut self, block: [u32; 3], cell: [usize; 3]) {
        let near = cell.map(|at| [at < MARGIN, true, at + MARGIN >= BLOCK]);
        let is_near = |step: &[usize; 3]| (0..3).all(|axis| near[axis][step[axis]]);
        self.blocks.extend(steps().filter(is_near).filter_map(|step| stepped(block, step, self.counts)));
    }

    pub(super) fn len(&self) -> usize {
        self.blocks.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    pub(super) fn add(&mut self, block: [u32; 3]) {
        self.blocks.insert(block);
    }

    pub(super) fn blocks(&self) -> impl Iterator<Item = [u32; 3]> {
        self.blocks.iter().copied()
    }

    /// The blocks and all next to them.
    pub(super) fn around_all(&self) -> impl Iterator<Item = [u32; 3]> {
        self.blocks().flat_map(move |block| steps().filter_map(move |step| stepped(block, step, self.counts)))
    }

    pub(super) fn has(&self, block: [u32; 3]) -> bool {
        self.blocks.contains(&block)
    }

    /// Whether a block of halved cells is in it.
    pub(super) fn has_half(&self, block: [u32; 3]) -> bool {
        self.has(block.map(|at| at / 2))
    }

    /// The block of the lattice that is next to one along an axis.
    pub(super) fn beside(&self, block: [u32; 3], axis: usize, up: bool) -> Option<[u32; 3]> {
        let mut step = [1; 3];
        step[axis] = if up { 2 } else { 0 };
        stepped(block, step, self.counts)
    }

    /// Whether a block of the lattice next to one, or that itself, is not in it.
    pub(super) fn ends_at(&self, block: [u32; 3]) -> bool {
        steps().filter_map(|step| stepped(block, step, self.counts)).any(|other| !self.has(other))
    }

    /// Whether a node of the halved lattice is in the seam: in blocks that are in the inset, and in
    /// others.
    pub(super) fn is_seam(&self, node: [u32; 3]) -> bool {
        if node.iter().all(|at| at % (2 * BLOCK as u32) != 0) {
            return false;
        }
        let mut met = [false; 2];
        self.blocks_at(node, 2 * BLOCK as u32).for_each(|block| met[usize::from(self.has(block))] = true);
        met == [true; 2]
    }

    /// The blocks of so many steps along the side that a node is in.
    pub(super) fn blocks_at(&self, node: [u32; 3], side: u32) -> impl Iterator<Item = [u32; 3]> {
        let counts = self.counts.map(|count| count * (2 * BLOCK as u32 / side));
        let first = node.map(|at| at / side);
        let low =
            std::array::from_fn(|axis| first[axis] - u32::from(node[axis].is_multiple_of(side) && first[axis] > 0));
        let high: [u32; 3] = std::array::from_fn(|axis| first[axis].min(counts[axis] - 1));
        between(low, high)
    }
}

/// All with coordinates from `low` to `high`.
fn between(low: [u32; 3], high: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| low[axis]..=high[axis]);
    zs.flat_map(move |z| {
        let xs = xs.clone();
        ys.clone().flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
    })
}

/// The ways to a block and all next to it: 0, 1 or 2 along each axis, 1 for none.
fn steps() -> impl Iterator<Item = [usize; 3]> {
    (0..27).map(|n| [n % 3, n / 3 % 3, n / 9])
}

fn stepped(block: [u32; 3], step: [usize; 3], counts: [u32; 3]) -> Option<[u32; 3]> {
    let mut other = block;
    for axis in 0..3 {
        other[axis] = (block[axis] + step[axis] as u32).checked_sub(1).filter(|&at| at < counts[axis])?;
    }
    Some(other)
}
