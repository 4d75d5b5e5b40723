//! Profiles: plane shapes, joined and moved like solids.
//!
//! A profile is a solid whose field does not depend on z: the column over it. Every verb of the
//! plane is that of the column, and takes what the solid's takes, with two coordinates for three.

mod join;
mod map;
mod part;
mod query;

use glam::DVec2;

use super::Solid;
use super::composed::Sweep;
use crate::{Circle, Gielis, Polygon, Rectangle, RegularPolygon, Superellipse, Superpolygon};

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
/// Verbs have the names, the rules and the errors of those of [`Solid`]; each says what is
/// different in the plane. Where a profile is taken, a reference to one and a plane leaf
/// ([`Circle`]) will do.
///
/// ```
/// use rvachev::Profile;
///
/// let holes = Profile::circle(3.0).translate([12.0, 0.0]).mirrored_x();
/// let plate = Profile::rounded_rectangle([40.0, 20.0], 4.0) - holes;
/// assert!(plate.contains([0.0, 0.0])?);
/// assert!(!plate.contains([12.0, 1.0])? && !plate.contains([-12.0, 1.0])?);
/// let part = plate.extrude(5.0);
/// assert!((part.bounds()?.size() - glam::DVec3::new(40.0, 20.0, 5.0)).length() < 1e-9);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Profile(pub(crate) Solid);

/// A rectangle along the axes of the plane: what a profile is within.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// A [`Superpolygon`]: what is within the curve, `radius` being what its radius of 1 becomes.
    #[must_use]
    pub fn superpolygon(curve: Gielis, radius: f64) -> Profile {
        Superpolygon::new(curve, radius).into()
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

    /// The column over the profile: the solid that is this profile at every z. It is unbounded.
    #[must_use]
    pub fn column(&self) -> Solid {
        Sweep::Column.of(self, self.0.clone(), None)
    }

    #[cfg(feature = "formula")]
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
        Profile(Solid::formula(tree, crate::Bounds::new(min, max)))
    }
}

/// The plane shape of a formula of x and y, whose box is infinite along z.
#[cfg(feature = "formula")]
impl From<crate::Formula> for Profile {
    fn from(formula: crate::Formula) -> Profile {
        Profile(Solid::from(formula))
    }
}

impl From<&Profile> for Profile {
    /// The same profile; a reference count.
    fn from(profile: &Profile) -> Profile {
        profile.clone()
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
