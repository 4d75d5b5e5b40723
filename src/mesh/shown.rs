//! What cells of a size show: how many there are, and whether smaller ones would show more.
//!
//! Cells whose nodes are on one side, though the surface may be in them, are asked at the nodes of
//! a finer lattice. Flush faces and acute edges are among them, and have nothing to show.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use super::blocks::Blocks;
use super::error::MeshingError;
use super::lattice::{CellSize, Lattice};
use super::resolve::{Among, Unresolved, unresolved_cells};
use super::subject::Subject;
use crate::eval::Program;
use crate::{Bounds, Run};

/// Cells of a block that the surface is in, as a rule.
const OF_BLOCK: usize = 110;

/// What is deeper than this, in cells, or has no other side near, is no bulge of a surface that the cells show.
const DEEP: f64 = 0.15;

/// Nearer to the surface than this part of the size, points may be on either side by rounding errors.
const ROUNDING: f64 = 1e-9;

impl Subject<'_> {
    /// About how many cells of a size the surface is in.
    pub(crate) fn cells(&self, cell: CellSize, run: &Run) -> Result<usize, MeshingError> {
        let lattice = Lattice::new(&self.bounds, cell)?;
        Ok(OF_BLOCK * Blocks::find(self.program, &lattice, run)?.cells.len())
    }

    /// Whether there is a cell, of a size, that has all its nodes on one side and nodes of cells that are so many
    /// times smaller on the other.
    pub(crate) fn shows_more(&self, cell: CellSize, times: u32, run: &Run) -> Result<bool, MeshingError> {
        let lattice = Lattice::new(&self.bounds, cell)?;
        let [to_find, to_search] = run.stages([0.2, 0.8]);
        let blocks = Blocks::find(self.program, &lattice, &to_find)?;
        let suspects = unresolved_cells(&blocks, (&lattice, self.bounds), Among::OneSided, &to_search)?;
        let programs: HashMap<[u32; 3], &Program> =
            blocks.cells.iter().enumerate().map(|(n, &block)| (block, blocks.programs.of(n))).collect();
        let shows = |suspect: &Unresolved| {
            let Some(program) = programs.get(&suspect.block) else { return false };
            let shows = |within: &[usize; 3]| {
                let cell = [0, 1, 2].map(|axis| suspect.block[axis] + within[axis] as u32);
                self.has_inner(&lattice.region(cell, 1), program, times)
            };
            suspect.cells.iter().any(shows)
        };
        Ok(suspects.par_iter().any(shows))
    }

    /// Whether a cell with all its nodes on one side has something of the other.
    fn has_inner(&self, cell: &Bounds, program: &Program, times: u32) -> bool {
        let step = cell.longest_side();
        let is_inside = program.value(cell.min) > 0.0;
        // How far points are on the other side.
        let depth = |p: &DVec3| {
            let (value, slope) = program.gradient(*p);
            if (value > 0.0) == is_inside { 0.0 } else { value.abs() / slope.length().max(f64::MIN_POSITIVE) }
        };
        let most = nodes(cell, times).map(|p| depth(&p)).fold(0.0, f64::max);
        let is_alone = || nodes(&cell.inflate(step), 3).all(|p| (self.program.value(p) > 0.0) == is_inside);
        most > ROUNDING * self.bounds.longest_side() && (most > DEEP * step || is_alone())
    }
}

/// The nodes of so many cells along each side of a box.
fn nodes(bounds: &Bounds, count: u32) -> impl Iterator<Item = DVec3> {
    let (min, step, side) = (bounds.min, bounds.size() / f64::from(count), count + 1);
    (0..side.pow(3))
        .map(move |n| min + step * DVec3::from_array([n % side, n / side % side, n / (side * side)].map(f64::from)))
}
