//! The cells of blocks that do not have the patches of the case table: found block by block, and kept for many
//! blocks in one list each.

use std::ops::Range;

use glam::Vec3A;
use rayon::prelude::*;

use super::Sampler;
use super::bulge::{Bulge, Cover, Ring};
use super::joined::Joined;
use super::nearby::Nearby;
use super::samples::{Samples, cell_number, cell_of};
use crate::mesh::feature::{Candidate, Refiner, Segment};
use crate::mesh::loops::{CellLoop, MOST};
use crate::mesh::meter::Meter;
use crate::mesh::signs::{BLOCK, for_each_cell};
use crate::mesh::table::CaseTable;
use crate::run::{Cancelled, Run};

/// Blocks that have their lists together.
const AT_ONCE: usize = 16;

/// The number of the list that the segments of a block are in.
pub(super) fn list_of(block: usize) -> u32 {
    (block / AT_ONCE) as u32
}

/// The special cells of all blocks.
#[derive(Default)]
pub(super) struct Special(Vec<Lists>);

/// Those of consecutive blocks, each list in the order of the blocks; cells of a block are in the order of the lengths
/// of their loops.
#[derive(Clone, Default)]
struct Lists {
    /// Those with a single loop whose normals spread, or that have joined faces.
    candidates: Vec<Candidate>,
    /// Their numbers in their blocks.
    numbers: Vec<u16>,
    /// The segments of all candidates.
    segments: Vec<Segment>,
    /// Smooth ones with a vertex in their middle.
    bulges: Vec<Bulge>,
    /// All but the candidates, by number, and how many triangles each has.
    cells: Vec<(u16, u8)>,
    /// Their triangles.
    plain: Vec<[u32; 3]>,
    blocks: Vec<OfBlock>,
}

/// Where the lists have what belongs to a block.
#[derive(Clone, Default)]
struct OfBlock {
    candidates: Range<usize>,
    bulges: Range<usize>,
    cells: Range<usize>,
    /// None for a block that has not been looked at.
    plain: Option<Range<usize>>,
    /// How many of these are dropped, and of the bulges.
    dropped: usize,
    dropped_bulges: usize,
}

/// What takes the place of triangles that are dropped: no vertex has that number.
pub(super) const DROPPED: [u32; 3] = [u32::MAX; 3];

impl Special {
    /// Finds the special cells of the blocks whose normals spread or that have joined faces.
    pub(super) fn find<S: Sampler>(
        samples: &Samples<'_>,
        sampler: &S,
        (spread, joined): (&[bool], &Joined),
        run: &Run,
    ) -> Result<Special, Cancelled> {
        let meter = Meter::new(run, spread.len());
        let of_chunk = |worker: &mut Worker<S>, (chunk, spread): (usize, &[bool])| {
            let mut lists = std::mem::take(&mut worker.lists);
            lists.clear();
            for (n, spreads) in (chunk * AT_ONCE..).zip(spread) {
                meter.step()?;
                let is_special = *spreads || joined.concerns(samples, n);
                let block =
                    if is_special { lists.add(samples, sampler, joined, n, worker) } else { OfBlock::default() };
                lists.blocks.push(block);
            }
            // Copies take no more memory than they need.
            worker.lists = lists;
            Ok(worker.lists.clone())
        };
        let chunks = spread.par_chunks(AT_ONCE).enumerate();
        let lists: Result<_, Cancelled> = chunks.map_init(|| Worker::new(sampler), of_chunk).collect();
        Ok(Special(lists?))
    }

    /// The lists that hold what belongs to a block, and where.
    fn at(&self, block: usize) -> (&Lists, &OfBlock) {
        let lists = &self.0[block / AT_ONCE];
        (lists, &lists.blocks[block % AT_ONCE])
    }

    /// How many candidates there are.
    pub(super) fn count(&self) -> usize {
        self.0.iter().map(|lists| lists.candidates.len()).sum()
    }

    /// Takes the segments, in lists: see [`list_of`].
    pub(super) fn take_segments(&mut self) -> Vec<Vec<Segment>> {
        self.0.iter_mut().map(|lists| std::mem::take(&mut lists.segments)).collect()
    }

