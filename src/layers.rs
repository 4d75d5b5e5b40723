//! What is behind a picture: depths, normals, positions and leaves of its pixels, and how their
//! numbers become colours.

pub use crate::render::{GBuffer, Isolines, Layers, Surface, Transfer};
