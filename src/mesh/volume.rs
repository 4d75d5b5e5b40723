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

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::signs::gathered;
use super::table::{CaseTable, EDGE_CORNERS};
use crate::geom::{Mesh, MeshError};
use crate::run::{Cancelled, Run};

/// The largest coordinate, that of a solid's lattice.
const MAX_COORDINATE: f64 = 1e37;

/// Samples of a function on a regular grid: voxel data.
///
/// ```
/// use glam::DVec3;
/// use rvachev::{Volume, VolumeSettings};
///
/// let size = [20; 3];
/// let at = |n: usize| DVec3::new((n % 20) as f64, (n / 20 % 20) as f64, (n / 400) as f64) - 9.5;
/// let samples: Vec<f32> = (0..8000).map(|n| 8.0 - at(n).length() as f32).collect();
/// let ball = Volume::new(&samples, size, DVec3::splat(-9.5), DVec3::ONE)?;
/// let mesh = ball.mesh(&VolumeSettings::default())?;
/// let report = mesh.check();
/// assert!(report.is_closed() && report.is_manifold());
/// assert!((report.volume / 2144.66 - 1.0).abs() < 0.01);
/// # Ok::<(), rvachev::VolumeError>(())
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

/// The signs of all nodes, with a layer of outside nodes around them: node i of the array is
/// number i + 1 here.
struct Rows<'a> {
    volume: &'a Volume<'a>,
    settings: VolumeSettings,
    /// Words of a row.
    words: usize,
    /// Rows of a layer, those of the layer around included.
    across: usize,
    bits: Vec<u64>,
    /// The edges along x, by their lower nodes, that may be crossed, and so the cells.
    allowed: Vec<u64>,
    /// Which rows have edges upwards, along y and z: from the first to the last.
    upward: [std::ops::RangeInclusive<usize>; 2],
    table: Cases,
}

/// What the case table says, ready for counters.
struct Cases {
    table: &'static CaseTable,
    /// Which of the twelve edges are crossed, as bits.
    crossed: [u16; 256],
    triangles: [u8; 256],
}

impl Cases {
    fn new() -> Cases {
        let table = CaseTable::get();
        let crossed = |case: usize| {
            let inside = |corner: u8| case >> corner & 1;
            let is_crossed = |[a, b]: [u8; 2]| u16::from(inside(a) != inside(b));
            EDGE_CORNERS.iter().enumerate().fold(0, |bits, (edge, &ends)| bits | is_crossed(ends) << edge)
        };
        let triangles = |case: usize| table.triangles(case as u8).len() as u8;
        Cases { table, crossed: std::array::from_fn(crossed), triangles: std::array::from_fn(triangles) }
    }
}

/// Numbers of vertices and triangles.
#[derive(Clone, Copy, Default)]
struct Count {
    vertices: u64,
    triangles: u64,
}

/// A row of cells at hand: the rows of nodes at its corners, in the order of the corners.
struct CellRow<'a>([&'a [u64]; 4]);

impl CellRow<'_> {
    fn words(&self, w: usize) -> [u64; 4] {
        self.0.map(|row| row[w])
    }

    /// The same, shifted by one node.
    fn next(&self, w: usize) -> [u64; 4] {
        self.0.map(|row| row[w] >> 1 | row.get(w + 1).map_or(0, |next| next << 63))
    }
}

/// The cells that have nodes of both signs.
fn mixed(row: [u64; 4], next: [u64; 4]) -> u64 {
    let any = row.iter().chain(&next).fold(0, |all, bits| all | bits);
    let all = row.iter().chain(&next).fold(u64::MAX, |all, bits| all & bits);
    any & !all
}

/// The case of cell `bit`.
fn case(row: [u64; 4], next: [u64; 4], bit: u32) -> usize {
    let pair = |n: usize| (row[n] >> bit & 1 | (next[n] >> bit & 1) << 1) << (2 * n);
    (pair(0) | pair(1) | pair(2) | pair(3)) as usize
}

/// Calls `visit` with the number of every bit that is set.
fn each_bit(mut bits: u64, mut visit: impl FnMut(u32)) {
    while bits != 0 {
        visit(bits.trailing_zeros());
        bits &= bits - 1;
    }
}

/// Packs whether samples are above a level.
fn pack(samples: &[f32], level: f32, out: &mut [u64]) {
    // Node 0 is that of the layer around: the first sample is bit 1.
    let mut carry = 0;
    let words = samples.chunks(64).map(|chunk| word(chunk, level));
    for (out, word) in out.iter_mut().zip(words.chain(std::iter::once(0))) {
        *out = word << 1 | carry;
        carry = word >> 63;
    }
}

