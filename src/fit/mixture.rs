//! The last steps: points are of the surface, with normal noise, or strewn evenly over the box.
//!
//! ```text
//!     p = (1 − w)·N(d; σ²)/Area / ((1 − w)·N(d; σ²)/Area + w/V)
//! ```
//!
//! Expectation and maximisation in turn: the chance p of each point, then the model by steps that
//! the points count in by p, then σ and w.
//!
//! Source: W. Liu et al., *Robust and accurate superquadric recovery: a probabilistic approach*
//! (2022).

use std::f64::consts::{LOG2_E, TAU};

use super::cost::Cost;
use super::kernel::{Chance, Model, Number, Sums, pass_by_chance};
use super::samples::Samples;
use super::solve::{Fitted, Problem, step};

/// Models that are off by less than this, of a cloud of size 1, are told apart by the number of
/// their parameters only.
const NOTHING: f64 = 1e-5;

/// A model among strewn points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture<M> {
    pub(super) model: M,
    /// The standard deviation of the noise.
    pub(super) noise: f64,
    /// The share of the strewn points.
    pub(super) strewn: f64,
    /// The volume that they are in.
    pub(super) volume: f64,
    /// The area's logarithm if it is not to be the model's.
    pub(super) log_area: Option<f64>,
}

/// How the last steps are made.
#[derive(Clone, Copy)]
pub(super) struct Polish {
    pub(super) rounds: usize,
    pub(super) steps: usize,
    /// Weight of the area's logarithm a point.
    pub(super) area: f64,
    /// How many points there are with those that are left out as they are far from the surface.
    pub(super) all: usize,
    pub(super) cost: Cost,
}

/// What a mixture says of points.
pub(super) struct Weighed<const N: usize> {
    /// How far each point is from the surface.
    pub(super) residuals: Vec<f64>,
    /// The chance of each point to be of it.
    pub(super) chances: Vec<f64>,
    /// The sums of the points by their chances.
    pub(super) sums: Sums<N>,
}

/// Damping of the last steps, which are short.
const DAMPING: f64 = 1e-4;

impl<M: Copy> Mixture<M> {
    /// The chance of a point to be of the surface.
    pub(super) fn chance<const N: usize>(&self) -> Chance
    where
        M: Model<N>,
    {
        let log_area = self.log_area();
        let square = self.noise * self.noise;
        let even = self.strewn / self.volume * TAU.sqrt() * self.noise / (1.0 - self.strewn);
        Chance { curve: 0.5 * LOG2_E / square, shift: even.log2() + log_area * LOG2_E }
    }

    /// The density of the surface's points at this distance.
    fn on(&self, log_area: f64, distance: f64) -> f64 {
        let normal = (-0.5 * (distance / self.noise).powi(2) - log_area).exp() / (TAU.sqrt() * self.noise);
        (1.0 - self.strewn) * normal
    }

    /// The same mixture with as much noise as nobody asks for.
    fn tolerant(&self) -> Mixture<M> {
        Mixture { noise: self.noise.max(NOTHING), ..*self }
    }

    /// Expectation and maximisation by turns.
    pub(super) fn polish<E: Number, const N: usize>(&mut self, samples: &Samples<E>, how: Polish) -> Fitted<M, E>
    where
        M: Model<N>,
    {
        let len = samples.len();
        let mut chances = vec![E::default(); samples.padded()];
        let mut fitted = Fitted { model: self.model, residuals: chances.clone(), evaluations: 0 };
        let problem = Problem { samples, cost: how.cost };
        for _ in 0..how.rounds {
            let sums: Sums<N> =
                pass_by_chance(&self.model, samples, self.chance(), &mut chances, how.cost, &mut fitted.residuals);
            fitted.evaluations += len;
            let (sum, square) = (sums.weight, self.noise * self.noise);
            problem.descend_from(sums, &mut fitted, &chances, [how.area * square * sum, square], how.steps, 1e-4);
            self.model = fitted.model;
            let square: f64 = chances[..len].iter().zip(&fitted.residuals).map(|(p, d)| p.to() * d.to().powi(2)).sum();
            self.learn::<E>(sum, square, how.all);
        }
        fitted
    }

