//! Solids: the expression graph that a user builds.

mod build;
mod debug;
mod error;
mod join;
mod node;
mod transform;

pub use error::SolidError;
pub(crate) use error::Trail;
pub(crate) use node::{Node, Operation};
pub use node::Solid;
