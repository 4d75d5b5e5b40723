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
use super::sharp::{Segment, Special, segments};
use super::span::Span;
use crate::mesh::feature::{Candidate, crease, settle};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;
use crate::mesh::signs::BLOCK;
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
    special: &[Special],
    joined: &Joined,
    run: &Run,
) -> Result<Vec<Region>, Cancelled> {
    let mut known = Known { samples, special, joined, taken: vec![Vec::new(); special.len()], regions: Vec::new() };
    // Boxes towards where planes meet; where that cannot be, such that are larger along some axes only.
    for is_whole in [true, false] {
        let mut wishes = Vec::new();
        for (block, list) in special.iter().enumerate() {
            run.check()?;
            for candidate in list.candidates.iter().filter(|one| known.taken(block, one.cell).is_none()) {
                Asker::candidate(block, candidate).misfits(MISFIT, is_whole, &mut wishes);
            }
        }
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
        for (block, list) in special.iter().enumerate().filter(|_| round == 0) {
            for candidate in list.candidates.iter().filter(|one| known.taken(block, one.cell).is_none()) {
                let normals = candidate.sides(&list.sides).iter().map(|side| side.normal);
                known.exits(&Asker::candidate(block, candidate), normals, &mut wishes);
            }
        }
        for (number, region) in known.regions.iter().enumerate() {
            let Some(region) = region else { continue };
            let asker = Asker::region(number, region);
            asker.misfits(2.0 * MISFIT, true, &mut wishes);
            asker.misfits(2.0 * MISFIT, false, &mut wishes);
            known.exits(&asker, region.segments.iter().map(|segment| segment.normal), &mut wishes);
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
            let parts = parts.filter(|part| is_whole || *part != span);
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
    special: &'a [Special],
    joined: &'a Joined,
    /// By block, and the numbers of cells in it, the regions that they are in; nothing for a block without any.
    taken: Vec<Vec<Option<u32>>>,
    /// All regions; `None` for those that others are merged from.
    regions: Vec<Option<Region>>,
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
        let Some(region) = self.region(wish, span) else { return merged.is_empty() };
        for old in merged {
            self.regions[old as usize] = None;
        }
        for &(cell, _) in &region.cells {
            let (block, within) = split_cell(cell);
            if let Some(block) = self.samples.find_near(wish.block, block) {
                let cells = &mut self.taken[block];
                cells.resize(BLOCK * BLOCK * BLOCK, None);
                cells[usize::from(cell_number(within))] = Some(self.regions.len() as u32);
            }
        }
        self.regions.push(Some(region));
        true
    }

    /// The boxes that hold an empty cell as well, which the crease goes on through.
    fn exits<'w>(&self, asker: &Asker<'w>, normals: impl Iterator<Item = Vec3> + Clone, wishes: &mut Vec<Wish<'w>>) {
        for along in crease(normals).into_iter().flat_map(|along| [along, -along]) {
            let Some((cell, length)) = asker.span.exit(asker.at, along) else { continue };
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
        *self.taken[block].get(usize::from(cell_number(within)))?
    }

    fn region(&self, wish: &Wish<'_>, span: Span) -> Option<Region> {
        let (mut cells, mut all, mut planes) = (Vec::new(), Vec::<Vec<Segment>>::new(), Planes::NONE);
        for cell in span.cells() {
            let case = self.samples.case_near(wish.block, cell);
            cells.push((cell, CaseTable::get().triangles(case).len()));
            if case != 0 && case != 255 {
                self.patches(wish.block, cell, case, &mut planes, &mut all)?;
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
        let Disc { ring, within } = glued(&all)?;
        let at = self.samples.inside(place, span.low, span.high);
        Some(Region { block: wish.block, segments: ring, at, place, planes, cells, within, span })
    }

    /// Adds the planes of a crossed cell, close to block `near`, and the segments of each of its loops.
    fn patches(
        &self,
        near: usize,
        cell: [u32; 3],
        case: u8,
        planes: &mut Planes,
        all: &mut Vec<Vec<Segment>>,
    ) -> Option<()> {
        let (block, _) = split_cell(cell);
        let Special { candidates, sides, .. } = &self.special[self.samples.find_near(near, block)?];
        if let Some(candidate) = candidates.iter().find(|candidate| candidate.cell == cell) {
            planes.append(&candidate.planes);
            all.push(segments(candidate, sides).collect());
            return Some(());
        }
        let mut add = |outline: CellLoop| {
            let (mut vertices, mut sides) = (Vec::with_capacity(outline.len()), Vec::with_capacity(outline.len()));
            for &edge in outline.edges() {
                vertices.push(self.samples.vertex(cell, edge)?);
            }
            let candidate = self.samples.candidate(cell, outline, &vertices, &mut sides);
            planes.append(&candidate.planes);
            all.push(segments(&candidate, &sides).collect());
            Some(())
        };
        let faces = self.joined.of(self.samples, cell, case);
        match CellLoop::single(case, faces) {
            Some(outline) => add(outline),
            None => CellLoop::all(case, faces).try_for_each(add),
        }
    }
}

/// A disc of several patches.
struct Disc {
    /// Its boundary.
    ring: Vec<Segment>,
    /// The vertices that are not on it, ascending.
    within: Vec<u32>,
}

/// Several patches, each given by the loop around it, as one, if they make a disc.
fn glued(patches: &[Vec<Segment>]) -> Option<Disc> {
    // Segments with their ends; one that two patches share is there in both directions.
    let mut all: Vec<(Segment, u32)> = Vec::with_capacity(8 * patches.len());
    for patch in patches {
        let next = patch.iter().cycle().skip(1).map(|segment| segment.from);
        all.extend(patch.iter().copied().zip(next));
    }
    let mut sides: Vec<(u32, u32)> = all.iter().map(|&(segment, to)| (segment.from, to)).collect();
    sides.sort_unstable();
    let is_outer = |(segment, to): &(Segment, u32)| sides.binary_search(&(*to, segment.from)).is_err();
    let outer: Vec<(Segment, u32)> = all.iter().copied().filter(is_outer).collect();
    let (first, _) = *outer.first()?;
    let mut ring = Vec::with_capacity(outer.len());
    let mut at = first.from;
    loop {
        let &(segment, to) = outer.iter().find(|(segment, _)| segment.from == at)?;
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
    let mut vertices: Vec<u32> = all.iter().map(|(segment, _)| segment.from).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let edges = outer.len() + (all.len() - outer.len()) / 2;
    if ring.len() != outer.len() || vertices.len() + patches.len() != edges + 1 || !hangs_together(patches) {
        return None;
    }
    vertices.retain(|vertex| ring.iter().all(|segment| segment.from != *vertex));
    Some(Disc { ring, within: vertices })
}

/// Whether one comes from every patch to every other by vertices that they share.
fn hangs_together(patches: &[Vec<Segment>]) -> bool {
    let mut left: Vec<&Vec<Segment>> = patches.iter().collect();
    let mut reached: Vec<&Vec<Segment>> = left.pop().into_iter().collect();
    while let Some(patch) = reached.pop() {
        let shares = |other: &&Vec<Segment>| patch.iter().any(|a| other.iter().any(|b| a.from == b.from));
        reached.extend(left.extract_if(.., |other| shares(&&**other)));
    }
    left.is_empty()
}