/// 64 samples, or fewer, as bits.
fn word(samples: &[f32], level: f32) -> u64 {
    let (eights, rest) = samples.as_chunks::<8>();
    let mut bits = 0;
    for (n, eight) in eights.iter().enumerate() {
        bits |= u64::from(gathered(eight.map(|value| u8::from(value > level)))) << (8 * n);
    }
    for (n, &value) in rest.iter().enumerate() {
        bits |= u64::from(value > level) << (8 * eights.len() + n);
    }
    bits
}

impl<'a> Rows<'a> {
    fn new(volume: &'a Volume<'a>, settings: &VolumeSettings, run: &Run) -> Result<Rows<'a>, Cancelled> {
        let [nx, ny, nz] = volume.size;
        let (words, across) = ((nx + 2).div_ceil(64), ny + 2);
        let mut bits = vec![0; words * across * (nz + 2)];
        let meter = Meter::new(run, nz);
        let layers = bits[words * across..].par_chunks_mut(words * across).zip(volume.samples.par_chunks(nx * ny));
        layers.try_for_each(|(bits, samples)| {
            meter.step()?;
            for (bits, samples) in bits[words..].chunks_mut(words).zip(samples.chunks(nx)) {
                pack(samples, settings.level, bits);
            }
            Ok(())
        })?;
        // An open mesh has no edges to the layer around.
        let (first, less) = if settings.closed { (0, 0) } else { (1, 1) };
        let mut allowed = vec![0; words];
        for i in first..=nx - less {
            allowed[i / 64] |= 1 << (i % 64);
        }
        let upward = [ny, nz].map(|n| first..=n - less);
        Ok(Rows { volume, settings: *settings, words, across, bits, allowed, upward, table: Cases::new() })
    }

    fn row(&self, j: usize, k: usize) -> &[u64] {
        &self.bits[(k * self.across + j) * self.words..][..self.words]
    }

    fn cells(&self, j: usize, k: usize) -> CellRow<'_> {
        CellRow([self.row(j, k), self.row(j + 1, k), self.row(j, k + 1), self.row(j + 1, k + 1)])
    }

    /// The crossed edges of 64 nodes of a row, along x, y and z.
    fn crossed(&self, [j, k]: [usize; 2], w: usize, row: [u64; 4], next: [u64; 4]) -> [u64; 3] {
        let up = |axis: usize, at: usize| if self.upward[axis].contains(&at) { u64::MAX } else { 0 };
        [(row[0] ^ next[0]) & self.allowed[w], (row[0] ^ row[1]) & up(0, j), (row[0] ^ row[2]) & up(1, k)]
    }

    /// Whether cells start at a row.
    fn has_cells(&self, j: usize, k: usize) -> bool {
        self.upward[0].contains(&j) && self.upward[1].contains(&k)
    }

    /// Counts the vertices of each row and the triangles of a layer; the rows' starts within
    /// the layer are noted.
    fn count(&self, k: usize, starts: &mut [Start]) -> Count {
        let mut count = Count::default();
        for (j, start) in starts[..=self.volume.size[1]].iter_mut().enumerate() {
            let cells = self.cells(j, k);
            let mut along = [0; 3];
            for w in 0..self.words {
                let (row, next) = (cells.words(w), cells.next(w));
                let mixed = mixed(row, next);
                if mixed == 0 {
                    continue;
                }
                let crossed = self.crossed([j, k], w, row, next);
                along.iter_mut().zip(crossed).for_each(|(along, bits)| *along += bits.count_ones());
                if self.has_cells(j, k) {
                    each_bit(mixed & self.allowed[w], |bit| {
                        count.triangles += u64::from(self.table.triangles[case(row, next, bit)]);
                    });
                }
            }
            let first = count.vertices as u32;
            *start = [first, first + along[0], first + along[0] + along[1]];
            count.vertices += u64::from(along[0]) + u64::from(along[1]) + u64::from(along[2]);
        }
        starts[self.volume.size[1] + 1] = [count.vertices as u32; 3];
        count
    }

    fn mesh(&self, run: &Run) -> Result<Mesh, VolumeError> {
        let layers = self.volume.size[2] + 1;
        // One row more than there are layers of cells: its vertices, all in the layer around,
        // are none.
        let mut starts: Vec<Start> = vec![[0; 3]; self.across * (layers + 1)];
        let meter = Meter::new(run, 2 * layers);
        let counted = starts.par_chunks_mut(self.across).take(layers).enumerate().map(|(k, starts)| {
            meter.step()?;
            Ok(self.count(k, starts))
        });
        let counts: Vec<Count> = counted.collect::<Result<_, Cancelled>>()?;
        let mut all = Count::default();
        for (n, starts) in starts.chunks_mut(self.across).enumerate() {
            let first = all.vertices as u32;
            starts.iter_mut().flatten().for_each(|start| *start = start.wrapping_add(first));
            if let Some(count) = counts.get(n) {
                all.vertices += count.vertices;
                all.triangles += count.triangles;
            }
        }
        if all.vertices > u64::from(u32::MAX) {
            return Err(VolumeError::TooLarge { vertices: all.vertices });
        }
        let mut positions = vec![Vec3::ZERO; all.vertices as usize];
        let mut normals = vec![Vec3::ZERO; if self.settings.normals { all.vertices as usize } else { 0 }];
        let mut triangles = vec![[0; 3]; all.triangles as usize];
        let mut pieces = Vec::with_capacity(layers);
        let (mut places, mut directions, mut corners) = (&mut positions[..], &mut normals[..], &mut triangles[..]);
        for count in &counts {
            let vertices = count.vertices as usize;
            pieces.push(Piece {
                positions: places.split_off_mut(..vertices).unwrap_or_default(),
                normals: directions.split_off_mut(..vertices).unwrap_or_default(),
                triangles: corners.split_off_mut(..count.triangles as usize).unwrap_or_default(),
            });
        }
        pieces.into_par_iter().enumerate().try_for_each(|(k, piece)| {
            meter.step()?;
            let starts = &starts[k * self.across..];
            self.vertices(k, starts, piece.positions, piece.normals);
            self.triangles(k, starts, piece.triangles);
            Ok::<(), Cancelled>(())
        })?;
        let mesh = Mesh::new(positions, triangles)?;
        Ok(if self.settings.normals { mesh.with_normals(normals)? } else { mesh })
    }

    /// The vertices of a layer of rows, in their order.
    fn vertices(&self, k: usize, starts: &[Start], positions: &mut [Vec3], normals: &mut [Vec3]) {
        let mut n = 0;
        for j in 0..=self.volume.size[1] {
            if starts[j][0] == starts[j + 1][0] {
                continue;
            }
            let cells = self.cells(j, k);
            // A row's vertices along x come before those along y, through all its words.
            for axis in 0..3 {
                let mut other = [j, k];
                if axis > 0 {
                    other[axis - 1] += 1;
                }
                let ends = [self.samples(j, k), self.samples(other[0], other[1])];
                for w in 0..self.words {
                    let (row, next) = (cells.words(w), cells.next(w));
                    each_bit(self.crossed([j, k], w, row, next)[axis], |bit| {
                        let i = 64 * w + bit as usize;
                        let (position, normal) = self.vertex(axis, [i, j, k], ends);
                        positions[n] = position;
                        if let Some(place) = normals.get_mut(n) {
                            *place = normal();
                        }
                        n += 1;
                    });
                }
            }
        }
    }

    /// The samples of a row; none in the layer around.
    fn samples(&self, j: usize, k: usize) -> Option<&[f32]> {
        let [nx, ny, nz] = self.volume.size;
        let (j, k) = (j.checked_sub(1).filter(|&j| j < ny)?, k.checked_sub(1).filter(|&k| k < nz)?);
        Some(&self.volume.samples[(k * ny + j) * nx..][..nx])
    }

    /// The vertex on the edge that leaves a node along an axis, and its normal on demand; `ends`
    /// are the rows of samples at the two ends of an edge across, or twice its own.
    fn vertex(&self, axis: usize, node: [usize; 3], ends: [Option<&[f32]>; 2]) -> (Vec3, impl Fn() -> Vec3) {
        let mut upper = node;
        upper[axis] += 1;
        let sample = |end: Option<&[f32]>, i: usize| Some(*end?.get(i.checked_sub(1)?)?);
        let (a, b) = (sample(ends[0], node[0]), sample(ends[1], upper[0]));
        let clearance = self.volume.clearance;
        let t = match (a, b) {
            (Some(a), Some(b)) => {
                let t = f64::from((self.settings.level - a) / (b - a));
                if t.is_nan() { 0.5 } else { t.clamp(clearance, 1.0 - clearance) }
            }
            // A cap.
            (Some(_), None) => clearance,
            _ => 1.0 - clearance,
        };
        let mut at = DVec3::new(node[0] as f64, node[1] as f64, node[2] as f64) - 1.0;
        at[axis] += t;
        let position = (self.volume.origin + at * self.volume.spacing).as_vec3();
        let normal = move || {
            let outward = match (a, b) {
                (Some(_), Some(_)) => -self.volume.gradient(node).lerp(self.volume.gradient(upper), t),
                (Some(_), None) => DVec3::AXES[axis],
                _ => -DVec3::AXES[axis],
            };
            outward.normalize_or_zero().as_vec3()
        };
        (position, normal)
    }

    /// The triangles of a layer of cells; `starts` are those of its rows and the next layer's.
    fn triangles(&self, k: usize, starts: &[Start], out: &mut [[u32; 3]]) {
        if out.is_empty() {
            return;
        }
        let mut slots = out.iter_mut();
        for j in 0..=self.volume.size[1] {
            if !self.has_cells(j, k) {
                continue;
            }
            let cells = self.cells(j, k);
            let [low, high] = [j, j + 1].map(|j| [starts[j], starts[self.across + j]]);
            let mut counters = Counters {
                x: [low[0][0], high[0][0], low[1][0], high[1][0]],
                y: [low[0][1], low[1][1]],
                z: [low[0][2], high[0][2]],
            };
            for w in 0..self.words {
                let (row, next) = (cells.words(w), cells.next(w));
                let crossed = mixed(row, next) & self.allowed[w];
                each_bit(crossed, |bit| {
                    let case = case(row, next, bit);
                    let edges = counters.pass(self.table.crossed[case]);
                    for (triangle, slot) in self.table.table.triangles(case as u8).iter().zip(&mut slots) {
                        *slot = triangle.map(|edge| edges[usize::from(edge)]);
                    }
                });
            }
        }
    }
}

