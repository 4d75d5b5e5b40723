//! How far two triangles are apart.
//!
//! ```text
//!       /\            Two triangles that have no point in common are nearest to each other at a corner
//!      /  \   ____    of one and anywhere on the other, or at two sides. They have one if a side of
//!     /____\ |   /    one goes through the other.
//!            |_/
//! ```

use glam::DVec3;

use super::closest::on_face;

/// Sides whose sine is less are parallel: then corners tell.
const PARALLEL: f64 = 1e-9;

/// The square of how far two triangles are apart, and the point of the first that is nearest.
pub(super) fn nearest(one: [DVec3; 3], other: [DVec3; 3]) -> (f64, DVec3) {
    let mut best = (f64::INFINITY, one[0]);
    let mut take = |square: f64, point: DVec3| {
        if square < best.0 {
            best = (square, point);
        }
    };
    for k in 0..3 {
        let (square, _) = from_corner(one[k], other);
        take(square, one[k]);
        let (square, [s, t]) = from_corner(other[k], one);
        take(square, one[0] + s * (one[1] - one[0]) + t * (one[2] - one[0]));
        let (a, u) = (one[k], one[(k + 1) % 3] - one[k]);
        for i in 0..3 {
            let (b, v) = (other[i], other[(i + 1) % 3] - other[i]);
            let (square, s) = between(a, u, b, v);
            take(square, a + s * u);
        }
    }
    for k in 0..3 {
        if let Some(p) = pierced(one[k], one[(k + 1) % 3], other) {
            return (0.0, p);
        }
        if let Some(p) = pierced(other[k], other[(k + 1) % 3], one) {
            return (0.0, p);
        }
    }
    best
}

/// The square of how far a point is from a triangle, and where that is nearest.
pub(super) fn from_corner(p: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, [f64; 2]) {
    let found = on_face([(b - a).to_array(), (c - a).to_array()], (p - a).to_array()).closest;
    (found.square, found.coordinates)
}

/// The square of how far two segments `a + s u` and `b + t v` are apart, and s.
fn between(a: DVec3, u: DVec3, b: DVec3, v: DVec3) -> (f64, f64) {
    let w = a - b;
    let [uu, vv, uv, uw, vw] = [u.dot(u), v.dot(v), u.dot(v), u.dot(w), v.dot(w)];
    let over = |x: f64, y: f64| if y > 0.0 { (x / y).clamp(0.0, 1.0) } else { 0.0 };
    let det = uu * vv - uv * uv;
    let s = if det > PARALLEL * PARALLEL * uu * vv { over(uv * vw - vv * uw, det) } else { 0.0 };
    let t = over(uv * s + vw, vv);
    let s = over(uv * t - uw, uu);
    ((w + s * u - t * v).length_squared(), s)
}

/// Where a segment goes through a triangle.
fn pierced(p: DVec3, q: DVec3, [a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (e, f) = (b - a, c - a);
    let n = e.cross(f);
    let (before, behind) = (n.dot(p - a), n.dot(q - a));
    if before * behind >= 0.0 {
        return None;
    }
    let x = p + before / (before - behind) * (q - p);
    let r = x - a;
    let (s, t) = (n.dot(r.cross(f)), n.dot(e.cross(r)));
    (s >= 0.0 && t >= 0.0 && s + t <= n.dot(n)).then_some(x)
}

#[cfg(test)]
mod tests {
    use rvachev_num::Run;

    use super::super::{Patch, Patches};
    use super::*;

    /// Numbers between −1 and 1.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }

        fn triangle(&mut self, size: f64) -> [DVec3; 3] {
            let at = DVec3::new(self.next(), self.next(), self.next());
            [0; 3].map(|_| at + size * DVec3::new(self.next(), self.next(), self.next()))
        }
    }

    #[test]
    fn triangles_are_as_near_as_their_points_are() {
        let mut numbers = Numbers(7);
        let (mut through, mut apart) = (0, 0);
        for round in 0..60 {
            let size = [0.05, 0.3, 1.0][round % 3];
            let others: Vec<[DVec3; 3]> = (0..40).map(|_| numbers.triangle(size)).collect();
            let flat: Vec<Patch> = others.iter().map(|other| Patch::flat(*other)).collect();
            let patches = Patches::new(&flat, &Run::default()).unwrap();
            let own = numbers.triangle(size);
            let least = others.iter().map(|other| nearest(own, *other));
            let (square, point) = least.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            let distance = square.sqrt();
            for (part, beyond) in [(0.999, true), (1.001, false)] {
                let told = patches.is_beyond(own, part * distance + 1e-9);
                assert!(distance == 0.0 || told == beyond, "{round}: {distance}");
            }
            assert!((patches.nearest(point).unwrap().distance - distance).abs() < 1e-6, "{distance}");
            // No point of it is nearer, and about the nearest one it is as near as is said.
            const STEPS: usize = 40;
            for i in 0..=STEPS {
                for j in 0..=STEPS - i {
                    let [s, t] = [i, j].map(|k| k as f64 / STEPS as f64);
                    let p = own[0] + s * (own[1] - own[0]) + t * (own[2] - own[0]);
                    assert!(patches.nearest(p).unwrap().distance >= distance - 1e-6, "{round}: {distance}");
                }
            }
            *(if distance > 0.0 { &mut apart } else { &mut through }) += 1;
        }
        assert!(through > 10 && apart > 10, "{through} {apart}");
        assert!(Patches::new(&[], &Run::default()).unwrap().is_beyond([DVec3::ZERO; 3], 1.0));
    }
}
