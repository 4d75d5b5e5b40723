//! The point of a box that fits a set of planes best.
//!
//! ```text
//!     ----o-------x        minimise  Σ (nᵢ·y − dᵢ)² + λ n |y − s|²   over low ≤ y ≤ high
//!                  \
//!                   o      o  a point of the surface, with its tangent plane nᵢ·y = dᵢ
//!                    \     x  where the planes meet: on the crease, or in the corner
//! ```
//!
//! The second term holds the point where the planes leave it free: along a crease, and within the
//! surface where there is only one plane. The planes may have weights; n is their sum, the number of
//! the planes without. A step from s to the minimum is a damped Gauss–Newton step; repeated, it takes
//! the point to the planes and hardly along them.
//!
//! The minimum over the box is exact: the function is strictly convex, so it is the best of the
//! minima over the inside, the faces, the edges and the corners that lie in the box. Where the
//! planes meet outside, the point slides along the crease first and leaves it only if the crease
//! misses the box.
//!
//! Source: T. Ju, F. Losasso, S. Schaefer and J. Warren, Dual contouring of Hermite data (2002),
//! for the quadratic; K. Levenberg (1944) for the damping.

use glam::{DMat3, DVec3};

/// Planes that a point should be on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    /// Σ n nᵀ: what is on the diagonal, and what is opposite to each of these, at yz, zx and xy.
    diagonal: DVec3,
    beside: DVec3,
    /// Σ d n
    vector: DVec3,
    /// Σ d²
    square: f64,
    /// Σ 1; each of the sums has the weights of the planes, 1 unless said.
    weight: f64,
}

impl Planes {
    /// No planes.
    pub(super) const NONE: Planes =
        Planes { diagonal: DVec3::ZERO, beside: DVec3::ZERO, vector: DVec3::ZERO, square: 0.0, weight: 0.0 };

    /// Adds the plane nᵢ·y = dᵢ; the normal is a unit vector.
    #[inline(always)]
    pub(super) fn add(&mut self, normal: DVec3, d: f64) {
        let DVec3 { x, y, z } = normal;
        self.diagonal += normal * normal;
        self.beside += DVec3::new(y * z, z * x, x * y);
        self.vector += normal * d;
        self.square += d * d;
        self.weight += 1.0;
    }

    /// Adds the planes of another set, each with a weight.
    pub(super) fn append(&mut self, other: &Planes, weight: f64) {
        self.diagonal += weight * other.diagonal;
        self.beside += weight * other.beside;
        self.vector += weight * other.vector;
        self.square += weight * other.square;
        self.weight += weight * other.weight;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.weight == 0.0
    }

    /// The sum of the weights; 1 without planes.
    fn total(&self) -> f64 {
        if self.is_empty() { 1.0 } else { self.weight }
    }

    /// The root of the mean square distance of a point from the planes.
    pub(super) fn distance(&self, y: DVec3) -> f64 {
        let along = product(self.diagonal, self.beside, y);
        let sum = y.dot(along) - 2.0 * self.vector.dot(y) + self.square;
        (sum.max(0.0) / self.total()).sqrt()
    }

    /// The point of the box from `low` to `high` that is best, with damping λ towards `from`.
    #[inline]
    pub(super) fn nearest(&self, from: DVec3, damping: f64, low: DVec3, high: DVec3) -> DVec3 {
        let weight = damping * self.total();
        let b = self.vector + weight * from;
        // Cramer's rule.
        let (d, e) = (self.diagonal + weight, self.beside);
        let diagonal = DVec3::new(d.y * d.z - e.x * e.x, d.z * d.x - e.y * e.y, d.x * d.y - e.z * e.z);
        let beside = DVec3::new(e.y * e.z - d.x * e.x, e.z * e.x - d.y * e.y, e.x * e.y - d.z * e.z);
        let determinant = d.x * diagonal.x + e.z * beside.z + e.y * beside.y;
        let free = product(diagonal, beside, b) * determinant.recip();
        let is_within = |y: DVec3| y.cmpge(low).all() && y.cmple(high).all();
        if is_within(free) { free } else { self.nearest_on_sides(free, from, weight, low, high) }
    }

