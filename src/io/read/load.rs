//! Loading from a path, by extension.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::format::read;
use super::shape::Shape;
use super::{FileFormat, LoadSettings, ReadError};
use crate::geom::{Mesh, PointCloud};
use crate::io::save::unknown;
use crate::{Cancelled, Run};

/// Why a file could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The extension of the file name stands for no format that can hold this.
    #[error("cannot load {}: {}; known: {known}", .path.display(), unknown(.extension))]
    Extension {
        /// The path that was asked for.
        path: PathBuf,
        /// Its extension, without the dot; empty if it has none.
        extension: String,
        /// The extensions that are known, as a list to read.
        known: String,
    },
    /// The file cannot be read.
    #[error("cannot load {}: {source}", .path.display())]
    Read {
        /// The path that was asked for.
        path: PathBuf,
        /// The cause.
        source: ReadError,
    },
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn load<T>(
    path: &Path,
    points: bool,
    settings: &LoadSettings,
    run: &Run,
    made: impl FnOnce(Shape, f64) -> Result<T, ReadError>,
) -> Result<T, LoadError> {
    let format = FileFormat::of(path, points)?;
    let opened = || {
        let file = File::open(path)?;
        let bytes = file.metadata().map_or(0, |about| about.len());
        read(format, file, settings, (bytes, run), made)
    };
    opened().map_err(|error| match error {
        ReadError::Cancelled(cancelled) => LoadError::Cancelled(cancelled),
        source => LoadError::Read { path: path.into(), source },
    })
}

impl Mesh {
    /// Loads a mesh in the format that the extension stands for:
    ///
    /// | extension | format | besides the shape |
    /// |---|---|---|
    /// | `.stl` | STL, binary or text | |
    /// | `.obj` | OBJ | normals, texture coordinates, colours of vertices |
    /// | `.ply` | PLY, text or binary | normals and colours of vertices, colours and owners of faces |
    /// | `.glb` | binary glTF 2.0 | normals, colours, texture coordinates; in millimetres |
    /// | `.3mf` | 3MF | colours; in millimetres |
    ///
    /// Vertices of STL and GLB at one position become one, so that what is closed is closed. What
    /// [`Mesh::save`] wrote is read as it was, as far as the format holds it.
    ///
    /// Positions become single precision, some seven digits: of a part in coordinates of a map,
    /// some 4·10⁶ from the origin, they are rounded to steps of 0.25. Such a part is to be moved to
    /// the origin by the program that writes it.
    ///
    /// ```
    /// use rvachev::Mesh;
    ///
    /// let error = Mesh::load("bolt.step").unwrap_err();
    /// assert!(error.to_string().contains("known: .3mf, .glb, .obj, .ply, .stl"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte.
    pub fn load(path: impl AsRef<Path>) -> Result<Mesh, LoadError> {
        Mesh::load_with(path, &LoadSettings::default())
    }

    /// [`load`](Mesh::load) with a choice of units and limits.
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte.
    pub fn load_with(path: impl AsRef<Path>, settings: &LoadSettings) -> Result<Mesh, LoadError> {
        Mesh::load_on(path, settings, &Run::default())
    }

    /// [`load_with`](Mesh::load_with) on a [`Run`], which is told roughly how much is read, and may
    /// be cancelled.
    ///
    /// ```
    /// use rvachev::error::LoadError;
    /// use rvachev::{CancelToken, LoadSettings, Mesh, MeshSettings, Run, Solid};
    ///
    /// let path = std::env::temp_dir().join("rvachev_load_on.stl");
    /// Solid::sphere(1.0).mesh(&MeshSettings::default())?.save(&path)?;
    /// let run = Run { cancel: CancelToken::new(), ..Run::default() };
    /// assert!(Mesh::load_on(&path, &LoadSettings::default(), &run).is_ok());
    /// run.cancel.cancel();
    /// let stopped = Mesh::load_on(&path, &LoadSettings::default(), &run);
    /// assert!(matches!(stopped, Err(LoadError::Cancelled(_))));
    /// # std::fs::remove_file(path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte, or that the work
    /// was cancelled.
    pub fn load_on(path: impl AsRef<Path>, settings: &LoadSettings, run: &Run) -> Result<Mesh, LoadError> {
        load(path.as_ref(), false, settings, run, Shape::into_mesh)
    }
}

impl PointCloud {
    /// Loads points in the format that the extension stands for: `.ply`; `.xyz` and `.csv`, rows of
    /// numbers; the vertices of all formats of [meshes](Mesh::load). Normals and colours come with
    /// them where each point has one of its own.
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte.
    pub fn load(path: impl AsRef<Path>) -> Result<PointCloud, LoadError> {
        PointCloud::load_with(path, &LoadSettings::default())
    }

    /// [`load`](PointCloud::load) with a choice of units and limits.
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte.
    pub fn load_with(path: impl AsRef<Path>, settings: &LoadSettings) -> Result<PointCloud, LoadError> {
        PointCloud::load_on(path, settings, &Run::default())
    }

    /// [`load_with`](PointCloud::load_with) on a [`Run`], which is told roughly how much is read,
    /// and may be cancelled.
    ///
    /// # Errors
    ///
    /// [`LoadError`], naming the file and the cause, with the line or the byte, or that the work
    /// was cancelled.
    pub fn load_on(path: impl AsRef<Path>, settings: &LoadSettings, run: &Run) -> Result<PointCloud, LoadError> {
        load(path.as_ref(), true, settings, run, Shape::into_cloud)
    }
}
