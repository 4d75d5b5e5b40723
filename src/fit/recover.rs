//! From points to a superellipsoid: what is dense, the table, the search, the last steps.

use glam::DVec3;

use super::check::check_depth;
use super::cost::Cost;
use super::density::{Dense, dense};
use super::error::FitError;
use super::grid::{extent, volume};
use super::kernel::residuals;
use super::local::{Local, local};
use super::mixture::{Mixture, Polish, Weighed};
use super::plane::table;
use super::random::Random;
use super::samples::Samples;
use super::search::Search;
use super::superquadric::{PARAMETERS, Superquadric};
use crate::{Cancelled, Run};

/// Points of the first of the last steps, of a surface that is seen all around, and of one side.
const SOME: [usize; 2] = [320, 416];

/// Points further from the surface than so many standard deviations, and than this length, are not
/// of it, unless fewer are left than these.
const REACH: [f64; 2] = [12.0, 0.03];
const FEWEST: usize = 24;

/// They are looked for if more than this share is strewn.
const FEW: f64 = 0.05;

/// How a fit came about.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Effort {
    pub(super) evaluations: usize,
    pub(super) tried: usize,
}

/// What the points of a surface tell before a model is fitted.
pub(super) struct Scene {
    /// The points of the surface, in random order.
    pub(super) surface: Vec<DVec3>,
    pub(super) local: Local,
    pub(super) strewn: f64,
    pub(super) volume: f64,
}

impl Scene {
    pub(super) fn of(points: &[DVec3], normals: Option<&[DVec3]>, random: &mut Random) -> Scene {
        let Dense { kept, strewn } = dense(points);
        let order: Vec<usize> = random.chosen(kept.len(), kept.len()).into_iter().map(|i| kept[i]).collect();
        let surface: Vec<DVec3> = order.iter().map(|i| points[*i]).collect();
        let normals: Option<Vec<DVec3>> = normals.map(|normals| order.iter().map(|i| normals[*i]).collect());
        let local = local(&surface, normals.as_deref(), random);
        Scene { surface, local, strewn, volume: volume(extent(points)) }
    }
}

/// A superellipsoid among points, with what it took.
pub(super) struct Recovered {
    pub(super) mixture: Mixture<Superquadric>,
    /// What it says of the points that it was fitted to; what is far counts as infinitely far.
    pub(super) weighed: Weighed<PARAMETERS>,
    pub(super) effort: Effort,
    pub(super) one_sided: bool,
    rough: f64,
    /// The points of the table were left out.
    pub(super) table: Option<super::plane::Table>,
}

impl Recovered {
    /// How well it explains the points that it was fitted to.
    pub(super) fn criterion(&self) -> f64 {
        self.mixture.criterion(self.weighed.residuals.iter().copied())
    }
}

/// Fits points, which are to be of a size near 1.
pub(super) fn recover(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    cost: Cost,
    seed: u64,
    run: &Run,
) -> Result<Recovered, FitError> {
    let mut random = Random::new(seed);
    let scene = Scene::of(points, normals, &mut random);
    check_depth(&scene.surface)?;
    let found = table(&scene.surface, &mut random);
    let whole = fit(points, &scene, cost, run)?;
    let Some(table) = found else { return Ok(whole) };
    let left: Vec<usize> = (0..points.len()).filter(|i| !table.holds(points[*i])).collect();
    let some: Vec<DVec3> = left.iter().map(|i| points[*i]).collect();
    let some_normals: Option<Vec<DVec3>> = normals.map(|normals| left.iter().map(|i| normals[*i]).collect());
    let scene = Scene::of(&some, some_normals.as_deref(), &mut random);
    let mut beside = fit(&some, &scene, cost, run)?;
    let effort = Effort {
        evaluations: whole.effort.evaluations + beside.effort.evaluations,
        tried: whole.effort.tried + beside.effort.tried,
    };
    let explained = |recovered: &Recovered| 1.0 - recovered.mixture.strewn;
    let more = explained(&whole) < explained(&beside) - 0.05;
    // What is flat may be a face of the object, which then is as smooth as its neighbourhoods are.
    let rough = whole.mixture.noise > 1.5 * whole.rough;
    let finer = whole.mixture.noise > 1.6 * beside.mixture.noise && explained(&whole) < explained(&beside) + 0.05;
    let mut chosen = if more || rough && finer {
        beside.table = Some(table);
        beside
    } else {
        whole
    };
    chosen.effort = effort;
    Ok(chosen)
}

