//! Sharp features: fans in place of the table's triangles, and edges along creases.
//!
//! ```text
//!       +-------------+          +------+------+        s--- the face between A and B
//!       |    _s_      |          |      s      |
//!       |  _/   \_    |          |    _/|\_    |         The segment s–t of the face is an edge
//!       | s---p---s   |          |  _/  |  \_  |         of the two fans. If the crease crosses
//!       |  \_   _/    |          | p----|----p |         it (normals at s and t differ), the
//!       |    \s/      |          |A \_  |  _/ B|         edge is turned: from p to p instead.
//!       +-------------+          |    \_|_/    |
//!        a cell's fan            |      t      |
//!                                +------+------+
//! ```
//!
//! A cell whose surface has a single loop on the cell's faces may have a fan from that loop to
//! a point inside instead of the table's triangles. What is shown here keeps the mesh free of
//! self-intersection, whatever the point:
//!
//! * Segments from an interior point of a convex cell to different points of its boundary have
//!   only that point in common, so the cone over a simple closed curve on the boundary is
//!   embedded, and it meets the boundary in the curve alone. The loop is such a curve: its
//!   segments lie in faces, and two in one face do not cross.
//! * An edge between two fans may be turned: see [`turn`](super::turn).
//!
//! Everything holds for the positions as f32: a vertex has the coordinates of its lattice
//! planes rounded, rounding keeps order, and feature points are moved strictly between the rounded
//! planes.
//!
//! [Regions](super::region) of several cells have fans as well, and so have [halves](super::halves)
//! of cells that two creases pass, and smooth cells that are strongly [curved](super::curvature),
//! even if their normals differ as those of a crease do ([`spread`](super::spread)).
//!
//! Limits: cells with several loops stay as the table has them, or as that of the opposite case
//! (see [`joined`](super::joined)). Where a crease passes an empty cell and no region comes about,
//! it is cut off by what it goes into that cell, up to half a cell or more.

use std::ops::Range;

use glam::Vec3;

use super::cells::{CellOrder, CellSet};
use super::corners::Vertices;
use super::crease::Creases;
use super::halves::Half;
use super::joined::Joined;
use super::lists::{fill, filled_numbers, split};
use super::plain::Plain;
use super::region::{RESIDUAL, Region, regions};
use super::samples::{Samples, cell_number, cell_of, split_cell};
use super::span::Span;
use super::special::{Special, list_of};
use super::trend::even_blocks;
use super::{ExtractError, Sampler};
use crate::mesh::bulk::Bulk;
use crate::mesh::feature::{Candidate, Segment};
use crate::mesh::signs::BLOCK;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// Fans that a thread looks at before it asks whether to go on.
pub(super) const AT_ONCE: usize = 512;

/// The fan of a cell, or of a region of several.
#[derive(Debug)]
pub(super) struct Fan {
    /// The list that its segments are in, and their place there.
    pub(super) list: u32,
    pub(super) segments: Range<u32>,
    /// The block of its cell, or of the one that asked for the region.
    pub(super) block: u32,
    /// The cells that it is in.
    pub(super) span: Span,
    /// The feature point, strictly inside.
    pub(super) at: Vec3,
    /// The normal that stands for all its sides.
    pub(super) normal: Vec3,
    /// Whether the point does not fit the planes of its sides.
    pub(super) is_loose: bool,
    /// Which half of its cell it is in, if that is cut.
    pub(super) half: Option<Box<Half>>,
}

impl Fan {
    /// Its segments, of those of all fans.
    fn of<'a>(&self, segments: &'a [Vec<Segment>]) -> &'a [Segment] {
        &segments[self.list as usize][self.segments.start as usize..self.segments.end as usize]
    }
}

