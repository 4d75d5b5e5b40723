//! Normals per corner, kept as they were given or as what differs from the normals of the vertices.
//!
//! Of a mesh with creases most triangles are far from any: their corners have the normals of their
//! vertices. Only the others are kept then, and the list of all is made when it is first asked for.

use std::ops::Range;
use std::sync::OnceLock;

use glam::Vec3;

use super::attributes::finite;
use super::{Mesh, MeshError};

/// The normals of the corners of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct CornerNormals {
    all: OnceLock<Vec<[Vec3; 3]>>,
    /// The triangles whose corners have other normals than their vertices; none once `all` is given.
    apart: Vec<Apart>,
}

/// Triangles whose corners have other normals than their vertices.
#[derive(Clone, Debug)]
pub(crate) struct Apart {
    /// The triangles.
    pub(crate) runs: Vec<Range<usize>>,
    /// Their normals, one run's after the other's.
    pub(crate) normals: Vec<[Vec3; 3]>,
}

impl CornerNormals {
    pub(super) fn given(all: Vec<[Vec3; 3]>) -> CornerNormals {
        CornerNormals { all: OnceLock::from(all), apart: Vec::new() }
    }
}

impl Mesh {
    /// The same mesh, whose corners have the normals of their vertices, but for those of some triangles, given in
    /// several lists.
    ///
    /// # Errors
    ///
    /// [`MeshError::Corners`] if there are no such triangles, [`MeshError::Normals`] if the vertices have no normals,
    /// and [`MeshError::NotFinite`] if a normal is NaN or infinite.
    pub(crate) fn with_normals_apart(mut self, apart: Vec<Apart>) -> Result<Mesh, MeshError> {
        if self.normals().is_none() {
            return Err(MeshError::Normals { normals: 0, vertices: self.positions.len() });
        }
        for Apart { runs, normals } in &apart {
            if let Some(run) = runs.iter().find(|run| run.end > self.triangles.len()) {
                self.fits_triangles("normals of corners", run.end)?;
            }
            finite("normal", normals, |n| n.is_finite())?;
        }
        self.corner_normals = Some(CornerNormals { all: OnceLock::new(), apart });
        Ok(self)
    }

    /// The unit normals of the corners, if the mesh has them: three for each triangle. The first call may have to
    /// list them.
    #[must_use]
    pub fn corner_normals(&self) -> Option<&[[Vec3; 3]]> {
        let corners = self.corner_normals.as_ref()?;
        let list = || {
            let normals = self.normals().unwrap_or_default();
            let mut all: Vec<[Vec3; 3]> =
                self.triangles.iter().map(|&[a, b, c]| [a, b, c].map(|vertex| normals[vertex as usize])).collect();
            for Apart { runs, normals } in &corners.apart {
                let triangles = runs.iter().cloned().flatten();
                triangles.zip(normals).for_each(|(triangle, normals)| all[triangle] = *normals);
            }
            all
        };
        Some(corners.all.get_or_init(list))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(triangle: usize, normal: Vec3) -> Vec<Apart> {
        let runs = std::iter::once(triangle..triangle + 1).collect();
        vec![Apart { runs, normals: vec![[normal; 3]] }]
    }

    #[test]
    fn what_is_apart_is_listed_with_the_rest() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2]]).unwrap();
        assert!(mesh.clone().with_normals_apart(apart(0, Vec3::X)).is_err());
        let mesh = mesh.with_normals(vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X]).unwrap();
        assert!(mesh.clone().with_normals_apart(apart(3, Vec3::X)).is_err());
        assert!(mesh.clone().with_normals_apart(apart(1, Vec3::NAN)).is_err());
        let listed = mesh.clone().with_normals_apart(apart(1, Vec3::NEG_Z)).unwrap();
        let all = [[Vec3::X, Vec3::Y, Vec3::Z], [Vec3::NEG_Z; 3], [Vec3::Y, Vec3::NEG_X, Vec3::Z]];
        assert_eq!(listed.corner_normals(), Some(&all[..]));
        assert_eq!(listed, mesh.clone().with_corner_normals(all.to_vec()).unwrap());
        assert_ne!(listed, mesh);
        // They do not follow other normals of the vertices.
        let turned = mesh.with_normals_apart(apart(1, Vec3::NEG_Z)).unwrap().with_normals(vec![Vec3::Z; 4]);
        assert_eq!(turned.unwrap().corner_normals(), Some(&all[..]));
    }
}
