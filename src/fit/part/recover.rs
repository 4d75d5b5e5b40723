//! From a mesh to a tree of leaves.

use glam::DVec3;

use super::super::check::check_depth;
use super::super::error::FitError;
use super::bits::WORD;
use super::body::Body;
use super::boxes::Grid;
use super::candidates::propose;
use super::finish::finish;
use super::intent::Meant;
use super::model::Model;
use super::offsets::grid;
use super::pool::Pool;
use super::queries::{Queries, Strip, Told};
use super::refine::refined;
use super::regions::{Form, Region, Regions, detect};
use super::result::PartFit;
use super::samples::{Kind, Samples};
use super::select::Selector;
use super::settings::PartSettings;
use super::snapping::{Snapped, exact, opened, steps, unsettled};
use super::times::{Clock, PartTimes};
use super::topology::{Topologies, mended};
use super::{profiles, residual, superellipsoids};
use crate::field::COORDINATE_LIMIT;
use crate::fit::cloud::SIZES;
use crate::fit::grid::extent;
use crate::geom::{Mesh, PointCloud};
use crate::{Bounds, Run};
use rvachev_num::jobs;

/// How far pairs are from the surface on either side, in diagonals, without noise.
const APART: f64 = 0.004;

/// The same of holes, at the least, in their radii, and in noise.
const LEAST_APART: f64 = 0.0015;
const NARROW: f64 = 0.15;
const NOISE: f64 = 2.2;

/// The least part of the pairs of a region, and of a hole that goes nearly all around.
const SHARES: [f64; 2] = [0.004, 0.012];

/// A hole goes nearly all around from this arc on, in degrees.
const AROUND: f64 = 300.0;

/// J may rise by so much where leaves are moved onto the surface.
const ALLOWED_RISE: f64 = 1e-4;

/// While so much is wrong leaves are looked for that explain it, so many times.
const LEFT: f64 = 0.005;
const ROUNDS: usize = 2;

/// What takes so many leaves is of no leaves: more would take long, and explain little.
const MANY: usize = 24;

/// Another round is worth its time if less than this part of what was wrong is left.
const WORTH: f64 = 0.9;

/// Skins of scans, which are thinner than this in diagonals or than noise has them, are none.
const SKIN: f64 = 0.002;

/// Points of a cloud at least.
const FEWEST: usize = 200;

/// Vertices that lengths are judged by, at most.
const VERTICES: usize = 3000;

/// Recovers a part from a mesh.
pub(super) fn recover(mesh: &Mesh, settings: &PartSettings, run: &Run) -> Result<PartFit, FitError> {
    // Of a mesh of many triangles most of the time goes here.
    let large = (mesh.triangles().len() as f64 / 2e6).min(0.5);
    let [to_index, to_sample, to_rest] = run.stages([0.05 + large, 0.01 + 0.5 * large, 0.95]);
    let points: Vec<DVec3> = mesh.positions().iter().map(|p| p.as_dvec3()).collect();
    if mesh.triangles().len() < 4 {
        return Err(FitError::TooFew { kind: "part", points: points.len(), parameters: 4, needed: 4 });
    }
    check(&points)?;
    let mut clock = Clock::start();
    let body = Body::of_mesh(mesh, &to_index)?;
    let mut samples = Samples::of_mesh(mesh, settings.seed, &to_sample)?;
    samples.noise = settings.noise / samples.size;
    let vertices = vertices(mesh, &samples);
    let hollow = FitError::Hollow { of: "triangles", count: mesh.triangles().len() };
    let times = PartTimes { sampling: clock.lap(), ..PartTimes::default() };
    recovered(&body, samples, &vertices, hollow, settings, times, &to_rest)
}

/// Recovers a part from points.
pub(super) fn recover_points(cloud: &PointCloud, settings: &PartSettings, run: &Run) -> Result<PartFit, FitError> {
    let points = cloud.positions();
    if points.len() < FEWEST {
        return Err(FitError::TooFew { kind: "part", points: points.len(), parameters: 4, needed: FEWEST });
    }
    check(points)?;
    let mut clock = Clock::start();
    let [to_sample, to_rest] = run.stages([if cloud.normals().is_none() { 0.3 } else { 0.02 }, 0.7]);
    let samples = Samples::of_cloud(cloud, settings.noise, settings.seed, &to_sample)?;
    run.check()?;
    let [low, high] = extent(points);
    let hollow = FitError::Hollow { of: "points", count: points.len() };
    let Some(body) = Body::of_points(&samples, Bounds::new(low, high)) else { return Err(hollow) };
    let times = PartTimes { sampling: clock.lap(), ..PartTimes::default() };
    recovered(&body, samples, &[], hollow, settings, times, &to_rest)
}

