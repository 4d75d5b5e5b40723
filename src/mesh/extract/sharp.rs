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
//! * Let A and B have the face F in common, with fans from a and b, and let s–t be the only
//!   segment in F. The union of A and B is convex, so the segment a–b crosses F in a point x
//!   of its interior. The triangles (a, s, b) and (b, t, a) that take the place of
//!   (s, t, a) and (t, s, b) are, within A, the cone from a over the path s–x–t, and within B
//!   that from b. The path is simple, as s and t lie in the boundary of F, and it meets no other
//!   segment, as F has none: so all is as before, with the path in place of the segment. Faces
//!   may be turned in any number and order, as paths of different faces do not meet.
//!
//! Everything holds for the positions as f32: a vertex has the coordinates of its lattice
//! planes rounded, rounding keeps order, and feature points are moved strictly between the rounded
//! planes.
//!
//! An ambiguous face has two segments, and x may be in the way of the other: there the edge of the
//! closer segment is turned if x is on the near side of the other one, with more than the rounding to
//! spare, and the other is not. [Regions](super::region) have fans as well; between those the line a–b
//! need not go through the face of the segment, and the edge is turned only where it does. That
//! also keeps two fans from having two edges in common.
//!
//! Limits: cells with several loops stay as the table has them, or as that of the opposite case
//! (see [`joined`](super::joined)). Where a crease passes an empty cell and no region comes about, it is
//! cut off by what it goes into that cell, up to half a cell or more.

use std::collections::HashSet;
use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::join::Corners;
use super::joined::{Joined, proposals};
use super::region::{Region, regions};
use super::samples::{Samples, cell_number, split_cell};
use super::Sampler;
use crate::mesh::feature::{Candidate, is_smooth, refine};
use crate::mesh::loops::{CellLoop, LONGEST};
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
    /// The cell that it bounds the surface of, and the face that it is in.
    pub(super) cell: [u32; 3],
    pub(super) face: (usize, bool),
    /// Whether it may be turned: its ends have different normals.
    pub(super) turns: bool,
    /// The fan on the other side, if the edge between the two is turned.
    pub(super) across: Option<u32>,
    /// The normal close to the feature point on the side of the vertex.
    pub(super) normal: Vec3,
}

/// The fan of a cell, or of a region of several.
pub(super) struct Fan {
    pub(super) segments: Vec<Segment>,
    /// The feature point, strictly inside.
    pub(super) at: Vec3,
}

impl Fan {
    /// The normal that stands for all sides.
    pub(super) fn normal(&self) -> Vec3 {
        self.segments.iter().map(|segment| segment.normal).sum::<Vec3>().normalize_or_zero()
    }
}

/// All fans.
#[derive(Default)]
pub(super) struct Fans {
    pub(super) fans: Vec<Fan>,
    blocks: Vec<OfBlock>,
}

/// The fans of a block.
#[derive(Clone, Default)]
struct OfBlock {
    /// Those that are listed with it.
    listed: Range<usize>,
    /// The cells that have a fan, by number, and which; ascending.
    cells: Vec<(u16, u32)>,
    /// How many triangles of the table they have no more.
    dropped: usize,
    /// The cells that have the patches of the opposite case, by number; ascending.
    opposite: Vec<(u16, u8)>,
}

