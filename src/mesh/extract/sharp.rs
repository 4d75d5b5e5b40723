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
//! [Regions](super::region) of several cells have fans as well, and so have smooth cells that are strongly
//! [curved](super::bulge).
//!
//! Limits: cells with several loops stay as the table has them, or as that of the opposite case
//! (see [`joined`](super::joined)). Where a crease passes an empty cell and no region comes about, it is
//! cut off by what it goes into that cell, up to half a cell or more.

use std::ops::Range;

use glam::Vec3;

use super::Sampler;
use super::joined::Joined;
use super::region::{Region, regions};
use super::samples::{Samples, cell_number, split_cell};
use super::span::Span;
use super::special::{Special, list_of};
use crate::geom::Apart;
use crate::mesh::feature::Segment;
use crate::run::{Cancelled, Run};

/// The fan of a cell, or of a region of several.
#[derive(Debug)]
pub(super) struct Fan {
    /// The list that its segments are in, and their place there.
    pub(super) list: u32,
    pub(super) segments: Range<u32>,
    /// The block that it is listed with.
    pub(super) block: u32,
    /// The cells that it is in.
    pub(super) span: Span,
    /// The feature point, strictly inside.
    pub(super) at: Vec3,
    /// The normal that stands for all its sides.
    pub(super) normal: Vec3,
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
    /// The segments of fans: those of single cells as they were found, those of regions in a last list.
    pub(super) segments: Vec<Vec<Segment>>,
    /// Points of creases between two fans, with the normals that stand for all sides.
    pub(super) points: Vec<(Vec3, Vec3)>,
    /// The cells that have a fan, by number, and which; those of a block together.
    cells: Vec<(u16, u32)>,
    /// The cells that they are in, and the smooth ones with a vertex in their middle.
    special: Special,
    /// How many vertices there are on edges.
    on_edges: u32,
    blocks: Vec<OfBlock>,
    /// The vertices within regions, which no triangle has any more: they are where the first of those that are added
    /// go. Ascending.
    free: Vec<u32>,
}

/// The fans of a block.
#[derive(Clone, Default)]
struct OfBlock {
    /// Those that are listed with it, of creases and corners, and how many triangles they have.
    listed: Listed,
    triangles: usize,
    /// Where its cells are in the list of those that have a fan.
    cells: Range<usize>,
    /// The bulges, by their numbers.
    bulges: Range<u32>,
}

/// Those of regions, and those of single cells.
type Listed = [Range<usize>; 2];

/// Finds the cells that hold creases and corners, and gives them fans.
pub(super) fn find<S: Sampler>(samples: &Samples<'_>, sampler: &S, run: &Run) -> Result<Fans, Cancelled> {
    // Blocks that are nearly flat are settled as a whole.
    let spread = samples.spread();
    if !spread.contains(&true) {
        return Ok(Fans::default());
    }
    let proposed = (0..spread.len()).map(|n| match spread[n] {
        true => samples.parts.part(n).joins.clone(),
        false => Vec::new(),
    });
    let joined = Joined::new(samples, proposed.collect());
    let special = Special::find(samples, sampler, (&spread, &joined), run)?;
    let regions = regions(samples, &special, &joined, run)?;
    Fans::new(samples, special, regions, run)
}

