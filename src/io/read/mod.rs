//! Readers of meshes and point clouds: one for each format.
//!
//! Files are not trusted. Whatever the bytes are, a reader returns: with a mesh or a cloud, or with
//! an error that tells the line or the byte. Memory grows with the bytes that are there, not with
//! what a header says of them.

mod bytes;
mod error;
mod format;
mod glb;
mod limits;
mod load;
mod obj;
mod ply;
mod polygon;
mod settings;
mod shape;
mod stl;
mod text;
mod threemf;
mod weld;
mod xyz;

pub use error::{FilePlace, ReadError};
pub use format::FileFormat;
pub use load::LoadError;
pub use settings::LoadSettings;
