//! An axis-aligned box.
//!
//! ```text
//!            +-----------* max
//!           /           /|
//!          +-----------+ |      z   y
//!          |           | |      |  /
//!          |           | +      | /
//!          |           |/       +---- x
//!      min *-----------+
//! ```
//!
//! A box is closed: its faces belong to it. It may be empty ([`Bounds::EMPTY`]), a single
//! point, or unbounded along any axis in either sense (infinite components). Every method is
//! defined for all of these and none yields NaN unless a corner is NaN; a box with a NaN
//! component counts as empty.
//!
//! Limits: arithmetic is rounded to nearest, so [`Bounds::transformed`] and
//! [`Bounds::inflate`] are exact to a few units in the last place of their largest term, not
//! outward. Whoever needs a guarantee adds a margin.

use std::fmt;

use glam::{DAffine3, DVec3};

use crate::figures_beside;

/// An axis-aligned box in f64, in the length units of the model.
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use rvachev::Bounds;
///
/// let b = Bounds::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0));
/// assert_eq!(b.center(), DVec3::new(1.0, 0.5, 0.5));
/// assert_eq!(b.longest_side(), 2.0);
/// assert!(b.contains(DVec3::new(2.0, 0.0, 1.0)));
///
/// // The empty box is the neutral element of the union, the infinite one of the intersection.
/// assert_eq!(b.union(&Bounds::EMPTY), b);
/// assert_eq!(b.intersection(&Bounds::ALL), b);
///
/// let turned = b.transformed(&DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2));
/// assert!((turned.min - DVec3::new(-1.0, 0.0, 0.0)).length() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

/// The empty box.
impl Default for Bounds {
    fn default() -> Bounds {
        Bounds::EMPTY
    }
}

/// The two corners, to nine figures of the largest coordinate.
///
/// ```
/// use rvachev::{Bounds, Solid};
///
/// let ball = Solid::sphere(1.0).translate([0.1, 0.2, 0.3]);
/// assert_eq!(ball.bounds()?.to_string(), "(-0.9, -0.8, -0.7) to (1.1, 1.2, 1.3)");
/// assert_eq!(Bounds::EMPTY.to_string(), "empty");
/// # Ok::<(), rvachev::SolidError>(())
/// ```
impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const COUNT: usize = 9;
        if self.is_empty() {
            return f.write_str("empty");
        }
        let corners = [self.min, self.max].map(|corner| corner.to_array());
        let finite = corners.iter().flatten().filter(|side| side.is_finite());
        let largest = finite.fold(0.0f64, |largest, side| largest.max(side.abs()));
        let [low, high] = corners.map(|corner| corner.map(|side| figures_beside(side, largest, COUNT)).join(", "));
        write!(f, "({low}) to ({high})")
    }
}

impl Bounds {
    /// The box that holds no point: `min = +∞`, `max = −∞`.
    pub const EMPTY: Bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box that holds every point: `min = −∞`, `max = +∞`.
    pub const ALL: Bounds = Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The box from `min` to `max`, taken as they are: if `min` exceeds `max` along some axis,
    /// the box is empty. [`Bounds::from_corners`] puts the corners in order instead.
    #[must_use]
    pub fn new(min: impl Into<DVec3>, max: impl Into<DVec3>) -> Bounds {
        Bounds { min: min.into(), max: max.into() }
    }

    /// The box spanned by two opposite corners, in any order.
    #[must_use]
    pub fn from_corners(a: impl Into<DVec3>, b: impl Into<DVec3>) -> Bounds {
        let (a, b) = (a.into(), b.into());
        Bounds::new(a.min(b), a.max(b))
    }

    /// The smallest box that holds all `points`; empty if there are none.
    #[must_use]
    pub fn from_points<T: Into<DVec3>>(points: impl IntoIterator<Item = T>) -> Bounds {
        let mut b = Bounds::EMPTY;
        for p in points {
            let p = p.into();
            b.min = b.min.min(p);
            b.max = b.max.max(p);
        }
        b
    }

    /// The box with the given centre and half side lengths (length units, ≥ 0).
    #[must_use]
    pub fn from_center(center: impl Into<DVec3>, half_extents: impl Into<DVec3>) -> Bounds {
        let (center, half_extents) = (center.into(), half_extents.into());
        Bounds::new(center - half_extents, center + half_extents)
    }

