//! Wavefront OBJ.
//!
//! ```text
//!   v  x y z          a position
//!   vt u v            texture coordinates, if the mesh has them
//!   vn x y z          a normal, if the mesh has them
//!   f  1/1/1 2/2/2 3/3/3      a triangle: position/texture/normal of each corner, from 1
//! ```
//!
//! Positions, texture coordinates and normals are listed apart, so that the vertices stay
//! shared whatever their corners carry. All the same, readers that keep one normal a vertex
//! (trimesh, most that draw) split the vertices at creases and end with an open mesh. So a mesh
//! with creases gets its normals on request only; without them, readers find them by the angle
//! between triangles. Colours and owners have no place in the format.
//!
//! Source: Wavefront Technologies, Advanced Visualizer Manual, appendix B1 (1995).

use std::io::{self, BufWriter, Write};

use super::SaveSettings;
use super::normal::corner_normal;
use super::split::Split;
use super::text::{Number, Numbers};
use super::watched::{size, watched};
use crate::Run;
use crate::geom::Mesh;

/// Writes a mesh as OBJ, with texture coordinates if it has them, and with normals if it has
/// one for each vertex, or on request ([`SaveSettings::crease_normals`]) one for each corner.
/// The writer need not be buffered.
///
/// ```
/// use glam::Vec3;
/// use rvachev::io::write_obj;
/// use rvachev::{Mesh, SaveSettings};
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
/// let mut text = Vec::new();
/// write_obj(&mesh, &SaveSettings::default(), &mut text)?;
/// assert_eq!(String::from_utf8(text)?, "# written by rvachev\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer, and [`io::ErrorKind::InvalidInput`] for normals or texture of a mesh
/// with more than 2³² − 1 corners.
pub fn write_obj(mesh: &Mesh, settings: &SaveSettings, out: impl Write) -> io::Result<()> {
    write_obj_on(mesh, settings, &Run::default(), out)
}

/// [`write_obj`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_obj`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_obj_on(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    watched(size(mesh), run, out, |run, out| written(mesh, settings, run, out))
}

fn written(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "# written by rvachev")?;
    for p in mesh.positions() {
        writeln!(out, "v {}", Numbers(p.to_array()))?;
    }
    let split = |is_wanted: bool, key: &dyn Fn(usize) -> [u32; 3]| match is_wanted {
        true => Split::new(mesh, "OBJ", run, |corner, _| key(corner)).map(Some),
        false => Ok(None),
    };
    let texture = |corner: usize| mesh.corner_texture().map_or([0.0; 2], |uv| uv[corner / 3][corner % 3]);
    let textures = split(mesh.corner_texture().is_some(), &|corner| {
        let [u, v] = texture(corner).map(f32::to_bits);
        [u, v, 0]
    })?;
    for &corner in textures.iter().flat_map(|split| &split.examples) {
        let [u, v] = texture(corner).map(Number);
        writeln!(out, "vt {u} {v}")?;
    }
    let normal = |corner: usize| corner_normal(mesh, corner).unwrap_or_default().to_array();
    let has_normals = mesh.normals().is_some() || mesh.corner_normals().is_some();
    let normals = split(has_normals, &|corner| normal(corner).map(f32::to_bits))?;
    let normals = normals.filter(|normals| settings.crease_normals || !normals.splits(mesh));
    for &corner in normals.iter().flat_map(|split| &split.examples) {
        writeln!(out, "vn {}", Numbers(normal(corner)))?;
    }
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        write!(out, "f")?;
        for (k, &v) in triangle.iter().enumerate() {
            // In 64 bits: counted from 1.
            let place = |split: &Split| u64::from(split.pairs[3 * t + k]) + 1;
            let v = u64::from(v) + 1;
            match (textures.as_ref().map(place), normals.as_ref().map(place)) {
                (None, None) => write!(out, " {v}")?,
                (Some(t), None) => write!(out, " {v}/{t}")?,
                (None, Some(n)) => write!(out, " {v}//{n}")?,
                (Some(t), Some(n)) => write!(out, " {v}/{t}/{n}")?,
            }
        }
        writeln!(out)?;
    }
    out.flush()
}
