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

    /// What there is on a level in pieces that are looked at at once, unless the run is cancelled.
    pub(super) fn chunks<'b, T>(
        &self,
        all: &'b [T],
        at_once: usize,
    ) -> impl Iterator<Item = Result<&'b [T], Cancelled>> {
        let count = all.len() as f64;
        all.chunks(at_once).enumerate().map(move |(nth, some)| {
            self.run.check()?;
            self.told((nth * at_once) as f64 / count);
            Ok(some)
        })
    }

    /// Goes on to the next level, unless the run is cancelled.
    pub(super) fn down(&mut self) -> Result<(), Cancelled> {
        self.level += 1.0;
        self.told(0.0);
        self.run.check()
    }

    fn told(&self, part: f64) {
        self.run.report(1.0 - (-self.level - part).exp2());
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
        let mut count = 0;
        for _ in 0..3 {
            count += levels.chunks(&[0; 10], 5).map(|some| some.unwrap().len()).sum::<usize>();
            levels.down().unwrap();
        }
        assert_eq!(count, 30);
        let seen = seen.lock().unwrap().clone();
        assert_eq!([seen[0], seen[2], seen[4], seen[6]], [0.0, 0.5, 0.75, 0.875]);
        assert!(seen.is_sorted());
        run.cancel.cancel();
        assert!(levels.down().is_err() && levels.chunks(&[0], 1).all(|some| some.is_err()));
    }
}
