//! Profiles: plane shapes, joined and moved like solids.

use std::fmt;
use std::ops::{BitAnd, BitOr, BitXor, Not, Sub};

use glam::{DAffine2, DAffine3, DMat3, DVec2, DVec3};

use super::Solid;
use super::composed::Sweep;
use crate::{
    Bounds, Circle, Gielis, Polygon, RFunction, Rectangle, RegularPolygon, SolidError, Superellipse, Superpolygon,
};

/// A shape in the plane of x and y: what solids are extruded, revolved and swept from.
///
#[doc = picture!(
    "profile_joined" = "docs/gallery/profile_joined.png",
    "extrude_twisted" = "docs/gallery/extrude_twisted.png",
    "revolve" = "docs/gallery/revolve.png",
    "sweep_helix" = "docs/gallery/sweep_helix.png",
)]
///
/// Like a [`Solid`] it is an expression of leaves, maps and joins, cheap to clone, whose value
/// is positive inside, in length units; its field does not depend on z. Building never fails;
/// parameters are checked when the profile, or a solid made of it, is first used.
///
/// ```
/// use rvachev::Profile;
/// use glam::DVec2;
///
/// let hole = Profile::circle(3.0).translate(DVec2::new(12.0, 0.0));
/// let plate = Profile::rounded_rectangle(DVec2::new(40.0, 20.0), 4.0) - hole;
/// assert!(plate.contains(DVec2::new(-12.0, 0.0))?);
/// assert!(!plate.contains(DVec2::new(12.0, 1.0))?);
/// let part = plate.extrude(5.0);
/// assert!((part.bounds()?.size() - glam::DVec3::new(40.0, 20.0, 5.0)).length() < 1e-9);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Profile(pub(crate) Solid);

/// A rectangle along the axes of the plane: what a profile is within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneBounds {
    /// The corner with the smallest coordinates.
    pub min: DVec2,
    /// The corner with the largest coordinates.
    pub max: DVec2,
}

impl Profile {
    /// A [`Circle`] about the origin.
    #[must_use]
    pub fn circle(radius: f64) -> Profile {
        Circle { radius }.into()
    }

    /// A [`Superellipse`] about the origin.
    #[must_use]
    pub fn superellipse(semi_axes: impl Into<DVec2>, exponent: f64) -> Profile {
        Superellipse::new(semi_axes, exponent).into()
    }

    /// A [`Superpolygon`]: what is within the curve, scaled by `size`.
    #[must_use]
    pub fn superpolygon(curve: Gielis, size: f64) -> Profile {
        Superpolygon::new(curve, size).into()
    }

    /// A [`Rectangle`] about the origin, `size` being the lengths of its sides.
    #[must_use]
    pub fn rectangle(size: impl Into<DVec2>) -> Profile {
        Rectangle { size: size.into(), radius: 0.0 }.into()
    }

    /// A [`Rectangle`] whose corners are rounded.
    #[must_use]
    pub fn rounded_rectangle(size: impl Into<DVec2>, radius: f64) -> Profile {
        Rectangle { size: size.into(), radius }.into()
    }

    /// A [`RegularPolygon`] about the origin with its corners at `radius`, the middle of a side
    /// on the positive x axis.
    #[must_use]
    pub fn regular_polygon(sides: u32, radius: f64) -> Profile {
        RegularPolygon::new(sides, radius).into()
    }

    /// A [`Polygon`] within one contour.
    #[must_use]
    pub fn polygon<P: Into<DVec2>>(points: impl IntoIterator<Item = P>) -> Profile {
        Polygon::new([points]).into()
    }

