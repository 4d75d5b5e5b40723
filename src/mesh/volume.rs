//! Marching cubes on an array of samples, row by row.
//!
//! ```text
//!      row j+1   . . 1 1 1 1 . .      Signs are packed to bits, 64 nodes of a row in a word.
//!                   \       \         What two rows differ in are crossed edges between them,
//!      row j     . . . 1 1 1 1 .      a row and its shift those along it: rows without any
//!                    x       x        cost a few operations a word.
//! ```
//!
//! A first pass counts the vertices and triangles of every row; a second one writes them where
//! they belong. Vertices are numbered row by row, in a row those on edges along x first, then
//! along y, then along z; so while the crossed cells of a row are visited in order, counters
//! tell the vertex on each of their edges, and nothing is looked up.
//!
//! Around the array a layer of outside nodes is assumed, which closes the mesh, unless an open
//! one is asked for.
//!
//! Limits: there are at most 2³² − 1 vertices.
//!
//! Sources: W. E. Lorensen and H. E. Cline, Marching cubes (1987); counting rows before writing
//! them: W. Schroeder, R. Maynard and B. Geveci, Flying edges (2015).

mod bits;
mod layer;
mod rows;
mod solid;

use glam::DVec3;

use self::rows::Rows;
use crate::geom::{Mesh, MeshError};
use crate::{Cancelled, Run};

/// The largest coordinate, that of a solid's lattice.
const MAX_COORDINATE: f64 = 1e37;

/// Samples of a function on a regular grid: voxel data.
///
/// ```
/// use glam::DVec3;
/// use rvachev::volume::{Volume, VolumeSettings};
///
/// let size = [20; 3];
/// let at = |n: usize| DVec3::new((n % 20) as f64, (n / 20 % 20) as f64, (n / 400) as f64) - 9.5;
/// let samples: Vec<f32> = (0..8000).map(|n| 8.0 - at(n).length() as f32).collect();
/// let ball = Volume::new(&samples, size, DVec3::splat(-9.5), DVec3::ONE)?;
/// let mesh = ball.mesh(&VolumeSettings::default())?;
/// let report = mesh.check();
/// assert!(report.is_closed() && report.is_manifold());
/// assert!((report.volume / 2144.66 - 1.0).abs() < 0.01);
/// # Ok::<(), rvachev::volume::VolumeError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Volume<'a> {
    samples: &'a [f32],
    size: [usize; 3],
    origin: DVec3,
    spacing: DVec3,
    /// How far vertices stay from samples, as a part of an edge.
    clearance: f64,
}

/// How to mesh a [`Volume`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct VolumeSettings {
    /// Samples above this value are inside; in the samples' unit, not NaN. Default: 0.
    pub level: f32,
    /// Whether the mesh has normals, by central differences. Default: true.
    pub normals: bool,
    /// Whether the mesh is closed where the inside reaches the border of the array; its caps
    /// lie a thousandth of a cell beyond the last samples. Default: true.
    pub closed: bool,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        VolumeSettings { level: 0.0, normals: true, closed: true }
    }
}