    /// Drops the candidates.
    pub(super) fn drop_candidates(&mut self) {
        for lists in &mut self.0 {
            lists.candidates = Vec::new();
            lists.blocks.iter_mut().for_each(|block| block.candidates = 0..0);
        }
    }

    /// The candidates of a block.
    pub(super) fn candidates(&self, block: usize) -> &[Candidate] {
        let (lists, of_block) = self.at(block);
        &lists.candidates[of_block.candidates.clone()]
    }

    /// The candidate of a block that is a cell, given by its number.
    pub(super) fn candidate(&self, block: usize, cell: u16) -> Option<&Candidate> {
        let (lists, of_block) = self.at(block);
        let nth = lists.numbers[of_block.candidates.clone()].iter().position(|&number| number == cell)?;
        Some(&lists.candidates[of_block.candidates.start + nth])
    }

    /// The segments of a candidate of a block.
    #[inline]
    pub(super) fn segments(&self, block: usize, candidate: &Candidate) -> &[Segment] {
        candidate.segments(&self.0[block / AT_ONCE].segments)
    }

    /// How many bulges of a block are there.
    pub(super) fn bulges(&self, block: usize) -> usize {
        let (_, of_block) = self.at(block);
        of_block.bulges.len() - of_block.dropped_bulges
    }

    /// The triangles of a block's cells that are no candidates, if it has been looked at; and how many of them are
    /// [`DROPPED`].
    pub(super) fn plain(&self, block: usize) -> Option<(&[[u32; 3]], usize)> {
        let lists = self.0.get(block / AT_ONCE)?;
        let OfBlock { plain, dropped, .. } = &lists.blocks[block % AT_ONCE];
        plain.clone().map(|plain| (&lists.plain[plain], *dropped))
    }

    /// Drops the triangles and bulges of some cells of a block, given by their numbers.
    pub(super) fn drop_cells(&mut self, block: usize, cells: impl Iterator<Item = u16>) {
        let mut bits = [0_u64; BLOCK * BLOCK * BLOCK / 64];
        cells.for_each(|number| bits[usize::from(number) / 64] |= 1 << (number % 64));
        let is_dropped = |number: u16| bits[usize::from(number) / 64] >> (number % 64) & 1 == 1;
        let lists = &mut self.0[block / AT_ONCE];
        let OfBlock { bulges, cells, plain, dropped, dropped_bulges, .. } = &mut lists.blocks[block % AT_ONCE];
        let Some(plain) = plain else { return };
        let mut rest = &mut lists.plain[plain.clone()];
        for &(number, count) in &lists.cells[cells.clone()] {
            let (triangles, others) = std::mem::take(&mut rest).split_at_mut(usize::from(count));
            if is_dropped(number) {
                triangles.fill(DROPPED);
                *dropped += triangles.len();
            }
            rest = others;
        }
        for bulge in lists.bulges[bulges.clone()].iter_mut().filter(|bulge| is_dropped(bulge.cell)) {
            bulge.drop_it();
            *dropped_bulges += 1;
        }
    }

    /// All bulges that are there, in order.
    pub(super) fn all_bulges(&self) -> impl Iterator<Item = &Bulge> {
        self.0.iter().flat_map(|lists| &lists.bulges).filter(|bulge| bulge.is_there())
    }

    /// Numbers the vertices of bulges in the triangles; `first` tells which vertex the first one of a block is, and
    /// `number` the number of that.
    pub(super) fn number_bulges(&mut self, first: impl Fn(usize) -> u32 + Sync, number: impl Fn(u32) -> u32 + Sync) {
        self.0.par_iter_mut().enumerate().for_each(|(chunk, lists)| {
            let bulges = lists.bulges.iter().filter(|bulge| bulge.is_there());
            for (nth, bulge) in (first(chunk * AT_ONCE)..).zip(bulges) {
                let triangles = &mut lists.plain[bulge.first as usize..][..usize::from(bulge.sides)];
                triangles.iter_mut().for_each(|triangle| triangle[0] = number(nth));
            }
        });
    }
}