impl Fans {
    fn new(samples: &Samples<'_>, mut special: Special, regions: Vec<Region>, run: &Run) -> Result<Fans, Cancelled> {
        let mut all = Fans { on_edges: samples.vertices(), ..Fans::default() };
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
            let normal = region.segments.iter().map(|segment| segment.normal).sum::<Vec3>().normalize_or_zero();
            let start = in_regions.len() as u32;
            in_regions.extend(region.segments);
            let (list, segments) = (all.segments.len() as u32, start..in_regions.len() as u32);
            // A region is listed with the block of the candidate that asked for it.
            let block = region.block as u32;
            all.fans.push(Fan { list, segments, block, span: region.span, at: region.at, normal });
        }
        all.segments.push(in_regions);
        all.free.sort_unstable();
        taken.sort_unstable();
        let mut taken = &taken[..];
        let (mut listed, regions) = (0, all.fans.len());
        let mut bulges = 0;
        for block in 0..samples.blocks().len() {
            run.check()?;
            let start = listed;
            listed += all.fans[start..regions].iter().take_while(|fan| fan.block as usize == block).count();
            let of_regions = start..listed;
            let (own, rest) = taken.split_at(taken.partition_point(|&(other, ..)| other == block));
            taken = rest;
            let (first_cell, first_fan) = (all.cells.len(), all.fans.len());
            all.cells.extend(own.iter().map(|&(_, number, fan)| (number, fan)));
            for candidate in special.candidates(block) {
                let number = cell_number(split_cell(candidate.cell).1);
                if own.iter().all(|&(_, other, _)| other != number) {
                    all.cells.push((number, all.fans.len() as u32));
                    let span = Span::single(candidate.cell);
                    let at = samples.inside(candidate.at, span.low, span.high);
                    let Range { start, end } = candidate.range();
                    let (list, segments) = (list_of(block), start as u32..end as u32);
                    all.fans.push(Fan { list, segments, block: block as u32, span, at, normal: candidate.normal });
                }
            }
            if !own.is_empty() {
                special.drop_cells(block, own.iter().map(|&(_, number, _)| number));
            }
            let listed = [of_regions, first_fan..all.fans.len()];
            let triangles = listed.iter().flat_map(|fans| &all.fans[fans.clone()]).map(|fan| fan.segments.len()).sum();
            let first_bulge = bulges;
            bulges += special.bulges(block) as u32;
            let (cells, bulges) = (first_cell..all.cells.len(), first_bulge..bulges);
            all.blocks.push(OfBlock { listed, triangles, cells, bulges });
        }
        special.drop_candidates();
        all.special = special;
        all.turn(samples, run)?;
        Ok(all)
    }

    /// The number of the vertex that is added as `nth`: those of fans come first, then points of creases, then those of
    /// bulges.
    #[inline]
    fn number(&self, nth: u32) -> u32 {
        match self.free.get(nth as usize) {
            Some(&free) => free,
            None => self.on_edges + (nth - self.free.len() as u32),
        }
    }

    /// Numbers the vertices of bulges, given that all vertices together are no more than indices of 32 bits.
    pub(super) fn number_bulges(&mut self) {
        let mut special = std::mem::take(&mut self.special);
        special.number_bulges(|block| self.first_bulge(block), |nth| self.number(nth));
        self.special = special;
    }

    /// Which of the vertices that are added the first of a block's bulges is.
    fn first_bulge(&self, block: usize) -> u32 {
        (self.fans.len() + self.points.len()) as u32 + self.blocks[block].bulges.start
    }

    /// Notes that segments are turned to a point between two fans.
    pub(super) fn bend(&mut self, fans: [u32; 2], at: Vec3, normal: Vec3) {
        self.points.push((at, normal));
        for fan in fans {
            // One triangle becomes two.
            self.blocks[self.fans[fan as usize].block as usize].triangles += 1;
        }
    }

    /// The segments of a fan.
    pub(super) fn of(&self, fan: usize) -> &[Segment] {
        self.fans[fan].of(&self.segments)
    }

    /// Adds the vertices, with the normals that stand for all their sides, to all positions and normals.
    pub(super) fn add_vertices(&self, positions: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        let count = self.vertices().saturating_sub(self.free.len());
        positions.reserve_exact(count);
        normals.reserve_exact(count);
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
        self.special.all_bulges().for_each(|bulge| add(bulge.at, bulge.normal));
    }

    /// How many vertices are added.
    pub(super) fn vertices(&self) -> usize {
        let bulges = self.blocks.last().map_or(0, |block| block.bulges.end);
        self.fans.len() + self.points.len() + bulges as usize
    }

    /// The vertices within regions that no other takes the place of.
    pub(super) fn unused(&self) -> &[u32] {
        self.free.get(self.vertices()..).unwrap_or_default()
    }

    /// The triangles of a block's cells without fans, if the block has been looked at; and how many of them are
    /// [`DROPPED`](super::special::DROPPED).
    pub(super) fn plain(&self, block: usize) -> Option<(&[[u32; 3]], usize)> {
        self.special.plain(block)
    }

    /// The cells of a block that have a fan, by number, and which fan.
    pub(super) fn cells(&self, block: usize) -> &[(u16, u32)] {
        self.blocks.get(block).map_or(&[], |block| &self.cells[block.cells.clone()])
    }

    /// How many triangles the fans that are listed with a block have.
    pub(super) fn listed(&self, block: usize) -> usize {
        self.blocks.get(block).map_or(0, |block| block.triangles)
    }

    /// The triangles of the fans of a block.
    pub(super) fn list(&self, block: usize, mut each: impl FnMut([u32; 3])) {
        let fans = self.fans.len() as u32;
        for nth in
            self.blocks.get(block).map_or_else(Listed::default, |block| block.listed.clone()).into_iter().flatten()
        {
            let (segments, centre) = (self.of(nth), self.number(nth as u32));
            for (n, segment) in segments.iter().enumerate() {
                let (from, to) = (segment.from, segments.get(n + 1).unwrap_or(&segments[0]).from);
                match segment.across() {
                    None => each([centre, from, to]),
                    Some(other) if other < fans => each([centre, from, self.number(other)]),
                    Some(point) => {
                        let point = self.number(point);
                        each([centre, from, point]);
                        each([centre, point, to]);
                    }
                }
            }
        }
    }

    /// What tells the normals of the fans' triangles, given the first one of each block; nothing without fans.
    pub(super) fn into_sides(self, first: Vec<usize>) -> Option<Sides> {
        let listed = self.blocks.into_iter().map(|block| block.listed);
        let blocks: Vec<_> = listed.zip(first).filter(|(listed, _)| !listed.iter().all(Range::is_empty)).collect();
        (!blocks.is_empty()).then_some(Sides { fans: self.fans, segments: self.segments, blocks })
    }
}