/// A superellipsoid of a scene, whatever it stands on.
pub(super) fn fit(points: &[DVec3], scene: &Scene, cost: Cost, run: &Run) -> Result<Recovered, Cancelled> {
    fit_by(points, scene, cost, true, run)
}

/// The same, or without a search among other encodings and extreme exponents.
pub(super) fn fit_by(
    points: &[DVec3],
    scene: &Scene,
    cost: Cost,
    thorough: bool,
    run: &Run,
) -> Result<Recovered, Cancelled> {
    let mut search = Search::new(&scene.surface, &scene.local, cost, run);
    let best = search.search(thorough)?;
    let mut effort = Effort { evaluations: search.evaluations, tried: search.tried };
    let mut mixture = Mixture {
        model: best.model,
        noise: best.noise.max(1e-6),
        strewn: scene.strewn.clamp(1e-3, 0.9),
        volume: scene.volume,
        log_area: None,
    };
    let one_sided = scene.local.view.is_some();
    let area = if one_sided { 0.8 } else { 0.4 };
    let stage = |rounds, steps, all| Polish { rounds, steps, area, all, cost };
    let mut random = Random::new(points.len() as u64);
    let some = random.chosen(points.len(), SOME[usize::from(one_sided)]);
    let samples = Samples::<f32>::new(some.into_iter().map(|i| points[i]));
    effort.evaluations += mixture.polish(&samples, stage(2, if one_sided { 4 } else { 2 }, samples.len())).evaluations;
    // Where hardly any are strewn there is nothing to be left out.
    let near: Vec<usize> = if mixture.strewn > FEW {
        effort.evaluations += points.len();
        near(points, &mixture)
    } else {
        (0..points.len()).collect()
    };
    let (rounds, steps) = if one_sided { (3, 2) } else { (1, 1) };
    let own = || near.iter().map(|i| points[*i]);
    effort.evaluations += mixture.polish(&Samples::<f32>::new(own()), stage(rounds, steps, points.len())).evaluations;
    let (mut weighed, last) = mixture.settle(&Samples::new(own()), stage(1, 1, points.len()));
    effort.evaluations += last;
    if near.len() < points.len() {
        weighed.residuals = spread(&near, &weighed.residuals, points.len(), f64::INFINITY);
        weighed.chances = spread(&near, &weighed.chances, points.len(), 0.0);
    }
    Ok(Recovered { mixture, weighed, effort, one_sided, rough: scene.local.rough, table: None })
}

/// Values of some of `count` points among those of all.
fn spread(at: &[usize], values: &[f64], count: usize, other: f64) -> Vec<f64> {
    let mut all = vec![other; count];
    for (i, value) in at.iter().zip(values) {
        all[*i] = *value;
    }
    all
}

/// The points that may be of the surface: of the others the last steps know without asking.
fn near(points: &[DVec3], mixture: &Mixture<Superquadric>) -> Vec<usize> {
    let samples = Samples::<f32>::new(points.iter().copied());
    let mut off = vec![0.0; samples.padded()];
    residuals(&mixture.model, &samples, Cost::Normal, &mut off);
    let reach = (REACH[0] * mixture.noise).max(REACH[1]) as f32;
    let near: Vec<usize> = (0..points.len()).filter(|i| off[*i].abs() <= reach).collect();
    if near.len() < FEWEST { (0..points.len()).collect() } else { near }
}
