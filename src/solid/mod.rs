//! Solids: the expression graph that a user builds.

mod blend;
mod build;
mod debug;
mod deform;
mod display;
mod equality;
mod error;
mod join;
mod length;
mod mirror;
mod name;
mod node;
mod operators;
mod paint;
mod profile;
mod rotate;
mod signature;
mod simplify;
mod sweep;
mod transform;

pub use error::SolidError;
pub(crate) use error::Trail;
pub use node::Solid;
pub(crate) use node::{Length, Node, Operation};
pub use paint::Paint;
pub use profile::{PlaneBounds, Profile};
pub use sweep::{Caps, Extrusion, Helix};
