//! Solids: the expression graph that a user builds.

mod blend;
mod build;
mod composed;
mod debug;
mod deform;
mod display;
mod equality;
mod error;
mod form;
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
mod tolerance;
mod transform;

pub(crate) use blend::BALL_OF_LEGS;
pub use composed::Repetition;
pub(crate) use composed::Sweep;
pub use error::SolidError;
pub(crate) use error::Trail;
pub use form::{DeformationForm, Form, LeafForm};
pub(crate) use node::Node;
pub use node::{Length, Operation, Solid};
pub use paint::Paint;
pub use profile::{PlaneBounds, Profile};
pub use sweep::{Extrusion, Helix};
pub(crate) use tolerance::check as check_tolerance;
