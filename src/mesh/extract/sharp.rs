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

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Sampler;
use super::bulge::{Bulge, Ring, around, is_flat};
use super::join::Corners;
use super::joined::Joined;
use super::region::{Region, regions};
use super::samples::{Samples, cell_number, split_cell};
use super::span::Span;
use crate::mesh::feature::{Candidate, Side, refine};
use crate::mesh::loops::CellLoop;
use crate::mesh::meter::Meter;
use crate::mesh::signs::for_each_cell;
use crate::mesh::table::CaseTable;
use crate::run::{Cancelled, Run};

/// A normal that is farther from that of its triangle than 45° is of another side: the cosine.
const ASTRAY: f32 = 0.7;

/// A segment of a loop: from a vertex to that of the next segment.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub(super) from: u32,
    /// The cell that it bounds the surface of, and the face that it is in: twice the axis, and 1 more for
    /// the upper one.
    pub(super) cell: [u32; 3],
    pub(super) face: u8,
    /// Whether it may be turned: its ends have different normals.
    pub(super) turns: bool,
    /// What the edge is turned to: the fan on the other side by its number, or a point between the two by its
    /// number after those of all fans.
    pub(super) across: Option<u32>,
    /// The normal close to the feature point on the side of the vertex.
    pub(super) normal: Vec3,
}

/// The fan of a cell, or of a region of several.
pub(super) struct Fan {
    /// The place of its segments in the list of all.
    pub(super) segments: Range<u32>,
    /// The block that it is listed with.
    pub(super) block: usize,
    /// The cells that it is in.
    pub(super) span: Span,
    /// The feature point, strictly inside.
    pub(super) at: Vec3,
}

/// All fans.
#[derive(Default)]
pub(super) struct Fans {
    pub(super) fans: Vec<Fan>,
    pub(super) segments: Vec<Segment>,
    /// Points of creases between two fans.
    pub(super) points: Vec<Vec3>,
    /// Smooth cells with a vertex in their middle.
    bulges: Vec<Bulge>,
    /// The number of the first of these vertices.
    first_bulge: u32,
    blocks: Vec<OfBlock>,
    /// The vertices within regions, which no triangle has any more; ascending.
    pub(super) unused: Vec<u32>,
}

/// The fans of a block.
#[derive(Clone, Default)]
struct OfBlock {
    /// Those that are listed with it: of creases and corners.
    listed: Range<usize>,
    /// Its bulges.
    bulges: Range<usize>,
    /// The cells that have a fan, by number, and which; ascending.
    cells: Vec<(u16, u32)>,
    /// How many triangles of the table they have no more.
    dropped: usize,
    /// The cells that have the patches of the opposite case, by number; ascending.
    opposite: Vec<(u16, u8)>,
    /// The triangles of its bulges, and of the cells that have those of the table, if they are listed already.
    plain: Option<Vec<[u32; 3]>>,
}

/// Finds the cells that hold creases and corners, and gives them fans.
pub(super) fn find<S: Sampler>(samples: &Samples<'_>, sampler: &S, run: &Run) -> Result<Fans, Cancelled> {
    // Blocks that are nearly flat are settled as a whole.
    let spread = samples.spread();
    if !spread.contains(&true) {
        return Ok(Fans::default());
    }
    let blocks = || (0..spread.len()).into_par_iter();
    let proposed = (0..spread.len()).map(|n| match spread[n] {
        true => samples.parts.part(n).joins.clone(),
        false => Vec::new(),
    });
    let joined = Joined::new(samples, proposed.collect());
    let meter = Meter::new(run, spread.len());
    let of_block = |(scratch, corners, found, points): &mut (S::Scratch, Corners, Special, Vec<DVec3>), n: usize| {
        meter.step()?;
        if !spread[n] && !joined.concerns(samples, n) {
            return Ok(Special::default());
        }
        found.fill(samples, &joined, n, corners);
        refine(&mut found.candidates, &mut found.sides, samples.lattice.step(), |local, out| {
            points.clear();
            points.extend(local.iter().map(|p| samples.world(*p)));
            sampler.slopes(scratch, n, samples.blocks()[n], points, out)
        });
        Ok(found.clone())
    };
    let worker = || (sampler.scratch(), Corners::new(), Special::default(), Vec::new());
    let special: Result<Vec<Special>, Cancelled> = blocks().map_init(worker, of_block).collect();
    let special = special?;
    let regions = regions(samples, &special, &joined, run)?;
    Fans::new(samples, special, regions, run)
}

