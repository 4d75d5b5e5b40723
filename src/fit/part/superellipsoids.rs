//! Superellipsoids for what planes, cylinders, cones, spheres and tori do not explain.
//!
//! ```text
//!     starts: frames × 3 polar axes × exponents     robust Levenberg–Marquardt, small areas preferred
//!     from the third round on a sample counts only where the model faces as its normal does
//! ```
//!
//! Each patch gives its best models; whether they are worth their parameters is for the selection.

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::balls;
use super::leaf::{Leaf, Shape};
use super::patches::{Patch, patches};
use super::pool::Pool;
use super::queries::Queries;
use super::regions::Regions;
use super::samples::{Kind, Samples};
use super::settings::PartKinds;
use super::supershapes;
use crate::fit::cost::Cost;
use crate::fit::linear::Principal;
use crate::fit::random::Random;
use crate::fit::samples::Samples as Columns;
use crate::fit::solve::{Fitted, Problem};
use crate::fit::superquadric::Superquadric;
use crate::{Cancelled, Run, Superellipsoid};

/// Patches that regions explain to this share are left to these.
const EXPLAINED: f64 = 0.85;

/// Samples that starts are tried on, and that the best are fitted to.
const FEW: usize = 100;
const MORE: usize = 400;

/// Models kept of a patch.
const KEPT: usize = 2;

/// Exponents to begin with.
const STARTS: [[f64; 2]; 3] = [[0.3, 0.3], [1.0, 1.0], [0.3, 1.0]];

/// Rounds of weights, and steps of each.
const ROUNDS: usize = 5;
const STEPS: usize = 4;

/// A model must explain so many samples, and so large a share of its patch.
const FEWEST: usize = 20;
const LEAST: f64 = 0.3;

/// Semi-axes at most, in sizes of the patch.
const LARGE: f64 = 4.0;

/// Of which superellipsoids explain less, supershapes are looked for, of so many patches.
const ENOUGH: f64 = 0.7;
const SUPERSHAPES: usize = 3;

/// Puts superellipsoids among the candidates, and supershapes where these are not enough.
pub(super) fn propose(
    pool: &mut Pool,
    samples: &Samples,
    regions: &Regions,
    queries: &Queries,
    kinds: PartKinds,
    seed: u64,
    run: &Run,
) -> Result<(), Cancelled> {
    // What is of no region counts last.
    let mut of_region = vec![regions.regions.len(); samples.points.len()];
    for (number, region) in regions.regions.iter().enumerate() {
        region.points.iter().for_each(|i| of_region[*i as usize] = number);
    }
    let mut random = Random::new(seed);
    // The largest have the first claim.
    let mut of_surface = patches(samples);
    order::falling(&mut of_surface, |patch| patch.samples.len() as f64);
    let of_surface = of_surface.into_iter().map(|patch| (patch, true));
    let of_balls = balls::patches(samples, &mut random).into_iter().map(|patch| (patch, false));
    let mut supershapes_left = if kinds.supershapes { SUPERSHAPES } else { 0 };
    for (patch, is_whole) in of_surface.chain(of_balls).collect::<Vec<_>>() {
        run.check()?;
        let mut counts = vec![0_usize; regions.regions.len() + 1];
        for i in &patch.samples {
            counts[of_region[*i as usize]] += 1;
        }
        // Where facets are large what regions explain together is made of these; else several of
        // them may be taken for what is round.
        let explained = match samples.kind {
            Kind::Cad => counts[..regions.regions.len()].iter().sum(),
            _ => counts[..regions.regions.len()].iter().max().map_or(0, |count| *count),
        };
        if explained as f64 >= EXPLAINED * patch.samples.len() as f64 {
            continue;
        }
        let share =
            if kinds.superellipsoids { of_patch(pool, &patch, samples, regions, queries, &mut random) } else { 0.0 };
        let is_left = is_whole && share < ENOUGH && patch.samples.len() >= supershapes::FEWEST;
        if is_left && supershapes_left > 0 {
            supershapes_left -= 1;
            supershapes::of_patch(pool, &patch, samples, 1.5 * regions.eps, queries, &mut random, run)?;
        }
    }
    Ok(())
}

/// Puts the superellipsoids of a patch among the candidates; the share of it that the best one
/// explains.
pub(super) fn of_patch(
    pool: &mut Pool,
    patch: &Patch,
    samples: &Samples,
    regions: &Regions,
    queries: &Queries,
    random: &mut Random,
) -> f64 {
    let scene = Scene::new(patch, samples, regions, random);
    let models = scene.models();
    let best = models.first().map_or(0.0, |(share, _)| *share);
    for (_, model) in models {
        let Superquadric { e: [e1, e2], semi_axes, rotation, center } = model;
        let leaf = Leaf {
            shape: Shape::Superellipsoid(Superellipsoid::new(scene.size * semi_axes, e1, e2)),
            rotation,
            centre: scene.centre + scene.size * center,
        };
        let outward = scene.outward(&model);
        pool.add(leaf, queries, [patch.may[0] && outward, patch.may[1] && !outward], None);
    }
    best
}

/// A patch brought to a size near 1 about 0.
struct Scene {
    /// In random order.
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    frames: Vec<DMat3>,
    centre: DVec3,
    size: f64,
    /// How far a sample may be from its model, in sizes.
    near: f64,
}

