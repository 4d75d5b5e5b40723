//! Regions: cells that share a fan, where a crease passes a cell that has no surface of its own.
//!
//! ```text
//!     +-------+-------+        The crease leaves A, cuts the corner of C, and goes on in D. All nodes
//!     |  A  . | - . C |        of C are outside, so the mesh has nothing there: the point of E,
//!     |  .    |     . |        held in E, is too low by the depth of the cut. The four cells
//!     o-------+-------o        together are convex and have a single loop, as the edge in the
//!     |   E   |  D   .|        middle is not crossed: they can have one fan, whose point may
//!     |       |       |        be anywhere in the four, on the crease.
//!     o-------o-------+
//! ```
//!
//! A cell asks for a region if the planes of its sides meet outside: the box of cells up to there, or, if that
//! cannot be, a box that is as large along some axes only; up to three cells along each axis, and with
//! the regions that the box cuts into. Then all cells and regions ask whose crease leaves them through an empty
//! cell: that cell is to be theirs as well. A region comes about if
//!
//! * the patches of the box make a disc: they hang together and have a single loop as boundary, without
//!   holes or handles;
//! * the planes of all its cells meet better in the region than those of the cell did in it, or as well as those
//!   of a region have to.
//!
//! The loop lies in the boundary of a convex box then, and what [`sharp`](super::sharp) says of the fans of
//! cells holds for that of the region. A vertex on an edge within the box is in no triangle any more, and is
//! left out.

use glam::{DVec3, Vec3};

use super::joined::Joined;
use super::samples::{Samples, cell_number, split_cell};
use super::span::Span;
use super::special::Special;
use crate::mesh::feature::{Candidate, Segment, crease, settle};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;
use crate::mesh::table::CaseTable;
use crate::run::{Cancelled, Run};

/// A cell asks for a region if its point is farther from the planes than this, in cells.
const MISFIT: f64 = 0.01;

/// The most cells along an axis of a region.
const LARGEST: u32 = 3;

/// How often regions may grow so.
const ROUNDS: usize = 3;

/// A crease that is in an empty cell for less than this, in cells, asks for nothing.
const SHORT: f64 = 0.02;

/// Cells that share a fan.
pub(super) struct Region {
    /// The block of the cell that asked for it.
    pub(super) block: usize,
    pub(super) segments: Vec<Segment>,
    /// The feature point.
    pub(super) at: Vec3,
    /// The same in cells.
    place: DVec3,
    planes: Planes,
    /// The cells, with the numbers of triangles that they have in the table.
    pub(super) cells: Vec<([u32; 3], usize)>,
    /// The vertices within, ascending.
    pub(super) within: Vec<u32>,
    pub(super) span: Span,
}

/// The regions that candidates ask for, those that fit their planes worst first; in the order of the blocks.
pub(super) fn regions(
    samples: &Samples<'_>,
    special: &Special,
    joined: &Joined,
    run: &Run,
) -> Result<Vec<Region>, Cancelled> {
    let blocks = samples.blocks().len();
    let mut known = Known {
        samples,
        special,
        joined,
        taken: vec![Vec::new(); blocks],
        regions: Vec::new(),
        patches: Patches::default(),
    };
    let mut all: Vec<Asker<'_>> = Vec::new();
    for block in 0..blocks {
        run.check()?;
        let askers = special.candidates(block).iter().map(|candidate| Asker::candidate(block, candidate));
        all.extend(askers.filter(|asker| asker.planes.distance(asker.at) > MISFIT));
    }
    // Boxes towards where planes meet; where that cannot be, such that are larger along some axes only.
    for is_whole in [true, false] {
        let mut wishes = Vec::new();
        run.check()?;
        all.retain(|asker| known.taken(asker.block, asker.span.low).is_none());
        all.iter().for_each(|asker| asker.misfits(MISFIT, is_whole, &mut wishes));
        wishes.sort_by(|a, b| b.size.total_cmp(&a.size));
        // Regions that stand alone come first: they are smaller than those that others are merged into.
        for merges in [None, Some(LARGEST)] {
            wishes.retain(|wish| !run.cancel.is_cancelled() && !known.grant(wish, merges));
        }
    }
    // Then those that creases leave through empty cells.
    for round in 0..ROUNDS {
        run.check()?;
        let mut wishes = Vec::new();
        for block in (0..blocks).filter(|_| round == 0) {
            for candidate in special.candidates(block).iter().filter(|one| known.taken(block, one.cell).is_none()) {
                let ring = special.segments(block, candidate);
                known.exits(&Asker::candidate(block, candidate), ring, &mut wishes);
            }
        }
        for (number, region) in known.regions.iter().enumerate() {
            let Some(region) = region else { continue };
            let asker = Asker::region(number, region);
            asker.misfits(2.0 * MISFIT, true, &mut wishes);
            asker.misfits(2.0 * MISFIT, false, &mut wishes);
            known.exits(&asker, &region.segments, &mut wishes);
        }
        wishes.sort_by(|a, b| b.size.total_cmp(&a.size));
        let before = known.regions.len();
        for wish in wishes {
            known.grant(&wish, Some(LARGEST + 1));
        }
        if known.regions.len() == before {
            break;
        }
    }
    run.check()?;
    let mut regions: Vec<Region> = known.regions.into_iter().flatten().collect();
    regions.sort_by_key(|region| region.block);
    Ok(regions)
}