/// One thread's means to look at blocks.
struct Worker<S: Sampler> {
    scratch: S::Scratch,
    nearby: Nearby,
    /// The cells at hand with a single loop, by the length of that: their numbers and cases.
    by_length: [Vec<(u16, u8)>; MOST + 1],
    refiner: Refiner,
    lists: Lists,
}

impl<S: Sampler> Worker<S> {
    fn new(sampler: &S) -> Worker<S> {
        Worker {
            scratch: sampler.scratch(),
            nearby: Nearby::new(),
            by_length: Default::default(),
            refiner: Refiner::default(),
            lists: Lists::default(),
        }
    }
}

impl Lists {
    fn clear(&mut self) {
        self.candidates.clear();
        self.numbers.clear();
        self.segments.clear();
        self.bulges.clear();
        self.cells.clear();
        self.plain.clear();
        self.blocks.clear();
    }

    /// Adds what is special in block `n`.
    fn add<S: Sampler>(
        &mut self,
        samples: &Samples<'_>,
        sampler: &S,
        joined: &Joined,
        n: usize,
        worker: &mut Worker<S>,
    ) -> OfBlock {
        // What is missing in a neighbour is an error of the second pass.
        if !worker.nearby.load(samples, n) {
            return OfBlock::default();
        }
        let Worker { scratch, nearby, by_length, refiner, .. } = worker;
        let (candidates, bulges) = (self.candidates.len(), self.bulges.len());
        let (segments, cells, plain) = (self.segments.len(), self.cells.len(), self.plain.len());
        refiner.clear();
        by_length.iter_mut().for_each(Vec::clear);
        let block = samples.blocks()[n];
        let has_joined = joined.concerns(samples, n);
        let loops = CellLoop::table();
        for_each_cell(&samples.parts.part(n).signs, |within, case| {
            let cell = || std::array::from_fn(|axis| block[axis] + within[axis] as u32);
            let faces = if has_joined { joined.of(samples, cell(), case) } else { 0 };
            match &loops[usize::from(case)] {
                Some(outline) if faces == 0 => by_length[outline.len()].push((cell_number(within), case)),
                _ => self.add_other(nearby, (block, within), (case, faces), refiner),
            }
        });
        // Cells with loops of one length are looked at by code for that length.
        self.add_cells::<3>(samples, nearby, block, &by_length[3], refiner);
        self.add_cells::<4>(samples, nearby, block, &by_length[4], refiner);
        self.add_cells::<5>(samples, nearby, block, &by_length[5], refiner);
        self.add_cells::<6>(samples, nearby, block, &by_length[6], refiner);
        self.add_cells::<7>(samples, nearby, block, &by_length[7], refiner);
        let found = (&mut self.candidates[candidates..], &mut self.segments[segments..]);
        refiner.refine(found.0, found.1, samples.lattice.step() as f32, |points, out| {
            sampler.slopes(scratch, n, block, points, out)
        });
        OfBlock {
            candidates: candidates..self.candidates.len(),
            bulges: bulges..self.bulges.len(),
            cells: cells..self.cells.len(),
            plain: Some(plain..self.plain.len()),
            dropped: 0,
            dropped_bulges: 0,
        }
    }

