//! How far round an axis samples reach.

use std::f64::consts::TAU;

/// Bins, and their width in degrees.
const BINS: usize = 36;
const WIDTH: f64 = 10.0;

/// Shares of bins about an axis.
pub(super) struct Coverage {
    bins: [f64; BINS],
}

impl Coverage {
    /// Of angles in radians with weights.
    pub(super) fn of(angles: impl Iterator<Item = (f64, f64)>) -> Coverage {
        let mut bins = [0.0; BINS];
        for (angle, weight) in angles {
            let turn = (angle / TAU).rem_euclid(1.0);
            bins[((turn * BINS as f64) as usize).min(BINS - 1)] += weight;
        }
        Coverage { bins }
    }

    /// What is not in the longest gap, in degrees.
    pub(super) fn arc(&self) -> f64 {
        let (mut longest, mut gap) = (0, 0);
        for i in 0..2 * BINS {
            gap = if self.bins[i % BINS] > 0.0 { 0 } else { gap + 1 };
            longest = longest.max(gap);
        }
        WIDTH * (BINS - longest.min(BINS)) as f64
    }

    /// The share of the arc's bins that are not empty.
    pub(super) fn fill(&self) -> f64 {
        let full = self.bins.iter().filter(|b| **b > 0.0).count() as f64;
        full * WIDTH / self.arc().max(1.0)
    }

    /// The share that so many samples strewn over the arc leave full.
    pub(super) fn expected(&self, samples: usize) -> f64 {
        1.0 - (-(samples as f64) * WIDTH / self.arc().max(WIDTH)).exp()
    }

    /// The largest share of a bin.
    pub(super) fn largest(&self) -> f64 {
        let sum: f64 = self.bins.iter().sum();
        self.bins.iter().fold(0.0, |a, b| f64::max(a, *b)) / sum.max(f64::MIN_POSITIVE)
    }
}