    /// The value at a point of the plane: positive inside.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn value(&self, p: DVec2) -> Result<f64, SolidError> {
        self.0.value(p.extend(0.0))
    }

    /// Whether a point of the plane is inside.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn contains(&self, p: DVec2) -> Result<bool, SolidError> {
        self.0.contains(p.extend(0.0))
    }

    /// A rectangle that holds the profile; infinite where the profile is unbounded, `min` above
    /// `max` if it is empty.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn bounds(&self) -> Result<PlaneBounds, SolidError> {
        let Bounds { min, max } = self.0.bounds()?;
        Ok(PlaneBounds { min: min.truncate(), max: max.truncate() })
    }

    /// The column over the profile: the solid that is this profile at every z. It is unbounded.
    #[must_use]
    pub fn column(&self) -> Solid {
        Sweep::Column.of(self, self.0.clone())
    }

    /// The shape where `tree` is negative (fidget's sign), a function of x and y; `bounds`
    /// must hold it. See [`Formula`](crate::Formula).
    ///
    /// ```
    /// use fidget::context::Tree;
    /// use rvachev::{PlaneBounds, Profile};
    /// use glam::DVec2;
    ///
    /// let (x, y, _) = Tree::axes();
    /// let disc = Profile::formula(&((x.square() + y.square()).sqrt() - 1.0), PlaneBounds {
    ///     min: DVec2::splat(-1.0),
    ///     max: DVec2::splat(1.0),
    /// });
    /// assert!(disc.contains(DVec2::new(0.5, 0.5))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn formula(tree: &fidget::context::Tree, bounds: PlaneBounds) -> Profile {
        let (min, max) = (bounds.min.extend(f64::NEG_INFINITY), bounds.max.extend(f64::INFINITY));
        Profile(Solid::formula(tree, Bounds::new(min, max)))
    }

    /// The shape with its border moved outwards by `distance` (inwards if negative): see
    /// [`Solid::offset`].
    ///
    #[doc = picture!(
        "profile_polygon" = "docs/gallery/profile_polygon.png",
        "profile_offset" = "docs/gallery/profile_offset.png",
    )]
    ///
    /// ```
    /// use rvachev::Profile;
    /// use glam::DVec2;
    ///
    /// let triangle = Profile::polygon([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]);
    /// assert!((triangle.offset(0.5).value(DVec2::new(2.0, -0.25))? - 0.25).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn offset(&self, distance: f64) -> Profile {
        Profile(self.0.offset(distance))
    }

    /// Moved by `offset`.
    #[must_use]
    pub fn translate(&self, offset: impl Into<DVec2>) -> Profile {
        Profile(self.0.translate(offset.into().extend(0.0)))
    }

    /// Turned about the origin by `angle` radians, from x towards y.
    #[must_use]
    pub fn rotate(&self, angle: f64) -> Profile {
        Profile(self.0.rotate_z(angle))
    }

    /// Scaled about the origin by `factor` (not 0; a negative one turns by half a turn).
    #[must_use]
    pub fn scale(&self, factor: f64) -> Profile {
        Profile(self.0.scale_axes(DVec3::new(factor, factor, factor.abs())))
    }

    /// Scaled about the origin by a factor along each axis (neither 0).
    #[must_use]
    pub fn scale_axes(&self, factors: impl Into<DVec2>) -> Profile {
        let factors = factors.into();
        // Along z nothing depends on the factor; values keep to the smallest one.
        Profile(self.0.scale_axes(factors.extend(factors.x.abs())))
    }

    /// Mirrored in the line through the origin across `normal` (of any length).
    ///
    /// ```
    /// use rvachev::Profile;
    /// use glam::DVec2;
    ///
    /// let half = Profile::polygon([[0.0, -1.0], [3.0, 0.0], [0.0, 1.0]]).mirror([1.0, 0.0]);
    /// assert!(half.contains(DVec2::new(-2.0, 0.0))? && !half.contains(DVec2::new(2.0, 0.0))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn mirror(&self, normal: impl Into<DVec2>) -> Profile {
        // A normal of no direction is NaN, which is told when the profile is used.
        let normal = normal.into().normalize();
        let turn = |axis: DVec2| (axis - 2.0 * axis.dot(normal) * normal).extend(0.0);
        let matrix = DMat3::from_cols(turn(DVec2::X), turn(DVec2::Y), DVec3::Z);
        Profile(self.0.affine(DAffine3::from_mat3(matrix)))
    }

    /// Mapped by any invertible affine map of the plane. Values are multiplied by its smallest
    /// stretch.
    #[must_use]
    pub fn affine(&self, forward: DAffine2) -> Profile {
        let m = forward.matrix2;
        // Along z a stretch between the smallest and the largest, which changes neither.
        let along = m.determinant().abs().sqrt();
        let matrix = DMat3::from_cols(m.x_axis.extend(0.0), m.y_axis.extend(0.0), DVec3::Z * along);
        Profile(self.0.affine(DAffine3::from_mat3_translation(matrix, forward.translation.extend(0.0))))
    }

    /// What is in either profile, joined by `rule`.
    #[must_use]
    pub fn union(&self, other: &Profile, rule: RFunction) -> Profile {
        Profile(self.0.union(&other.0, rule))
    }

    /// What is in both profiles, joined by `rule`.
    #[must_use]
    pub fn intersection(&self, other: &Profile, rule: RFunction) -> Profile {
        Profile(self.0.intersection(&other.0, rule))
    }

    /// What is in this profile and not in `other`, joined by `rule`.
    #[must_use]
    pub fn difference(&self, other: &Profile, rule: RFunction) -> Profile {
        Profile(self.0.difference(&other.0, rule))
    }

    /// What is in exactly one of the profiles, joined by `rule`.
    #[must_use]
    pub fn symmetric_difference(&self, other: &Profile, rule: RFunction) -> Profile {
        Profile(self.0.symmetric_difference(&other.0, rule))
    }

    /// Everything outside this profile.
    #[must_use]
    pub fn complement(&self) -> Profile {
        Profile(self.0.complement())
    }

    /// The union of many profiles (see [`Solid::union_all`]).
    #[must_use]
    pub fn union_all(profiles: impl IntoIterator<Item = Profile>, rule: RFunction) -> Profile {
        Profile(Solid::union_all(profiles.into_iter().map(|profile| profile.0), rule))
    }

    /// The intersection of many profiles (see [`Solid::intersection_all`]).
    #[must_use]
    pub fn intersection_all(profiles: impl IntoIterator<Item = Profile>, rule: RFunction) -> Profile {
        Profile(Solid::intersection_all(profiles.into_iter().map(|profile| profile.0), rule))
    }

    /// This profile without all of `profiles`.
    #[must_use]
    pub fn difference_all(&self, profiles: impl IntoIterator<Item = Profile>, rule: RFunction) -> Profile {
        Profile(self.0.difference_all(profiles.into_iter().map(|profile| profile.0), rule))
    }
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Profile({:?})", self.0)
    }
}