/// The cells of a block that do not have the patches of the table.
#[derive(Clone, Default)]
pub(super) struct Special {
    /// Those with a single loop, in order.
    pub(super) candidates: Vec<Candidate>,
    /// The vertices of all candidates.
    pub(super) sides: Vec<Side>,
    /// Smooth ones with a vertex in their middle, in order.
    bulges: Vec<Bulge>,
    /// Those with the patches of the opposite case, by number, and their cases.
    opposite: Vec<(u16, u8)>,
    /// The triangles of bulges and of all other cells, in their order, if the block has been looked at.
    plain: Option<Vec<[u32; 3]>>,
}

impl Special {
    /// Finds those of block `n`: where the normals spread, or faces are joined.
    fn fill(&mut self, samples: &Samples<'_>, joined: &Joined, n: usize, corners: &mut Corners) {
        self.candidates.clear();
        self.sides.clear();
        self.bulges.clear();
        self.opposite.clear();
        let mut plain = self.plain.take().unwrap_or_default();
        plain.clear();
        // What is missing in a neighbour is an error of the second pass.
        if !samples.parts.number(n, corners) {
            return;
        }
        let block = samples.blocks()[n];
        let has_joined = joined.concerns(samples, n);
        let (table, loops) = (CaseTable::get(), CellLoop::table());
        let mut ring = Ring::NONE;
        for_each_cell(&samples.parts.part(n).signs, |within, case| {
            let ids = corners.of_cell(within);
            let outline = loops[usize::from(case)].as_ref();
            let is_flat = outline.is_none_or(|outline| is_flat(samples, outline.edges(), &ids));
            if has_joined || !is_flat {
                let [i, j, k] = within;
                let cell = [block[0] + i as u32, block[1] + j as u32, block[2] + k as u32];
                let faces = if has_joined { joined.of(samples, cell, case) } else { 0 };
                if (faces != 0 || !is_flat) && self.takes(samples, cell, (case, faces), &ids, &mut ring, &mut plain) {
                    return;
                }
            }
            for triangle in table.triangles(case) {
                plain.push(triangle.map(|edge| ids[usize::from(edge & 15)]));
            }
        });
        self.plain = Some(plain);
    }

    /// Lists a cell that is not flat, or has joined faces, if it is not to have the triangles of the table. `ids` are
    /// the vertices on its edges; `plain` gets the triangles of a bulge.
    #[inline(never)]
    fn takes(
        &mut self,
        samples: &Samples<'_>,
        cell: [u32; 3],
        (case, faces): (u8, u8),
        ids: &[u32; 16],
        ring: &mut Ring,
        plain: &mut Vec<[u32; 3]>,
    ) -> bool {
        let number = cell_number(split_cell(cell).1);
        let Some(outline) = CellLoop::single(case, faces) else {
            if faces != 0 {
                self.opposite.push((number, case));
            }
            return faces != 0;
        };
        ring.take(samples, outline.edges(), ids);
        // The table knows nothing of joined faces.
        if faces != 0 || !ring.is_smooth() {
            self.candidates.push(samples.candidate(cell, outline, ring.vertices(), &mut self.sides));
            return true;
        }
        let Some((at, normal)) = ring.top(samples) else { return false };
        let at = samples.held(at.as_dvec3(), cell, cell.map(|n| n + 1));
        let (sides, first) = (outline.len() as u16, plain.len() as u32);
        self.bulges.push(Bulge { cell: number, sides, first, at, normal });
        // Its number is not known yet.
        plain.extend(around(0, ring.vertices()));
        true
    }
}

/// The segments of a cell's loop, whose vertices are in a list.
pub(super) fn segments(candidate: &Candidate, sides: &[Side]) -> impl Iterator<Item = Segment> {
    let segment = |(n, side): (usize, &Side)| Segment {
        from: side.vertex,
        cell: candidate.cell,
        face: candidate.outline.face(n),
        turns: candidate.split >> n & 1 == 1,
        across: None,
        normal: side.normal,
    };
    candidate.sides(sides).iter().enumerate().map(segment)
}

