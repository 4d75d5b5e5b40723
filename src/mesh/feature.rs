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
//! Vertices that follow each other on the loop with nearly the same normal are on one side: they
//! share a point, on the way to the middle of them.
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

use super::qef::Planes;

/// Which normals are those of a crease.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crease {
    /// Normals of a cell that differ by less than this are those of a smooth surface: the cosine of
    /// the angle between them.
    pub(super) smooth: f32,
    /// The same of vertices next to each other that are on one side of a crease.
    alike: f32,
    /// Normals that differ by more are of a side that is not the one that was asked for.
    astray: f32,
    /// The first angle, as a part of the usual one: by so much less is a crease above the triangles
    /// that cut it off.
    pub(super) part: f32,
}

/// The damping of steps to a crease of the usual angle; it takes the distance from that to a
/// hundredth a step.
const DAMPING: f32 = 3e-3;

impl Crease {
    /// Sides that are 26° apart or more; normals of one side are no more than 11° apart, those of
    /// another than the one that was asked for more than 45°.
    pub(crate) const USUAL: Crease = Crease { smooth: 0.9, alike: 0.98, astray: 0.7, part: 1.0 };

    /// The usual angle, and the least that normals in single precision tell.
    const ANGLE: f64 = 0.451;
    const LEAST: f64 = 5e-3;

    /// Sides that are so far apart, in radians, or as far as usual if that is less.
    pub(crate) fn of_angle(angle: f64) -> Crease {
        let angle = angle.max(Crease::LEAST);
        if angle >= Crease::ANGLE {
            return Crease::USUAL;
        }
        let cosine = |by: f64| (by * angle).cos() as f32;
        Crease { smooth: cosine(1.0), alike: cosine(0.44), astray: cosine(1.76), part: (angle / Crease::ANGLE) as f32 }
    }

    /// Its square: by so much less do the planes of both sides draw a point towards where they
    /// meet.
    pub(super) fn pull(self) -> f32 {
        self.part * self.part
    }
}

/// How far feature points stay from the faces of their cell, in cells.
pub(super) const INSET: f32 = 1.0 / 128.0;

/// Steps that are shorter than this, in cells, are the last: what is left is less.
pub(super) const CLOSE: f32 = 1e-3;

/// Where the field is asked, as a part of the way from the feature point to a vertex. Much closer,
/// and what is found is the side of the crease that the first point missed it to.
const CLOSER: f32 = 0.4;

/// The most sides that a cell may have: as many as four bits tell.
const MOST_SIDES: usize = 16;

/// A value and a gradient of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slope {
    /// The value, in length units.
    pub value: f32,
    /// The gradient, inward.
    pub gradient: Vec3A,
}

impl Slope {
    /// The outward normal of the surface close to the point, and how deep the point is below it, to
    /// first order and in cells of size `step`; `None` if the field does not tell.
    #[inline(always)]
    pub(super) fn surface(&self, step: f32) -> Option<(Vec3A, f32)> {
        let steepness = self.gradient.length();
        let depth = self.value / (steepness * step);
        // A surface that is farther away than the cell tells nothing; neither does NaN.
        (steepness > 0.0 && depth.abs() < 1.0).then(|| (self.gradient / -steepness, depth))
    }
}

/// Whether two of some normals differ as those of a crease do.
pub(super) fn differ(normals: &[Vec3A], crease: Crease) -> bool {
    let mut least = f32::INFINITY;
    for (n, a) in normals.iter().enumerate() {
        for b in &normals[..n] {
            least = least.min(a.dot(*b));
        }
    }
    least <= crease.smooth
}

/// A segment of a loop: from a vertex to that of the next segment. There are many: it is kept
/// small.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: u32,
    across: u32,
    /// The outward unit normal at the vertex; later that which its side has close to the feature
    /// point. 0 if it is not known.
    pub(super) normal: Vec3,
    /// The cell that it bounds the surface of: how far that is along each axis from the first one
    /// of its fan's box, two bits each.
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

    /// The faces that segments are in, as bits.
    #[inline(always)]
    pub(super) fn faces(ring: &[Segment]) -> u8 {
        ring.iter().fold(0, |faces, segment| faces | 1 << segment.face)
    }

    /// What the edge is turned to, if it is: the fan on the other side by its number, or a point
    /// between the two by its number after those of all fans.
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

    /// The same in the fan of a box, of up to [`REACH`](Segment::REACH) cells along each axis,
    /// given the first one.
    pub(super) fn placed(mut self, cell: [u32; 3], low: [u32; 3]) -> Segment {
        self.place = (0..3).fold(0, |place, axis| place | ((cell[axis] - low[axis]) as u8) << (2 * axis));
        self
    }
}

