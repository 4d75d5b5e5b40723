//! Leaves as solids.

use std::sync::Arc;

use glam::DVec3;

use rvachev_field::{AnyField, Erase};

use super::{Node, Solid};
use crate::{
    Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Field, HalfSpace, Prism, Pyramid, RoundedCuboid, Slab, Sphere,
    Superellipsoid, Supertoroid, Torus, Wedge,
};

impl Solid {
    /// A user's own leaf as a solid. (The built-in ones are converted: `Solid::from(leaf)`.)
    #[must_use]
    pub fn new(leaf: impl Field) -> Solid {
        Solid::from_node(Node::Leaf(Arc::new(leaf)))
    }

    /// A [`Sphere`] about the origin.
    #[must_use]
    pub fn sphere(radius: f64) -> Solid {
        Sphere { radius }.into()
    }

    /// A box about the origin ([`Cuboid`]), `size` being its edge lengths.
    #[must_use]
    pub fn cuboid(size: impl Into<DVec3>) -> Solid {
        Cuboid { size: size.into() }.into()
    }

    /// A [`Cylinder`] about the z axis, centred at the origin.
    #[must_use]
    pub fn cylinder(radius: f64, height: f64) -> Solid {
        Cylinder { radius, height }.into()
    }

    /// A [`HalfSpace`]: all points p with `n·p ≤ offset`, n the normal made a unit vector.
    #[must_use]
    pub fn half_space(normal: impl Into<DVec3>, offset: f64) -> Solid {
        HalfSpace { normal: normal.into(), offset }.into()
    }

    /// A box about the origin with rounded edges ([`RoundedCuboid`]); `size` is from face to
    /// face.
    #[must_use]
    pub fn rounded_cuboid(size: impl Into<DVec3>, radius: f64) -> Solid {
        RoundedCuboid { size: size.into(), radius }.into()
    }

    /// A [`Cone`] about the z axis, centred at the origin; pointed if one radius is 0.
    #[must_use]
    pub fn cone(bottom_radius: f64, top_radius: f64, height: f64) -> Solid {
        Cone { bottom_radius, top_radius, height }.into()
    }

    /// A [`Capsule`] about the z axis, centred at the origin; `height` is from end to end.
    #[must_use]
    pub fn capsule(radius: f64, height: f64) -> Solid {
        Capsule { radius, height }.into()
    }

    /// A [`Torus`] about the z axis, centred at the origin.
    #[must_use]
    pub fn torus(radius: f64, tube: f64) -> Solid {
        Torus { radius, tube }.into()
    }

    /// An [`Ellipsoid`] about the origin.
    #[must_use]
    pub fn ellipsoid(semi_axes: impl Into<DVec3>) -> Solid {
        Ellipsoid { semi_axes: semi_axes.into() }.into()
    }

    /// A regular [`Prism`] along the z axis, centred at the origin; `radius` is that of the
    /// corners.
    #[must_use]
    pub fn prism(sides: u32, radius: f64, height: f64) -> Solid {
        Prism::new(sides, radius, height).into()
    }

    /// A regular [`Pyramid`] along the z axis, centred at the origin; `radius` is that of the
    /// corners of its base.
    #[must_use]
    pub fn pyramid(sides: u32, radius: f64, height: f64) -> Solid {
        Pyramid::new(sides, radius, height).into()
    }

    /// A [`Wedge`] about the origin: the lower half of a box of this size.
    #[must_use]
    pub fn wedge(size: impl Into<DVec3>) -> Solid {
        Wedge { size: size.into() }.into()
    }

    /// A [`Slab`] between two parallel planes about the origin.
    #[must_use]
    pub fn slab(normal: impl Into<DVec3>, thickness: f64) -> Solid {
        Slab { normal: normal.into(), thickness }.into()
    }

    /// A [`Superellipsoid`] about the origin.
    #[must_use]
    pub fn superellipsoid(semi_axes: impl Into<DVec3>, e1: f64, e2: f64) -> Solid {
        Superellipsoid::new(semi_axes, e1, e2).into()
    }

    /// A [`Supertoroid`] about the z axis: a tube of these half-widths, whose core is `ring`
    /// times them from the axis. `ring` is a number and no length: along x the solid reaches to
    /// `(ring + 1)·semi_axes.x`.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // A ring of radius 20 about a tube that is 3 wide and 4 high.
    /// let ring = Solid::supertoroid([1.5, 1.5, 2.0], 20.0 / 1.5, 1.0, 1.0);
    /// assert!((ring.bounds()?.max.x - 21.5).abs() < 1e-9);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn supertoroid(semi_axes: impl Into<DVec3>, ring: f64, e1: f64, e2: f64) -> Solid {
        Supertoroid::new(semi_axes, ring, e1, e2).into()
    }
}

#[cfg(feature = "formula")]
impl Solid {
    /// The solid where `tree` is negative (fidget's sign); `bounds` must hold it. See
    /// [`Formula`](crate::Formula).
    #[must_use]
    pub fn formula(tree: &fidget::context::Tree, bounds: crate::Bounds) -> Solid {
        crate::Formula::new(tree, bounds).into()
    }
}

impl Solid {
    /// A built-in leaf as a solid.
    pub(crate) fn leaf(leaf: impl Erase<dyn AnyField>) -> Solid {
        Solid::from_node(Node::Leaf(leaf.erase()))
    }
}

/// The built-in leaves as solids.
macro_rules! leaves {
    ($($leaf:ty),* $(,)?) => {$(
        impl From<$leaf> for Solid {
            fn from(leaf: $leaf) -> Solid {
                Solid::leaf(leaf)
            }
        }
    )*};
}

rvachev_field::solid_leaves!(leaves);
#[cfg(feature = "formula")]
rvachev_field::formula_leaves!(leaves);
