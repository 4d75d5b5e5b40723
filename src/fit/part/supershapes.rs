//! Three-dimensional supershapes for patches that superellipsoids do not explain: stars with round
//! backs, flowers, pumpkins.

use glam::DVec3;

use super::leaf::{Leaf, Shape};
use super::patches::Patch;
use super::pool::Pool;
use super::queries::Queries;
use super::samples::Samples;
use crate::fit::linear::Principal;
use crate::fit::random::Random;
use crate::fit::settings::FitSettings;
use crate::fit::shape_recover::{Best, recover_shape};
use crate::fit::supershape;
use crate::{Cancelled, Run};

/// Samples of a patch at least, and that are fitted at most.
pub(super) const FEWEST: usize = 150;
const MOST: usize = 600;

/// The share of the samples that a supershape must explain.
const LEAST: f64 = 0.6;

/// Puts the supershape of a patch among the candidates, if it explains most of it; `near` is how
/// far samples may be off.
pub(super) fn of_patch(
    pool: &mut Pool,
    patch: &Patch,
    samples: &Samples,
    near: f64,
    queries: &Queries,
    random: &mut Random,
    run: &Run,
) -> Result<(), Cancelled> {
    let order = random.chosen(patch.samples.len(), MOST);
    let chosen: Vec<usize> = order.into_iter().map(|i| patch.samples[i] as usize).collect();
    let own = || chosen.iter().map(|i| samples.points[*i]);
    let principal = Principal::of(own());
    let size = principal.variances.iter().sum::<f64>().sqrt().max(1e-6);
    let points: Vec<DVec3> = own().map(|p| (p - principal.mean) / size).collect();
    let run = Run { progress: None, ..run.clone() };
    let settings = FitSettings { seed: random.below(usize::MAX) as u64, ..FitSettings::default() };
    let found = recover_shape(&points, None, &settings, &run);
    run.check()?;
    // What is no shape is none of the part.
    let Some(Best::Shape(mixture)) = found.ok().map(|found| found.best) else { return Ok(()) };
    let leaf = Leaf {
        shape: Shape::Supersolid(supershape::leaf(&mixture.model, size)),
        rotation: mixture.model.rotation,
        centre: principal.mean + size * mixture.model.center,
    };
    let mut facing = [0_usize; 2];
    for i in &chosen {
        if leaf.distance(samples.points[*i]).abs() < near {
            let along = leaf.gradient(samples.points[*i]).dot(samples.normals[*i]);
            facing[0] += usize::from(along > 0.5);
            facing[1] += usize::from(along < -0.5);
        }
    }
    let outward = facing[0] > facing[1];
    if facing[0].max(facing[1]) as f64 >= LEAST * chosen.len() as f64 {
        pool.add(leaf, queries, [patch.may[0] && outward, patch.may[1] && !outward], None);
    }
    Ok(())
}
