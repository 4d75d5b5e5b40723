//! A model with the lengths that it is meant to have, as far as it stays what it is.
//!
//! ```text
//!     found  →  laid through the vertices  →  axes, round numbers, cuts that go through
//!                                                    │
//!               leaves that do nothing left out  ←───┘
//!                      │
//!                      └  what spoils genus or shells is taken back: leaves, then lengths
//! ```

use std::collections::BTreeMap;

use glam::DVec3;

use super::super::error::FitError;
use super::intent::{Change, Free, Meant, changes, intended, is_settled};
use super::leaf::Leaf;
use super::measures::tilt;
use super::model::{Model, Step};
use super::refine;
use super::samples::Samples;
use super::select::Selector;
use super::snap;
use super::through::lengthened;
use super::topology::Topologies;
use crate::{Cancelled, Run};

/// The error may rise by so much where a leaf does nothing, or a cut goes through.
const IDLE: f64 = 1e-4;

/// Ends that are moved by less, in diagonals, are where they were: it is rounding.
const GRAIN: f64 = 1e-6;

/// A model, and what leaves of it are meant to be, by candidates.
pub(super) struct Snapped {
    pub(super) model: Model,
    pub(super) meant: BTreeMap<u32, Meant>,
}

/// The model as the vertices of a mesh, in diagonals, tell it.
pub(super) fn exact(
    selector: &mut Selector<'_>,
    found: Model,
    vertices: &[DVec3],
    samples: &Samples,
    topologies: &mut Topologies<'_>,
    run: &Run,
) -> Result<Snapped, FitError> {
    let Samples { centre, size, .. } = *samples;
    let laid = snap::snapped(&selector.leaves(&found.steps), vertices, run)?;
    let free = free(&laid, vertices, samples, run)?;
    let outward: Vec<(bool, Leaf)> = laid.iter().map(|(adds, leaf)| (*adds, leaf.outward(centre, size))).collect();
    let vertices: Vec<DVec3> = vertices.iter().map(|p| centre + size * *p).collect();
    let (outward, changes) = intended(&outward, &free, &vertices, size, run)?;
    let inward = outward.iter().map(|(adds, leaf)| (*adds, leaf.inward(centre, size))).collect();
    let steps = steps(selector, &found, inward);
    // What is taken back has its own numbers, and settled axes all the same.
    let mut meant = settled(&found.steps, &selector.leaves(&found.steps), &free, samples);
    for (i, (step, (_, leaf))) in steps.iter().zip(outward).enumerate() {
        let own = changes.iter().filter(|change| change.leaf == i).copied().collect();
        meant.insert(step.which, Meant { leaf, changes: own });
    }
    let exact = selector.model(steps);
    let model = harmless(selector, &found, exact, |model| topologies.off(selector, model))?;
    Ok(Snapped { model, meant })
}

/// Leaves as they are turned by what tells it best, in length units.
fn free(leaves: &[(bool, Leaf)], vertices: &[DVec3], samples: &Samples, run: &Run) -> Result<Vec<Free>, Cancelled> {
    let Samples { centre, size, .. } = *samples;
    let told = snap::turned(leaves, vertices, run)?;
    let sampled = refine::turned(leaves, samples, run)?;
    let free = |(told, sampled): (Option<Leaf>, Leaf)| Free {
        is_told: told.is_some(),
        leaf: told.unwrap_or(sampled).outward(centre, size),
    };
    Ok(told.into_iter().zip(sampled).map(free).collect())
}

/// Leaves in diagonals as they are, with what was settled of their axes, by candidates.
fn settled(
    steps: &[Step],
    leaves: &[(bool, Leaf)],
    free: &[Free],
    Samples { centre, size, .. }: &Samples,
) -> BTreeMap<u32, Meant> {
    let meant = |(i, (step, (_, leaf))): (usize, (&Step, &(bool, Leaf)))| {
        let leaf = leaf.outward(*centre, *size);
        let changes = free[i].turn(i, &leaf).filter(|_| is_settled(leaves, i)).into_iter().collect();
        (step.which, Meant { leaf, changes })
    };
    steps.iter().zip(leaves).enumerate().map(meant).collect()
}

