//! STL, binary and as text.
//!
//! ```text
//!   80 bytes   header, any text that does not begin with "solid"
//!    4         number of facets n, u32
//!   50 × n     normal, corner, corner, corner: 12 × f32; then 2 bytes, 0
//! ```
//!
//! ```text
//!   solid rvachev
//!     facet normal 0 0 1
//!       outer loop
//!         vertex 0 0 0          three of them
//!       endloop
//!     endfacet
//!   endsolid rvachev
//! ```
//!
//! In the binary form all numbers are little-endian. Facets are anticlockwise seen from outside,
//! their normals of length 1. The format has no units and no shared vertices, and in binary no room
//! for more than 2³² − 1 facets.
//!
//! Source: 3D Systems, StereoLithography Interface Specification (1988).

use std::io::{self, BufWriter, Write};

use super::text::Numbers;
use super::too_many;
use super::watched::{size, watched};
use crate::Run;
use crate::geom::Mesh;

/// Facets that are put together before they are handed to the writer.
const CHUNK: usize = 1024;

/// How much larger the text is.
const ASCII: usize = 5;

/// Writes a mesh as binary STL, in large pieces: the writer need not be buffered.
///
/// The normals of the facets are computed from the positions as they are written; that of a
/// facet without area is 0, as the format asks.
///
/// ```
/// use glam::Vec3;
/// use rvachev::io::write_stl;
/// use rvachev::Mesh;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
/// let mut bytes = Vec::new();
/// write_stl(&mesh, &mut bytes)?;
/// assert_eq!(bytes.len(), 84 + 50);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer, and [`io::ErrorKind::InvalidInput`] for a mesh of more than 2³² − 1
/// triangles.
pub fn write_stl(mesh: &Mesh, mut out: impl Write) -> io::Result<()> {
    let Ok(count) = u32::try_from(mesh.triangles().len()) else {
        return Err(too_many("binary STL"));
    };
    let mut header = [b' '; 80];
    let title = b"binary STL, written by rvachev";
    header[..title.len()].copy_from_slice(title);
    out.write_all(&header)?;
    out.write_all(&count.to_le_bytes())?;

    let mut bytes = Vec::with_capacity(50 * CHUNK);
    for chunk in mesh.triangles().chunks(CHUNK) {
        bytes.clear();
        for &triangle in chunk {
            for x in facet(mesh, triangle).as_flattened() {
                bytes.extend_from_slice(&x.to_le_bytes());
            }
            bytes.extend_from_slice(&[0, 0]);
        }
        out.write_all(&bytes)?;
    }
    out.flush()
}

/// [`write_stl`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_stl`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
///
/// ```
/// use rvachev::io::write_stl_on;
/// use rvachev::{Cancelled, MeshSettings, Run, Solid};
///
/// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
/// let mut bytes = Vec::new();
/// write_stl_on(&mesh, &Run::default(), &mut bytes)?;
/// assert_eq!(bytes.len(), 84 + 50 * mesh.triangles().len());
///
/// let run = Run::default();
/// run.cancel.cancel();
/// let error = write_stl_on(&mesh, &run, &mut bytes).unwrap_err();
/// assert!(error.get_ref().is_some_and(|inner| inner.is::<Cancelled>()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_stl_on(mesh: &Mesh, run: &Run, out: impl Write) -> io::Result<()> {
    watched(size(mesh), run, out, |_, out| write_stl(mesh, out))
}

/// Writes a mesh as STL in text, for programs that do not read the binary form: five times as
/// large. The writer need not be buffered.
///
/// # Errors
///
/// Those of the writer.
pub fn write_stl_ascii(mesh: &Mesh, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "solid rvachev")?;
    for &triangle in mesh.triangles() {
        let [normal, a, b, c] = facet(mesh, triangle).map(Numbers);
        writeln!(out, "facet normal {normal}\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet")?;
    }
    writeln!(out, "endsolid rvachev")?;
    out.flush()
}

/// [`write_stl_ascii`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_stl_ascii`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_stl_ascii_on(mesh: &Mesh, run: &Run, out: impl Write) -> io::Result<()> {
    watched(ASCII * size(mesh), run, out, |_, out| write_stl_ascii(mesh, out))
}

/// Unit normal and corners.
fn facet(mesh: &Mesh, triangle: [u32; 3]) -> [[f32; 3]; 4] {
    let [a, b, c] = mesh.corners(triangle);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    // Exact for the corners: they were f32.
    [normal, a, b, c].map(|v| v.as_vec3().to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn read_f32(bytes: &[u8]) -> f32 {
        f32::from_le_bytes(bytes.try_into().unwrap())
    }

    #[test]
    fn round_trip() {
        // Enough facets for several chunks, with coordinates that do not end in zeros.
        let positions: Vec<Vec3> = (0..3000u32)
            .map(|i| {
                let x = i as f32 * 0.1;
                Vec3::new(x.sin(), x.cos() * 1e-3, x / 7.0)
            })
            .collect();
        let triangles: Vec<[u32; 3]> = (0..2998).map(|i| [i, i + 1, i + 2]).collect();
        let mesh = Mesh::new(positions, triangles).unwrap();
        let mut bytes = Vec::new();
        write_stl(&mesh, &mut bytes).unwrap();

        assert_eq!(bytes.len(), 84 + 50 * mesh.triangles().len());
        assert!(!bytes.starts_with(b"solid"));
        assert_eq!(bytes[80..84], 2998u32.to_le_bytes());
        for (facet, &t) in bytes[84..].chunks(50).zip(mesh.triangles()) {
            let v: Vec<f32> = facet[..48].chunks(4).map(read_f32).collect();
            let corners: Vec<Vec3> = v.chunks(3).map(Vec3::from_slice).collect();
            assert_eq!(&corners[1..], t.map(|i| mesh.positions()[i as usize]));
            let normal = (corners[2] - corners[1]).cross(corners[3] - corners[1]);
            assert!((corners[0].length() - 1.0).abs() < 1e-6);
            assert!(normal.dot(corners[0]) > 0.0);
            assert_eq!(facet[48..], [0, 0]);
        }
    }

    #[test]
    fn degenerate_facets_have_no_normal() {
        let mesh = Mesh::new(vec![Vec3::ONE; 3], vec![[0, 1, 2]]).unwrap();
        let mut bytes = Vec::new();
        write_stl(&mesh, &mut bytes).unwrap();
        assert_eq!(bytes[84..96], [0; 12]);
    }

    #[test]
    fn errors_of_the_writer_arrive() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let error = write_stl(&Mesh::default(), Full).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
