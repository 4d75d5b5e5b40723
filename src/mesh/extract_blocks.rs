//! Extraction of the surface in the blocks of a solid.

use super::blocks::Blocks;
use super::extract::{ExtractError, extract};
use super::lattice::Lattice;
use super::sampler::{BESIDE, SolidSampler};
use super::settings::Features;
use crate::eval::Program;
use crate::geom::Mesh;
use crate::{Bounds, Run};

impl Blocks {
    /// The surface in the blocks, and in others where it goes on.
    pub(super) fn extract(
        &mut self,
        whole: &Program,
        (lattice, limits): (&Lattice, Bounds),
        features: Features,
        run: &Run,
    ) -> Result<Mesh, ExtractError> {
        loop {
            let mut sampler = SolidSampler::new(lattice, self, limits, BESIDE);
            if features == Features::Sharp {
                sampler.keep_tapes();
            }
            match extract(&sampler, lattice, &self.cells, features, run) {
                Err(ExtractError::Mismatches(mismatches))
                    if self.repair(&mismatches, whole, (lattice, &limits), |_| true, run)? => {}
                result => return result,
            }
        }
    }
}
