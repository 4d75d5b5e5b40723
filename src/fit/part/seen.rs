//! How much of the surface that a leaf makes there are points of.
//!
//! ```text
//!      : : : : : :        points of the top and the sides; none of the bottom, which may be anywhere:
//!     :+---------+:       4 of 5 parts of this section are seen
//!     :|         |:
//!      '  ?   ?  '
//! ```

use glam::DVec3;

use super::super::error::FitError;
use super::leaf::Leaf;
use super::refine::owner;
use super::samples::{Kind, Samples};
use super::topology::tree;
use crate::error::MeshingError;
use crate::fit::grid::{Grid, extent};
use crate::{CellSize, Features, MeshSettings, Run};

/// Cells along the longest side of the mesh of the tree, and triangles of it that are asked.
const CELLS: u32 = 64;
const ASKED: usize = 8000;

/// A place is seen that has one of so many points nearest to it within a distance, in distances of
/// evenly spread points and in noise, and facing the same way, as a cosine.
const NEAREST: usize = 12;
const WITHIN: [f64; 2] = [2.0, 3.0];
const FACING: f64 = 0.4;

/// The share of each leaf's part of the surface that is seen: all of a mesh, nothing of a leaf that
/// makes no surface.
pub(super) fn seen(leaves: &[(bool, Leaf)], samples: &Samples, run: &Run) -> Result<Vec<f64>, FitError> {
    let all = vec![1.0; leaves.len()];
    let Some(solid) = tree(leaves.iter().map(|(adds, leaf)| (*adds, leaf.solid()))) else { return Ok(all) };
    if samples.kind != Kind::Scan {
        return Ok(all);
    }
    let cell = CellSize::LongestSide(CELLS);
    let settings = MeshSettings { cell, features: Features::Smooth, ..MeshSettings::default() };
    let mesh = match solid.mesh_with(&settings, &Run { progress: None, ..run.clone() }) {
        Ok(mesh) => mesh,
        Err(MeshingError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(error) => return Err(FitError::Meshing { what: error.to_string() }),
    };
    let facet = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
        ((a + b + c) / 3.0, 0.5 * (b - a).cross(c - a))
    };
    let area: f64 = mesh.triangles().iter().map(|t| facet(t).1.length()).sum();
    let spacing = (area / samples.len().max(1) as f64).sqrt();
    let within = WITHIN[0] * spacing + WITHIN[1] * samples.noise;
    let grid = Grid::new(&samples.points, extent(&samples.points), spacing);
    let mut near = Vec::new();
    let mut is_seen = |p: DVec3, normal: DVec3| {
        grid.nearest(p, NEAREST, &mut near);
        let faces = |i: u32| samples.normals[i as usize].dot(normal) > FACING;
        near.iter().any(|(square, i)| *square < within * within && faces(*i))
    };
    let mut parts = vec![[0.0; 2]; leaves.len()];
    let step = mesh.triangles().len().div_ceil(ASKED).max(1);
    for (p, across) in mesh.triangles().iter().step_by(step).map(facet) {
        let area = across.length();
        if let (Some(leaf), _) = owner(leaves, p)
            && area > 0.0
        {
            let [all, seen] = &mut parts[leaf];
            *all += area;
            *seen += if is_seen(p, across / area) { area } else { 0.0 };
        }
    }
    Ok(parts.into_iter().map(|[all, seen]| if all > 0.0 { seen / all } else { 0.0 }).collect())
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::PointCloud;

    #[test]
    fn what_is_below_is_a_guess() {
        let block = Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(-0.3, -0.3, 0.0), DVec3::new(0.3, 0.3, 0.2)]);
        let foot = Leaf::cylinder(DVec3::Z, DVec3::ZERO, 0.1, [-0.2, 0.05]);
        // Points of the top and the sides of the block.
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for k in 0..1600 {
            let [u, v] = [f64::from(k % 40), f64::from(k / 40)].map(|x| (x + 0.5) / 40.0);
            points.push(DVec3::new(0.6 * u - 0.3, 0.6 * v - 0.3, 0.2));
            normals.push(DVec3::Z);
            if v < 1.0 / 3.0 {
                let side = DVec3::new(0.3, 0.6 * u - 0.3, 0.6 * v);
                for turn in (0..4).map(|q| DMat3::from_rotation_z(f64::from(q) * std::f64::consts::FRAC_PI_2)) {
                    points.push(turn * side);
                    normals.push(turn * DVec3::X);
                }
            }
        }
        let cloud = PointCloud::new(points).unwrap();
        let cloud = cloud.with_normals(normals.iter().map(|n| n.as_vec3()).collect()).unwrap();
        let samples = Samples::of_cloud(&cloud, 0.0, 1, &Run::default()).unwrap();
        let leaves =
            [(true, block), (true, foot)].map(|(adds, leaf)| (adds, leaf.inward(samples.centre, samples.size)));
        let shares = seen(&leaves, &samples, &Run::default()).unwrap();
        // 0.36 + 4·0.12 of 0.36 + 4·0.12 + 0.36 − 0.03.
        assert!((shares[0] - 0.84 / 1.17).abs() < 0.04 && shares[1] < 0.1, "{shares:?}");
    }
}
