//! The formulas: leaves, R-functions and deformations, each written once over
//! [`Real`](crate::Real).
//!
//! A leaf is a type that implements [`Field`]; adding one is a file here and a line below. A
//! deformation implements `Warp`. Both are erased (`AnyField`, `AnyWarp`) to the evaluations
//! that the engine runs: point, gradient, range, lanes, expression tree.

pub(crate) mod check;
mod cuboid;
mod cylinder;
mod deform;
mod erased;
mod gielis;
mod half_space;
mod leaf;
mod profile;
mod rfunction;
mod sphere;
mod superellipsoid;
mod supershape;
mod sweep;
mod zone;

pub use check::ParamError;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub(crate) use deform::{AnyWarp, Bend, Taper, Twist};
pub(crate) use erased::{AnyField, Chunk, Placement, smallest_stretch};
pub use gielis::{Gielis, Radius};
pub use half_space::HalfSpace;
pub use leaf::{Field, Kernel};
pub use profile::{Circle, Polygon, Rectangle, RegularPolygon, Superellipse, Superpolygon};
pub use rfunction::RFunction;
pub(crate) use rfunction::{Rule, saturate};
pub use sphere::Sphere;
pub use superellipsoid::Superellipsoid;
pub use supershape::Supershape;
pub(crate) use sweep::{HelixWarp, Revolution, Slab, Turn, Wedge};
pub(crate) use zone::Zone;

/// Coordinates beyond this many length units are evaluated as if they lay there, so that no
/// intermediate result overflows single precision.
pub const COORDINATE_LIMIT: f64 = 1e12;

/// Values saturate at this many length units, so that no chain of R-functions overflows.
pub const VALUE_LIMIT: f64 = 1e18;
