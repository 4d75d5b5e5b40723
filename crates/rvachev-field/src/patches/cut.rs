//! What of a triangle is in a ball: how far it reaches along a direction.
//!
//! ```text
//!         /\           A part of a plane with straight sides and arcs: what is farthest is an end of what is
//!      .-/--\-.        left of a side, or the point of the disc's rim, if that is in the triangle.
//!     ( /    \ )
//!      '------'
//! ```

use glam::DVec3;

/// What of a triangle is in a ball about 0.
pub(super) struct Cut {
    corners: [DVec3; 3],
    /// Across the plane; 0 if the triangle has none.
    normal: DVec3,
    /// The disc that the ball cuts out of the plane.
    middle: DVec3,
    radius: f64,
    /// What is left of the sides, by their ends.
    ends: [[DVec3; 2]; 3],
    count: usize,
}

impl Cut {
    pub(super) fn new(corners: [DVec3; 3], reach: f64) -> Cut {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let middle = normal.dot(a) * normal;
        let radius = (reach * reach - middle.length_squared()).max(0.0).sqrt();
        let mut cut = Cut { corners, normal, middle, radius, ends: [[a; 2]; 3], count: 0 };
        for n in 0..3 {
            let (from, way) = (corners[n], corners[(n + 1) % 3] - corners[n]);
            // |from + s way| ≤ reach
            let (square, along, over) = (way.length_squared(), from.dot(way), from.length_squared() - reach * reach);
            let root = along * along - square * over;
            if root < 0.0 || square == 0.0 && over > 0.0 {
                continue;
            }
            let at = |sign: f64| if square > 0.0 { (sign * root.sqrt() - along) / square } else { 0.0 };
            let (low, high) = (at(-1.0).max(0.0), at(1.0).min(1.0));
            if low <= high {
                cut.ends[cut.count] = [from + low * way, from + high * way];
                cut.count += 1;
            }
        }
        cut
    }

    /// Whether a point of the plane is within the triangle.
    fn holds(&self, p: DVec3) -> bool {
        let [a, b, c] = self.corners;
        let beside = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(self.normal) >= 0.0;
        beside(a, b) && beside(b, c) && beside(c, a)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0 && !(self.normal != DVec3::ZERO && self.radius > 0.0 && self.holds(self.middle))
    }

    /// How far from a point it reaches.
    pub(super) fn farthest_from(&self, point: DVec3) -> f64 {
        let ends = self.ends[..self.count].as_flattened().iter();
        let by_sides = ends.fold(0.0f64, |most, end| most.max(end.distance(point)));
        // The point of the disc's rim that is farthest; any, if all are as far.
        if self.normal == DVec3::ZERO {
            return by_sides;
        }
        // On the disc's rim, if the farthest point of that is within the triangle; any is if the
        // point is above its middle.
        let aside = (self.middle - point).reject_from_normalized(self.normal).try_normalize();
        let rim = self.middle + self.radius * aside.unwrap_or_else(|| self.normal.any_orthonormal_vector());
        if self.holds(rim) { by_sides.max(rim.distance(point)) } else { by_sides }
    }

    /// How far it reaches along a direction, from 0.
    pub(super) fn farthest(&self, way: DVec3) -> f64 {
        let ends = self.ends[..self.count].as_flattened().iter();
        let by_sides = ends.fold(f64::NEG_INFINITY, |most, end| most.max(end.dot(way)));
        // On the disc's rim, if that is within the triangle there.
        let in_plane = (way - way.dot(self.normal) * self.normal).normalize_or_zero();
        let rim = self.middle + self.radius * in_plane;
        if self.holds(rim) { by_sides.max(rim.dot(way)) } else { by_sides }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reaches_as_far_as_its_points_do() {
        let mut state = 9u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let (mut empty, mut full) = (0, 0);
        for _ in 0..400 {
            let mut point = || DVec3::new(random(), random(), random());
            let (corners, way) = ([point(), point(), point()], point());
            let cut = Cut::new(corners, 0.6);
            const STEPS: usize = 200;
            let all = (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| [i, j].map(|k| k as f64 / STEPS as f64)));
            let [a, b, c] = corners;
            let inside = all.map(|[s, t]| a + s * (b - a) + t * (c - a)).filter(|p| p.length() <= 0.6);
            let farthest = inside.clone().map(|p| p.dot(way)).fold(f64::NEG_INFINITY, f64::max);
            if cut.is_empty() {
                assert_eq!(farthest, f64::NEG_INFINITY, "{corners:?}");
                empty += 1;
            } else if farthest > f64::NEG_INFINITY {
                let off = cut.farthest(way) - farthest;
                assert!(off > -1e-12 && off < 0.03, "{corners:?} {way} {off}");
                let distance = inside.clone().map(|p| p.distance(way)).fold(0.0, f64::max);
                let off = cut.farthest_from(way) - distance;
                assert!(off > -1e-12 && off < 0.03, "{corners:?} from {way} {off}");
                full += 1;
            }
        }
        assert!(empty > 50 && full > 100, "{empty} {full}");
    }
}
