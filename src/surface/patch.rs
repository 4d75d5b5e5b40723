//! Meshes of parametric surfaces: closed and manifold by construction.
//!
//! ```text
//!    ●───────────────●   pole: one vertex, a ring of triangles about it
//!    │ ╲ │ ╱ │ ╲ │ ╱ │
//!    ├───┼───┼───┼───┤   row: as many vertices as columns; after the last column
//!    │   │   │   │   │   comes the first again, there is no seam
//!    ├───┼───┼───┼───┤
//!    │ ╲ │ ╱ │ ╲ │ ╱ │   clipped end: the last row again, as a flat fan about a vertex in its
//!    ○───────────────○   middle
//! ```
//!
//! Rows run along the meridian, columns along the equator; a ring (torus) closes both ways.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::angle::sin_cos;
use super::curve::{By, Curve};
use super::parametric::{ParametricSurface, Shape};
use super::spacing::{Arc, Sample};
use crate::geom::{Corner, Mesh, MeshError, QuadMesh};

/// How a parametric surface is meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchSettings {
    /// Rows of faces along the meridian, 2 to 100 000 (3 around a tube). Default: 32.
    pub rows: u32,
    /// Columns of faces about the axis, 3 to 100 000. Default: 64.
    pub columns: u32,
    /// Where rows and columns lie.
    pub spacing: Spacing,
}

/// Where the rows and columns of a patch mesh lie.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Spacing {
    /// At equal angles η and ω, as the papers do. Squarish shapes (e below 0.5) leave large
    /// gaps on their sides: at e = 0.04, 0.85 of the size with 91 samples a quarter.
    #[default]
    UniformAngle,
}

impl Default for PatchSettings {
    fn default() -> PatchSettings {
        PatchSettings { rows: 32, columns: 64, spacing: Spacing::default() }
    }
}

/// Why a surface cannot be meshed or sampled as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PatchError {
    /// A number of rows, columns or samples out of its range.
    #[error("{parameter} is {value}, allowed: {least} to {most}")]
    Count {
        /// Which number.
        parameter: &'static str,
        /// Its value.
        value: u64,
        /// The least allowed.
        least: u64,
        /// The most allowed.
        most: u64,
    },
    /// A tolerance that cannot be met.
    #[error("tolerance is {value}, allowed: {least} to {most}, for a surface of this size")]
    Tolerance {
        /// Its value.
        value: f64,
        /// The least allowed.
        least: f64,
        /// The most allowed.
        most: f64,
    },
    /// The mesh is beyond single precision.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The most rows or columns.
const MOST: u32 = 100_000;

/// The most vertices: 2²⁸ of them are 12 GB.
const MOST_VERTICES: u64 = 1 << 28;

pub(super) fn count(parameter: &'static str, value: u64, least: u64, most: u64) -> Result<(), PatchError> {
    if (least..=most).contains(&value) { Ok(()) } else { Err(PatchError::Count { parameter, value, least, most }) }
}

impl PatchSettings {
    fn check(&self, shape: Shape) -> Result<(), PatchError> {
        let least = match shape {
            Shape::Ring | Shape::Horn => 3,
            Shape::Ball => 2,
            _ => 1,
        };
        count("rows", u64::from(self.rows), least, u64::from(MOST))?;
        count("columns", u64::from(self.columns), 3, u64::from(MOST))?;
        count("rows · columns", u64::from(self.rows) * u64::from(self.columns), 1, MOST_VERTICES)
    }
}

impl ParametricSurface {
    /// The surface as triangles with exact normals, closed and manifold; a hyperboloid of two
    /// sheets as two shells. Texture coordinates run from 0 to 1 along ω and η.
    ///
    /// Volume and area converge to those of the solid at second order in the number of rows and
    /// columns where the shape is smooth.
    ///
    /// ```
    /// use rvachev::{PatchSettings, Supertoroid};
    ///
    /// let ring = Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.3, 0.7).surface()?;
    /// let mesh = ring.mesh(&PatchSettings { rows: 48, columns: 96, ..PatchSettings::default() })?;
    /// let report = mesh.check();
    /// assert!(report.is_closed() && report.is_manifold());
    /// assert_eq!(report.genus, Some(1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A setting out of its range, or a surface beyond single precision.
    pub fn mesh(&self, settings: &PatchSettings) -> Result<Mesh, PatchError> {
        Ok(self.quad_mesh(settings)?.to_mesh()?)
    }

    /// The same as quadrilaterals in double precision, with triangles at poles and clipped ends.
    ///
    /// # Errors
    ///
    /// A setting out of its range.
    pub fn quad_mesh(&self, settings: &PatchSettings) -> Result<QuadMesh, PatchError> {
        settings.check(self.shape)?;
        let mut mesh = QuadMesh::default();
        for sheet in std::iter::once(*self).chain(self.other_sheet()) {
            let grid = Grid::new(&sheet, settings);
            grid.append_to(&mut mesh);
        }
        Ok(mesh)
    }
}

/// A vertex of a grid with the normals of its four sides.
#[derive(Clone, Copy)]
struct Knot {
    point: DVec3,
    normal: DVec3,
    /// `[before, after]` along the meridian, of `[before, after]` along the equator.
    sides: [[DVec3; 2]; 2],
    texture: DVec2,
}

