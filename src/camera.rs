//! What a [`Camera`](crate::Camera) is made of: projection, intrinsics, rays, parts of its picture.

pub use crate::geom::{Corner, Intrinsics, Projection, Rays};
pub use crate::render::Window;
