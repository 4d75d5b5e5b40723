//! How far a job of equal steps has come.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::run::{Cancelled, Run};

/// Counts steps, and stops when the run is cancelled.
pub(super) struct Meter<'a> {
    run: &'a Run,
    done: AtomicUsize,
    total: usize,
}

impl<'a> Meter<'a> {
    pub(super) fn new(run: &'a Run, total: usize) -> Meter<'a> {
        Meter { run, done: AtomicUsize::new(0), total }
    }

    /// Called before each step.
    pub(super) fn step(&self) -> Result<(), Cancelled> {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        self.run.report(done as f64 / self.total as f64);
        self.run.check()
    }
}
