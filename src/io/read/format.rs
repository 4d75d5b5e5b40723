//! The formats that are read, and what goes through all of them.

use std::io::Read;
use std::path::Path;

use super::limits::Limits;
use super::shape::Shape;
use super::{LoadError, LoadSettings, ReadError, glb, obj, ply, stl, threemf, xyz};
use crate::Run;
use crate::geom::{Mesh, PointCloud};

/// A format that meshes or point clouds are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileFormat {
    /// STL, binary or text, which the content tells.
    Stl,
    /// Wavefront OBJ.
    Obj,
    /// PLY: text, and binary in both orders.
    Ply,
    /// 3MF.
    ThreeMf,
    /// Binary glTF 2.0.
    Glb,
    /// Rows of numbers, between blanks or commas: points.
    Xyz,
}

/// The extensions of those that hold triangles, and of all.
const KNOWN: [(&str, FileFormat); 7] = [
    ("3mf", FileFormat::ThreeMf),
    ("glb", FileFormat::Glb),
    ("obj", FileFormat::Obj),
    ("ply", FileFormat::Ply),
    ("stl", FileFormat::Stl),
    ("csv", FileFormat::Xyz),
    ("xyz", FileFormat::Xyz),
];

impl FileFormat {
    /// The format that the extension of a path stands for, in upper or lower case; of `xyz` and
    /// `csv` only if `points` will do.
    pub(super) fn of(path: &Path, points: bool) -> Result<FileFormat, LoadError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let known = || KNOWN.iter().filter(|(_, format)| points || *format != FileFormat::Xyz);
        let found = known().find(|(name, _)| extension.eq_ignore_ascii_case(name));
        found.map(|(_, format)| *format).ok_or_else(|| LoadError::Extension {
            path: path.into(),
            extension: extension.into_owned(),
            known: known().map(|(name, _)| format!(".{name}")).collect::<Vec<_>>().join(", "),
        })
    }

    /// What a file holds, and by what its lengths are to be multiplied.
    pub(super) fn read(self, input: impl Read, settings: &Limits<'_>) -> Result<(Shape, f64), ReadError> {
        let (mut shape, scale) = self.parsed(input, settings)?;
        settings.run.check()?;
        shape.skip(settings)?;
        Ok((shape, scale))
    }

    fn parsed(self, input: impl Read, settings: &Limits<'_>) -> Result<(Shape, f64), ReadError> {
        let bytes = settings.bytes(input)?;
        // Some programs put a mark before text in UTF-8.
        let data = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        let own = settings.scale(settings.file_unit);
        Ok(match self {
            FileFormat::Stl => (stl::read(data, settings)?, own),
            FileFormat::Obj => (obj::read(data, settings)?, own),
            FileFormat::Ply => (ply::read(data, settings)?, own),
            FileFormat::Xyz => (xyz::read(data, settings)?, own),
            FileFormat::ThreeMf => {
                let (shape, unit) = threemf::read(data, settings)?;
                (shape, settings.scale(Some(unit)))
            }
            // Its lengths are metres, and have been converted with the maps of its nodes.
            FileFormat::Glb => (glb::read(data, settings)?, 1.0),
        })
    }
}

impl Mesh {
    /// Reads a mesh, which is the whole of `input`, which need not be buffered. With it come, where
    /// the file has them, normals, colours, texture coordinates and owners.
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    /// use rvachev::io::{FileFormat, LoadSettings, write_stl};
    ///
    /// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
    /// let mut bytes = Vec::new();
    /// write_stl(&mesh, &mut bytes)?;
    /// assert_eq!(Mesh::read(FileFormat::Stl, &bytes[..], &LoadSettings::default())?, mesh);
    /// let error = Mesh::read(FileFormat::Stl, &bytes[..100], &LoadSettings::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "byte 84: expected 50 bytes of a facet, found the end of the file after 16 bytes");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ReadError`], naming the line or the byte; that there are points but no triangles is one.
    pub fn read(format: FileFormat, input: impl Read, settings: &LoadSettings) -> Result<Mesh, ReadError> {
        Mesh::read_on(format, input, settings, &Run::default())
    }

    /// [`read`](Mesh::read) on a [`Run`], which is told roughly how much is read once the bytes are
    /// there, and may be cancelled.
    ///
    /// ```
    /// use rvachev::io::{FileFormat, LoadSettings, ReadError, write_ply};
    /// use rvachev::{Mesh, MeshSettings, Run, Solid};
    ///
    /// let mut bytes = Vec::new();
    /// write_ply(&Solid::sphere(1.0).mesh(&MeshSettings::default())?, &mut bytes)?;
    /// let run = Run::default();
    /// run.cancel.cancel();
    /// let stopped = Mesh::read_on(FileFormat::Ply, &bytes[..], &LoadSettings::default(), &run);
    /// assert!(matches!(stopped, Err(ReadError::Cancelled(_))));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`read`](Mesh::read), and [`ReadError::Cancelled`].
    pub fn read_on(
        format: FileFormat,
        input: impl Read,
        settings: &LoadSettings,
        run: &Run,
    ) -> Result<Mesh, ReadError> {
        read(format, input, settings, (0, run), Shape::into_mesh)
    }
}

impl PointCloud {
    /// Reads points, which are the whole of `input`, which need not be buffered; of a mesh its
    /// vertices. With them come normals and colours, where each point has one of its own.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::PointCloud;
    /// use rvachev::io::{FileFormat, LoadSettings};
    ///
    /// let rows = "x,y,z,red,green,blue\n1,2,3,200,0,0\n4,5,6,0,200,0\n";
    /// let cloud = PointCloud::read(FileFormat::Xyz, rows.as_bytes(), &LoadSettings::default())?;
    /// assert_eq!(cloud.positions(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
    /// assert_eq!(cloud.colors(), Some(&[[200, 0, 0], [0, 200, 0]][..]));
    /// # Ok::<(), rvachev::io::ReadError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ReadError`], naming the line or the byte.
    pub fn read(format: FileFormat, input: impl Read, settings: &LoadSettings) -> Result<PointCloud, ReadError> {
        PointCloud::read_on(format, input, settings, &Run::default())
    }

    /// [`read`](PointCloud::read) on a [`Run`], which is told roughly how much is read once the
    /// bytes are there, and may be cancelled.
    ///
    /// # Errors
    ///
    /// Those of [`read`](PointCloud::read), and [`ReadError::Cancelled`].
    pub fn read_on(
        format: FileFormat,
        input: impl Read,
        settings: &LoadSettings,
        run: &Run,
    ) -> Result<PointCloud, ReadError> {
        read(format, input, settings, (0, run), Shape::into_cloud)
    }
}

/// What is made of all of `input`, on a run; of so many `bytes`, 0 if that is not known.
pub(super) fn read<T>(
    format: FileFormat,
    input: impl Read,
    settings: &LoadSettings,
    (bytes, run): (u64, &Run),
    made: impl FnOnce(Shape, f64) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let run = run.stage(0.0, 1.0);
    let [to_read, _] = run.stages([0.9, 0.1]);
    let (shape, scale) = format.read(input, &Limits::new(settings, bytes, &to_read))?;
    run.check()?;
    let made = made(shape, scale)?;
    run.check()?;
    run.report(1.0);
    Ok(made)
}
