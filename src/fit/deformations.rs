//! The search for a deformed superellipsoid: closed-form starts along principal axes.
//!
//! Along the axis, the middle of a bent solid runs as a parabola, and the width of a tapered one
//! changes in proportion.

use std::f64::consts::FRAC_PI_4;

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::cost::Cost;
use super::deformable::Deformable;
use super::linear::{Principal, quantile, solved};
use super::samples::Samples;
use super::solve::{Problem, Robust};
use super::superquadric::Superquadric;
use crate::{Cancelled, Run};

/// The best model of a search, with what it took.
pub(super) struct Deformed {
    pub(super) model: Deformable,
    pub(super) noise: f64,
    pub(super) evaluations: usize,
    pub(super) tried: usize,
}

/// Points of the first fits, of those of the best few, and that starts are made of. The padding of
/// what is no multiple of 32 takes as long as points.
const FEW: usize = 96;
const MORE: usize = 320;
const SEEN: usize = 500;

/// A fit is as good as the noise where its deviation is below this times that of local planes.
const GOOD: f64 = 1.3;

/// Twists between the middle and an end that are tried where none fits.
const TWISTS: [f64; 2] = [0.9, -0.9];

/// Searches the points of a surface, which are in random order; `rough` is the deviation of local
/// planes.
pub(super) fn search(
    points: &[DVec3],
    rough: f64,
    quadric: &Superquadric,
    cost: Cost,
    run: &Run,
) -> Result<Deformed, Cancelled> {
    let first = |count: usize| Samples::<f32>::new(points[..count.min(points.len())].iter().copied());
    let (few, more) = (first(FEW), first(MORE));
    let (mut evaluations, mut tried) = (0, 0);
    let early = if cost == Cost::Normal { Cost::Radial } else { cost };
    let mut fit = |start: Deformable,
                   samples: &Samples<f32>,
                   cost,
                   [rounds, steps]: [usize; 2]|
     -> Result<(f64, Deformable), Cancelled> {
        run.check()?;
        let how = Robust { rounds, steps, width: 3.0, area: 0.3, gain: 1e-2 };
        let fitted = Problem { samples, cost }.robust(start, how);
        evaluations += fitted.evaluations;
        tried += 1;
        run.report(1.0 - 1.0 / (1.0 + 0.1 * tried as f64));
        Ok((fitted.deviation(samples.len()), fitted.model))
    };
    let mut starts = starts(&points[..points.len().min(SEEN)]);
    starts.push(Deformable { base: *quadric, taper: [0.0; 2], twist: 0.0, bend: DVec2::ZERO });
    let mut best: Option<(f64, Deformable)> = None;
    for round in 0..2 {
        if round == 1 {
            if best.is_some_and(|(noise, _)| noise < GOOD * rough) {
                break;
            }
            starts = TWISTS.iter().flat_map(|w| starts.iter().map(|s| s.twisted(*w)).collect::<Vec<_>>()).collect();
        }
        let mut found =
            starts.iter().map(|s| fit(*s, &few, early, [2, 5])).collect::<Result<Vec<(f64, Deformable)>, _>>()?;
        order::rising(&mut found, |a| a.0);
        for (_, model) in found.into_iter().take(3) {
            let next = fit(model, &more, cost, [3, 4])?;
            if best.as_ref().is_none_or(|b| next.0 < b.0) {
                best = Some(next);
            }
            if next.0 < GOOD * rough {
                break;
            }
        }
    }
    let (noise, model) = best.ok_or(Cancelled)?;
    Ok(Deformed { model, noise, evaluations, tried })
}

impl Deformable {
    fn twisted(&self, turn: f64) -> Deformable {
        Deformable { twist: turn / self.base.semi_axes.z, ..*self }
    }
}

/// For each principal axis as z, and turned by 45° about it.
fn starts(points: &[DVec3]) -> Vec<Deformable> {
    let principal = Principal::of(points.iter().copied());
    let mut starts = Vec::new();
    for k in 0..3 {
        let [x, y, z] = [0, 1, 2].map(|i| principal.axes.col((i + k) % 3));
        let axes = DMat3::from_cols(x, y, z);
        for (turn, e) in [(0.0, 0.8), (FRAC_PI_4, 0.3)] {
            starts.push(start(points, principal.mean, axes * DMat3::from_rotation_z(turn), e));
        }
    }
    starts
}

/// Parabolas of the middle, and straight lines of the width, along z.
fn start(points: &[DVec3], mean: DVec3, axes: DMat3, e: f64) -> Deformable {
    let local: Vec<DVec3> = points.iter().map(|p| axes.transpose() * (*p - mean)).collect();
    let mut heights: Vec<f64> = local.iter().map(|p| p.z).collect();
    let (low, high) = (quantile(&mut heights, 0.005), quantile(&mut heights, 0.995));
    let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(1e-3));
    let at = |p: &DVec3| (p.z - middle) / half;
    let polynomial = |values: &dyn Fn(&DVec3) -> f64, terms: usize, most: f64| -> [f64; 3] {
        let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        for p in local.iter().filter(|p| at(p).abs() < most) {
            let t = at(p);
            let row = [1.0, t, t * t];
            for i in 0..3 {
                right[i] += row[i] * values(p);
                for j in 0..=i {
                    matrix[i][j] += row[i] * row[j];
                }
            }
        }
        solved(&matrix, &right, &std::array::from_fn(|i| i < terms)).unwrap_or_default()
    };
    let across = [0, 1].map(|i| polynomial(&|p| p[i], 3, 1.0));
    let width = [0, 1].map(|i| {
        let [c0, c1, c2] = across[i];
        polynomial(&|p| (p[i] - c0 - (c1 + c2 * at(p)) * at(p)).abs(), 2, 0.85)
    });
    let bend = DVec2::new(across[0][2], across[1][2]) * (2.0 / (half * half));
    let a = width.map(|f| (1.5 * f[0]).max(1e-3));
    let base = Superquadric {
        e: [e, e],
        semi_axes: DVec3::new(a[0], a[1], half),
        rotation: axes,
        center: mean + axes * DVec3::new(across[0][0], across[1][0], middle),
    };
    let taper = width.map(|f| (f[1] / f[0].max(1e-6)).clamp(-0.6, 0.6));
    let most = (0.7 / half).min(0.6 / a[0].hypot(a[1]));
    Deformable { base, taper, twist: 0.0, bend: bend.clamp_length_max(most) }
}
