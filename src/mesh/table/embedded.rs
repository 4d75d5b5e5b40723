//! The triangles of a case do not cross, wherever on the edges their corners are.
//!
//! What is shown, for all 256 cases and all positions strictly inside the edges at once:
//!
//! * Two triangles of a cell can only meet, beyond what they share, where a side of one goes
//!   through the other or meets a side of it. A side that lies in a face of the cell cannot: the
//!   triangles lie in no face, so they meet the cell's boundary in such sides alone. That leaves
//!   the diagonals.
//! * The volume that four points span is affine in the place of each of them. Its sign over all
//!   places is settled if it is the same at the 16 combinations of edge ends (and not 0 at all of
//!   them).
//! * Where signs do not settle whether a diagonal goes through a triangle, a plane separates the
//!   two, whose normal is made of small integers: it is enough to look at the ends of the edges.
//! * Triangles that share a side do not fold onto one another: both face the same way in some fixed
//!   direction.

use super::*;
use crate::mesh::loops::CellLoop;

type Vector = [i32; 3];

fn end(edge: u8, upper: bool) -> Vector {
    corner_position(EDGE_CORNERS[usize::from(edge)][usize::from(upper)])
}

fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|n| a[n] - b[n])
}

fn dot(a: Vector, b: Vector) -> i32 {
    (0..3).map(|n| a[n] * b[n]).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The sign that a function of points on edges has everywhere, if it is affine in each of them and
/// its sign is settled by the ends; 0 if it is not.
fn settled<const N: usize>(edges: [u8; N], f: impl Fn([Vector; N]) -> i32) -> i32 {
    let values = (0..1 << N).map(|ends: usize| f(std::array::from_fn(|n| end(edges[n], ends >> n & 1 == 1))));
    let (low, high) = values.fold((i32::MAX, i32::MIN), |(low, high), v| (low.min(v), high.max(v)));
    match (low, high) {
        (0, 1..) | (1.., _) => 1,
        (_, 0) if low < 0 => -1,
        (_, ..0) => -1,
        _ => 0,
    }
}

/// The sign of the volume that points on four edges span.
fn volume(edges: [u8; 4]) -> i32 {
    settled(edges, |[a, b, c, d]| dot(minus(b, a), cross(minus(c, a), minus(d, a))))
}

fn directions() -> impl Iterator<Item = Vector> {
    (0..125).map(|n| [n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2]).filter(|&w| w != [0; 3])
}

/// Whether all points on the first edges are on the lower side of a plane, and those on the second
/// on the upper; one of the two may come as close as it likes.
fn separated(below: &[u8], above: &[u8]) -> bool {
    let range = |edge: u8, w: Vector| [dot(end(edge, false), w), dot(end(edge, true), w)];
    directions().any(|w| {
        let high = below.iter().flat_map(|&edge| range(edge, w)).max();
        let low = above.iter().flat_map(|&edge| range(edge, w)).min();
        // An end of an edge is not reached, unless the edge runs along the plane.
        let reaches = |edges: &[u8], at| edges.iter().any(|&edge| range(edge, w).map(Some) == [at; 2]);
        high < low || high == low && !(reaches(below, high) && reaches(above, low))
    })
}

fn apart(a: &[u8], b: &[u8]) -> bool {
    separated(a, b) || separated(b, a)
}

#[test]
fn no_diagonal_goes_through_a_triangle() {
    let (mut by_sign, mut by_plane) = (0, 0);
    for case in 0..=255 {
        let triangles = CaseTable::get().triangles(case);
        let all: Vec<[u8; 2]> = triangles.iter().flat_map(|&t| sides(t)).collect();
        let diagonals = all.iter().filter(|&&[a, b]| a < b && all.contains(&[b, a]));
        for &[p, q] in diagonals {
            for &[a, b, c] in triangles {
                let shared = [a, b, c].iter().filter(|&&v| v == p || v == q).count();
                let settled = match shared {
                    0 => {
                        let ends = [volume([a, b, c, p]), volume([a, b, c, q])];
                        let around = [volume([p, q, a, b]), volume([p, q, b, c]), volume([p, q, c, a])];
                        ends[0] * ends[1] > 0 || around.contains(&1) && around.contains(&-1)
                    }
                    1 => {
                        // From a shared corner it could only cross the opposite side, if that is a
                        // diagonal.
                        let [u, v] = sides([a, b, c]).into_iter().find(|s| !s.contains(&p) && !s.contains(&q)).unwrap();
                        let is_diagonal = all.contains(&[u, v]) && all.contains(&[v, u]);
                        !is_diagonal || volume([p, q, u, v]) != 0 || apart(&[p, q], &[u, v])
                    }
                    _ => true,
                };
                by_sign += usize::from(settled);
                if !settled {
                    by_plane += 1;
                    assert!(shared == 0 && apart(&[p, q], &[a, b, c]), "case {case}: {p}–{q} and {a}, {b}, {c}");
                }
            }
        }
    }
    assert_eq!(by_plane, 32);
    assert!(by_sign > 1000);
}

/// Whether two triangles face the same way in some direction, wherever their corners are on their
/// edges.
fn face_one_way(t: [u8; 3], u: [u8; 3]) -> bool {
    let faces =
        |triangle: [u8; 3], w: Vector| settled(triangle, |[a, b, c]| dot(cross(minus(b, a), minus(c, a)), w)) == 1;
    directions().any(|w| faces(t, w) && faces(u, w))
}

#[test]
fn triangles_that_share_a_side_do_not_fold() {
    for case in 0..=255 {
        let triangles = CaseTable::get().triangles(case);
        for (n, &t) in triangles.iter().enumerate() {
            for &u in triangles[..n].iter().filter(|&&u| runs_along(t, u).is_some()) {
                assert!(face_one_way(t, u), "case {case}: {t:?} and {u:?}");
            }
        }
    }
}

#[test]
fn a_loop_of_four_may_have_either_diagonal() {
    let mut count = 0;
    for outline in CellLoop::table().iter().flatten() {
        let &[a, b, c, d] = outline.edges() else { continue };
        count += 1;
        for [t, u] in [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]] {
            assert!(face_one_way(t, u), "{t:?} and {u:?}");
        }
        // The diagonals are in no face of the cell.
        assert!(common_face(a, c).is_none() && common_face(b, d).is_none());
    }
    assert_eq!(count, 30);
}
