//! The cells of blocks that do not have the patches of the case table: found block by block, and kept for many
//! blocks in one list each.

use std::ops::Range;

use glam::Vec3A;
use rayon::prelude::*;

use super::Sampler;
use super::bulge::{Bulge, Ring, around};
use super::join::Corners;
use super::joined::Joined;
use super::samples::{Samples, cell_number, split_cell};
use crate::mesh::feature::{Candidate, Refiner, Segment};
use crate::mesh::loops::CellLoop;
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
            let is_dropped = cells.peek() == Some(&number);
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
        lists.plain.copy_within(from..at, to);
        plain.end = to + at - from;
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
    corners: Corners,
    ring: Ring,
    /// By segment, the place of its vertex in the cell.
    places: Vec<Vec3A>,
    refiner: Refiner,
    lists: Lists,
}

impl<S: Sampler> Worker<S> {
    fn new(sampler: &S) -> Worker<S> {
        Worker {
            scratch: sampler.scratch(),
            corners: Corners::new(),
            ring: Ring::NONE,
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
        if !samples.parts.number(n, &mut worker.corners) {
            return OfBlock::default();
        }
        let Worker { scratch, corners, ring, places, refiner, .. } = worker;
        let (candidates, bulges) = (self.candidates.len(), self.bulges.len());
        let (opposite, plain) = (self.opposite.len(), self.plain.len());
        let block = samples.blocks()[n];
        let has_joined = joined.concerns(samples, n);
        let (table, loops) = (CaseTable::get(), CellLoop::table());
        for_each_cell(&samples.parts.part(n).signs, |within, case| {
            let ids = corners.of_cell(within);
            let cell = || std::array::from_fn(|axis| block[axis] + within[axis] as u32);
            let faces = if has_joined { joined.of(samples, cell(), case) } else { 0 };
            if faces != 0 {
                // The table knows nothing of joined faces.
                match CellLoop::single(case, faces) {
                    Some(outline) => {
                        ring.take(samples, outline.edges(), &ids);
                        let lists = (&mut self.segments, &mut *places);
                        self.numbers.push(cell_number(within));
                        self.candidates.push(samples.candidate(cell(), &outline, ring.vertices(), lists));
                    }
                    None => {
                        self.opposite.push(cell_number(within));
                        let corner = |edge: u8| ids[usize::from(edge & 15)];
                        let turned = table.triangles(!case).iter();
                        self.plain.extend(turned.map(|&[a, b, c]| [corner(a), corner(c), corner(b)]));
                    }
                }
                return;
            }
            if let Some(outline) = &loops[usize::from(case)] {
                ring.take(samples, outline.edges(), &ids);
                if !ring.is_flat() && self.takes(samples, cell(), outline, ring, places) {
                    return;
                }
            }
            let corner = |edge: u8| ids[usize::from(edge & 15)];
            self.plain.extend(table.triangles(case).iter().map(|&[a, b, c]| [corner(a), corner(b), corner(c)]));
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

    /// Lists a cell that is not flat, if it is not to have the triangles of the table.
    #[inline(never)]
    fn takes(
        &mut self,
        samples: &Samples<'_>,
        cell: [u32; 3],
        outline: &CellLoop,
        ring: &mut Ring,
        places: &mut Vec<Vec3A>,
    ) -> bool {
        let number = cell_number(split_cell(cell).1);
        if !ring.is_smooth() {
            let lists = (&mut self.segments, places);
            self.numbers.push(number);
            self.candidates.push(samples.candidate(cell, outline, ring.vertices(), lists));
            return true;
        }
        let Some((at, normal)) = ring.top(samples) else { return false };
        let at = samples.held(at.into(), cell, cell.map(|n| n + 1));
        let (sides, first) = (outline.len() as u16, self.plain.len() as u32);
        self.bulges.push(Bulge { cell: number, sides, first, at, normal: normal.into() });
        // Its number is not known yet.
        self.plain.extend(around(0, ring.vertices()));
        true
    }
}
