//! Files that appear whole or not at all.
//!
//! Content goes to a temporary file in the directory of the target, which is flushed to the
//! disk and then renamed: a rename within a directory replaces the target in one step. When
//! anything fails, the temporary file is removed and the target is as it was.
//!
//! What is no file, as a pipe or a device, is written to as it is.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes a file through `content`; a symbolic link is followed, and an existing file keeps
/// its permissions.
pub(super) fn write_whole(path: &Path, content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let target = followed(path)?;
    let existing = fs::metadata(&target).ok();
    if let Some(existing) = &existing {
        if existing.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if !existing.is_file() {
            let mut out = BufWriter::with_capacity(1 << 16, OpenOptions::new().write(true).open(&target)?);
            content(&mut out)?;
            return out.flush();
        }
        // The rename would replace it all the same.
        if existing.permissions().readonly() {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
        }
    }

    let (file, temporary) = Temporary::beside(&target)?;
    let mut out = BufWriter::with_capacity(1 << 16, file);
    content(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    // Some file systems report a full disk no earlier than here.
    file.sync_all()?;
    if let Some(existing) = existing {
        file.set_permissions(existing.permissions())?;
    }
    drop(file);
    temporary.rename(&target)
}

/// What a path stands for: a link stays a link, and what it points to is replaced, or made if there
/// is nothing.
fn followed(path: &Path) -> io::Result<PathBuf> {
    // As many as Linux follows.
    const LINKS: u32 = 40;
    let mut target = path.to_path_buf();
    for _ in 0..LINKS {
        let Ok(link) = fs::read_link(&target) else { return Ok(target) };
        target = target.with_file_name("").join(link);
    }
    Err(io::Error::other("too many symbolic links, one to another"))
}

/// A file that is removed when it goes out of scope, unless it was renamed.
struct Temporary {
    path: PathBuf,
    renamed: bool,
}

impl Temporary {
    /// A new, empty file in the directory of `target`.
    fn beside(target: &Path) -> io::Result<(File, Temporary)> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            // Not made from the target's name, which may be as long as a name can be.
            let name = format!(".rvachev-{}-{count}.tmp", process::id());
            let path = target.with_file_name(name);
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => {
                    let renamed = false;
                    return Ok((file, Temporary { path, renamed }));
                }
                // Left by a process of the same number that was killed: the next name.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn rename(mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.renamed = true;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            // Nothing is left to report an error to; the first one is on its way.
            let _ = fs::remove_file(&self.path);
        }
    }
}
