//! Whether two triangles meet, exactly.
//!
//! ```text
//!   none shared          one vertex shared        two shared: a common edge
//!        ____                    b                        c
//!    ___/_   \             a----/---c                    /|\
//!    \  \ \   \             \  /   /                    / | \      fold: d on c's side
//!     \  \_\___\             \/   /                    /  |  \     of the edge, in the
//!      \____\                v---d                    a---+---b    plane of a, b, c
//!   any common point     a common point besides v         d
//! ```
//!
//! Triangles are closed sets without a shared tolerance: a vertex of one that lies exactly on
//! the other counts. Where a vertex v is shared and there is another common point, the ray from
//! v through it leaves the triangle that ends first through the side opposite to v, and that
//! point is common too. So the sides opposite to v tell all, and no case has to look at v.
//!
//! Signs are those of Shewchuk's orientation predicates (1997), from the crate `robust`.
//! Triangles must not be degenerate.

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

type Triangle = [DVec3; 3];

/// Margins of [`lies_beyond`], relative to powers of the largest coordinate difference M:
/// sums of products of three differences are below 6 M³ and computed to 48 ε M³, those of four
/// to 132 ε M⁴, with ε = 2⁻⁵³ (first-order analysis). These are more than twice as large.
const MARGIN_3: f64 = 2e-14;
const MARGIN_4: f64 = 4e-14;

/// A quick proof, in f64, that two triangles have no common point: the plane of one, or a plane
/// through a side and upright on it, separates them. False is no proof of the contrary.
pub(super) fn surely_apart(p: &Triangle, q: &Triangle) -> bool {
    lies_beyond(p, q) || lies_beyond(q, p)
}

/// Whether a plane that belongs to `p` separates it from the corners `q`: three of a triangle, or
/// two of one whose third is `p[0]`. The plane then has to pass through that, and all other points
/// of the triangle are beyond.
fn lies_beyond<const N: usize>(p: &Triangle, q: &[DVec3; N]) -> bool {
    let (e, f) = (p[1] - p[0], p[2] - p[0]);
    let w = q.map(|x| x - p[0]);
    let largest = w.iter().fold(e.abs().max(f.abs()), |m, x| m.max(x.abs())).max_element();
    let cubed = largest * largest * largest;

    let normal = e.cross(f);
    let (low, high) = range(w.map(|x| normal.dot(x)));
    if low > MARGIN_3 * cubed || high < -MARGIN_3 * cubed {
        return true;
    }
    // Inward of each side: positive on p.
    let margin = -MARGIN_4 * cubed * largest;
    let beyond = |side: DVec3, through: DVec3| {
        let inward = normal.cross(side);
        range(w.map(|x| inward.dot(x - through))).1 < margin
    };
    beyond(e, DVec3::ZERO) || beyond(-f, DVec3::ZERO) || N == 3 && beyond(f - e, e)
}

fn range<const N: usize>(all: [f64; N]) -> (f64, f64) {
    all[1..].iter().fold((all[0], all[0]), |(low, high), x| (low.min(*x), high.max(*x)))
}

/// Whether two triangles without a shared vertex have a common point.
pub(super) fn meet(p: &Triangle, q: &Triangle) -> bool {
    let sides = q.map(|x| side(p, x));
    if sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0) {
        return false;
    }
    // The common points make a segment or a polygon whose ends or corners are on sides.
    let edges = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    edges(q).into_iter().any(|s| segment_meets(s, p)) || edges(p).into_iter().any(|s| segment_meets(s, q))
}

/// Whether [v, p0, p1] and [v, q0, q1] have a common point besides v.
pub(super) fn meet_beyond_vertex(v: DVec3, p: [DVec3; 2], q: [DVec3; 2]) -> bool {
    let (s, t) = ([v, p[0], p[1]], [v, q[0], q[1]]);
    let are_apart = lies_beyond(&s, &q) || lies_beyond(&t, &p);
    !are_apart && (segment_meets(p, &t) || segment_meets(q, &s))
}

/// Whether [a, b, p] and [a, b, q] have a common point besides those of the side a–b.
pub(super) fn meet_beyond_edge(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> bool {
    if side(&[a, b, p], q) != 0.0 {
        return false;
    }
    let flat = Flat::of(&[a, b, p]);
    (flat.turn(a, b, p) > 0.0) == (flat.turn(a, b, q) > 0.0)
}

/// Whether the three points are on a line.
pub(super) fn is_degenerate([a, b, c]: Triangle) -> bool {
    let (e, f) = (b - a, c - a);
    let largest = e.abs().max(f.abs()).max_element();
    if e.cross(f).abs().max_element() > MARGIN_3 * largest * largest {
        return false;
    }
    [Flat(0), Flat(1), Flat(2)].iter().all(|flat| flat.turn(a, b, c) == 0.0)
}

/// On which side of the triangle's plane a point is: a number of that sign, or 0.
fn side(t: &Triangle, x: DVec3) -> f64 {
    let [a, b, c, d] = [t[0], t[1], t[2], x].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    orient3d(a, b, c, d)
}

/// Whether a segment and a triangle have a common point.
fn segment_meets([a, b]: [DVec3; 2], t: &Triangle) -> bool {
    let (at_a, at_b) = (side(t, a), side(t, b));
    if (at_a > 0.0 && at_b > 0.0) || (at_a < 0.0 && at_b < 0.0) {
        return false;
    }
    if at_a == 0.0 && at_b == 0.0 {
        return Flat::of(t).segment_meets([a, b], t);
    }
    // The line passes the plane in one point, which is on the segment: is it in the triangle?
    let turns = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[p, q]| side(&[a, b, p], q));
    turns.iter().all(|&s| s >= 0.0) || turns.iter().all(|&s| s <= 0.0)
}