/// A cell whose surface is not smooth. Its segments, in order, are in a list of those of many
/// cells. There are many: it is kept small.
pub(super) struct Candidate {
    /// The place of the first segment in the list, and the number of them.
    first: u32,
    len: u8,
    /// Whether there is a crease that leaves the cell by a face that the surface does not cross.
    pub(super) leaves: bool,
    /// The number of the cell in its block.
    pub(super) number: u16,
    /// How far the feature point is from the planes, in cells.
    pub(super) residual: f32,
    /// The normal that stands for all its sides.
    pub(super) normal: Vec3,
    /// The feature point, in cells from the cell's first node, as are the sides' planes close to
    /// it.
    pub(super) at: Vec3,
    planes: [f32; Planes::SUMS],
    /// The feature point as a vertex has it.
    pub(super) position: Vec3,
}

impl Candidate {
    pub(super) fn planes(&self) -> Planes {
        Planes::unpacked(&self.planes)
    }

    /// The segments of the loop, in order, of the list of all.
    #[inline(always)]
    pub(super) fn segments<'a>(&self, all: &'a [Segment]) -> &'a [Segment] {
        &all[self.range()]
    }

    /// The places of its segments in the list.
    #[inline(always)]
    pub(super) fn range(&self) -> Range<usize> {
        let first = self.first as usize;
        first..first + usize::from(self.len)
    }
}

/// The planes of the surface at the vertices of a cell's loop, given where these are from the
/// cell's first node; tells the segments which of them turn, and `each` how far its plane is from
/// that node, last vertex first. Then, by a bit for each vertex, where another side starts than
/// that of the one before.
#[inline(always)]
pub(super) fn tangents(
    segments: &mut [Segment],
    places: &[Vec3A],
    crease: Crease,
    mut each: impl FnMut(f32),
) -> (Planes, u32) {
    let (mut planes, mut sides) = (Planes::NONE, 0);
    let first = segments.first().map_or(Vec3A::ZERO, |segment| segment.normal.into());
    let mut next = first;
    for (segment, at) in segments.iter_mut().zip(places).rev() {
        let normal = Vec3A::from(segment.normal);
        let offset = normal.dot(*at);
        if normal != Vec3A::ZERO {
            planes.add(normal, offset);
        }
        each(offset);
        let alike = normal.dot(next);
        segment.turns = alike < crease.smooth;
        sides = sides << 1 | u32::from(alike <= crease.alike);
        next = normal;
    }
    // So far each bit is that of the vertex before. Loops of cells are short; of those with more
    // vertices than bits, about merged cells, sides are not asked for.
    let last = (segments.len() - 1).min(31);
    (planes, sides << 1 & u32::MAX >> (31 - last) | sides >> last)
}

/// The point of a box of cells, clear of its faces, that the planes lead to in up to some steps.
#[inline]
pub(super) fn settle(planes: &Planes, from: Vec3A, [low, high]: [Vec3A; 2], (steps, crease): (usize, Crease)) -> Vec3A {
    let mut at = from;
    for _ in 0..steps {
        let next = planes.nearest(at, crease.pull() * DAMPING, low + INSET, high - INSET);
        let way = next - at;
        at = next;
        if way.length_squared() < CLOSE * CLOSE {
            break;
        }
    }
    at
}

/// A candidate in the making.
pub(super) struct Draft {
    first: u32,
    len: u8,
    /// How many sides there are, and which of them the vertices of its segments are on, in order,
    /// four bits each.
    count: u8,
    on: u64,
    pub(super) number: u16,
    pub(super) at: Vec3A,
    pub(super) planes: Planes,
}

impl Draft {
    /// The candidate, given its normal and position, and whether a crease leaves it.
    #[inline(always)]
    pub(super) fn done(&self, [normal, position]: [Vec3; 2], leaves: bool) -> Candidate {
        let Draft { first, len, number, at, ref planes, .. } = *self;
        let residual = planes.distance(at);
        Candidate { first, len, leaves, number, residual, normal, at: at.into(), planes: planes.packed(), position }
    }
}

/// Places feature points, those of many cells together.
#[derive(Default)]
pub(super) struct Refiner {
    drafts: Vec<Draft>,
    /// By segment, how far the tangent plane at its vertex is from the candidate's first node;
    /// those of a candidate from the last to the first.
    offsets: Vec<f32>,
    /// One for each side of each candidate, in cells from the candidate's first node; and the same
    /// from the block's.
    points: Vec<Vec3A>,
    in_block: Vec<Vec3A>,
    /// The field there.
    found: Vec<Slope>,
}

