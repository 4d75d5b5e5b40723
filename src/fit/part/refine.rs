//! Leaves moved onto the surface, each by the samples that it makes the surface at.
//!
//! ```text
//!     v = max(v, −d)  of what is added,   v = min(v, d)  of what is cut:     one leaf decides at each sample
//! ```
//!
//! So a residual depends on the parameters of one leaf only, and each is fitted alone: robust
//! Levenberg–Marquardt (Geman and McClure), only samples whose normals agree.

use glam::{DMat3, DQuat, DVec3};

use super::freedom::{Axes, MOST};
use super::leaf::Leaf;
use super::samples::{Kind, Samples};
use crate::fit::linear::solved;
use crate::{Cancelled, Run};

/// Rounds of finding owners and fitting.
const ROUNDS: i32 = 4;

/// Steps of a fit.
const STEPS: usize = 4;

/// Where weights fall off in the first round, and at last without noise.
const WIDTHS: [f64; 2] = [0.012, 0.0015];

/// Where weights fall off of leaves of regions in the first round.
const NARROW: f64 = 0.004;

/// Normals that agree, as a cosine.
const AGREE: f64 = 0.5;

/// A step for derivatives.
const STEP: f64 = 1e-6;

/// Which leaf decides at a point, and the signed distance there, negative inside; none of no
/// leaves.
pub(super) fn owner(leaves: &[(bool, Leaf)], p: DVec3) -> (Option<usize>, f64) {
    let (mut owner, mut value) = (None, f64::INFINITY);
    for (i, (adds, leaf)) in leaves.iter().enumerate() {
        let distance = leaf.distance(p);
        if *adds && distance < value {
            (owner, value) = (Some(i), distance);
        } else if !adds && -distance > value {
            (owner, value) = (Some(i), -distance);
        }
    }
    (owner, value)
}

/// The leaves, fitted to the samples.
pub(super) fn refined(leaves: &[(bool, Leaf)], samples: &Samples, run: &Run) -> Result<Vec<(bool, Leaf)>, Cancelled> {
    let mut leaves = leaves.to_vec();
    for round in 0..ROUNDS {
        run.check()?;
        let least = WIDTHS[1].max(1.5 * samples.noise);
        let width = (WIDTHS[0] * 0.5_f64.powi(round)).max(least);
        // Corners of a mesh have told the others, which samples of facets are inside of.
        let is_told = |leaf: &Leaf| samples.kind == Kind::Cad && !leaf.is_free();
        let own = owned(&leaves, samples, 3.0 * width, |leaf| !is_told(leaf));
        for ((_, leaf), own) in leaves.iter_mut().zip(own) {
            run.check()?;
            // What was found by its own region is nearly there, and would be drawn off by what is
            // beside it.
            let width = if leaf.is_free() { width } else { width.min(NARROW.max(least)) };
            if !is_told(leaf) && own.len() >= 2 * leaf.freedom(Axes::Kept) {
                *leaf = fitted(leaf, Axes::Kept, &own, width, |leaf, p| leaf.distance(p));
            }
        }
    }
    Ok(leaves)
}

/// By leaf, of those that are asked for, the samples that it makes the surface at, to within a
/// distance, and that face as it does, with their weights.
fn owned(
    leaves: &[(bool, Leaf)],
    samples: &Samples,
    near: f64,
    is_asked: impl Fn(&Leaf) -> bool,
) -> Vec<Vec<(DVec3, f64)>> {
    let mut own = vec![Vec::new(); leaves.len()];
    for ((p, normal), weight) in samples.points.iter().zip(&samples.normals).zip(&samples.weights) {
        if let (Some(i), value) = owner(leaves, *p)
            && value.abs() < near
            && is_asked(&leaves[i].1)
        {
            let (adds, leaf) = &leaves[i];
            let sign = if *adds { 1.0 } else { -1.0 };
            if sign * leaf.gradient(*p).dot(*normal) > AGREE {
                own[i].push((*p, *weight));
            }
        }
    }
    own
}

/// The leaves, where they are if turned as their samples tell; where these are too few, as they
/// were.
pub(super) fn turned(leaves: &[(bool, Leaf)], samples: &Samples, run: &Run) -> Result<Vec<Leaf>, Cancelled> {
    let width = WIDTHS[1].max(1.5 * samples.noise);
    let turned = |((_, leaf), own): (&(bool, Leaf), Vec<(DVec3, f64)>)| {
        run.check()?;
        if leaf.turns() == 0 || own.len() < 2 * leaf.freedom(Axes::Free) {
            return Ok(leaf.clone());
        }
        let mut free = fitted(leaf, Axes::Free, &own, width, |leaf, p| leaf.distance(p));
        if leaf.turns() < 3 {
            // About its own axis it was not settled.
            let [from, to] = [leaf, &free].map(|leaf| leaf.rotation.z_axis);
            free.rotation = DMat3::from_quat(DQuat::from_rotation_arc(from, to)) * leaf.rotation;
        }
        Ok(free)
    };
    // What a settled axis is off may be more than noise.
    leaves.iter().zip(owned(leaves, samples, WIDTHS[0].max(3.0 * width), |_| true)).map(turned).collect()
}