    /// The same where the point that is best of all is not in the box.
    #[cold]
    fn nearest_on_sides(&self, free: DVec3, from: DVec3, weight: f64, low: DVec3, high: DVec3) -> DVec3 {
        let (m, b) = (self.matrix(weight), self.vector + weight * from);
        // Most often it is where the coordinates that are beyond a side are held there.
        let mut sides = [FREE; 3];
        let mut y = free;
        for _ in 0..3 {
            for axis in 0..3 {
                if y[axis] < low[axis] {
                    sides[axis] = LOW;
                } else if y[axis] > high[axis] {
                    sides[axis] = HIGH;
                }
            }
            y = on_sides(&m, b, sides, low, high);
            if y.cmpge(low).all() && y.cmple(high).all() {
                if is_pressed(b - m * y, sides) {
                    return y;
                }
                break;
            }
        }
        let mut best = (f64::INFINITY, from.clamp(low, high));
        for choice in 1..27 {
            let sides = [choice % 3, choice / 3 % 3, choice / 9];
            let y = on_sides(&m, b, sides, low, high);
            if y.cmpge(low).all() && y.cmple(high).all() {
                let energy = y.dot(m * y) - 2.0 * b.dot(y);
                if energy < best.0 {
                    best = (energy, y);
                }
            }
        }
        best.1
    }

    /// Σ n nᵀ, and a number more on the diagonal.
    fn matrix(&self, more: f64) -> DMat3 {
        let (DVec3 { x, y, z }, e) = (self.diagonal + more, self.beside);
        DMat3::from_cols(DVec3::new(x, e.z, e.y), DVec3::new(e.z, y, e.x), DVec3::new(e.y, e.x, z))
    }
}

/// A symmetric matrix, given like that of [`Planes`], times a vector.
#[inline(always)]
fn product(d: DVec3, e: DVec3, y: DVec3) -> DVec3 {
    let row = |a: f64, b: f64, c: f64| a * y.x + b * y.y + c * y.z;
    DVec3::new(row(d.x, e.z, e.y), row(e.z, d.y, e.x), row(e.y, e.x, d.z))
}

/// A coordinate that is free, at the low side of the box, and at the high one.
const FREE: usize = 0;
const LOW: usize = 1;
const HIGH: usize = 2;

/// Where the quadratic is least with some coordinates held at sides of the box.
fn on_sides(m: &DMat3, b: DVec3, sides: [usize; 3], low: DVec3, high: DVec3) -> DVec3 {
    let mut y = DVec3::ZERO;
    for axis in 0..3 {
        y[axis] = [0.0, low[axis], high[axis]][sides[axis]];
    }
    solve(m, b, sides, &mut y);
    y
}

/// Whether the quadratic falls outward at every side that a coordinate is held at; `fall` is half its
/// gradient, downwards. In the box that makes it the minimum over the box.
fn is_pressed(fall: DVec3, sides: [usize; 3]) -> bool {
    (0..3).all(|axis| match sides[axis] {
        LOW => fall[axis] <= 0.0,
        HIGH => fall[axis] >= 0.0,
        _ => true,
    })
}

