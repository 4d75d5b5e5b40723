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
//! A cell asks for a region if the planes of its sides meet outside, in another cell: the region is the
//! smallest box of cells that holds both. It comes about if
//!
//! * every cell of it has a single loop or none, and none is in a region yet;
//! * the loops, with the segments that two of them share removed, make a single loop that all vertices
//!   are in: the patches that are replaced make a disc, and so is the fan;
//! * the planes of all its cells meet better in the region than those of the cell did in it.
//!
//! The loop then lies in the boundary of a convex box, and what [`sharp`](super::sharp) says of the
//! fans of cells holds for that of the region; an edge between two fans is turned only where it goes through
//! the face that the segment is in, which is always so between single cells.

use std::collections::HashMap;

use glam::DVec3;

use super::joined::Joined;
use super::samples::{Samples, split_cell};
use super::sharp::{Fan, Segment, Special, segments};
use crate::mesh::feature::{Candidate, settle};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;
use crate::mesh::table::CaseTable;

/// A cell asks for a region if its point is farther from the planes than this, in cells.
const MISFIT: f64 = 0.01;

/// Cells that share a fan.
pub(super) struct Region {
    /// The block of the cell that asked for it.
    pub(super) block: usize,
    pub(super) fan: Fan,
    /// The cells, with the numbers of triangles that they have in the table.
    pub(super) cells: Vec<([u32; 3], usize)>,
}

/// The regions that candidates ask for, those that fit their planes worst first; in the order of the blocks.
pub(super) fn regions(samples: &Samples<'_>, special: &[Special], joined: &Joined) -> Vec<Region> {
    let mut asking: Vec<Wish> = Vec::new();
    for (block, list) in special.iter().enumerate() {
        for candidate in &list.candidates {
            let misfit = candidate.planes.distance(candidate.at);
            if misfit > MISFIT {
                let at = candidate.unbound();
                let target = at.floor();
                if let Some(other) = towards(candidate.cell, target) {
                    asking.push(Wish { size: misfit, block, candidate, other, at, allowed: 0.5 * misfit });
                }
            } else {
                for along in candidate.crease().into_iter().flat_map(|d| [d, -d]) {
                    if let Some((size, other, at)) = beyond(samples, candidate, along) {
                        asking.push(Wish { size, block, candidate, other, at, allowed: 2.0 * MISFIT });
                    }
                }
            }
        }
    }
    asking.sort_by(|a, b| b.size.total_cmp(&a.size));
    let mut known = Known { samples, special, joined, taken: HashMap::new() };
    let mut regions: Vec<Region> = asking.iter().filter_map(|wish| known.region(wish)).collect();
    regions.sort_by_key(|region| region.block);
    regions
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

/// The cell that is a step towards another, along every axis where they differ.
fn towards(cell: [u32; 3], target: DVec3) -> Option<[u32; 3]> {
    let mut other = cell;
    for axis in 0..3 {
        let by = (target[axis] - f64::from(cell[axis])).clamp(-1.0, 1.0) as i32;
        other[axis] = other[axis].checked_add_signed(by)?;
    }
    (other != cell).then_some(other)
}

/// Follows a crease from the point of a cell. If it goes through empty cells and then comes to
/// one that is a neighbour of the first by an edge or a corner: how long it is in them, the cell, and
/// the middle of that part.
fn beyond(samples: &Samples<'_>, candidate: &Candidate, along: DVec3) -> Option<(f64, [u32; 3], DVec3)> {
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
        match (entry, matches!(samples.case(cell), 0 | 255)) {
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
    /// The cells that are in a region.
    taken: HashMap<[u32; 3], ()>,
}

impl Known<'_> {
    fn region(&mut self, wish: &Wish<'_>) -> Option<Region> {
        let &Wish { block, candidate: asking, other, .. } = wish;
        let low: [u32; 3] = std::array::from_fn(|axis| asking.cell[axis].min(other[axis]));
        let high: [u32; 3] = std::array::from_fn(|axis| asking.cell[axis].max(other[axis]) + 1);

        let (mut cells, mut all, mut planes, mut patches) = (Vec::new(), Vec::new(), Planes::NONE, 0);
        for k in low[2]..high[2] {
            for j in low[1]..high[1] {
                for i in low[0]..high[0] {
                    let cell = [i, j, k];
                    if self.taken.contains_key(&cell) {
                        return None;
                    }
                    let case = self.samples.case(cell);
                    if case == 0 || case == 255 {
                        cells.push((cell, 0));
                        continue;
                    }
                    let candidate = self.candidate(cell, case)?;
                    planes.append(&candidate.planes);
                    cells.push((cell, CaseTable::get().triangles(case).len()));
                    all.extend(segments(self.samples, &candidate)?);
                    patches += 1;
                }
            }
        }
        let segments = glued(all, patches)?;
        let corner = |cell: [u32; 3]| DVec3::from_array(cell.map(f64::from));
        let at = settle(&planes, wish.at, corner(low), corner(high), 3);
        if planes.distance(at) > wish.allowed || asking.planes.distance(at) > wish.allowed {
            return None;
        }
        self.taken.extend(cells.iter().map(|&(cell, _)| (cell, ())));
        Some(Region { block, fan: Fan { segments, at: self.samples.inside(at, low, high) }, cells })
    }

    /// A crossed cell with a single loop.
    fn candidate(&self, cell: [u32; 3], case: u8) -> Option<Candidate> {
        let (block, _) = split_cell(cell);
        let block = self.samples.find(block)?;
        if let Some(candidate) = self.special[block].candidates.iter().find(|candidate| candidate.cell == cell) {
            return Some(candidate.clone());
        }
        let outline = CellLoop::single(case, self.joined.of(self.samples, cell, case))?;
        let vertex = |&edge: &u8| Some(self.samples.get(self.samples.vertex(cell, edge)?));
        let vertices: Option<Vec<_>> = outline.edges().iter().map(vertex).collect();
        Some(self.samples.candidate(cell, outline, &vertices?))
    }
}

/// The loop around several patches, if they hang together such that they make a disc that all their
/// vertices are on the boundary of.
fn glued(all: Vec<Segment>, patches: usize) -> Option<Vec<Segment>> {
    // The segments in the order of the cells, each with its end.
    let mut ends: Vec<u32> = Vec::with_capacity(all.len());
    let mut start = 0;
    for (n, segment) in all.iter().enumerate() {
        let last = all.get(n + 1).is_none_or(|next| next.cell != segment.cell);
        ends.push(if last { all[start].from } else { all[n + 1].from });
        if last {
            start = n + 1;
        }
    }
    let sides: Vec<(u32, u32)> = all.iter().map(|segment| segment.from).zip(ends).collect();
    let outer: Vec<usize> = (0..all.len()).filter(|&n| !sides.contains(&(sides[n].1, sides[n].0))).collect();
    // Shared segments count twice; patches in a tree share one fewer than they are.
    if all.len() - outer.len() != 2 * (patches - 1) {
        return None;
    }
    let first = *outer.first()?;
    let mut ring = vec![all[first]];
    let mut at = sides[first].1;
    while at != sides[first].0 {
        let next = *outer.iter().find(|&&n| sides[n].0 == at)?;
        ring.push(all[next]);
        at = sides[next].1;
        if ring.len() > outer.len() {
            return None;
        }
    }
    let is_in_ring = |vertex: u32| ring.iter().any(|segment| segment.from == vertex);
    (ring.len() == outer.len() && all.iter().all(|segment| is_in_ring(segment.from))).then_some(ring)
}
