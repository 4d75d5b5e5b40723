//! Cells that two creases pass: cut in two halves, with a fan each.
//!
//! ```text
//!         a--u--b            A narrow side between two creases: the cell's loop goes over it twice, at u and at v.
//!        /   |   \           The plane through u and v, across that side, cuts the cell into two convex halves
//!       /    |    \          with a crease each. They have a fan each, from points on the creases. The segment
//!      s     |     t         u–v that the two have in common is turned: from one point to the other.
//!       A    |   B
//! ```
//!
//! The halves are convex, the loop is on their boundaries but for u–v, which lies in the plane
//! between them: what [`sharp`](super::sharp) says of the fans of cells, and of edges between them,
//! holds for halves as well. It takes that the vertices and the point of each are on its side of
//! the plane: they are by more than any rounding. An edge that is turned across a face of the cell
//! has to pass the half's part of that face.

use glam::{DVec3, Vec3, Vec3A};

use crate::mesh::feature::{Crease, Segment, settle};
use crate::mesh::qef::Planes;

/// How far from the plane all of a half has to be, in cells.
const MARGIN: f64 = 1.0 / 64.0;

/// The face of the segment between halves: none of the cell's.
const BETWEEN: u8 = 6;

/// The half of a cell that a fan is in.
#[derive(Clone, Debug)]
pub(super) struct Half {
    /// The fan of the other half.
    pub(super) twin: u32,
    /// A point of the plane between them, and the direction from that into the half.
    at: DVec3,
    inward: DVec3,
}

impl Half {
    /// Whether a point is in the half, by more than a distance.
    pub(super) fn has(&self, p: DVec3, margin: f64) -> bool {
        (p - self.at).dot(self.inward) > margin
    }

    /// The same, given the fan of the other one.
    pub(super) fn with_twin(self, twin: u32) -> Half {
        Half { twin, ..self }
    }

    /// The other half, given the fan of this one.
    pub(super) fn other(&self, own: u32) -> Half {
        Half { twin: own, at: self.at, inward: -self.inward }
    }
}

/// How to cut a cell.
pub(super) struct Cut {
    /// Which vertices of the loop it goes through.
    ends: [usize; 2],
    /// The direction that the plane goes in besides.
    along: Vec3A,
    /// The points of the halves, in cells from the first node; first that of the segments from the
    /// first end to the last.
    pub(super) at: [Vec3A; 2],
    /// How far they are from their planes, in cells.
    pub(super) residual: f32,
}

impl Cut {
    /// The cut of a loop that leaves two halves with what fits best in each, given where its
    /// vertices are from the cell's first node.
    pub(super) fn best(ring: &[Segment], places: &[Vec3A], size: Vec3A, crease: Crease) -> Option<Cut> {
        let count = ring.len();
        let mut best: Option<Cut> = None;
        for first in 0..count {
            for last in first + 2..count {
                if first == 0 && last == count - 1 {
                    continue;
                }
                let cut = Cut::new(ring, places, size, ([first, last], crease));
                best = match (best, cut) {
                    (Some(best), Some(cut)) if cut.residual < best.residual => Some(cut),
                    (best, cut) => best.or(cut),
                };
            }
        }
        best
    }

    fn new(ring: &[Segment], places: &[Vec3A], size: Vec3A, (ends, crease): ([usize; 2], Crease)) -> Option<Cut> {
        let [first, last] = ends;
        let normal = |n: usize| Vec3A::from(ring[n].normal);
        // Both are on one side, and there are others on either way between them.
        if normal(first).dot(normal(last)) < crease.smooth {
            return None;
        }
        let along = (normal(first) + normal(last)).normalize_or_zero();
        let ways = Cut::ways(ends, ring.len());
        let has_other = |way: &Vec<usize>| way.iter().any(|&n| normal(n).dot(along) < crease.smooth);
        if !ways.iter().all(has_other) {
            return None;
        }
        let mut residual = 0.0f32;
        let at = ways.map(|way| {
            let (mut planes, mut sum) = (Planes::NONE, Vec3A::ZERO);
            for &n in way.iter().chain(&ends).filter(|&&n| normal(n) != Vec3A::ZERO) {
                planes.add(normal(n), normal(n).dot(places[n]));
            }
            way.iter().for_each(|&n| sum += places[n]);
            let middle = (sum + places[first] + places[last]) / (way.len() + 2) as f32;
            let at = settle(&planes, middle, [Vec3A::ZERO, size], (3, crease));
            residual = residual.max(planes.distance(at));
            at
        });
        Some(Cut { ends, along, at, residual })
    }

    /// The vertices between the ends, on either way around.
    fn ways([first, last]: [usize; 2], count: usize) -> [Vec<usize>; 2] {
        [(first + 1..last).collect(), (last + 1..count).chain(0..first).collect()]
    }

    /// The half of the segments from the first end to the last, but for its twin, if all of both
    /// halves is on its side of the plane; given the positions of the vertices and of the points.
    pub(super) fn half(&self, positions: &[Vec3], at: [Vec3; 2], step: f64) -> Option<Half> {
        let [first, last] = self.ends.map(|end| positions[end].as_dvec3());
        let inward = (last - first).cross(self.along.as_dvec3()).normalize_or_zero();
        let [own, others] = Cut::ways(self.ends, positions.len());
        let is_clear = |half: &Half, way: &[usize], at: Vec3| {
            let points = way.iter().map(|&n| positions[n]).chain([at]);
            points.map(Vec3::as_dvec3).all(|p| half.has(p, MARGIN * step))
        };
        [inward, -inward].into_iter().find_map(|inward| {
            let half = Half { twin: 0, at: first, inward };
            (is_clear(&half, &own, at[0]) && is_clear(&half.other(0), &others, at[1])).then_some(half)
        })
    }

    /// The loops of both halves, given those of their fans by number.
    pub(super) fn rings(&self, ring: &[Segment], fans: [u32; 2]) -> [Vec<Segment>; 2] {
        let [first, last] = self.ends;
        let closed = |way: Vec<Segment>, end: usize, across: u32| {
            let mut between = Segment::new(ring[end].from, ring[end].normal, BETWEEN);
            between.turn(across);
            let mut all = way;
            all.push(between);
            all
        };
        let own = ring[first..last].to_vec();
        let others = ring[last..].iter().chain(&ring[..first]).copied().collect();
        [closed(own, last, fans[1]), closed(others, first, fans[0])]
    }
}