/// A cell, or a region by its number.
#[derive(Clone, Copy)]
enum Who<'a> {
    Cell(&'a Candidate),
    Region(usize),
}

/// A cell or a region that may want to be part of a larger one.
struct Asker<'a> {
    who: Who<'a>,
    block: usize,
    span: Span,
    /// The feature point, and what it should be on.
    at: DVec3,
    planes: Planes,
}

impl<'a> Asker<'a> {
    fn candidate(block: usize, candidate: &'a Candidate) -> Asker<'a> {
        let Candidate { cell, at, planes, .. } = *candidate;
        Asker { who: Who::Cell(candidate), block, span: Span::single(cell), at, planes }
    }

    fn region(number: usize, region: &Region) -> Asker<'a> {
        let Region { block, span, place, planes, .. } = *region;
        Asker { who: Who::Region(number), block, span, at: place, planes }
    }

    fn wish(&self, size: f64, span: Span, at: DVec3, allowed: f64) -> Wish<'a> {
        Wish { size, block: self.block, who: self.who, span, at, allowed }
    }

    /// About how far from the planes the point would be in a box.
    fn distance_in(&self, span: &Span, at: DVec3) -> f64 {
        let [low, high] = span.corners();
        self.planes.distance(settle(&self.planes, at, low, high, 1))
    }

    /// Wishes for the boxes towards where the planes meet, if that is outside: the whole ones, or those that are larger
    /// along some of the axes only.
    fn misfits(&self, most: f64, is_whole: bool, wishes: &mut Vec<Wish<'a>>) {
        let misfit = self.planes.distance(self.at);
        if misfit <= most {
            return;
        }
        let mut last = self.span;
        for reach in [1.0, 2.0] {
            let [low, high] = self.span.corners();
            let at = settle(&self.planes, self.at, low - reach, high + reach, 3);
            let span = self.span.union(&Span::single(at.max(DVec3::ZERO).to_array().map(|x| x as u32)));
            if span == last {
                continue;
            }
            last = span;
            let all = if is_whole { 7..8 } else { 1..7 };
            let parts = all.map(|axes| self.span.grown(&span, axes)).filter(|part| *part != self.span);
            let parts = parts.filter(|part| is_whole || *part != span && self.distance_in(part, at) <= 0.5 * misfit);
            wishes.extend(parts.map(|part| self.wish(misfit, part, at, 0.5 * misfit)));
        }
    }
}

/// A region that a cell, or another region, asks for.
struct Wish<'a> {
    /// How far off the mesh may be without it, in cells.
    size: f64,
    /// Who asks, and the block of it.
    who: Who<'a>,
    block: usize,
    span: Span,
    /// About where the point goes.
    at: DVec3,
    /// How far it may be from the planes.
    allowed: f64,
}

struct Known<'a> {
    samples: &'a Samples<'a>,
    special: &'a Special,
    joined: &'a Joined,
    /// By block, the cells that are in regions, by number, and in which.
    taken: Vec<Vec<(u16, u32)>>,
    /// All regions; `None` for those that others are merged from.
    regions: Vec<Option<Region>>,
    /// Memory for the patches at hand.
    patches: Patches,
}

