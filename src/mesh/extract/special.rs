//! The cells of blocks that do not have the patches of the case table, found block by block and
//! kept for many blocks in one list each; and the triangles of all that need no fan, which are
//! written once, where they stay in the mesh.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use glam::Vec3A;

use super::block_vertices::Corners;
use super::cells::{CellOrder, CellSet};
use super::curvature::{Cover, Ring};
use super::joined::Joined;
use super::nearby::Nearby;
use super::plain::Plain;
use super::samples::{Samples, cell_number, cell_of};
use super::span::Span;
use super::spread::{Spread, Spreads};
use super::{ExtractError, Sampler};
use crate::Run;
use crate::mesh::feature::{Candidate, Crease, Refiner, Segment, Slope};
use crate::mesh::loops::{CellLoop, MOST};
use crate::mesh::signs::for_each_cell;
use crate::mesh::table::CaseTable;
use rvachev_num::{Meter, jobs};

/// Blocks that have their lists together.
const AT_ONCE: usize = 64;

/// The number of the list that the segments of a block are in.
pub(super) fn list_of(block: usize) -> u32 {
    (block / AT_ONCE) as u32
}

/// The special cells of all blocks, and what the others have.
#[derive(Default)]
pub(super) struct Special {
    lists: Vec<Lists>,
    /// The triangles of all cells but the candidates, in the order of the blocks.
    plain: Plain,
}

/// The special cells of consecutive blocks, each list in the order of the blocks; candidates and
/// other cells of a block are in the order that they are looked at in.
#[derive(Default)]
struct Lists {
    /// Those with a single loop whose normals spread and that are not round, or that have joined
    /// faces.
    candidates: Vec<Candidate>,
    /// By block, its candidates in the order of their numbers: each by its place among those of the
    /// block.
    order: Vec<u16>,
    /// The segments of all candidates.
    segments: Vec<Segment>,
    /// The others, by number, and how many triangles each has.
    cells: Vec<(u16, u8)>,
    blocks: Vec<OfBlock>,
}

/// Where the lists have what belongs to a block.
#[derive(Default)]
struct OfBlock {
    candidates: Range<usize>,
    /// Which cells they are: tells their places in the list of the order, from the block's first.
    order: CellOrder,
    /// None for a block that is even: all its cells have the triangles of the table.
    cells: Option<Range<usize>>,
    plain: Range<usize>,
}

/// Takes what chunks of blocks have as they come, and adds it in their order. A chunk whose turn it
/// is adds to what those before it have itself.
#[derive(Default)]
struct Queue {
    all: Special,
    /// Those that others before them are missing for.
    waiting: BTreeMap<usize, (Lists, Plain)>,
}

impl Queue {
    /// What there is so far, if it is the turn of a chunk.
    fn begin(&mut self, chunk: usize) -> Option<Plain> {
        (chunk == self.all.lists.len()).then(|| std::mem::take(&mut self.all.plain))
    }

    /// Adds what a chunk has; that is more of what there was if it began in its turn.
    fn end(&mut self, chunk: usize, lists: Lists, plain: &mut Plain, in_turn: bool) {
        if in_turn {
            self.all.plain = std::mem::take(plain);
            self.all.plain.around.clear();
            self.all.lists.push(lists);
        } else if chunk == self.all.lists.len() {
            self.append(lists, plain);
        } else {
            self.waiting.insert(chunk, (lists, std::mem::take(plain)));
        }
        while let Some((lists, mut plain)) = self.waiting.remove(&self.all.lists.len()) {
            self.append(lists, &mut plain);
        }
    }

    /// Adds what a chunk has by itself.
    fn append(&mut self, mut lists: Lists, plain: &mut Plain) {
        let all = &self.all.plain;
        // Whether there are too many is checked later.
        let before = all.tops[0].len() as u32;
        for (start, count) in plain.around.drain(..) {
            let around = &mut plain.triangles[start as usize..(start + count) as usize];
            around.iter_mut().for_each(|triangle| triangle[0] = triangle[0].wrapping_add(before));
        }
        let start = all.triangles.len();
        for block in &mut lists.blocks {
            block.plain = start + block.plain.start..start + block.plain.end;
        }
        self.all.lists.push(lists);
        let all = &mut self.all.plain;
        all.triangles.extend_from_slice(&plain.triangles);
        for (all, tops) in all.tops.iter_mut().zip(&plain.tops) {
            all.extend_from_slice(tops);
        }
    }
}

