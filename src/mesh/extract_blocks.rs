//! Extraction of the surface in the blocks of a solid.

use super::blocks::Blocks;
use super::extract::{ExtractError, extract};
use super::lattice::Lattice;
use super::refine::Job;
use super::sampler::{BESIDE, SolidSampler};
use super::settings::Features;
use crate::Run;
use crate::geom::Mesh;

impl Blocks {
    /// The surface in the blocks, and in others where it goes on.
    pub(super) fn extract(&mut self, job: Job<'_>, lattice: &Lattice, run: &Run) -> Result<Mesh, ExtractError> {
        let Job { program: whole, limits, features, .. } = job;
        loop {
            let mut sampler = SolidSampler::new(lattice, self, limits, BESIDE);
            if features == Features::Sharp {
                sampler.look_for(job.crease(lattice));
            }
            match extract(&sampler, lattice, &self.cells, features, run) {
                Err(ExtractError::Rifts(rifts)) if self.mend(&rifts, whole, (lattice, &limits), |_| true, run)? => {}
                result => return result,
            }
        }
    }
}
