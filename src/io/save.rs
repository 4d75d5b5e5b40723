//! Saving to a path, by extension.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::Duration;

use glam::{DVec3, Vec3};

use super::LengthUnit;
#[cfg(not(feature = "threemf"))]
use super::absent::write_3mf_on;
#[cfg(not(feature = "exr"))]
use super::absent::write_exr_on;
use super::drawing::{write_dxf_on, write_svg_on};
#[cfg(feature = "exr")]
use super::exr::write_exr_on;
use super::file::write_whole;
use super::gif::write_gif_on;
use super::glb::write_glb_on;
use super::obj::write_obj_on;
use super::ply::write_ply_on;
use super::png::{Rows, write_png_on, write_png_rows};
use super::points::write_ply_points_on;
use super::stl::{write_stl_ascii_on, write_stl_on};
#[cfg(feature = "threemf")]
use super::threemf::write_3mf_on;
use crate::geom::{Image, Mesh, PointCloud, Polyline};
use crate::{Cancelled, Run};

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
        known: String,
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
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

pub(super) fn unknown(extension: &str) -> String {
    if extension.is_empty() {
        "its name has no extension".into()
    } else {
        format!("the extension .{extension} is not known")
    }
}

/// How a mesh is saved, where the format leaves a choice.
///
/// ```no_run
/// use rvachev::{LengthUnit, MeshSettings, SaveSettings, Solid};
///
/// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
/// mesh.save_with("ball.3mf", &SaveSettings { unit: LengthUnit::Inch, ..SaveSettings::default() })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct SaveSettings {
    /// What a length of 1 means. Default: a millimetre. For `.3mf` and `.glb`; the other
    /// formats have no units.
    pub unit: LengthUnit,
    /// Whether `.stl` is written as text. Default: binary. The other formats have one form.
    pub ascii: bool,
    /// Whether `.obj` has normals even where a vertex has several: at creases, one for each
    /// corner. Default: no, as some readers (trimesh, and most that only draw) split the
    /// vertices there, and no longer see a closed mesh. `.glb` always has them.
    pub crease_normals: bool,
}

/// A writer of one format, for `T` by settings `S`.
type Writer<T, S> = fn(&T, &S, &Run, &mut BufWriter<File>) -> io::Result<()>;

/// Pictures, and how long each is shown.
type Animation<'a> = (&'a [Image], Duration);

/// The formats of a mesh, by extension.
const MESH_FORMATS: [(&str, Writer<Mesh, SaveSettings>); 5] = [
    ("3mf", |mesh, settings, run, out| write_3mf_on(mesh, settings, run, out)),
    ("glb", |mesh, settings, run, out| write_glb_on(mesh, settings, run, out)),
    ("obj", |mesh, settings, run, out| write_obj_on(mesh, settings, run, out)),
    ("ply", |mesh, _, run, out| write_ply_on(mesh, run, out)),
    ("stl", |mesh, settings, run, out| match settings.ascii {
        true => write_stl_ascii_on(mesh, run, out),
        false => write_stl_on(mesh, run, out),
    }),
];

impl Mesh {
    /// Saves the mesh in the format that the extension stands for:
    ///
    /// | extension | format | besides the shape |
    /// |---|---|---|
    /// | `.stl` | binary STL | |
    /// | `.obj` | OBJ | normals (at creases: on request) and texture coordinates per corner |
    /// | `.ply` | binary PLY | normals per vertex, colours, owners |
    /// | `.glb` | binary glTF | normals, colours and texture coordinates per corner; in millimetres |
    /// | `.3mf` | 3MF | colours per corner; in millimetres |
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// ```
    /// use rvachev::Mesh;
    ///
    /// let error = Mesh::default().save("bolt.xyz").unwrap_err();
    /// assert!(error.to_string().contains("known: .3mf, .glb, .obj, .ply, .stl"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.save_with(path, &SaveSettings::default())
    }

    /// [`save`](Mesh::save) with a choice of unit, of STL as text, of OBJ with all its normals.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save_with(&self, path: impl AsRef<Path>, settings: &SaveSettings) -> Result<(), SaveError> {
        self.save_on(path, settings, &Run::default())
    }

    /// [`save_with`](Mesh::save_with) on a [`Run`], which is told roughly how much is written, and
    /// may be cancelled: then whatever was at the path before is still there.
    ///
    /// ```
    /// use rvachev::error::SaveError;
    /// use rvachev::{CancelToken, MeshSettings, Run, SaveSettings, Solid};
    ///
    /// let run = Run { cancel: CancelToken::new(), ..Run::default() };
    /// run.cancel.cancel();
    /// let path = std::env::temp_dir().join("rvachev_save_on.stl");
    /// let ball = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
    /// let stopped = ball.save_on(&path, &SaveSettings::default(), &run);
    /// assert!(matches!(stopped, Err(SaveError::Cancelled(_))) && !path.exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause, or that the work was cancelled.
    pub fn save_on(&self, path: impl AsRef<Path>, settings: &SaveSettings, run: &Run) -> Result<(), SaveError> {
        save(self, settings, path.as_ref(), &MESH_FORMATS, run)
    }
}

