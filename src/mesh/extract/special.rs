//! The cells of blocks that do not have the patches of the case table: found block by block, and kept for many
//! blocks in one list each.

use std::ops::Range;

use glam::Vec3A;
use rayon::prelude::*;

use super::Sampler;
use super::bulge::{Bulge, Cover, Ring};
use super::joined::Joined;
use super::nearby::Nearby;
use super::samples::{Samples, cell_number};
use crate::mesh::feature::{Candidate, Refiner, Segment};
use crate::mesh::loops::{CellLoop, LONGEST};
use crate::mesh::meter::Meter;
use crate::mesh::signs::for_each_cell;
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

/// Those of consecutive blocks, each list in the order of the blocks and of their cells.
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
    /// Those with the patches of the opposite case, by number.
    opposite: Vec<u16>,
    /// The triangles of all but the candidates, in the order of cells.
    plain: Vec<[u32; 3]>,
    blocks: Vec<OfBlock>,
}

/// Where the lists have what belongs to a block.
#[derive(Clone, Default)]
struct OfBlock {
    candidates: Range<usize>,
    bulges: Range<usize>,
    opposite: Range<usize>,
    /// None for a block that has not been looked at.
    plain: Option<Range<usize>>,
}

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
            worker.places.clear();
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

    /// The candidates of a block, in order.
    pub(super) fn candidates(&self, block: usize) -> &[Candidate] {
        let (lists, of_block) = self.at(block);
        &lists.candidates[of_block.candidates.clone()]
    }

    /// The candidate of a block that is a cell, given by its number.
    pub(super) fn candidate(&self, block: usize, cell: u16) -> Option<&Candidate> {
        let (lists, of_block) = self.at(block);
        let nth = lists.numbers[of_block.candidates.clone()].binary_search(&cell).ok()?;
        Some(&lists.candidates[of_block.candidates.start + nth])
    }

    /// The segments of a candidate of a block.
    #[inline]
    pub(super) fn segments(&self, block: usize, candidate: &Candidate) -> &[Segment] {
        candidate.segments(&self.0[block / AT_ONCE].segments)
    }

    /// The bulges of a block, in order.
    pub(super) fn bulges(&self, block: usize) -> &[Bulge] {
        let Some(lists) = self.0.get(block / AT_ONCE) else { return &[] };
        &lists.bulges[lists.blocks[block % AT_ONCE].bulges.clone()]
    }

    /// The triangles of a block's cells that are no candidates, in order, if it has been looked at.
    pub(super) fn plain(&self, block: usize) -> Option<&[[u32; 3]]> {
        let lists = self.0.get(block / AT_ONCE)?;
        let of_block = &lists.blocks[block % AT_ONCE];
        of_block.plain.clone().map(|plain| &lists.plain[plain])
    }

    /// Drops the triangles and bulges of some cells of a block, given by their numbers, ascending.
    pub(super) fn drop_cells(&mut self, samples: &Samples<'_>, block: usize, cells: impl Iterator<Item = u16>) {
        let lists = &mut self.0[block / AT_ONCE];
        let OfBlock { candidates, bulges, opposite, plain } = &mut lists.blocks[block % AT_ONCE];
        let Some(plain) = plain else { return };
        let mut cells = cells.peekable();
        let mut candidates = lists.numbers[candidates.clone()].iter().peekable();
        let mut bulges = lists.bulges[bulges.clone()].iter_mut().peekable();
        let mut opposite = lists.opposite[opposite.clone()].iter().peekable();
        let table = CaseTable::get();
        // Where the triangles of the next cell are, where those start that are to be moved, and where to.
        let (mut at, mut from, mut to) = (plain.start, plain.start, plain.start);
        for_each_cell(&samples.parts.part(block).signs, |within, case| {
            let number = cell_number(within);
            while cells.next_if(|other| *other < number).is_some() {}
            let Some(next) = cells.peek() else { return };
            let is_dropped = *next == number;
            if candidates.next_if(|other| **other == number).is_some() {
                return;
            }
            let bulge = bulges.next_if(|bulge| bulge.cell == number);
            let count = match &bulge {
                Some(bulge) => usize::from(bulge.sides),
                None if opposite.next_if(|other| **other == number).is_some() => table.triangles(!case).len(),
                None => table.triangles(case).len(),
            };
            match (is_dropped, bulge) {
                (true, bulge) => {
                    lists.plain.copy_within(from..at, to);
                    (from, to) = (at + count, to + at - from);
                    bulge.into_iter().for_each(Bulge::drop_it);
                }
                (false, Some(bulge)) => bulge.first = (to + at - from) as u32,
                (false, None) => {}
            }
            at += count;
        });
        // After the last one that is dropped all is moved as a whole.
        bulges.for_each(|bulge| bulge.first -= (from - to) as u32);
        lists.plain.copy_within(from..plain.end, to);
        plain.end -= from - to;
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
    /// By segment, the place of its vertex in the cell.
    places: Vec<Vec3A>,
    refiner: Refiner,
    lists: Lists,
}

