//! The time that the questions to one solid have.
//!
//! It is over when the process has worked for so long: where others are at work, the clock on the
//! wall goes on alone, and where other tests are, that of the process is ahead.

use std::cell::RefCell;
use std::sync::LazyLock;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use rvachev::{CancelToken, Run};

/// So long one solid is asked; what is left then is not.
pub const PATIENCE: Duration = Duration::from_secs(5);

#[derive(Clone, Copy)]
struct Since(Instant, ProcessTime);

impl Since {
    fn now() -> Since {
        Since(Instant::now(), ProcessTime::now())
    }

    fn elapsed(&self) -> Duration {
        self.0.elapsed().min(self.1.elapsed())
    }
}

thread_local! {
    static CLOCK: RefCell<Option<Since>> = const { RefCell::new(None) };
}

/// While it is there, [`is_late`] tells. Others than those of a run, as of minimal programs, have
/// no end.
pub struct Clock(Since);

impl Clock {
    pub fn start() -> Clock {
        let since = Since::now();
        CLOCK.set(Some(since));
        Clock(since)
    }

    pub fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }

    pub fn is_late(&self) -> bool {
        self.elapsed() > PATIENCE
    }
}

impl Drop for Clock {
    fn drop(&mut self) {
        CLOCK.set(None);
    }
}

/// Whether the solid that is checked has been asked for long enough.
pub fn is_late() -> bool {
    CLOCK.with_borrow(|since| since.is_some_and(|since| since.elapsed() > PATIENCE))
}

/// A run that is cancelled after some seconds: what takes long is for other tests.
pub fn short() -> Run {
    static TIMER: LazyLock<Sender<(Since, CancelToken)>> = LazyLock::new(timer);
    let run = Run::default();
    drop(TIMER.send((Since::now(), run.cancel.clone())));
    run
}

/// Takes tokens, and cancels each when its time is over.
fn timer() -> Sender<(Since, CancelToken)> {
    let (sender, begun) = channel::<(Since, CancelToken)>();
    std::thread::spawn(move || {
        let mut waiting = Vec::new();
        loop {
            match begun.recv_timeout(Duration::from_millis(200)) {
                Ok(next) => waiting.push(next),
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {}
            }
            waiting.extend(begun.try_iter());
            waiting.retain(|(since, cancel)| {
                let is_over = since.elapsed() > PATIENCE;
                if is_over {
                    cancel.cancel();
                }
                !is_over
            });
        }
    });
    sender
}