/// The model with axes as nothing but vertices and samples tell them, where that is not for the
/// worse.
pub(super) fn unsettled(
    selector: &mut Selector<'_>,
    mut model: Model,
    vertices: &[DVec3],
    samples: &Samples,
    run: &Run,
) -> Result<Snapped, Cancelled> {
    let leaves = selector.leaves(&model.steps);
    let most = model.cost + IDLE;
    for (i, free) in free(&leaves, vertices, samples, run)?.into_iter().enumerate() {
        run.check()?;
        // Its sizes are no concern of vertices.
        let leaf = &leaves[i].1;
        let turned = leaf.turned_by(&tilt(&free.leaf.inward(samples.centre, samples.size), leaf));
        let mut steps = model.steps.clone();
        let may = selector.pool.candidates[steps[i].which as usize].may;
        steps[i].which = selector.pool.add(turned, selector.queries, may, None);
        let next = selector.model(steps);
        if next.cost < most {
            model = next;
        }
    }
    Ok(Snapped { model, meant: BTreeMap::new() })
}

/// What of a model with exact lengths may stay beside the one that was found. `off` tells how far
/// genus and shells are from those that are meant, if that is known.
fn harmless(
    selector: &Selector<'_>,
    found: &Model,
    exact: Model,
    mut off: impl FnMut(&Model) -> Result<Option<u64>, FitError>,
) -> Result<Model, FitError> {
    let fewer = without_idle(selector, &exact, |_| Ok(true))?;
    let Some(worst) = off(&fewer)?.filter(|off| *off > 0) else { return Ok(fewer) };
    let Some(before) = off(found)?.filter(|before| *before < worst) else { return Ok(fewer) };
    let mut best = (worst, fewer);
    if best.1.steps.len() < exact.steps.len() {
        let all = off(&exact)?.unwrap_or(worst);
        if all < worst {
            best = (all, without_idle(selector, &exact, |next| Ok(off(next)?.is_some_and(|off| off <= all)))?);
        }
    }
    for (exact, found) in exact.steps.iter().zip(&found.steps) {
        let Some(at) = best.1.steps.iter().position(|step| step == exact).filter(|_| best.0 > before) else { continue };
        let mut steps = best.1.steps.clone();
        steps[at] = *found;
        let next = selector.model(steps);
        if let Some(off) = off(&next)?.filter(|off| *off < best.0) {
            best = (off, next);
        }
    }
    Ok(if best.0 > before { found.clone() } else { best.1 })
}

/// The model without leaves that have nothing to do, as far as that is allowed.
fn without_idle(
    selector: &Selector<'_>,
    model: &Model,
    mut may: impl FnMut(&Model) -> Result<bool, FitError>,
) -> Result<Model, FitError> {
    let mut model = model.clone();
    let mut i = 0;
    while i < model.steps.len() {
        let mut steps = model.steps.clone();
        steps.remove(i);
        let next = selector.model(steps);
        let is_idle = next.cost < model.cost && selector.error(&next) < selector.error(&model) + IDLE;
        if is_idle && may(&next)? {
            model = next;
        } else {
            i += 1;
        }
    }
    Ok(model)
}

/// The steps of a model with other leaves in their places.
pub(super) fn steps(selector: &mut Selector<'_>, model: &Model, leaves: Vec<(bool, Leaf)>) -> Vec<Step> {
    let mut steps = model.steps.clone();
    for (step, (_, leaf)) in steps.iter_mut().zip(leaves) {
        let may = selector.pool.candidates[step.which as usize].may;
        step.which = selector.pool.add(leaf, selector.queries, may, None);
    }
    steps
}

