//! Leaves for what a tree leaves unexplained.
//!
//! ```text
//!      _______                  T \ S   what is missing: boxes between the planes near it
//!     |       |_..              S \ T   what is too much: the same, to be cut
//!     |_______|  .              and where no leaf makes the surface: superellipsoids of the samples there
//!             '.:'
//! ```
//!
//! The first search looks for boxes between the largest planes of the whole part only, and for
//! superellipsoids of patches without creases. Here few planes are near, so that all of them count,
//! and what the other leaves explain does not hide what is beside it.

use glam::DVec3;
use rvachev_num::order;

use super::model::Model;
use super::offsets::grid;
use super::patches::{FEWEST, Patch};
use super::places::places;
use super::refine::owner;
use super::regions::{Region, Regions};
use super::samples::Samples;
use super::select::Selector;
use super::settings::PartSettings;
use super::superellipsoids;
use crate::fit::random::Random;
use crate::{Cancelled, Run};

/// The side of cells by which wrong points hang together, in diagonals.
const CELL: f64 = 0.03;

/// Places with fewer wrong points are left as they are, and so many places are looked at.
const FEW: usize = 12;
const MOST: usize = 3;

/// Samples farther from the tree's surface than this are of nothing that is there.
const FAR: f64 = 0.006;

/// Puts leaves among the candidates for what a model has wrong.
pub(super) fn propose(
    selector: &mut Selector<'_>,
    model: &Model,
    samples: &Samples,
    regions: &Regions,
    settings: &PartSettings,
    run: &Run,
) -> Result<(), Cancelled> {
    let PartSettings { kinds, seed, .. } = *settings;
    let queries = selector.queries;
    let leaves = selector.leaves(&model.steps);
    let far = FAR.max(3.0 * samples.noise);
    let left = (0_u32..).zip(&samples.points).filter(|(_, p)| owner(&leaves, **p).1.abs() > far);
    let mut random = Random::new(seed);
    for place in places(left.map(|(i, p)| (*p, i)), CELL) {
        run.check()?;
        if kinds.superellipsoids && place.len() >= FEWEST {
            let patch = Patch { samples: place.into_iter().map(|(_, i)| i).collect(), may: [true, true] };
            superellipsoids::of_patch(&mut selector.pool, &patch, samples, regions, queries, &mut random);
        }
    }
    if !kinds.boxes {
        return Ok(());
    }
    let mut wrong = Vec::new();
    for set in [queries.inside.without(&model.state), model.state.without(&queries.inside)] {
        wrong.extend(places(set.each().map(|i| (queries.points[i], ())), CELL));
    }
    wrong.retain(|place| place.len() >= FEW);
    order::falling(&mut wrong, |place| place.len() as f64);
    selector.grids.truncate(regions.frames.len());
    for place in wrong.into_iter().take(MOST) {
        run.check()?;
        for frame in &regions.frames {
            let to = frame.transpose();
            let local = || place.iter().map(|(p, ())| to * *p);
            let low = local().fold(DVec3::INFINITY, DVec3::min) - CELL;
            let high = local().fold(DVec3::NEG_INFINITY, DVec3::max) + CELL;
            let is_near = |region: &&Region| {
                let mut points = region.points.iter().map(|i| to * samples.points[*i as usize]);
                points.any(|p| p.cmpge(low).all() && p.cmple(high).all())
            };
            let near: Vec<Region> = regions.regions.iter().filter(is_near).cloned().collect();
            selector.grids.push(grid(*frame, &near, &[*frame * low, *frame * high], queries));
        }
    }
    Ok(())
}