/// A pixel whose pictures can be saved: see [`Image::save`]. This trait is closed.
pub trait Pixel: Sized + sealed::Pixel {}

mod sealed {
    pub trait Pixel: Sized + 'static {
        const FORMATS: &'static [(&'static str, super::Writer<super::Image<Self>, ()>)];
    }
}

/// Says which formats hold which pixels.
macro_rules! pixel {
    ($($pixel:ty: $($extension:literal => $write:ident),*;)*) => {$(
        impl Pixel for $pixel {}
        impl sealed::Pixel for $pixel {
            const FORMATS: &'static [(&'static str, Writer<Image<Self>, ()>)] =
                &[$(($extension, |image, (), run, out| $write(image, run, out))),*];
        }
    )*};
}

pixel! {
    [u8; 4]: "png" => write_png_on;
    [u16; 4]: "png" => write_png_on;
    u8: "png" => write_png_on;
    u16: "png" => write_png_on;
    bool: "png" => write_png_on;
    Option<u32>: "png" => write_png_on;
    [f32; 4]: "exr" => write_exr_on;
    f64: "exr" => write_exr_on, "png" => write_png_on;
    Vec3: "exr" => write_exr_on, "png" => write_png_on;
    DVec3: "exr" => write_exr_on;
}

impl<P: Pixel> Image<P> {
    /// Saves the picture in the format that the extension stands for: `.png` for colours, greys,
    /// masks, leaves, depths and normals ([`Colors`](crate::io::Colors) says how), `.exr` for what
    /// is made of floats: light, depths, normals, positions.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.save_on(path, &Run::default())
    }

    /// [`save`](Image::save) on a [`Run`], which is told how much is written, and may be
    /// cancelled: then whatever was at the path before is still there.
    ///
    /// ```
    /// use rvachev::error::SaveError;
    /// use rvachev::{Image, Run};
    ///
    /// let picture = Image::new(2, 1, vec![[200_u8, 100, 50, 255]; 2])?;
    /// let path = std::env::temp_dir().join("rvachev_picture_save_on.png");
    /// let run = Run::default();
    /// run.cancel.cancel();
    /// let stopped = picture.save_on(&path, &run);
    /// assert!(matches!(stopped, Err(SaveError::Cancelled(_))) && !path.exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause, or that the work was cancelled.
    pub fn save_on(&self, path: impl AsRef<Path>, run: &Run) -> Result<(), SaveError> {
        save(self, &(), path.as_ref(), P::FORMATS, run)
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
        Image::save_animation_on(pictures, pause, path, &Run::default())
    }

    /// [`save_animation`](Image::save_animation) on a [`Run`], which is told how many pictures are
    /// written, and may be cancelled before each: then whatever was at the path before is still
    /// there.
    ///
    /// ```
    /// use std::time::Duration;
    /// use rvachev::{Image, Progress, Run};
    ///
    /// let pictures = [0, 90, 180].map(|grey| Image::new(1, 1, vec![[grey, grey, grey, 255]]).unwrap());
    /// let progress = Some(Progress::new(|part| println!("{:.0} %", 100.0 * part)));
    /// let path = std::env::temp_dir().join("rvachev_save_animation_on.gif");
    /// Image::save_animation_on(&pictures, Duration::from_millis(40), &path, &Run { progress, ..Run::default() })?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause, or that the work was cancelled.
    pub fn save_animation_on(
        pictures: &[Image],
        pause: Duration,
        path: impl AsRef<Path>,
        run: &Run,
    ) -> Result<(), SaveError> {
        let formats: &[(&str, Writer<Animation<'_>, ()>)] =
            &[("gif", |(pictures, pause), (), run, out| write_gif_on(pictures, *pause, run, out))];
        save(&(pictures, pause), &(), path.as_ref(), formats, run)
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
        self.save_on(path, &Run::default())
    }

    /// [`save`](PointCloud::save) on a [`Run`], which is told roughly how much is written, and may
    /// be cancelled: then whatever was at the path before is still there.
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause, or that the work was cancelled.
    pub fn save_on(&self, path: impl AsRef<Path>, run: &Run) -> Result<(), SaveError> {
        let formats: &[(&str, Writer<PointCloud, ()>)] =
            &[("ply", |cloud, (), run, out| write_ply_points_on(cloud, run, out))];
        save(self, &(), path.as_ref(), formats, run)
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
        Polyline::save_all_on(lines, path, &Run::default())
    }

    /// [`save_all`](Polyline::save_all) on a [`Run`], which is told how much is written, and may be
    /// cancelled: then whatever was at the path before is still there.
    ///
    /// ```
    /// use glam::DVec2;
    /// use rvachev::error::SaveError;
    /// use rvachev::{Polyline, Run};
    ///
    /// let triangle = Polyline::closed(vec![DVec2::ZERO, DVec2::X, DVec2::Y]);
    /// let path = std::env::temp_dir().join("rvachev_save_all_on.svg");
    /// let run = Run::default();
    /// run.cancel.cancel();
    /// let stopped = Polyline::save_all_on(&[triangle], &path, &run);
    /// assert!(matches!(stopped, Err(SaveError::Cancelled(_))) && !path.exists());
    /// ```
    ///
    /// # Errors
    ///
    /// [`SaveError`], naming the file and the cause, or that the work was cancelled.
    pub fn save_all_on(lines: &[Polyline], path: impl AsRef<Path>, run: &Run) -> Result<(), SaveError> {
        let formats: &[(&str, Writer<&[Polyline], ()>)] = &[
            ("dxf", |lines, (), run, out| write_dxf_on(lines, run, out)),
            ("svg", |lines, (), run, out| write_svg_on(lines, run, out)),
        ];
        save(&lines, &(), path.as_ref(), formats, run)
    }
}

/// Saves `data` with the writer that `formats` has for the extension, in upper or lower case.
fn save<T, S>(
    data: &T,
    settings: &S,
    path: &Path,
    formats: &[(&str, Writer<T, S>)],
    run: &Run,
) -> Result<(), SaveError> {
    let known: Vec<&str> = formats.iter().map(|(known, _)| *known).collect();
    let (_, write) = formats[format_of(path, &known)?];
    let run = run.stage(0.0, 1.0);
    let saved = saved(path, |out| write(data, settings, &run.stage(0.0, 0.95), out));
    // A writer that is stopped has failed.
    saved.map_err(|error| run.check().map_or_else(SaveError::Cancelled, |()| error))?;
    run.report(1.0);
    Ok(())
}

/// Saves a picture as PNG whose rows come bit by bit.
pub(crate) fn save_rows(
    path: &Path,
    size: [u32; 2],
    has_alpha: bool,
    rows: impl FnOnce(&mut Rows<'_>) -> io::Result<()>,
) -> Result<(), SaveError> {
    format_of(path, &["png"])?;
    saved(path, |out| write_png_rows(size, has_alpha, rows, out))
}

/// The place among those that are `known` of the format that the extension stands for.
fn format_of(path: &Path, known: &[&str]) -> Result<usize, SaveError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    known.iter().position(|known| extension.eq_ignore_ascii_case(known)).ok_or_else(|| {
        let known: Vec<String> = known.iter().map(|known| format!(".{known}")).collect();
        SaveError::Extension { path: path.into(), extension: extension.clone().into_owned(), known: known.join(", ") }
    })
}

fn saved(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), SaveError> {
    // The parent of a bare file name is the empty path, which stands for here.
    if let Some(directory) = path.parent()
        && !directory.as_os_str().is_empty()
        && !directory.exists()
    {
        return Err(SaveError::Directory { path: path.into(), directory: directory.into() });
    }
    write_whole(path, write).map_err(|source| SaveError::Write { path: path.into(), source })
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
        let image = Image::new(1, 1, vec![[1u8, 2, 3, 255]]).unwrap();
        image.save(folder.0.join("dot.png")).unwrap();
        let read = image::open(folder.0.join("dot.png")).unwrap();
        assert_eq!(read.into_rgba8().into_raw(), [1, 2, 3, 255]);
        assert_eq!(folder.entries(), 2, "no temporary file is left");
    }

    #[test]
    fn unknown_extensions_are_listed() {
        let error = triangle().save("a/part.step").unwrap_err();
        assert_eq!(
            error.to_string(),
            "cannot save a/part.step: the extension .step is not known; known: .3mf, .glb, .obj, .ply, .stl"
        );
        let image = Image::new(1, 1, vec![[0u8; 4]]).unwrap();
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

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_written_to_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        let folder = Folder::new("device");
        for extension in ["stl", "obj", "ply", "glb", "3mf"] {
            let link = folder.0.join(format!("part.{extension}"));
            std::os::unix::fs::symlink("/dev/full", &link).unwrap();
            let error = triangle().save(&link).unwrap_err();
            let SaveError::Write { path, source } = &error else { panic!("{error}") };
            assert_eq!((path, source.kind()), (&link, io::ErrorKind::StorageFull));
            assert!(error.to_string().contains(&format!("part.{extension}")));
        }
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
        assert_eq!(folder.entries(), 5);
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

    #[cfg(unix)]
    #[test]
    fn links_to_what_is_not_there_yet_are_followed() {
        let folder = Folder::new("dangling");
        let (file, link, further) =
            (folder.0.join("real.stl"), folder.0.join("link.stl"), folder.0.join("further.stl"));
        std::os::unix::fs::symlink("real.stl", &link).unwrap();
        std::os::unix::fs::symlink(&link, &further).unwrap();
        triangle().save(&further).unwrap();
        assert!([&link, &further].iter().all(|link| fs::symlink_metadata(link).unwrap().is_symlink()));
        assert_eq!(fs::read(&file).unwrap().len(), 134);
        let (one, other) = (folder.0.join("one.stl"), folder.0.join("other.stl"));
        std::os::unix::fs::symlink(&one, &other).unwrap();
        std::os::unix::fs::symlink(&other, &one).unwrap();
        assert!(triangle().save(&one).unwrap_err().to_string().contains("one.stl"));
        assert_eq!(folder.entries(), 5);
    }
}
