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
use crate::Run;
use crate::eval::Program;

/// Cells of a block that the surface is in, as a rule.
const OF_BLOCK: usize = 110;

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
            suspect.cells.iter().any(|within| {
                let cell = [0, 1, 2].map(|axis| suspect.block[axis] + within[axis] as u32);
                let region = lattice.region(cell, 1);
                let is_inside = |p: DVec3| program.value(p) > 0.0;
                let first = is_inside(region.min);
                let node = |n: u32| {
                    let at = [n % (times + 1), n / (times + 1) % (times + 1), n / (times + 1).pow(2)];
                    region.min + region.size() * DVec3::from_array(at.map(f64::from)) / f64::from(times)
                };
                (0..(times + 1).pow(3)).any(|n| is_inside(node(n)) != first)
            })
        };
        Ok(suspects.par_iter().any(shows))
    }
}