/// All fans.
#[derive(Default)]
pub(super) struct Fans {
    /// Those of regions first, then those of single cells, each in the order of the blocks.
    pub(super) fans: Vec<Fan>,
    /// The segments of fans: those of single cells as they were found, those of regions in a last
    /// list.
    pub(super) segments: Vec<Vec<Segment>>,
    /// Vertices of loops in faces, with their normals, and the number of the first.
    pub(super) thirds: Vec<(Vec3, Vec3)>,
    pub(super) first_third: u32,
    /// Points of creases between two fans, with the normals that stand for all sides.
    pub(super) points: Vec<(Vec3, Vec3)>,
    /// The fans of cells, block by block in the order of the cells; and where those of each block
    /// start, and their order.
    cells: Vec<u32>,
    blocks: Vec<(usize, CellOrder)>,
    /// How many triangles consecutive fans have, [`AT_ONCE`] together.
    counts: Vec<usize>,
    /// What cells without fans have.
    plain: Plain,
    /// The triangles of these that are gone, ascending: where the last of those of fans go.
    holes: Vec<usize>,
    /// Those of them that no triangle has any more: where the first of those that are added go.
    /// Ascending.
    free: Vec<u32>,
}

/// All triangles, and the normals at their corners if there are fans.
type Listed = (Bulk<[u32; 3]>, Vec<(u32, [Vec3; 3])>);

/// What a mesh with sharp features is made of.
pub(super) enum Found {
    /// The triangles of the case table: there are no creases.
    Table(Bulk<[u32; 3]>),
    Fans(Box<Fans>),
}

/// Finds the cells that hold creases and corners, and gives them fans.
pub(super) fn find<S: Sampler>(samples: &Samples<'_>, sampler: &S, run: &Run) -> Result<Found, ExtractError> {
    // Most creases are found soon.
    if let Some(triangles) = samples.parts.triangles_unless(|| Creases::new(samples), run)? {
        return Ok(Found::Table(triangles));
    }
    // How long each stage takes, more or less.
    let [to_look, to_find, to_merge, to_fan, to_verify] = run.stages([1.5, 6.0, 1.7, 0.6, 1.0]);
    // Blocks whose normals change evenly are settled as a whole.
    let even = even_blocks(samples, &to_look)?;
    let proposed = (0..even.len()).map(|n| match even[n] {
        true => Vec::new(),
        false => joins(samples, n),
    });
    let joined = Joined::new(samples, proposed.collect());
    let special = Special::find(samples, sampler, (&even, &joined), &to_find)?;
    let regions = regions(samples, &special, &joined, &to_merge)?;
    let mut fans = Fans::new(samples, special, regions, &to_fan)?;
    fans.verify(samples, sampler, &to_verify)?;
    fans.count_triangles();
    fans.turn((samples, sampler), &to_verify)?;
    Ok(Found::Fans(Box::new(fans)))
}

/// The upper ambiguous faces of a block's cells that would rather be joined, but those of plain
/// blocks.
fn joins(samples: &Samples<'_>, n: usize) -> Vec<(u16, u8)> {
    let mut joins = samples.parts.part(n).joins.clone();
    for axis in 0..3 {
        let mut beyond = samples.blocks()[n];
        beyond[axis] += BLOCK as u32;
        if !joins.is_empty() && samples.is_plain(beyond) {
            let is_last = |number: u16| usize::from(number) / BLOCK.pow(axis as u32) % BLOCK == BLOCK - 1;
            joins.iter_mut().filter(|(number, _)| is_last(*number)).for_each(|(_, faces)| *faces &= !(1 << axis));
        }
    }
    joins
}