/// Rows and columns of a surface.
struct Grid<'a> {
    surface: &'a ParametricSurface,
    rows: u32,
    columns: u32,
    product: Product,
}

/// What points come from.
enum Product {
    /// Samples of meridian and equator.
    Curves { meridian: Vec<Sample>, equator: Vec<Sample> },
    /// Barr's bowl, in polar form.
    Polar { end: f64, e1: f64, e2: f64 },
}

impl<'a> Grid<'a> {
    fn new(surface: &'a ParametricSurface, settings: &PatchSettings) -> Grid<'a> {
        let PatchSettings { rows, columns, spacing } = *settings;
        let product = match (surface.shape, spacing) {
            (Shape::BarrBowl { end, e1, e2 }, _) => Product::Polar { end, e1, e2 },
            (_, Spacing::UniformAngle) => Product::Curves {
                meridian: surface.meridian_arc(By::Angle).uniform(rows),
                equator: surface.equator_arc(By::Angle).uniform(columns),
            },
        };
        Grid { surface, rows, columns, product }
    }

    /// The vertex where row and column meet.
    fn knot(&self, row: u32, column: u32) -> Knot {
        match &self.product {
            Product::Curves { meridian, equator } => {
                self.surface.knot(&meridian[row as usize], &equator[column as usize])
            }
            &Product::Polar { end, e1, e2 } => {
                let share = |i: u32, of: u32| f64::from(i) / f64::from(of);
                self.surface.polar_knot([end, e1, e2], share(row, self.rows), share(column, self.columns))
            }
        }
    }

    fn append_to(&self, mesh: &mut QuadMesh) {
        Stitcher::new(self, mesh).stitch();
    }
}

impl ParametricSurface {
    /// The meridian as it is seen where the equator is widest.
    pub(super) fn meridian_arc(&self, by: By) -> Arc {
        let [a, b, c] = self.semi_axes().to_array();
        Arc { curve: self.meridian, by, range: self.meridian_range(by), scale: DVec2::new(a.max(b), c) }
    }

    /// The equator.
    pub(super) fn equator_arc(&self, by: By) -> Arc {
        let scale = self.semi_axes().truncate();
        Arc { curve: self.equator, by, range: self.equator.range(by), scale }
    }

    fn knot(&self, meridian: &Sample, equator: &Sample) -> Knot {
        let normal = |m: DVec2, e: DVec2| self.normal_of(m, e, equator.point);
        Knot {
            point: self.point_of(meridian.point, equator.point),
            normal: normal(meridian.normal, equator.normal),
            sides: meridian.sides.map(|m| equator.sides.map(|e| normal(m, e))),
            texture: DVec2::new(equator.texture, meridian.texture),
        }
    }

    /// Barr's bowl about its apex. At `x/a₁ = ξ` the logarithm of ξ, the sum of those of the two
    /// secants, is divided between them by the squared cosine and sine of the column's angle.
    fn polar_knot(&self, [end, e1, e2]: [f64; 3], row: f64, column: f64) -> Knot {
        let (sin, cos) = sin_cos((2.0 * column - 1.0) * PI);
        let log = end.ln() * row * row;
        let curve = |e: f64, share: f64| Curve::at_secant(e, (log * share * share).exp(), share);
        // In this order columns run anticlockwise about the apex, seen from outside.
        let (m, n) = (curve(e1, sin), curve(e2, cos));
        let mut point = self.point_of(m.point, n.point);
        if row == 1.0 {
            // On the clipping plane, which the product of the two secants leaves by some rounding.
            point.x = (end * self.semi_axes().x).copysign(point.x);
        }
        let normal = self.normal_of(m.normal, n.normal, n.point);
        Knot { point, normal, sides: [[normal; 2]; 2], texture: DVec2::new(column, row) }
    }
}

/// Appends the grid of one sheet to a mesh.
struct Stitcher<'a, 'b> {
    grid: &'a Grid<'a>,
    mesh: &'b mut QuadMesh,
    /// The first vertex of the rings.
    base: u32,
    /// The row of the first ring: that of a pole is no ring.
    first: u32,
    rings: u32,
}

impl<'a, 'b> Stitcher<'a, 'b> {
    fn new(grid: &'a Grid<'a>, mesh: &'b mut QuadMesh) -> Stitcher<'a, 'b> {
        let base = mesh.positions.len() as u32;
        let rows = grid.rows;
        let (first, rings) = match grid.surface.shape {
            Shape::Ball | Shape::Horn => (1, rows - 1),
            Shape::Ring => (0, rows),
            Shape::Tube => (0, rows + 1),
            Shape::Bowl | Shape::BarrBowl { .. } => (1, rows),
        };
        Stitcher { grid, mesh, base, first, rings }
    }

