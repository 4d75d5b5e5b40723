//! Writers of meshes, points, drawings and pictures: through [`std::io::Write`], and to a path by
//! extension; readers of meshes and points: through [`std::io::Read`], and from a path.
//!
//! # Readers
//!
//! [`Mesh::load`](crate::Mesh::load) and [`PointCloud::load`](crate::PointCloud::load) by
//! extension, [`Mesh::read`](crate::Mesh::read) and [`PointCloud::read`](crate::PointCloud::read)
//! by [`FileFormat`]. They are in the feature `import`.
//!
//! | format | read | not read: an error |
//! |---|---|---|
//! | STL | binary and text, which the content tells | |
//! | OBJ | v, vt, vn, f, colours behind v; in any order | |
//! | PLY | text, binary in both orders; faces and strips; of other elements and properties any | |
//! | 3MF | meshes and components, in other parts of the archive too; colours, unit; UTF-8 and UTF-16 | what is encrypted |
//! | GLB | triangles, strips, fans, points; accessors of any kind, sparse ones too; nodes | data beside the file, compression |
//! | XYZ, CSV | rows of numbers, with names above the columns or without | |
//!
//! Polygons become triangles within them. Files are not trusted: archives are unpacked by `zip`,
//! XML and JSON parsed by `quick-xml` and `serde_json`, which take whatever bytes there are and are
//! kept well; they unpack no more than [`LoadSettings::most_bytes`]. All else is read here, so that
//! errors tell the line or byte, and no header is believed that claims more than there is.
//!
//! # Writers
//!
//! | type | extension | format | carries |
//! |---|---|---|---|
//! | [`Mesh`](crate::Mesh) | `.stl` | STL, binary or text, see [`write_stl`] | facets |
//! | | `.obj` | OBJ, see [`write_obj`] | normals and texture per corner |
//! | | `.ply` | binary PLY, see [`write_ply`] | normals per vertex, colours, owners |
//! | | `.glb` | binary glTF, see [`write_glb`] | normals, colours and texture per corner, unit |
//! | | `.3mf` | 3MF, see [`write_3mf`] | colours per corner, unit |
//! | [`Image`](crate::Image) | `.png` | PNG of 8 and 16 bits, see [`write_png`] | |
//! | | `.exr` | OpenEXR, see [`write_exr`] | |
//! | images in a row | `.gif` | animated GIF, see [`write_gif`] | |
//! | [`PointCloud`](crate::PointCloud) | `.ply` | binary PLY, see [`write_ply_points`] | normals |
//! | [`Polyline`](crate::Polyline)s | `.svg`, `.dxf` | see [`write_svg`] and [`write_dxf`] | |
//!
//! Each of them has a second form on a [`Run`](crate::Run), which is told how far it is and may be
//! cancelled ([`write_stl_on`]); what saves to a path has it too
//! ([`Mesh::save_on`](crate::Mesh::save_on)).
//!
//! No writer joins vertices by their position, and only GLB splits them: where the corners of
//! a vertex carry different normals, colours or texture coordinates.

#[cfg(not(all(feature = "exr", feature = "threemf")))]
mod absent;
mod drawing;
#[cfg(feature = "exr")]
mod exr;
mod file;
mod gif;
mod glb;
mod normal;
mod obj;
mod ply;
mod png;
mod points;
#[cfg(feature = "import")]
mod read;
pub(crate) mod save;
mod split;
mod stl;
mod text;
#[cfg(feature = "threemf")]
mod threemf;
pub(crate) mod unit;
mod watched;

use std::io;

pub use drawing::{write_dxf, write_dxf_on, write_svg, write_svg_on};
#[cfg(feature = "exr")]
pub use exr::{Floats, write_exr, write_exr_on};
pub use gif::{write_gif, write_gif_on};
pub use glb::{write_glb, write_glb_on};
pub use obj::{write_obj, write_obj_on};
pub use ply::{write_ply, write_ply_on};
pub use png::{Colors, write_png, write_png_on};
pub use points::{write_ply_points, write_ply_points_on};
#[cfg(feature = "import")]
pub use read::{FileFormat, FilePlace, LoadError, LoadSettings, ReadError};
pub use save::Pixel;
pub(crate) use save::{SaveSettings, save_rows};
pub use stl::{write_stl, write_stl_ascii, write_stl_ascii_on, write_stl_on};
#[cfg(feature = "threemf")]
pub use threemf::{write_3mf, write_3mf_on};
pub(crate) use unit::LengthUnit;

/// The error for a mesh that is too large for a format.
fn too_many(format: &str) -> io::Error {
    let what = format!("the mesh has more vertices or triangles than {format} can hold");
    io::Error::new(io::ErrorKind::InvalidInput, what)
}