/// Why there is no volume, or no mesh of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// The number of samples is not that of the size.
    #[error("{given} samples for a size of {size:?}; allowed: exactly {expected}")]
    Samples {
        /// How many there are.
        given: usize,
        /// Samples along x, y and z.
        size: [usize; 3],
        /// How many there have to be.
        expected: u128,
    },
    /// The origin is not a point.
    #[error("origin is {value}; it must be finite along every axis")]
    Origin {
        /// The origin, in length units.
        value: DVec3,
    },
    /// The spacing is not a positive length along every axis.
    #[error("spacing is {value}; it must be finite and above 0 along every axis")]
    Spacing {
        /// The spacing, in length units.
        value: DVec3,
    },
    /// Single precision does not resolve the cells: they are too small for where they are.
    #[error(
        "the farthest coordinate is {farthest} with a spacing of {spacing}; allowed: a spacing of {smallest} or more"
    )]
    Far {
        /// The largest coordinate in absolute value, in length units.
        farthest: f64,
        /// The least spacing, in length units.
        spacing: f64,
        /// The least that is allowed there.
        smallest: f64,
    },
    /// The level is NaN.
    #[error("level is NaN; allowed: any number")]
    Level,
    /// There are more vertices than 32-bit indices count.
    #[error("{vertices} vertices, allowed: at most {}", u32::MAX)]
    TooLarge {
        /// How many vertices the mesh would have.
        vertices: u64,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The result is not a mesh: a defect of this crate.
    #[error("internal error, please report it: {0}")]
    Internal(#[from] MeshError),
}

impl<'a> Volume<'a> {
    /// Samples, x fastest, then y, then z: `size` is how many there are along each axis,
    /// `origin` where the first one is and `spacing` how far apart they are, in length units.
    ///
    /// # Errors
    /// [`VolumeError`] names what does not fit.
    pub fn new(
        samples: &'a [f32],
        size: [usize; 3],
        origin: impl Into<DVec3>,
        spacing: impl Into<DVec3>,
    ) -> Result<Volume<'a>, VolumeError> {
        let (origin, spacing) = (origin.into(), spacing.into());
        let expected = size.iter().map(|&n| n as u128).fold(1u128, u128::saturating_mul);
        if expected != samples.len() as u128 {
            return Err(VolumeError::Samples { given: samples.len(), size, expected });
        }
        if !origin.is_finite() {
            return Err(VolumeError::Origin { value: origin });
        }
        if !(spacing.is_finite() && spacing.min_element() > 0.0) {
            return Err(VolumeError::Spacing { value: spacing });
        }
        // The assumed layer included.
        let last = origin + spacing * DVec3::from_array(size.map(|n| n as f64));
        let farthest = (origin - spacing).abs().max(last.abs()).max_element();
        let least = spacing.min_element();
        let gap = if farthest < MAX_COORDINATE {
            f64::from((farthest as f32).next_up() - farthest as f32)
        } else {
            f64::INFINITY
        };
        // As for the lattice of a solid: two numbers apart, and a quarter of a cell left.
        let clearance = (2.0 * gap / least).max(1.0 / 1024.0);
        if clearance > 0.25 {
            return Err(VolumeError::Far { farthest, spacing: least, smallest: 8.0 * gap });
        }
        Ok(Volume { samples, size, origin, spacing, clearance })
    }

    /// The surface where the samples, interpolated along the grid's edges, have the settings'
    /// level: welded, oriented towards lower values, manifold. A sample that is NaN is outside.
    ///
    /// # Errors
    /// [`VolumeError`].
    pub fn mesh(&self, settings: &VolumeSettings) -> Result<Mesh, VolumeError> {
        self.mesh_with(settings, &Run::default())
    }

    /// [`mesh`](Volume::mesh) with a choice of threads, a cancel token and a progress sink. The
    /// result is the same to the byte for any number of threads.
    ///
    /// # Errors
    /// [`VolumeError`].
    pub fn mesh_with(&self, settings: &VolumeSettings, run: &Run) -> Result<Mesh, VolumeError> {
        if settings.level.is_nan() {
            return Err(VolumeError::Level);
        }
        let run = run.stage(0.0, 1.0);
        let fewest = self.size.into_iter().min().unwrap_or(0);
        if fewest == 0 || fewest == 1 && !settings.closed {
            run.report(1.0);
            return Ok(Mesh::default());
        }
        run.install(|| {
            let rows = Rows::new(self, settings, &run.stage(0.0, 0.4))?;
            let mesh = rows.mesh(&run.stage(0.4, 1.0))?;
            run.report(1.0);
            Ok(mesh)
        })
    }
}

impl Volume<'_> {
    /// By how much the samples rise from one to the next along each axis, at a node (numbered from
    /// 1): by central differences, one-sided at the border.
    #[inline(always)]
    fn rises(&self, node: [usize; 3]) -> DVec3 {
        let [nx, ny, nz] = self.size;
        let [x, y, z] = [node[0] - 1, node[1] - 1, node[2] - 1];
        let place = x + nx * (y + ny * z);
        DVec3::new(self.rise(place, x, nx, 1), self.rise(place, y, ny, nx), self.rise(place, z, nz, nx * ny))
    }

    /// The same along one axis, at sample `at` of `size`, which is at `place` of the list of all.
    #[inline(always)]
    fn rise(&self, place: usize, at: usize, size: usize, stride: usize) -> f64 {
        let below = if at > 0 { stride } else { 0 };
        let above = if at + 1 < size { stride } else { 0 };
        let rise = f64::from(self.samples[place + above]) - f64::from(self.samples[place - below]);
        if below + above == 2 * stride { 0.5 * rise } else { rise }
    }
}