    /// Whether the box holds no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether the box is bounded along every axis. The empty box is.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.is_empty() || (self.min.is_finite() && self.max.is_finite())
    }

    /// The midpoint. Along an axis that is unbounded both ways, and for the empty box, it
    /// is 0; along one that is unbounded one way it is that infinity.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        // Halved before they are added: the sum of two huge corners overflows.
        let mid = self.min * 0.5 + self.max * 0.5;
        DVec3::select(mid.is_nan_mask(), DVec3::ZERO, mid)
    }

    /// Half the side lengths; 0 for the empty box.
    #[must_use]
    pub fn half_extents(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        self.max * 0.5 - self.min * 0.5
    }

    /// The side lengths; 0 for the empty box.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        self.max - self.min
    }

    /// The longest side length; 0 for the empty box.
    #[must_use]
    pub fn longest_side(&self) -> f64 {
        self.size().max_element()
    }

    /// Whether `point` is in the box or on its boundary.
    #[must_use]
    pub fn contains(&self, point: impl Into<DVec3>) -> bool {
        let point = point.into();
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Whether every point of `other` is in this box; true for an empty `other`.
    #[must_use]
    pub fn contains_bounds(&self, other: &Bounds) -> bool {
        other.is_empty() || (self.contains(other.min) && self.contains(other.max))
    }

    /// Whether the two boxes have a point in common; boxes that touch do.
    #[must_use]
    pub fn intersects(&self, other: &Bounds) -> bool {
        !self.is_empty() && !other.is_empty() && self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(&self, other: &Bounds) -> Bounds {
        match (self.is_empty(), other.is_empty()) {
            (true, true) => Bounds::EMPTY,
            (true, false) => *other,
            (false, true) => *self,
            (false, false) => Bounds::new(self.min.min(other.min), self.max.max(other.max)),
        }
    }

    /// The common part of the two boxes; [`Bounds::EMPTY`] if there is none.
    #[must_use]
    pub fn intersection(&self, other: &Bounds) -> Bounds {
        // Tested first: the minimum of a number and NaN is the number.
        if self.is_empty() || other.is_empty() {
            return Bounds::EMPTY;
        }
        Bounds::new(self.min.max(other.min), self.max.min(other.max)).or_empty()
    }

    /// The box with every face moved outward by `margin` (length units; a negative margin
    /// moves them inward, down to [`Bounds::EMPTY`]). The empty box stays empty.
    #[must_use]
    pub fn inflate(&self, margin: f64) -> Bounds {
        if self.is_empty() {
            return Bounds::EMPTY;
        }
        // An infinite margin inward leaves NaN on an infinite side, which counts as empty.
        Bounds::new(self.min - margin, self.max + margin).or_empty()
    }

    /// The eight corners; corner c is at the maximum along x, y, z where its bits 0, 1, 2 are
    /// set.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|c| {
            let pick = |axis: usize| {
                let side = if (c >> axis) & 1 == 1 { self.max } else { self.min };
                side[axis]
            };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// The eight halves of the box along all axes, in the order of the [`corners`](Bounds::corners)
    /// that they hold.
    #[must_use]
    pub fn octants(&self) -> [Bounds; 8] {
        let center = self.center();
        self.corners().map(|corner| Bounds::new(corner.min(center), corner.max(center)))
    }

    /// The smallest box that holds the image of this box under an affine map. An unbounded
    /// side stays unbounded along every axis that it reaches, and does not spread to others;
    /// the empty box stays empty.
    #[must_use]
    pub fn transformed(&self, map: &DAffine3) -> Bounds {
        if self.is_empty() {
            return Bounds::EMPTY;
        }
        let mut out = Bounds::new(map.translation, map.translation);
        for axis in 0..3 {
            let column = map.matrix3.col(axis);
            let at_min = column_times(column, self.min[axis]);
            let at_max = column_times(column, self.max[axis]);
            // The lower ends are finite or −∞ and the upper ends finite or +∞, so that
            // neither sum meets opposite infinities.
            out.min += at_min.min(at_max);
            out.max += at_min.max(at_max);
        }
        out
    }

    /// The squared distance from `point` to the box: 0 inside, +∞ for the empty box.
    #[must_use]
    pub fn distance_squared(&self, point: impl Into<DVec3>) -> f64 {
        let point = point.into();
        if self.is_empty() {
            return f64::INFINITY;
        }
        (self.min - point).max(point - self.max).max(DVec3::ZERO).length_squared()
    }

    /// This box, or the canonical empty one if it is empty.
    fn or_empty(self) -> Bounds {
        if self.is_empty() { Bounds::EMPTY } else { self }
    }
}

/// `column · x`, where 0 · ∞ is 0: an axis that a map does not feed on contributes nothing.
pub fn column_times(column: DVec3, x: f64) -> DVec3 {
    DVec3::select(column.cmpeq(DVec3::ZERO), DVec3::ZERO, column * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Bounds {
        Bounds::new(DVec3::ZERO, DVec3::ONE)
    }

    #[test]
    fn empty_and_all() {
        assert!(Bounds::EMPTY.is_empty() && Bounds::EMPTY.is_finite());
        assert!(!Bounds::ALL.is_empty() && !Bounds::ALL.is_finite());
        assert!(Bounds::new(DVec3::ONE, DVec3::ZERO).is_empty());
        assert!(Bounds::new(DVec3::NAN, DVec3::ONE).is_empty());
        assert!(!unit().is_empty());
        assert_eq!(Bounds::from_corners(DVec3::ONE, DVec3::ZERO), Bounds::new(DVec3::ZERO, DVec3::ONE));
        assert_eq!(Bounds::EMPTY.size(), DVec3::ZERO);
        assert_eq!(Bounds::ALL.center(), DVec3::ZERO);
        assert_eq!(Bounds::EMPTY.center(), DVec3::ZERO);
        assert_eq!(Bounds::ALL.longest_side(), f64::INFINITY);
        assert_eq!(Bounds::EMPTY.inflate(1.0), Bounds::EMPTY);
        assert_eq!(unit().inflate(-0.6), Bounds::EMPTY);
        assert_eq!(Bounds::ALL.inflate(f64::NEG_INFINITY), Bounds::EMPTY);
        assert_eq!(Bounds::from_points([DVec3::ZERO; 0]), Bounds::EMPTY);
    }

    #[test]
    fn set_operations() {
        let b = Bounds::new(DVec3::splat(0.5), DVec3::splat(2.0));
        assert_eq!(unit().intersection(&b), Bounds::new(DVec3::splat(0.5), DVec3::ONE));
        assert_eq!(unit().union(&b), Bounds::new(DVec3::ZERO, DVec3::splat(2.0)));
        // Not canonical, and still neutral.
        let odd = Bounds::new(DVec3::splat(3.0), DVec3::splat(-3.0));
        assert_eq!(unit().union(&odd), unit());
        assert!(unit().contains_bounds(&odd));
        assert!(!unit().intersects(&odd));
        let touching = Bounds::new(DVec3::X, DVec3::new(2.0, 1.0, 1.0));
        assert!(unit().intersects(&touching));
        assert!(!unit().contains_bounds(&touching));
        assert!(Bounds::ALL.contains_bounds(&unit()));
        let nan = Bounds::new(DVec3::ZERO, DVec3::new(1.0, f64::NAN, 1.0));
        assert_eq!(unit().intersection(&nan), Bounds::EMPTY);
    }

    #[test]
    fn transformed_is_the_box_of_the_corners() {
        let map = DAffine3::from_cols(
            DVec3::new(0.3, -1.0, 2.0),
            DVec3::new(1.5, 0.25, -0.5),
            DVec3::new(-0.125, 0.75, 1.0),
            DVec3::new(10.0, -20.0, 30.0),
        );
        let b = Bounds::new(DVec3::new(-1.0, 2.0, 3.0), DVec3::new(4.0, 2.5, 7.0));
        let want = Bounds::from_points(b.corners().map(|p| map.transform_point3(p)));
        let got = b.transformed(&map);
        assert!((got.min - want.min).length() < 1e-12);
        assert!((got.max - want.max).length() < 1e-12);
    }

    #[test]
    fn transformed_keeps_infinities_apart() {
        let slab = Bounds::new(
            DVec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, -1.0),
            DVec3::new(f64::INFINITY, f64::INFINITY, 1.0),
        );
        let moved = slab.transformed(&DAffine3::from_translation(DVec3::splat(5.0)));
        assert_eq!((moved.min.z, moved.max.z), (4.0, 6.0));
        assert_eq!((moved.min.x, moved.max.x), (slab.min.x, slab.max.x));
        let half = Bounds::new(DVec3::ZERO, DVec3::INFINITY);
        let turned = half.transformed(&DAffine3::from_rotation_x(1.0));
        assert!(!turned.min.is_nan() && !turned.max.is_nan());
        assert_eq!((turned.min.x, turned.max.x), (0.0, f64::INFINITY));
        assert_eq!(turned.max.z, f64::INFINITY);
        assert_eq!(turned.min.y, f64::NEG_INFINITY);
        let all = Bounds::ALL.transformed(&DAffine3::from_rotation_x(1.0));
        assert_eq!(all, Bounds::ALL);
        let empty = Bounds::EMPTY.transformed(&DAffine3::from_rotation_x(1.0));
        assert_eq!(empty, Bounds::EMPTY);
    }

    #[test]
    fn distance() {
        assert_eq!(unit().distance_squared(DVec3::splat(0.5)), 0.0);
        assert_eq!(unit().distance_squared(DVec3::new(2.0, 0.5, 3.0)), 5.0);
        assert_eq!(Bounds::ALL.distance_squared(DVec3::ONE), 0.0);
        assert_eq!(Bounds::EMPTY.distance_squared(DVec3::ONE), f64::INFINITY);
        // A non-canonical empty box as well.
        let odd = Bounds::new(DVec3::splat(3.0), DVec3::splat(-3.0));
        assert_eq!(odd.distance_squared(DVec3::ZERO), f64::INFINITY);
    }

    #[test]
    fn corners_follow_their_bits() {
        let c = unit().corners();
        assert_eq!(c[0], DVec3::ZERO);
        assert_eq!(c[1], DVec3::X);
        assert_eq!(c[2], DVec3::Y);
        assert_eq!(c[4], DVec3::Z);
        assert_eq!(c[7], DVec3::ONE);
    }
}
