//! The search for a superellipsoid: starts, switches of the encoding, and a rescue.
//!
//! ```text
//!     starts on 96 points,  radial residual, robust        all
//!     again on 320, normal residual                        the best few
//!     switch: polar axis, dual by 45°                      the best one, if it explains more
//!     rescue: extreme exponents, frames turned by 45°      if it is still worse than the noise
//! ```

use glam::DVec3;
use rvachev_num::order;

use super::cost::Cost;
use super::kernel::Model;
use super::local::Local;
use super::samples::Samples;
use super::solve::{Fitted, Problem, Robust};
use super::starts::Frame;
use super::superquadric::Superquadric;
use crate::{Cancelled, Run};

/// A candidate and its score: the logarithm of the median residual, and half that of the area.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub(super) model: Superquadric,
    pub(super) score: f64,
    /// The standard deviation.
    pub(super) noise: f64,
}

/// The search over the points of a surface, which are in random order.
pub(super) struct Search<'a> {
    points: &'a [DVec3],
    local: &'a Local,
    cost: Cost,
    few: Samples<f32>,
    more: Samples<f32>,
    run: &'a Run,
    pub(super) evaluations: usize,
    /// How many models were descended from.
    pub(super) tried: usize,
}

/// How much worse a candidate on few points may be than the best one on more.
const SLACK: f64 = 0.26;

/// By how much it must then be better.
const GAIN: f64 = 0.02;

/// A fit is as good as the noise where its deviation is below this times that of local planes.
const GOOD: f64 = 1.3;

impl<'a> Search<'a> {
    pub(super) fn new(points: &'a [DVec3], local: &'a Local, cost: Cost, run: &'a Run) -> Search<'a> {
        let (few, more) = if local.view.is_some() { (128, 416) } else { (96, 320) };
        let first = |count: usize| Samples::new(points[..count.min(points.len())].iter().copied());
        Search { points, local, cost, few: first(few), more: first(more), run, evaluations: 0, tried: 0 }
    }

    fn fit(&mut self, start: Superquadric, more: bool, first: bool) -> Result<Candidate, Cancelled> {
        self.run.check()?;
        let samples = if more { &self.more } else { &self.few };
        let cost = if first && self.cost == Cost::Normal { Cost::Radial } else { self.cost };
        let area = if first && self.local.view.is_none() { 0.3 } else { 1.0 };
        let how = if first {
            Robust { rounds: 3, steps: 3, width: 3.0, area, gain: 1e-3 }
        } else {
            Robust { rounds: 2, steps: 3, width: 2.5, area, gain: 1e-3 }
        };
        let fitted = Problem { samples, cost }.robust(start, how);
        self.evaluations += fitted.evaluations;
        self.tried += 1;
        // How many there will be is not known: never more than nearly all.
        self.run.report(1.0 - 1.0 / (1.0 + 0.1 * self.tried as f64));
        Ok(candidate(&fitted, samples.len()))
    }

    fn is_good(&self, candidate: &Candidate) -> bool {
        self.local.view.is_none() && self.cost == Cost::Normal && candidate.noise < GOOD * self.local.rough
    }

    /// The first stage of many starts, the second of the best.
    fn best_of(&mut self, starts: Vec<Superquadric>, most: usize) -> Result<Candidate, Cancelled> {
        let mut first = starts.into_iter().map(|s| self.fit(s, false, true)).collect::<Result<Vec<_>, _>>()?;
        order::rising(&mut first, |a| a.score);
        let mut best: Option<Candidate> = None;
        for candidate in first.into_iter().take(most) {
            let next = self.fit(candidate.model, true, false)?;
            if best.as_ref().is_none_or(|b| next.score < b.score) {
                best = Some(next);
            }
            if self.is_good(&next) {
                break;
            }
        }
        // There is always a start.
        best.ok_or(Cancelled)
    }

    /// Switches to another encoding of the same solid while it helps.
    fn switched(&mut self, mut current: Candidate, times: usize) -> Result<Candidate, Cancelled> {
        for _ in 0..times {
            if self.is_good(&current) {
                break;
            }
            let mut others = Vec::new();
            for turns in 0..3 {
                let permuted = current.model.permuted(turns);
                if turns > 0 {
                    others.push(permuted);
                }
                others.extend(permuted.dual());
            }
            let mut best: Option<Candidate> = None;
            for other in others {
                let next = self.fit(other, false, false)?;
                if best.as_ref().is_none_or(|b| next.score < b.score) {
                    best = Some(next);
                }
            }
            let Some(best) = best.filter(|b| b.score < current.score + SLACK) else { break };
            let next = self.fit(best.model, true, false)?;
            if next.score >= current.score - GAIN {
                break;
            }
            current = next;
        }
        Ok(current)
    }

    /// In other encodings and with extreme exponents, too, if nothing else fits and it is to be
    /// `thorough`.
    pub(super) fn search(&mut self, thorough: bool) -> Result<Candidate, Cancelled> {
        if let Some(view) = self.local.view {
            let frame = Frame::one_sided(self.points, view);
            let starts = frame.starts(&[[0.5, 0.5], [1.3, 1.3], [0.5, 1.3], [1.3, 0.5]], 0.0);
            let best = self.best_of(starts, 4)?;
            return self.switched(best, 2);
        }
        let frame = Frame::complete(self.points);
        let best = self.best_of(frame.starts(&[[0.6, 0.6], [1.2, 1.2]], 0.0), 2)?;
        if !thorough {
            return Ok(best);
        }
        let mut best = self.switched(best, 1)?;
        if !self.is_good(&best) {
            let extreme = [[0.25, 0.25], [1.7, 0.4], [0.4, 1.7], [1.7, 1.7]];
            let mut starts = frame.starts(&extreme, 0.0);
            starts.extend(frame.starts(&extreme, std::f64::consts::FRAC_PI_4));
            let other = self.best_of(starts, 2)?;
            let other = self.switched(other, 1)?;
            if other.score < best.score {
                best = other;
            }
        }
        Ok(best)
    }
}

fn candidate(fitted: &Fitted<Superquadric, f32>, len: usize) -> Candidate {
    let noise = fitted.deviation(len);
    let model = fitted.model;
    let score = (noise + 1.5e-4 * model.semi_axes.max_element()).ln() + 0.5 * model.log_area().0;
    Candidate { model, score, noise }
}
