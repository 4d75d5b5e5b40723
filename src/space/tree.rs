//! Dividing a grid of blocks until every block is inside, outside, or small.
//!
//! The grid's blocks are cubes of one size. A range of blocks is narrowed as one box; if the
//! surface may cross it, it is halved along its longest side, and the halves start from the
//! program that is narrowed already. Work is proportional to the surface, and to the leaves
//! that matter locally.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::eval::{Program, Region};
use crate::{Bounds, Cancelled, Run};

/// A regular grid of cubic blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// The low corner of block (0, 0, 0).
    pub(crate) origin: DVec3,
    /// Edge length of a block.
    pub(crate) side: f64,
    /// Blocks along each axis.
    pub(crate) blocks: [u32; 3],
}

impl Grid {
    /// The box of the blocks from `from` up to `to`, exclusive.
    pub(crate) fn bounds(&self, from: [u32; 3], to: [u32; 3]) -> Bounds {
        let corner = |at: [u32; 3]| self.origin + self.side * DVec3::from_array(at.map(f64::from));
        Bounds::new(corner(from), corner(to))
    }
}

/// A block that the surface may cross.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Its place in the grid.
    pub(crate) index: [u32; 3],
    pub(crate) program: Program,
}

/// A range of blocks, with the program narrowed to a box that holds it.
struct Part {
    from: [u32; 3],
    to: [u32; 3],
    program: Program,
}

impl Part {
    fn size(&self) -> [u32; 3] {
        [self.to[0] - self.from[0], self.to[1] - self.from[1], self.to[2] - self.from[2]]
    }

    /// How many blocks it has: fewer than 2⁴⁴ cells' worth.
    fn volume(&self) -> u64 {
        self.size().map(u64::from).iter().product()
    }

    /// The two halves along the longest side; the upper one has the odd block.
    fn halves(self) -> [Part; 2] {
        let size = self.size();
        let axis = (0..3).rev().max_by_key(|&axis| size[axis]).unwrap_or(0);
        let middle = self.from[axis] + size[axis] / 2;
        let (mut below, mut above) = (self.to, self.from);
        below[axis] = middle;
        above[axis] = middle;
        [
            Part { from: self.from, to: below, program: self.program.clone() },
            Part { from: above, to: self.to, program: self.program },
        ]
    }
}

/// The blocks of `grid` that the surface may cross, in the order of the halvings: blocks that
/// follow each other are near each other, and often have one program. Every block grown by
/// `margin` length units on each side is narrowed as a whole. The order does not depend on the
/// number of threads.
pub(crate) fn surface_blocks(program: &Program, grid: &Grid, margin: f64, run: &Run) -> Result<Vec<Block>, Cancelled> {
    let root = Part { from: [0; 3], to: grid.blocks, program: program.clone() };
    let meter = Meter { run, done: AtomicU64::new(0), total: root.volume() };
    // Breadth first until there is work for every thread, then depth first in each part.
    let mut parts = vec![root];
    let wanted = 64 * rayon::current_num_threads().max(1);
    while parts.len() < wanted && parts.iter().any(|part| part.size() != [1; 3]) {
        let divided = |part: Part| {
            run.check()?;
            if part.size() == [1; 3] {
                return Ok(vec![part]);
            }
            let volume = part.volume();
            Ok(match narrowed(part, grid, margin) {
                Some(part) => Vec::from(part.halves()),
                None => {
                    meter.add(volume);
                    Vec::new()
                }
            })
        };
        let next: Result<Vec<Vec<Part>>, Cancelled> = parts.into_par_iter().map(divided).collect();
        parts = next?.into_iter().flatten().collect();
    }
    let found: Result<Vec<Vec<Block>>, Cancelled> =
        parts.into_par_iter().map(|part| descend(part, grid, margin, &meter)).collect();
    run.report(1.0);
    let found = found?;
    let mut blocks = Vec::with_capacity(found.iter().map(Vec::len).sum());
    found.into_iter().for_each(|list| blocks.extend(list));
    Ok(blocks)
}

fn descend(part: Part, grid: &Grid, margin: f64, meter: &Meter<'_>) -> Result<Vec<Block>, Cancelled> {
    let mut blocks = Vec::new();
    let mut pending = vec![part];
    while let Some(part) = pending.pop() {
        meter.run.check()?;
        let (volume, single) = (part.volume(), part.size() == [1; 3]);
        match narrowed(part, grid, margin) {
            Some(part) if !single => {
                let [below, above] = part.halves();
                pending.extend([above, below]);
            }
            found => {
                blocks.extend(found.map(|part| Block { index: part.from, program: part.program }));
                meter.add(volume);
            }
        }
    }
    Ok(blocks)
}

/// Counts the blocks that are decided.
struct Meter<'a> {
    run: &'a Run,
    done: AtomicU64,
    total: u64,
}

impl Meter<'_> {
    fn add(&self, blocks: u64) {
        let done = self.done.fetch_add(blocks, Ordering::Relaxed) + blocks;
        self.run.report(done as f64 / self.total as f64);
    }
}

/// The part with the program narrowed to it, if the surface may cross it.
fn narrowed(part: Part, grid: &Grid, margin: f64) -> Option<Part> {
    match part.program.narrow(&grid.bounds(part.from, part.to).inflate(margin)) {
        Region::Surface(program) => Some(Part { program, ..part }),
        Region::Inside | Region::Outside => None,
    }
}