/// The built-in plane shapes as profiles; their kernels are compiled here once.
macro_rules! plane_leaves {
    ($($leaf:ty),* $(,)?) => {$(
        impl From<$leaf> for Profile {
            #[inline(never)]
            fn from(leaf: $leaf) -> Profile {
                Profile(Solid::leaf(leaf))
            }
        }
    )*};
}

rvachev_field::plane_leaves!(plane_leaves);

/// Implements an operator for all four combinations of values and references.
macro_rules! operator {
    ($trait:ident, $method:ident, $named:ident, $doc:literal) => {
        operator!(@ $trait, $method, $named, $doc, Profile, Profile);
        operator!(@ $trait, $method, $named, $doc, Profile, &Profile);
        operator!(@ $trait, $method, $named, $doc, &Profile, Profile);
        operator!(@ $trait, $method, $named, $doc, &Profile, &Profile);
    };
    (@ $trait:ident, $method:ident, $named:ident, $doc:literal, $left:ty, $right:ty) => {
        impl $trait<$right> for $left {
            type Output = Profile;

            #[doc = $doc]
            fn $method(self, other: $right) -> Profile {
                self.$named(&other.clone(), RFunction::default())
            }
        }
    };
}

operator!(BitOr, bitor, union, "Union by R_p, p = 2.");
operator!(BitAnd, bitand, intersection, "Intersection by R_p, p = 2.");
operator!(Sub, sub, difference, "Difference by R_p, p = 2.");
operator!(BitXor, bitxor, symmetric_difference, "Symmetric difference by R_p, p = 2.");

impl Not for Profile {
    type Output = Profile;

    /// Everything outside.
    fn not(self) -> Profile {
        self.complement()
    }
}

impl Not for &Profile {
    type Output = Profile;

    /// Everything outside.
    fn not(self) -> Profile {
        self.complement()
    }
}
