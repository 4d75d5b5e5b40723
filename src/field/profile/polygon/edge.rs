//! An edge of a polygon: the signed distance to it, its sign right wherever no other edge is
//! nearer.
//!
//! ```text
//!     t = u·(p − a),  s = n·(p − a),  e = what t is beyond [0, L]       inside is on the left
//!     e = 0   f = s
//!     e ≠ 0   f = ±√(s² + e²), the sign that of min(s, s') at a convex corner and of
//!             max(s, s') at a reflex one, s' belonging to the edge beyond the corner
//! ```
//!
//! Both edges at a corner so give one sign where the corner is the nearest point, whichever
//! of the two wins by a rounding error. Where the turn is of more than a right angle the
//! corner's side is certain, and min and max, which lose it at needles, are left out.

use glam::DVec2;

use crate::{Norm, Real};

/// An edge with what it needs to know of the two next to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) start: DVec2,
    pub(super) end: DVec2,
    along: DVec2,
    length: f64,
    first: Corner,
    last: Corner,
}

/// The corner at an end: `side = turn·min(turn·s, normal·(p − a) + offset)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Corner {
    /// 1 at a convex corner, −1 at a reflex one.
    turn: f64,
    normal: DVec2,
    offset: f64,
}

impl Corner {
    /// The corner where an edge meets its neighbour. `convex` tells the turn exactly.
    fn new(along: DVec2, neighbour: DVec2, convex: bool, offset: f64) -> Corner {
        let turn = if convex { 1.0 } else { -1.0 };
        if along.dot(neighbour) < 0.0 {
            return Corner { turn, normal: DVec2::ZERO, offset: -1.0 };
        }
        let normal = turn * neighbour.perp();
        Corner { turn, normal, offset: normal.dot(along) * -offset }
    }

    #[inline(always)]
    fn side<R: Real>(&self, dx: R, dy: R, s: R) -> R {
        let other = dx.scale_add(self.normal.x, dy.scale_add(self.normal.y, s.lift(self.offset)));
        (s * self.turn).min(other) * self.turn
    }
}

impl Edge {
    /// The edge from `b` to `c` of the chain `a`, `b`, `c`, `d`, inside on its left; `turns`
    /// tells whether the corners at `b` and `c` are convex.
    pub(super) fn new([a, b, c, d]: [DVec2; 4], turns: [bool; 2]) -> Edge {
        let unit = |from: DVec2, to: DVec2| (to - from).normalize_or_zero();
        let (before, along, after) = (unit(a, b), unit(b, c), unit(c, d));
        let length = (c - b).length();
        Edge {
            start: b,
            end: c,
            along,
            length,
            first: Corner::new(along, before, turns[0], 0.0),
            last: Corner::new(along, after, turns[1], length),
        }
    }

    /// The distance to the edge, with its sign.
    #[inline(always)]
    pub(super) fn signed<R: Real>(&self, x: R, y: R) -> R {
        let zero = x.lift(0.0);
        let (dx, dy) = (x - self.start.x, y - self.start.y);
        let t = dx.scale_add(self.along.x, dy * self.along.y);
        let s = dx.scale_add(-self.along.y, dy * self.along.x);
        let e = (t - self.length).max(zero) + t.min(zero);
        let side = t.select(self.last.side(dx, dy, s), self.first.side(dx, dy, s));
        let distance = s.norm(e, Norm::Euclid);
        (-e.abs()).select(s, side.select(distance, -distance))
    }

    /// The point of the edge that is nearest to `p`.
    pub(super) fn nearest(&self, p: DVec2) -> DVec2 {
        self.start + (p - self.start).dot(self.along).clamp(0.0, self.length) * self.along
    }

    /// The distance from `p`.
    pub(super) fn distance(&self, p: DVec2) -> f64 {
        (p - self.nearest(p)).length()
    }
}
