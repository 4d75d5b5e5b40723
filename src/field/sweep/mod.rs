//! What turns plane shapes into solids: slabs and wedges that cut them off, and the maps that
//! carry them round an axis and along a helix.

mod helix;
mod opening;
mod revolution;
mod span;

pub(crate) use helix::{HelixWarp, Turn};
pub(crate) use opening::Opening;
pub(crate) use revolution::Revolution;
pub(crate) use span::Span;