/// Finds the cells that hold creases and corners, and gives them fans.
pub(super) fn find<S: Sampler>(samples: &Samples<'_>, sampler: &S, run: &Run) -> Result<Fans, Cancelled> {
    // Most blocks are settled as a whole.
    let spread = samples.spread();
    if !spread.contains(&true) {
        return Ok(Fans::default());
    }
    let blocks = || (0..spread.len()).into_par_iter();
    let of_block = |scratch: &mut S::Scratch, n: usize| {
        if spread[n] { proposals(samples, sampler, scratch, n) } else { Vec::new() }
    };
    let joined = Joined::new(samples, blocks().map_init(|| sampler.scratch(), of_block).collect());
    let meter = Meter::new(run, spread.len());
    let of_block = |(scratch, corners): &mut (S::Scratch, Corners), n: usize| {
        meter.step()?;
        if !spread[n] && !joined.concerns(samples, n) {
            return Ok(Special::default());
        }
        let mut special = special(samples, &joined, n, corners);
        let mut points = Vec::new();
        refine(&mut special.candidates, samples.lattice.step(), |local, out| {
            points.clear();
            points.extend(local.iter().map(|p| samples.world(*p)));
            sampler.slopes(scratch, n, samples.blocks()[n], &points, out)
        });
        Ok(special)
    };
    let special: Result<Vec<Special>, Cancelled> =
        blocks().map_init(|| (sampler.scratch(), Corners::new()), of_block).collect();
    let special = special?;
    let regions = regions(samples, &special, &joined);
    Ok(Fans::new(samples, special, regions))
}

/// The cells of a block that do not have the patches of the table.
#[derive(Default)]
pub(super) struct Special {
    /// Those with a single loop, in order.
    pub(super) candidates: Vec<Candidate>,
    /// Those with the patches of the opposite case, by number, and their cases.
    opposite: Vec<(u16, u8)>,
}

/// The cells of block `n` around which the normals spread, or faces are joined.
fn special(samples: &Samples<'_>, joined: &Joined, n: usize, corners: &mut Corners) -> Special {
    let mut found = Special::default();
    // What is missing in a neighbour is an error of the second pass.
    if !samples.parts.number(n, corners) {
        return found;
    }
    let block = samples.blocks()[n];
    let mut around = Vec::with_capacity(LONGEST);
    for_each_cell(&samples.parts.part(n).signs, |within, case| {
        let cell = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
        let faces = joined.of(samples, cell, case);
        let Some(outline) = CellLoop::single(case, faces) else {
            if faces != 0 {
                found.opposite.push((cell_number(within), case));
            }
            return;
        };
        around.clear();
        around.extend(outline.edges().iter().map(|&edge| samples.get(corners.vertex(within, edge))));
        // The table knows nothing of joined faces.
        if faces != 0 || !is_smooth(&around) {
            found.candidates.push(samples.candidate(cell, outline, &around));
        }
    });
    found
}

/// The segments of a cell's loop.
pub(super) fn segments(samples: &Samples<'_>, candidate: &Candidate) -> Option<Vec<Segment>> {
    let outline = candidate.outline;
    let segment = |(n, &edge): (usize, &u8)| {
        Some(Segment {
            from: samples.vertex(candidate.cell, edge)?,
            cell: candidate.cell,
            face: outline.face(n),
            turns: candidate.split >> n & 1 == 1,
            across: None,
            normal: candidate.normal(n),
        })
    };
    outline.edges().iter().enumerate().map(segment).collect()
}

impl Fans {
    fn new(samples: &Samples<'_>, special: Vec<Special>, regions: Vec<Region>) -> Fans {
        let mut all = Fans { fans: Vec::new(), blocks: vec![OfBlock::default(); samples.blocks().len()] };
        // A region is listed with the block of the candidate that asked for it.
        let in_region: HashSet<[u32; 3]> =
            regions.iter().flat_map(|region| region.cells.iter().map(|&(cell, _)| cell)).collect();
        let mut regions = regions.into_iter().peekable();
        let table = CaseTable::get();
        for (block, Special { candidates, opposite }) in special.into_iter().enumerate() {
            all.blocks[block].opposite = opposite;
            let start = all.fans.len();
            for candidate in candidates.iter().filter(|candidate| !in_region.contains(&candidate.cell)) {
                let Some(segments) = segments(samples, candidate) else { continue };
                let high = candidate.cell.map(|n| n + 1);
                let fan = Fan { segments, at: samples.inside(candidate.at, candidate.cell, high) };
                all.add(samples, fan, &[(candidate.cell, table.triangles(samples.case(candidate.cell)).len())]);
            }
            while let Some(region) = regions.next_if(|region| region.block == block) {
                all.add(samples, region.fan, &region.cells);
            }
            all.blocks[block].listed = start..all.fans.len();
        }
        for block in &mut all.blocks {
            block.cells.sort_unstable();
        }
        all.turn(samples);
        all
    }

