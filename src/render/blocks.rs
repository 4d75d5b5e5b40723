//! A solid prepared for rays: blocks that the surface may cross, each with its own program.
//!
//! Between its blocks the solid is all inside or all outside, so only the segments of a ray
//! in the blocks are looked at. All programs of a solid agree on the sign of any point, and
//! neighbouring segments share their end to the bit: a crossing at the border of two blocks
//! belongs to one of them and is never lost.

use glam::DVec3;
use rayon::prelude::*;

use super::walk::Walk;
use crate::eval::{Course, Hit, Program};
use crate::space::{Grid, surface_blocks};
use crate::{Bounds, Cancelled, Run};

/// Marks a block of the grid that the surface does not cross.
const EMPTY: u32 = u32::MAX;

/// The surface of a solid, by blocks.
pub(super) struct Blocks {
    grid: Grid,
    programs: Vec<(Program, Course)>,
    /// The number of each block's program, x first, or [`EMPTY`].
    numbers: Vec<u32>,
    /// Holds every segment with room to spare.
    reach: Bounds,
}

impl Blocks {
    /// The blocks of `program`, whose solid lies within `bounds` (finite, of some size):
    /// `across` of them along the longest side.
    pub(super) fn new(program: &Program, bounds: &Bounds, across: u32, run: &Run) -> Result<Blocks, Cancelled> {
        let longest = bounds.longest_side();
        // Room around the solid, so that rays start outside of it; not a round part of a
        // block, so that faces on round coordinates do not lie on planes of the grid.
        let bounds = bounds.inflate(0.37 * longest / f64::from(across.max(1)));
        let grid = Grid::over(&bounds, across);
        let distance = bounds.center().abs().max_element() + 1e3 * bounds.size().length();
        let margin = 1e-6 * grid.side + 16.0 * f64::EPSILON * distance;
        let blocks = surface_blocks(program, &grid, margin, run)?;
        let [nx, ny, nz] = grid.blocks.map(|count| count as usize);
        let mut numbers = vec![EMPTY; nx * ny * nz];
        for (number, block) in blocks.iter().enumerate() {
            numbers[place(&grid, block.index)] = number as u32;
        }
        let reach = grid.bounds([0; 3], grid.blocks).inflate(longest);
        let programs = blocks
            .into_par_iter()
            .map(|block| {
                let region = grid.bounds(block.index, block.index.map(|i| i + 1)).inflate(margin);
                let course = Course::new(&block.program, &region);
                (block.program, course)
            })
            .collect();
        Ok(Blocks { grid, programs, numbers, reach })
    }

    /// The first crossing on the ray from `origin` along `direction`, a unit vector.
    pub(super) fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        Walk::new(&self.grid, origin, direction).find_map(|segment| {
            let (program, course) = self.programs.get(self.numbers[place(&self.grid, segment.block)] as usize)?;
            course.first_hit(program, &self.reach, origin, direction, segment.near, segment.far)
        })
    }

    /// A length that is small for the solid, and large for the rounding of its points.
    pub(super) fn hair(&self) -> f64 {
        1e-7 * self.reach.longest_side()
    }
}

/// The place of a block in the list of all blocks.
fn place(grid: &Grid, [x, y, z]: [u32; 3]) -> usize {
    let [nx, ny, _] = grid.blocks.map(|count| count as usize);
    (z as usize * ny + y as usize) * nx + x as usize
}
