//! What turns plane shapes into solids: slabs and wedges that cut them off, and the maps that
//! carry them round an axis and along a helix.

mod caps;
mod helix;
mod opening;
mod revolution;
mod span;

pub use caps::Caps;
pub use helix::{HelixWarp, Turn};
pub use opening::Opening;
pub use revolution::Revolution;
pub use span::Span;
