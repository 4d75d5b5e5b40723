//! Genus and shells: of a mesh, of a tree, and trees without the leaves that spoil them.
//!
//! ```text
//!      _________        A leaf that is nearly flush with another leaves a skin between them, or a slit: hardly any
//!     |_________|~      volume, but handles and shells. What the mesh has tells whether they are meant.
//! ```

use std::collections::HashMap;

use rvachev_num::order;

use super::super::error::FitError;
use super::leaf::Leaf;
use super::model::{Model, Step};
use super::result::Topology;
use super::samples::Samples;
use super::select::Selector;
use crate::error::MeshingError;
use crate::geom::Mesh;
use crate::{CellSize, Features, MeshSettings, RFunction, Run, Solid};

/// Cells along the longest side of the mesh that tells genus and shells, and of one that tells them
/// better.
const CELLS: [u32; 2] = [128, 384];

/// J may rise by so much where a leaf is left out for the topology.
const RISE: f64 = 0.004;

/// Leaves that are tried.
const TRIED: usize = 6;

/// What a mesh has.
pub(super) fn of_mesh(mesh: &Mesh, run: &Run) -> Result<Topology, FitError> {
    let report = mesh.check_with(run)?;
    Ok(Topology { genus: report.genus, shells: report.shells })
}

fn quiet(run: &Run) -> Run {
    Run { progress: None, ..run.clone() }
}

/// Leaves as one solid, in the order in which they are added and cut; all of a run at once.
pub(super) fn tree(leaves: impl IntoIterator<Item = (bool, Solid)>) -> Option<Solid> {
    let mut tree: Option<Solid> = None;
    let mut run: Vec<Solid> = Vec::new();
    let mut adds = true;
    let joined = |tree: Option<Solid>, adds: bool, mut run: Vec<Solid>| match (tree, adds, run.len()) {
        (tree, _, 0) => tree,
        (None, false, _) => None,
        (None, true, 1) => run.pop(),
        (None, true, _) => Some(Solid::union_all(run, RFunction::MIN_MAX)),
        (Some(tree), true, _) => Some(Solid::union_all([tree].into_iter().chain(run), RFunction::MIN_MAX)),
        (Some(tree), false, _) => Some(tree.difference_all(run, RFunction::MIN_MAX)),
    };
    for (next, leaf) in leaves {
        if next != adds {
            tree = joined(tree, adds, std::mem::take(&mut run));
            adds = next;
        }
        run.push(leaf);
    }
    joined(tree, adds, run)
}

/// The topologies of trees of a selector's leaves, each found once.
pub(super) struct Topologies<'a> {
    samples: &'a Samples,
    /// That of the input.
    meant: Topology,
    run: &'a Run,
    known: HashMap<(Vec<Step>, u32), Topology>,
}

impl<'a> Topologies<'a> {
    pub(super) fn new(samples: &'a Samples, meant: Topology, run: &'a Run) -> Topologies<'a> {
        Topologies { samples, meant, run, known: HashMap::new() }
    }

    fn of(&mut self, selector: &Selector<'_>, model: &Model, cells: u32) -> Result<Topology, FitError> {
        let key = (model.steps.clone(), cells);
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        let found = of_tree(&selector.leaves(&model.steps), self.samples, cells, self.run)?;
        self.known.insert(key, found);
        Ok(found)
    }

    /// How far a model's genus and shells are from those of the input; nothing if one is not known.
    pub(super) fn off(&mut self, selector: &Selector<'_>, model: &Model) -> Result<Option<u64>, FitError> {
        // Of points nothing is known that could be meant.
        Ok(if self.meant.genus.is_none() { None } else { apart(self.of(selector, model, CELLS[0])?, self.meant) })
    }
}

fn of_tree(leaves: &[(bool, Leaf)], samples: &Samples, cells: u32, run: &Run) -> Result<Topology, FitError> {
    let outward = leaves.iter().map(|(adds, leaf)| (*adds, leaf.outward(samples.centre, samples.size).solid()));
    let Some(solid) = tree(outward) else { return Ok(Topology::default()) };
    let cell = CellSize::LongestSide(cells);
    let settings = MeshSettings { cell, features: Features::Smooth, ..MeshSettings::default() };
    let made = match solid.mesh_with(&settings, &quiet(run)) {
        Ok(made) => made,
        Err(MeshingError::Cancelled(cancelled)) => return Err(cancelled.into()),
        // What cannot be meshed has none that is known.
        Err(_) => return Ok(Topology::default()),
    };
    let shells = made.components_with(&quiet(run))?.len();
    // It is closed and manifold: three edges a triangle, each of two of them; every vertex is used.
    let euler = made.positions().len() as i64 - made.triangles().len() as i64 / 2;
    Ok(Topology { genus: Some(shells as i64 - euler / 2), shells })
}

/// How far two are apart; nothing if one is not known.
fn apart(a: Topology, b: Topology) -> Option<u64> {
    Some(a.genus?.abs_diff(b.genus?) + a.shells.abs_diff(b.shells) as u64)
}

/// The model without leaves that spoil the topology and mend little, and its topology.
pub(super) fn mended(
    selector: &Selector<'_>,
    mut model: Model,
    topologies: &mut Topologies<'_>,
) -> Result<(Model, Topology), FitError> {
    let meant = topologies.meant;
    let mut found = topologies.of(selector, &model, CELLS[0])?;
    // Of points nothing is known that could be meant.
    if meant.genus.is_none() || apart(found, meant) == Some(0) {
        return Ok((model, found));
    }
    // It may be that a wall or a hole fell between the cells.
    let finer = topologies.of(selector, &model, CELLS[1])?;
    if apart(finer, meant) == Some(0) {
        return Ok((model, finer));
    }
    let limit = model.cost + RISE;
    let mut tried = 0;
    while let Some(off) = apart(found, meant).filter(|off| *off > 0) {
        let mut without: Vec<Model> = (0..model.steps.len())
            .map(|i| {
                let mut steps = model.steps.clone();
                steps.remove(i);
                selector.model(steps)
            })
            .filter(|next| next.cost < limit)
            .collect();
        order::rising(&mut without, |a| a.cost);
        let mut better = None;
        for next in without {
            if tried == TRIED {
                break;
            }
            tried += 1;
            let topology = topologies.of(selector, &next, CELLS[0])?;
            if apart(topology, meant).is_some_and(|next| next < off) {
                better = Some((next, topology));
                break;
            }
        }
        let Some((next, topology)) = better else { break };
        (model, found) = (next, topology);
    }
    Ok((model, found))
}