/// A leaf fitted to what is weighted, of which each is to be at no distance from it.
pub(super) fn fitted<T: Copy>(
    leaf: &Leaf,
    axes: Axes,
    own: &[(T, f64)],
    width: f64,
    distance: impl Fn(&Leaf, T) -> f64,
) -> Leaf {
    let count = leaf.freedom(axes);
    let mut leaf = leaf.clone();
    let cost = |leaf: &Leaf| -> f64 {
        let of = |(p, weight): &(T, f64)| {
            let square = (distance(leaf, *p) / width).powi(2);
            weight * square / (1.0 + square)
        };
        own.iter().map(of).sum()
    };
    let mut before = cost(&leaf);
    let mut damping = 1e-4;
    for _ in 0..STEPS {
        let nearby: Vec<Option<Leaf>> = (0..count)
            .map(|k| {
                let mut x = [0.0; MOST];
                x[k] = STEP;
                leaf.moved(&x, axes)
            })
            .collect();
        let (mut hessian, mut right) = ([[0.0; MOST]; MOST], [0.0; MOST]);
        for (p, weight) in own {
            let p = *p;
            let off = distance(&leaf, p);
            let weight = weight / (1.0 + (off / width).powi(2)).powi(2);
            let mut slopes = [0.0; MOST];
            for (slope, near) in slopes.iter_mut().zip(&nearby) {
                *slope = near.as_ref().map_or(0.0, |near| (distance(near, p) - off) / STEP);
            }
            for a in 0..count {
                right[a] -= weight * slopes[a] * off;
                for b in 0..=a {
                    hessian[a][b] += weight * slopes[a] * slopes[b];
                }
            }
        }
        let largest = (0..count).map(|a| hessian[a][a]).fold(0.0, f64::max);
        // What no sample tells of stays.
        let mut free = [false; MOST];
        for a in 0..count {
            free[a] = hessian[a][a] > 1e-6 * largest;
            hessian[a][a] *= 1.0 + damping;
        }
        let Some(step) = solved(&hessian, &right, &free) else { break };
        let Some(next) = leaf.moved(&step.map(|x| x.clamp(-0.05, 0.05)), axes) else { break };
        let after = cost(&next);
        if after < before {
            let gain = before - after;
            (leaf, before) = (next, after);
            damping *= 0.1;
            if gain < 1e-4 * before {
                break;
            }
        } else {
            damping *= 100.0;
        }
    }
    leaf
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::super::leaf_tests::leaves;
    use super::super::snap;
    use super::*;
    use crate::{CellSize, MeshSettings, Solid};

    /// Samples, and vertices where there are such, tell turns of settled axes, whatever the leaf
    /// is. What is turned by every fit, and about its own axis, stays as it was fitted.
    #[test]
    fn turns_of_settled_axes_are_told_of_every_kind() {
        let tilt = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.008);
        for truth in leaves() {
            let kind = truth.kind();
            let turn = |by: DMat3| Leaf { rotation: truth.rotation * by, ..truth.clone() };
            // A half-space has an end here.
            let there = turn(tilt).outward(DVec3::ZERO, 20.0).solid() & Solid::sphere(14.0);
            let coarse = MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() };
            let mesh = there.mesh(&coarse).unwrap();
            let samples = Samples::of_mesh(&mesh, 0, &Run::default()).unwrap();
            let inward = |leaf: Leaf| leaf.outward(DVec3::ZERO, 20.0).inward(samples.centre, samples.size);
            let (settled, right) = (inward(truth.clone()), inward(turn(tilt)));
            let some = mesh.positions().iter().step_by(mesh.positions().len().div_ceil(400));
            let vertices: Vec<DVec3> = some.map(|p| (p.as_dvec3() - samples.centre) / samples.size).collect();
            let leaves = [(true, settled.clone())];
            let sampled = turned(&leaves, &samples, &Run::default()).unwrap().swap_remove(0);
            let told = snap::turned(&leaves, &vertices, &Run::default()).unwrap().swap_remove(0);
            let off = |leaf: &Leaf| leaf.rotation.z_axis.angle_between(right.rotation.z_axis);
            if truth.turns() == 0 {
                assert!(sampled.rotation == settled.rotation && told.is_none(), "{kind}");
                continue;
            }
            assert!(off(&sampled) < 5e-4, "{kind}: {}", off(&sampled));
            let own = settled.rotation.transpose() * sampled.rotation;
            let about_itself = 0.5 * (own.x_axis.y - own.y_axis.x);
            assert!(about_itself.abs() < 1e-4 || truth.turns() == 3, "{kind}: {about_itself}");
            let told = told.unwrap_or_else(|| panic!("{kind}: vertices tell nothing"));
            assert!(off(&told) < 5e-5, "{kind}: {}", off(&told));
        }
    }
}
