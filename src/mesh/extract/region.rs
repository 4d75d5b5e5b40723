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
//! A cell asks for a region if the planes of its sides meet outside, in another cell, or if the crease
//! goes on from it through empty cells: a box of cells that holds both ends, up to three along each axis,
//! and the regions that the box cuts into. It comes about if
//!
//! * the patches of the box make a disc: they hang together and have a single loop as boundary, without
//!   holes or handles;
//! * the planes of all its cells meet better in the region than those of the cell did in it.
//!
//! The loop lies in the boundary of a convex box then, and what [`sharp`](super::sharp) says of the fans of
//! cells holds for that of the region. A vertex on an edge within the box is in no triangle any more, and is
//! left out.

use glam::{DVec3, Vec3};

use super::joined::Joined;
use super::samples::{Samples, cell_number, split_cell};
use super::sharp::{Segment, Special, segments};
use crate::mesh::feature::{Candidate, settle};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;
use crate::mesh::signs::BLOCK;
use crate::mesh::table::CaseTable;
use crate::run::{Cancelled, Run};

/// A cell asks for a region if its point is farther from the planes than this, in cells.
const MISFIT: f64 = 0.01;

/// The most cells along an axis of a region.
const LARGEST: u32 = 3;

/// Cells that share a fan.
pub(super) struct Region {
    /// The block of the cell that asked for it.
    pub(super) block: usize,
    pub(super) segments: Vec<Segment>,
    /// The feature point.
    pub(super) at: Vec3,
    /// The cells, with the numbers of triangles that they have in the table.
    pub(super) cells: Vec<([u32; 3], usize)>,
    /// The vertices within, ascending.
    pub(super) within: Vec<u32>,
    pub(super) span: Span,
}

/// A box of cells: from the first to the last, exclusive.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) low: [u32; 3],
    pub(super) high: [u32; 3],
}

impl Span {
    pub(super) fn single(cell: [u32; 3]) -> Span {
        let [x, y, z] = cell;
        Span { low: cell, high: [x + 1, y + 1, z + 1] }
    }

    fn of(a: [u32; 3], b: [u32; 3]) -> Span {
        let low = std::array::from_fn(|axis| a[axis].min(b[axis]));
        Span { low, high: std::array::from_fn(|axis| a[axis].max(b[axis]) + 1) }
    }

    fn union(&self, other: &Span) -> Span {
        let low = std::array::from_fn(|axis| self.low[axis].min(other.low[axis]));
        Span { low, high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])) }
    }

    /// What both hold, if there is any.
    pub(super) fn intersection(&self, other: &Span) -> Span {
        let low = std::array::from_fn(|axis| self.low[axis].max(other.low[axis]));
        Span { low, high: std::array::from_fn(|axis| self.high[axis].min(other.high[axis])) }
    }

    fn is_small(&self) -> bool {
        (0..3).all(|axis| self.high[axis] - self.low[axis] <= LARGEST)
    }

    fn cells(self) -> impl Iterator<Item = [u32; 3]> {
        let Span { low, high } = self;
        let rows = (low[2]..high[2]).flat_map(move |k| (low[1]..high[1]).map(move |j| [j, k]));
        rows.flat_map(move |[j, k]| (low[0]..high[0]).map(move |i| [i, j, k]))
    }

    /// Its corners, in cells.
    fn corners(&self) -> [DVec3; 2] {
        [self.low, self.high].map(|cell| DVec3::from_array(cell.map(f64::from)))
    }
}

