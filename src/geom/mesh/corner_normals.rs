//! Normals per corner, kept as they were given or as what differs from the normals of the vertices.
//!
//! Of a mesh with creases most triangles are far from any: their corners have the normals of their
//! vertices. What tells those of the others is kept then, and the list of all is made when it is first asked for.
//!
//! A vertex on a crease itself may have been given the normal of the other side. What is farther from the triangle's
//! own normal than 45° is replaced by that.

use std::fmt::Debug;
use std::sync::{Arc, OnceLock};

use glam::Vec3;

use super::{Mesh, MeshError};

/// A normal that is farther from that of its triangle is of another side: the cosine.
const ASTRAY: f32 = 0.7;

/// The normals of the corners of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct CornerNormals {
    all: OnceLock<Vec<[Vec3; 3]>>,
    /// What tells the triangles whose corners have other normals than their vertices; none if `all` was given.
    apart: Option<Arc<dyn Apart>>,
}

/// Tells the normals of triangles whose corners have other ones than their vertices.
pub(crate) trait Apart: Debug + Send + Sync {
    /// Tells each such triangle, by number, with the unit normals at its corners; 0 at a corner that has that
    /// of its vertex.
    fn tell(&self, each: &mut dyn FnMut(usize, [Vec3; 3]));
}

impl CornerNormals {
    pub(super) fn given(all: Vec<[Vec3; 3]>) -> CornerNormals {
        CornerNormals { all: OnceLock::from(all), apart: None }
    }
}

impl Mesh {
    /// The same mesh, whose corners have the normals of their vertices, but for those of some triangles.
    ///
    /// # Errors
    ///
    /// [`MeshError::Normals`] if the vertices have no normals.
    pub(crate) fn with_normals_apart(mut self, apart: impl Apart + 'static) -> Result<Mesh, MeshError> {
        if self.normals().is_none() {
            return Err(MeshError::Normals { normals: 0, vertices: self.positions.len() });
        }
        self.corner_normals = Some(CornerNormals { all: OnceLock::new(), apart: Some(Arc::new(apart)) });
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
            if let Some(apart) = &corners.apart {
                apart.tell(&mut |triangle, given| {
                    if let Some(own) = all.get_mut(triangle) {
                        *own = self.straightened(self.triangles[triangle], *own, given);
                    }
                });
            }
            all
        };
        Some(corners.all.get_or_init(list))
    }

    /// The normals at the corners of a triangle, given those of its vertices and others, 0 where there is none.
    fn straightened(&self, [a, b, c]: [u32; 3], own: [Vec3; 3], given: [Vec3; 3]) -> [Vec3; 3] {
        let [p, q, r] = [a, b, c].map(|vertex| self.positions[vertex as usize]);
        let face = (q - p).cross(r - p);
        let least = ASTRAY * face.length();
        std::array::from_fn(|corner| {
            let normal = if given[corner] == Vec3::ZERO { own[corner] } else { given[corner] };
            // NaN is astray as well.
            if normal.dot(face) > least { normal } else { face.normalize_or_zero() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One triangle and its normals.
    #[derive(Debug)]
    struct One(usize, [Vec3; 3]);

    impl Apart for One {
        fn tell(&self, each: &mut dyn FnMut(usize, [Vec3; 3])) {
            each(self.0, self.1);
        }
    }

    #[test]
    fn what_is_apart_is_listed_with_the_rest() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2]]).unwrap();
        let up = Vec3::new(0.0, 0.6, 0.8);
        assert!(mesh.clone().with_normals_apart(One(0, [up; 3])).is_err());
        let mesh = mesh.with_normals(vec![up, Vec3::Y, Vec3::Z, Vec3::NEG_X]).unwrap();
        // At the last corner one that is astray; the vertex of the second has one that is.
        let given = [Vec3::ZERO, up, Vec3::NEG_Z];
        let listed = mesh.clone().with_normals_apart(One(0, given)).unwrap();
        let all = [[up, up, Vec3::Z], [up, Vec3::NEG_X, Vec3::Y], [Vec3::Y, Vec3::NEG_X, Vec3::Z]];
        assert_eq!(listed.corner_normals(), Some(&all[..]));
        assert_eq!(listed, mesh.clone().with_corner_normals(all.to_vec()).unwrap());
        assert_ne!(listed, mesh);
        let listed = mesh.clone().with_normals_apart(One(0, [Vec3::NAN, Vec3::ZERO, up])).unwrap();
        assert_eq!(listed.corner_normals().unwrap()[0], [Vec3::Z, Vec3::Z, up]);
        // They do not follow other normals of the vertices.
        let turned = mesh.with_normals_apart(One(0, given)).unwrap().with_normals(vec![Vec3::Z; 4]);
        assert_eq!(turned.unwrap().corner_normals(), Some(&all[..]));
    }
}