/// A plane of two of the axes: the projection along the axis of that number.
#[derive(Clone, Copy)]
struct Flat(usize);

impl Flat {
    /// A projection that keeps the triangle from collapsing.
    fn of(&[a, b, c]: &Triangle) -> Flat {
        let normal = (b - a).cross(c - a).abs();
        let likely = Flat(if normal.x >= normal.y && normal.x >= normal.z {
            0
        } else if normal.y >= normal.z {
            1
        } else {
            2
        });
        [likely, Flat(0), Flat(1)].into_iter().find(|flat| flat.turn(a, b, c) != 0.0).unwrap_or(Flat(2))
    }

    /// Positive where a, b, c turn anticlockwise; exact in sign.
    fn turn(self, a: DVec3, b: DVec3, c: DVec3) -> f64 {
        let [a, b, c] = [a, b, c].map(|p| {
            let (x, y) = [(p.y, p.z), (p.z, p.x), (p.x, p.y)][self.0];
            Coord { x, y }
        });
        orient2d(a, b, c)
    }

    /// Whether a segment and a triangle of the same plane have a common point.
    fn segment_meets(self, s: [DVec3; 2], t: &Triangle) -> bool {
        let sides = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        // Either an end is inside, or a side is crossed.
        let turns = sides.map(|[p, q]| self.turn(p, q, s[0]));
        turns.iter().all(|&x| x >= 0.0)
            || turns.iter().all(|&x| x <= 0.0)
            || sides.into_iter().any(|side| self.segments_meet(s, side))
    }

    fn segments_meet(self, [a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> bool {
        let (at_c, at_d) = (self.turn(a, b, c), self.turn(a, b, d));
        let (at_a, at_b) = (self.turn(c, d, a), self.turn(c, d, b));
        if at_c == 0.0 && at_d == 0.0 && at_a == 0.0 && at_b == 0.0 {
            // On one line: they meet if their boxes do.
            let overlap = a.min(b).cmple(c.max(d)) & c.min(d).cmple(a.max(b));
            return overlap.all();
        }
        !strictly_same(at_c, at_d) && !strictly_same(at_a, at_b)
    }
}

fn strictly_same(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Exact signs take a microsecond and more where all is in a plane, and of the triangles of a
    /// face that is a fan about one of its corners all pairs would ask for them.
    #[test]
    fn triangles_of_a_flat_fan_are_apart_without_exact_signs() {
        let count = 300;
        let corner = |n: usize| {
            let angle = TAU * n as f64 / count as f64;
            // Corners of a mesh are in single precision.
            DVec3::new(angle.cos(), angle.sin(), 0.3 * angle.cos() + 2.0).as_vec3().as_dvec3()
        };
        for first in 1..count - 1 {
            for other in first + 2..count - 1 {
                let [p, q] = [first, other].map(|n| [corner(n), corner(n + 1)]);
                let [s, t] = [p, q].map(|[a, b]| [corner(0), a, b]);
                assert!(lies_beyond(&s, &q) || lies_beyond(&t, &p), "{first} and {other}");
            }
        }
    }

    /// On a coarse lattice most pairs touch, or lie in a plane.
    #[test]
    fn what_is_apart_in_f64_does_not_meet() {
        let mut state = 1u64;
        let mut number = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below) as f64
        };
        let mut apart = [0; 2];
        for round in 0..100_000 {
            let height = 1 + round % 3;
            let [v, a, b, c, d, e] = [(); 6].map(|()| DVec3::new(number(5), number(5), number(height)));
            let (p, q) = ([v, a, b], [v, c, d]);
            if is_degenerate(p) || is_degenerate(q) {
                continue;
            }
            if lies_beyond(&p, &[c, d]) {
                apart[0] += 1;
                assert!(!segment_meets([a, b], &q) && !segment_meets([c, d], &p), "{p:?} {q:?}");
            }
            let q = [c, d, e];
            if !is_degenerate(q) && lies_beyond(&p, &q) {
                apart[1] += 1;
                assert!(!meet(&p, &q), "{p:?} {q:?}");
            }
        }
        assert!(apart.iter().all(|count| *count > 5_000), "{apart:?}");
    }
}
