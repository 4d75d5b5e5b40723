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
//! surface where there is only one plane. The planes may have weights; n is their sum, the number
//! of the planes without. A step from s to the minimum is a damped Gauss–Newton step; repeated, it
//! takes the point to the planes and hardly along them.
//!
//! The minimum over the box is exact: the function is strictly convex, so it is the best of the
//! minima over the inside, the faces, the edges and the corners that lie in the box. Where the
//! planes meet outside, the point slides along the crease first and leaves it only if the crease
//! misses the box.
//!
//! Source: T. Ju, F. Losasso, S. Schaefer and J. Warren, Dual contouring of Hermite data (2002),
//! for the quadratic; K. Levenberg (1944) for the damping.

use glam::{Vec3A, Vec3Swizzles};

/// Planes that a point should be on. Positions are in cells, from a node that is close: single
/// precision does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    /// Σ n nᵀ: what is on the diagonal, and what is opposite to each of these, at yz, zx and xy.
    diagonal: Vec3A,
    beside: Vec3A,
    /// Σ d n
    vector: Vec3A,
    /// Σ d²
    square: f32,
    /// Σ 1; each of the sums has the weights of the planes, 1 unless said.
    weight: f32,
}

impl Planes {
    /// No planes.
    pub(super) const NONE: Planes =
        Planes { diagonal: Vec3A::ZERO, beside: Vec3A::ZERO, vector: Vec3A::ZERO, square: 0.0, weight: 0.0 };

    /// How many numbers these are.
    pub(super) const SUMS: usize = 11;

    /// The same as numbers alone, to be kept.
    #[inline(always)]
    pub(super) fn packed(&self) -> [f32; Planes::SUMS] {
        let ([a, b, c], [d, e, f], [x, y, z]) =
            (self.diagonal.to_array(), self.beside.to_array(), self.vector.to_array());
        [a, b, c, d, e, f, x, y, z, self.square, self.weight]
    }

    /// What [`packed`](Planes::packed) has kept.
    #[inline(always)]
    pub(super) fn unpacked(&[a, b, c, d, e, f, x, y, z, square, weight]: &[f32; Planes::SUMS]) -> Planes {
        let (diagonal, beside) = (Vec3A::new(a, b, c), Vec3A::new(d, e, f));
        Planes { diagonal, beside, vector: Vec3A::new(x, y, z), square, weight }
    }

    /// Adds the plane nᵢ·y = dᵢ; the normal is a unit vector.
    #[inline(always)]
    pub(super) fn add(&mut self, normal: Vec3A, d: f32) {
        self.diagonal += normal * normal;
        self.beside += normal.yzx() * normal.zxy();
        self.vector += normal * d;
        self.square += d * d;
        self.weight += 1.0;
    }

    /// Adds the planes of another set, each with a weight. The node that the other's positions are
    /// from is at `shift`.
    pub(super) fn append(&mut self, other: &Planes, shift: Vec3A, weight: f32) {
        // n·(y − s) = d is n·y = d + n·s.
        let along = product(other.diagonal, other.beside, shift);
        self.diagonal += weight * other.diagonal;
        self.beside += weight * other.beside;
        self.vector += weight * (other.vector + along);
        self.square += weight * (other.square + shift.dot(2.0 * other.vector + along));
        self.weight += weight * other.weight;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.weight == 0.0
    }

    /// The sum of the weights; 1 without planes.
    fn total(&self) -> f32 {
        if self.is_empty() { 1.0 } else { self.weight }
    }

    /// The root of the mean square distance of a point from the planes.
    pub(super) fn distance(&self, y: Vec3A) -> f32 {
        let along = product(self.diagonal, self.beside, y);
        let sum = y.dot(along - 2.0 * self.vector) + self.square;
        (sum.max(0.0) / self.total()).sqrt()
    }

    /// The direction that the planes have in common, if there are two sides and no more: those of a
    /// crease with a [pull](super::feature::Crease::pull).
    pub(super) fn crease(&self, pull: f32) -> Option<Vec3A> {
        // What the matrix of the normals takes to almost 0. Its adjugate has that in its columns;
        // the sum of the products of two eigenvalues, and the least one, tell how many sides there
        // are.
        let Adjugate { diagonal: d, beside: e, determinant } = Adjugate::new(self.diagonal, self.beside);
        let pairs = d.element_sum();
        let weight = pull * self.weight;
        let is_crease = pairs > 0.015 * weight * self.weight && determinant < 0.008 * weight * pairs;
        let columns = [Vec3A::new(d.x, e.z, e.y), Vec3A::new(e.z, d.y, e.x), Vec3A::new(e.y, e.x, d.z)];
        is_crease.then(|| columns[d.max_position()].normalize())
    }