impl Scene {
    fn new(patch: &Patch, samples: &Samples, regions: &Regions, random: &mut Random) -> Scene {
        let order = random.chosen(patch.samples.len(), MORE);
        let chosen: Vec<usize> = order.into_iter().map(|i| patch.samples[i] as usize).collect();
        let own: Vec<DVec3> = chosen.iter().map(|i| samples.points[*i]).collect();
        let principal = Principal::of(own.iter().copied());
        let size = principal.variances.iter().sum::<f64>().sqrt().max(1e-6);
        let points = own.iter().map(|p| (*p - principal.mean) / size).collect();
        let normals = chosen.iter().map(|i| samples.normals[*i]).collect();
        let mut frames = vec![principal.axes];
        frames.extend(regions.frames.iter().take(2));
        Scene { points, normals, frames, centre: principal.mean, size, near: 1.5 * regions.eps / size }
    }

    /// The best models, different ones, with the shares of the samples that they explain.
    fn models(&self) -> Vec<(f64, Superquadric)> {
        let few = self.points.len().min(FEW);
        let first = Columns::<f32>::new(self.points[..few].iter().copied());
        let all = Columns::<f32>::new(self.points.iter().copied());
        let mut tried: Vec<(f64, Superquadric)> = Vec::new();
        for start in self.starts() {
            let model = self.fitted(start, &first, few, Cost::Radial);
            tried.push((self.share(&model, few), model));
        }
        order::falling(&mut tried, |a| a.0);
        let mut kept: Vec<(f64, Superquadric)> = Vec::new();
        for (_, model) in tried.into_iter().take(2 * KEPT) {
            let count = self.points.len();
            let model = self.fitted(model, &all, count, Cost::Normal);
            let share = self.share(&model, count);
            let is_new = kept.iter().all(|(_, other)| {
                let apart = other.center.distance(model.center);
                apart > 0.05 || (other.semi_axes.element_product() / model.semi_axes.element_product()).ln().abs() > 0.1
            });
            // A model much larger than its patch is of some other shape there.
            let fits = model.semi_axes.max_element() < LARGE;
            if share > LEAST && share * count as f64 > FEWEST as f64 && is_new && fits {
                kept.push((share, model));
            }
        }
        order::falling(&mut kept, |a| a.0);
        kept.truncate(KEPT);
        kept
    }

    fn starts(&self) -> Vec<Superquadric> {
        let mut starts = Vec::new();
        for frame in &self.frames {
            let local = self.points.iter().map(|p| frame.transpose() * *p);
            let (low, high) =
                local.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
            let (centre, half) = (*frame * (0.5 * (low + high)), (0.5 * (high - low)).max(DVec3::splat(0.05)));
            for k in 0..3 {
                let [x, y, z] = [0, 1, 2].map(|i| (i + k) % 3);
                let rotation = DMat3::from_cols(frame.col(x), frame.col(y), frame.col(z));
                let semi_axes = DVec3::new(half[x], half[y], half[z]);
                starts.extend(STARTS.map(|e| Superquadric { e, semi_axes, rotation, center: centre }));
            }
        }
        starts
    }

    /// A robust fit.
    fn fitted(&self, start: Superquadric, samples: &Columns<f32>, count: usize, cost: Cost) -> Superquadric {
        let problem = Problem { samples, cost };
        let mut fitted = Fitted::new(start, samples, cost);
        let mut weights = vec![0.0_f32; samples.padded()];
        for round in 0..ROUNDS {
            let noise = fitted.deviation(count).min(0.5).max(0.2 * self.near);
            let mut sum = 0.0;
            for (i, (weight, residual)) in weights[..count].iter_mut().zip(&fitted.residuals).enumerate() {
                let faces = round < 2 || self.faces(&fitted.model, i) != 0.0;
                let off = f64::from(*residual) / (3.0 * noise);
                let counts = if faces { (1.0 + off * off).powi(-2) } else { 0.0 };
                *weight = counts as f32;
                sum += counts;
            }
            let area = if round == 0 { 0.0 } else { 0.3 * noise * noise * sum };
            problem.descend(&mut fitted, &weights, [area, noise * noise], STEPS, 1e-3);
        }
        fitted.model
    }

    /// 1 where the model faces as the sample does, −1 where the other way round, 0 where across.
    fn faces(&self, model: &Superquadric, i: usize) -> f64 {
        let Superquadric { e: [e1, e2], semi_axes, rotation, center } = *model;
        let shape = Superellipsoid::new(semi_axes, e1, e2);
        let local = rotation.transpose() * (self.points[i] - center);
        let normal = rotation.transpose() * self.normals[i];
        let step = 1e-3;
        let slope = (shape.gauge(local + step * normal) - shape.gauge(local - step * normal)) / (2.0 * step);
        // The gauge grows by 1 in a semi-axis at least.
        let steep = 0.2 / semi_axes.max_element();
        if slope.abs() < steep { 0.0 } else { slope.signum() }
    }

    /// Whether most samples face as the model does.
    fn outward(&self, model: &Superquadric) -> bool {
        (0..self.points.len().min(FEW)).map(|i| self.faces(model, i)).sum::<f64>() > 0.0
    }

    /// The share of the first samples that are near the model and face as most do.
    fn share(&self, model: &Superquadric, count: usize) -> f64 {
        let Superquadric { e: [e1, e2], semi_axes, rotation, center } = *model;
        let shape = Superellipsoid::new(semi_axes, e1, e2);
        let mut facing = [0_usize; 2];
        for i in 0..count {
            let local = rotation.transpose() * (self.points[i] - center);
            if shape.radial_distance(local).abs() < self.near {
                let faces = self.faces(model, i);
                facing[0] += usize::from(faces > 0.0);
                facing[1] += usize::from(faces < 0.0);
            }
        }
        facing[0].max(facing[1]) as f64 / count.max(1) as f64
    }
}
