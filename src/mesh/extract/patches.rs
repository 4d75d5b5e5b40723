//! Patches of several cells, glued to one.

use std::ops::Range;

use glam::Vec3A;

use super::samples::Samples;
use super::span::{Span, offset};
use crate::mesh::feature::{Segment, tangents};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;

/// The weight of a cell's planes is 1 over the square of its distance, in cells, and this.
const NEAR: f32 = 0.1;

/// The patches of several cells of a box, which meet in the faces between these.
#[derive(Default)]
pub(super) struct Patches<'a> {
    all: Vec<Patch<'a>>,
    /// The segments of those that are not known yet.
    own: Vec<Segment>,
    /// Memory for where the vertices of one are in its cell.
    places: Vec<Vec3A>,
    /// And for [`glued`](Patches::glued): the segments in the sides of the box, with their ends; the vertices within, each
    /// four times; and what tells whether all hangs together.
    outer: Vec<(Segment, u32)>,
    within: Vec<u32>,
    vertices: Vec<(u32, u32)>,
    reached: Vec<bool>,
}

/// The patch of a loop of a cell.
struct Patch<'a> {
    cell: [u32; 3],
    planes: Planes,
    ring: Ring<'a>,
}

/// The segments of a loop.
enum Ring<'a> {
    Known(&'a [Segment]),
    /// Where they are among the patches' own.
    Own(Range<usize>),
}

/// A disc of several patches.
pub(super) struct Disc {
    /// Its boundary.
    pub(super) ring: Vec<Segment>,
    /// The vertices that are not on it, ascending.
    pub(super) within: Vec<u32>,
}

impl<'a> Patches<'a> {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.own.clear();
    }

    /// Adds a patch of a cell whose segments and planes are known.
    pub(super) fn add(&mut self, cell: [u32; 3], ring: &'a [Segment], planes: Planes) {
        self.all.push(Patch { cell, planes, ring: Ring::Known(ring) });
    }

    /// Adds the patch of a loop of a cell, given the vertices on it.
    pub(super) fn add_loop(&mut self, samples: &Samples<'_>, cell: [u32; 3], outline: &CellLoop, vertices: &[u32]) {
        let start = self.own.len();
        self.places.clear();
        let (low, share) = (samples.node(cell), 1.0 / samples.lattice.step() as f32);
        for (n, &from) in vertices.iter().enumerate() {
            let (position, normal) = samples.get(from);
            self.own.push(Segment::new(from, normal, outline.face(n)));
            self.places.push(share * Vec3A::from(position - low));
        }
        let (planes, _) = tangents(&mut self.own[start..], &self.places);
        self.all.push(Patch { cell, planes, ring: Ring::Own(start..self.own.len()) });
    }

    /// All planes, from the first node of cell `low`; those of cells close to a point tell the most.
    pub(super) fn planes(&self, low: [u32; 3], point: Vec3A) -> Planes {
        let mut all = Planes::NONE;
        for Patch { cell, planes, .. } in &self.all {
            let shift = offset(*cell, low);
            all.append(planes, shift, (NEAR + (shift + 0.5 - point).length_squared()).recip());
        }
        all
    }

    /// All as one, if they make a disc, given the box that they are in.
    ///
    /// A segment in a face between two cells of the box is that of both, one in a side of the box that of one. A vertex
    /// is where a loop goes from a face to the next: it is within the box if neither face is in a side; all four cells
    /// around its edge are in the box then, and each has it once.
    pub(super) fn glued(&mut self, span: &Span) -> Option<Disc> {
        let Patches { all, own, outer, within, vertices, reached, .. } = self;
        let segments = |patch: &Patch<'a>| match &patch.ring {
            Ring::Known(ring) => *ring,
            Ring::Own(range) => &own[range.clone()],
        };
        outer.clear();
        within.clear();
        let mut shared = 0;
        for patch in &*all {
            let ring = segments(patch);
            let is_outer = |segment: &Segment| span.is_side(patch.cell, segment.face);
            let mut comes_within = ring.last().is_some_and(|last| !is_outer(last));
            for (n, segment) in ring.iter().enumerate() {
                let is_within = !is_outer(segment);
                if is_within {
                    shared += 1;
                    within.extend(comes_within.then_some(segment.from));
                } else {
                    let next = ring.get(n + 1).unwrap_or(&ring[0]);
                    outer.push((segment.placed(patch.cell, span.low), next.from));
                }
                comes_within = is_within;
            }
        }
        // Vertices − edges + patches is 1 for a disc. On its boundary there are as many of the one as of the other.
        let is_shared_alike = within.len() % 4 == 0 && shared % 2 == 0;
        if !is_shared_alike || within.len() / 4 + all.len() != shared / 2 + 1 {
            return None;
        }
        let mut ring: Vec<Segment> = Vec::with_capacity(outer.len());
        let first = outer.first()?.0.from;
        let mut at = first;
        while ring.len() < outer.len() {
            let &(segment, to) = outer.iter().find(|(segment, _)| segment.from == at)?;
            ring.push(segment);
            at = to;
            if at == first {
                break;
            }
        }
        if ring.len() != outer.len() || at != first {
            return None;
        }
        // As there is a single boundary, what does not hang together with the rest is closed. There is a node in it, and it
        // is crossed on all six ways along the axes from that: it has six vertices within, or more.
        if within.len() / 4 >= 6 {
            vertices.clear();
            for (patch, number) in all.iter().zip(0..) {
                vertices.extend(segments(patch).iter().map(|segment| (segment.from, number)));
            }
            vertices.sort_unstable();
            reached.clear();
            reached.resize(all.len(), false);
            if !hangs_together(vertices, reached) {
                return None;
            }
        }
        within.sort_unstable();
        within.dedup();
        Some(Disc { ring, within: within.clone() })
    }
}

/// Whether one comes from every patch to every other by vertices that they share; given the vertices in order,
/// each with its patches, and a mark for each patch.
fn hangs_together(vertices: &[(u32, u32)], reached: &mut [bool]) -> bool {
    reached[0] = true;
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
    reached.iter().all(|patch| *patch)
}
