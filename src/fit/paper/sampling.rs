//! Points of a mesh, spread by area: the same ones each time.

use glam::DVec3;

use crate::geom::Mesh;

/// A point of a triangle.
pub(super) struct OnMesh {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

/// Steps of the plane's additive sequence of low discrepancy. Source: M. Roberts, *The unreasonable
/// effectiveness of quasirandom sequences* (2018).
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// So many points of these triangles, each of which gets them by its area; none of no area.
pub(super) fn spread(mesh: &Mesh, triangles: &[usize], count: usize) -> Vec<OnMesh> {
    let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| mesh.corners(mesh.triangles()[*t])).collect();
    let mut until = Vec::with_capacity(corners.len());
    let mut area = 0.0;
    for [a, b, c] in &corners {
        area += 0.5 * (b - a).cross(c - a).length();
        until.push(area);
    }
    if !(area > 0.0 && area.is_finite()) {
        return Vec::new();
    }
    let mut points = Vec::with_capacity(count);
    for i in 0..count {
        let at = area * (i as f64 + 0.5) / count as f64;
        let triangle = until.partition_point(|end| *end < at).min(corners.len() - 1);
        let [a, b, c] = corners[triangle];
        let [mut u, mut v] = STEPS.map(|step| (0.5 + step * (i + 1) as f64).fract());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let normal = (b - a).cross(c - a).normalize_or_zero();
        points.push(OnMesh { point: a + (b - a) * u + (c - a) * v, normal });
    }
    points
}
