//! Saving to a path, by extension.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::Duration;

use glam::{DVec3, Vec3};

use super::file::write_whole;
use super::{write_dxf, write_exr, write_gif, write_ply_points, write_png, write_stl, write_svg};
use crate::geom::{Image, Mesh, PointCloud, Polyline};

/// Why a file could not be saved. Whatever was at the path before is still there, and no
/// half-written file is left.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The extension of the file name stands for no format that can hold this.
    #[error("cannot save {}: {}; known: {known}", .path.display(), unknown(.extension))]
    Extension {
        /// The path that was asked for.
        path: PathBuf,
        /// Its extension, without the dot; empty if it has none.
        extension: String,
        /// The extensions that are known, as a list to read.
        known: &'static str,
    },
    /// The directory that the file should go to does not exist; saving does not make
    /// directories.
    #[error(
        "cannot save {}: there is no directory {}; it must be made first",
        .path.display(), .directory.display()
    )]
    Directory {
        /// The path that was asked for.
        path: PathBuf,
        /// The missing directory.
        directory: PathBuf,
    },
    /// The file cannot be written.
    #[error("cannot save {}: {source}", .path.display())]
    Write {
        /// The path that was asked for.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
}

fn unknown(extension: &str) -> String {
    if extension.is_empty() {
        "its name has no extension".into()
    } else {
        format!("the extension .{extension} is not known")
    }
}

/// A writer of one format.
type Writer<T> = fn(&T, &mut BufWriter<File>) -> io::Result<()>;

impl Mesh {
    /// Saves the mesh in the format that the extension stands for: `.stl`, binary STL.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// ```
    /// use rvachev::Mesh;
    ///
    /// let error = Mesh::default().save("bolt.xyz").unwrap_err();
    /// assert!(error.to_string().contains("known: .stl"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let writer = |extension: &str| -> Option<Writer<Mesh>> {
            match extension {
                "stl" => Some(|mesh, out| write_stl(mesh, out)),
                _ => None,
            }
        };
        save(self, path.as_ref(), writer, ".stl")
    }
}

/// A pixel whose pictures can be saved: see [`Image::save`]. This trait is closed.
pub trait Pixel: Sized + sealed::Pixel {}

mod sealed {
    pub trait Pixel: Sized {
        const KNOWN: &'static str;
        fn writer(extension: &str) -> Option<super::Writer<super::Image<Self>>>;
    }
}

/// Says which formats hold which pixels.
macro_rules! pixel {
    ($($pixel:ty: $known:literal, $($extension:literal => $write:ident),*;)*) => {$(
        impl Pixel for $pixel {}
        impl sealed::Pixel for $pixel {
            const KNOWN: &'static str = $known;
            fn writer(extension: &str) -> Option<Writer<Image<Self>>> {
                match extension {
                    $($extension => Some(|image, out| $write(image, out)),)*
                    _ => None,
                }
            }
        }
    )*};
}

pixel! {
    [u8; 4]: ".png", "png" => write_png;
    [u16; 4]: ".png", "png" => write_png;
    u8: ".png", "png" => write_png;
    u16: ".png", "png" => write_png;
    bool: ".png", "png" => write_png;
    Option<u32>: ".png", "png" => write_png;
    [f32; 4]: ".exr", "exr" => write_exr;
    f64: ".exr, .png", "exr" => write_exr, "png" => write_png;
    Vec3: ".exr, .png", "exr" => write_exr, "png" => write_png;
    DVec3: ".exr", "exr" => write_exr;
}

impl<P: Pixel> Image<P> {
    /// Saves the picture in the format that the extension stands for: `.png` for colours, greys,
    /// masks, leaves, depths and normals ([`Colors`](crate::Colors) says how), `.exr` for what is
    /// made of floats: light, depths, normals, positions.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        save(self, path.as_ref(), P::writer, P::KNOWN)
    }
}

impl Image {
    /// Saves pictures as an animation, each shown for `pause`: `.gif`.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause; that there are no pictures is one.
    pub fn save_animation(pictures: &[Image], pause: Duration, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let animation = (pictures, pause);
        let writer = |extension: &str| -> Option<Writer<(&[Image], Duration)>> {
            match extension {
                "gif" => Some(|(pictures, pause), out| write_gif(pictures, *pause, out)),
                _ => None,
            }
        };
        save(&animation, path.as_ref(), writer, ".gif")
    }
}

impl PointCloud {
    /// Saves the points in the format that the extension stands for: `.ply`, binary PLY.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let writer = |extension: &str| -> Option<Writer<PointCloud>> {
            match extension {
                "ply" => Some(|cloud, out| write_ply_points(cloud, out)),
                _ => None,
            }
        };
        save(self, path.as_ref(), writer, ".ply")
    }
}

