//! Boxes about runs of patches that follow each other, in pairs, pairs of pairs and so on.
//!
//! ```text
//!     [        all         ]      Patches that follow each other are near each other, so that a box of
//!     [   half   ][  half  ]      some of them is small: what is far from a box is far from all of
//!     [run ][run ][run ][..]      them, and patches of one place are found in a few steps.
//! ```

use glam::DVec3;
use rvachev_field::Patches;

use crate::Bounds;

/// So many patches are a run.
const RUN: usize = 8;

/// The boxes, those of single runs first, then those of two, and so on to one of all.
pub(crate) struct Runs {
    levels: Vec<Vec<Bounds>>,
    patches: usize,
}

/// A box of patches, by its level and its number there.
#[derive(Clone, Copy)]
pub(crate) struct Block {
    level: usize,
    number: usize,
}

impl Runs {
    pub(super) fn new(patches: &Patches) -> Runs {
        let count = patches.len();
        let run = |n: usize| {
            let own = n * RUN..count.min((n + 1) * RUN);
            own.fold(Bounds::EMPTY, |all, patch| all.union(&patch_box(patches, patch)))
        };
        let mut levels = vec![(0..count.div_ceil(RUN)).map(run).collect::<Vec<Bounds>>()];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let pair = |pair: &[Bounds]| pair.iter().fold(Bounds::EMPTY, |all, own| all.union(own));
            levels.push(last.chunks(2).map(pair).collect());
        }
        Runs { levels, patches: count }
    }

    /// The box of all, if there are any.
    pub(crate) fn all(&self) -> Option<Block> {
        let level = self.levels.len() - 1;
        (self.patches > 0).then_some(Block { level, number: 0 })
    }

    pub(crate) fn bounds(&self, block: Block) -> &Bounds {
        &self.levels[block.level][block.number]
    }

    /// The two boxes that a box is made of; the second is missing at the end of a level, and both
    /// are of a single run.
    pub(crate) fn parts(&self, block: Block) -> impl Iterator<Item = Block> + use<> {
        let Block { level, number } = block;
        let below = if level == 0 { 0..0 } else { 2 * number..self.levels[level - 1].len().min(2 * number + 2) };
        below.map(move |number| Block { level: level - 1, number })
    }

    /// What boxes are made of: boxes, and the patches of single runs.
    pub(crate) fn opened(&self, blocks: &[Block]) -> (Vec<Block>, Vec<usize>) {
        let parts = blocks.iter().flat_map(|block| self.parts(*block)).collect();
        let single = blocks.iter().filter(|block| block.level == 0);
        (parts, single.flat_map(|block| self.patches(*block)).collect())
    }

    /// The patches in it.
    pub(crate) fn patches(&self, block: Block) -> std::ops::Range<usize> {
        let size = RUN << block.level;
        block.number * size..self.patches.min((block.number + 1) * size)
    }
}

/// A box that holds a patch: it is within its control points, which are the corners and, of each
/// side, a point as far beyond its middle as that is off the straight line.
fn patch_box(patches: &Patches, n: usize) -> Bounds {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|at| patches.point(n, at));
    let middles = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]].map(|at| patches.point(n, at));
    let control = |k: usize| 2.0 * middles[k] - 0.5 * (corners[k] + corners[(k + 1) % 3]);
    let points: [DVec3; 6] = [corners[0], corners[1], corners[2], control(0), control(1), control(2)];
    points.into_iter().fold(Bounds::EMPTY, |all, p| all.union(&Bounds::new(p, p)))
}
