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

use std::f64::consts::TAU;

use super::cost::Cost;
use super::kernel::{Model, Number};
use super::samples::Samples;
use super::solve::{Fitted, Problem};

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

impl<M: Copy> Mixture<M> {
    /// The chance of a point at this distance to be of the surface.
    pub(super) fn chance(&self, log_area: f64, distance: f64) -> f64 {
        let on = self.on(log_area, distance);
        on / (on + self.strewn / self.volume)
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

    /// Expectation and maximisation by turns; the evaluations that they took.
    pub(super) fn polish<E: Number, const N: usize>(&mut self, samples: &Samples<E>, how: Polish) -> usize
    where
        M: Model<N>,
    {
        let len = samples.len();
        let mut fitted = Fitted::new(self.model, samples, how.cost);
        let mut chances = vec![E::default(); samples.padded()];
        let problem = Problem { samples, cost: how.cost };
        for _ in 0..how.rounds {
            let sum = self.weigh(&fitted, &mut chances[..len]);
            let square = self.noise * self.noise;
            problem.descend(&mut fitted, &chances, [how.area * square * sum, square], how.steps, 1e-4);
            self.model = fitted.model;
            let square: f64 = chances[..len].iter().zip(&fitted.residuals).map(|(p, d)| p.to() * d.to().powi(2)).sum();
            self.noise = (square / sum.max(1.0)).sqrt().max(E::GRAIN);
            self.strewn = (1.0 - sum / how.all as f64).clamp(1e-6, 0.999);
        }
        fitted.evaluations
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

    /// That of the points themselves.
    pub(super) fn criterion_of<E: Number, const N: usize>(&self, samples: &Samples<E>) -> f64
    where
        M: Model<N>,
    {
        let fitted = Fitted::new(self.model, samples, Cost::Normal);
        self.criterion(fitted.residuals[..samples.len()].iter().map(|d| d.to()))
    }

    /// Chances by the residuals; their sum.
    fn weigh<E: Number, const N: usize>(&self, fitted: &Fitted<M, E>, chances: &mut [E]) -> f64
    where
        M: Model<N>,
    {
        let log_area = self.log_area();
        let mut sum = 0.0;
        for (chance, residual) in chances.iter_mut().zip(&fitted.residuals) {
            let p = self.chance(log_area, residual.to());
            *chance = E::of(p);
            sum += p;
        }
        sum
    }
}
