//! Solids: the expression graph that a user builds.

mod blend;
mod build;
mod debug;
mod error;
mod join;
mod node;
mod profile;
mod sweep;
mod transform;

pub(crate) use blend::Blend;
pub use error::SolidError;
pub(crate) use error::Trail;
pub use node::Solid;
pub(crate) use node::{Node, Operation};
pub use profile::{PlaneBounds, Profile};
pub use sweep::{Caps, Extrusion, Helix};
