//! Levenberg–Marquardt with bounds, and least squares that outliers count less and less in.
//!
//! ```text
//!     minimise  Σ wᵢ dᵢ² + v·ln Area          (JᵀWJ + λ·diag)·δ = −(JᵀWd + v/2·∇ ln Area)
//!     round:    m = 1.4826·median |d|          w = 1/(1 + (d/(k·m))²)²      (Geman and McClure)
//! ```
//!
//! The area's term stands for the likelihood of points that are spread over the surface: of two
//! solids that pass through the points it takes the smaller one.
//!
//! Sources: K. Madsen, H. Nielsen, O. Tingleff, *Methods for non-linear least squares problems*
//! (2004); S. Geman, D. McClure, *Statistical methods for tomographic image reconstruction* (1987).

use super::cost::Cost;
use super::kernel::{Model, Number, Sums, pass, residuals};
use super::linear::{median, solved};
use super::samples::Samples;

/// From the median of absolute deviations to the standard deviation of a normal distribution.
pub(super) const NORMAL: f64 = 1.4826;

/// What is minimised over which points.
pub(super) struct Problem<'a, E> {
    pub(super) samples: &'a Samples<E>,
    pub(super) cost: Cost,
}

/// How a robust fit is made.
#[derive(Clone, Copy)]
pub(super) struct Robust {
    /// How often weights are made anew.
    pub(super) rounds: usize,
    /// Steps between.
    pub(super) steps: usize,
    /// Where weights fall off, in standard deviations.
    pub(super) width: f64,
    /// Weight of the area's logarithm, in squares of the standard deviation a point.
    pub(super) area: f64,
    /// Relative gain of a step below which a round ends.
    pub(super) gain: f64,
}

/// A model with what it was judged by.
pub(super) struct Fitted<M, E> {
    pub(super) model: M,
    /// The residuals of the points.
    pub(super) residuals: Vec<E>,
    /// Points evaluated, padding left out.
    pub(super) evaluations: usize,
}

impl<M, E: Number> Fitted<M, E> {
    /// A model with its residuals.
    pub(super) fn new<const N: usize>(model: M, samples: &Samples<E>, cost: Cost) -> Fitted<M, E>
    where
        M: Model<N>,
    {
        let mut off = vec![E::default(); samples.padded()];
        residuals(&model, samples, cost, &mut off);
        Fitted { model, residuals: off, evaluations: samples.len() }
    }

    /// The standard deviation that the median of the residuals tells.
    pub(super) fn deviation(&self, len: usize) -> f64 {
        let mut sizes: Vec<f64> = self.residuals[..len].iter().map(|d| d.to().abs()).collect();
        NORMAL * median(&mut sizes)
    }
}

