//! What stops a reader: limits and a run.

use std::cell::Cell;
use std::io::Read;
use std::ops::Deref;

use super::{LoadSettings, ReadError};
use crate::Run;
use crate::io::watched::Watched;

/// The run is asked, and told, after so many vertices and triangles.
const AT_ONCE: u64 = 4096;

/// How much of the time the bytes take to arrive.
const ARRIVE: f64 = 0.2;

/// Bytes of a file to a vertex or a triangle, about.
const BYTES: f64 = 16.0;

/// Settings beside the run of a reader.
pub(super) struct Limits<'a> {
    settings: &'a LoadSettings,
    pub(super) run: &'a Run,
    /// How many bytes there are, or are expected.
    bytes: Cell<u64>,
    /// How many vertices and triangles there were.
    seen: Cell<u64>,
}

impl Deref for Limits<'_> {
    type Target = LoadSettings;

    fn deref(&self) -> &LoadSettings {
        self.settings
    }
}

impl<'a> Limits<'a> {
    /// For a file of so many bytes, as far as that is known.
    pub(super) fn new(settings: &'a LoadSettings, bytes: u64, run: &'a Run) -> Limits<'a> {
        Limits { settings, run, bytes: Cell::new(bytes), seen: Cell::new(0) }
    }

    /// All bytes, unless these are too many.
    pub(super) fn bytes(&self, input: impl Read) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        let to_read = self.run.stage(0.0, ARRIVE);
        // The memory grows with what arrives.
        let input = Watched::new(input, self.bytes.get(), &to_read);
        let arrived = input.take(self.most_bytes.saturating_add(1)).read_to_end(&mut bytes);
        self.run.check()?;
        arrived?;
        if bytes.len() as u64 > self.most_bytes {
            return Err(ReadError::Limit { what: "bytes", limit: self.most_bytes, setting: "most_bytes" });
        }
        self.bytes.set(bytes.len() as u64);
        Ok(bytes)
    }

    /// Whether there may be so many triangles.
    pub(super) fn triangles(&self, count: usize) -> Result<(), ReadError> {
        self.step()?;
        if count as u64 <= self.most_triangles {
            return Ok(());
        }
        Err(ReadError::Limit { what: "triangles", limit: self.most_triangles, setting: "most_triangles" })
    }

    /// Whether there may be so many vertices; never more than 32 bits count.
    pub(super) fn points(&self, count: usize) -> Result<(), ReadError> {
        self.step()?;
        let limit = self.most_points.min(u64::from(u32::MAX));
        if count as u64 <= limit {
            return Ok(());
        }
        Err(ReadError::Limit { what: "vertices", limit, setting: "most_points" })
    }

    /// Whether it may go on to the next vertex or triangle.
    pub(super) fn step(&self) -> Result<(), ReadError> {
        let seen = self.seen.get() + 1;
        self.seen.set(seen);
        if seen.is_multiple_of(AT_ONCE) {
            self.run.check()?;
            let share = BYTES * seen as f64 / self.bytes.get().max(1) as f64;
            self.run.report(ARRIVE + (1.0 - ARRIVE) * share.min(1.0));
        }
        Ok(())
    }
}
