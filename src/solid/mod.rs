//! Solids: the expression graph that a user builds.

mod build;
mod debug;
mod deform;
mod error;
mod join;
mod mirror;
mod node;
mod transform;

pub use error::SolidError;
pub(crate) use error::Trail;
pub use node::Solid;
pub(crate) use node::{Node, Operation};
