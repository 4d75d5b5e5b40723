//! Pictures of meshes and of CSG over them by depth buffers, without any field.
//!
//! ```text
//!    meshes ──► RasterView::layers ──► layers: where rays enter and leave each operand
//!                                         │
//!        stencil passes, sequences, or sorted intervals, tile by tile
//!                                         │
//!                                      Buffers: depth, stencil, operand and face
//! ```
//!
//! | file | |
//! |---|---|
//! | `view` | camera and picture: from points to pixels and depths, and back |
//! | `closed`, `deform` | meshes that enclose solids; moved, tapered, twisted, bent |
//! | `triangle`, `mesh_layers` | the rasteriser: edge functions on lanes, tiles, near plane |
//! | `layers` | what a method of CSG needs to know of an operand |
//! | `target`, `buffers` | the buffers of a tile and of a picture, and the passes over them |
//! | `stencil`, `sequence`, `intervals` | three methods of CSG; `csg` chooses |
//! | `expression` | trees of operands, lowered for each method |
//! | `picture` | shaded pictures, and pictures of depth |
//!
//! Which method to take, and when rays instead, is said at [`CsgMethod`], with what
//! `cargo bench --bench raster` measures.
//!
//! Sources: H. S. Kim et al. on superquadrics and the depth buffer; J. Goldfeather et al. (1986,
//! 1989); N. Stewart et al. (1998); J. Pineda (1988).

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
mod range;
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

pub(crate) use closed::Slant;
pub(crate) use target::Target;
