//! Holes: clusters of points that are inside of a body by more than the noise, each fitted as a
//! body is, and subtracted.

use glam::DVec3;

use super::scene::{NOTHING, Scene, beside};
use super::segment::supershape_of;
use super::truncated::Truncated;
use super::whole::{Part, Whole};
use crate::fit::error::FitError;
use crate::fit::gielis;
use crate::fit::settings::FitSettings;
use crate::{Cancelled, Run};

/// Points that are so deep, in sizes of the body, are of a hole at least.
const DEEP: f64 = 3.0 * NOTHING;

/// Clusters of fewer points are left alone: they do not tell a supershape.
const FEWEST: usize = 2 * gielis::PARAMETERS + 2;

/// A hole must take this share of the error of its points.
const TAKEN: f64 = 0.5;

/// The longest link of a cluster, in spacings of the points.
const LINK: f64 = 4.0;

/// A hole is longer than its points at an open end by these half-widths at least, and at most: as
/// far as the box of the body reaches.
const THROUGH: [f64; 2] = [0.4, 2.0];

/// What is a hole of a body.
pub(super) struct Depth {
    /// Points deeper than this.
    pub(super) least: f64,
}

impl Depth {
    /// By the noise of a body of this size.
    pub(super) fn of(body: &Truncated, noise: f64, times: f64) -> Depth {
        let size = body.shape.semi_axes.max_element().min(body.bounds.half.max_element());
        Depth { least: (times * noise).max(DEEP * size) }
    }
}

/// Subtracts holes from a part of the whole; the evaluations that it took.
pub(super) fn drill(
    scene: &Scene,
    whole: &mut Whole,
    at: usize,
    depth: &Depth,
    settings: &FitSettings,
    run: &Run,
) -> Result<usize, FitError> {
    let body = whole.parts[at].body;
    let deep: Vec<f64> = scene.points.iter().map(|p| body.depth(*p)).collect();
    let inside: Vec<usize> = (0..deep.len()).filter(|i| deep[*i] > depth.least).collect();
    let mut evaluations = 0;
    for cluster in clusters(scene, &inside) {
        let points = scene.points_of(&cluster);
        let found = match supershape_of(&points, scene.normals_of(&cluster).as_deref(), settings, run) {
            Ok(found) => found,
            Err(FitError::Cancelled(cancelled)) => return Err(cancelled.into()),
            // A flat patch is no hole.
            Err(_) => continue,
        };
        evaluations += found.evaluations;
        // The end of a hole is open where its points come near the skin.
        let skin = 2.0 * depth.least + 2.0 * scene.near.spacing;
        let hole = scene.truncated(
            &cluster,
            &found,
            |bounds, side, on| beside(bounds, side, on, &scene.points).iter().any(|i| deep[*i] < skin),
            |side, bounds| {
                let half = bounds.half[side.axis];
                let beyond = body.bounds.end_along(side.direction(bounds), bounds.center) - half;
                skin + beyond.clamp(THROUGH[0] * half, THROUGH[1] * half)
            },
        );
        let facing = |(p, n): (&DVec3, &DVec3)| hole.shape.outwards(*p).dot(*n) < 0.0;
        if let Some(normals) = scene.normals_of(&cluster)
            && 2 * points.iter().zip(&normals).filter(|both| facing(*both)).count() < points.len()
        {
            continue;
        }
        let before = [whole.error(&points, run)?, whole.error(&scene.points, run)?];
        whole.parts[at].holes.push(hole);
        let after = [whole.error(&points, run)?, whole.error(&scene.points, run)?];
        // NaN is no less.
        let is_better = after[0] < (1.0 - TAKEN) * before[0] && after[1] < before[1];
        if !is_better {
            whole.parts[at].holes.pop();
        }
    }
    Ok(evaluations)
}

/// Points that hang together, from the largest cluster on.
fn clusters(scene: &Scene, inside: &[usize]) -> Vec<Vec<usize>> {
    let mut is_inside = vec![false; scene.points.len()];
    inside.iter().for_each(|i| is_inside[*i] = true);
    let link = LINK * scene.near.spacing;
    let mut all = Vec::new();
    for &start in inside {
        if !std::mem::replace(&mut is_inside[start], false) {
            continue;
        }
        let mut cluster = vec![start];
        let mut next = 0;
        while next < cluster.len() {
            let i = cluster[next];
            next += 1;
            for &j in scene.near.of(i) {
                let j = j as usize;
                if is_inside[j] && scene.points[i].distance(scene.points[j]) <= link {
                    is_inside[j] = false;
                    cluster.push(j);
                }
            }
        }
        if cluster.len() >= FEWEST {
            cluster.sort_unstable();
            all.push(cluster);
        }
    }
    all.sort_by(|a, b| b.len().cmp(&a.len()).then(a.cmp(b)));
    all
}

/// Which of the bodies are holes of others: most of their normals face inwards or, of points
/// without normals, most are deep inside of another body.
pub(super) fn negative(
    scene: &Scene,
    parts: &[Part],
    members: &[Vec<usize>],
    depths: &[Depth],
    run: &Run,
) -> Result<Vec<bool>, Cancelled> {
    let mut is_negative = Vec::new();
    for (k, of) in members.iter().enumerate() {
        run.check()?;
        let most = |count: usize| 5 * count > 4 * of.len();
        is_negative.push(match &scene.normals {
            Some(normals) => {
                let body = &parts[k].body;
                most(of.iter().filter(|i| body.shape.outwards(scene.points[**i]).dot(normals[**i]) < 0.0).count())
            }
            None => parts.iter().zip(depths).enumerate().any(|(other, (part, depth))| {
                let is_deep = |i: &&usize| part.body.depth(scene.points[**i]) > depth.least;
                other != k && most(of.iter().filter(is_deep).count())
            }),
        });
    }
    if is_negative.iter().all(|negative| *negative) {
        // Normals that all face inwards are a matter of convention.
        is_negative.fill(false);
    }
    Ok(is_negative)
}
