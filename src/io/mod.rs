//! Writers of meshes, points, drawings and pictures: through [`std::io::Write`], and to a path by
//! extension.
//!
//! | type | extension | format |
//! |---|---|---|
//! | [`Mesh`](crate::Mesh) | `.stl` | binary STL, see [`write_stl`] |
//! | [`Image`](crate::Image) | `.png` | PNG of 8 and 16 bits, see [`write_png`] |
//! | | `.exr` | OpenEXR, see [`write_exr`] |
//! | images in a row | `.gif` | animated GIF, see [`write_gif`] |
//! | [`PointCloud`](crate::PointCloud) | `.ply` | binary PLY, see [`write_ply_points`] |
//! | [`Polyline`](crate::Polyline)s | `.svg`, `.dxf` | see [`write_svg`] and [`write_dxf`] |

mod drawing;
mod exr;
mod file;
mod gif;
mod png;
mod points;
mod save;
mod stl;

pub use drawing::{write_dxf, write_svg};
pub use exr::{Floats, write_exr};
pub use gif::write_gif;
pub use png::{Colors, write_png};
pub use points::write_ply_points;
pub use save::{Pixel, SaveError};
pub use stl::write_stl;
