//! How far a triangle is from all patches, where these are flat.
//!
//! ```text
//!       /\            Two triangles that have no point in common are nearest to each other at a corner
//!      /  \   ____    of one and anywhere on the other, or at two sides. They have one if a side of
//!     /____\ |   /    one goes through the other.
//!            |_/
//! ```
//!
//! To look at two triangles takes long, and where surfaces run beside each other many are about as
//! near as the nearest. Most are left out as they are seen along the way to a near point:
//!
//! ```text
//!         ---T---          What is below T by g along a way, and aside of it by l across that way,
//!       g |                is no nearer than √(g² + l²), however the axes lie.
//!         '   l  --S--
//! ```

use glam::DVec3;

use super::Patches;
use super::closest::on_face;
use super::face::double;
use super::hierarchy::{DEEPEST, PARENT};

/// Distances in the patches' frame, of coordinates of 2 at most, are off by less.
const ROUNDING: f64 = 1e-12;

/// Triangles with a corner whose sine is less have no plane.
const SLIM: f64 = 1e-3;

/// Sides whose sine is less are parallel: then corners tell.
const PARALLEL: f64 = 1e-9;

/// Where a triangle is nearest to patches.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// How far it is there, in length units; 0 if it goes through one.
    pub distance: f64,
    /// The point of the triangle.
    pub point: DVec3,
}

impl Patches {
    /// Where a triangle is nearest to the patches; nothing if some of them are curved, or there are
    /// none.
    pub fn approach(&self, triangle: [DVec3; 3]) -> Option<Approach> {
        self.approach_within(triangle, f64::INFINITY)
    }

    /// The same if that is within a length.
    pub fn approach_within(&self, triangle: [DVec3; 3], length: f64) -> Option<Approach> {
        if self.is_empty() || !self.is_flat() {
            return None;
        }
        let middle = self.frame.into_local(triangle.iter().sum::<DVec3>() / 3.0);
        let at = self.search_one(middle.to_array()).which as usize;
        let [s, t] = self.closest(at, middle.to_array()).coordinates;
        let foot = self.point_and_normal(at, s, t).0;
        self.approached(triangle, length, Some((middle, foot)))
    }

    /// Whether no point of a triangle is within a length of the patches; nothing if some of them
    /// are curved.
    pub fn is_beyond(&self, triangle: [DVec3; 3], length: f64) -> Option<bool> {
        if !self.quadratics.is_empty() {
            return None;
        }
        Some(self.approached(triangle, length, None).is_none())
    }

    /// Where a triangle is nearest to the patches, if that is within a length, given its middle and
    /// the point of the patches that is nearest to that.
    fn approached(&self, triangle: [DVec3; 3], length: f64, near: Option<(DVec3, DVec3)>) -> Option<Approach> {
        if self.is_empty() || !self.quadratics.is_empty() {
            return None;
        }
        let most = (length.max(0.0) / self.frame.unit).powi(2);
        let own = triangle.map(|p| self.frame.into_local(p));
        let (low, high) = hull(own);
        let gap = |from: DVec3, to: DVec3| (from - high).max(low - to).max(DVec3::ZERO).length_squared();
        let (mut least, mut point) = (most, own[0]);
        let mut way = (own[1] - own[0]).cross(own[2] - own[0]);
        if let Some((middle, foot)) = near {
            let away = middle - foot;
            if away.length_squared() < least {
                (least, point) = (away.length_squared(), middle);
            }
            // Nearer than this it is rounding.
            way = if away.length_squared() > PARALLEL * PARALLEL { away } else { way };
        }
        let along = Along::new(way.normalize_or_zero(), own);
        let of_node = |at: u32, least: f64| {
            let node = &self.nodes[at as usize];
            let (from, to) = (double(node.low), double(node.high));
            let by_box = gap(from, to);
            if by_box >= least { by_box } else { by_box.max(along.gap(from, to, along.of_box(from, to))) }
        };
        let mut stack = [(0, 0.0); DEEPEST + 1];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, away) = stack[height];
            if away >= least {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count >= PARENT {
                let both = [node.first, node.first + 1].map(|at| (at, of_node(at, least)));
                let [far, near] = if both[0].1 < both[1].1 { [both[1], both[0]] } else { both };
                (stack[height], stack[height + 1]) = (far, near);
                height += 2;
                continue;
            }
            for at in node.first..node.first + node.count {
                let Some((face, sides)) = self.at(at as usize) else { continue };
                let [a, e, f] = [face.a, sides.e, sides.f].map(double);
                let other = [a, a + e, a + f];
                let (from, to) = hull(other);
                let is_near = gap(from, to) < least
                    && along.gap(from, to, along.of(other)) < least
                    && off_plane(own, other) < least
                    && off_plane(other, own) < least;
                if is_near {
                    let found = nearest(own, other);
                    if found.0 < least {
                        (least, point) = found;
                    }
                }
            }
        }
        let found = Approach { distance: least.sqrt() * self.frame.unit, point: self.frame.outward(point) };
        (least < most).then_some(found)
    }
}

/// A triangle as it is seen along a way.
struct Along {
    /// A unit vector, or 0.
    way: DVec3,
    span: [f64; 2],
    /// A ball about the triangle.
    middle: DVec3,
    radius: f64,
}

impl Along {
    fn new(way: DVec3, own: [DVec3; 3]) -> Along {
        let (low, high) = hull(own);
        let whole = Along { way, span: [0.0; 2], middle: 0.5 * (low + high), radius: 0.5 * (high - low).length() };
        Along { span: whole.of(own), ..whole }
    }

