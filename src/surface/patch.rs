//! Meshes of parametric surfaces: closed and manifold by construction.
//!
//! Rows run along the meridian, columns along the equator; a ring (torus) closes both ways.

use glam::{DVec2, DVec3};

use super::adaptive;
use super::curve::By;
use super::parametric::{ParametricSurface, Shape};
use super::polar::Lines;
use super::spacing::{Arc, Sample};
use super::stitch::{End, Knot, Knots, Layout, stitch};
use crate::geom::{Mesh, MeshError, QuadMesh};
use crate::{Cancelled, Run};

/// How a parametric surface is meshed.
///
/// ```
/// use rvachev::surface::{ParametricSurface, PatchSettings, Spacing};
/// use rvachev::Superellipsoid;
///
/// // A rounded box: by angles most of the triangles are at its edges, and some too long.
/// let surface = ParametricSurface::of(&Superellipsoid::new([1.0, 1.5, 0.7], 0.2, 0.2))?;
/// let by_angle = surface.mesh(&PatchSettings::default())?;
/// let within = surface.mesh(&PatchSettings { spacing: Spacing::Chord(0.005), ..PatchSettings::default() })?;
/// let even = surface.mesh(&PatchSettings { spacing: Spacing::EqualArc, ..PatchSettings::default() })?;
/// assert!(within.triangles().len() < by_angle.triangles().len() / 3);
/// assert_eq!(even.triangles().len(), by_angle.triangles().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Spacing {
    /// At equal angles η and ω, as the papers do. Squarish shapes (e below 0.5) leave large
    /// gaps on their sides: at e = 0.04, 0.85 of the size with 91 samples a quarter.
    #[default]
    UniformAngle,
    /// By equal lengths along meridian and equator: the longest gap between neighbours on either
    /// is at most 1.5 of the shortest. (Of Barr's two sheets along x: along the rim of the clipped
    /// end, and along the line from the apex to its farthest point.)
    EqualArc,
    /// As few as keep the mesh within this distance (length units) of the surface; `rows` and
    /// `columns` are not used. Rings have as many vertices as each needs, so that there are
    /// triangles only: 1.4 times (sphere) to 1.65 times (ellipsoid of 1 : 2 : 3) the least number
    /// possible. 10⁻⁶ to 0.3 of the size. (Barr's two sheets along x are grids of rows and columns:
    /// they take two to four times as many as sheets along z, and many times as many where e is
    /// below 0.3.)
    Chord(f64),
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
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The most rows or columns.
const MOST: u32 = 100_000;

/// The most vertices: 2²⁴ of them are some 4 GB, with faces, normals and texture coordinates.
const MOST_VERTICES: u64 = 1 << 24;

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
    /// use rvachev::surface::{ParametricSurface, PatchSettings};
    /// use rvachev::Supertoroid;
    ///
    /// let ring = ParametricSurface::of(&Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.3, 0.7))?;
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
        self.mesh_with(settings, &Run::default())
    }

    /// [`mesh`](ParametricSurface::mesh) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// ```
    /// use rvachev::surface::{ParametricSurface, PatchError, PatchSettings};
    /// use rvachev::{Run, Superellipsoid};
    ///
    /// let surface = ParametricSurface::of(&Superellipsoid::new([3.0, 2.0, 1.0], 0.5, 0.5))?;
    /// let settings = PatchSettings { rows: 200, columns: 400, ..PatchSettings::default() };
    /// let run = Run::default();
    /// assert_eq!(surface.mesh_with(&settings, &run)?.triangles().len(), 2 * 199 * 400);
    /// // Any clone of the token, on any thread, stops the work.
    /// run.cancel.cancel();
    /// assert!(matches!(surface.mesh_with(&settings, &run), Err(PatchError::Cancelled(_))));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`mesh`](ParametricSurface::mesh), and [`PatchError::Cancelled`].
    pub fn mesh_with(&self, settings: &PatchSettings, run: &Run) -> Result<Mesh, PatchError> {
        let run = run.stage(0.0, 1.0);
        let [making, cutting] = run.stages([1.0, 1.0]);
        let mesh = self.quad_mesh_with(settings, &making)?.to_mesh_with(&cutting);
        mesh.map_err(|error| match error {
            MeshError::Cancelled(cancelled) => cancelled.into(),
            error => error.into(),
        })
    }

    /// The same as quadrilaterals in double precision, with triangles at poles and clipped ends;
    /// by [`Spacing::Chord`] triangles only. Positions are in length units, normals of length 1.
    ///
    /// # Errors
    ///
    /// [`PatchError::Count`] or [`PatchError::Tolerance`] for a setting out of its range, and for a
    /// tolerance that is not met.
    pub fn quad_mesh(&self, settings: &PatchSettings) -> Result<QuadMesh, PatchError> {
        self.quad_mesh_with(settings, &Run::default())
    }

    /// [`quad_mesh`](ParametricSurface::quad_mesh) with a cancel token and a progress sink; on one
    /// thread.
    ///
    /// # Errors
    ///
    /// Those of [`quad_mesh`](ParametricSurface::quad_mesh), and [`PatchError::Cancelled`].
    pub fn quad_mesh_with(&self, settings: &PatchSettings, run: &Run) -> Result<QuadMesh, PatchError> {
        settings.check(self.shape)?;
        let run = run.stage(0.0, 1.0);
        let mut mesh = QuadMesh::default();
        let sheets: Vec<ParametricSurface> = std::iter::once(*self).chain(self.other_sheet()).collect();
        let part = |sheet: usize| sheet as f64 / sheets.len() as f64;
        for (number, sheet) in sheets.iter().enumerate() {
            let run = run.stage(part(number), part(number + 1));
            run.check()?;
            if let Spacing::Chord(tolerance) = settings.spacing {
                let size = self.size();
                let [least, most] = adaptive::TOLERANCES.map(|share| share * size);
                if !(least..=most).contains(&tolerance) {
                    return Err(PatchError::Tolerance { value: tolerance, least, most });
                }
                if !matches!(self.shape, Shape::BarrBowl { .. }) {
                    adaptive::append(sheet, tolerance, &mut mesh, &run)?;
                    continue;
                }
            }
            let grid = Grid::new(sheet, settings, &run)?;
            stitch(&grid, grid.layout(), &mut mesh, &run)?;
        }
        run.report(1.0);
        Ok(mesh)
    }
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
    Polar { bowl: [f64; 3], lines: Lines },
}

