//! Patches of several cells, glued to one.

use glam::Vec3A;

use super::samples::Samples;
use super::span::offset;
use crate::mesh::feature::{Segment, tangents};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;

/// The weight of a cell's planes is 1 over the square of its distance, in cells, and this.
const NEAR: f32 = 0.1;

/// The patches of several cells: the segments of the loops around them, with their ends and the numbers of the patches.
#[derive(Default)]
pub(super) struct Patches {
    segments: Vec<(Segment, u32, u32)>,
    /// By patch, its cell and the planes.
    planes: Vec<([u32; 3], Planes)>,
    /// Memory for the loop of one, and where its vertices are in the cell.
    ring: Vec<Segment>,
    places: Vec<Vec3A>,
    /// And for [`glued`](Patches::glued): the ends of all segments, those that no other shares, by number, all vertices
    /// with the numbers of their patches, and the patches that are reached.
    sides: Vec<(u32, u32)>,
    outer: Vec<u32>,
    vertices: Vec<(u32, u32)>,
    reached: Vec<bool>,
}

/// A disc of several patches.
pub(super) struct Disc {
    /// Its boundary.
    pub(super) ring: Vec<Segment>,
    /// The vertices that are not on it, ascending.
    pub(super) within: Vec<u32>,
}

impl Patches {
    pub(super) fn clear(&mut self) {
        self.segments.clear();
        self.planes.clear();
    }

    /// Adds a patch of a cell.
    pub(super) fn add(&mut self, cell: [u32; 3], ring: &[Segment], planes: &Planes) {
        let (next, count) = (ring.iter().cycle().skip(1).map(|segment| segment.from), self.count());
        self.segments.extend(ring.iter().zip(next).map(|(segment, to)| (*segment, to, count)));
        self.planes.push((cell, *planes));
    }

    /// Adds the patch of a loop of a cell, given the vertices on it.
    pub(super) fn add_loop(&mut self, samples: &Samples<'_>, cell: [u32; 3], outline: &CellLoop, vertices: &[u32]) {
        let (mut ring, mut places) = (std::mem::take(&mut self.ring), std::mem::take(&mut self.places));
        ring.clear();
        places.clear();
        let (low, share) = (samples.node(cell), 1.0 / samples.lattice.step() as f32);
        for (n, &from) in vertices.iter().enumerate() {
            let (position, normal) = samples.get(from);
            ring.push(Segment::new(from, normal, outline.face(n)));
            places.push(share * Vec3A::from(position - low));
        }
        let (planes, _) = tangents(&mut ring, &places);
        self.add(cell, &ring, &planes);
        (self.ring, self.places) = (ring, places);
    }

    fn count(&self) -> u32 {
        self.planes.len() as u32
    }

    /// All planes, from the first node of cell `low`; those of cells close to a point tell the most.
    pub(super) fn planes(&self, low: [u32; 3], point: Vec3A) -> Planes {
        let mut all = Planes::NONE;
        for (cell, planes) in &self.planes {
            let shift = offset(*cell, low);
            all.append(planes, shift, (NEAR + (shift + 0.5 - point).length_squared()).recip());
        }
        all
    }

    /// All as one, if they make a disc; `low` is the first cell of the box that they are in.
    pub(super) fn glued(&mut self, low: [u32; 3]) -> Option<Disc> {
        let Patches { segments, planes, sides, outer, vertices, reached, .. } = self;
        // A segment that two patches share is there in both directions.
        sides.clear();
        sides.extend(segments.iter().map(|&(segment, to, _)| (segment.from, to)));
        sides.sort_unstable();
        let is_outer = |&n: &u32| {
            let (segment, to, _) = segments[n as usize];
            sides.binary_search(&(to, segment.from)).is_err()
        };
        outer.clear();
        outer.extend((0..segments.len() as u32).filter(is_outer));
        let mut ring: Vec<Segment> = Vec::with_capacity(outer.len());
        let first = segments[*outer.first()? as usize].0.from;
        let mut at = first;
        loop {
            let all = outer.iter().map(|&n| &segments[n as usize]);
            let &(segment, to, patch) = all.into_iter().find(|(segment, ..)| segment.from == at)?;
            ring.push(segment.placed(planes[patch as usize].0, low));
            at = to;
            if at == first {
                break;
            }
            if ring.len() > outer.len() {
                return None;
            }
        }
        // Vertices − edges + patches is 1 for a disc; edges within are listed twice.
        vertices.clear();
        vertices.extend(segments.iter().map(|&(segment, _, patch)| (segment.from, patch)));
        vertices.sort_unstable();
        reached.clear();
        reached.resize(planes.len(), false);
        if ring.len() != outer.len() || !hangs_together(vertices, reached) {
            return None;
        }
        vertices.dedup_by_key(|(vertex, _)| *vertex);
        let edges = outer.len() + (segments.len() - outer.len()) / 2;
        if vertices.len() + planes.len() != edges + 1 {
            return None;
        }
        let is_within = |vertex: &u32| ring.iter().all(|segment| segment.from != *vertex);
        let within = vertices.iter().map(|&(vertex, _)| vertex).filter(is_within).collect();
        Some(Disc { ring, within })
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