    /// The point of the box from `low` to `high` that is best, with damping λ towards `from`.
    #[inline]
    pub(super) fn nearest(&self, from: Vec3A, damping: f32, low: Vec3A, high: Vec3A) -> Vec3A {
        let weight = damping * self.total();
        // The step to it.
        let fall = self.vector - product(self.diagonal, self.beside, from);
        let free = from + solve(self.diagonal + weight, self.beside, fall);
        let is_within = free.cmpge(low) & free.cmple(high);
        if is_within.all() { free } else { self.nearest_on_sides(free, from, weight, low, high) }
    }

    /// The same where the point that is best of all is not in the box.
    #[cold]
    fn nearest_on_sides(&self, free: Vec3A, from: Vec3A, weight: f32, low: Vec3A, high: Vec3A) -> Vec3A {
        let (d, e, b) = (self.diagonal + weight, self.beside, self.vector + weight * from);
        let is_within = |y: Vec3A| (y.cmpge(low) & y.cmple(high)).all();
        // Most often it is where the coordinates that are beyond a side are held there, and those
        // that it falls inward from are let go.
        let (mut sides, mut y) = (Vec3A::ZERO, free);
        for _ in 0..6 {
            sides = Vec3A::select(y.cmplt(low), Vec3A::NEG_ONE, Vec3A::select(y.cmpgt(high), Vec3A::ONE, sides));
            y = on_sides((d, e, b), sides, low, high);
            if is_within(y) {
                // In the box it is the minimum if the quadratic falls outward at every side.
                let is_held = (sides * (b - product(d, e, y))).cmpge(Vec3A::ZERO);
                if is_held.all() {
                    return y;
                }
                sides = Vec3A::select(is_held, sides, Vec3A::ZERO);
                y = on_sides((d, e, b), sides, low, high);
            }
        }
        let mut best = (f32::INFINITY, from.clamp(low, high));
        for choice in 1..27 {
            let y = on_sides((d, e, b), sides_of(choice), low, high);
            if is_within(y) {
                let energy = y.dot(product(d, e, y) - 2.0 * b);
                if energy < best.0 {
                    best = (energy, y);
                }
            }
        }
        best.1
    }
}

/// The choices of sides of a box, by number: along each axis −1 for the low side, 1 for the high
/// one, and 0 for none; none at all for 0.
fn sides_of(choice: u8) -> Vec3A {
    Vec3A::from_array([choice % 3, choice / 3 % 3, choice / 9].map(|n| [0.0, -1.0, 1.0][usize::from(n)]))
}

/// A symmetric matrix, given like that of [`Planes`], times a vector.
#[inline(always)]
fn product(d: Vec3A, e: Vec3A, y: Vec3A) -> Vec3A {
    d * y + e.zxy() * y.yzx() + e.yzx() * y.zxy()
}

/// The adjugate of a symmetric matrix, given like that of [`Planes`], and the determinant.
struct Adjugate {
    diagonal: Vec3A,
    beside: Vec3A,
    determinant: f32,
}

impl Adjugate {
    #[inline(always)]
    fn new(d: Vec3A, e: Vec3A) -> Adjugate {
        let diagonal = d.yzx() * d.zxy() - e * e;
        let beside = e.yzx() * e.zxy() - d * e;
        let determinant = d.x * diagonal.x + e.z * beside.z + e.y * beside.y;
        Adjugate { diagonal, beside, determinant }
    }
}

/// What a symmetric matrix takes to a vector, by Cramer's rule.
#[inline(always)]
fn solve(d: Vec3A, e: Vec3A, b: Vec3A) -> Vec3A {
    let Adjugate { diagonal, beside, determinant } = Adjugate::new(d, e);
    product(diagonal, beside, b) / determinant
}

