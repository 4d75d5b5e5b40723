//! What turns plane shapes into solids: slabs and wedges that cut them off, and the maps that
//! carry them round an axis and along a helix.

mod helix;
mod revolution;
mod slab;
mod wedge;

pub(crate) use helix::{HelixWarp, Turn};
pub(crate) use revolution::Revolution;
pub(crate) use slab::Slab;
pub(crate) use wedge::Wedge;