impl Polyline {
    /// Saves polylines as a drawing in the format that the extension stands for: `.svg` or
    /// `.dxf`.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save_all(lines: &[Polyline], path: impl AsRef<Path>) -> Result<(), SaveError> {
        let writer = |extension: &str| -> Option<Writer<&[Polyline]>> {
            match extension {
                "svg" => Some(|lines, out| write_svg(lines, out)),
                "dxf" => Some(|lines, out| write_dxf(lines, out)),
                _ => None,
            }
        };
        save(&lines, path.as_ref(), writer, ".svg, .dxf")
    }
}

/// Saves `data` with the writer that `writer` gives for the extension in lower case.
fn save<T>(
    data: &T,
    path: &Path,
    writer: impl FnOnce(&str) -> Option<Writer<T>>,
    known: &'static str,
) -> Result<(), SaveError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let Some(write) = writer(&extension.to_ascii_lowercase()) else {
        return Err(SaveError::Extension { path: path.into(), extension: extension.into_owned(), known });
    };
    // The parent of a bare file name is the empty path, which stands for here.
    if let Some(directory) = path.parent()
        && !directory.as_os_str().is_empty()
        && !directory.exists()
    {
        return Err(SaveError::Directory { path: path.into(), directory: directory.into() });
    }
    write_whole(path, |out| write(data, out)).map_err(|source| SaveError::Write { path: path.into(), source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// A directory of its own for a test, removed at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Folder {
            let unique = format!("rvachev-save-{name}-{}", std::process::id());
            let path = std::env::temp_dir().join(unique);
            fs::create_dir_all(&path).unwrap();
            Folder(path)
        }

        fn entries(&self) -> usize {
            fs::read_dir(&self.0).unwrap().count()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn triangle() -> Mesh {
        Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap()
    }

    #[test]
    fn saves_and_replaces() {
        let folder = Folder::new("replace");
        let path = folder.0.join("part.STL");
        fs::write(&path, "something else, and longer than what follows".repeat(9)).unwrap();
        triangle().save(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap().len(), 134);
        let image = Image::new(1, 1, vec![[1, 2, 3, 255]]).unwrap();
        image.save(folder.0.join("dot.png")).unwrap();
        let read = image::open(folder.0.join("dot.png")).unwrap();
        assert_eq!(read.into_rgba8().into_raw(), [1, 2, 3, 255]);
        assert_eq!(folder.entries(), 2, "no temporary file is left");
    }

    #[test]
    fn unknown_extensions_are_listed() {
        let error = triangle().save("a/part.step").unwrap_err();
        assert_eq!(error.to_string(), "cannot save a/part.step: the extension .step is not known; known: .stl");
        let image = Image::new(1, 1, vec![[0; 4]]).unwrap();
        assert_eq!(
            image.save("view").unwrap_err().to_string(),
            "cannot save view: its name has no extension; known: .png"
        );
    }

    #[test]
    fn missing_directories_are_named() {
        let folder = Folder::new("directory");
        let path = folder.0.join("no/such/part.stl");
        let error = triangle().save(&path).unwrap_err();
        assert!(matches!(error, SaveError::Directory { .. }));
        let text = error.to_string();
        assert!(text.contains("part.stl") && text.contains("must be made first"));
        assert_eq!(folder.entries(), 0);
    }

    #[test]
    fn a_path_that_cannot_be_written_is_named_and_leaves_nothing() {
        let folder = Folder::new("unwritable");
        // A directory in the place of the file.
        let taken = folder.0.join("part.stl");
        fs::create_dir(&taken).unwrap();
        let error = triangle().save(&taken).unwrap_err();
        assert!(error.to_string().contains(&*taken.to_string_lossy()));
        // A file in the place of the directory.
        let file = folder.0.join("file");
        fs::write(&file, "x").unwrap();
        let error = triangle().save(file.join("part.stl")).unwrap_err();
        assert!(error.to_string().contains("part.stl"));
        // A file that must not be changed.
        let fixed = folder.0.join("fixed.stl");
        fs::write(&fixed, "x").unwrap();
        let mut permissions = fs::metadata(&fixed).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&fixed, permissions).unwrap();
        let error = triangle().save(&fixed).unwrap_err();
        assert!(error.to_string().contains("fixed.stl"));
        assert_eq!(fs::read(&fixed).unwrap(), b"x");
        assert_eq!(folder.entries(), 3);
    }

    #[test]
    fn a_write_that_fails_half_way_leaves_what_was_there() {
        let folder = Folder::new("half");
        let path = folder.0.join("part.stl");
        fs::write(&path, "before").unwrap();
        let failed = write_whole(&path, |out| {
            io::Write::write_all(out, &[1; 1 << 20])?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(failed.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"before");
        assert_eq!(folder.entries(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links() {
        let folder = Folder::new("link");
        let (file, link) = (folder.0.join("real.stl"), folder.0.join("link.stl"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        triangle().save(&link).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap().len(), 134);
    }
}