    fn stitch(mut self) {
        let columns = self.grid.columns;
        for ring in 0..self.rings {
            for column in 0..columns {
                let knot = self.grid.knot(self.first + ring, column);
                self.vertex(knot.point, knot.normal);
            }
        }
        let ring_shape = self.grid.surface.shape == Shape::Ring;
        let strips = if ring_shape { self.rings } else { self.rings - 1 };
        for strip in 0..strips {
            for column in 0..columns {
                self.quad(strip, column);
            }
        }
        let last = self.grid.rows;
        match self.grid.surface.shape {
            Shape::Ring => {}
            Shape::Ball | Shape::Horn => {
                self.pole(0);
                self.pole(last);
            }
            Shape::Tube => {
                self.cap(0);
                self.cap(last);
            }
            Shape::Bowl | Shape::BarrBowl { .. } => {
                self.pole(0);
                self.cap(last);
            }
        }
    }

    fn vertex(&mut self, point: DVec3, normal: DVec3) -> u32 {
        self.mesh.positions.push(point);
        self.mesh.normals.push(normal);
        self.mesh.positions.len() as u32 - 1
    }

    fn at(&self, ring: u32, column: u32) -> u32 {
        self.base + (ring % self.rings) * self.grid.columns + column % self.grid.columns
    }

    /// The corner of a face at a row and column, on the side of it where the face is.
    fn corner(&self, [row, column]: [u32; 2], [after_row, after_column]: [usize; 2]) -> Corner {
        let knot = self.grid.knot(row, column);
        Corner { normal: knot.sides[after_row][after_column], texture: knot.texture }
    }

    fn quad(&mut self, strip: u32, column: u32) {
        let corner = |right: u32, up: u32| {
            let vertex = self.at(strip + up, column + right);
            let sides = [1 - up as usize, 1 - right as usize];
            (vertex, self.corner([self.first + strip + up, column + right], sides))
        };
        let [a, b, c, d] = self.turned([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        self.mesh.quads.push([a.0, b.0, c.0, d.0]);
        self.mesh.quad_corners.push([a.1, b.1, c.1, d.1]);
    }

    fn triangle(&mut self, corners: [(u32, Corner); 3], upwards: bool) {
        let [a, b, c] = self.turned(corners);
        let [a, b, c] = if upwards { [a, b, c] } else { [a, c, b] };
        self.mesh.triangles.push([a.0, b.0, c.0]);
        self.mesh.triangle_corners.push([a.1, b.1, c.1]);
    }

    /// The other way round on a mirror image.
    fn turned<const N: usize>(&self, mut corners: [(u32, Corner); N]) -> [(u32, Corner); N] {
        if self.grid.surface.mirrored() {
            corners.reverse();
        }
        corners
    }

    /// A vertex and a fan of triangles in place of the first or last row.
    fn pole(&mut self, row: u32) {
        let last = row == self.grid.rows;
        let columns = self.grid.columns;
        let (ring, beside) = if last { (self.rings - 1, row - 1) } else { (0, 1) };
        let side = usize::from(!last);
        let tips: Vec<Corner> = (0..columns)
            .map(|column| {
                let left = self.corner([row, column], [side, 1]);
                let right = self.corner([row, column + 1], [side, 0]);
                let texture = 0.5 * (left.texture + right.texture);
                Corner { normal: (left.normal + right.normal).normalize_or_zero(), texture }
            })
            .collect();
        // Normals about a tip may cancel, as those about the middle of a horn do.
        let mean = tips.iter().map(|tip| tip.normal).sum::<DVec3>() / f64::from(columns);
        let up = self.grid.surface.placed(if last { DVec3::Z } else { DVec3::NEG_Z });
        let normal = if mean.length() > 1e-9 { mean.normalize() } else { up };
        let pole = self.vertex(self.grid.knot(row, 0).point, normal);
        for column in 0..columns {
            let base = [0, 1].map(|right: u32| {
                let sides = [1 - side, 1 - right as usize];
                (self.at(ring, column + right), self.corner([beside, column + right], sides))
            });
            self.triangle([base[0], base[1], (pole, tips[column as usize])], last);
        }
    }

    /// A flat fan across a clipped end.
    fn cap(&mut self, row: u32) {
        let last = row == self.grid.rows;
        let ring = if last { self.rings - 1 } else { 0 };
        let up = if last { 1.0 } else { -1.0 };
        let surface = self.grid.surface;
        let normal = match surface.shape {
            Shape::BarrBowl { .. } => surface.placed(DVec3::X),
            _ => surface.placed(DVec3::new(0.0, 0.0, up)),
        };
        let rim = self.grid.knot(row, 0).point;
        let axis = normal.abs();
        let center = self.vertex(rim * axis, normal);
        let corner = |point: DVec3, size: f64| {
            let flat = surface.seen_along_axis(point) / (2.0 * size);
            Corner { normal, texture: DVec2::splat(0.5) + flat }
        };
        let columns = self.grid.columns;
        let size = (0..columns).map(|c| self.grid.knot(row, c).point - rim * axis).map(DVec3::length).fold(0.0, f64::max);
        for column in 0..columns {
            let base = [0, 1].map(|right| {
                let vertex = self.at(ring, column + right);
                (vertex, corner(self.mesh.positions[vertex as usize], size))
            });
            self.triangle([base[0], base[1], (center, corner(rim * axis, size))], last);
        }
    }
}
