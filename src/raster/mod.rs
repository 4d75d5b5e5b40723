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
//! # Which method, and when rays instead
//!
//! [`CsgMethod::Intervals`] is the general one, and as quick as the others or quicker: for the
//! difference of two balls at 512 × 512, one thread, it takes 20, 23 and 39 ms with 4000, 16 000
//! and 260 000 triangles each, where stencil passes take 19, 28 and 64 (they draw operands two to
//! four times), sequences 20, 24 and 61. At 1024 × 1024 and few triangles the others are ahead by
//! a fifth. Passes and sequences are exact for convex operands only; they are what graphics
//! hardware can do, and are here to be compared and followed step by step.
//!
//! Against the [`Scene`](crate::Scene) of the implicit renderer (`cargo bench --bench raster`
//! prints it for models of 2 to 32 superellipsoids):
//!
//! * The depth image of meshes costs by the triangles and the pixels that they cover, whatever
//!   the surfaces are made of; that of a field costs by the pixels and by what the field costs.
//! * Meshes have a chord error, which falls as one over the number of triangles, and edges of
//!   a joint are exact to the pixel for the meshes. Rays find the surface itself.
//! * So: many views of few superquadrics, synthetic range images by the thousand, previews while
//!   parameters change, point sets that have no field: rasterise. Blends, fillets, offsets,
//!   lattices and formulas, close-ups, shadows, and whatever must be exact: cast rays.
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