impl Refiner {
    /// Forgets all candidates.
    pub(super) fn clear(&mut self) {
        let Refiner { drafts, offsets, points, in_block, found } = self;
        drafts.clear();
        offsets.clear();
        points.clear();
        in_block.clear();
        found.clear();
    }

    /// Adds the next candidate: a cell, by its number in the block and by its first node there. Its
    /// segments are told which of them turn, and will be in the list from `first` on. The places
    /// are those of their vertices, in cells from the first node.
    #[inline]
    pub(super) fn add(
        &mut self,
        (number, low): (u16, Vec3A),
        (first, segments): (usize, &mut [Segment]),
        places: &[Vec3A],
        crease: Crease,
    ) {
        let (planes, starts) = tangents(segments, places, crease, |offset| self.offsets.push(offset));
        let middle = places.iter().sum::<Vec3A>() / places.len() as f32;
        let at = settle(&planes, middle, [Vec3A::ZERO, Vec3A::ONE], (1, crease));
        // Vertices of a side share a point. Those before the first start are on the last side, the
        // one that goes on there.
        let count = starts.count_ones().max(1);
        let mut sides = [(Vec3A::ZERO, 0.0); MOST_SIDES];
        let (mut side, mut on) = (count - 1, 0);
        for (n, place) in places.iter().enumerate() {
            side += starts >> n & 1;
            side = if side == count { 0 } else { side };
            let (sum, size) = &mut sides[side as usize % MOST_SIDES];
            *sum += *place;
            *size += 1.0;
            on |= u64::from(side) << (4 * n);
        }
        for (sum, size) in &sides[..count as usize % (MOST_SIDES + 1)] {
            let point = at + CLOSER * (*sum / *size - at);
            self.points.push(point);
            self.in_block.push(low + point);
        }
        let (first, len, count) = (first as u32, segments.len() as u8, count as u8);
        self.drafts.push(Draft { first, len, count, on, number, at, planes });
    }

    /// Moves the points of the candidates that were added closer to the creases, and tells `each`
    /// of them, with the normal that stands for its sides and its part of the `segments`, which are
    /// consecutive. `slopes` tells values and gradients at points, in cells from the block's first
    /// node, for cells of size `step`; without any, feature points stay.
    pub(super) fn refine(
        &mut self,
        segments: &mut [Segment],
        (step, crease): (f32, Crease),
        mut slopes: impl FnMut(&[Vec3A], &mut Vec<Slope>) -> bool,
        mut each: impl FnMut(&Draft, Vec3, &[Segment]),
    ) {
        let Refiner { drafts, offsets, points, in_block, found } = self;
        if drafts.is_empty() {
            return;
        }
        if !slopes(in_block, found) || found.len() != points.len() {
            found.clear();
        }
        let mut asked = points.iter().zip(found);
        let (mut segments, mut offsets) = (segments, &offsets[..]);
        let mut known = [None; MOST_SIDES];
        for draft in drafts {
            let (mut planes, mut sum, mut on) = (Planes::NONE, Vec3A::ZERO, draft.on);
            let mut first = None;
            for (known, (point, slope)) in known[..usize::from(draft.count)].iter_mut().zip(&mut asked) {
                *known = slope.surface(step).map(|(normal, depth)| (normal, normal.dot(*point) + depth));
            }
            let ring = segments.split_off_mut(..usize::from(draft.len)).unwrap_or_default();
            let (own, rest) = offsets.split_at(ring.len());
            offsets = rest;
            for (segment, offset) in ring.iter_mut().zip(own.iter().rev()) {
                let own = Vec3A::from(segment.normal);
                first.get_or_insert(own);
                match known[(on & 15) as usize] {
                    Some((normal, offset)) if normal.dot(own) > crease.astray => {
                        segment.normal = normal.into();
                        sum += normal;
                        planes.add(normal, offset);
                    }
                    // The point has come out on another side of the crease.
                    Some(_) => {
                        sum += own;
                        planes.add(own, *offset);
                    }
                    None => sum += own,
                }
                on >>= 4;
            }
            if !planes.is_empty() {
                draft.at = settle(&planes, draft.at, [Vec3A::ZERO, Vec3A::ONE], (1, crease));
                draft.planes = planes;
            }
            // On both sides of a thin wall they may be no more than nothing together.
            each(draft, sum.normalize_or(first.unwrap_or_default()).into(), ring);
        }
    }
}
