//! Normals per corner: as they were given, or as what differs from the normals of the vertices.
//!
//! Of a mesh with creases most triangles are far from any: their corners have the normals of their
//! vertices. Those of the others are listed by triangle; the list of all is made of both when it is
//! first asked for.

use std::sync::OnceLock;

use glam::Vec3;

use super::{Mesh, MeshError};

/// The normals of the corners of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct CornerNormals {
    /// Triangles whose corners have other normals than their vertices; none if `all` was given.
    apart: Vec<(u32, [Vec3; 3])>,
    all: OnceLock<Vec<[Vec3; 3]>>,
}

impl CornerNormals {
    pub(super) fn given(all: Vec<[Vec3; 3]>) -> CornerNormals {
        CornerNormals { apart: Vec::new(), all: OnceLock::from(all) }
    }
}

impl Mesh {
    /// The same mesh, whose corners have the normals of their vertices, but for those of some
    /// triangles.
    ///
    /// # Errors
    ///
    /// [`MeshError::Normals`] if the vertices have no normals.
    pub(crate) fn with_corner_normals_apart(mut self, apart: Vec<(u32, [Vec3; 3])>) -> Result<Mesh, MeshError> {
        if self.normals().is_none() {
            return Err(MeshError::Normals { normals: 0, vertices: self.positions.len() });
        }
        self.corner_normals = Some(CornerNormals { apart, all: OnceLock::new() });
        Ok(self)
    }

    /// The unit normals of the corners, if the mesh has them: three for each triangle. The first
    /// call may have to list them.
    #[must_use]
    pub fn corner_normals(&self) -> Option<&[[Vec3; 3]]> {
        let corners = self.corner_normals.as_ref()?;
        let list = || {
            let normals = self.normals().unwrap_or_default();
            let of_vertices = |triangle: &[u32; 3]| triangle.map(|vertex| normals[vertex as usize]);
            let mut all: Vec<[Vec3; 3]> = self.triangles.iter().map(of_vertices).collect();
            for &(triangle, given) in &corners.apart {
                all[triangle as usize] = given;
            }
            all
        };
        Some(corners.all.get_or_init(list))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_apart_is_listed_with_the_rest() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2]]).unwrap();
        let up = Vec3::new(0.0, 0.6, 0.8);
        let apart = vec![(1, [up, Vec3::Z, Vec3::Z])];
        assert!(mesh.clone().with_corner_normals_apart(apart.clone()).is_err());
        let mesh = mesh.with_normals(vec![up, Vec3::Y, Vec3::Z, Vec3::NEG_X]).unwrap();
        let listed = mesh.clone().with_corner_normals_apart(apart.clone()).unwrap();
        let all = [[up, Vec3::Y, Vec3::Z], [up, Vec3::Z, Vec3::Z], [Vec3::Y, Vec3::NEG_X, Vec3::Z]];
        assert_eq!(listed.corner_normals(), Some(&all[..]));
        assert_eq!(listed, mesh.clone().with_corner_normals(all.to_vec()).unwrap());
        assert_ne!(listed, mesh);
        // They do not follow other normals of the vertices.
        let turned = mesh.with_corner_normals_apart(apart).unwrap().with_normals(vec![Vec3::Z; 4]);
        assert_eq!(turned.unwrap().corner_normals(), Some(&all[..]));
    }
}
