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

use super::{Mesh, MeshError, each};
use crate::Run;

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

/// Faces and vertices that a thread takes at once.
const CHUNK: usize = 4096;

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
        self.to_mesh_with(&Run::default())
    }

    /// [`to_mesh`](QuadMesh::to_mesh) with a choice of threads, a cancel token and a progress sink.
    ///
    /// ```
    /// use rvachev::subdivision::SubdivisionRevolution;
    /// use rvachev::Run;
    ///
    /// let quads = SubdivisionRevolution::ellipsoid([2.0, 1.0, 0.7])?.limit_mesh([4, 4])?;
    /// let mesh = quads.to_mesh_with(&Run { threads: 1, ..Run::default() })?;
    /// assert_eq!(mesh, quads.to_mesh()?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`to_mesh`](QuadMesh::to_mesh), and [`MeshError::Cancelled`].
    pub fn to_mesh_with(&self, run: &Run) -> Result<Mesh, MeshError> {
        let run = run.stage(0.0, 1.0);
        let mesh = run.install(|| self.cut(&run))?;
        run.report(1.0);
        Ok(mesh)
    }

    fn cut(&self, run: &Run) -> Result<Mesh, MeshError> {
        let [cutting, naming, moving, creasing, bending, texturing] = run.stages([1.0, 1.0, 1.0, 2.0, 1.0, 1.0]);
        let halves = each(self.quads.len(), CHUNK, &cutting, |face| self.halves(face))?;
        // Quadrilaterals first, two triangles each.
        let count = 2 * halves.len() + self.triangles.len();
        let triangle = |t: usize| match halves.get(t / 2) {
            Some(half) => half[t % 2].map(|k| self.quads[t / 2][k]),
            None => self.triangles[t - 2 * halves.len()],
        };
        let corners = |t: usize| match halves.get(t / 2) {
            Some(half) => half[t % 2].map(|k| self.quad_corners[t / 2][k]),
            None => self.triangle_corners[t - 2 * halves.len()],
        };
        let has_corners = !(self.quad_corners.is_empty() && self.triangle_corners.is_empty());
        let triangles = each(count, CHUNK, &naming, triangle)?;
        let positions = each(self.positions.len(), CHUNK, &moving, |v| self.positions[v].as_vec3())?;
        let mut mesh = Mesh::new(positions, triangles)?;
        if !self.normals.is_empty() {
            mesh = mesh.with_normals(self.normals.iter().map(|n| n.as_vec3()).collect())?;
        }
        if has_corners {
            let is_creased = |t: usize| {
                let differs =
                    |(vertex, corner): (u32, Corner)| corner.normal.dot(self.normals[vertex as usize]) < SAME_NORMAL;
                triangle(t).into_iter().zip(corners(t)).any(differs)
            };
            if each(count, CHUNK, &creasing, is_creased)?.contains(&true) {
                mesh = mesh.with_corner_normals(each(count, CHUNK, &bending, |t| {
                    corners(t).map(|corner| corner.normal.as_vec3())
                })?)?;
            }
            let texture = |t: usize| corners(t).map(|corner| corner.texture.as_vec2().to_array());
            mesh = mesh.with_corner_texture(each(count, CHUNK, &texturing, texture)?)?;
        }
        Ok(mesh)
    }

    /// The two triangles of a quadrilateral, as corners of it.
    fn halves(&self, face: usize) -> [[usize; 3]; 2] {
        let [a, b, c, d] = self.quads[face].map(|i| self.positions[i as usize]);
        if a.distance_squared(c) <= b.distance_squared(d) { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] }
    }
}
