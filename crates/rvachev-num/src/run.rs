//! How to run a long job, apart from what it computes.
//!
//! Settings say what is wanted and decide the result; a [`Run`] says on how many threads, who
//! may stop the work and who hears of its progress, and never changes a byte of the result.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub use self::meter::Meter;

mod meter;

/// How to run a job: threads, cancelling, progress.
///
/// The default uses all cores, cannot be cancelled from elsewhere and reports to nobody.
///
/// ```
/// use rvachev::{Cancelled, Progress, Run};
///
/// let run = Run {
///     threads: 2,
///     progress: Some(Progress::new(|fraction| println!("{:.0} %", 100.0 * fraction))),
///     ..Run::default()
/// };
/// assert_eq!(run.install(|| 6 * 7), 42);
/// run.report(0.5);
///
/// // Any clone of the token, on any thread, stops the job.
/// run.cancel.clone().cancel();
/// assert_eq!(run.check(), Err(Cancelled));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Number of threads. 0, the default, means the current rayon pool, which has one thread
    /// a core unless the program has set it up otherwise.
    pub threads: usize,
    /// The token that stops the job.
    pub cancel: CancelToken,
    /// Who is told how far the job has come. Default: nobody.
    pub progress: Option<Progress>,
}

impl Run {
    /// Whether the job may go on.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] once the token has been cancelled.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Tells the sink that the given fraction of the work (0 to 1) is done. A fraction below
    /// one that was reported already is dropped. Cheap enough for every block of a mesh.
    pub fn report(&self, fraction: f64) {
        if let Some(progress) = &self.progress {
            progress.report(fraction);
        }
    }

    /// Calls `job` such that its rayon loops use [`Run::threads`] threads. Where that pool
    /// cannot be made, the job runs on the calling thread with whatever pool it belongs to.
    pub fn install<T: Send>(&self, job: impl FnOnce() -> T + Send) -> T {
        if self.threads == 0 || self.threads == rayon::current_num_threads() {
            return job();
        }
        let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build() else {
            return job();
        };
        // What is the same for all jobs is compiled once.
        let (mut job, mut done) = (Some(job), None);
        let run: &mut (dyn FnMut() + Send) = &mut || done = job.take().map(|job| job());
        pool.install(run);
        done.expect("the pool has run it")
    }

    /// The same run for a part of the job: its reports from 0 to 1 become reports from `from`
    /// to `to`. A job takes `stage(0.0, 1.0)` of the run that it is given, so that a run can
    /// serve several jobs one after the other, each of them starting at 0.
    #[must_use]
    pub fn stage(&self, from: f64, to: f64) -> Run {
        Run {
            threads: self.threads,
            cancel: self.cancel.clone(),
            progress: self.progress.as_ref().map(|p| p.stage(from, to)),
        }
    }

    /// The [stages](Run::stage) of a job, given how long each of them takes, in any unit.
    pub fn stages<const N: usize>(&self, times: [f64; N]) -> [Run; N] {
        let all: f64 = times.iter().sum();
        let mut end = 0.0;
        times.map(|time| {
            let start = end;
            end += time;
            self.stage(start / all, end / all)
        })
    }
}

/// A receiver of progress reports.
///
/// The function may be called from any thread, but never from two at once, and its argument
/// never decreases within a job: 0 at the start, 1 when all is done, in steps of a 1000th or
/// more. Clones share the function.
#[derive(Clone)]
pub struct Progress {
    sink: Arc<dyn Fn(f64) + Send + Sync>,
    highest: Arc<Highest>,
}

/// The highest fraction that was passed on.
struct Highest {
    /// A copy of `passed` as bits, to turn most reports away without the lock.
    seen: AtomicU64,
    passed: Mutex<f64>,
}

/// Reports closer together than this are not passed on: a mesh has far more blocks than a
/// progress bar has pixels.
const FINEST: f64 = 1e-3;

