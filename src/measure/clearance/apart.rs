//! The nearest points of two surfaces.
//!
//! The nearest points of their patches are found by [pairs](Patches::between), to within what is
//! known of the surfaces, and led from there to the surfaces themselves.

use glam::DVec3;
use rvachev_field::{Between, Loss};

use super::{Side, common, distance};
use crate::eval::Block;
use crate::query::nearest;
use crate::{Bounds, Cancelled, Run};

/// How near the least distance is found, as a part of it, and of the sizes of the solids.
const RELATIVE: f64 = 1e-3;
const OF_SIZES: f64 = 1e-5;

/// Patches are divided while they are off their triangles by more than this part of how exact the
/// surfaces are.
const FINE: f64 = 0.25;

/// Steps from one surface to the other and back that end the search.
const STEPS: usize = 30;

/// What was found of two surfaces.
pub(super) struct Found {
    /// The nearest points that were found, on the surfaces themselves.
    pub(super) points: [DVec3; 2],
    /// No points of the surfaces, but where these are in doubt, are nearer to each other.
    pub(super) least: f64,
    /// What that may be less by than the distance of the points, or more.
    pub(super) loss: f64,
    /// A point of both solids, if one was seen.
    pub(super) common: Option<DVec3>,
}

/// The nearest points of both surfaces.
pub(super) fn search(from: &Side<'_>, to: &Side<'_>, run: &Run) -> Result<Found, Cancelled> {
    let mut points = refined(from, to, greedy(from, to));
    let apart = |points: [DVec3; 2]| points[0].distance(points[1]);
    let slack = from.fineness() + to.fineness();
    let length = open(from, to);
    let mut least = 0.0;
    let within = common(from, to, slack, points[0]).or_else(|| common(to, from, slack, points[1]));
    // Else they touch, or cross each other, there.
    if within.is_none() && apart(points) > slack {
        let loss = Loss { part: RELATIVE, length: length - slack, fine: FINE * slack };
        let Between { least: found, nearest } =
            from.surface.patches.between(&to.surface.patches, apart(points), loss, run)?;
        if let Some((_, p)) = nearest {
            let nearer = refined(from, to, p);
            points = if apart(nearer) < apart(points) { nearer } else { points };
        }
        least = (found - slack).clamp(0.0, apart(points));
    }
    Ok(Found { points, least, loss: RELATIVE * apart(points) + length, common: within })
}

/// How much nearer than the nearest points others may be by how exact the surfaces are.
fn open(from: &Side<'_>, to: &Side<'_>) -> f64 {
    let sizes: f64 = [from, to].iter().map(|side| side.surface.patches.bounds().longest_side()).sum();
    // Where it is in doubt a surface may be nearer by that much in any case.
    let doubt = |side: &Side<'_>| if side.is_known { 0.0 } else { side.exactness() };
    let [fine, coarse] = [2.0 * (from.fineness() + to.fineness()), doubt(from) + doubt(to)];
    fine.max(coarse) + OF_SIZES * sizes
}

/// A point of the patches of one surface that is near the other, found by going down to the nearer
/// of two boxes.
fn greedy(from: &Side<'_>, to: &Side<'_>) -> DVec3 {
    let (runs, patches, others) = (from.surface.runs(), &from.surface.patches, &to.surface.patches);
    let far = |block: &Block| distance(others, runs.bounds(*block).center());
    let mut at = runs.all();
    let mut last = at;
    while let Some(block) = at {
        last = at;
        at = runs.parts(block).min_by(|a, b| far(a).total_cmp(&far(b)));
    }
    let points = last.into_iter().flat_map(|block| runs.patches(block)).map(|n| patches.point(n, [1.0 / 3.0; 2]));
    points.min_by(|a, b| distance(others, *a).total_cmp(&distance(others, *b))).unwrap_or_default()
}

/// The nearest points of the surfaces about a point: from each where the other is.
fn refined(from: &Side<'_>, to: &Side<'_>, p: DVec3) -> [DVec3; 2] {
    let there = to.surface.patches.nearest(p).map_or(p, |foot| foot.point);
    let mut points = [p, there];
    let mut apart = f64::INFINITY;
    for _ in 0..STEPS {
        let Some(there) = nearest(to.program, &to.surface.patches, points[0]) else { break };
        let Some(here) = nearest(from.program, &from.surface.patches, there) else { break };
        points = [here, there];
        let gain = apart - here.distance(there);
        apart = here.distance(there);
        if gain.abs() <= 1e-12 * apart {
            break;
        }
    }
    points
}

/// A ball about a box.
pub(super) fn ball(bounds: &Bounds) -> (DVec3, f64) {
    (bounds.center(), bounds.half_extents().length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::{compiled, surface_of};

    #[test]
    fn a_gap_that_is_even_is_told_from_both_sides() {
        let plate = Solid::cuboid([30.0, 30.0, 5.0]) - Solid::cylinder(5.1, 10.0);
        let solids = [Solid::cylinder(5.0, 20.0), plate];
        let programs = solids.each_ref().map(|solid| compiled(solid).unwrap());
        let surfaces = solids.each_ref().map(|solid| surface_of(solid).unwrap());
        let [peg, plate] = [0, 1].map(|n| Side::new(&programs[n], &surfaces[n], false));
        for (from, to) in [(&peg, &plate), (&plate, &peg)] {
            let found = search(from, to, &Run::default()).unwrap();
            assert!(found.least > 0.08 && found.least <= 0.1 && found.loss < 0.015, "{}, {}", found.least, found.loss);
        }
    }
}