/// The regions that candidates ask for, those that fit their planes worst first; in the order of the blocks.
pub(super) fn regions(
    samples: &Samples<'_>,
    special: &[Special],
    joined: &Joined,
    run: &Run,
) -> Result<Vec<Region>, Cancelled> {
    let mut asking: Vec<Wish> = Vec::new();
    for (block, list) in special.iter().enumerate() {
        run.check()?;
        for candidate in &list.candidates {
            let misfit = candidate.planes.distance(candidate.at);
            if misfit > MISFIT {
                let mut last = None;
                for reach in [1.0, 2.0] {
                    let at = candidate.unbound(reach);
                    let other = towards(candidate.cell, at.floor(), reach as i32);
                    if other == last {
                        continue;
                    }
                    last = other;
                    if let Some(other) = other {
                        asking.push(Wish { size: misfit, block, candidate, other, at, allowed: 0.5 * misfit });
                    }
                }
            } else {
                for along in candidate.crease(&list.sides).into_iter().flat_map(|d| [d, -d]) {
                    if let Some((size, other, at)) = beyond(samples, block, candidate, along) {
                        asking.push(Wish { size, block, candidate, other, at, allowed: 2.0 * MISFIT });
                    }
                }
            }
        }
    }
    asking.sort_by(|a, b| b.size.total_cmp(&a.size));
    let mut known = Known { samples, special, joined, taken: vec![Vec::new(); special.len()], regions: Vec::new() };
    // Regions that stand alone come first: they are smaller than those that others are merged into.
    for merges in [false, true] {
        asking.retain(|wish| !run.cancel.is_cancelled() && !known.grant(wish, merges));
    }
    run.check()?;
    let mut regions: Vec<Region> = known.regions.into_iter().flatten().collect();
    regions.sort_by_key(|region| region.block);
    Ok(regions)
}

/// A region that a cell asks for.
struct Wish<'a> {
    /// How far off the mesh may be without it, in cells.
    size: f64,
    /// The block of the cell.
    block: usize,
    candidate: &'a Candidate,
    /// The cell in the opposite corner of the region.
    other: [u32; 3],
    /// About where the point goes.
    at: DVec3,
    /// How far it may be from the planes.
    allowed: f64,
}

/// The cell that is some steps towards another, along every axis where they differ.
fn towards(cell: [u32; 3], target: DVec3, steps: i32) -> Option<[u32; 3]> {
    let mut other = cell;
    for axis in 0..3 {
        let by = ((target[axis] - f64::from(cell[axis])) as i32).clamp(-steps, steps);
        other[axis] = other[axis].checked_add_signed(by)?;
    }
    (other != cell).then_some(other)
}

/// Follows a crease from the point of a cell. If it goes through empty cells and then comes to
/// one that is a neighbour of the first by an edge or a corner: how long it is in them, the cell, and
/// the middle of that part.
fn beyond(samples: &Samples<'_>, block: usize, candidate: &Candidate, along: DVec3) -> Option<(f64, [u32; 3], DVec3)> {
    let (mut cell, mut at) = (candidate.cell, candidate.at);
    let mut entry: Option<DVec3> = None;
    for _ in 0..4 {
        // Where the line leaves the cell.
        let (mut axis, mut least) = (0, f64::INFINITY);
        for n in 0..3 {
            let side = f64::from(cell[n]) + f64::from(u8::from(along[n] > 0.0));
            let part = (side - at[n]) / along[n];
            if part < least {
                (axis, least) = (n, part);
            }
        }
        at += along * least;
        cell[axis] = cell[axis].checked_add_signed(if along[axis] > 0.0 { 1 } else { -1 })?;
        if (0..3).any(|n| cell[n].abs_diff(candidate.cell[n]) > 1) {
            return None;
        }
        match (entry, matches!(samples.case_near(block, cell), 0 | 255)) {
            (None, false) => return None,
            (None, true) => entry = Some(at),
            (Some(start), false) => return Some((0.5 * (at - start).length(), cell, 0.5 * (start + at))),
            (Some(_), true) => {}
        }
    }
    None
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
    fn grant(&mut self, wish: &Wish<'_>, merges: bool) -> bool {
        // One that it is in already is what it wished for, or better.
        if self.taken(wish.block, wish.candidate.cell).is_some() {
            return true;
        }
        let mut span = Span::of(wish.candidate.cell, wish.other);
        let mut merged: Vec<u32> = Vec::new();
        while let Some(region) =
            span.cells().filter_map(|cell| self.taken(wish.block, cell)).find(|region| !merged.contains(region))
        {
            if let Some(other) = &self.regions[region as usize] {
                span = span.union(&other.span);
            }
            merged.push(region);
            if !merges || !span.is_small() {
                return merges;
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
        let at = settle(&planes, wish.at, low, high, 3);
        if planes.distance(at) > wish.allowed || wish.candidate.planes.distance(at) > wish.allowed {
            return None;
        }
        let Disc { ring, within } = glued(&all)?;
        let at = self.samples.inside(at, span.low, span.high);
        Some(Region { block: wish.block, segments: ring, at, cells, within, span })
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