impl Fans {
    fn new(samples: &Samples<'_>, mut special: Special, regions: Vec<Region>, run: &Run) -> Result<Fans, Cancelled> {
        let mut all = Fans::default();
        all.blocks.reserve_exact(samples.blocks().len());
        all.fans.reserve_exact(regions.len() + special.count());
        all.segments = special.take_segments();
        let mut in_regions: Vec<Segment> = Vec::new();
        // The cells of regions, by the numbers of their blocks and their own; and which regions.
        let mut taken: Vec<(usize, u16, u32)> = Vec::new();
        for (number, region) in (0..).zip(regions) {
            for cell in region.span.cells() {
                let (block, within) = split_cell(cell);
                taken.extend(samples.find_near(region.block, block).map(|n| (n, cell_number(within), number)));
            }
            all.free.extend(region.within);
            let mut normals = region.segments.iter().map(|segment| segment.normal);
            let first = normals.next().unwrap_or_default();
            let normal = normals.fold(first, |sum, normal| sum + normal).normalize_or(first);
            let start = in_regions.len() as u32;
            in_regions.extend(region.segments);
            let (list, segments) = (all.segments.len() as u32, start..in_regions.len() as u32);
            let block = region.block as u32;
            let (span, at) = (region.span, region.at);
            all.fans.push(Fan { list, segments, block, span, at, normal, is_loose: false, half: None });
        }
        all.segments.push(in_regions);
        taken.sort_unstable();
        let mut taken = &taken[..];
        let meter = Meter::new(run, samples.blocks().len());
        let mut numbers = Vec::new();
        for block in 0..samples.blocks().len() {
            meter.step()?;
            let (own, rest) = taken.split_at(taken.partition_point(|&(other, ..)| other == block));
            taken = rest;
            let mut cells: CellSet = own.iter().map(|&(_, number, _)| number).collect();
            let free = |candidate: &&Candidate| !cells.has(candidate.number);
            let alone = all.fans.len();
            for candidate in special.candidates(block).iter().filter(free) {
                numbers.push(candidate.number);
                let span = Span::single(cell_of(samples.blocks()[block], candidate.number));
                let Range { start, end } = candidate.range();
                let (list, segments) = (list_of(block), start as u32..end as u32);
                let (at, normal) = (candidate.position, candidate.normal);
                let (block, is_loose) = (block as u32, candidate.residual > samples.crease.part * RESIDUAL);
                all.fans.push(Fan { list, segments, block, span, at, normal, is_loose, half: None });
            }
            numbers.iter().for_each(|&number| cells.insert(number));
            let (start, order) = (all.cells.len(), CellOrder::new(cells));
            all.cells.resize(start + own.len() + numbers.len(), 0);
            let single = numbers.drain(..).zip(alone as u32..);
            for (number, fan) in own.iter().map(|&(_, number, fan)| (number, fan)).chain(single) {
                if let Some(place) = order.place(number) {
                    all.cells[start + place] = fan;
                }
            }
            all.blocks.push((start, order));
            if !own.is_empty() {
                let numbers = own.iter().map(|&(_, number, _)| number);
                special.drop_cells(samples, block, numbers, (&mut all.holes, &mut all.free));
            }
        }
        all.free.sort_unstable();
        all.plain = special.into_plain();
        all.first_third = samples.vertices().wrapping_add(all.plain.tops[0].len() as u32);
        Ok(all)
    }

    /// Where a vertex of a loop is.
    #[inline]
    pub(super) fn position(&self, samples: &Samples<'_>, vertex: u32) -> Vec3 {
        match vertex.checked_sub(self.first_third) {
            Some(third) => self.thirds[third as usize].0,
            None => samples.position(vertex),
        }
    }

    /// Counts the triangles, when all loops are known.
    fn count_triangles(&mut self) {
        let triangles = |fans: &[Fan]| fans.iter().map(|fan| fan.segments.len()).sum();
        self.counts = self.fans.chunks(AT_ONCE).map(triangles).collect();
    }

    /// The number of the vertex that is added as `nth`: those of fans come first, then points of
    /// creases.
    #[inline]
    fn number(&self, nth: u32) -> u32 {
        match self.free.get(nth as usize) {
            Some(&free) => free,
            None => self.first_third + self.thirds.len() as u32 + (nth - self.free.len() as u32),
        }
    }

    /// Notes that segments are turned to a point between two fans.
    pub(super) fn bend(&mut self, fans: [u32; 2], at: Vec3, normal: Vec3) {
        self.points.push((at, normal));
        for fan in fans {
            // One triangle becomes two.
            self.counts[fan as usize / AT_ONCE] += 1;
        }
    }

    /// The segments of a fan.
    pub(super) fn of(&self, fan: usize) -> &[Segment] {
        self.fans[fan].of(&self.segments)
    }

    /// How many vertices are added to those on edges, at most.
    pub(super) fn count(&self) -> usize {
        self.plain.tops[0].len() + self.thirds.len() + self.fans.len() + self.points.len()
    }

    /// The vertices that are in no triangle, ascending.
    pub(super) fn unused(&self) -> &[u32] {
        self.free.get(self.fans.len() + self.points.len()..).unwrap_or_default()
    }

