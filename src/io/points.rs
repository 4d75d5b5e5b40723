//! PLY of point clouds.
//!
//! Binary, little-endian: x, y and z as doubles, so that nothing is lost; normals as floats and
//! colours as bytes where the cloud has them.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994).

use std::io::{self, BufWriter, Write};

use super::watched::watched;
use crate::Run;
use crate::geom::PointCloud;

/// Writes a point cloud as PLY. The writer need not be buffered.
///
/// ```
/// use glam::DVec3;
/// use rvachev::io::write_ply_points;
/// use rvachev::PointCloud;
///
/// let mut file = Vec::new();
/// write_ply_points(&PointCloud::new(vec![DVec3::X])?, &mut file)?;
/// assert!(file.starts_with(b"ply\nformat binary_little_endian 1.0\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer.
pub fn write_ply_points(cloud: &PointCloud, out: impl Write) -> io::Result<()> {
    write_ply_points_on(cloud, &Run::default(), out)
}

/// [`write_ply_points`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_ply_points`], and one that holds a [`Cancelled`](crate::Cancelled) if
/// cancelled: what is written by then is no whole file.
pub fn write_ply_points_on(cloud: &PointCloud, run: &Run, out: impl Write) -> io::Result<()> {
    watched(cloud.len(), run, out, |_, out| written(cloud, out))
}

fn written(cloud: &PointCloud, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", cloud.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    if cloud.normals().is_some() {
        for axis in ["nx", "ny", "nz"] {
            writeln!(out, "property float {axis}")?;
        }
    }
    if cloud.colors().is_some() {
        for channel in ["red", "green", "blue"] {
            writeln!(out, "property uchar {channel}")?;
        }
    }
    writeln!(out, "end_header")?;
    let mut record = Vec::with_capacity(39);
    for (i, p) in cloud.positions().iter().enumerate() {
        record.clear();
        record.extend(p.to_array().into_iter().flat_map(f64::to_le_bytes));
        if let Some(normals) = cloud.normals() {
            record.extend(normals[i].to_array().into_iter().flat_map(f32::to_le_bytes));
        }
        if let Some(colors) = cloud.colors() {
            record.extend(colors[i]);
        }
        out.write_all(&record)?;
    }
    out.flush()
}