impl Progress {
    /// Reports go to `sink`, as a fraction of the job from 0 to 1. The sink must not report to
    /// the run that calls it.
    pub fn new(sink: impl Fn(f64) + Send + Sync + 'static) -> Progress {
        Progress::of(Arc::new(sink))
    }

    fn of(sink: Arc<dyn Fn(f64) + Send + Sync>) -> Progress {
        let none = f64::NEG_INFINITY;
        let highest = Arc::new(Highest { seen: AtomicU64::new(none.to_bits()), passed: Mutex::new(none) });
        Progress { sink, highest }
    }

    fn stage(&self, from: f64, to: f64) -> Progress {
        if from <= 0.0 && to >= 1.0 {
            // A job of its own: the same sink, from 0 on.
            return Progress::of(self.sink.clone());
        }
        let whole = self.clone();
        Progress::new(move |fraction| whole.report(from + (to - from) * fraction))
    }

    fn report(&self, fraction: f64) {
        // NaN stays NaN, which is never news.
        let fraction = fraction.clamp(0.0, 1.0);
        let is_news = |highest: f64| fraction >= highest + FINEST || (fraction > highest && fraction == 1.0);
        if !is_news(f64::from_bits(self.highest.seen.load(Ordering::Relaxed))) {
            return;
        }
        // The lock is held during the call, else two threads could call in the wrong order.
        let passed = self.highest.passed.lock();
        let mut passed = passed.unwrap_or_else(PoisonError::into_inner);
        if is_news(*passed) {
            *passed = fraction;
            self.highest.seen.store(fraction.to_bits(), Ordering::Relaxed);
            (self.sink)(fraction);
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let highest = f64::from_bits(self.highest.seen.load(Ordering::Relaxed));
        f.debug_tuple("Progress").field(&highest).finish()
    }
}

/// A flag that stops a job from another thread. Clones share the flag, and it cannot be
/// taken back: a new job wants a new token.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A token that is not cancelled.
    #[must_use]
    pub fn new() -> CancelToken {
        CancelToken::default()
    }

    /// Asks every job that holds this token to stop. They return [`Cancelled`] soon after.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether [`CancelToken::cancel`] was called.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The job was cancelled through its [`CancelToken`]; it has no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    fn recorder() -> (Arc<Mutex<Vec<f64>>>, Run) {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = seen.clone();
        let run =
            Run { threads: 2, progress: Some(Progress::new(move |f| sink.lock().unwrap().push(f))), ..Run::default() };
        (seen, run)
    }

    #[test]
    fn reports_never_decrease() {
        let (seen, run) = recorder();
        run.install(|| {
            (0..20_000u32).into_par_iter().for_each(|i| {
                run.report(f64::from(i % 5000) / 4999.0);
            });
        });
        run.report(f64::NAN);
        run.report(7.0);
        let seen = seen.lock().unwrap();
        assert!(seen.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(seen.last(), Some(&1.0));
        assert!(seen.len() <= 1001);
    }

    #[test]
    fn stages_nest_and_start_afresh() {
        let (seen, run) = recorder();
        for _ in 0..2 {
            let job = run.stage(0.0, 1.0);
            job.stage(0.0, 0.5).report(1.0);
            let second = job.stage(0.5, 1.0);
            second.report(0.0);
            second.report(0.5);
            second.report(1.0);
        }
        assert_eq!(*seen.lock().unwrap(), [0.5, 0.75, 1.0, 0.5, 0.75, 1.0]);
    }

    #[test]
    fn threads_and_cancel() {
        let run = Run { threads: 3, ..Run::default() };
        assert_eq!(run.install(rayon::current_num_threads), 3);
        let all = Run::default();
        assert_eq!(all.install(rayon::current_num_threads), rayon::current_num_threads());
        assert_eq!(run.check(), Ok(()));
        let stage = run.stage(0.2, 0.4);
        run.cancel.cancel();
        assert_eq!(stage.check(), Err(Cancelled));
        assert!(format!("{run:?}").contains("threads: 3"));
    }
}