impl Fans {
    fn new(samples: &Samples<'_>, special: Vec<Special>, regions: Vec<Region>, run: &Run) -> Result<Fans, Cancelled> {
        let mut all = Fans { blocks: vec![OfBlock::default(); samples.blocks().len()], ..Fans::default() };
        all.fans.reserve(special.iter().map(|special| special.candidates.len()).sum());
        all.segments.reserve(special.iter().map(|special| special.sides.len()).sum());
        all.bulges.reserve(special.iter().map(|special| special.bulges.len()).sum());
        // The cells of regions, by the numbers of their blocks and their own.
        let mut in_region: Vec<(usize, u16)> = Vec::new();
        for &(cell, _) in regions.iter().flat_map(|region| &region.cells) {
            let (block, within) = split_cell(cell);
            in_region.extend(samples.find(block).map(|block| (block, cell_number(within))));
        }
        in_region.sort_unstable();
        let mut in_region = &in_region[..];
        // A region is listed with the block of the candidate that asked for it.
        let mut regions = regions.into_iter().peekable();
        let table = CaseTable::get();
        for (block, Special { candidates, sides, bulges, mut opposite, plain }) in special.into_iter().enumerate() {
            run.check()?;
            let (taken, rest) = in_region.split_at(in_region.partition_point(|&(other, _)| other == block));
            in_region = rest;
            let is_free = |number: u16| taken.binary_search(&(block, number)).is_err();
            opposite.retain(|&(number, _)| is_free(number));
            // Regions may hold other cells than candidates.
            let number = |candidate: &Candidate| cell_number(split_cell(candidate.cell).1);
            let is_candidate = |&(_, cell): &(usize, u16)| candidates.binary_search_by_key(&cell, number).is_ok();
            all.blocks[block].plain = plain.filter(|_| opposite.is_empty() && taken.iter().all(is_candidate));
            all.blocks[block].opposite = opposite;
            all.blocks[block].cells.reserve_exact(candidates.len() + taken.len());
            let start = all.fans.len();
            let signs = &samples.parts.part(block).signs;
            for candidate in &candidates {
                let (_, within) = split_cell(candidate.cell);
                let number = cell_number(within);
                if is_free(number) {
                    all.hold(block, number, table.triangles(signs.case(within)).len());
                    let span = Span::single(candidate.cell);
                    let at = samples.inside(candidate.at, span.low, span.high);
                    all.add(block, segments(candidate, &sides), span, at);
                }
            }
            while let Some(region) = regions.next_if(|region| region.block == block) {
                all.cover(samples, &region.cells);
                all.unused.extend(region.within);
                all.add(block, region.segments.into_iter(), region.span, region.at);
            }
            all.blocks[block].listed = start..all.fans.len();
            let start = all.bulges.len();
            all.bulges.extend(bulges.iter().filter(|bulge| is_free(bulge.cell)));
            all.blocks[block].bulges = start..all.bulges.len();
        }
        all.unused.sort_unstable();
        for block in &mut all.blocks {
            block.cells.sort_unstable();
        }
        all.turn(samples, run)?;
        Ok(all)
    }

    /// Numbers the vertices of bulges, which follow those of fans, which follow `count` others; together they
    /// are no more than indices of 32 bits.
    pub(super) fn number_bulges(&mut self, count: u32) {
        self.first_bulge = count + (self.fans.len() + self.points.len()) as u32;
        let (first, bulges) = (self.first_bulge, &self.bulges);
        self.blocks.par_iter_mut().for_each(|block| {
            let Some(plain) = &mut block.plain else { return };
            for n in block.bulges.clone() {
                let Bulge { sides, first: place, .. } = bulges[n];
                let triangles = &mut plain[place as usize..][..usize::from(sides)];
                triangles.iter_mut().for_each(|triangle| triangle[0] = first + n as u32);
            }
        });
    }

    /// Notes that the next fan takes the place of the patches of cells, each with the number of its triangles.
    fn cover(&mut self, samples: &Samples<'_>, cells: &[([u32; 3], usize)]) {
        for &(cell, count) in cells {
            let (block, within) = split_cell(cell);
            if let Some(block) = samples.find(block) {
                self.hold(block, cell_number(within), count);
            }
        }
    }

    /// Notes that the next fan takes the place of the patch of a cell, with the number of its triangles.
    fn hold(&mut self, block: usize, number: u16, count: usize) {
        self.blocks[block].cells.push((number, self.fans.len() as u32));
        self.blocks[block].dropped += count;
    }

    fn add(&mut self, block: usize, segments: impl Iterator<Item = Segment>, span: Span, at: Vec3) {
        let first = self.segments.len() as u32;
        self.segments.extend(segments);
        self.fans.push(Fan { segments: first..self.segments.len() as u32, block, span, at });
    }

    /// The segments of a fan.
    pub(super) fn of(&self, fan: usize) -> &[Segment] {
        let Range { start, end } = self.fans[fan].segments;
        &self.segments[start as usize..end as usize]
    }

    /// Whether a segment is turned to a point between the two fans.
    fn is_bent(&self, segment: &Segment) -> bool {
        segment.across.is_some_and(|other| other as usize >= self.fans.len())
    }

    /// The vertices that are added, feature points first and those of bulges last, with the normals that stand for
    /// all their sides.
    pub(super) fn vertices(&self) -> impl Iterator<Item = (Vec3, Vec3)> {
        let normal = |fan| self.of(fan).iter().map(|segment| segment.normal).sum::<Vec3>().normalize_or_zero();
        let mut between = vec![Vec3::ZERO; self.points.len()];
        for segment in self.segments.iter().filter(|segment| self.is_bent(segment)) {
            let nth = segment.across.map_or(0, |other| other as usize - self.fans.len());
            between[nth] += segment.normal;
        }
        let between = between.into_iter().map(Vec3::normalize_or_zero);
        let centres = (0..self.fans.len()).map(move |fan| (self.fans[fan].at, normal(fan)));
        let bulges = self.bulges.iter().map(|bulge| (bulge.at, bulge.normal));
        centres.chain(self.points.iter().copied().zip(between)).chain(bulges)
    }