    /// Adds a fan that takes the place of the patches of cells, each with the number of its triangles.
    fn add(&mut self, samples: &Samples<'_>, fan: Fan, cells: &[([u32; 3], usize)]) {
        for &(cell, count) in cells {
            let (block, within) = split_cell(cell);
            if let Some(block) = samples.find(block) {
                self.blocks[block].cells.push((cell_number(within), self.fans.len() as u32));
                self.blocks[block].dropped += count;
            }
        }
        self.fans.push(fan);
    }

    /// The cells of a block that have a fan, by number, and which fan.
    pub(super) fn cells(&self, block: usize) -> &[(u16, u32)] {
        self.blocks.get(block).map_or(&[], |block| &block.cells)
    }

    /// How many triangles a block has, which has `count` without fans.
    pub(super) fn count(&self, block: usize, count: usize) -> usize {
        let Some(of_block) = self.blocks.get(block) else { return count };
        let listed = self.fans[of_block.listed.clone()].iter().map(|fan| fan.segments.len());
        let table = CaseTable::get();
        let triangles = |case: u8| table.triangles(case).len();
        let gone: usize = of_block.opposite.iter().map(|&(_, case)| triangles(case)).sum();
        let come: usize = of_block.opposite.iter().map(|&(_, case)| triangles(!case)).sum();
        count + listed.sum::<usize>() + come - of_block.dropped - gone
    }

    /// The cells of a block that have the patches of the opposite case, by number.
    pub(super) fn opposite(&self, block: usize) -> &[(u16, u8)] {
        self.blocks.get(block).map_or(&[], |block| &block.opposite)
    }

    /// The triangles of the fans that are listed with a block; feature points are numbered from
    /// `centres`, in the order of the fans.
    pub(super) fn triangles(&self, block: usize, centres: u32) -> impl Iterator<Item = [u32; 3]> {
        let listed = self.blocks.get(block).map_or(0..0, |block| block.listed.clone());
        listed.flat_map(move |nth| {
            let segments = &self.fans[nth].segments;
            segments.iter().enumerate().map(move |(n, segment)| {
                let end = match segment.across {
                    Some(other) => centres + other,
                    None => segments[(n + 1) % segments.len()].from,
                };
                [centres + nth as u32, segment.from, end]
            })
        })
    }

