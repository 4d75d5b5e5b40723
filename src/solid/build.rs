//! Leaves as solids.

use std::sync::Arc;

use glam::DVec3;

use super::{Node, Solid};
use crate::{Cuboid, Cylinder, Field, HalfSpace, Sphere, Superellipsoid};

impl Solid {
    /// A leaf as a solid: a built-in one or a user's own [`Field`].
    #[must_use]
    pub fn new(leaf: impl Field) -> Solid {
        Solid::from_node(Node::Leaf(Arc::new(leaf)))
    }

    /// A [`Sphere`] about the origin.
    #[must_use]
    pub fn sphere(radius: f64) -> Solid {
        Solid::new(Sphere { radius })
    }

    /// A box about the origin ([`Cuboid`]), `size` being its edge lengths.
    #[must_use]
    pub fn cuboid(size: impl Into<DVec3>) -> Solid {
        Solid::new(Cuboid { size: size.into() })
    }

    /// A [`Cylinder`] about the z axis, centred at the origin.
    #[must_use]
    pub fn cylinder(radius: f64, height: f64) -> Solid {
        Solid::new(Cylinder { radius, height })
    }

    /// A [`HalfSpace`]: all points p with `normal·p ≤ offset`, for a unit normal.
    #[must_use]
    pub fn half_space(normal: impl Into<DVec3>, offset: f64) -> Solid {
        Solid::new(HalfSpace { normal: normal.into(), offset })
    }

    /// A [`Superellipsoid`] about the origin.
    #[must_use]
    pub fn superellipsoid(semi_axes: impl Into<DVec3>, e1: f64, e2: f64) -> Solid {
        Solid::new(Superellipsoid::new(semi_axes, e1, e2))
    }
}

impl<F: Field> From<F> for Solid {
    fn from(leaf: F) -> Solid {
        Solid::new(leaf)
    }
}