/// The part that samples are of.
fn recovered(
    body: &Body,
    samples: Samples,
    vertices: &[DVec3],
    hollow: FitError,
    settings: &PartSettings,
    mut times: PartTimes,
    run: &Run,
) -> Result<PartFit, FitError> {
    let mut clock = Clock::start();
    let [to_detect, to_label, to_propose, to_search, to_select, to_settle, to_finish] =
        run.stages([0.1, 0.2, 0.1, 0.25, 0.15, 0.1, 0.1]);
    let regions = detect(&samples, settings.seed, &to_detect)?;
    times.detection = clock.lap();
    to_detect.report(1.0);
    let queries = queries(body, &samples, &regions, settings.seed, &to_label)?;
    times.queries = clock.lap();
    to_label.report(1.0);
    if queries.inside.is_none() {
        return Err(hollow);
    }
    let mut selector = selector(body, &samples, &regions, &queries, settings, &to_propose)?;
    times.proposals = clock.lap();
    let model = selector.search(&to_search)?;
    times.selection = clock.lap();
    let model = moved(&mut selector, model, &samples, &to_select)?;
    times.refinement = clock.lap();
    let mut model = selector.improve(model, &to_select)?;
    times.selection += clock.lap();
    for _ in 0..ROUNDS {
        let before = selector.error(&model);
        if before <= LEFT * (1.0 + samples.noise / 0.001) || model.steps.len() > MANY {
            break;
        }
        residual::propose(&mut selector, &model, &samples, &regions, settings, &to_select)?;
        times.proposals += clock.lap();
        let next = selector.select(model.steps.clone(), &to_select)?;
        times.selection += clock.lap();
        let next = moved(&mut selector, next, &samples, &to_select)?;
        times.refinement += clock.lap();
        let next = selector.improve(next, &to_select)?;
        times.selection += clock.lap();
        let is_better = next.cost < model.cost;
        let after = selector.error(&next);
        if is_better {
            model = next;
        }
        if !is_better || after > WORTH * before {
            break;
        }
    }
    let Samples { centre, size, .. } = samples;
    let mut topologies = Topologies::new(&samples, body.topology, &to_settle);
    let snapped = match settings.snap {
        true if vertices.is_empty() => {
            opened(&mut selector, model, SKIN.max(3.0 * samples.noise), &samples, &to_select)?
        }
        true => exact(&mut selector, model, vertices, &samples, &mut topologies, &to_select)?,
        false => unsettled(&mut selector, model, vertices, &samples, &to_select)?,
    };
    let Snapped { model, meant } = snapped;
    times.snapping = clock.lap();
    to_select.report(1.0);
    if model.steps.is_empty() {
        return Err(FitError::NoSurface { inliers: 0.0 });
    }
    let (model, topology) = mended(&selector, model, &mut topologies)?;
    times.topology = clock.lap();
    to_settle.report(1.0);
    let leaves = selector.leaves(&model.steps);
    // What has no round numbers goes outwards as it is.
    let meant = (model.steps.iter().zip(&leaves))
        .map(|(step, (_, leaf))| {
            meant.get(&step.which).cloned().unwrap_or_else(|| Meant::of(leaf.outward(centre, size)))
        })
        .collect();
    let mut fit = finish(&leaves, meant, body, &samples, queries.spread(), topology, &to_finish)?;
    times.measures = clock.lap();
    fit.times = times;
    run.report(1.0);
    Ok(fit)
}

/// The vertices that triangles use, evenly thinned, in diagonals.
fn vertices(mesh: &Mesh, samples: &Samples) -> Vec<DVec3> {
    let mut used = vec![false; mesh.positions().len()];
    mesh.triangles().iter().flatten().for_each(|v| used[*v as usize] = true);
    let all = mesh.positions().iter().zip(used).filter(|(_, used)| *used).map(|(p, _)| p.as_dvec3());
    let all: Vec<DVec3> = all.map(|p| (p - samples.centre) / samples.size).collect();
    let step = all.len().div_ceil(VERTICES).max(1);
    all.into_iter().step_by(step).collect()
}

/// That points have a size that solids may have.
fn check(points: &[DVec3]) -> Result<(), FitError> {
    let farthest = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if farthest > COORDINATE_LIMIT {
        let (property, allowed) = ("from the origin", "at most 1000000000");
        return Err(FitError::Extent { property, value: farthest, allowed });
    }
    let [low, high] = extent(points);
    let size = low.distance(high);
    if !(SIZES[0]..=SIZES[1]).contains(&size) {
        let (property, allowed) = ("in size", "0.00001 to 10000000");
        return Err(FitError::Extent { property, value: size, allowed });
    }
    check_depth(points)
}