    /// Adds the vertices, with the normals that stand for all their sides, to those on edges.
    pub(super) fn add_vertices(&self, positions: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        let added = self.count().saturating_sub(self.free.len());
        positions.reserve_exact(added);
        normals.reserve_exact(added);
        positions.extend_from_slice(&self.plain.tops[0]);
        normals.extend_from_slice(&self.plain.tops[1]);
        positions.extend(self.thirds.iter().map(|third| third.0));
        normals.extend(self.thirds.iter().map(|third| third.1));
        let mut free = self.free.iter();
        let mut add = |at: Vec3, normal: Vec3| match free.next() {
            Some(&free) => (positions[free as usize], normals[free as usize]) = (at, normal),
            None => {
                positions.push(at);
                normals.push(normal);
            }
        };
        self.fans.iter().for_each(|fan| add(fan.at, fan.normal));
        self.points.iter().for_each(|&(at, normal)| add(at, normal));
    }

    /// All triangles, and the normals at the corners of those of fans, by the triangle's number;
    /// given the vertices.
    pub(super) fn triangles(mut self, vertices: Vertices<'_>, run: &Run) -> Result<Listed, Cancelled> {
        let mut triangles = std::mem::take(&mut self.plain.triangles);
        let (start, count) = (triangles.len(), self.counts.iter().sum::<usize>());
        triangles.reserve_exact(count);
        triangles.resize(start + count, [0; 3]);
        let numbers = filled_numbers(start, count, &self.holes);
        let mut corners: Vec<(u32, [Vec3; 3])> = numbers.map(|number| (number, [Vec3::ZERO; 3])).collect();
        let pieces = split(&mut triangles[start..], self.counts.iter().copied());
        let corner_pieces = split(&mut corners, self.counts.iter().copied());
        let meter = Meter::new(run, self.counts.len());
        let pieces = pieces.into_iter().zip(corner_pieces).enumerate().collect();
        jobs::try_taking(pieces, |(chunk, (piece, corners)): (usize, (&mut [_], &mut [_]))| {
            meter.step()?;
            let mut slots = piece.iter_mut().zip(corners);
            for fan in (chunk * AT_ONCE..self.fans.len()).take(AT_ONCE) {
                self.list(fan, |triangle, normals| {
                    if let Some((slot, corners)) = slots.next() {
                        *slot = triangle;
                        corners.1 = vertices.straightened(triangle, normals);
                    }
                });
            }
            Ok(())
        })?;
        fill(&mut triangles, start, &self.holes);
        Ok((triangles, corners))
    }

    /// The triangles of a fan, with the normals of their sides at their corners: at feature points
    /// the normal is that of the triangle's side. It is 0 at corners on one side, which have that
    /// of their vertex.
    fn list(&self, nth: usize, mut each: impl FnMut([u32; 3], [Vec3; 3])) {
        const OWN: Vec3 = Vec3::ZERO;
        let (segments, centre) = (self.of(nth), self.number(nth as u32));
        let first = &segments[0];
        let (mut to, mut beside) = (first.from, first.normal);
        for segment in segments.iter().rev() {
            let (from, near) = (segment.from, segment.normal);
            match segment.across().map(|other| (other, self.fans.get(other as usize))) {
                None => each([centre, from, to], [(near + beside).normalize_or(near), OWN, OWN]),
                Some((other, Some(fan))) => {
                    let end = fan.of(&self.segments).iter().find(|other| other.from == from);
                    each([centre, from, self.number(other)], [near, OWN, end.map_or(OWN, |end| end.normal)]);
                }
                Some((point, None)) => {
                    let point = self.number(point);
                    each([centre, from, point], [near, OWN, near]);
                    each([centre, point, to], [beside, beside, OWN]);
                }
            }
            (to, beside) = (from, near);
        }
    }

    /// The fan of a cell of a block, by its number, if it has one.
    #[inline]
    pub(super) fn of_cell(&self, block: usize, number: u16) -> Option<u32> {
        let (start, order) = &self.blocks[block];
        Some(self.cells[start + order.place(number)?])
    }
}
