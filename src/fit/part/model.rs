//! A part as a list of steps: leaves added and subtracted one after the other.
//!
//! ```text
//!     S₀ = ∅,   Sᵢ = Sᵢ₋₁ ∪ leafᵢ  or  Sᵢ₋₁ \ leafᵢ,      J = Σ w[S ≠ T] + Σ price
//! ```
//!
//! What a further leaf c at a place of the list gains is linear in c: it changes the samples that
//! are not in the state before, or are, and that no later leaf decides.

use fearless_simd::Simd;

use super::bits::{Bits, Stakes, differing};
use super::pool::Pool;
use super::queries::Queries;

/// Gains below this are rounding.
pub(super) const GRAIN: f64 = 1e-9;

/// A leaf that is added or subtracted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Step {
    pub(super) adds: bool,
    pub(super) which: u32,
}

/// Steps and what comes of them.
#[derive(Clone, Debug)]
pub(super) struct Model {
    pub(super) steps: Vec<Step>,
    pub(super) state: Bits,
    /// J.
    pub(super) cost: f64,
}

/// What models are judged by.
#[derive(Clone, Copy)]
pub(super) struct Judge<'a> {
    pub(super) pool: &'a Pool,
    pub(super) queries: &'a Queries,
}

impl Judge<'_> {
    pub(super) fn bits(&self, step: Step) -> &Bits {
        &self.pool.candidates[step.which as usize].bits
    }

    fn apply(&self, state: &mut Bits, step: Step) {
        if step.adds { state.join(self.bits(step)) } else { state.remove(self.bits(step)) }
    }

    /// What comes of steps.
    pub(super) fn state(&self, steps: &[Step]) -> Bits {
        let mut state = Bits::none(self.queries.words());
        for step in steps {
            self.apply(&mut state, *step);
        }
        state
    }

    /// What the leaves cost; of equal ones that are added, or cut, the first costs most.
    pub(super) fn price(&self, steps: &[Step]) -> f64 {
        let candidate = |step: &Step| &self.pool.candidates[step.which as usize];
        let price = |(i, step): (usize, &Step)| {
            let own = candidate(step);
            let is_equal = |other: &Step| other.adds == step.adds && candidate(other).class == own.class;
            if steps[..i].iter().any(is_equal) { own.another } else { own.price }
        };
        steps.iter().enumerate().map(price).sum()
    }

    /// What is wrong, without what the leaves cost.
    pub(super) fn error(&self, state: &Bits) -> f64 {
        differing(state, &self.queries.inside, &self.queries.weights)
    }

    pub(super) fn model(&self, steps: Vec<Step>) -> Model {
        let state = self.state(&steps);
        let cost = self.error(&state) + self.price(&steps);
        Model { steps, state, cost }
    }

    /// What adding, or subtracting, at a place of the steps changes for better and worse.
    pub(super) fn stakes(&self, steps: &[Step], place: usize, adds: bool) -> Stakes {
        let before = self.state(&steps[..place]);
        let mut later = Bits::none(self.queries.words());
        for step in &steps[place..] {
            later.join(self.bits(*step));
        }
        let open = if adds { later.with(&before, |later, before| !later & !before) } else { before.without(&later) };
        self.staked(&open, adds)
    }

    /// Of samples that will become inside, or outside, those for which that is right and wrong.
    pub(super) fn staked(&self, open: &Bits, adds: bool) -> Stakes {
        let (inside, outside) = (open.and(&self.queries.inside), open.without(&self.queries.inside));
        if adds { Stakes { gain: inside, loss: outside } } else { Stakes { gain: outside, loss: inside } }
    }

    /// The candidates that gain most by stakes, less their price beside the steps, from the best
    /// down; none that gain nothing. Losses count `dear` times.
    pub(super) fn best(&self, steps: &[Step], stakes: &Stakes, adds: bool, dear: f64, count: usize) -> Vec<(f64, u32)> {
        let mut is_there = vec![false; self.pool.class_count as usize];
        for step in steps.iter().filter(|step| step.adds == adds) {
            is_there[self.pool.candidates[step.which as usize].class as usize] = true;
        }
        // Bits are counted by an instruction where there is one.
        rvachev_num::on_level!(simd => self.ranked(simd, &is_there, stakes, (adds, dear), count))
    }

    #[inline(always)]
    fn ranked<S: Simd>(
        &self,
        _: S,
        is_there: &[bool],
        stakes: &Stakes,
        (adds, dear): (bool, f64),
        count: usize,
    ) -> Vec<(f64, u32)> {
        let chances = stakes.chances();
        let weights = &self.queries.weights;
        let mut best: Vec<(f64, u32)> = Vec::with_capacity(count + 1);
        for (which, candidate) in (0..).zip(&self.pool.candidates) {
            if !candidate.may[usize::from(!adds)] {
                continue;
            }
            // Where little is wrong few words can gain, and most candidates are out before they are
            // counted.
            let least = if best.len() < count { GRAIN } else { best[count - 1].0 };
            let price = if is_there[candidate.class as usize] { candidate.another } else { candidate.price };
            let most = Stakes::most(&candidate.bits, &chances, weights) - price;
            if most <= least {
                continue;
            }
            let gain = most - dear * stakes.loss(&candidate.bits, weights);
            if gain > least {
                let at = best.partition_point(|other| other.0 >= gain);
                best.insert(at, (gain, which));
                best.truncate(count);
            }
        }
        best
    }
}
