//! The pass over the points: residuals, and the normal equations of a least-squares step.
//!
//! ```text
//!     q = Rᵀ(p − t)     G = gauge of q     r = |q|     g = ∇ ln G     f = r/G
//!     radial    d = r(1 − 1/G)             ∂d/∂s = f·∂ln G/∂s   for a parameter s of the shape
//!     normal    d·c,  c = 1/(r|g|)         rotation f·(g × q),  translation −(q/r)(1 − 1/G) − f·g
//! ```
//!
//! A shape gives `ln G`, its gradient, and its derivatives by the shape's parameters; all residuals
//! follow from these. The sums run on SIMD lanes, in `f32` for the search and in `f64` for the last
//! steps; two vectors at a time, as one alone waits for itself. What computes with lanes is a
//! function that is always inlined, not a closure: those are compiled without the vectors'
//! features, and each of their operations is a call. The sign of residuals is that of lengths here:
//! negative inside.
//!
//! Sources: F. Solina, R. Bajcsy, *Recovery of parametric models from range images* (1990);
//! A. Gross, T. Boult, *Error of fit measures for recovering parametric solids* (1988).

use std::f64::consts::LN_2;
use std::ops::Range;

use fearless_simd::{Simd, SimdBase};
use glam::{DMat3, DVec3};
use rvachev_num::Real;
use rvachev_num::lanes::{F32, F64, Lanes, Twice};

use super::cost::Cost;
use super::samples::Samples;

/// A family of surfaces about a centre, with `N` parameters: those of the shape first, then three
/// of a rotation about the local axes and three of a translation along them.
pub(super) trait Model<const N: usize>: Copy + Sync {
    /// The rotation (its columns are the local axes) and the centre.
    fn pose(&self) -> (DMat3, DVec3);

    /// `log2 G` and the gradient of `ln G` at a point in local coordinates; derivatives of `ln G`
    /// by the shape's parameters go to the first rows.
    fn log_gauge<R: Real>(&self, q: [R; 3], rows: &mut [R; N]) -> LogGauge<R>;

    /// `ln √(a₁a₂a₃)` is half the sum of these rows' parameters.
    fn sizes(&self) -> (Range<usize>, f64);

    /// The model moved by a step of the parameters, which must be within [`limits`](Model::limits).
    fn moved(&self, step: &[f64; N]) -> Self;

    /// The longest steps down and up: what keeps the parameters in their ranges, and the steps
    /// sane.
    fn limits(&self) -> [[f64; 2]; N];

    /// The logarithm of the surface's area, and its derivatives.
    fn log_area(&self) -> (f64, [f64; N]);

    /// For each parameter the first one of those that move together with it.
    fn groups(&self) -> [usize; N] {
        std::array::from_fn(|i| i)
    }

    /// How many parameters there are, with those of the pose; tied ones are counted once.
    fn parameters(&self) -> usize {
        let groups = self.groups();
        (0..N).filter(|i| groups[*i] == *i).count()
    }

    /// A quadratic penalty's weights and the parameters' deviations, in units of the noise.
    fn penalty(&self) -> Option<[[f64; 2]; N]> {
        None
    }
}

/// What a shape says of a point.
pub(super) struct LogGauge<R> {
    /// `log2 G`.
    pub(super) log2: R,
    /// The gradient of `ln G` in local coordinates.
    pub(super) gradient: [R; 3],
    /// The distance from the centre, before any deformation.
    pub(super) radius: R,
}

/// Two logarithms joined: `log2(2^u + 2^v)`, the shares of both, and the entropy of the shares in
/// nats.
#[inline(always)]
pub(super) fn joined<R: Real>(u: R, v: R) -> (R, R, R, R) {
    let (hi, lo) = (u.max(v), u.min(v));
    let apart = hi - lo;
    let small = (-apart).exp2();
    let log = (small + 1.0).log2();
    let large_share = u.lift(1.0) / (small + 1.0);
    let small_share = small * large_share;
    let entropy = small_share.mul_add(apart, log) * LN_2;
    (hi + log, (u - v).select(large_share, small_share), (u - v).select(small_share, large_share), entropy)
}

/// How much points count.
trait Weights<E: Number> {
    /// The weights of these points, by their residuals if they are made of them.
    fn at<S: Simd>(&mut self, simd: S, at: Range<usize>, residuals: Twice<E::Vector<S>>) -> Twice<E::Vector<S>>;
}