/// The model with cuts that go through but for a skin, where that is not for the worse, and what
/// was settled of its axes.
pub(super) fn opened(
    selector: &mut Selector<'_>,
    mut model: Model,
    skin: f64,
    samples: &Samples,
    run: &Run,
) -> Result<Snapped, Cancelled> {
    let Samples { centre, size, .. } = *samples;
    let leaves = selector.leaves(&model.steps);
    let free = free(&leaves, &[], samples, run)?;
    let mut meant = settled(&model.steps, &leaves, &free, samples);
    for i in 0..model.steps.len() {
        run.check()?;
        let leaves = selector.leaves(&model.steps);
        let longer = if leaves[i].0 { None } else { lengthened(&leaves, i, 1.0, skin) };
        if let Some(longer) = longer {
            let may = selector.pool.candidates[model.steps[i].which as usize].may;
            let mut steps = model.steps.clone();
            let [old, leaf] = [&leaves[i].1, &longer].map(|leaf| leaf.outward(centre, size));
            steps[i].which = selector.pool.add(longer, selector.queries, may, None);
            let which = steps[i].which;
            let next = selector.model(steps);
            if next.cost < model.cost + IDLE {
                let numbers: Vec<f64> = leaf.measures().into_iter().map(|(_, v)| v).collect();
                // The other end is the same but for the last digits.
                let is_moved = |change: &Change| (change.to - change.from).abs() > GRAIN * size;
                let ends = changes(i, &old, &numbers).into_iter().filter(is_moved);
                let mut changes = meant.get(&model.steps[i].which).map_or(Vec::new(), |meant| meant.changes.clone());
                changes.extend(ends);
                meant.insert(which, Meant { changes, leaf });
                model = next;
            }
        }
    }
    Ok(Snapped { model, meant })
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3};

    use super::super::intent::Changed;
    use super::super::pool::Pool;
    use super::super::select_tests::{PRICE, asked};
    use super::*;
    use crate::{CancelToken, MeshSettings, Solid};

    #[test]
    fn what_spoils_the_topology_is_taken_back() {
        let block = |half: f64| Leaf::cuboid(DMat3::IDENTITY, [DVec3::splat(-half), DVec3::splat(half)]);
        let rod = |x: f64| Leaf::cylinder(DVec3::Z, DVec3::X * x, 0.1, [-0.35, 0.35]);
        let queries = asked(&[(true, block(0.3)), (false, rod(0.0))], DVec3::splat(0.36));
        let mut pool = Pool::new(PRICE);
        // The last cut of both is beside the block.
        let mut steps = |by: f64| {
            let leaves = [(true, block(0.3 + by)), (false, rod(by)), (false, rod(0.6 + by))];
            leaves.map(|(adds, leaf)| Step { adds, which: pool.add(leaf, &queries, [true; 2], None) }).to_vec()
        };
        let [found, exact] = [steps(1e-5), steps(0.0)];
        let selector = Selector { pool, queries: &queries, grids: Vec::new(), cancel: CancelToken::default() };
        let kept = |off: &dyn Fn(&[Step]) -> u64| {
            let [found, exact] = [&found, &exact].map(|steps| selector.model(steps.clone()));
            harmless(&selector, &found, exact, |model| Ok(Some(off(&model.steps)))).unwrap().steps
        };
        assert_eq!(kept(&|_| 0), exact[..2]);
        assert_eq!(kept(&|steps| u64::from(steps.contains(&exact[1]))), [exact[0], found[1]]);
        assert_eq!(kept(&|steps| u64::from(steps.len() < 3)), exact);
        assert_eq!(kept(&|steps| u64::from(steps != found)), found);
        // What was no better before is left as it is.
        assert_eq!(kept(&|_| 1), exact[..2]);
    }

    /// A blind hole under a skin: only the end that is moved is told.
    #[test]
    fn ends_that_stay_are_not_told() {
        let turn = DAffine3::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7);
        let block = Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(-0.4, -0.3, 0.0), DVec3::new(0.4, 0.3, 0.1)]);
        let hole = |end: f64| Leaf::cylinder(DVec3::Z, DVec3::new(0.1, 0.07, 0.0), 0.1, [0.05, end]).turned_by(&turn);
        let block = block.turned_by(&turn);
        let queries = asked(&[(true, block.clone()), (false, hole(0.2))], DVec3::splat(0.5));
        let mut pool = Pool::new(PRICE);
        let leaves = [(true, block), (false, hole(0.099))];
        let steps = leaves.map(|(adds, leaf)| Step { adds, which: pool.add(leaf, &queries, [true; 2], None) });
        let mut selector = Selector { pool, queries: &queries, grids: Vec::new(), cancel: CancelToken::default() };
        let model = selector.model(steps.to_vec());
        let mesh = Solid::cuboid([1.0; 3]).mesh(&MeshSettings::default()).unwrap();
        let samples = Samples::of_mesh(&mesh, 0, &Run::default()).unwrap();
        let samples = Samples { centre: DVec3::new(7.1, -3.3, 12.7), size: 61.7, ..samples };
        let meant = opened(&mut selector, model, 0.002, &samples, &Run::default()).unwrap().meant;
        let changes: Vec<Change> = meant.into_values().flat_map(|meant| meant.changes).collect();
        let is_end = |change: &&Change| matches!(change.of, Changed::Number(_));
        let [change] = changes.iter().filter(is_end).collect::<Vec<_>>()[..] else { panic!("{changes:?}") };
        assert!(change.of == Changed::Number(3) && change.to > change.from + 0.3, "{change:?}");
    }
}