/// A layer's part of the mesh.
struct Piece<'a> {
    positions: &'a mut [Vec3],
    normals: &'a mut [Vec3],
    triangles: &'a mut [[u32; 3]],
}

/// The first vertices of a row along x, y and z.
type Start = [u32; 3];

/// The vertices that come next on the edges of a row of cells.
struct Counters {
    /// By the row at the corner, as they are numbered.
    x: [u32; 4],
    /// Of the lower and the upper row.
    y: [u32; 2],
    z: [u32; 2],
}

impl Counters {
    /// The vertices on the edges of a cell, of which `crossed` are; the counters go on to the
    /// next.
    fn pass(&mut self, crossed: u16) -> [u32; 12] {
        let has = |edge: u32| u32::from(crossed >> edge & 1);
        let Counters { x, y, z } = self;
        let edges = [
            x[0],
            x[1],
            x[2],
            x[3],
            y[0],
            y[0] + has(4),
            y[1],
            y[1] + has(6),
            z[0],
            z[0] + has(8),
            z[1],
            z[1] + has(10),
        ];
        *x = [x[0] + has(0), x[1] + has(1), x[2] + has(2), x[3] + has(3)];
        *y = [edges[5], edges[7]];
        *z = [edges[9], edges[11]];
        edges
    }
}