/// Weights that are given.
struct Given<'a, E>(&'a [E]);

impl<E: Number> Weights<E> for Given<'_, E> {
    #[inline(always)]
    fn at<S: Simd>(&mut self, simd: S, at: Range<usize>, _: Twice<E::Vector<S>>) -> Twice<E::Vector<S>> {
        <Twice<E::Vector<S>> as Lanes>::load(simd, &self.0[at])
    }
}

/// The chance of a point to be of the surface by its residual: `1/(1 + 2^(curve·d² + shift))`.
#[derive(Clone, Copy)]
pub(super) struct Chance {
    pub(super) curve: f64,
    pub(super) shift: f64,
}

impl Chance {
    pub(super) fn at(self, residual: f64) -> f64 {
        1.0 / (1.0 + (self.curve * residual * residual + self.shift).exp2())
    }
}

/// What chances count to: one in so many powers of 2.
const FARTHEST: f64 = 100.0;

/// Chances as weights, which are kept.
struct Chances<'a, E> {
    chance: Chance,
    /// 1 for points, 0 for the padding.
    counts: &'a [E],
    kept: &'a mut [E],
}

impl<E: Number> Weights<E> for Chances<'_, E> {
    #[inline(always)]
    fn at<S: Simd>(&mut self, simd: S, at: Range<usize>, d: Twice<E::Vector<S>>) -> Twice<E::Vector<S>> {
        let counts = <Twice<E::Vector<S>> as Lanes>::load(simd, &self.counts[at.clone()]);
        let Chance { curve, shift } = self.chance;
        // So far off all are out alike; chances below the normal numbers would only be slow.
        let odds = d.square().scale_add(curve, d.lift(shift)).min(d.lift(FARTHEST)).exp2();
        let chances = counts / (odds + 1.0);
        chances.store(&mut self.kept[at]);
        chances
    }
}

/// The sums of a pass.
#[derive(Clone, Copy)]
pub(super) struct Sums<const N: usize> {
    /// Sum of the weights.
    pub(super) weight: f64,
    /// Sum of the weighted squares.
    pub(super) square: f64,
    /// Half its gradient.
    pub(super) gradient: [f64; N],
    /// Half its second derivatives (Gauss–Newton); the lower triangle.
    pub(super) hessian: [[f64; N]; N],
}

/// The numbers that points are kept in.
pub(super) trait Number: Copy + Default + PartialOrd + Send + Sync + 'static {
    /// Vectors of them.
    type Vector<S: Simd>: Lanes<Element = Self, Token = S>;
    /// Below this share of the cloud's size residuals are rounding.
    const GRAIN: f64;
    fn of(x: f64) -> Self;
    fn to(self) -> f64;
    /// The sums of neighbouring lanes: those of the first vector, then those of the second.
    fn pair_sums<S: Simd>(first: Self::Vector<S>, second: Self::Vector<S>) -> Self::Vector<S>;
}

