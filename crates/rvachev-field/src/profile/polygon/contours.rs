//! From contours to edges: what is wrong with them, and on which side of each it is inside.

use glam::DVec2;
use rvachev_num::{Cancelled, Run};

use super::super::super::check;
use super::Edge;
use super::snap::{Way, joined, led, rounding};
use super::sweep::{Piece, Swept, from_left, sweep};
use crate::ParamError;

/// The shortest edge.
const SHORTEST: f64 = 1e-9;

/// Coordinates that are smaller are taken as 0: products of them would be below what numbers can
/// hold.
const NOTHING: f64 = 1e-30;

/// The edges of the contours, inside on their left; or what is wrong with them.
pub(super) fn edges(contours: &[Vec<DVec2>], run: &Run) -> Result<Result<Vec<Edge>, ParamError>, Cancelled> {
    if contours.is_empty() {
        return Ok(Err(ParamError::new("number of contours", 0.0, "1 or more")));
    }
    let rounding = rounding(contours);
    for (c, points) in contours.iter().enumerate() {
        run.check()?;
        if let Err(error) = check_points(c, points, rounding) {
            return Ok(Err(error));
        }
    }
    let given = Given::new(contours, rounding, run)?;
    let ways = led(&given.corners, given.ways(), rounding, run)?;
    Ok(match sweep(&given.corners, pieces(&ways), run)? {
        Swept::Pieces(pieces) => given.parted(pieces),
        Swept::Cross(edges) => Err(given.crossing(edges)),
    })
}

fn check_points(c: usize, points: &[DVec2], rounding: f64) -> Result<(), ParamError> {
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
        if length > rounding && length < SHORTEST {
            return Err(ParamError::new(
                format_args!("length of edge {i} of contour {c}, at ({}, {}),", a.x, a.y),
                length,
                "at least 1e-9",
            ));
        }
    }
    Ok(())
}

/// The ways by their ends from left to right; what has no length is nothing.
fn pieces(ways: &[Way]) -> Vec<Piece> {
    let piece = |([from, to], edge): &Way| Piece { left: *from.min(to), right: *from.max(to), edge: *edge };
    ways.iter().filter(|([from, to], _)| from != to).map(piece).collect()
}

/// The contours by their corners, each point once.
struct Given<'a> {
    contours: &'a [Vec<DVec2>],
    /// From left to right.
    corners: Vec<DVec2>,
    /// The corners that the edges lead from and to.
    ends: Vec<[u32; 2]>,
}

impl<'a> Given<'a> {
    fn new(contours: &'a [Vec<DVec2>], rounding: f64, run: &Run) -> Result<Given<'a>, Cancelled> {
        let near_zero = |v: f64| if v.abs() < NOTHING { 0.0 } else { v };
        let points = contours.iter().flatten().map(|p| DVec2::new(near_zero(p.x), near_zero(p.y)));
        let mut order: Vec<(DVec2, u32)> = points.zip(0..).collect();
        run.check()?;
        order.sort_unstable_by(|a, b| from_left(&a.0, &b.0).then(a.1.cmp(&b.1)));
        run.check()?;
        let (corners, stands) = joined(order.iter().map(|(point, _)| *point), rounding);
        let mut corner_of = vec![0; order.len()];
        for ((_, at), corner) in order.into_iter().zip(stands) {
            corner_of[at as usize] = corner;
        }
        let mut ends = Vec::with_capacity(corner_of.len());
        let mut rest = &corner_of[..];
        for points in contours {
            let (of_one, others) = rest.split_at(points.len());
            ends.extend(of_one.iter().zip(of_one.iter().cycle().skip(1)).map(|(from, to)| [*from, *to]));
            rest = others;
        }
        run.check()?;
        Ok(Given { contours, corners, ends })
    }

    fn ways(&self) -> Vec<Way> {
        self.ends.iter().copied().zip(0..).filter(|([from, to], _)| from != to).collect()
    }

    /// The contour of an edge, and its number there.
    fn place(&self, edge: u32) -> (usize, usize) {
        let mut number = edge as usize;
        for (c, points) in self.contours.iter().enumerate() {
            if number < points.len() {
                return (c, number);
            }
            number -= points.len();
        }
        (self.contours.len(), 0)
    }

    /// The edges that are left, in the order of the contours.
    fn parted(&self, mut pieces: Vec<(Piece, bool)>) -> Result<Vec<Edge>, ParamError> {
        let is_forward = |piece: &Piece| self.ends[piece.edge as usize][0] < self.ends[piece.edge as usize][1];
        pieces.sort_unstable_by_key(|(piece, _)| {
            (piece.edge, if is_forward(piece) { piece.left } else { u32::MAX - piece.left })
        });
        if pieces.is_empty() {
            let allowed = "more than 0: every edge lies on another one, and by the even-odd rule nothing is left";
            return Err(ParamError::new("area", 0.0, allowed));
        }
        let mut edges = Vec::with_capacity(pieces.len());
        for (piece, is_inside_above) in pieces {
            let [left, right] = [piece.left, piece.right].map(|corner| self.corners[corner as usize]);
            let length = (right - left).length();
            if length < SHORTEST {
                let (c, number) = self.place(piece.edge);
                return Err(ParamError::new(
                    format_args!(
                        "length of a part of edge {number} of contour {c}, which a corner parts at ({}, {}),",
                        left.x, left.y
                    ),
                    length,
                    "at least 1e-9",
                ));
            }
            edges.push(if is_inside_above { Edge::new(left, right) } else { Edge::new(right, left) });
        }
        Ok(edges)
    }

    fn crossing(&self, edges: [u32; 2]) -> ParamError {
        let [(c, i), (d, j)] = edges.map(|edge| self.place(edge));
        let [[from, to], other] = edges.map(|edge| self.ends[edge as usize].map(|end| self.corners[end as usize]));
        let (u, v) = (to - from, other[1] - other[0]);
        let along = (other[0] - from).perp_dot(v) / u.perp_dot(v);
        let place = from + along * u;
        ParamError::new(
            format_args!(
                "where edge {i} of contour {c} crosses edge {j} of contour {d}, at ({}, {}), the distance from the \
                 first edge's start",
                place.x, place.y
            ),
            (place - from).length(),
            "nowhere: edges may touch, but not cross",
        )
    }
}
