//! The erasing of what is built in: one function for each leaf and deformation.
//!
//! A leaf that is put behind a pointer brings all its kernels along. These functions are neither
//! generic nor inlined, so that the kernels are compiled here, and not again wherever a solid is
//! made. A user's own leaf is erased, with its kernels, in the user's crate.

use std::sync::Arc;

use crate::deform::{Bend, Cells, Elongate, Sectors, Taper, TaperBy, Twist, TwistBy};
use crate::profile::{Circle, Rectangle, RegularPolygon, Superellipse, Superpolygon};
use crate::sweep::{HelixWarp, Opening, Revolution, Span};
use crate::{
    AnyField, AnyWarp, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, GeneralisedSuperquadric, HalfSpace, Law,
    NetworkLattice, Prism, Pyramid, RoundedCuboid, SheetLattice, Slab, Sphere, Superellipsoid, Superhyperboloid,
    Supershape, Supertoroid, Torus, Wedge,
};

/// A built-in leaf or deformation, to be put behind a pointer.
pub trait Erase<Any: ?Sized> {
    /// Behind a pointer, with all its kernels.
    fn erase(self) -> Arc<Any>;
}

macro_rules! erase {
    ($any:ty: $($built_in:ty),* $(,)?) => {$(
        impl Erase<$any> for $built_in {
            #[inline(never)]
            fn erase(self) -> Arc<$any> {
                Arc::new(self)
            }
        }
    )*};
}

erase!(
    dyn AnyField: Capsule,
    Circle,
    Cone,
    Cuboid,
    Cylinder,
    Ellipsoid,
    GeneralisedSuperquadric,
    HalfSpace,
    NetworkLattice,
    Opening,
    Prism,
    Pyramid,
    Rectangle,
    RegularPolygon,
    RoundedCuboid,
    SheetLattice,
    Slab,
    Span,
    Sphere,
    Superellipse,
    Superellipsoid,
    Superhyperboloid,
    Superpolygon,
    Supershape,
    Supertoroid,
    Torus,
    Wedge,
);
#[cfg(feature = "formula")]
erase!(dyn AnyField: crate::Formula);
erase!(dyn AnyWarp: Bend, Cells, Elongate, HelixWarp, Revolution, Sectors, Taper, Twist);

impl<X: Law, Y: Law> Erase<dyn AnyWarp> for TaperBy<X, Y> {
    fn erase(self) -> Arc<dyn AnyWarp> {
        Arc::new(self)
    }
}

impl<A: Law> Erase<dyn AnyWarp> for TwistBy<A> {
    fn erase(self) -> Arc<dyn AnyWarp> {
        Arc::new(self)
    }
}