impl Special {
    /// Finds the special cells of the blocks that are not even or have joined faces, and lists the
    /// triangles of all others.
    pub(super) fn find<S: Sampler>(
        samples: &Samples<'_>,
        sampler: &S,
        (even, joined): (&[bool], &Joined),
        run: &Run,
    ) -> Result<Special, ExtractError> {
        let meter = Meter::new(run, even.len());
        let mut queue = Queue::default();
        queue.all.plain.make_room((0..even.len()).map(|n| samples.parts.part(n).triangles as usize).sum());
        let queue = Mutex::new(queue);
        let lock = || queue.lock().unwrap_or_else(PoisonError::into_inner);
        let of_chunk = |worker: &mut Worker<S>, chunk: usize, even: &[bool]| {
            let mut lists = Lists::with_room(worker.room);
            let begun = lock().begin(chunk);
            let in_turn = begun.is_some();
            let mut plain = begun.unwrap_or_else(|| std::mem::take(&mut worker.plain).cleared());
            for (n, is_even) in (chunk * AT_ONCE..).zip(even) {
                meter.step()?;
                let start = plain.triangles.len();
                let mut block = match *is_even && !joined.concerns(samples, n) {
                    true => worker.list(samples, n, &mut plain)?,
                    false => lists.add(samples, (sampler, joined), n, worker, &mut plain)?,
                };
                block.plain = start..plain.triangles.len();
                lists.blocks.push(block);
            }
            worker.room = lists.fit();
            lock().end(chunk, lists, &mut plain, in_turn);
            if !in_turn {
                worker.plain = plain;
            }
            Ok::<(), ExtractError>(())
        };
        jobs::try_chunks_with(even, AT_ONCE, || Worker::new(sampler), of_chunk)?;
        Ok(queue.into_inner().unwrap_or_else(PoisonError::into_inner).all)
    }

    /// The lists that hold what belongs to a block, and where.
    fn at(&self, block: usize) -> (&Lists, &OfBlock) {
        let lists = &self.lists[block / AT_ONCE];
        (lists, &lists.blocks[block % AT_ONCE])
    }

    /// How many candidates there are.
    pub(super) fn count(&self) -> usize {
        self.lists.iter().map(|lists| lists.candidates.len()).sum()
    }

    /// Takes the segments, in lists: see [`list_of`].
    pub(super) fn take_segments(&mut self) -> Vec<Vec<Segment>> {
        self.lists.iter_mut().map(|lists| std::mem::take(&mut lists.segments)).collect()
    }

    /// What the cells without fans have.
    pub(super) fn into_plain(self) -> Plain {
        self.plain
    }

    /// The candidates of a block.
    pub(super) fn candidates(&self, block: usize) -> &[Candidate] {
        let (lists, of_block) = self.at(block);
        &lists.candidates[of_block.candidates.clone()]
    }

    /// The candidate of a block that is a cell, given by its number.
    pub(super) fn candidate(&self, block: usize, cell: u16) -> Option<&Candidate> {
        let (lists, of_block) = self.at(block);
        let place = of_block.candidates.start + of_block.order.place(cell)?;
        Some(&lists.candidates[of_block.candidates.start + usize::from(lists.order[place])])
    }

    /// The segments of a candidate of a block.
    #[inline]
    pub(super) fn segments(&self, block: usize, candidate: &Candidate) -> &[Segment] {
        candidate.segments(&self.lists[block / AT_ONCE].segments)
    }

    /// Gives up the triangles of some cells of a block, given by their numbers: tells `holes` their
    /// places among all, and `free` the vertices that no triangle has any more.
    pub(super) fn drop_cells(
        &self,
        samples: &Samples<'_>,
        block: usize,
        cells: impl Iterator<Item = u16>,
        (holes, free): (&mut Vec<usize>, &mut Vec<u32>),
    ) {
        let dropped: CellSet = cells.collect();
        let (lists, of_block) = self.at(block);
        let mut end = of_block.plain.start;
        let mut next = |number: u16, count: usize| {
            let start = end;
            end += count;
            if dropped.has(number) {
                holes.extend(start..end);
                let first = self.plain.triangles[start..end].first().map(|triangle| triangle[0]);
                free.extend(first.filter(|&vertex| vertex >= samples.vertices()));
            }
        };
        match &of_block.cells {
            Some(cells) => lists.cells[cells.clone()].iter().for_each(|&(number, count)| next(number, count.into())),
            None => for_each_cell(&samples.parts.part(block).signs, |within, case| {
                next(cell_number(within), CaseTable::get().triangles(case).len());
            }),
        }
    }
}

/// One thread's means to look at blocks.
struct Worker<S: Sampler> {
    scratch: S::Scratch,
    nearby: Nearby,
    corners: Corners,
    /// The cells at hand with a single loop, by the length of that: their numbers and cases.
    by_length: [Vec<(u16, u8)>; MOST + 1],
    spreads: Spreads,
    refiner: Refiner,
    /// How long the last lists were.
    room: [usize; 4],
    plain: Plain,
}

