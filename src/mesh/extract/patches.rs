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
        let planes = tangents(&mut ring, &places);
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
    pub(super) fn glued(&self, low: [u32; 3]) -> Option<Disc> {
        // A segment that two patches share is there in both directions.
        let mut sides: Vec<(u32, u32)> = self.segments.iter().map(|&(segment, to, _)| (segment.from, to)).collect();
        sides.sort_unstable();
        let is_outer = |(segment, to, _): &&(Segment, u32, u32)| sides.binary_search(&(*to, segment.from)).is_err();
        let outer: Vec<&(Segment, u32, u32)> = self.segments.iter().filter(is_outer).collect();
        let mut ring: Vec<Segment> = Vec::with_capacity(outer.len());
        let (first, ..) = *outer.first()?;
        let mut at = first.from;
        loop {
            let &&(segment, to, patch) = outer.iter().find(|(segment, ..)| segment.from == at)?;
            ring.push(segment.placed(self.planes[patch as usize].0, low));
            at = to;
            if at == first.from {
                break;
            }
            if ring.len() > outer.len() {
                return None;
            }
        }
        // Vertices − edges + patches is 1 for a disc; edges within are listed twice.
        let mut vertices: Vec<(u32, u32)> =
            self.segments.iter().map(|&(segment, _, patch)| (segment.from, patch)).collect();
        vertices.sort_unstable();
        if ring.len() != outer.len() || !self.hangs_together(&vertices) {
            return None;
        }
        vertices.dedup_by_key(|(vertex, _)| *vertex);
        let edges = outer.len() + (self.segments.len() - outer.len()) / 2;
        if vertices.len() + self.count() as usize != edges + 1 {
            return None;
        }
        let mut within: Vec<u32> = vertices.into_iter().map(|(vertex, _)| vertex).collect();
        within.retain(|vertex| ring.iter().all(|segment| segment.from != *vertex));
        Some(Disc { ring, within })
    }

    /// Whether one comes from every patch to every other by vertices that they share; given the vertices in order,
    /// each with its patches.
    fn hangs_together(&self, vertices: &[(u32, u32)]) -> bool {
        let mut reached: Vec<bool> = (0..self.count()).map(|patch| patch == 0).collect();
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
        reached.into_iter().all(|patch| patch)
    }
}
