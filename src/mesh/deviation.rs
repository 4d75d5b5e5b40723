//! How far the triangles of a mesh are from the surface of its solid.
//!
//! ```text
//!            c
//!           / \          The middle of a triangle and those of its sides are compared with the
//!          x   x         surface, and its corners are. Two Newton steps along the gradient lead
//!         /  x  \        from each to the surface: the foot.
//!        a---x---b
//! ```

use glam::DVec3;

use super::slopes::{Slope, Slopes};
use crate::geom::Mesh;
use crate::{Cancelled, Run};

/// A point that is compared with the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    /// The triangle that it is in, or a corner of.
    pub(super) triangle: u32,
    /// The corner, if it is one.
    pub(super) vertex: Option<u32>,
    /// The point of the surface that it is compared with.
    pub(super) foot: DVec3,
    /// How far it is from that.
    pub(super) off: f64,
}

/// The probes of a mesh: each vertex once, each side once, each triangle once.
pub(super) fn probes(
    mesh: &Mesh,
    program: &crate::eval::Program,
    tolerance: f64,
    run: &Run,
) -> Result<Vec<Probe>, Cancelled> {
    let slopes = Slopes::within(program, tolerance);
    let mut seen = vec![false; mesh.positions().len()];
    let (mut probes, mut points, mut reach) = (Vec::new(), Vec::new(), Vec::new());
    for (number, &triangle) in (0u32..).zip(mesh.triangles()) {
        let corners = mesh.corners(triangle);
        let longest = (0..3).map(|k| corners[k].distance(corners[(k + 1) % 3])).fold(0.0, f64::max);
        let mut add = |point: DVec3, vertex| {
            probes.push(Probe { triangle: number, vertex, foot: point, off: 0.0 });
            points.push(point);
            reach.push(longest);
        };
        add(corners.iter().sum::<DVec3>() / 3.0, None);
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            if from < to {
                add(0.5 * (corners[k] + corners[(k + 1) % 3]), None);
            }
            if !std::mem::replace(&mut seen[from as usize], true) {
                add(corners[k], Some(from));
            }
        }
    }
    let [first, second] = run.stages([0.5, 0.5]);
    let mut feet = points.clone();
    for run in [first, second] {
        let found = slopes.at(&feet, &run)?;
        for (n, slope) in found.iter().enumerate() {
            feet[n] += stepped(slope, reach[n]);
        }
    }
    for (n, probe) in probes.iter_mut().enumerate() {
        (probe.foot, probe.off) = (feet[n], feet[n].distance(points[n]));
    }
    Ok(probes)
}

/// A step to the surface, no longer than that: where the slope is of no use, what is told is far.
fn stepped(slope: &Slope, reach: f64) -> DVec3 {
    let step = slope.newton();
    match slope.value {
        0.0 => DVec3::ZERO,
        _ if step.is_finite() && step != DVec3::ZERO => step.clamp_length_max(reach),
        _ => reach * DVec3::X,
    }
}

/// The largest distance of the probes.
pub(super) fn largest(probes: &[Probe]) -> f64 {
    probes.iter().map(|probe| probe.off).fold(0.0, f64::max)
}