/// Points in space and about the surface, with their sides.
fn queries(body: &Body, samples: &Samples, regions: &Regions, seed: u64, run: &Run) -> Result<Queries, FitError> {
    let half = 0.5 * body.bounds.size() / samples.size;
    let rest = unexplained(samples, &regions.regions);
    let mut strips: Vec<Strip<'_>> = (regions.regions.iter())
        .map(|region| Strip { samples: &region.points, share: share(region), apart: apart(region, samples) })
        .collect();
    let left: f64 = rest.iter().map(|i| samples.weights[*i as usize]).sum();
    strips.push(Strip { samples: &rest, share: left, apart: APART.max(NOISE * samples.noise) });
    let told = if samples.kind == Kind::Scan { Told::ByPoints } else { Told::ByWinding };
    Ok(Queries::new([-half, half], [&samples.points, &samples.normals], &strips, seed, told, |points| {
        let numbers = |points: &[DVec3]| {
            run.check()?;
            Ok(points.iter().map(|p| body.winding_number(samples.centre + samples.size * *p)).collect::<Vec<_>>())
        };
        let numbers = jobs::try_chunks(points, WORD, |_, chunk| numbers(chunk))?;
        Ok(numbers.concat())
    })?)
}

/// How far pairs are from a region: of narrow holes nearer, so that a countersink differs from its
/// bore.
fn apart(region: &Region, samples: &Samples) -> f64 {
    let (Form::Cylinder { radius, .. } | Form::Cone { radius, .. }) = region.form else {
        return APART.max(NOISE * samples.noise);
    };
    let least = if samples.kind == Kind::Cad { LEAST_APART } else { APART };
    (NARROW * radius).clamp(least, APART).max(NOISE * samples.noise)
}

/// The samples that are of no region.
fn unexplained(samples: &Samples, regions: &[Region]) -> Vec<u32> {
    let mut is_left = vec![true; samples.points.len()];
    for i in regions.iter().flat_map(|region| &region.points) {
        is_left[*i as usize] = false;
    }
    (0..is_left.len() as u32).filter(|i| is_left[*i as usize]).collect()
}

/// A region's part of the pairs: small holes count, as they are few points but a handle each.
fn share(region: &Region) -> f64 {
    let is_hole = match region.form {
        Form::Cylinder { arc, .. } | Form::Cone { arc, .. } => region.sign < 0.0 && arc > AROUND,
        _ => false,
    };
    region.share.max(if is_hole { SHARES[1] } else { SHARES[0] })
}

/// All candidates, ready to be chosen from.
fn selector<'a>(
    body: &Body,
    samples: &Samples,
    regions: &Regions,
    queries: &'a Queries,
    settings: &PartSettings,
    run: &Run,
) -> Result<Selector<'a>, FitError> {
    let kinds = settings.kinds;
    let mut pool = Pool::new(settings.parameter_cost * (1.0 + samples.noise / 0.001));
    let low = samples.points.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = samples.points.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    propose(&mut pool, samples, &regions.regions, [low, high], queries, kinds, run)?;
    if kinds.superellipsoids || kinds.supershapes {
        superellipsoids::propose(&mut pool, samples, regions, queries, kinds, settings.seed, run)?;
    }
    if kinds.profiles || kinds.prisms || kinds.supershapes {
        profiles::propose(&mut pool, body, samples, regions, queries, kinds, run)?;
    }
    run.check()?;
    let mut grids: Vec<Grid> = Vec::new();
    if kinds.boxes {
        for frame in &regions.frames {
            run.check()?;
            grids.push(grid(*frame, &regions.regions, &samples.points, queries));
        }
    }
    Ok(Selector { pool, queries, grids, cancel: run.cancel.clone() })
}

/// The model with its leaves moved onto the surface, where that is not for the worse.
fn moved(selector: &mut Selector<'_>, model: Model, samples: &Samples, run: &Run) -> Result<Model, FitError> {
    let fitted = refined(&selector.leaves(&model.steps), samples, run)?;
    let steps = steps(selector, &model, fitted);
    let all = selector.model(steps.clone());
    let mut best = model;
    if all.cost < best.cost + ALLOWED_RISE {
        best = all;
    } else {
        for (i, step) in steps.iter().enumerate() {
            let mut one = best.steps.clone();
            one[i] = *step;
            let one = selector.model(one);
            if one.cost < best.cost + ALLOWED_RISE {
                best = one;
            }
        }
    }
    Ok(best)
}
