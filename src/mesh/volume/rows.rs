//! All rows of signs of a volume: counted first, then written where they belong.

use std::ops::RangeInclusive;

use glam::Vec3;

use super::bits::{CellRow, Word, pack};
use super::{Volume, VolumeError, VolumeSettings};
use crate::geom::Mesh;
use crate::mesh::bulk::Bulk;
use crate::mesh::table::{CaseTable, EDGE_CORNERS};
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// The signs of all nodes, with a layer of outside nodes around them: node i of the array is
/// number i + 1 here.
pub(super) struct Rows<'a> {
    pub(super) volume: &'a Volume<'a>,
    pub(super) settings: VolumeSettings,
    /// Words of a row.
    pub(super) words: usize,
    /// Rows of a layer, those of the layer around included.
    pub(super) across: usize,
    bits: Vec<u64>,
    /// The edges along x, by their lower nodes, that may be crossed, and so the cells.
    pub(super) allowed: Vec<u64>,
    /// Which rows have edges upwards, along y and z: from the first to the last.
    upward: [RangeInclusive<usize>; 2],
    pub(super) table: Cases,
}

/// What the case table says, ready for counters.
pub(super) struct Cases {
    pub(super) table: &'static CaseTable,
    /// Which of the twelve edges are crossed, as bits.
    pub(super) crossed: [u16; 256],
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

impl<'a> Rows<'a> {
    pub(super) fn new(volume: &'a Volume<'a>, settings: &VolumeSettings, run: &Run) -> Result<Rows<'a>, Cancelled> {
        let [nx, ny, nz] = volume.size;
        let (words, across) = ((nx + 2).div_ceil(64), ny + 2);
        let mut bits = vec![0; words * across * (nz + 2)];
        let meter = Meter::new(run, nz);
        let layers = &mut bits[words * across..][..words * across * nz];
        jobs::try_chunks_mut(layers, words * across, |k, bits| {
            meter.step()?;
            let samples = &volume.samples[k * nx * ny..][..nx * ny];
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

    pub(super) fn row(&self, j: usize, k: usize) -> &[u64] {
        &self.bits[(k * self.across + j) * self.words..][..self.words]
    }

    pub(super) fn cells(&self, j: usize, k: usize) -> CellRow<'_> {
        CellRow([self.row(j, k), self.row(j + 1, k), self.row(j, k + 1), self.row(j + 1, k + 1)])
    }

    /// The crossed edges of 64 nodes of a row, along x, y and z.
    #[inline(always)]
    pub(super) fn crossed(&self, [j, k]: [usize; 2], w: usize, word: &Word) -> [u64; 3] {
        let up = |axis: usize, at: usize| if self.upward[axis].contains(&at) { u64::MAX } else { 0 };
        let Word { row, next } = word;
        [(row[0] ^ next[0]) & self.allowed[w], (row[0] ^ row[1]) & up(0, j), (row[0] ^ row[2]) & up(1, k)]
    }

    /// Whether cells start at a row.
    pub(super) fn has_cells(&self, j: usize, k: usize) -> bool {
        self.upward[0].contains(&j) && self.upward[1].contains(&k)
    }

    /// Counts the vertices of each row and the triangles of a layer; the rows' starts within
    /// the layer are noted.
    fn count(&self, k: usize, starts: &mut [Start]) -> Count {
        let mut count = Count::default();
        for (j, start) in starts[..=self.volume.size[1]].iter_mut().enumerate() {
            let cells = self.cells(j, k);
            let has_cells = self.has_cells(j, k);
            let mut along = [0; 3];
            for w in 0..self.words {
                let word = cells.word(w);
                let mut mixed = word.mixed();
                if mixed == 0 {
                    continue;
                }
                let [x, y, z] = self.crossed([j, k], w, &word);
                along = [along[0] + x.count_ones(), along[1] + y.count_ones(), along[2] + z.count_ones()];
                mixed &= if has_cells { self.allowed[w] } else { 0 };
                while mixed != 0 {
                    count.triangles += u64::from(self.table.triangles[word.case(mixed.trailing_zeros())]);
                    mixed &= mixed - 1;
                }
            }
            let first = count.vertices as u32;
            *start = [first, first + along[0], first + along[0] + along[1]];
            count.vertices += u64::from(along[0]) + u64::from(along[1]) + u64::from(along[2]);
        }
        starts[self.volume.size[1] + 1] = [count.vertices as u32; 3];
        count
    }

    pub(super) fn mesh(&self, run: &Run) -> Result<Mesh, VolumeError> {
        let layers = self.volume.size[2] + 1;
        // One row more than there are layers of cells: its vertices, all in the layer around,
        // are none.
        let mut starts: Vec<Start> = vec![[0; 3]; self.across * (layers + 1)];
        let meter = Meter::new(run, 2 * layers);
        let counted: Vec<(usize, &mut [Start])> = starts.chunks_mut(self.across).take(layers).enumerate().collect();
        let counts = jobs::try_taking(counted, |(k, starts)| {
            meter.step()?;
            Ok::<Count, Cancelled>(self.count(k, starts))
        })?;
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
        let mut positions = Bulk::from(vec![Vec3::ZERO; all.vertices as usize]);
        let mut normals = Bulk::from(vec![Vec3::ZERO; if self.settings.normals { all.vertices as usize } else { 0 }]);
        let mut triangles = Bulk::from(vec![[0; 3]; all.triangles as usize]);
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
        jobs::try_taking(pieces.into_iter().enumerate().collect(), |(k, piece): (usize, Piece<'_>)| {
            meter.step()?;
            let starts = &starts[k * self.across..];
            self.vertices(k, starts, piece.positions, piece.normals);
            self.triangles(k, starts, piece.triangles);
            Ok::<(), Cancelled>(())
        })?;
        let mesh = Mesh::new(positions.into_vec(), triangles.into_vec())?;
        Ok(if self.settings.normals { mesh.with_normals(normals.into_vec())? } else { mesh })
    }
}

/// A layer's part of the mesh.
struct Piece<'a> {
    positions: &'a mut [Vec3],
    normals: &'a mut [Vec3],
    triangles: &'a mut [[u32; 3]],
}

/// The first vertices of a row along x, y and z.
pub(super) type Start = [u32; 3];
