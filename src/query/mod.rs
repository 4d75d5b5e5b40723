//! What solids are asked: values, points, rays, meshes, paint.
//!
//! Here, above programs, meshes and distances, because an answer may need a solid's surface.

mod field;
mod inside;
#[cfg(feature = "formula")]
mod lower;
mod many;
mod mesh;
mod nearest;
mod painted;
mod palette;
mod place;
mod prepare;

pub(crate) use nearest::nearest;
pub use place::Face;
pub use prepare::PrepareError;
