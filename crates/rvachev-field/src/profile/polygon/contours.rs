//! From contours to edges: what is wrong with them, and which way round they go.
//!
//! Whether edges meet and which way corners turn is decided by exact arithmetic (J. R.
//! Shewchuk's adaptive orientation test, 1997). Pairs of edges are looked for through the
//! hierarchy of their boxes, so contours of n points take O(n log n) where boxes overlap
//! little, as they do in drawings.

use glam::DVec2;

use super::super::super::check;
use super::{Edge, Tree};
use crate::ParamError;

/// The shortest edge.
const SHORTEST: f64 = 1e-9;

/// A segment, the contour that it is of and its number there.
#[derive(Clone, Copy)]
struct Segment {
    ends: [DVec2; 2],
    contour: u32,
    number: u32,
}

/// The edges of the contours, inside on their left.
pub(super) fn edges(contours: &[Vec<DVec2>]) -> Result<Vec<Edge>, ParamError> {
    if contours.is_empty() {
        return Err(ParamError::new("number of contours", 0.0, "1 or more"));
    }
    let mut segments = Vec::new();
    for (c, points) in contours.iter().enumerate() {
        check_points(c, points)?;
        let ends = points.iter().zip(points.iter().cycle().skip(1));
        segments.extend(ends.enumerate().map(|(i, (a, b))| Segment {
            ends: [*a, *b],
            contour: c as u32,
            number: i as u32,
        }));
    }
    let tree = Tree::build(&mut segments, |segment| segment.ends);
    check_meetings(contours, &segments, &tree)?;
    let mut edges = Vec::with_capacity(segments.len());
    for (c, points) in contours.iter().enumerate() {
        let inward = depth(points[0], c as u32, &segments, &tree) % 2 == 1;
        chain(points, anticlockwise(points) == inward, &mut edges);
    }
    Ok(edges)
}

fn check_points(c: usize, points: &[DVec2]) -> Result<(), ParamError> {
    if points.len() < 3 {
        return Err(ParamError::new(format_args!("number of points of contour {c}"), points.len() as f64, "3 or more"));
    }
    for (i, point) in points.iter().enumerate() {
        for (axis, v) in ["x", "y"].into_iter().zip(point.to_array()) {
            check::finite(&format!("contour {c}, point {i}, {axis}"), v)?;
        }
    }
    for (i, (a, b)) in points.iter().zip(points.iter().cycle().skip(1)).enumerate() {
        let length = (*b - *a).length();
        if length < SHORTEST {
            return Err(ParamError::new(
                format_args!("length of edge {i} of contour {c}, at ({}, {}),", a.x, a.y),
                length,
                "at least 1e-9",
            ));
        }
    }
    Ok(())
}

fn check_meetings(contours: &[Vec<DVec2>], segments: &[Segment], tree: &Tree) -> Result<(), ParamError> {
    for one in segments {
        let [a, b] = one.ends;
        let mut met = None;
        tree.meeting(a.min(b), a.max(b), |i| {
            let other = segments[i];
            // Each pair once, and errors in the order of the contours.
            if (other.contour, other.number) > (one.contour, one.number) {
                let count = contours[one.contour as usize].len() as u32;
                let meets = match neighbours(one, &other, count) {
                    Some([from, corner, to]) => folds_back(from, corner, to),
                    None => meet(one.ends, other.ends),
                };
                if meets {
                    met = Some(other);
                }
            }
            met.is_none()
        });
        if let Some(other) = met {
            let place = common_point(one.ends, other.ends);
            return Err(ParamError::new(
                format_args!(
                    "where edge {} of contour {} meets edge {} of contour {}, at ({}, {}), the distance from the \
                     first edge's start",
                    one.number, one.contour, other.number, other.contour, place.x, place.y
                ),
                (place - a).length(),
                "nowhere: contours neither cross nor touch themselves or one another",
            ));
        }
    }
    Ok(())
}

/// The corner that two edges of a contour of `count` points have in common, with the point
/// before it and the one after it.
fn neighbours(one: &Segment, other: &Segment, count: u32) -> Option<[DVec2; 3]> {
    if one.contour != other.contour {
        None
    } else if one.number + 1 == other.number {
        Some([one.ends[0], one.ends[1], other.ends[1]])
    } else if one.number == 0 && other.number + 1 == count {
        Some([other.ends[0], one.ends[0], one.ends[1]])
    } else {
        None
    }
}

/// The sign of the turn at `b`: positive to the left. Exact.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Whether an edge runs back along the one before it.
fn folds_back(from: DVec2, corner: DVec2, to: DVec2) -> bool {
    let axis = usize::from(from.x == corner.x);
    turn(from, corner, to) == 0.0 && (from[axis] > corner[axis]) == (to[axis] > corner[axis])
}

/// Whether two segments have a point in common.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let on = |p: DVec2, a: DVec2, b: DVec2| a.min(b).cmple(p).all() && p.cmple(a.max(b)).all();
    let (to_c, to_d, to_a, to_b) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    let apart = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    (apart(to_c, to_d) && apart(to_a, to_b))
        || (to_c == 0.0 && on(c, a, b))
        || (to_d == 0.0 && on(d, a, b))
        || (to_a == 0.0 && on(a, c, d))
        || (to_b == 0.0 && on(b, c, d))
}

/// A point that two segments have in common, to rounding: what an error shows.
fn common_point([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let (u, v) = (b - a, d - c);
    let t = (c - a).perp_dot(v) / u.perp_dot(v);
    if (0.0..=1.0).contains(&t) {
        return a + t * u;
    }
    // Parallel: they overlap, and one's end is on the other.
    let on = |p: DVec2| a.min(b).cmple(p).all() && p.cmple(a.max(b)).all();
    if on(c) {
        c
    } else if on(d) {
        d
    } else {
        a
    }
}

/// How many other contours go round the point `p` of contour number `own`.
fn depth(p: DVec2, own: u32, segments: &[Segment], tree: &Tree) -> usize {
    // Crossings of the ray along x; a contour that goes round has an odd number of them.
    let mut crossings: Vec<u32> = Vec::new();
    tree.meeting(p, DVec2::new(f64::INFINITY, p.y), |i| {
        let Segment { ends: [a, b], contour, .. } = segments[i];
        if contour != own && (a.y > p.y) != (b.y > p.y) && (turn(a, b, p) > 0.0) == (b.y > a.y) {
            crossings.push(contour);
        }
        true
    });
    crossings.sort_unstable();
    crossings.chunk_by(|a, b| a == b).filter(|of_one| of_one.len() % 2 == 1).count()
}

/// Which way round a contour goes, by the turn at its leftmost point.
fn anticlockwise(points: &[DVec2]) -> bool {
    let n = points.len();
    let leftmost = (0..n).min_by(|&i, &j| {
        let (a, b) = (points[i], points[j]);
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    let at = leftmost.unwrap_or(0);
    turn(points[(at + n - 1) % n], points[at], points[(at + 1) % n]) > 0.0
}

/// Appends the edges of a contour, the other way round if so wished.
fn chain(points: &[DVec2], reversed: bool, edges: &mut Vec<Edge>) {
    let n = points.len();
    let at = |i: usize| if reversed { points[(2 * n - 1 - i % n) % n] } else { points[i % n] };
    edges.extend((0..n).map(|i| Edge::new(at(i), at(i + 1))));
}
