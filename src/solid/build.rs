//! Leaves as solids.

use std::sync::Arc;

use glam::DVec3;

use super::{Node, Solid};
use crate::{
    Cuboid, Cylinder, Field, GeneralisedSuperquadric, HalfSpace, Sphere, Superellipsoid, Superhyperboloid, Supershape,
    Supertoroid,
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

    /// A [`HalfSpace`]: all points p with `normal·p ≤ offset`, for a unit normal.
    #[must_use]
    pub fn half_space(normal: impl Into<DVec3>, offset: f64) -> Solid {
        HalfSpace { normal: normal.into(), offset }.into()
    }

    /// A [`Superellipsoid`] about the origin.
    #[must_use]
    pub fn superellipsoid(semi_axes: impl Into<DVec3>, e1: f64, e2: f64) -> Solid {
        Superellipsoid::new(semi_axes, e1, e2).into()
    }

    /// A [`Supertoroid`] about the z axis.
    #[must_use]
    pub fn supertoroid(semi_axes: impl Into<DVec3>, ring: f64, e1: f64, e2: f64) -> Solid {
        Supertoroid::new(semi_axes, ring, e1, e2).into()
    }
}

/// The built-in leaves as solids. Their kernels are compiled here once and not, as those of
/// users' own leaves, where the solid is made.
macro_rules! leaves {
    ($($leaf:ty),* $(,)?) => {$(
        impl From<$leaf> for Solid {
            #[inline(never)]
            fn from(leaf: $leaf) -> Solid {
                Solid::new(leaf)
            }
        }
    )*};
}

leaves!(
    Cuboid,
    Cylinder,
    GeneralisedSuperquadric,
    HalfSpace,
    Sphere,
    Superellipsoid,
    Superhyperboloid,
    Supershape,
    Supertoroid
);