    /// The triangles of a block's bulges, and of its cells that have those of the table, if they are listed already.
    pub(super) fn plain(&self, block: usize) -> Option<&[[u32; 3]]> {
        self.blocks.get(block)?.plain.as_deref()
    }

    /// The cells of a block that have a fan, by number, and which fan.
    pub(super) fn cells(&self, block: usize) -> &[(u16, u32)] {
        self.blocks.get(block).map_or(&[], |block| &block.cells)
    }

    /// How many triangles the fans that are listed with some blocks have.
    pub(super) fn listed(&self, blocks: Range<usize>) -> usize {
        let fans = self.blocks.get(blocks).unwrap_or_default().iter().flat_map(|block| block.listed.clone());
        fans.flat_map(|fan| self.of(fan)).map(|segment| 1 + usize::from(self.is_bent(segment))).sum()
    }

    /// The bulges of a block: the cells by number, and the vertices.
    pub(super) fn bulges(&self, block: usize) -> impl Iterator<Item = (u16, u32)> {
        let bulges = self.blocks.get(block).map_or(0..0, |block| block.bulges.clone());
        bulges.map(|n| (self.bulges[n].cell, self.first_bulge + n as u32))
    }

    /// How many triangles a block has, which has `count` without fans.
    pub(super) fn count(&self, block: usize, count: usize) -> usize {
        let Some(of_block) = self.blocks.get(block) else { return count };
        let table = CaseTable::get();
        let triangles = |case: u8| table.triangles(case).len();
        let gone: usize = of_block.opposite.iter().map(|&(_, case)| triangles(case)).sum();
        let come: usize = of_block.opposite.iter().map(|&(_, case)| triangles(!case)).sum();
        // A ring around a vertex has two triangles more than one without.
        let more = 2 * of_block.bulges.len();
        count + self.listed(block..block + 1) + more + come - of_block.dropped - gone
    }

    /// Whether all cells of a block have the triangles of the table.
    pub(super) fn is_plain(&self, block: usize) -> bool {
        self.cells(block).is_empty() && self.opposite(block).is_empty() && self.bulges(block).next().is_none()
    }

    /// The cells of a block that have the patches of the opposite case, by number.
    pub(super) fn opposite(&self, block: usize) -> &[(u16, u8)] {
        self.blocks.get(block).map_or(&[], |block| &block.opposite)
    }

    /// Lists the triangles of the fans of a block, each with the normals at its corners: at feature points that
    /// of the triangle's side, elsewhere that of the vertex, which lies on one side. Feature points are numbered from
    /// `centres`, in the order of the fans.
    pub(super) fn list(
        &self,
        block: usize,
        centres: u32,
        [positions, normals]: [&[Vec3]; 2],
        mut each: impl FnMut([u32; 3], [Vec3; 3]),
    ) {
        let fans = self.fans.len() as u32;
        let at = |vertex: u32| positions[vertex as usize];
        let own = |vertex: u32| normals[vertex as usize];
        let mut list = |triangle: [u32; 3], given: [Vec3; 3]| {
            let p = at(triangle[0]);
            let face = (at(triangle[1]) - p).cross(at(triangle[2]) - p).normalize_or_zero();
            // A vertex on the crease itself may have the normal of the other side.
            let on_side = |normal: Vec3| if normal.dot(face) > ASTRAY { normal } else { face };
            each(triangle, [on_side(given[0]), on_side(given[1]), on_side(given[2])]);
        };
        for nth in self.blocks.get(block).map_or(0..0, |block| block.listed.clone()) {
            let (segments, centre) = (self.of(nth), centres + nth as u32);
            for (n, segment) in segments.iter().enumerate() {
                let next = segments.get(n + 1).unwrap_or(&segments[0]);
                let (near, beside) = (segment.normal, next.normal);
                let (from, to) = (segment.from, next.from);
                match segment.across {
                    None => list([centre, from, to], [(near + beside).normalize_or_zero(), own(from), own(to)]),
                    Some(other) if other < fans => {
                        let end = self.of(other as usize).iter().find(|segment| segment.from == from);
                        let beyond = end.map_or(Vec3::ZERO, |segment| segment.normal);
                        list([centre, from, centres + other], [near, own(from), beyond]);
                    }
                    Some(point) => {
                        list([centre, from, centres + point], [near, own(from), near]);
                        list([centre, centres + point, to], [beside, beside, own(to)]);
                    }
                }
            }
        }
    }
}
