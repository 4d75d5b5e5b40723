//! Depth-buffer CSG.

mod buffers;
mod closed;
mod csg;
mod deform;
mod error;
mod expression;
mod intervals;
mod layers;
mod mesh_layers;
mod picture;
mod sequence;
mod stencil;
mod target;
mod triangle;
mod view;

pub use buffers::{Buffers, SurfaceId};
pub use closed::ClosedMesh;
pub use csg::CsgMethod;
pub use error::RasterError;
pub use expression::Csg;
pub use layers::{Facing, Fragments, LANES, LayerSource, Tile};
pub use mesh_layers::MeshLayers;
pub use view::RasterView;
