//! Leaves as solids.

use std::sync::Arc;

use fidget::context::Tree;
use glam::DVec3;

use super::{Node, Solid};
use crate::{Bounds, Cuboid, Cylinder, Field, Formula, HalfSpace, Sphere, Superellipsoid, Supershape};

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
}

impl Solid {
    /// The solid where `tree` is negative (fidget's sign); `bounds` must hold it. See [`Formula`].
    #[must_use]
    pub fn formula(tree: &Tree, bounds: Bounds) -> Solid {
        Formula::new(tree, bounds).into()
    }
}

impl From<Formula> for Solid {
    fn from(formula: Formula) -> Solid {
        Solid::from_node(Node::Leaf(Arc::new(formula)))
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

leaves!(Cuboid, Cylinder, HalfSpace, Sphere, Superellipsoid, Supershape);