impl<E: Number> Problem<'_, E> {
    fn evaluate<M: Model<N>, const N: usize>(
        &self,
        model: &M,
        weights: &[E],
        beside: [f64; 2],
        residuals: &mut [E],
    ) -> Sums<N> {
        let mut sums = pass(model, self.samples, weights, self.cost, residuals);
        Self::complete(&mut sums, model, beside);
        sums
    }

    /// Adds what is minimised besides the squares: the area's term, and the model's penalty.
    pub(super) fn complete<M: Model<N>, const N: usize>(sums: &mut Sums<N>, model: &M, [area, noise]: [f64; 2]) {
        sums.square += Self::beside(model, area, noise);
        if area > 0.0 {
            let (_, slopes) = model.log_area();
            for (gradient, slope) in sums.gradient.iter_mut().zip(slopes) {
                *gradient += 0.5 * area * slope;
            }
        }
        if noise > 0.0
            && let Some(penalty) = model.penalty()
        {
            for (i, [weight, off]) in penalty.into_iter().enumerate() {
                sums.gradient[i] += noise * weight * off;
                sums.hessian[i][i] += noise * weight;
            }
        }
    }

    /// What is minimised besides the squares: the area's term, and the model's penalty.
    fn beside<M: Model<N>, const N: usize>(model: &M, area: f64, noise: f64) -> f64 {
        let area = if area > 0.0 { area * model.log_area().0 } else { 0.0 };
        let penalty = if noise > 0.0 { model.penalty() } else { None };
        area + penalty.map_or(0.0, |rows| noise * rows.iter().map(|[weight, off]| weight * off * off).sum::<f64>())
    }

    /// The sum that is minimised, without its derivatives.
    fn value<M: Model<N>, const N: usize>(
        &self,
        model: &M,
        weights: &[E],
        [area, noise]: [f64; 2],
        off: &mut [E],
    ) -> f64 {
        residuals(model, self.samples, self.cost, off);
        let squares = off.iter().zip(weights).map(|(d, w)| w.to() * d.to() * d.to());
        squares.sum::<f64>() + Self::beside(model, area, noise)
    }

    /// Levenberg–Marquardt from a model; residuals become those of the best one. `beside` are the
    /// weight of the area's logarithm, and that of the model's penalty.
    pub(super) fn descend<M: Model<N>, const N: usize>(
        &self,
        fitted: &mut Fitted<M, E>,
        weights: &[E],
        beside: [f64; 2],
        steps: usize,
        gain: f64,
    ) {
        let sums: Sums<N> = pass(&fitted.model, self.samples, weights, self.cost, &mut fitted.residuals);
        fitted.evaluations += self.samples.len();
        self.descend_from(sums, fitted, weights, beside, steps, gain);
    }

    /// The same where the sums of the first pass are known.
    pub(super) fn descend_from<M: Model<N>, const N: usize>(
        &self,
        mut sums: Sums<N>,
        fitted: &mut Fitted<M, E>,
        weights: &[E],
        beside: [f64; 2],
        steps: usize,
        gain: f64,
    ) {
        Self::complete(&mut sums, &fitted.model, beside);
        let mut trial = vec![E::default(); fitted.residuals.len()];
        let (mut damping, mut growth) = (1e-3, 2.0);
        for left in (0..steps).rev() {
            let Some(step) = step(&fitted.model, &sums, damping) else {
                damping *= growth;
                growth *= 2.0;
                continue;
            };
            let model = fitted.model.moved(&step);
            fitted.evaluations += self.samples.len();
            // Nobody asks for the derivatives after the last step.
            let (square, next) = if left == 0 {
                (self.value(&model, weights, beside, &mut trial), None)
            } else {
                let next: Sums<N> = self.evaluate(&model, weights, beside, &mut trial);
                (next.square, Some(next))
            };
            let drop = sums.square - square;
            if drop > 0.0 {
                std::mem::swap(&mut fitted.residuals, &mut trial);
                fitted.model = model;
                let Some(next) = next else { break };
                // The area's term makes the sum's zero arbitrary: gains are relative to the
                // squares.
                let squares = square.abs().max(beside[0]);
                sums = next;
                damping = f64::max(0.2 * damping, 1e-9);
                growth = 2.0;
                if drop < gain * squares {
                    break;
                }
            } else {
                damping *= 2.0 * growth;
                growth *= 2.0;
            }
        }
    }

    /// A robust fit from a model.
    pub(super) fn robust<M: Model<N>, const N: usize>(&self, start: M, how: Robust) -> Fitted<M, E> {
        let len = self.samples.len();
        let mut fitted = Fitted::new(start, self.samples, self.cost);
        let mut weights = vec![E::default(); self.samples.padded()];
        for round in 0..how.rounds {
            let noise = f64::max(fitted.deviation(len), E::GRAIN);
            let mut sum = 0.0;
            for (weight, residual) in weights[..len].iter_mut().zip(&fitted.residuals) {
                let w = (1.0 + (residual.to() / (how.width * noise)).powi(2)).powi(-2);
                *weight = E::of(w);
                sum += w;
            }
            let area = if round == 0 { 0.0 } else { how.area * noise * noise * sum };
            self.descend(&mut fitted, &weights, [area, noise * noise], how.steps, how.gain);
        }
        fitted
    }
}

/// The damped step, within the limits: what is at a bound and drawn beyond it stays.
pub(super) fn step<M: Model<N>, const N: usize>(model: &M, sums: &Sums<N>, damping: f64) -> Option<[f64; N]> {
    let mut limits = model.limits();
    let groups = model.groups();
    let (mut hessian, mut gradient) = ([[0.0; N]; N], [0.0; N]);
    for i in 0..N {
        let to = groups[i];
        gradient[to] += sums.gradient[i];
        limits[to] = [limits[to][0].max(limits[i][0]), limits[to][1].min(limits[i][1])];
        for j in 0..=i {
            let (a, b) = (to.max(groups[j]), to.min(groups[j]));
            // Both halves of what is off the diagonal come to lie on it.
            hessian[a][b] += if i != j && a == b { 2.0 } else { 1.0 } * sums.hessian[i][j];
        }
    }
    let largest = (0..N).map(|i| hessian[i][i]).fold(0.0, f64::max);
    let mut matrix = hessian;
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += damping * row[i] + 1e-12 * largest + f64::MIN_POSITIVE;
    }
    let right = gradient.map(|g| -g);
    let mut free = [true; N];
    for i in 0..N {
        free[i] = groups[i] == i && !(limits[i][0] > -1e-9 && right[i] < 0.0 || limits[i][1] < 1e-9 && right[i] > 0.0);
    }
    let mut step = solved(&matrix, &right, &free)?;
    for (x, [low, high]) in step.iter_mut().zip(limits) {
        *x = x.clamp(f64::min(low, 0.0), f64::max(high, 0.0));
    }
    Some(groups.map(|group| step[group]))
}
