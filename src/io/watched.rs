//! Readers and writers under a run.

use std::io::{self, Read, Seek, SeekFrom, Write};

use crate::geom::Mesh;

use crate::Run;

/// A reader or a writer that ends when a run is cancelled, and tells it how many of the bytes have
/// passed.
pub struct Watched<'a, T> {
    inner: T,
    run: &'a Run,
    passed: u64,
    /// How many bytes are expected, about; 0 if that is not known.
    all: u64,
}

impl<'a, T> Watched<'a, T> {
    pub(super) fn new(inner: T, all: u64, run: &'a Run) -> Watched<'a, T> {
        Watched { inner, run, passed: 0, all }
    }

    /// Lets some bytes pass.
    fn pass(&mut self, bytes: impl FnOnce(&mut T) -> io::Result<usize>) -> io::Result<usize> {
        self.run.check().map_err(io::Error::other)?;
        let count = bytes(&mut self.inner)?;
        self.passed += count as u64;
        if self.all > 0 {
            self.run.report((self.passed as f64 / self.all as f64).min(1.0));
        }
        Ok(count)
    }
}

/// Bytes of a file to a vertex, a point or a triangle, about.
const BYTES: u64 = 30;

/// Writes on a run so many points and triangles, of which the run is told when their bytes pass.
pub(super) fn watched<W: Write>(
    count: usize,
    run: &Run,
    out: W,
    write: impl FnOnce(&Run, &mut Watched<'_, W>) -> io::Result<()>,
) -> io::Result<()> {
    staged(run, |run| write(run, &mut Watched::new(out, BYTES * count as u64, run)))
}

/// Writes on a run: what is told on the way is not yet all.
pub(super) fn staged(run: &Run, write: impl FnOnce(&Run) -> io::Result<()>) -> io::Result<()> {
    let run = run.stage(0.0, 1.0);
    run.check().map_err(io::Error::other)?;
    write(&run.stage(0.0, 0.95))?;
    run.report(1.0);
    Ok(())
}

/// Points and triangles of a mesh.
pub(super) fn size(mesh: &Mesh) -> usize {
    mesh.positions().len() + mesh.triangles().len()
}

impl<T: Read> Read for Watched<'_, T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.pass(|inner| inner.read(bytes))
    }
}

impl<T: Write> Write for Watched<'_, T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pass(|inner| inner.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<T: Seek> Seek for Watched<'_, T> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}
