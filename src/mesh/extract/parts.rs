//! All blocks after the first pass, and the triangles of their cells by the case table.

use glam::Vec3;

use super::block_vertices::{Corners, note_row};
use super::lists::split;
use super::neighbours::Neighbours;
use super::suspect::Suspect;
use super::{BATCH, Batch, ExtractError, Mismatch, Part};
use crate::mesh::Features;
use crate::mesh::bulk::Bulk;
use crate::mesh::signs::{BLOCK, SIDE, for_each_cell, is_mixed};
use crate::mesh::table::CaseTable;
use rvachev_num::{Meter, jobs};

use crate::{Cancelled, Run};

/// Why no more triangles are listed.
enum Stop {
    Open,
    Error(ExtractError),
}

impl From<ExtractError> for Stop {
    fn from(error: ExtractError) -> Stop {
        Stop::Error(error)
    }
}

impl From<Cancelled> for Stop {
    fn from(cancelled: Cancelled) -> Stop {
        Stop::Error(cancelled.into())
    }
}

/// What looks on while triangles are listed by the case table.
pub(super) trait Watch {
    /// Whether it may tell that triangles will not do.
    const STOPS: bool = true;

    /// A vertex on an edge of the next block's cells, and its place among their [`Corners`].
    fn note(&mut self, place: usize, vertex: u32);

    /// Whether the triangles of block `n` will not do, given the vertices of its cells.
    fn is_open(&mut self, n: usize, corners: &Corners) -> bool;
}

/// All will do.
impl Watch for () {
    const STOPS: bool = false;

    #[inline(always)]
    fn note(&mut self, _place: usize, _vertex: u32) {}

    #[inline(always)]
    fn is_open(&mut self, _n: usize, _corners: &Corners) -> bool {
        false
    }
}

/// All blocks after the first pass.
pub(super) struct Parts<'a> {
    pub(super) blocks: &'a [[u32; 3]],
    pub(super) neighbours: Neighbours,
    /// In batches, as they were sampled.
    parts: Vec<Vec<Part>>,
    positions: Bulk<Vec3>,
    normals: Bulk<Vec3>,
    /// How many times as many vertices there is room made for: for some to be added.
    room: f64,
    /// How many of the vertices are moved to keep clear of nodes.
    pub(super) clamped: usize,
    /// Blocks that may have lost a feature, in their order; and of those that still may, the first
    /// cells.
    pub(super) suspects: Vec<Suspect>,
    pub(super) lost: Vec<[u32; 3]>,
}

