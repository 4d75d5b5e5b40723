//! A mesh of quadrilaterals and triangles in double precision.
//!
//! What parameter grids are made of: quadrilaterals in rows, triangles where a row shrinks to a
//! point. Corners carry what vertices cannot: on both sides of a seam a vertex has two places
//! on a texture, and at an edge several normals.
//!
//! ```text
//!      d *------* c       a quadrilateral [a, b, c, d], anticlockwise seen from outside;
//!        |    / |         it is cut along the shorter diagonal, the first of equal ones
//!        |  /   |
//!      a *------* b
//! ```

use glam::{DVec2, DVec3};

use super::{Mesh, MeshError};

/// A mesh of quadrilaterals and triangles, in double precision.
///
/// ```
/// use rvachev::surface::{ParametricSurface, PatchSettings};
/// use rvachev::Superellipsoid;
///
/// let surface = ParametricSurface::of(&Superellipsoid::new([3.0, 2.0, 1.0], 0.5, 0.5))?;
/// let quads = surface.quad_mesh(&PatchSettings { rows: 8, columns: 16, ..PatchSettings::default() })?;
/// // Two rows of triangles at the poles, quadrilaterals between.
/// assert_eq!((quads.quads().len(), quads.triangles().len()), (6 * 16, 2 * 16));
/// let mesh = quads.to_mesh()?;
/// assert!(mesh.check().is_closed());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuadMesh {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) normals: Vec<DVec3>,
    pub(crate) quads: Vec<[u32; 4]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) quad_corners: Vec<[Corner; 4]>,
    pub(crate) triangle_corners: Vec<[Corner; 3]>,
}

/// Normals whose cosine is above this are one: 10⁻³ apart, in radians.
const SAME_NORMAL: f64 = 1.0 - 5e-7;

/// What a corner of a face knows that its vertex does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The outward unit normal of the face's side of an edge.
    pub normal: DVec3,
    /// The place on a texture, each from 0 to 1.
    pub texture: DVec2,
}

impl QuadMesh {
    /// The positions of the vertices, in length units.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The outward unit normals of the vertices; empty if there are none.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// The quadrilaterals: four vertex indices each, anticlockwise seen from outside.
    #[must_use]
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }

    /// The triangles beside the quadrilaterals, at poles and ends.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of the quadrilaterals; empty if the mesh has no such knowledge.
    #[must_use]
    pub fn quad_corners(&self) -> &[[Corner; 4]] {
        &self.quad_corners
    }

    /// The corners of the triangles; empty if the mesh has no such knowledge.
    #[must_use]
    pub fn triangle_corners(&self) -> &[[Corner; 3]] {
        &self.triangle_corners
    }

    /// All faces as triangles, quadrilaterals first, two each, in single precision, with texture
    /// coordinates and, where a vertex has several, the normals of the corners.
    ///
    /// # Errors
    ///
    /// If a position is beyond single precision.
    pub fn to_mesh(&self) -> Result<Mesh, MeshError> {
        let halves: Vec<[[usize; 3]; 2]> = (0..self.quads.len()).map(|face| self.halves(face)).collect();
        let cut = self.quads.iter().zip(&halves).flat_map(|(quad, halves)| halves.map(|half| half.map(|k| quad[k])));
        let triangles: Vec<[u32; 3]> = cut.chain(self.triangles.iter().copied()).collect();
        let cut =
            self.quad_corners.iter().zip(&halves).flat_map(|(quad, halves)| halves.map(|half| half.map(|k| quad[k])));
        let corners: Vec<[Corner; 3]> = cut.chain(self.triangle_corners.iter().copied()).collect();

        let creased = triangles
            .iter()
            .flatten()
            .zip(corners.iter().flatten())
            .any(|(&vertex, corner)| corner.normal.dot(self.normals[vertex as usize]) < SAME_NORMAL);
        let mut mesh = Mesh::new(self.positions.iter().map(|p| p.as_vec3()).collect(), triangles)?;
        if !self.normals.is_empty() {
            mesh = mesh.with_normals(self.normals.iter().map(|n| n.as_vec3()).collect())?;
        }
        if creased {
            mesh = mesh.with_corner_normals(corners.iter().map(|c| c.map(|c| c.normal.as_vec3())).collect())?;
        }
        if !corners.is_empty() {
            let texture = corners.iter().map(|c| c.map(|c| c.texture.as_vec2().to_array())).collect();
            mesh = mesh.with_corner_texture(texture)?;
        }
        Ok(mesh)
    }

    /// The two triangles of a quadrilateral, as corners of it.
    fn halves(&self, face: usize) -> [[usize; 3]; 2] {
        let [a, b, c, d] = self.quads[face].map(|i| self.positions[i as usize]);
        if a.distance_squared(c) <= b.distance_squared(d) { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] }
    }
}
