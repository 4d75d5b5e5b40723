//! A zone as the plane sees it, and the distances of edges over it.

use glam::DVec2;

use super::super::super::Zone;
use super::Edge;
use crate::Interval;

/// What of a zone lies in the plane: `{ c + Σ uᵢ aᵢ + s∘v }`, each of u and v within ±1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub(super) centre: DVec2,
    axes: [DVec2; 3],
    slack: DVec2,
    /// No point of it is farther than this from the centre.
    pub(super) radius: f64,
}

impl Patch {
    /// The zone, or its hull where that is smaller; `None` if it is infinite.
    pub(super) fn of_zone(zone: &Zone) -> Option<Patch> {
        let [x, y, _] = zone.hull();
        let hull = Patch::of_box(x, y);
        let own = zone.is_finite().then(|| {
            let axes = [zone.axes.x_axis, zone.axes.y_axis, zone.axes.z_axis].map(|a| a.truncate());
            Patch::new(zone.centre.truncate(), axes, zone.slack.truncate())
        });
        match (own, hull) {
            (Some(own), Some(hull)) => Some(if hull.radius < own.radius { hull } else { own }),
            (own, hull) => own.or(hull),
        }
    }

    /// A box of the plane.
    pub(super) fn of_box(x: Interval, y: Interval) -> Option<Patch> {
        let finite = x.magnitude() < f64::INFINITY && y.magnitude() < f64::INFINITY;
        let half = |side: Interval| 0.5 * side.width() + 4.0 * f64::EPSILON * side.magnitude();
        finite.then(|| {
            let axes = [DVec2::X * half(x), DVec2::Y * half(y), DVec2::ZERO];
            Patch::new(DVec2::new(x.mid(), y.mid()), axes, DVec2::ZERO)
        })
    }

    fn new(centre: DVec2, axes: [DVec2; 3], slack: DVec2) -> Patch {
        let mut patch = Patch { centre, axes, slack, radius: 0.0 };
        let farthest = patch.corners().map(|corner| (corner - centre).length()).into_iter().fold(0.0, f64::max);
        patch.radius = (farthest + slack.length()) * (1.0 + 1e-12);
        patch
    }

    /// The corners of the parallelepiped (without the slack).
    fn corners(&self) -> [DVec2; 8] {
        std::array::from_fn(|corner| {
            let sign = |bit: usize| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let [a, b, c] = self.axes;
            self.centre + sign(0) * a + sign(1) * b + sign(2) * c
        })
    }

    /// Some points of it, in general position.
    pub(super) fn inner_points(&self) -> [DVec2; 9] {
        let [a, b, c] = self.axes;
        std::array::from_fn(|i| {
            // Steps of three irrational numbers, within ±0.8.
            let part = |step: f64| 1.6 * ((i as f64 * step).fract() - 0.5);
            let inside = part(0.754_877_666) * a + part(0.569_840_291) * b + part(0.381_966_011) * c;
            if i == 0 { self.centre } else { self.centre + inside }
        })
    }

    /// Bounds from below and above on the distance of `edge`, which is a convex function: its
    /// tangent at the centre, and the largest of its values at the corners.
    pub(super) fn distances(&self, edge: &Edge) -> (f64, f64) {
        let away = self.centre - edge.nearest(self.centre);
        let distance = away.length();
        let slope = away.normalize_or_zero();
        let fall = self.axes.iter().map(|axis| axis.dot(slope).abs()).sum::<f64>() + slope.abs().dot(self.slack);
        let most = self.corners().map(|corner| edge.distance(corner)).into_iter().fold(0.0, f64::max);
        (distance - fall * (1.0 + 1e-12), most + self.slack.length())
    }

    /// The range of the signed distance, which is `value` at the centre; `edges` are those
    /// that may be nearest, and everything is known to `rounding`.
    pub(super) fn range<'a>(&self, value: f64, edges: impl Iterator<Item = &'a Edge>, rounding: f64) -> Interval {
        let (mut least, mut most) = (f64::INFINITY, f64::INFINITY);
        for edge in edges {
            let (low, high) = self.distances(edge);
            least = least.min(low - rounding);
            most = most.min(high + rounding);
        }
        let by_slope = Interval::around(value, self.radius + rounding);
        if least <= 0.0 {
            return by_slope.narrowed_by(Interval::new(-most, most));
        }
        // No edge meets the patch: one sign throughout.
        let by_edges = if value > 0.0 { Interval::new(least, most) } else { Interval::new(-most, -least) };
        by_slope.narrowed_by(by_edges)
    }
}
