//! From a solid to a triangle mesh, and what can be said about a mesh.

mod check;
mod extract;
mod lattice;
mod paint;
mod signs;
mod solid;
mod table;

pub use check::MeshReport;
pub use lattice::{CellSize, Lattice, LatticeError};
pub use solid::{MeshSettings, MeshingError};