impl Known<'_> {
    /// Makes the region that a cell wishes for, if it can be; merged with the regions in its way, or not at all
    /// where there are any. Whether there is no more to be done for the cell.
    fn grant(&mut self, wish: &Wish<'_>, merged_up_to: Option<u32>) -> bool {
        // One that it is in already is what it wished for, or better.
        if matches!(wish.who, Who::Cell(candidate) if self.taken(wish.block, candidate.cell).is_some()) {
            return true;
        }
        let mut span = wish.span;
        let mut merged: Vec<u32> = Vec::new();
        while let Some(region) =
            span.cells().filter_map(|cell| self.taken(wish.block, cell)).find(|region| !merged.contains(region))
        {
            if let Some(other) = &self.regions[region as usize] {
                span = span.union(&other.span);
            }
            merged.push(region);
            if !merged_up_to.is_some_and(|most| span.is_small(most)) {
                return merged_up_to.is_some();
            }
        }
        let mut patches = std::mem::take(&mut self.patches);
        let region = self.region(wish, span, &mut patches);
        self.patches = patches;
        let Some(region) = region else { return merged.is_empty() };
        for old in merged {
            self.regions[old as usize] = None;
        }
        for &(cell, _) in &region.cells {
            let (block, within) = split_cell(cell);
            if let Some(block) = self.samples.find_near(wish.block, block) {
                let (cells, number) = (&mut self.taken[block], cell_number(within));
                let region = self.regions.len() as u32;
                match cells.iter_mut().find(|(cell, _)| *cell == number) {
                    Some(cell) => cell.1 = region,
                    None => cells.push((number, region)),
                }
            }
        }
        self.regions.push(Some(region));
        true
    }

    /// The boxes that hold an empty cell as well, which the crease goes on through.
    fn exits<'w>(&self, asker: &Asker<'w>, ring: &[Segment], wishes: &mut Vec<Wish<'w>>) {
        let normals = ring.iter().map(|segment| segment.normal);
        // Beyond a face that the surface crosses there is some of it.
        let is_crossed =
            |face: u8| matches!(asker.who, Who::Cell(_)) && ring.iter().any(|segment| segment.face == face);
        for along in crease(normals).into_iter().flat_map(|along| [along, -along]) {
            let Some((cell, length)) = asker.span.exit(asker.at, along, is_crossed) else { continue };
            let is_empty = matches!(self.samples.case_near(asker.block, cell), 0 | 255);
            if length > SHORT && is_empty && self.taken(asker.block, cell).is_none() {
                let allowed = asker.planes.distance(asker.at).max(2.0 * MISFIT);
                wishes.push(asker.wish(0.5 * length, asker.span.union(&Span::single(cell)), asker.at, allowed));
            }
        }
    }

    /// The region that a cell, close to block `near`, is in.
    fn taken(&self, near: usize, cell: [u32; 3]) -> Option<u32> {
        let (block, within) = split_cell(cell);
        let block = self.samples.find_near(near, block)?;
        let cells = &self.taken[block];
        if cells.is_empty() {
            return None;
        }
        let number = cell_number(within);
        cells.iter().find(|(cell, _)| *cell == number).map(|&(_, region)| region)
    }

    fn region(&self, wish: &Wish<'_>, span: Span, patches: &mut Patches) -> Option<Region> {
        let (mut cells, mut planes) = (Vec::with_capacity(8), Planes::NONE);
        patches.clear();
        for cell in span.cells() {
            let case = self.samples.case_near(wish.block, cell);
            cells.push((cell, CaseTable::get().triangles(case).len()));
            if case != 0 && case != 255 {
                self.add_patches(wish.block, cell, case, &mut planes, patches)?;
            }
        }
        let [low, high] = span.corners();
        let place = settle(&planes, wish.at, low, high, 3);
        let own = match wish.who {
            Who::Cell(candidate) => &candidate.planes,
            // None if it is part of another by now.
            Who::Region(number) => &self.regions[number].as_ref()?.planes,
        };
        if planes.distance(place).max(own.distance(place)) > wish.allowed {
            return None;
        }
        let Disc { ring, within } = patches.glued()?;
        let at = self.samples.inside(place, span.low, span.high);
        Some(Region { block: wish.block, segments: ring, at, place, planes, cells, within, span })
    }

    /// Adds the planes of a crossed cell, close to block `near`, and its patches.
    fn add_patches(
        &self,
        near: usize,
        cell: [u32; 3],
        case: u8,
        planes: &mut Planes,
        patches: &mut Patches,
    ) -> Option<()> {
        let (block, within) = split_cell(cell);
        let block = self.samples.find_near(near, block)?;
        if let Some(candidate) = self.special.candidate(block, cell_number(within)) {
            planes.append(&candidate.planes);
            patches.add(self.special.segments(block, candidate));
            return Some(());
        }
        let faces = self.joined.of(self.samples, cell, case);
        let mut add = |outline: &CellLoop| {
            let vertices: Option<Vec<u32>> =
                outline.edges().iter().map(|&edge| self.samples.vertex(near, cell, edge)).collect();
            let mut own = Vec::with_capacity(outline.len());
            let lists = (&mut own, &mut Vec::with_capacity(outline.len()));
            planes.append(&self.samples.candidate(cell, outline, &vertices?, lists).planes);
            patches.add(&own);
            Some(())
        };
        match CellLoop::single(case, faces) {
            Some(outline) => add(&outline),
            None => CellLoop::all(case, faces).try_for_each(|outline| add(&outline)),
        }
    }
}

