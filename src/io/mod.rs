//! Writers of meshes and pictures: through [`std::io::Write`], and to a path by extension.
//!
//! | type | extension | format |
//! |---|---|---|
//! | [`Mesh`](crate::Mesh) | `.stl` | binary STL, see [`write_stl`] |
//! | [`Image`](crate::Image) | `.png` | 8-bit sRGB PNG, see [`write_png`] |

mod file;
mod png;
mod save;
mod stl;

pub use png::write_png;
pub use save::SaveError;
pub use stl::write_stl;
