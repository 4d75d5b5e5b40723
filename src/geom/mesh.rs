//! A triangle mesh with shared vertices.
//!
//! Positions are f32, as every file format and graphics interface has them; whatever is
//! computed from them here is computed in f64.
//!
//! ```text
//!           c
//!           *        A triangle [a, b, c] is seen anticlockwise from outside:
//!          / \       its normal (b − a) × (c − a) points out of the solid.
//!         /   \
//!      a *-----* b
//! ```

mod attributes;
mod corner_normals;
mod findings;
mod flipped;
mod measure;

use glam::{DVec3, Vec3};

use self::attributes::Attributes;
use self::corner_normals::CornerNormals;
pub(crate) use self::findings::Findings;
use rvachev_num::jobs;

use crate::Bounds;

/// A triangle mesh: positions and triangles that index them, and perhaps normals per vertex
/// and per corner, colours and texture coordinates per corner, owners per triangle.
///
/// Every index is in range and every position finite; nothing else is promised. Positions are in
/// single precision, some seven digits: steps of 0.25 at coordinates of 4·10⁶. [`Mesh::check`]
/// tells the rest. A mesh that was extracted from a solid also says what the extraction found:
/// [`possibly_lost`](Mesh::possibly_lost), [`warnings`](Mesh::warnings).
///
/// A mesh is plain data: lists and numbers, without functions or references to the solid that it
/// was made from. Two meshes are equal if positions, triangles and attributes are; what the
/// extraction found is not compared.
///
/// ```
/// use glam::Vec3;
/// use rvachev::Mesh;
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let tetrahedron = Mesh::new(positions, triangles)?;
/// assert!((tetrahedron.volume() - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), rvachev::error::MeshError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    attributes: Attributes,
    corner_normals: Option<CornerNormals>,
    findings: Findings,
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Mesh) -> bool {
        self.positions == other.positions
            && self.triangles == other.triangles
            && self.attributes == other.attributes
            && self.corner_normals() == other.corner_normals()
    }
}

/// Why a mesh cannot be built from the given parts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, but there are {vertices} vertices")]
    Index {
        /// The triangle, counted from 0.
        triangle: usize,
        /// The index that is out of range.
        index: u32,
        /// Number of vertices; the allowed indices are those below it.
        vertices: usize,
    },
    /// A position has a component that is NaN or infinite.
    #[error("vertex {vertex} is at {position}, which is not finite")]
    Position {
        /// The vertex, counted from 0.
        vertex: usize,
        /// Where it is.
        position: Vec3,
    },
    /// There are not as many normals as vertices.
    #[error("{normals} normals for {vertices} vertices; one a vertex is needed")]
    Normals {
        /// Number of normals given.
        normals: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// Values for corners or triangles are not as many as the triangles.
    #[error("{what} for {given} triangles, but there are {triangles}; every triangle needs them")]
    Corners {
        /// What the values are.
        what: &'static str,
        /// Number of triangles that they are given for.
        given: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// A normal of a vertex is NaN or infinite.
    #[error("the normal of vertex {vertex} is not finite")]
    Normal {
        /// The vertex, counted from 0.
        vertex: usize,
    },
    /// A value at a corner is NaN or infinite.
    #[error("the {what} at corner {corner} of triangle {triangle} is not finite")]
    NotFinite {
        /// What the value is.
        what: &'static str,
        /// The triangle, counted from 0.
        triangle: usize,
        /// Its corner, 0 to 2.
        corner: usize,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] crate::Cancelled),
}

/// The place of the first one of a list that something holds for. Threads share long lists.
fn first<T: Sync>(list: &[T], holds: impl Fn(&T) -> bool + Sync) -> Option<usize> {
    /// Fewer are not worth a second thread.
    const MANY: usize = 1 << 16;
    if list.len() <= MANY {
        return list.iter().position(holds);
    }
    let in_chunk = |n: usize| {
        let chunk = &list[n * MANY..list.len().min((n + 1) * MANY)];
        chunk.iter().position(&holds).map(|at| n * MANY + at)
    };
    jobs::first(list.len().div_ceil(MANY), in_chunk)
}

