//! Binary PLY, the Stanford polygon format.
//!
//! ```text
//!   ply                               a header of text
//!   format binary_little_endian 1.0
//!   element vertex n                  x y z, normal, colour
//!   element face m                    3 and the three indices, colour, owner
//!   end_header
//!   ...                               the vertices, then the faces, without padding
//! ```
//!
//! Vertices stay shared. So a vertex has one normal, that of the vertex, or the mean of those
//! of its corners; OBJ and GLB keep them apart at creases. Colours are given to the vertices if
//! all corners of each agree, else to the faces: the mean of their corners. Texture coordinates
//! are left out.
//!
//! Source: G. Turk, The PLY Polygon File Format (1994).

use std::io::{self, BufWriter, Write};

use glam::Vec3;

use super::normal::corner_normal;
use super::watched::{size, watched};
use crate::Run;
use crate::geom::Mesh;

/// Writes a mesh as binary PLY, with normals, colours and owners if it has them. The writer
/// need not be buffered.
///
/// ```
/// use glam::Vec3;
/// use rvachev::io::write_ply;
/// use rvachev::Mesh;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
/// let mut bytes = Vec::new();
/// write_ply(&mesh, &mut bytes)?;
/// assert!(bytes.starts_with(b"ply\nformat binary_little_endian 1.0\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer.
pub fn write_ply(mesh: &Mesh, out: impl Write) -> io::Result<()> {
    write_ply_on(mesh, &Run::default(), out)
}

/// [`write_ply`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_ply`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_ply_on(mesh: &Mesh, run: &Run, out: impl Write) -> io::Result<()> {
    watched(size(mesh), run, out, |_, out| written(mesh, out))
}

fn written(mesh: &Mesh, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    let normals = vertex_normals(mesh);
    let colors = mesh.corner_colors().map(|colors| Colors::new(mesh, colors));
    let (of_vertices, of_faces) = match &colors {
        Some(Colors::Vertices(colors)) => (Some(colors), None),
        Some(Colors::Faces(colors)) => (None, Some(colors)),
        None => (None, None),
    };

    let color = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    write!(out, "ply\nformat binary_little_endian 1.0\ncomment written by rvachev\n")?;
    writeln!(out, "element vertex {}", mesh.positions().len())?;
    write!(out, "property float x\nproperty float y\nproperty float z\n")?;
    if normals.is_some() {
        write!(out, "property float nx\nproperty float ny\nproperty float nz\n")?;
    }
    if of_vertices.is_some() {
        out.write_all(color.as_bytes())?;
    }
    writeln!(out, "element face {}", mesh.triangles().len())?;
    writeln!(out, "property list uchar int vertex_indices")?;
    if of_faces.is_some() {
        out.write_all(color.as_bytes())?;
    }
    if mesh.owners().is_some() {
        writeln!(out, "property uint owner")?;
    }
    writeln!(out, "end_header")?;

    for (v, p) in mesh.positions().iter().enumerate() {
        for x in p.to_array() {
            out.write_all(&x.to_le_bytes())?;
        }
        if let Some(normals) = &normals {
            for x in normals[v].to_array() {
                out.write_all(&x.to_le_bytes())?;
            }
        }
        if let Some(colors) = of_vertices {
            out.write_all(&colors[v])?;
        }
    }
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        out.write_all(&[3])?;
        for i in triangle {
            out.write_all(&i.to_le_bytes())?;
        }
        if let Some(colors) = of_faces {
            out.write_all(&colors[t])?;
        }
        if let Some(owners) = mesh.owners() {
            out.write_all(&owners[t].to_le_bytes())?;
        }
    }
    out.flush()
}

/// One normal a vertex; a vertex that no triangle uses has 0.
fn vertex_normals(mesh: &Mesh) -> Option<Vec<Vec3>> {
    if let Some(normals) = mesh.normals() {
        return Some(normals.to_vec());
    }
    mesh.corner_normals()?;
    let mut sums = vec![Vec3::ZERO; mesh.positions().len()];
    for (corner, &v) in mesh.triangles().as_flattened().iter().enumerate() {
        sums[v as usize] += corner_normal(mesh, corner)?;
    }
    Some(sums.into_iter().map(Vec3::normalize_or_zero).collect())
}

enum Colors {
    Vertices(Vec<[u8; 4]>),
    Faces(Vec<[u8; 4]>),
}

impl Colors {
    fn new(mesh: &Mesh, corners: &[[[u8; 4]; 3]]) -> Colors {
        let mut vertices: Vec<Option<[u8; 4]>> = vec![None; mesh.positions().len()];
        let mut agree = mesh.triangles().as_flattened().iter().zip(corners.as_flattened());
        if agree.all(|(&v, &color)| *vertices[v as usize].get_or_insert(color) == color) {
            return Colors::Vertices(vertices.into_iter().map(Option::unwrap_or_default).collect());
        }
        let mean = |of: &[[u8; 4]; 3]| {
            std::array::from_fn(|k| {
                let sum: u16 = of.iter().map(|color| u16::from(color[k])).sum();
                ((sum + 1) / 3) as u8
            })
        };
        Colors::Faces(corners.iter().map(mean).collect())
    }
}
