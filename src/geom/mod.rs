//! Plain data that other modules make and use: meshes, images, cameras.
//!
//! Nothing here evaluates, renders or reads files. A type has private fields where they must
//! agree with one another ([`Mesh`], [`Image`]) and public ones where any combination can at
//! least be written down ([`Camera`], checked by [`Camera::check`]).

mod camera;
mod image;
mod mesh;
mod quad_mesh;

pub use camera::{Camera, CameraError, Projection, Rays};
pub use image::{Image, ImageError};
pub use mesh::{Mesh, MeshError};
pub use quad_mesh::{Corner, QuadMesh};
