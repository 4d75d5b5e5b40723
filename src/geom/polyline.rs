//! Chains of points in a plane.

use glam::DVec2;

/// A chain of points in a plane, open or closed: the contour of a slice, for instance.
///
/// ```
/// use glam::DVec2;
/// use rvachev::Polyline;
///
/// let square = Polyline::closed(vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]);
/// assert_eq!((square.length(), square.area()), (4.0, 1.0));
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Polyline {
    points: Vec<DVec2>,
    closed: bool,
}

impl Polyline {
    /// From the first point to the last.
    #[must_use]
    pub fn open(points: Vec<DVec2>) -> Polyline {
        Polyline { points, closed: false }
    }

    /// From the first point to the last, and back to the first, which is given once.
    #[must_use]
    pub fn closed(points: Vec<DVec2>) -> Polyline {
        Polyline { points, closed: true }
    }

    /// The points, in order.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Whether the last point is joined to the first.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Its edges, from point to point.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let count = if self.closed { self.points.len() } else { self.points.len().saturating_sub(1) };
        (0..count).map(|i| [self.points[i], self.points[(i + 1) % self.points.len()]])
    }

    /// The sum of the lengths of its edges.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.edges().map(|[a, b]| a.distance(b)).sum()
    }

    /// The area it encloses: positive if it runs anticlockwise. An open one is closed first.
    #[must_use]
    pub fn area(&self) -> f64 {
        let Some(&first) = self.points.first() else { return 0.0 };
        // About the first point, so that a far origin costs no digits.
        self.edges().map(|[a, b]| (a - first).perp_dot(b - first)).sum::<f64>() / 2.0
    }

    /// Whether a point is within it, by the even-odd rule. An open one is closed first.
    pub(crate) fn winds_about(&self, p: DVec2) -> bool {
        let Some(&last) = self.points.last() else { return false };
        let mut inside = false;
        let mut a = last;
        for &b in &self.points {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
            a = b;
        }
        inside
    }
}