impl Number for f32 {
    type Vector<S: Simd> = F32<S>;
    const GRAIN: f64 = 1e-6;
    fn of(x: f64) -> f32 {
        x as f32
    }
    fn to(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn pair_sums<S: Simd>(first: F32<S>, second: F32<S>) -> F32<S> {
        F32(first.0.unzip_low(second.0) + first.0.unzip_high(second.0))
    }
}

impl Number for f64 {
    type Vector<S: Simd> = F64<S>;
    const GRAIN: f64 = 1e-12;
    fn of(x: f64) -> f64 {
        x
    }
    fn to(self) -> f64 {
        self
    }
    #[inline(always)]
    fn pair_sums<S: Simd>(first: F64<S>, second: F64<S>) -> F64<S> {
        F64(first.0.unzip_low(second.0) + first.0.unzip_high(second.0))
    }
}

/// Residuals of all points and the sums of their squares by weight.
pub(super) fn pass<E: Number, M: Model<N>, const N: usize>(
    model: &M,
    samples: &Samples<E>,
    weights: &[E],
    cost: Cost,
    residuals: &mut [E],
) -> Sums<N> {
    rvachev_num::on_level!(simd => pass_on::<_, E, M, N>(simd, model, samples, Given(weights), cost, residuals))
}

/// The same with chances for weights, which are kept; 0 for the padding.
pub(super) fn pass_by_chance<E: Number, M: Model<N>, const N: usize>(
    model: &M,
    samples: &Samples<E>,
    chance: Chance,
    kept: &mut [E],
    cost: Cost,
    residuals: &mut [E],
) -> Sums<N> {
    let chances = Chances { chance, counts: samples.counts(), kept };
    rvachev_num::on_level!(simd => pass_on::<_, E, M, N>(simd, model, samples, chances, cost, residuals))
}

#[inline(always)]
fn pass_on<S: Simd, E: Number, M: Model<N>, const N: usize>(
    simd: S,
    model: &M,
    samples: &Samples<E>,
    mut weights: impl Weights<E>,
    cost: Cost,
    residuals: &mut [E],
) -> Sums<N> {
    let width = <Twice<E::Vector<S>> as Lanes>::WIDTH;
    let zero = <E::Vector<S> as Lanes>::splat(simd, 0.0);
    const { assert!(2 + N + N * (N + 1) / 2 <= SUMS, "more sums than there is room for") };
    // Weight, square, gradient, and the lower triangle of the second derivatives, one after
    // another.
    let mut sums = [zero; SUMS];
    for start in (0..samples.padded()).step_by(width) {
        let at = start..start + width;
        let (residual, rows) = terms::<_, M, N>(model, places(simd, samples, at.clone()), cost);
        let weight = weights.at(simd, at.clone(), residual);
        residual.store(&mut residuals[at]);
        sums[0] = sums[0] + weight.0 + weight.1;
        let Twice(r, s) = residual * weight;
        sums[1] = r.mul_add(residual.0, s.mul_add(residual.1, sums[1]));
        let mut at = 2 + N;
        for i in 0..N {
            sums[2 + i] = r.mul_add(rows[i].0, s.mul_add(rows[i].1, sums[2 + i]));
            let Twice(a, b) = rows[i] * weight;
            for j in 0..=i {
                sums[at] = a.mul_add(rows[j].0, b.mul_add(rows[j].1, sums[at]));
                at += 1;
            }
        }
    }
    let mut totals = [0.0; SUMS];
    let count = 2 + N + N * (N + 1) / 2;
    lane_sums::<S, E>(simd, &sums[..count.next_multiple_of(<E::Vector<S> as Lanes>::WIDTH)], &mut totals);
    let [weight, square] = [totals[0], totals[1]];
    let mut sums = Sums { weight, square, gradient: [0.0; N], hessian: [[0.0; N]; N] };
    sums.gradient.copy_from_slice(&totals[2..2 + N]);
    let mut at = 2 + N;
    for i in 0..N {
        sums.hessian[i][..=i].copy_from_slice(&totals[at..=at + i]);
        at += i + 1;
    }
    sums
}

/// The coordinates of these points.
#[inline(always)]
fn places<S: Simd, E: Number>(simd: S, samples: &Samples<E>, at: Range<usize>) -> [Twice<E::Vector<S>>; 3] {
    let [xs, ys, zs] = samples.columns();
    [
        <Twice<E::Vector<S>> as Lanes>::load(simd, &xs[at.clone()]),
        <Twice<E::Vector<S>> as Lanes>::load(simd, &ys[at.clone()]),
        <Twice<E::Vector<S>> as Lanes>::load(simd, &zs[at]),
    ]
}

/// Sums of the largest model, in whole blocks of the widest vectors.
const SUMS: usize = 160;

/// The sum over the lanes of each vector; of a multiple of their width.
#[inline(always)]
fn lane_sums<S: Simd, E: Number>(simd: S, vectors: &[E::Vector<S>], sums: &mut [f64; SUMS]) {
    // No vector is wider.
    const MOST: usize = 16;
    let width = <E::Vector<S> as Lanes>::WIDTH;
    let zero = <E::Vector<S> as Lanes>::splat(simd, 0.0);
    let (mut buffer, mut block) = ([E::default(); MOST], [zero; MOST]);
    for (some, sums) in vectors.chunks_exact(width).zip(sums.chunks_exact_mut(width)) {
        let mut left = width / 2;
        for i in 0..left {
            block[i] = E::pair_sums::<S>(some[2 * i], some[2 * i + 1]);
        }
        while left > 1 {
            left /= 2;
            for i in 0..left {
                block[i] = E::pair_sums::<S>(block[2 * i], block[2 * i + 1]);
            }
        }
        block[0].store(&mut buffer[..width]);
        for (sum, lane) in sums.iter_mut().zip(&buffer) {
            *sum = lane.to();
        }
    }
}

/// Residuals of all points.
pub(super) fn residuals<E: Number, M: Model<N>, const N: usize>(
    model: &M,
    samples: &Samples<E>,
    cost: Cost,
    residuals: &mut [E],
) {
    rvachev_num::on_level!(simd => residuals_on::<_, E, M, N>(simd, model, samples, cost, residuals));
}

#[inline(always)]
fn residuals_on<S: Simd, E: Number, M: Model<N>, const N: usize>(
    simd: S,
    model: &M,
    samples: &Samples<E>,
    cost: Cost,
    residuals: &mut [E],
) {
    let width = <Twice<E::Vector<S>> as Lanes>::WIDTH;
    for start in (0..samples.padded()).step_by(width) {
        let at = start..start + width;
        // What the derivatives take is not computed where nothing reads them.
        let (residual, _) = terms::<_, M, N>(model, places(simd, samples, at.clone()), cost);
        residual.store(&mut residuals[at]);
    }
}

/// The residual of a point, and its derivatives by the parameters.
#[inline(always)]
pub(super) fn terms<R: Real, M: Model<N>, const N: usize>(model: &M, p: [R; 3], cost: Cost) -> (R, [R; N]) {
    let (rotation, center) = model.pose();
    let from = [p[0] - center.x, p[1] - center.y, p[2] - center.z];
    let q = [along(from, rotation.x_axis), along(from, rotation.y_axis), along(from, rotation.z_axis)];
    let mut rows = [p[0].lift(0.0); N];
    let LogGauge { log2, gradient: g, radius } = model.log_gauge(q, &mut rows);
    let shape = N - 6;
    // What ln G is multiplied by in derivatives, and what the translation has besides.
    let (residual, factor, beside) = match cost {
        Cost::Radial | Cost::Normal => {
            let inverse = (-log2).exp2();
            let off = -inverse + 1.0;
            let mut scale = radius;
            if let Cost::Normal = cost {
                let steep = (g[0].square() + g[1].square() + g[2].square()).sqrt();
                scale = radius.min(p[0].lift(1.0) / (steep + 1e-30));
            }
            (scale * off, scale * inverse, scale * off / radius.square())
        }
        Cost::SolinaBajcsy | Cost::Gauge | Cost::Eq15 => {
            let (rows_of_sizes, half_log) = model.sizes();
            let root = half_log.exp();
            let gauge = log2.exp2();
            let (residual, factor) = match cost {
                Cost::SolinaBajcsy => ((gauge.square() - 1.0) * root, gauge.square() * (2.0 * root)),
                _ => ((gauge - 1.0) * root, gauge * root),
            };
            for row in &mut rows[..shape] {
                *row = *row * factor;
            }
            for row in &mut rows[rows_of_sizes] {
                *row = *row + residual * 0.5;
            }
            let [turn, shift] = pose_rows(q, g);
            for k in 0..3 {
                rows[shape + k] = turn[k] * factor;
                rows[shape + 3 + k] = shift[k] * factor;
            }
            return (residual, rows);
        }
    };
    for row in &mut rows[..shape] {
        *row = *row * factor;
    }
    let [turn, shift] = pose_rows(q, g);
    for k in 0..3 {
        rows[shape + k] = turn[k] * factor;
        rows[shape + 3 + k] = shift[k] * factor - q[k] * beside;
    }
    (residual, rows)
}

/// How far a vector reaches along an axis.
#[inline(always)]
fn along<R: Real>(v: [R; 3], axis: DVec3) -> R {
    v[0].scale_add(axis.x, v[1].scale_add(axis.y, v[2] * axis.z))
}

/// Derivatives of `ln G` by a rotation about the local axes and a translation along them.
#[inline(always)]
fn pose_rows<R: Real>(q: [R; 3], g: [R; 3]) -> [[R; 3]; 2] {
    let turn = [g[1] * q[2] - g[2] * q[1], g[2] * q[0] - g[0] * q[2], g[0] * q[1] - g[1] * q[0]];
    [turn, [-g[0], -g[1], -g[2]]]
}