/// Counts what is done, and stops when the run is cancelled.
struct Meter<'a> {
    run: &'a Run,
    done: AtomicUsize,
    total: usize,
}

impl<'a> Meter<'a> {
    fn new(run: &'a Run, total: usize) -> Meter<'a> {
        Meter { run, done: AtomicUsize::new(0), total }
    }

    fn step(&self) -> Result<(), Cancelled> {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        self.run.report(done as f64 / self.total as f64);
        self.run.check()
    }
}

impl Volume<'_> {
    /// The gradient at a node (numbered from 1) by central differences, one-sided at the border.
    fn gradient(&self, node: [usize; 3]) -> DVec3 {
        let [nx, ny, _] = self.size;
        let strides = [1, nx, nx * ny];
        let at = [0, 1, 2].map(|axis| node[axis] - 1);
        let place = at[0] + at[1] * strides[1] + at[2] * strides[2];
        let along = |axis: usize| {
            let below = usize::from(at[axis] > 0);
            let above = usize::from(at[axis] + 1 < self.size[axis]);
            let value = |place: usize| f64::from(self.samples[place]);
            let rise = value(place + above * strides[axis]) - value(place - below * strides[axis]);
            rise / ((below + above).max(1) as f64 * self.spacing[axis])
        };
        DVec3::new(along(0), along(1), along(2))
    }
}