impl Mesh {
    /// A mesh from positions (length units) and triangles, anticlockwise seen from outside.
    ///
    /// # Errors
    ///
    /// [`MeshError::Index`] or [`MeshError::Position`], naming the first offender.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Mesh, MeshError> {
        if let Some(vertex) = first(&positions, |p| !p.is_finite()) {
            return Err(MeshError::Position { vertex, position: positions[vertex] });
        }
        let vertices = positions.len();
        if let Some(triangle) = first(&triangles, |[a, b, c]| *a.max(b).max(c) as usize >= vertices) {
            let [a, b, c] = triangles[triangle];
            let index = [a, b, c].into_iter().find(|&i| i as usize >= vertices).unwrap_or(c);
            return Err(MeshError::Index { triangle, index, vertices });
        }
        Ok(Mesh {
            positions,
            triangles,
            attributes: Attributes::default(),
            corner_normals: None,
            findings: Findings::default(),
        })
    }

    /// The positions of the vertices, in length units.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The triangles: three vertex indices each, anticlockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle of this mesh, in f64.
    #[must_use]
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|i| self.positions[i as usize].as_dvec3())
    }

    /// The smallest box that holds all vertices; [`Bounds::EMPTY`] without any.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &p in &self.positions {
            min = min.min(p);
            max = max.max(p);
        }
        Bounds::new(min.as_dvec3(), max.as_dvec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box from `min`, with sides `size`, faces outward.
    fn cuboid(min: Vec3, size: Vec3) -> Mesh {
        let at = |c: u32| Vec3::new((c & 1) as f32, (c >> 1 & 1) as f32, (c >> 2) as f32);
        let positions = (0..8).map(|c| min + at(c) * size).collect();
        let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        Mesh::new(positions, quads.into_iter().flat_map(halves).collect()).unwrap()
    }

    #[test]
    fn measures_of_a_box_far_away() {
        let mesh = cuboid(Vec3::splat(4096.0), Vec3::new(2.0, 3.0, 4.0));
        assert_eq!(mesh.volume(), 24.0);
        assert_eq!(mesh.area(), 52.0);
        let middle = DVec3::splat(4096.0) + DVec3::new(1.0, 1.5, 2.0);
        assert!((mesh.centroid().unwrap() - middle).length() < 1e-12);
        assert_eq!(mesh.bounds().size(), DVec3::new(2.0, 3.0, 4.0));
        // m (b² + c²) / 12, and no product of inertia.
        let inertia = mesh.inertia().unwrap();
        for (k, exact) in [2.0 * 25.0, 2.0 * 20.0, 2.0 * 13.0].into_iter().enumerate() {
            assert!((inertia.col(k)[k] - exact).abs() < 1e-11);
            assert!(inertia.col(k)[(k + 1) % 3].abs() < 1e-11);
        }
    }

    #[test]
    fn empty() {
        let mesh = Mesh::default();
        assert_eq!(mesh.volume(), 0.0);
        assert_eq!((mesh.centroid(), mesh.inertia()), (None, None));
        assert_eq!(mesh.bounds(), Bounds::EMPTY);
    }

    #[test]
    fn bad_parts_are_named() {
        let bad = Mesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 3, 1]]);
        assert_eq!(bad.unwrap_err().to_string(), "triangle 1 refers to vertex 3, but there are 3 vertices");
        let bad = Mesh::new(vec![Vec3::ZERO, Vec3::NAN], vec![]);
        assert!(matches!(bad.unwrap_err(), MeshError::Position { vertex: 1, .. }));
        let bad = cuboid(Vec3::ZERO, Vec3::ONE).with_normals(vec![Vec3::Z]);
        assert!(matches!(bad.unwrap_err(), MeshError::Normals { normals: 1, vertices: 8 }));
    }
}
