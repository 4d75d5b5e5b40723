//! Cells that may hide a feature thinner than they are.
//!
//! ```text
//!     o-------o       A wall passes between the nodes: all are outside, and the mesh has nothing.
//!     |  ===  |       The value's range over the cell contains 0 then; and as the gradient is
//!     o-------o       turned round within the wall, so does the range of each of its components.
//! ```
//!
//! Blocks are halved until the ranges show that a part has no surface, or that the value is
//! monotone along some axis in it, or until it is a cell.

use rayon::prelude::*;

use super::lattice::Lattice;
use super::meter::Meter;
use super::signs::BLOCK;
use crate::eval::Program;
use crate::{Bounds, Cancelled, Dual, Interval, Run};

/// The number of cells, of the given blocks, whose programs are told by their numbers, all of whose nodes are on one side,
/// though the ranges of the value and of each component of the gradient contain 0.
pub(super) fn unresolved_cells<'a>(
    lattice: &Lattice,
    blocks: &[[u32; 3]],
    program: impl Fn(usize) -> &'a Program + Sync,
    run: &Run,
) -> Result<usize, Cancelled> {
    let meter = Meter::new(run, blocks.len());
    let of_block = |(n, &block): (usize, &[u32; 3])| {
        meter.step()?;
        let program = program(n);
        let mut open = vec![(block, BLOCK as u32)];
        let (mut count, mut memory) = (0, Vec::new());
        while let Some((cell, size)) = open.pop() {
            let node = |by: u32| lattice.node(cell[0] + by, cell[1] + by, cell[2] + by);
            if is_settled(program, &Bounds::new(node(0), node(size)), &mut memory) {
                continue;
            }
            if size > 1 {
                let half = size / 2;
                open.extend((0..8u32).map(|n| (std::array::from_fn(|axis| cell[axis] + (n >> axis & 1) * half), half)));
            } else {
                let corner = |n: u32| lattice.node(cell[0] + (n & 1), cell[1] + (n >> 1 & 1), cell[2] + (n >> 2));
                let inside = (0..8).filter(|&n| program.value(corner(n)) > 0.0).count();
                count += usize::from(inside == 0 || inside == 8);
            }
        }
        Ok(count)
    };
    blocks.par_iter().enumerate().map(of_block).sum()
}

/// Whether a box has no surface, or none that turns round.
fn is_settled(program: &Program, region: &Bounds, memory: &mut Vec<Dual<Interval>>) -> bool {
    let range = program.range(region);
    if range.lo() > 0.0 || range.hi() < 0.0 {
        return true;
    }
    let side = |axis: usize| Interval::new(region.min[axis], region.max[axis]);
    let over = program.evaluate(Dual::point([side(0), side(1), side(2)]), memory);
    let excludes_0 = |range: &Interval| range.lo() > 0.0 || range.hi() < 0.0;
    excludes_0(&over.value()) || over.gradient().iter().any(excludes_0)
}
