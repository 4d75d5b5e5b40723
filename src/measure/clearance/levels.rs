//! How far a search has come that goes down level by level, of which nobody knows how many there
//! are.

use crate::{Cancelled, Run};

/// Each level is told as half of what is left.
pub(super) struct Levels<'a> {
    run: &'a Run,
    level: f64,
}

impl<'a> Levels<'a> {
    pub(super) fn new(run: &'a Run) -> Levels<'a> {
        Levels { run, level: 0.0 }
    }

    /// Goes on to the next level, unless the run is cancelled.
    pub(super) fn down(&mut self) -> Result<(), Cancelled> {
        self.level += 1.0;
        self.run.report(1.0 - (-self.level).exp2());
        self.run.check()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::Progress;

    #[test]
    fn levels_rise_by_halves_and_stop() {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = seen.clone();
        let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
        let run = Run { progress, ..Run::default() };
        let mut levels = Levels::new(&run);
        for _ in 0..3 {
            levels.down().unwrap();
        }
        let seen = seen.lock().unwrap().clone();
        assert_eq!(seen, [0.5, 0.75, 0.875]);
        run.cancel.cancel();
        assert!(levels.down().is_err());
    }
}