impl<'a> Grid<'a> {
    fn new(surface: &'a ParametricSurface, settings: &PatchSettings, run: &Run) -> Result<Grid<'a>, PatchError> {
        let PatchSettings { rows, columns, spacing } = *settings;
        if let Shape::BarrBowl { end, e1, e2 } = surface.shape {
            let (bowl, counts) = ([end, e1, e2], [rows, columns]);
            let lines = match spacing {
                Spacing::UniformAngle => ParametricSurface::polar_uniform(counts),
                Spacing::EqualArc => surface.polar_equal(bowl, counts),
                Spacing::Chord(tolerance) => surface.polar_chords(bowl, tolerance, run)?,
            };
            let [rows, columns] = lines.counts();
            return Ok(Grid { surface, rows, columns, product: Product::Polar { bowl, lines } });
        }
        let (by, even) = match spacing {
            Spacing::UniformAngle => (By::Angle, false),
            _ => (By::Even, true),
        };
        let samples = |arc: Arc, count: u32| if even { arc.equal(count) } else { arc.uniform(count) };
        let meridian = samples(surface.meridian_arc(by), rows);
        let equator = samples(surface.equator_arc(by), columns);
        Ok(Grid { surface, rows, columns, product: Product::Curves { meridian, equator } })
    }

    fn layout(&self) -> Layout {
        let surface = self.surface;
        let ends = match surface.shape {
            Shape::Ring => None,
            Shape::Ball | Shape::Horn => Some([End::Pole; 2]),
            Shape::Tube => Some([End::Flat; 2]),
            Shape::Bowl | Shape::BarrBowl { .. } => Some([End::Pole, End::Flat]),
        };
        let axis = if matches!(surface.shape, Shape::BarrBowl { .. }) { DVec3::X } else { DVec3::Z };
        Layout {
            rows: self.rows,
            columns: self.columns,
            ends,
            columns_join: true,
            mirrored: surface.mirrored(),
            axis: surface.placed(axis),
        }
    }
}

impl Knots for Grid<'_> {
    fn knot(&self, row: u32, column: u32) -> Knot {
        match &self.product {
            Product::Curves { meridian, equator } => {
                self.surface.knot(&meridian[row as usize], &equator[column as usize])
            }
            Product::Polar { bowl, lines } => self.surface.polar_vertex(*bowl, lines, [row, column]),
        }
    }
}

impl ParametricSurface {
    /// The meridian as it is seen where the equator is widest.
    pub(super) fn meridian_arc(&self, by: By) -> Arc {
        let equator = self.equator_arc(By::Even);
        let [first, last] = equator.range;
        let at = |i: u32| equator.point(first + (last - first) * f64::from(i) / 256.0).length();
        let widest = (0..=256).map(at).fold(0.0, f64::max);
        let scale = DVec2::new(widest, self.semi_axes().z);
        Arc { curve: self.meridian, by, range: self.meridian_range(by), scale }
    }

    /// The equator.
    pub(super) fn equator_arc(&self, by: By) -> Arc {
        let scale = self.semi_axes().truncate();
        Arc { curve: self.equator, by, range: self.equator.range(by), scale }
    }

    fn knot(&self, meridian: &Sample, equator: &Sample) -> Knot {
        let normal = |m: DVec2, e: DVec2| self.normal_of(m, e, equator.point);
        let point = self.point_of(meridian.point, equator.point);
        let knot =
            Knot::smooth(point, normal(meridian.normal, equator.normal), DVec2::new(equator.texture, meridian.texture));
        if meridian.is_smooth() && equator.is_smooth() {
            return knot;
        }
        Knot { sides: meridian.sides.map(|m| equator.sides.map(|e| normal(m, e))), ..knot }
    }
}
