//! Feature points: where a cell holds a crease or a corner, a vertex on it.
//!
//! ```text
//!      x0                    The normals at the vertices of the cell's loop spread more than a
//!     --o---.                smooth surface's do. Their planes meet near the crease: a first p.
//!       q0 ·.\               Then the field is asked at points q on the way from p to each
//!            p x  crease     vertex, for the planes that the sides have close to p, and p moves
//!       q1 · /               to where those meet.
//!     --o---'
//!      x1
//! ```
//!
//! Vertices with nearly the same normal share a point, on the way to the middle of them.
//!
//! Each step is a damped Gauss–Newton step (see [`Planes`]) that is held in the cell. On
//! plane sides the first is exact; on curved ones the error falls from d²/2R to δ²d²/2R, with
//! d the distance of the vertices, R the radius of curvature and δ = 2/5. Where the
//! cell turns out smooth, though strongly curved, the planes are nearly the same, and p
//! ends on the surface.
//!
//! Source: L. P. Kobbelt, M. Botsch, U. Schwanecke and H.-P. Seidel, Feature sensitive surface
//! extraction from volume data (2001), for the idea.

use std::ops::Range;

use glam::{Vec3, Vec3A};

use super::loops::LONGEST;
use super::qef::Planes;

/// Normals of a cell that differ by less than this are those of a smooth surface: the cosine
/// of the angle between them.
pub(super) const SMOOTH: f32 = 0.9;

/// Normals of vertices that are on the same side of a crease, with little between them: the cosine of 11°.
const ALIKE: f32 = 0.98;

/// How far feature points stay from the faces of their cell, in cells.
pub(super) const INSET: f32 = 1.0 / 128.0;

/// Normals of a side that is not the one that was asked for: the cosine of 45°.
const ASTRAY: f32 = 0.7;

/// The damping of the steps; it takes the distance from the crease to a hundredth a step.
const DAMPING: f32 = 3e-3;

/// Where the field is asked, as a part of the way from the feature point to a vertex. Much closer, and what
/// is found is the side of the crease that the first point missed it to.
const CLOSER: f32 = 0.4;

/// A value and a gradient of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slope {
    /// The value, in length units.
    pub value: f32,
    /// The gradient, inward.
    pub gradient: Vec3A,
}

/// Whether two of some normals differ as those of a crease do.
pub(super) fn differ(normals: &[Vec3A]) -> bool {
    for (n, a) in normals.iter().enumerate() {
        for b in &normals[..n] {
            if a.dot(*b) <= SMOOTH {
                return true;
            }
        }
    }
    false
}

/// A segment of a loop: from a vertex to that of the next segment. There are many: it is kept small.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: u32,
    across: u32,
    /// The outward unit normal at the vertex; later that which its side has close to the feature point. 0 if it
    /// is not known.
    pub(super) normal: Vec3,
    /// The cell that it bounds the surface of: how far that is along each axis from the first one of its fan's box, two
    /// bits each.
    place: u8,
    /// The face of the cell that it is in: twice the axis, and 1 more for the upper one.
    pub(super) face: u8,
    /// Whether it may be turned: its ends have different normals.
    pub(super) turns: bool,
}

impl Segment {
    /// The most cells along an axis that a fan's box may have.
    pub(super) const REACH: u32 = 4;

    /// Marks one that is not turned.
    const STRAIGHT: u32 = u32::MAX;

    /// A segment of a single cell.
    pub(super) fn new(from: u32, normal: Vec3, face: u8) -> Segment {
        Segment { from, across: Segment::STRAIGHT, normal, place: 0, face, turns: false }
    }

    /// What the edge is turned to, if it is: the fan on the other side by its number, or a point between the two by its
    /// number after those of all fans.
    #[inline]
    pub(super) fn across(&self) -> Option<u32> {
        Some(self.across).filter(|&across| across != Segment::STRAIGHT)
    }

    pub(super) fn turn(&mut self, across: u32) {
        self.across = across;
    }

    /// Its cell, given the first one of the fan's box.
    #[inline]
    pub(super) fn cell(&self, low: [u32; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| low[axis] + u32::from(self.place >> (2 * axis) & 3))
    }

    /// The same in the fan of a box, of up to [`REACH`](Segment::REACH) cells along each axis, given the first one.
    pub(super) fn placed(mut self, cell: [u32; 3], low: [u32; 3]) -> Segment {
        self.place = (0..3).fold(0, |place, axis| place | ((cell[axis] - low[axis]) as u8) << (2 * axis));
        self
    }
}

/// A cell whose surface is not smooth. Its segments, in order, are in a list of those of many cells.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) cell: [u32; 3],
    /// The place of the first segment in the list, and the number of them.
    first: u32,
    len: u32,
    /// The feature point, in cells from the cell's first node, as are the sides' planes close to it.
    pub(super) at: Vec3A,
    pub(super) planes: Planes,
}

impl Candidate {
    /// The cell with a first feature point. Its segments are those from `first` on of the list of all, and
    /// are told which of them turn; `places` are their vertices in cells, from the cell's first node.
    pub(super) fn new(cell: [u32; 3], first: usize, all: &mut [Segment], places: &[Vec3A]) -> Candidate {
        let segments = &mut all[first..];
        let planes = tangents(segments, places);
        let len = segments.len();
        let at = places.iter().sum::<Vec3A>() / len as f32;
        let mut candidate = Candidate { cell, first: first as u32, len: len as u32, at, planes };
        candidate.settle();
        candidate
    }