/// The sides that the triangles of fans are on: what tells the normals at their corners.
#[derive(Debug)]
pub(super) struct Sides {
    fans: Vec<Fan>,
    segments: Vec<Vec<Segment>>,
    /// By block, the fans that are listed with it, and the first of their triangles.
    blocks: Vec<(Listed, usize)>,
}

impl Apart for Sides {
    /// At feature points the normal is that of the triangle's side; other vertices lie on one side. The order is that of
    /// [`Fans::list`].
    fn tell(&self, each: &mut dyn FnMut(usize, [Vec3; 3])) {
        const OWN: Vec3 = Vec3::ZERO;
        for (listed, first) in &self.blocks {
            let mut numbers = *first..;
            let mut each = |normals| numbers.next().into_iter().for_each(|triangle| each(triangle, normals));
            for fan in listed.clone().into_iter().flatten() {
                let segments = self.fans[fan].of(&self.segments);
                for (n, segment) in segments.iter().enumerate() {
                    let (near, beside) = (segment.normal, segments.get(n + 1).unwrap_or(&segments[0]).normal);
                    match segment.across().map(|other| self.fans.get(other as usize)) {
                        None => each([(near + beside).normalize_or_zero(), OWN, OWN]),
                        Some(Some(other)) => {
                            let end = other.of(&self.segments).iter().find(|other| other.from == segment.from);
                            each([near, OWN, end.map_or(OWN, |end| end.normal)]);
                        }
                        Some(None) => {
                            each([near, OWN, near]);
                            each([beside, beside, OWN]);
                        }
                    }
                }
            }
        }
    }
}
