//! How far a job of many steps has come.

use std::sync::atomic::{AtomicU64, Ordering};

use super::{Cancelled, Run};

/// Counts steps, and stops when the run is cancelled.
pub struct Meter<'a> {
    run: &'a Run,
    total: u64,
    done: Count,
}

/// A count in a line of the cache of its own: apart from what all threads read at each step, which
/// each count would take from the others.
#[repr(align(128))]
#[derive(Default)]
struct Count(AtomicU64);

impl<'a> Meter<'a> {
    /// A meter of a job of `total` steps.
    pub fn new(run: &'a Run, total: impl TryInto<u64>) -> Meter<'a> {
        Meter { run, total: total.try_into().unwrap_or(u64::MAX), done: Count::default() }
    }

    /// Called before each step.
    pub fn step(&self) -> Result<(), Cancelled> {
        self.count(1, 0);
        self.check()
    }

    /// Whether the job may go on.
    pub fn check(&self) -> Result<(), Cancelled> {
        self.run.check()
    }

    /// Called after some steps.
    pub fn add(&self, steps: u64) {
        self.count(steps, steps);
    }

    /// Counts some steps, of which some are done, if anybody asks for progress.
    fn count(&self, steps: u64, done: u64) {
        if self.run.progress.is_some() {
            let done = self.done.0.fetch_add(steps, Ordering::Relaxed) + done;
            self.run.report(done as f64 / self.total as f64);
        }
    }
}