/// Sets the free coordinates (side 0) to where the quadratic yᵀm y − 2 bᵀy is least.
fn solve(m: &DMat3, b: DVec3, sides: [usize; 3], y: &mut DVec3) {
    // With the free coordinates 0, this is what is left for them to balance.
    let rest = b - *m * *y;
    let mut pair = |a: usize, c: usize| {
        let (aa, ac, cc) = (m.col(a)[a], m.col(a)[c], m.col(c)[c]);
        let determinant = aa * cc - ac * ac;
        y[a] = (rest[a] * cc - rest[c] * ac) / determinant;
        y[c] = (rest[c] * aa - rest[a] * ac) / determinant;
    };
    match sides.map(|side| side == FREE) {
        [true, true, _] => pair(0, 1),
        [true, _, true] => pair(0, 2),
        [_, true, true] => pair(1, 2),
        [true, ..] => y.x = rest.x / m.x_axis.x,
        [_, true, _] => y.y = rest.y / m.y_axis.y,
        [.., true] => y.z = rest.z / m.z_axis.z,
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planes(list: &[(DVec3, f64)]) -> Planes {
        let mut planes = Planes::NONE;
        for &(normal, d) in list {
            planes.add(normal.normalize(), d / normal.length());
        }
        planes
    }

    #[test]
    fn three_planes_meet_in_a_point() {
        let planes = planes(&[(DVec3::X, 0.25), (DVec3::Y, 0.5), (DVec3::new(0.0, 1.0, 1.0), 1.2)]);
        let mut y = DVec3::splat(0.5);
        for _ in 0..6 {
            y = planes.nearest(y, 1e-3, DVec3::ZERO, DVec3::ONE);
        }
        assert!((y - DVec3::new(0.25, 0.5, 0.7)).length() < 1e-9, "{y}");
        assert!(planes.distance(y) < 1e-9);
    }

    #[test]
    fn a_crease_leaves_the_point_free_along_it() {
        let planes = planes(&[(DVec3::X, 0.25), (DVec3::Y, 0.5)]);
        let y = planes.nearest(DVec3::new(0.9, 0.1, 0.3), 1e-6, DVec3::ZERO, DVec3::ONE);
        assert!((y - DVec3::new(0.25, 0.5, 0.3)).length() < 1e-5, "{y}");
    }

    #[test]
    fn outside_the_box_it_slides_along_the_crease() {
        // The crease x = y, z = 1/2 + x; seen from (0.8, 0.8) it is above the box.
        let planes = planes(&[(DVec3::new(1.0, -1.0, 0.0), 0.0), (DVec3::new(-1.0, 0.0, 1.0), 0.5)]);
        let y = planes.nearest(DVec3::new(0.8, 0.8, 0.9), 1e-6, DVec3::ZERO, DVec3::ONE);
        assert!(planes.distance(y) < 1e-4 && (y.z - 1.0).abs() < 1e-4, "{y}");
    }

    #[test]
    fn the_minimum_over_the_box_is_that_of_all_choices_of_sides() {
        let mut state = 1u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        let mut outside = 0;
        for _ in 0..2000 {
            let list: Vec<(DVec3, f64)> =
                (0..4).map(|_| (DVec3::new(next(), next(), next()) + 1e-3, 2.0 * next())).collect();
            let planes = planes(&list);
            let (low, high) = (DVec3::ZERO, DVec3::ONE);
            let from = DVec3::new(next(), next(), next()).abs();
            let y = planes.nearest(from, 3e-3, low, high);
            let m = planes.matrix(3e-3 * 4.0);
            let b = planes.vector + 3e-3 * 4.0 * from;
            let energy = |y: DVec3| y.dot(m * y) - 2.0 * b.dot(y);
            let choices = (0..27).map(|n| on_sides(&m, b, [n % 3, n / 3 % 3, n / 9], low, high));
            let within = choices.filter(|y| y.cmpge(low).all() && y.cmple(high).all());
            let best = within.map(energy).fold(f64::INFINITY, f64::min);
            let free = m.inverse() * b;
            let is_free = free.cmpge(low).all() && free.cmple(high).all();
            outside += usize::from(!is_free);
            assert!(energy(y) <= if is_free { energy(free) } else { best } + 1e-12, "{y}");
        }
        assert!(outside > 1000, "{outside}");
    }

    #[test]
    fn the_minimum_over_the_box_is_a_minimum() {
        let list = [(DVec3::new(1.0, 2.0, -0.5), 3.0), (DVec3::new(-1.0, 0.3, 0.9), -2.0), (DVec3::Y, 1.7)];
        let planes = planes(&list);
        let from = DVec3::new(0.2, 0.4, 0.6);
        let value = |y: DVec3| planes.distance(y).powi(2) + 1e-3 * (y - from).length_squared();
        let y = planes.nearest(from, 1e-3, DVec3::ZERO, DVec3::ONE);
        for n in 0..4096 {
            let p = DVec3::new(f64::from(n % 16), f64::from(n / 16 % 16), f64::from(n / 256)) / 15.0;
            assert!(value(p) >= value(y) - 1e-12, "{p} is better than {y}");
        }
    }
}
