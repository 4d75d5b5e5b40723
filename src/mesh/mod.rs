//! From a solid to a triangle mesh, and what can be said about a mesh.

mod blocks;
mod bulk;
mod check;
mod components;
mod deciders;
mod deviation;
mod error;
mod extract;
mod extract_blocks;
mod feature;
mod groups;
mod hide;
mod lattice;
mod loops;
mod open_edges;
mod paint;
mod qef;
mod refine;
mod resolve;
mod roots;
mod sampler;
mod settings;
mod shown;
mod signs;
mod simplify;
mod slender;
mod slopes;
mod subject;
mod table;
mod thin;
mod volume;

pub use check::MeshReport;
pub use components::Component;
pub use error::MeshingError;
pub use lattice::{CellSize, Lattice, LatticeError};
pub use open_edges::OpenEdges;
pub use settings::{AtBounds, Features, MeshSettings, ThinFeatures};
pub use volume::{Volume, VolumeError, VolumeSettings};

pub(crate) use paint::{corner_colors, each_triangle};
pub(crate) use shown::{Hidden, reached};
pub(crate) use signs::BLOCK;
pub(crate) use slender::Slender;
pub(crate) use slopes::{Slope, Slopes};
pub(crate) use subject::{Subject, Whole};
pub(crate) use thin::thin_features_of;
