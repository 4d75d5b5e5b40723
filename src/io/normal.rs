//! The normal of a corner, as files want it: of length 1.

use glam::Vec3;

use crate::geom::Mesh;

/// The unit normal at a corner, whose number is 3 t + k for corner k of triangle t: its own, or
/// that of its vertex; that of the triangle where it has no direction. `None` if the mesh has
/// no normals.
pub(super) fn corner_normal(mesh: &Mesh, corner: usize) -> Option<Vec3> {
    let triangle = mesh.triangles()[corner / 3];
    let given = match (mesh.corner_normals(), mesh.normals()) {
        (Some(normals), _) => normals[corner / 3][corner % 3],
        (None, Some(normals)) => normals[triangle[corner % 3] as usize],
        (None, None) => return None,
    };
    if (given.length_squared() - 1.0).abs() < 1e-3 {
        return Some(given);
    }
    let [a, b, c] = mesh.corners(triangle);
    let face = || (b - a).cross(c - a).try_normalize().map(|n| n.as_vec3());
    Some(given.try_normalize().or_else(face).unwrap_or(Vec3::Z))
}