/// The patches of several cells: the segments of the loops around them, with their ends and the numbers of the patches.
#[derive(Default)]
struct Patches {
    segments: Vec<(Segment, u32, u32)>,
    count: u32,
}

/// A disc of several patches.
struct Disc {
    /// Its boundary.
    ring: Vec<Segment>,
    /// The vertices that are not on it, ascending.
    within: Vec<u32>,
}

impl Patches {
    fn clear(&mut self) {
        self.segments.clear();
        self.count = 0;
    }

    /// Adds a patch.
    fn add(&mut self, ring: &[Segment]) {
        let next = ring.iter().cycle().skip(1).map(|segment| segment.from);
        self.segments.extend(ring.iter().zip(next).map(|(segment, to)| (*segment, to, self.count)));
        self.count += 1;
    }

    /// All as one, if they make a disc.
    fn glued(&self) -> Option<Disc> {
        // A segment that two patches share is there in both directions.
        let mut sides: Vec<(u32, u32)> = self.segments.iter().map(|&(segment, to, _)| (segment.from, to)).collect();
        sides.sort_unstable();
        let is_outer = |(segment, to, _): &&(Segment, u32, u32)| sides.binary_search(&(*to, segment.from)).is_err();
        let outer: Vec<&(Segment, u32, u32)> = self.segments.iter().filter(is_outer).collect();
        let mut ring: Vec<Segment> = Vec::with_capacity(outer.len());
        let (first, ..) = *outer.first()?;
        let mut at = first.from;
        loop {
            let &&(segment, to, _) = outer.iter().find(|(segment, ..)| segment.from == at)?;
            ring.push(segment);
            at = to;
            if at == first.from {
                break;
            }
            if ring.len() > outer.len() {
                return None;
            }
        }
        // Vertices − edges + patches is 1 for a disc; edges within are listed twice.
        let mut vertices: Vec<(u32, u32)> =
            self.segments.iter().map(|&(segment, _, patch)| (segment.from, patch)).collect();
        vertices.sort_unstable();
        if ring.len() != outer.len() || !self.hangs_together(&vertices) {
            return None;
        }
        vertices.dedup_by_key(|(vertex, _)| *vertex);
        let edges = outer.len() + (self.segments.len() - outer.len()) / 2;
        if vertices.len() + self.count as usize != edges + 1 {
            return None;
        }
        let mut within: Vec<u32> = vertices.into_iter().map(|(vertex, _)| vertex).collect();
        within.retain(|vertex| ring.iter().all(|segment| segment.from != *vertex));
        Some(Disc { ring, within })
    }

    /// Whether one comes from every patch to every other by vertices that they share; given the vertices in order,
    /// each with its patches.
    fn hangs_together(&self, vertices: &[(u32, u32)]) -> bool {
        let mut reached: Vec<bool> = (0..self.count).map(|patch| patch == 0).collect();
        let mut is_new = true;
        while is_new {
            is_new = false;
            for around in vertices.chunk_by(|a, b| a.0 == b.0) {
                if around.iter().any(|&(_, patch)| reached[patch as usize]) {
                    for &(_, patch) in around {
                        is_new |= !std::mem::replace(&mut reached[patch as usize], true);
                    }
                }
            }
        }
        reached.into_iter().all(|patch| patch)
    }
}
