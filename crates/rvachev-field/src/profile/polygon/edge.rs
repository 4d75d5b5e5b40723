//! An edge of a polygon.
//!
//! ```text
//!     t = u·(p − a),  s = n·(p − a),  e = what t is beyond [0, L]       inside is on the left
//!     distance = √(s² + e²)
//! ```

use glam::DVec2;

use crate::{Euclid, Real};

/// A segment with its direction; the inside of the polygon is on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) start: DVec2,
    pub(super) end: DVec2,
    pub(super) along: DVec2,
    length: f64,
}

impl Edge {
    pub(super) fn new(start: DVec2, end: DVec2) -> Edge {
        Edge { start, end, along: (end - start).normalize_or_zero(), length: (end - start).length() }
    }

    /// The distance to the edge, and that to its line, positive on its left.
    #[inline(always)]
    pub(super) fn distances<R: Real>(&self, x: R, y: R) -> (R, R) {
        let zero = x.lift(0.0);
        let (dx, dy) = (x - self.start.x, y - self.start.y);
        let t = dx.scale_add(self.along.x, dy * self.along.y);
        let s = dx.scale_add(-self.along.y, dy * self.along.x);
        let e = (t - self.length).max(zero) - t.min(zero);
        // Where the foot is on the edge, s itself: its slope is known even on the edge.
        ((-e).select(s.abs(), s.norm_as(e, Euclid)), s)
    }

    /// The point of the edge that is nearest to `p`.
    pub(super) fn nearest(&self, p: DVec2) -> DVec2 {
        self.start + (p - self.start).dot(self.along).clamp(0.0, self.length) * self.along
    }

    /// The distance from `p`.
    pub(super) fn distance(&self, p: DVec2) -> f64 {
        (p - self.nearest(p)).length()
    }

    /// The point half way.
    pub(super) fn middle(&self) -> DVec2 {
        0.5 * (self.start + self.end)
    }

    /// Its ends, the lower one first.
    pub(super) fn rising(&self) -> [DVec2; 2] {
        if self.start.y < self.end.y { [self.start, self.end] } else { [self.end, self.start] }
    }
}