impl<'a> Parts<'a> {
    /// Some blocks, before the first pass.
    pub(super) fn new(blocks: &'a [[u32; 3]], neighbours: Neighbours, features: Features) -> Parts<'a> {
        let (parts, positions, normals) = (Vec::new(), Bulk::default(), Bulk::default());
        let room = match features {
            Features::Smooth => 1.1,
            Features::Sharp => 1.8,
        };
        Parts {
            blocks,
            neighbours,
            parts,
            positions,
            normals,
            room,
            clamped: 0,
            suspects: Vec::new(),
            lost: Vec::new(),
        }
    }

    /// Adds what the first pass leaves of the next blocks, and numbers their vertices.
    pub(super) fn add(&mut self, batch: Batch) -> Result<(), ExtractError> {
        let Batch { mut parts, positions, normals, clamped, suspects } = batch;
        let start = self.positions.len();
        let count = start as u64 + positions.len() as u64;
        if count > u64::from(u32::MAX) {
            return Err(ExtractError::TooLarge { count });
        }
        for part in &mut parts {
            part.first += start as u32;
        }
        self.parts.push(parts);
        let progress = (self.parts.len(), self.blocks.len().div_ceil(BATCH));
        reserve(&mut self.positions, positions.len(), progress, self.room);
        reserve(&mut self.normals, normals.len(), progress, self.room);
        self.positions.extend_from_slice(&positions);
        self.normals.extend_from_slice(&normals);
        self.clamped += clamped;
        self.suspects.extend(suspects);
        Ok(())
    }

    #[inline]
    pub(super) fn part(&self, n: usize) -> &Part {
        &self.parts[n / BATCH][n % BATCH]
    }

    /// Checks that wherever a face has both signs there is a block on its other side, and
    /// that the two agree. It follows that every cell around a crossed edge is in a block,
    /// and every vertex in the list of its owner.
    pub(super) fn check_faces(&self, run: &Run) -> Result<(), ExtractError> {
        let meter = Meter::new(run, self.blocks.len());
        let of_batch = |batch: usize, blocks: &[_]| {
            let mut mismatches = Vec::new();
            for n in (batch * BATCH..).take(blocks.len()) {
                meter.step()?;
                self.add_mismatches(n, &mut mismatches);
            }
            Ok::<_, Cancelled>(mismatches)
        };
        let mismatches = jobs::try_chunks(self.blocks, BATCH, of_batch)?.concat();
        if mismatches.is_empty() { Ok(()) } else { Err(ExtractError::Mismatches(mismatches)) }
    }

    /// Adds the faces of block `n` that are not as they should be.
    fn add_mismatches(&self, n: usize, mismatches: &mut Vec<Mismatch>) {
        let (block, signs) = (self.blocks[n], &self.part(n).signs);
        for axis in 0..3 {
            let mut add = |up: bool, what| {
                let mut beyond = block;
                let side = BLOCK as u32;
                let at = if up { block[axis].checked_add(side) } else { block[axis].checked_sub(side) };
                beyond[axis] = at.unwrap_or_default();
                mismatches.push(Mismatch { block, beyond: at.map(|_| beyond), what });
            };
            let ours = signs.face(axis, true);
            match self.neighbours.upper(n, 1 << axis) {
                Some(other) if self.part(other).signs.face(axis, false) != ours => {
                    add(true, "an upper neighbour has other signs on their common face");
                }
                None if is_mixed(&ours) => add(true, "the surface goes on in an upper neighbour not listed"),
                _ => {}
            }
            if self.neighbours.lower(n, axis).is_none() && is_mixed(&signs.face(axis, false)) {
                add(false, "the surface goes on in a lower neighbour not listed");
            }
        }
    }

    /// Positions and normals of all vertices, which are given up.
    pub(super) fn take_vertices(&mut self) -> [Bulk<Vec3>; 2] {
        [std::mem::take(&mut self.positions), std::mem::take(&mut self.normals)]
    }

    /// The triangles of all cells by the case table, in the order of the blocks; nothing if what
    /// watches tells that they will not do.
    pub(super) fn triangles_unless<W: Watch + Send>(
        &self,
        watch: impl Fn() -> W + Sync + Send,
        run: &Run,
    ) -> Result<Option<Bulk<[u32; 3]>>, ExtractError> {
        let meter = Meter::new(run, self.blocks.len());
        let counts: Vec<usize> =
            self.parts.iter().map(|batch| batch.iter().map(|part| part.triangles as usize).sum()).collect();
        let mut triangles = Bulk::default();
        let of_batch = |(corners, watch): &mut (Corners, W), (batch, mut piece): (usize, &mut [[u32; 3]])| {
            for n in batch * BATCH..batch * BATCH + self.parts[batch].len() {
                meter.step()?;
                let (own, rest) = std::mem::take(&mut piece).split_at_mut(self.part(n).triangles as usize);
                self.list_triangles(n, (corners, watch), own)?;
                piece = rest;
                if watch.is_open(n, corners) {
                    return Err(Stop::Open);
                }
            }
            Ok(())
        };
        let worker = || (Corners::new(), watch());
        // Most often the first batch tells that triangles will not do: room for those of others is
        // made after it.
        let all = counts.len();
        let first = if W::STOPS { all.min(1) } else { all };
        for batches in [0..first, first..all].into_iter().filter(|batches| !batches.is_empty()) {
            let (start, counts) = (triangles.len(), &counts[batches.clone()]);
            triangles.add_zeros(counts.iter().sum());
            let pieces = split(&mut triangles[start..], counts.iter().copied());
            match jobs::try_taking_with(batches.zip(pieces).collect(), worker, of_batch) {
                Ok(_) => {}
                Err(Stop::Open) => return Ok(None),
                Err(Stop::Error(error)) => return Err(error),
            }
        }
        Ok(Some(triangles))
    }

    /// Lists the triangles of the cells of block `n` by the case table, in the order of the cells.
    /// There is room for so many.
    pub(super) fn list_triangles(
        &self,
        n: usize,
        (corners, watch): (&mut Corners, &mut impl Watch),
        out: &mut [[u32; 3]],
    ) -> Result<(), ExtractError> {
        if out.is_empty() {
            return Ok(());
        }
        self.number(n, |place, vertex| {
            corners.note(place, vertex);
            watch.note(place, vertex);
        })?;
        let (table, mut slots) = (CaseTable::get(), out.iter_mut());
        for_each_cell(&self.part(n).signs, |cell, case| {
            let ids = corners.of_cell(cell);
            for (triangle, slot) in table.triangles(case).iter().zip(&mut slots) {
                *slot = triangle.map(|edge| ids[usize::from(edge & 15)]);
            }
        });
        Ok(())
    }

    /// Tells `note` the vertices on all edges of the cells of block `n`, and the places of these
    /// among its [`Corners`]; an error if the owner of one is not there.
    ///
    /// Edges that start in an upper face belong to the neighbour there: those along the two
    /// other axes, in its first row or column.
    pub(super) fn number(&self, n: usize, mut note: impl FnMut(usize, u32)) -> Result<(), ExtractError> {
        let missing = || {
            let what = "a vertex is missing in the neighbour that owns it";
            Err(ExtractError::Blocks { block: self.blocks[n], what })
        };
        let part = self.part(n);
        for k in 0..BLOCK {
            for j in 0..BLOCK {
                note_row(part, [true; 3], [j, k], [j, k], &mut note);
            }
        }
        let signs = &part.signs;
        let upper = |bits: usize| self.neighbours.upper(n, bits).map(|other| self.part(other));
        let mut complete = true;
        // Beyond y and z: rows as they are.
        let mut row = |bits: usize, axes: [bool; 3], to: [usize; 2]| match upper(bits) {
            Some(other) => note_row(other, axes, to.map(|at| at % BLOCK), to, &mut note),
            None => complete &= !signs.is_crossed(axes, to),
        };
        for n in 0..BLOCK {
            row(2, [true, false, true], [BLOCK, n]);
            row(4, [true, true, false], [n, BLOCK]);
        }
        row(6, [true, false, false], [BLOCK, BLOCK]);
        // Beyond x: the first edges of rows, along y and z.
        let last = signs.face(0, true);
        for k in 0..SIDE {
            let along_y = (last[k] ^ last[k] >> 1) & ((1 << BLOCK) - 1);
            let along_z = last.get(k + 1).map_or(0, |next| last[k] ^ next);
            let mut crossed = along_y | along_z;
            while crossed != 0 {
                let j = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                let bits = 1 | (j / BLOCK) << 1 | (k / BLOCK) << 2;
                let Some(other) = upper(bits) else { return missing() };
                let (row_j, row_k) = (j % BLOCK, k % BLOCK);
                let [x, y, _] = other.signs.crossed(row_j, row_k);
                let vertex = other.first + other.rows.start(row_j, row_k) + x.count_ones();
                if along_y >> j & 1 == 1 {
                    note(Corners::place(1, [BLOCK, j, k]), vertex);
                }
                if along_z >> j & 1 == 1 {
                    note(Corners::place(2, [BLOCK, j, k]), vertex + y.count_ones());
                }
            }
        }
        if complete { Ok(()) } else { missing() }
    }
}

/// Makes room for more in a list, and for what is to come by what it has when `done` parts of
/// `all` are added, times `share`: moving much is slow.
fn reserve<T>(list: &mut Vec<T>, more: usize, (done, all): (usize, usize), share: f64) {
    let count = list.len() + more;
    if count > list.capacity() {
        // Few parts do not tell.
        let times = if done * 16 < all { 2.0 } else { share * all as f64 / done as f64 };
        list.reserve_exact((times * count as f64) as usize - list.len());
    }
}