    /// Noise and share from the chances' sum and that of the squares.
    fn learn<E: Number>(&mut self, sum: f64, square: f64, all: usize) {
        self.noise = (square / sum.max(1.0)).sqrt().max(E::GRAIN);
        self.strewn = (1.0 - sum / all as f64).clamp(1e-6, 0.999);
    }

    /// What is said of points.
    pub(super) fn weigh<const N: usize>(&self, samples: &Samples<f64>, cost: Cost) -> Weighed<N>
    where
        M: Model<N>,
    {
        let (mut residuals, mut chances) = (vec![0.0; samples.padded()], vec![0.0; samples.padded()]);
        let sums = pass_by_chance(&self.model, samples, self.chance(), &mut chances, cost, &mut residuals);
        residuals.truncate(samples.len());
        chances.truncate(samples.len());
        Weighed { residuals, chances, sums }
    }

    /// The very last steps, in double precision: a pass a step. What is said of the points by the
    /// normal distance then, and the evaluations that all of it took.
    pub(super) fn settle<const N: usize>(&mut self, samples: &Samples<f64>, how: Polish) -> (Weighed<N>, usize)
    where
        M: Model<N>,
    {
        let mut weighed = self.weigh(samples, how.cost);
        let mut passes = 1;
        for _ in 0..how.steps {
            let squares =
                |now: &Weighed<N>| -> f64 { weighed.chances.iter().zip(&now.residuals).map(|(p, d)| p * d * d).sum() };
            let (sum, square) = (weighed.sums.weight, self.noise * self.noise);
            let beside = [how.area * square * sum, square];
            let mut sums = weighed.sums;
            Problem::<f64>::complete(&mut sums, &self.model, beside);
            let Some(step) = step(&self.model, &sums, DAMPING) else { break };
            let mut next = Mixture { model: self.model.moved(&step), ..*self };
            next.learn::<f64>(sum, weighed.sums.square, how.all);
            let found = next.weigh(samples, how.cost);
            passes += 1;
            let mut after = Sums { square: squares(&found), ..found.sums };
            Problem::<f64>::complete(&mut after, &next.model, beside);
            if after.square >= sums.square || after.square.is_nan() {
                break;
            }
            (*self, weighed) = (next, found);
        }
        self.learn::<f64>(weighed.sums.weight, weighed.sums.square, how.all);
        if how.cost == Cost::Normal {
            // By the noise and the share as they are now, as points are that were not searched.
            let chance = self.chance();
            for (p, d) in weighed.chances.iter_mut().zip(&weighed.residuals) {
                *p = chance.at(*d);
            }
        } else {
            weighed = self.weigh(samples, Cost::Normal);
            passes += 1;
        }
        (weighed, passes * samples.len())
    }

    /// The logarithm of the area that the surface's points are spread over.
    pub(super) fn log_area<const N: usize>(&self) -> f64
    where
        M: Model<N>,
    {
        self.log_area.unwrap_or_else(|| self.model.log_area().0)
    }

    /// Schwarz's criterion of points by their residuals: the logarithm of their likelihood, less
    /// the price of the parameters. The larger the better.
    pub(super) fn criterion<const N: usize>(&self, residuals: impl ExactSizeIterator<Item = f64>) -> f64
    where
        M: Model<N>,
    {
        let (log_area, tolerant) = (self.log_area(), self.tolerant());
        let price = 0.5 * self.model.parameters() as f64 * (residuals.len() as f64).ln();
        residuals.map(|d| (tolerant.on(log_area, d) + self.strewn / self.volume).ln()).sum::<f64>() - price
    }

    /// That of points that the mixture was polished with.
    pub(super) fn criterion_of<E: Number, const N: usize>(
        &self,
        samples: &Samples<E>,
        polished: &Fitted<M, E>,
        cost: Cost,
    ) -> f64
    where
        M: Model<N>,
    {
        let of = |residuals: &[E]| self.criterion(residuals[..samples.len()].iter().map(|d| d.to()));
        if cost == Cost::Normal {
            of(&polished.residuals)
        } else {
            of(&Fitted::new(self.model, samples, Cost::Normal).residuals)
        }
    }
}