impl<S: Sampler> Worker<S> {
    fn new(sampler: &S) -> Worker<S> {
        Worker {
            scratch: sampler.scratch(),
            nearby: Nearby::new(),
            corners: Corners::new(),
            by_length: Default::default(),
            spreads: Spreads::default(),
            refiner: Refiner::default(),
            room: [0; 4],
            plain: Plain::default(),
        }
    }

    /// Lists the triangles of block `n`, which is even.
    fn list(&mut self, samples: &Samples<'_>, n: usize, plain: &mut Plain) -> Result<OfBlock, ExtractError> {
        let start = plain.triangles.len();
        plain.triangles.resize(start + samples.parts.part(n).triangles as usize, [0; 3]);
        samples.parts.list_triangles(n, (&mut self.corners, &mut ()), &mut plain.triangles[start..])?;
        Ok(OfBlock::default())
    }
}

impl Lists {
    /// Empty lists with room for about as much as others have.
    fn with_room(lengths: [usize; 4]) -> Lists {
        let [candidates, order, segments, cells] = lengths.map(|length| length + length / 4);
        Lists {
            candidates: Vec::with_capacity(candidates),
            order: Vec::with_capacity(order),
            segments: Vec::with_capacity(segments),
            cells: Vec::with_capacity(cells),
            blocks: Vec::with_capacity(AT_ONCE),
        }
    }

    /// Gives back the room that is left; tells how long they are.
    fn fit(&mut self) -> [usize; 4] {
        self.candidates.shrink_to_fit();
        self.order.shrink_to_fit();
        self.segments.shrink_to_fit();
        self.cells.shrink_to_fit();
        [self.candidates.len(), self.order.len(), self.segments.len(), self.cells.len()]
    }