    /// The normals at the corners of all triangles: at feature points that of the triangle's side,
    /// elsewhere that of the vertex, which lies on one side.
    pub(super) fn corner_normals(
        &self,
        positions: &[Vec3],
        normals: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Vec<[Vec3; 3]> {
        let centres = (positions.len() - self.fans.len()) as u32;
        let own = |vertex: u32| normals[vertex as usize];
        // The normal close to a fan's point, on the side of a vertex.
        let close = |fan: u32, vertex: u32| {
            let segments = &self.fans[fan as usize].segments;
            segments.iter().find(|segment| segment.from == vertex).map_or(Vec3::ZERO, |segment| segment.normal)
        };
        let corners = |&[a, b, c]: &[u32; 3]| {
            if a < centres {
                return [own(a), own(b), own(c)];
            }
            let [p, q, r] = [a, b, c].map(|vertex| positions[vertex as usize]);
            let face = (q - p).cross(r - p).normalize_or_zero();
            let near = close(a - centres, b);
            let given = if c >= centres {
                [near, own(b), close(c - centres, b)]
            } else {
                [(near + close(a - centres, c)).normalize_or_zero(), own(b), own(c)]
            };
            // A vertex on the crease itself may have the normal of the other side.
            given.map(|normal| if normal.dot(face) > ASTRAY { normal } else { face })
        };
        triangles.par_iter().map(corners).collect()
    }

    /// Finds out which edges between fans are turned.
    fn turn(&mut self, samples: &Samples<'_>) {
        let all = &*self;
        let across: Vec<Vec<Option<u32>>> = (0..all.fans.len())
            .into_par_iter()
            .map(|nth| all.fans[nth].segments.iter().map(|segment| all.across(samples, nth, segment)).collect())
            .collect();
        for (fan, across) in self.fans.iter_mut().zip(across) {
            for (segment, across) in fan.segments.iter_mut().zip(across) {
                segment.across = across;
            }
        }
    }

    /// The fan on the other side of a segment, if the edge between the two is turned there. Both find
    /// the same.
    fn across(&self, samples: &Samples<'_>, fan: usize, segment: &Segment) -> Option<u32> {
        if !segment.turns {
            return None;
        }
        let (axis, upper) = segment.face;
        let mut cell = segment.cell;
        cell[axis] = if upper { cell[axis] + 1 } else { cell[axis].checked_sub(1)? };
        let (block, within) = split_cell(cell);
        let cells = self.cells(samples.find(block)?);
        let other = cells.binary_search_by_key(&cell_number(within), |&(cell, _)| cell).ok()?;
        let other = cells[other].1;
        self.turns(samples, fan, other as usize, segment).then_some(other)
    }

    /// Whether the edge between two fans is turned at a segment of the first.
    fn turns(&self, samples: &Samples<'_>, fan: usize, other: usize, segment: &Segment) -> bool {
        // Both fans calculate with the same numbers in the same order.
        let (axis, upper) = segment.face;
        let (low, high) = if upper { (fan, other) } else { (other, fan) };
        let mut above = segment.cell;
        above[axis] += u32::from(upper);
        let (a, b) = (self.fans[low].at.as_dvec3(), self.fans[high].at.as_dvec3());
        let node = |[i, j, k]: [u32; 3]| samples.node([i, j, k]).as_dvec3();
        let (first, last) = (node(above), node(above.map(|n| n + 1)));
        let x = a + (b - a) * ((first[axis] - a[axis]) / (b[axis] - a[axis]));
        // More than the rounding of the line above.
        let margin = 1e-12 * first.abs().max(last.abs()).max_element();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if ![u, v].into_iter().all(|n| x[n] > first[n] + margin && x[n] < last[n] - margin) {
            return false;
        }
        let segments = &self.fans[fan].segments;
        let in_face = |n: &usize| segments[*n].cell == segment.cell && segments[*n].face == segment.face;
        let mut both = (0..segments.len()).filter(in_face);
        let (Some(p), Some(q)) = (both.next(), both.next()) else { return true };
        // Of the two segments of an ambiguous face, the one that is closer may be turned, if the other one
        // is not in the way: twice the area of the triangle of a segment and x, with the sign of the side.
        let area = |n: usize| {
            let ends = [n, (n + 1) % segments.len()].map(|n| samples.get(segments[n].from).0.as_dvec3() - x);
            ends[0][u] * ends[1][v] - ends[0][v] * ends[1][u]
        };
        let (own, foreign) = if segments[p].from == segment.from { (p, q) } else { (q, p) };
        let (size, away) = (area(own), area(foreign));
        // Both run such that what is between them is on the same hand.
        let reach = margin * (last - first).max_element() * 4.0;
        let side = {
            let ends = [foreign, (foreign + 1) % segments.len()].map(|n| samples.get(segments[n].from).0.as_dvec3());
            let s = samples.get(segment.from).0.as_dvec3();
            let (d, e) = (ends[0] - s, ends[1] - s);
            d[u] * e[v] - d[v] * e[u]
        };
        size.abs() < away.abs() && away.abs() > reach && (away > 0.0) == (side > 0.0)
    }
}
