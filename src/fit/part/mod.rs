//! Whole parts: from a closed mesh to an ordered tree of added and subtracted leaves.

mod bits;
mod boxes;
mod candidates;
mod finish;
mod freedom;
mod leaf;
mod model;
mod offsets;
mod outline;
mod pool;
mod queries;
mod recover;
mod refine;
mod regions;
mod result;
mod samples;
mod select;
#[cfg(test)]
mod select_tests;
mod settings;
mod snap;
mod sobol;

pub use result::{PartFit, PartLeaf, Topology, Unexplained};
pub use settings::{PartKinds, PartSettings};

use super::FitError;
use crate::Run;
use crate::geom::Mesh;

/// Recovers a whole part.
pub fn part(mesh: &Mesh, settings: &PartSettings) -> Result<PartFit, FitError> {
    part_with(mesh, settings, &Run::default())
}

/// [`part`] with a [`Run`].
pub fn part_with(mesh: &Mesh, settings: &PartSettings, run: &Run) -> Result<PartFit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    settings.check()?;
    run.install(|| recover::recover(mesh, settings, &run))
}