    /// The segments of the loop, in order, of the list of all.
    #[inline(always)]
    pub(super) fn segments<'a>(&self, all: &'a [Segment]) -> &'a [Segment] {
        &all[self.range()]
    }

    /// The places of its segments in the list.
    #[inline(always)]
    pub(super) fn range(&self) -> Range<usize> {
        self.first as usize..(self.first + self.len) as usize
    }

    #[inline(always)]
    fn settle(&mut self) {
        self.at = settle(&self.planes, self.at, Vec3A::ZERO, Vec3A::ONE, 1);
    }
}

/// The planes of the surface at the vertices of a cell's loop, given where these are from the cell's first node; tells
/// the segments which of them turn.
pub(super) fn tangents(segments: &mut [Segment], places: &[Vec3A]) -> Planes {
    let mut planes = Planes::NONE;
    let mut next = segments.first().map_or(Vec3A::ZERO, |segment| segment.normal.into());
    for (segment, at) in segments.iter_mut().zip(places).rev() {
        let normal = Vec3A::from(segment.normal);
        if normal != Vec3A::ZERO {
            planes.add(normal, normal.dot(*at));
        }
        segment.turns = normal.dot(next) < SMOOTH;
        next = normal;
    }
    planes
}

/// The point of a box of cells, clear of its faces, that the planes lead to in some steps.
#[inline]
pub(super) fn settle(planes: &Planes, from: Vec3A, low: Vec3A, high: Vec3A, steps: usize) -> Vec3A {
    (0..steps).fold(from, |at, _| planes.nearest(at, DAMPING, low + INSET, high - INSET))
}

/// Vertices of a cell that have nearly the same normal as the first of them.
#[derive(Clone, Copy, Default)]
struct Group {
    normal: Vec3A,
    sum: Vec3A,
    size: f32,
}

/// The plane that the surface has close to a point: its outward normal and its distance from the node that the point is
/// given from; `None` if the field does not tell.
#[inline(always)]
fn plane(point: Vec3A, slope: &Slope, step: f32) -> Option<(Vec3A, f32)> {
    let steepness = slope.gradient.length();
    let depth = slope.value / (steepness * step);
    // A plane that is farther away than the cell tells nothing; neither does NaN.
    (steepness > 0.0 && depth.abs() < 1.0).then(|| {
        let normal = slope.gradient / -steepness;
        (normal, normal.dot(point) + depth)
    })
}

/// Memory to refine candidates with.
#[derive(Default)]
pub(super) struct Refiner {
    /// By candidate, the sides that the vertices of its segments are on, in order, four bits each.
    sides: Vec<u64>,
    /// One for each side of each candidate, in cells from the candidate's first node; and the same from the block's.
    points: Vec<Vec3A>,
    in_block: Vec<Vec3A>,
    /// The field there.
    found: Vec<Slope>,
}

impl Refiner {
    /// Moves feature points closer to the creases. The candidates are consecutive, of the block with a first cell, and so
    /// are their `segments` and `places`, of the vertices in cells from the cell's first node. `slopes` tells values and
    /// gradients at points, in cells from the block's first node, for cells of size `step`; without any, feature points
    /// stay.
    pub(super) fn refine(
        &mut self,
        block: [u32; 3],
        candidates: &mut [Candidate],
        (segments, places): (&mut [Segment], &[Vec3A]),
        step: f32,
        mut slopes: impl FnMut(&[Vec3A], &mut Vec<Slope>) -> bool,
    ) {
        if candidates.is_empty() {
            return;
        }
        let Refiner { sides, points, in_block, found } = self;
        sides.clear();
        points.clear();
        in_block.clear();
        found.clear();
        // Vertices that have nearly the same normal are on the same side: they share a point.
        let mut groups = [Group::default(); LONGEST];
        for candidate in candidates.iter() {
            let range = candidate.range();
            let (mut count, mut on, mut shift) = (0, 0, 0);
            for (segment, &at) in segments[range.clone()].iter().zip(&places[range]) {
                let normal = Vec3A::from(segment.normal);
                let mut side = 0;
                while side < count && groups[side].normal.dot(normal) <= ALIKE {
                    side += 1;
                }
                if side == count {
                    groups[count] = Group { normal, ..Group::default() };
                    count += 1;
                }
                groups[side].sum += at;
                groups[side].size += 1.0;
                on |= (side as u64) << shift;
                shift += 4;
            }
            sides.push(on);
            let low = Vec3A::from_array(std::array::from_fn(|axis| (candidate.cell[axis] - block[axis]) as f32));
            for Group { sum, size, .. } in &groups[..count] {
                let point = candidate.at + CLOSER * (*sum / *size - candidate.at);
                points.push(point);
                in_block.push(low + point);
            }
        }
        if !slopes(in_block, found) || found.len() != points.len() {
            return;
        }
        let mut asked = points.iter().zip(found);
        let mut known = [None; LONGEST];
        for (candidate, &on) in candidates.iter_mut().zip(&*sides) {
            let range = candidate.range();
            let (mut planes, mut count, mut on) = (Planes::NONE, 0, on);
            for (segment, at) in segments[range.clone()].iter_mut().zip(&places[range]) {
                let side = (on & 15) as usize;
                on >>= 4;
                // They are met in the order of their first vertices.
                if side == count {
                    known[count] = asked.next().and_then(|(point, slope)| plane(*point, slope, step));
                    count += 1;
                }
                let own = Vec3A::from(segment.normal);
                match known[side] {
                    Some((normal, offset)) if normal.dot(own) > ASTRAY => {
                        segment.normal = normal.into();
                        planes.add(normal, offset);
                    }
                    // The point has come out on another side of the crease.
                    Some(_) => planes.add(own, own.dot(*at)),
                    None => {}
                }
            }
            if !planes.is_empty() {
                candidate.planes = planes;
                candidate.settle();
            }
        }
    }
}
