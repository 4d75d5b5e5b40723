//! Readers and writers under a run.

use std::io::{self, Read, Seek, SeekFrom, Write};

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

    /// The run.
    pub(super) fn run(&self) -> &'a Run {
        self.run
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