    /// Adds what cells of a block, given by its first cell, with loops of `N` in the table are to have.
    fn add_cells<const N: usize>(
        &mut self,
        samples: &Samples<'_>,
        nearby: &Nearby,
        block: [u32; 3],
        cells: &[(u16, u8)],
        refiner: &mut Refiner,
    ) {
        let loops = CellLoop::table();
        for &(number, case) in cells {
            let Some(outline) = &loops[usize::from(case)] else { continue };
            let Some(edges) = outline.edges().first_chunk::<N>() else { continue };
            let within = cell_of([0; 3], number).map(|n| n as usize);
            let around = nearby.places(within, edges);
            let ring = Ring::new(nearby, around);
            let vertices = around.map(|place| nearby.vertex(place));
            let cover = if ring.is_flat() {
                Cover::Table
            } else if ring.is_smooth() {
                ring.cover(nearby)
            } else {
                let low = vector(within);
                let places = around.map(|place| nearby.position(place) - low);
                let mut segments: [_; N] =
                    std::array::from_fn(|n| Segment::new(vertices[n], ring.normals[n].into(), outline.face(n)));
                self.add_candidate((block, within), &mut segments, (&ring.normals, &places), refiner);
                continue;
            };
            // As many as three bits tell.
            let mut corners = [0; 8];
            corners[..N].copy_from_slice(&vertices);
            let corner = |n: u8| corners[usize::from(n & 7)];
            let start = self.plain.len();
            match cover {
                Cover::Table => self.plain.extend(outline.triangles::<N>().iter().map(|triangle| triangle.map(corner))),
                Cover::Two(triangles) => self.plain.extend_from_slice(&triangles.map(|triangle| triangle.map(corner))),
                Cover::Top { at, normal } => {
                    let cell = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
                    let at = samples.inside(at - vector(within), cell, cell.map(|n| n + 1));
                    let (sides, first) = (N as u16, start as u32);
                    self.bulges.push(Bulge { cell: number, sides, first, at, normal: normal.into() });
                    // Its number is not known yet.
                    let triangles: [_; N] = std::array::from_fn(|n| [0, vertices[n], vertices[(n + 1) % N]]);
                    self.plain.extend_from_slice(&triangles);
                }
            }
            self.cells.push((number, (self.plain.len() - start) as u8));
        }
    }

    /// Adds what a cell of a block, given by its first cell, with several loops or with joined faces is to have.
    #[cold]
    fn add_other(
        &mut self,
        nearby: &Nearby,
        (block, within): ([u32; 3], [usize; 3]),
        (case, faces): (u8, u8),
        refiner: &mut Refiner,
    ) {
        let all = nearby.all_places(within);
        let corner = |edge: u8| nearby.vertex(all[usize::from(edge & 15)]);
        let (table, start) = (CaseTable::get(), self.plain.len());
        if faces == 0 {
            self.plain.extend(table.triangles(case).iter().map(|triangle| triangle.map(corner)));
        } else if let Some(outline) = CellLoop::single(case, faces) {
            // The table knows nothing of joined faces.
            let (low, around) = (vector(within), outline.edges().iter().map(|&edge| all[usize::from(edge & 15)]));
            let normals: Vec<Vec3A> = around.clone().map(|place| nearby.normal(place)).collect();
            let places: Vec<Vec3A> = around.clone().map(|place| nearby.position(place) - low).collect();
            let segment =
                |(n, place): (usize, u32)| Segment::new(nearby.vertex(place), normals[n].into(), outline.face(n));
            let mut segments: Vec<Segment> = around.enumerate().map(segment).collect();
            return self.add_candidate((block, within), &mut segments, (&normals, &places), refiner);
        } else {
            let turned = table.triangles(!case).iter();
            self.plain.extend(turned.map(|&[a, b, c]| [corner(a), corner(c), corner(b)]));
        }
        self.cells.push((cell_number(within), (self.plain.len() - start) as u8));
    }

    /// Adds a cell with a single loop around it that is to have a fan, given with the normals at its vertices and with
    /// their places from the cell's first node.
    #[inline(always)]
    fn add_candidate(
        &mut self,
        (block, within): ([u32; 3], [usize; 3]),
        segments: &mut [Segment],
        (normals, places): (&[Vec3A], &[Vec3A]),
        refiner: &mut Refiner,
    ) {
        let cell = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
        let candidate = Candidate::new(cell, self.segments.len(), segments, places);
        refiner.add(vector(within), candidate.at, normals, places);
        self.segments.extend_from_slice(segments);
        self.numbers.push(cell_number(within));
        self.candidates.push(candidate);
    }
}

fn vector(cell: [usize; 3]) -> Vec3A {
    let [x, y, z] = cell.map(|n| n as i32 as f32);
    Vec3A::new(x, y, z)
}