/// Where the quadratic yᵀm y − 2 bᵀy is least with some coordinates held at sides of a box; m is
/// given like that of [`Planes`].
fn on_sides((d, e, b): (Vec3A, Vec3A, Vec3A), sides: Vec3A, low: Vec3A, high: Vec3A) -> Vec3A {
    let (held, free) = (sides.abs(), Vec3A::ONE - sides.abs());
    // What is held stands for itself in its row; the others have to balance what is left.
    let at = held * Vec3A::select(sides.cmplt(Vec3A::ZERO), low, high);
    let rest = free * (b - product(d, e, at)) + at;
    let y = solve(free * d + held, free.yzx() * free.zxy() * e, rest);
    free * y + at
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;

    fn planes(list: &[(Vec3A, f32)]) -> Planes {
        let mut planes = Planes::NONE;
        for &(normal, d) in list {
            planes.add(normal.normalize(), d / normal.length());
        }
        planes
    }

    #[test]
    fn three_planes_meet_in_a_point() {
        let planes = planes(&[(Vec3A::X, 0.25), (Vec3A::Y, 0.5), (Vec3A::new(0.0, 1.0, 1.0), 1.2)]);
        let mut y = Vec3A::splat(0.5);
        for _ in 0..6 {
            y = planes.nearest(y, 1e-3, Vec3A::ZERO, Vec3A::ONE);
        }
        assert!((y - Vec3A::new(0.25, 0.5, 0.7)).length() < 1e-6, "{y}");
        assert!(planes.distance(y) < 1e-6);
    }

    #[test]
    fn a_crease_leaves_the_point_free_along_it() {
        let planes = planes(&[(Vec3A::X, 0.25), (Vec3A::Y, 0.5)]);
        let y = planes.nearest(Vec3A::new(0.9, 0.1, 0.3), 1e-6, Vec3A::ZERO, Vec3A::ONE);
        assert!((y - Vec3A::new(0.25, 0.5, 0.3)).length() < 1e-5, "{y}");
    }

    #[test]
    fn the_direction_of_two_sides_is_told() {
        let two = planes(&[(Vec3A::X, 0.25), (Vec3A::X, 0.25), (Vec3A::new(0.0, 1.0, 1.0), 0.5)]);
        let along = two.crease(1.0).unwrap();
        assert!(along.cross(Vec3A::new(0.0, 1.0, -1.0)).length() < 1e-6, "{along}");
        let one = planes(&[(Vec3A::X, 0.25), (Vec3A::new(1.0, 0.1, 0.0), 0.25)]);
        assert!(one.crease(1.0).is_none());
        let three = planes(&[(Vec3A::X, 0.25), (Vec3A::Y, 0.5), (Vec3A::Z, 0.5), (Vec3A::Z, 0.5)]);
        assert!(three.crease(1.0).is_none());
        assert!(Planes::NONE.crease(1.0).is_none());
    }

    #[test]
    fn outside_the_box_it_slides_along_the_crease() {
        // The crease x = y, z = 1/2 + x; seen from (0.8, 0.8) it is above the box.
        let planes = planes(&[(Vec3A::new(1.0, -1.0, 0.0), 0.0), (Vec3A::new(-1.0, 0.0, 1.0), 0.5)]);
        let y = planes.nearest(Vec3A::new(0.8, 0.8, 0.9), 1e-6, Vec3A::ZERO, Vec3A::ONE);
        assert!(planes.distance(y) < 1e-4 && (y.z - 1.0).abs() < 1e-4, "{y}");
    }

    #[test]
    fn the_minimum_over_the_box_is_that_of_all_choices_of_sides() {
        let mut state = 1u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 23) as f32 - 1.0
        };
        let mut outside = 0;
        for _ in 0..2000 {
            let list: Vec<(Vec3A, f32)> =
                (0..4).map(|_| (Vec3A::new(next(), next(), next()) + 1e-3, 2.0 * next())).collect();
            let planes = planes(&list);
            let (low, high) = (Vec3A::ZERO, Vec3A::ONE);
            let from = Vec3A::new(next(), next(), next()).abs();
            let y = planes.nearest(from, 3e-3, low, high);
            // The same in double precision, by inverse matrices: what is held has a row of its own.
            let (d, e) = (planes.diagonal.as_dvec3() + 3e-3 * 4.0, planes.beside.as_dvec3());
            let m = DMat3::from_cols_array(&[d.x, e.z, e.y, e.z, d.y, e.x, e.y, e.x, d.z]);
            let b = planes.vector.as_dvec3() + 3e-3 * 4.0 * from.as_dvec3();
            let energy = |y: DVec3| y.dot(m * y) - 2.0 * b.dot(y);
            let held = |n: usize| {
                let (mut rows, mut right) = (m.transpose(), b);
                for (axis, side) in [n % 3, n / 3 % 3, n / 9].into_iter().enumerate().filter(|(_, side)| *side > 0) {
                    *rows.col_mut(axis) = DVec3::AXES[axis];
                    right[axis] = (side - 1) as f64;
                }
                rows.transpose().inverse() * right
            };
            let is_within = |y: &DVec3| y.cmpge(DVec3::splat(-1e-9)).all() && y.cmple(DVec3::splat(1.0 + 1e-9)).all();
            let best = (0..27).map(held).filter(is_within).map(energy).fold(f64::INFINITY, f64::min);
            outside += usize::from(!is_within(&held(0)));
            assert!(y.cmpge(low).all() && y.cmple(high).all() && energy(y.as_dvec3()) <= best + 1e-6, "{y}");
        }
        assert!(outside > 1000, "{outside}");
    }

    #[test]
    fn the_minimum_over_the_box_is_a_minimum() {
        let list = [(Vec3A::new(1.0, 2.0, -0.5), 3.0), (Vec3A::new(-1.0, 0.3, 0.9), -2.0), (Vec3A::Y, 1.7)];
        let planes = planes(&list);
        let from = Vec3A::new(0.2, 0.4, 0.6);
        let value = |y: Vec3A| planes.distance(y).powi(2) + 1e-3 * (y - from).length_squared();
        let y = planes.nearest(from, 1e-3, Vec3A::ZERO, Vec3A::ONE);
        for n in 0..4096 {
            let p = Vec3A::new((n % 16) as f32, (n / 16 % 16) as f32, (n / 256) as f32) / 15.0;
            assert!(value(p) >= value(y) - 1e-6, "{p} is better than {y}");
        }
    }
}