    /// From where to where a triangle is.
    fn of(&self, corners: [DVec3; 3]) -> [f64; 2] {
        let [a, b, c] = corners.map(|p| self.way.dot(p));
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// From where to where a box is.
    fn of_box(&self, low: DVec3, high: DVec3) -> [f64; 2] {
        let (middle, half) = (self.way.dot(0.5 * (low + high)), self.way.abs().dot(0.5 * (high - low)));
        [middle - half, middle + half]
    }

    /// The square of how far what is in a box, and there along the way, is at least.
    fn gap(&self, low: DVec3, high: DVec3, [from, to]: [f64; 2]) -> f64 {
        let along = (self.span[0] - to).max(from - self.span[1]) - ROUNDING;
        let away = 0.5 * (low + high) - self.middle;
        let across = (away - away.dot(self.way) * self.way).length();
        let aside = across - 0.5 * (high - low).length() - self.radius - ROUNDING;
        along.max(0.0).powi(2) + aside.max(0.0).powi(2)
    }
}

fn hull([a, b, c]: [DVec3; 3]) -> (DVec3, DVec3) {
    (a.min(b).min(c), a.max(b).max(c))
}

/// The square of how far a triangle is from the plane of another at least.
fn off_plane(own: [DVec3; 3], [a, b, c]: [DVec3; 3]) -> f64 {
    let (e, f) = (b - a, c - a);
    let normal = e.cross(f);
    let square = normal.length_squared();
    if square <= SLIM * SLIM * e.length_squared() * f.length_squared() {
        return 0.0;
    }
    let [p, q, r] = own.map(|p| normal.dot(p - a));
    let off = p.min(q).min(r).max(-p.max(q).max(r)) / square.sqrt() - ROUNDING;
    off.max(0.0).powi(2)
}

/// The square of how far two triangles are apart, and the point of the first that is nearest.
fn nearest(one: [DVec3; 3], other: [DVec3; 3]) -> (f64, DVec3) {
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
fn from_corner(p: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, [f64; 2]) {
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

    use super::super::Patch;
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

    /// The triangles of a bowl over a square.
    fn bowl() -> Vec<[DVec3; 3]> {
        const STEPS: usize = 12;
        let at = |i: usize, j: usize| {
            let [x, y] = [i, j].map(|k| k as f64 / STEPS as f64 - 0.5);
            DVec3::new(x, y, 0.4 * (x * x + y * y))
        };
        let two = |k: usize| {
            let (i, j) = (k % STEPS, k / STEPS);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        (0..STEPS * STEPS).flat_map(two).collect()
    }

    #[test]
    fn of_surfaces_beside_each_other_the_nearest_triangles_are_found() {
        let own = bowl();
        let patches = Patches::new(&own.iter().map(|own| Patch::flat(*own)).collect::<Vec<_>>(), &Run::default());
        let patches = patches.unwrap();
        let mut numbers = Numbers(3);
        // From above, from below, and where both pass each other.
        for up in [0.1, 0.01, 0.001, 0.0, -0.05] {
            for [a, b, c] in own.iter().step_by(5) {
                let by = up * DVec3::Z + 1e-3 * DVec3::new(numbers.next(), numbers.next(), numbers.next());
                let moved = [*a + by, *b + 1.01 * by, *c + by];
                let brute = own.iter().map(|other| nearest(moved, *other).0).fold(f64::INFINITY, f64::min).sqrt();
                let found = patches.approach(moved).unwrap();
                assert!((found.distance - brute).abs() < 1e-6, "{found:?} {brute} {up}");
                assert_eq!(patches.approach_within(moved, 0.99 * brute - 1e-6).map(|found| found.distance), None);
                assert!(patches.approach_within(moved, 1.01 * brute + 1e-6).is_some(), "{brute} {up}");
            }
        }
    }

    #[test]
    fn triangles_are_as_near_as_their_points_are() {
        let mut numbers = Numbers(7);
        let (mut through, mut apart) = (0, 0);
        for round in 0..60 {
            let size = [0.05, 0.3, 1.0][round % 3];
            let others: Vec<Patch> = (0..40).map(|_| Patch::flat(numbers.triangle(size))).collect();
            let patches = Patches::new(&others, &Run::default()).unwrap();
            let own = numbers.triangle(size);
            let found = patches.approach(own).unwrap();
            for (part, beyond) in [(0.999, true), (1.001, false)] {
                let told = patches.is_beyond(own, part * found.distance + 1e-9);
                assert!(found.distance == 0.0 || told == Some(beyond), "{round}: {found:?}");
            }
            assert!((patches.nearest(found.point).unwrap().distance - found.distance).abs() < 1e-6, "{found:?}");
            // No point of it is nearer, and about the nearest one it is as near as is said.
            const STEPS: usize = 40;
            for i in 0..=STEPS {
                for j in 0..=STEPS - i {
                    let [s, t] = [i, j].map(|k| k as f64 / STEPS as f64);
                    let p = own[0] + s * (own[1] - own[0]) + t * (own[2] - own[0]);
                    assert!(patches.nearest(p).unwrap().distance >= found.distance - 1e-6, "{round}: {found:?}");
                }
            }
            *(if found.distance > 0.0 { &mut apart } else { &mut through }) += 1;
        }
        assert!(through > 10 && apart > 10, "{through} {apart}");
        assert!(Patches::new(&[], &Run::default()).unwrap().approach([DVec3::ZERO; 3]).is_none());
    }
}