    /// Adds what is special in block `n`.
    fn add<S: Sampler>(
        &mut self,
        samples: &Samples<'_>,
        (sampler, joined): (&S, &Joined),
        n: usize,
        worker: &mut Worker<S>,
        plain: &mut Plain,
    ) -> Result<OfBlock, ExtractError> {
        let Worker { scratch, nearby, by_length, spreads, refiner, .. } = worker;
        nearby.load(samples, n)?;
        let (candidates, segments, cells) = (self.candidates.len(), self.segments.len(), self.cells.len());
        spreads.clear();
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
                _ => self.add_other((samples, nearby), within, (case, faces), (refiner, plain)),
            }
        });
        // Cells with loops of one length are looked at by code for that length.
        self.add_cells::<3>(samples, nearby, &by_length[3], (spreads, refiner, plain));
        self.add_cells::<4>(samples, nearby, &by_length[4], (spreads, refiner, plain));
        self.add_cells::<5>(samples, nearby, &by_length[5], (spreads, refiner, plain));
        self.add_cells::<6>(samples, nearby, &by_length[6], (spreads, refiner, plain));
        self.add_cells::<7>(samples, nearby, &by_length[7], (spreads, refiner, plain));
        let step = samples.lattice.step() as f32;
        let mut slopes = |points: &[Vec3A], out: &mut Vec<Slope>| sampler.slopes(scratch, n, block, points, out);
        spreads.look(step, &mut slopes, |Spread { number, segments, places, top }| {
            let within = cell_of([0; 3], number).map(|n| n as usize);
            let Some((at, normal)) = top else {
                return self.add_candidate(within, (segments, places), samples.crease, refiner);
            };
            let at = nearby.inside(samples, within, at - vector(within));
            plain.add_top_of(at, normal.into(), segments, samples.vertices());
            self.cells.push((number, segments.len() as u8));
        });
        let all = &mut self.candidates;
        refiner.refine(&mut self.segments[segments..], (step, samples.crease), slopes, |draft, normal, ring| {
            let within = cell_of([0; 3], draft.number).map(|n| n as usize);
            let position = nearby.inside(samples, within, draft.at);
            // Beyond a face that the surface crosses there is some of it.
            let is_shut = |along| Span::is_shut(draft.at, along, Segment::faces(ring));
            let leaves = draft.planes.crease(samples.crease.pull()).is_some_and(|along| !is_shut(along));
            all.push(draft.done([normal, position], leaves));
        });
        let order = self.note_order(candidates);
        let (candidates, cells) = (candidates..self.candidates.len(), Some(cells..self.cells.len()));
        Ok(OfBlock { candidates, order, cells, plain: 0..0 })
    }

    /// Notes the order of a block's candidates, the last ones from `first` on.
    fn note_order(&mut self, first: usize) -> CellOrder {
        let candidates = &self.candidates[first..];
        let order = CellOrder::new(candidates.iter().map(|candidate| candidate.number).collect());
        self.order.resize(first + candidates.len(), 0);
        for (n, candidate) in (0..).zip(candidates) {
            if let Some(place) = order.place(candidate.number) {
                self.order[first + place] = n;
            }
        }
        order
    }

    /// Adds what cells of a block with loops of `N` in the table are to have.
    fn add_cells<const N: usize>(
        &mut self,
        samples: &Samples<'_>,
        nearby: &Nearby,
        cells: &[(u16, u8)],
        (spreads, refiner, plain): (&mut Spreads, &mut Refiner, &mut Plain),
    ) {
        let loops = CellLoop::table();
        for &(number, case) in cells {
            let Some(outline) = &loops[usize::from(case)] else { continue };
            let Some(edges) = outline.edges().first_chunk::<N>() else { continue };
            let within = cell_of([0; 3], number).map(|n| n as usize);
            let vertices = nearby.around(within, edges);
            let ring = Ring::new(std::array::from_fn(|n| samples.normal(vertices[n]).into()), samples.crease);
            let positions = || std::array::from_fn(|n| nearby.place(samples, vertices[n]));
            let cover = if ring.is_flat() {
                Cover::Table
            } else if ring.is_smooth() {
                ring.cover(positions)
            } else {
                Cover::Open
            };
            if let Cover::Open = cover {
                let (low, positions): (_, [Vec3A; N]) = (vector(within), positions());
                let places: [_; N] = std::array::from_fn(|n| positions[n] - low);
                let mut segments: [_; N] =
                    std::array::from_fn(|n| Segment::new(vertices[n], ring.normals[n].into(), outline.face(n)));
                if ring.may_be_round() {
                    spreads.add(number, ring.middle(&positions), &segments, &places);
                } else {
                    self.add_candidate(within, (&mut segments, &places), samples.crease, refiner);
                }
                continue;
            }
            // As many as three bits tell.
            let mut corners = [0; 8];
            corners[..N].copy_from_slice(&vertices);
            let corner = |n: u8| corners[usize::from(n & 7)];
            let start = plain.triangles.len();
            match cover {
                Cover::Open => {}
                Cover::Table => {
                    plain.triangles.extend(outline.triangles::<N>().iter().map(|triangle| triangle.map(corner)));
                }
                Cover::Two(triangles) => {
                    plain.triangles.extend_from_slice(&triangles.map(|triangle| triangle.map(corner)));
                }
                Cover::Top { at, normal } => {
                    let at = nearby.inside(samples, within, at - vector(within));
                    plain.add_top(at, normal.into(), vertices, samples.vertices());
                }
            }
            self.cells.push((number, (plain.triangles.len() - start) as u8));
        }
    }

    /// Adds what a cell of a block with several loops or with joined faces is to have.
    #[cold]
    fn add_other(
        &mut self,
        (samples, nearby): (&Samples<'_>, &Nearby),
        within: [usize; 3],
        (case, faces): (u8, u8),
        (refiner, plain): (&mut Refiner, &mut Plain),
    ) {
        let all = nearby.all_around(within);
        let corner = |edge: u8| all[usize::from(edge & 15)];
        let (table, start) = (CaseTable::get(), plain.triangles.len());
        if faces == 0 {
            plain.triangles.extend(table.triangles(case).iter().map(|triangle| triangle.map(corner)));
        } else if let Some(outline) = CellLoop::single(case, faces) {
            // The table knows nothing of joined faces.
            let low = vector(within);
            let around = outline.edges().iter().map(|&edge| corner(edge));
            let places: Vec<Vec3A> = around.clone().map(|vertex| nearby.place(samples, vertex) - low).collect();
            let segment = |(n, vertex)| Segment::new(vertex, samples.normal(vertex), outline.face(n));
            let mut segments: Vec<Segment> = around.enumerate().map(segment).collect();
            return self.add_candidate(within, (&mut segments, &places), samples.crease, refiner);
        } else {
            let turned = table.triangles(!case).iter();
            plain.triangles.extend(turned.map(|&[a, b, c]| [corner(a), corner(c), corner(b)]));
        }
        self.cells.push((cell_number(within), (plain.triangles.len() - start) as u8));
    }

    /// Adds a cell with a single loop around it that is to have a fan, given with the places of its
    /// vertices from the cell's first node.
    #[inline]
    fn add_candidate(
        &mut self,
        within: [usize; 3],
        (segments, places): (&mut [Segment], &[Vec3A]),
        crease: Crease,
        refiner: &mut Refiner,
    ) {
        refiner.add((cell_number(within), vector(within)), (self.segments.len(), segments), places, crease);
        self.segments.extend_from_slice(segments);
    }
}

fn vector(cell: [usize; 3]) -> Vec3A {
    let [x, y, z] = cell.map(|n| n as i32 as f32);
    Vec3A::new(x, y, z)
}