impl<S: Sampler> Worker<S> {
    fn new(sampler: &S) -> Worker<S> {
        Worker {
            scratch: sampler.scratch(),
            nearby: Nearby::new(),
            places: Vec::new(),
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
        self.opposite.clear();
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
        let Worker { scratch, nearby, places, refiner, .. } = worker;
        let (candidates, bulges) = (self.candidates.len(), self.bulges.len());
        let (opposite, plain) = (self.opposite.len(), self.plain.len());
        let block = samples.blocks()[n];
        let has_joined = joined.concerns(samples, n);
        let (table, loops) = (CaseTable::get(), CellLoop::table());
        for_each_cell(&samples.parts.part(n).signs, |within, case| {
            let cell = || std::array::from_fn(|axis| block[axis] + within[axis] as u32);
            let faces = if has_joined { joined.of(samples, cell(), case) } else { 0 };
            if faces == 0
                && let Some(outline) = &loops[usize::from(case)]
            {
                return match outline.len() {
                    3 => self.add_cell::<3>(samples, nearby, (block, within), outline, places),
                    4 => self.add_cell::<4>(samples, nearby, (block, within), outline, places),
                    5 => self.add_cell::<5>(samples, nearby, (block, within), outline, places),
                    6 => self.add_cell::<6>(samples, nearby, (block, within), outline, places),
                    _ => self.add_cell::<7>(samples, nearby, (block, within), outline, places),
                };
            }
            let all = nearby.all_places(within);
            let corner = |edge: u8| nearby.vertex(all[usize::from(edge & 15)]);
            if faces == 0 {
                return self.plain.extend(table.triangles(case).iter().map(|triangle| triangle.map(corner)));
            }
            // The table knows nothing of joined faces.
            match CellLoop::single(case, faces) {
                Some(outline) => {
                    let mut around = [0; LONGEST];
                    for (place, &edge) in around.iter_mut().zip(outline.edges()) {
                        *place = all[usize::from(edge & 15)];
                    }
                    self.add_candidate(nearby, (block, within), &outline, (&around[..outline.len()], places));
                }
                None => {
                    self.opposite.push(cell_number(within));
                    let turned = table.triangles(!case).iter();
                    self.plain.extend(turned.map(|&[a, b, c]| [corner(a), corner(c), corner(b)]));
                }
            }
        });
        let found = &mut self.candidates[candidates..];
        let lists = (&mut self.segments[..], &places[..]);
        refiner.refine(block, found, lists, samples.lattice.step() as f32, |points, out| {
            sampler.slopes(scratch, n, block, points, out)
        });
        OfBlock {
            candidates: candidates..self.candidates.len(),
            bulges: bulges..self.bulges.len(),
            opposite: opposite..self.opposite.len(),
            plain: Some(plain..self.plain.len()),
        }
    }

    /// Adds what a cell of a block, given by its first cell, with a loop of `N` in the table is to have.
    #[inline(never)]
    fn add_cell<const N: usize>(
        &mut self,
        samples: &Samples<'_>,
        nearby: &Nearby,
        (block, within): ([u32; 3], [usize; 3]),
        outline: &CellLoop,
        places: &mut Vec<Vec3A>,
    ) {
        let Some(edges) = outline.edges().first_chunk::<N>() else { return };
        let around = nearby.places(within, edges);
        let ring = Ring::new(nearby, around);
        let cover = if ring.is_flat() {
            Cover::Table
        } else if ring.is_smooth() {
            ring.cover(nearby)
        } else {
            return self.add_candidate(nearby, (block, within), outline, (&around, places));
        };
        // As many as three bits tell.
        let mut vertices = [0; 8];
        for (vertex, &place) in vertices.iter_mut().zip(&around) {
            *vertex = nearby.vertex(place);
        }
        let corner = |n: u8| vertices[usize::from(n & 7)];
        match cover {
            Cover::Table => self.plain.extend(outline.triangles::<N>().iter().map(|triangle| triangle.map(corner))),
            Cover::Two(triangles) => self.plain.extend_from_slice(&triangles.map(|triangle| triangle.map(corner))),
            Cover::Top { at, normal } => {
                let cell = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
                let at = samples.inside(at - vector(within), cell, cell.map(|n| n + 1));
                let (cell, sides, first) = (cell_number(within), N as u16, self.plain.len() as u32);
                self.bulges.push(Bulge { cell, sides, first, at, normal: normal.into() });
                // Its number is not known yet.
                let triangles: [_; N] = std::array::from_fn(|n| [0, vertices[n], vertices[(n + 1) % N]]);
                self.plain.extend_from_slice(&triangles);
            }
        }
    }

    /// Adds a cell with a single loop around it that is to have a fan.
    fn add_candidate(
        &mut self,
        nearby: &Nearby,
        (block, within): ([u32; 3], [usize; 3]),
        outline: &CellLoop,
        (around, places): (&[u32], &mut Vec<Vec3A>),
    ) {
        let (first, low) = (self.segments.len(), vector(within));
        self.segments.extend(
            around
                .iter()
                .enumerate()
                .map(|(n, &place)| Segment::new(nearby.vertex(place), nearby.normal(place).into(), outline.face(n))),
        );
        places.extend(around.iter().map(|&place| nearby.position(place) - low));
        self.numbers.push(cell_number(within));
        let cell = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
        self.candidates.push(Candidate::new(cell, first, &mut self.segments, &places[first..]));
    }
}

fn vector(cell: [usize; 3]) -> Vec3A {
    let [x, y, z] = cell.map(|n| n as i32 as f32);
    Vec3A::new(x, y, z)
}
