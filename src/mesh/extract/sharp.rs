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
//! Cells with several loops and ambiguous faces stay as the table has them.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{Lookup, Meter, Parts, Sampler, Starts};
use crate::mesh::feature::{Candidate, SMOOTH, is_smooth, refine};
use crate::mesh::lattice::Lattice;
use crate::mesh::loops::{CellLoop, LONGEST};
use crate::mesh::signs::{BLOCK, for_each_cell};
use crate::run::{Cancelled, Run};

/// A cell with a fan.
pub(super) struct Feature {
    /// The number of the cell in its block: x fastest, then y, then z.
    pub(super) cell: u16,
    pub(super) outline: &'static CellLoop,
    /// The segments that the crease crosses, as bits.
    split: u8,
    /// The feature point.
    pub(super) at: Vec3,
    /// The normals close to it on the sides of the loop's vertices.
    normals: [Vec3; LONGEST],
}

impl Feature {
    /// The normal that stands for all sides.
    pub(super) fn normal(&self) -> Vec3 {
        self.normals[..self.outline.len()].iter().sum::<Vec3>().normalize_or_zero()
    }
}

/// The number of a cell in its block.
pub(super) fn cell_number([i, j, k]: [usize; 3]) -> u16 {
    (i + BLOCK * (j + BLOCK * k)) as u16
}

/// The features of each block, in the order of their cells.
pub(super) fn find<S: Sampler>(
    parts: &Parts<'_>,
    sampler: &S,
    lattice: &Lattice,
    run: &Run,
) -> Result<Vec<Vec<Feature>>, Cancelled> {
    let meter = Meter::new(run, parts.blocks.len());
    let of_block = |scratch: &mut S::Scratch, n: usize| {
        meter.step()?;
        let place = Place { lattice, block: parts.blocks[n] };
        let mut candidates = candidates(parts, &place, n);
        if candidates.is_empty() {
            return Ok(Vec::new());
        }
        let mut points = Vec::new();
        refine(&mut candidates, lattice.step(), |local, out| {
            points.clear();
            points.extend(local.iter().map(|p| place.world(*p)));
            sampler.slopes(scratch, place.block, &points, out)
        });
        Ok(candidates.iter().map(|candidate| place.feature(candidate)).collect())
    };
    (0..parts.blocks.len()).into_par_iter().map_init(|| sampler.scratch(), of_block).collect()
}

/// The cells of block `n` with one loop, around which the normals spread.
fn candidates(parts: &Parts<'_>, place: &Place<'_>, n: usize) -> Vec<Candidate> {
    let lookup = Lookup::new(parts, n);
    let mut found = Vec::new();
    // Most blocks are settled as a whole.
    if lookup.normal_spread().length_squared() < 2.0 - 2.0 * SMOOTH {
        return found;
    }
    let mut around = Vec::with_capacity(LONGEST);
    for_each_cell(&parts.sampled[n].signs, |cell, case| {
        let Some(outline) = CellLoop::single(case) else { return };
        around.clear();
        for &edge in outline.edges() {
            let Some(vertex) = lookup.vertex(cell, edge) else { return };
            around.push(lookup.get(vertex));
        }
        if !is_smooth(&around) {
            let vertices: Vec<(DVec3, Vec3)> = around.iter().map(|&(p, n)| (place.local(p), n)).collect();
            found.push(Candidate::new(cell, outline, &vertices));
        }
    });
    found
}

/// A block of the lattice.
struct Place<'a> {
    lattice: &'a Lattice,
    block: [u32; 3],
}

impl Place<'_> {
    fn node(&self, [i, j, k]: [u32; 3]) -> DVec3 {
        let [x, y, z] = self.block;
        self.lattice.node(x + i, y + j, z + k)
    }

    /// From a position to cells from the block's first node, and back.
    fn local(&self, p: Vec3) -> DVec3 {
        (p.as_dvec3() - self.node([0; 3])) / self.lattice.step()
    }

    fn world(&self, p: DVec3) -> DVec3 {
        self.node([0; 3]) + p * self.lattice.step()
    }

    fn feature(&self, candidate: &Candidate) -> Feature {
        let cell = candidate.cell.map(|i| i as u32);
        let low = self.node(cell).as_vec3().to_array().map(f32::next_up);
        let high = self.node(cell.map(|i| i + 1)).as_vec3().to_array().map(f32::next_down);
        let at = self.world(candidate.at).as_vec3();
        Feature {
            cell: cell_number(candidate.cell),
            outline: candidate.outline,
            split: candidate.split,
            at: at.clamp(low.into(), high.into()),
            normals: std::array::from_fn(|n| candidate.normal(n)),
        }
    }
}

/// The fans of a block's cells, and those of the blocks around it.
pub(super) struct Fans<'a> {
    parts: &'a Parts<'a>,
    starts: &'a Starts,
    block: usize,
}

impl<'a> Fans<'a> {
    pub(super) fn new(parts: &'a Parts<'a>, block: usize, starts: &'a Starts) -> Fans<'a> {
        Fans { parts, starts, block }
    }

    /// The fan of a cell, if it has one.
    pub(super) fn of(&self, cell: [usize; 3]) -> Option<Fan<'_>> {
        let nth = self.index(self.block, cell)?;
        Some(Fan { fans: self, cell, feature: &self.parts.features[self.block][nth], centre: self.number(self.block, nth) })
    }

    fn index(&self, block: usize, cell: [usize; 3]) -> Option<usize> {
        self.parts.features[block].binary_search_by_key(&cell_number(cell), |feature| feature.cell).ok()
    }

    fn number(&self, block: usize, nth: usize) -> u32 {
        self.starts.features[block] + nth as u32
    }

    /// The feature point of the cell on the other side of a face, if it has one.
    fn across(&self, cell: [usize; 3], axis: usize, upper: bool) -> Option<u32> {
        let (mut block, mut cell) = (self.block, cell);
        let last = if upper { BLOCK - 1 } else { 0 };
        if cell[axis] == last {
            let mut by = [0; 3];
            by[axis] = if upper { 1 } else { -1 };
            block = self.parts.neighbours.find(self.parts.blocks[block], by)?;
            cell[axis] = BLOCK - 1 - last;
        } else if upper {
            cell[axis] += 1;
        } else {
            cell[axis] -= 1;
        }
        Some(self.number(block, self.index(block, cell)?))
    }
}

/// The fan of a cell.
pub(super) struct Fan<'a> {
    fans: &'a Fans<'a>,
    cell: [usize; 3],
    feature: &'a Feature,
    centre: u32,
}

impl Fan<'_> {
    /// Calls `put` with the triangles, one for each segment of the loop. `vertex` tells the vertex on an
    /// edge of the cell.
    pub(super) fn triangles(&self, vertex: impl Fn(u8) -> Option<u32>, mut put: impl FnMut([Option<u32>; 3])) {
        let outline = self.feature.outline;
        let edges = outline.edges();
        for n in 0..edges.len() {
            let turned = self.turned(n);
            let end = turned.or_else(|| vertex(edges[(n + 1) % edges.len()]));
            put([Some(self.centre), vertex(edges[n]), end]);
        }
    }

    /// The feature point on the other side of segment `n`, if the edge between the two fans is
    /// turned there. Both cells find the same.
    fn turned(&self, n: usize) -> Option<u32> {
        let outline = self.feature.outline;
        if self.feature.split >> n & 1 == 0 || !outline.is_alone(n) {
            return None;
        }
        let (axis, upper) = outline.face(n);
        self.fans.across(self.cell, axis, upper)
    }
}
