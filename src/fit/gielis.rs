//! Supershapes as a family to fit.
//!
//! ```text
//!     u = ρ/r₁(θ)    λ = |(u, Z)|    φ = atan2(Z, u)    ln G = ln λ − ln r₂(φ)    L′ = d ln r/d angle
//!     G_u = (u + L₂′Z)/λ²    G_Z = (Z − L₂′u)/λ²    s = G_u·u
//!     ∂ln G/∂ln nᵢ = −s·∂ln r₁/∂ln nᵢ    ∂ln G/∂ln Nᵢ = −∂ln r₂/∂ln Nᵢ
//!     g_X = s(X + L₁′Y)/ρ²    g_Y = s(Y − L₁′X)/ρ²    g_Z = G_Z    (X = x/a₁ …)
//! ```
//!
//! Sources: J. Gielis, *A generic geometric transformation* (2003); Y. D. Fougerolle et al.,
//! *Rational supershapes for surface reconstruction*.

use std::f64::consts::{E, LN_2};
use std::ops::Range;

use glam::{DMat3, DVec3};
use rvachev_num::Real;

use super::kernel::{LogGauge, Model, joined};
use super::pose;

/// Parameters: logarithms of three exponents for either curve and of the semi-axes, and the pose.
pub(super) const PARAMETERS: usize = 15;

/// The range of exponents.
const EXPONENTS: [f64; 2] = [0.15, 400.0];

/// The largest ratio of n2 or n3 to n1: radii beyond run over astronomic ranges.
const STEEPEST: f64 = 99.0;

/// The range of the semi-axes, in units of the cloud's size.
const SEMI_AXES: [f64; 2] = [1e-4, 1e2];

/// How strongly the exponents, whose scale many solids leave free, are drawn to e.
const DRAWN: f64 = 0.05;

/// A curve: its symmetry and exponents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) m: u32,
    pub(super) n: [f64; 3],
}

/// Which parameters move together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ties {
    /// n2 = n3, all N, a1 = a2.
    Round,
    /// n2 = n3, all N.
    Stretched,
    /// n2 = n3, N2 = N3.
    Profiled,
    /// All N, a1 = a2.
    Split,
    /// None.
    Free,
}

impl Ties {
    /// n2 = n3.
    fn lobes(self) -> bool {
        matches!(self, Ties::Round | Ties::Stretched | Ties::Profiled)
    }

    /// All N.
    pub(super) fn meridian(self) -> bool {
        matches!(self, Ties::Round | Ties::Stretched | Ties::Split)
    }

    /// a1 = a2.
    fn round(self) -> bool {
        matches!(self, Ties::Round | Ties::Split)
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Supershaped {
    pub(super) equator: Curve,
    pub(super) meridian: Curve,
    pub(super) semi_axes: DVec3,
    pub(super) rotation: DMat3,
    pub(super) center: DVec3,
    pub(super) ties: Ties,
    /// Whether radii are the rational ones.
    pub(super) rational: bool,
}

/// `ln r` of a curve, its slope by the angle, and its derivatives by the logarithms of n.
struct Radius<R> {
    log: R,
    slope: R,
    by: [R; 3],
}

/// A share times a tangent: shares vanish where its denominator does.
#[inline(always)]
fn tangent<R: Real>(share: R, x: R, over: R) -> R {
    share * x * over / (over.square() + 1e-14)
}

impl Curve {
    #[inline(always)]
    fn radius<R: Real>(&self, angle: R, rational: bool) -> Radius<R> {
        let [n1, n2, n3] = self.n;
        let quarter = 0.25 * f64::from(self.m);
        let (sin, cos) = (angle * quarter).sin_cos();
        if rational {
            return self.rational(sin, cos, quarter);
        }
        let (lc, ls) = (cos.abs().log2(), sin.abs().log2());
        let (sum, wc, ws, _) = joined(lc * n2, ls * n3);
        let slope = (tangent(wc, sin, cos) * n2 - tangent(ws, cos, sin) * n3) * (quarter / n1);
        let by = [sum * (LN_2 / n1), wc * lc * (-n2 * LN_2 / n1), ws * ls * (-n3 * LN_2 / n1)];
        Radius { log: sum * (-LN_2 / n1), slope, by }
    }

    /// Powers are replaced by `g_p(t) = t/(p + (1 − p)t)`, after C. Blanc and C. Schlick.
    #[inline(always)]
    fn rational<R: Real>(&self, sin: R, cos: R, quarter: f64) -> Radius<R> {
        let [n1, n2, n3] = self.n;
        let (u, v) = (cos.abs(), sin.abs());
        let one = u.lift(1.0);
        let (du, dv) = (u.scale_add(1.0 - n2, u.lift(n2)), v.scale_add(1.0 - n3, v.lift(n3)));
        let sum = u / du + v / dv;
        let part = one / (sum * (0.5 * n1));
        let whole = part + (1.0 - 1.0 / n1);
        // −∂ ln r/∂W.
        let fall = part / (sum * whole);
        let sign = (sin.select(one, -one)) * (cos.select(one, -one));
        let (gu, gv) = (one / du.square() * n2, one / dv.square() * n3);
        let slope = fall * (gu * v - gv * u) * sign * quarter;
        let (by_u, by_v) = (u * (-u + 1.0) / du.square() * n2, v * (-v + 1.0) / dv.square() * n3);
        let by = [(-part + 1.0 / n1) / whole + LN_2 / n1, fall * by_u, fall * by_v];
        Radius { log: (whole.log2() - 1.0 / n1) * LN_2, slope, by }
    }

    pub(super) fn radius_at(&self, angle: f64) -> f64 {
        self.radius(angle, false).log.exp()
    }

    fn moved(&self, step: &[f64]) -> Curve {
        let mut n = [0, 1, 2].map(|i| (self.n[i] * step[i].exp()).clamp(EXPONENTS[0], EXPONENTS[1]));
        n[0] = n[0].max(n[1].max(n[2]) / STEEPEST);
        Curve { m: self.m, n }
    }
}

impl Model<PARAMETERS> for Supershaped {
    fn pose(&self) -> (DMat3, DVec3) {
        (self.rotation, self.center)
    }

    #[inline(always)]
    fn log_gauge<R: Real>(&self, q: [R; 3], rows: &mut [R; PARAMETERS]) -> LogGauge<R> {
        let inverse = self.semi_axes.recip();
        let (x, y, z) = (q[0] * inverse.x, q[1] * inverse.y, q[2] * inverse.z);
        let square = x.square() + y.square() + 1e-20;
        let around = self.equator.radius(y.atan2(x), self.rational);
        let u = square.sqrt() * (around.log * -std::f64::consts::LOG2_E).exp2();
        let reach = u.square() + z.square();
        let along = self.meridian.radius(z.atan2(u), self.rational);
        let by_u = (u + along.slope * z) / reach;
        let by_z = (z - along.slope * u) / reach;
        let share = by_u * u;
        for i in 0..3 {
            rows[i] = -(share * around.by[i]);
            rows[3 + i] = -along.by[i];
        }
        let by_x = share * (x + around.slope * y) / square;
        let by_y = share * (y - around.slope * x) / square;
        (rows[6], rows[7], rows[8]) = (-(x * by_x), -(y * by_y), -(z * by_z));
        let gradient = [by_x * inverse.x, by_y * inverse.y, by_z * inverse.z];
        let radius = (q[0].square() + q[1].square() + q[2].square() + 1e-30).sqrt();
        LogGauge { log2: reach.log2() * 0.5 - along.log * std::f64::consts::LOG2_E, gradient, radius }
    }

    fn sizes(&self) -> (Range<usize>, f64) {
        (6..9, 0.5 * self.semi_axes.element_product().ln())
    }

    fn moved(&self, step: &[f64; PARAMETERS]) -> Supershaped {
        let (rotation, center) = pose::moved(self.rotation, self.center, &step[9..]);
        Supershaped {
            equator: self.equator.moved(&step[..3]),
            meridian: self.meridian.moved(&step[3..6]),
            semi_axes: self.semi_axes * DVec3::new(step[6].exp(), step[7].exp(), step[8].exp()),
            rotation,
            center,
            ..*self
        }
    }

    fn limits(&self) -> [[f64; 2]; PARAMETERS] {
        let mut limits = [[-0.5, 0.5]; PARAMETERS];
        let within = |x: f64, [low, high]: [f64; 2], most: f64| [(low / x).ln().max(-most), (high / x).ln().min(most)];
        for (limit, n) in limits.iter_mut().zip(self.equator.n.iter().chain(&self.meridian.n)) {
            *limit = within(*n, EXPONENTS, 1.0);
        }
        for (limit, a) in limits[6..9].iter_mut().zip(self.semi_axes.to_array()) {
            *limit = within(a, SEMI_AXES, 0.7);
        }
        let reach = 2.0 * self.semi_axes.max_element();
        limits[12..].fill([-reach, reach]);
        limits
    }

    /// None: sizes and exponents trade off, so that it would reward a wrong symmetry.
    fn log_area(&self) -> (f64, [f64; PARAMETERS]) {
        (0.0, [0.0; PARAMETERS])
    }

    fn penalty(&self) -> Option<[[f64; 2]; PARAMETERS]> {
        let mut penalty = [[0.0; 2]; PARAMETERS];
        for (row, n) in penalty.iter_mut().zip(self.equator.n.iter().chain(&self.meridian.n)) {
            *row = [DRAWN, (n / E).ln()];
        }
        Some(penalty)
    }

    fn groups(&self) -> [usize; PARAMETERS] {
        let mut groups = std::array::from_fn(|i| i);
        if self.ties.lobes() {
            groups[2] = 1;
        }
        if self.ties == Ties::Profiled {
            groups[5] = 4;
        }
        if self.ties.meridian() {
            (groups[4], groups[5]) = (3, 3);
        }
        if self.ties.round() {
            groups[7] = 6;
        }
        groups
    }
}

impl Supershaped {
    /// The direction outwards at a point, of no certain length.
    pub(super) fn outwards(&self, p: DVec3) -> DVec3 {
        let q = self.rotation.transpose() * (p - self.center);
        let mut rows = [0.0; PARAMETERS];
        self.rotation * DVec3::from_array(self.log_gauge(q.to_array(), &mut rows).gradient)
    }

    /// The same with other ties; what is tied becomes equal.
    pub(super) fn tied(mut self, ties: Ties) -> Supershaped {
        self.ties = ties;
        let mean = |a: f64, b: f64| (a * b).sqrt();
        if ties.lobes() {
            let n = &mut self.equator.n;
            (n[1], n[2]) = (mean(n[1], n[2]), mean(n[1], n[2]));
        }
        if ties == Ties::Profiled {
            let n = &mut self.meridian.n;
            (n[1], n[2]) = (mean(n[1], n[2]), mean(n[1], n[2]));
        }
        if ties.meridian() {
            let n = self.meridian.n;
            self.meridian.n = [(n[0] * n[1] * n[2]).cbrt(); 3];
        }
        if ties.round() {
            let a = mean(self.semi_axes.x, self.semi_axes.y);
            (self.semi_axes.x, self.semi_axes.y) = (a, a);
        }
        self
    }

    /// The like with hollows for corners: between lobes of exponents below 2 are ones of exponents
    /// above, turned by half a lobe, and the other way round.
    pub(super) fn opposite(&self) -> Supershaped {
        let [n1, n2, n3] = self.equator.n;
        let mean = 0.5 * (n2 + n3);
        let log = ((0.5 * mean - 1.0).abs() * LN_2 / n1).clamp(1e-3, 3.0);
        let (n, grown) = if mean < 2.0 { (4.0f64, (-log).exp()) } else { (1.2, log.exp()) };
        let n1 = ((0.5 * n - 1.0).abs() * LN_2 / log).clamp(0.2, 200.0);
        let turn = std::f64::consts::PI / f64::from(self.equator.m.max(1));
        Supershaped {
            equator: Curve { n: [n1, n, n], ..self.equator },
            semi_axes: self.semi_axes * DVec3::new(grown, grown, 1.0),
            rotation: self.rotation * DMat3::from_rotation_z(turn),
            ..*self
        }
    }

    /// Whether rational radii stand for the exact ones, by the published rule: they differ by no
    /// more than a tolerance, and no exponent is above 4.
    pub(super) fn stays_rational(&self, tolerance: f64) -> bool {
        let mut n = self.equator.n.iter().chain(&self.meridian.n);
        n.all(|n| *n <= 4.0) && self.rational_error() <= tolerance
    }

    /// How far the rational radius of either curve is from the exact one, in proportion, at most.
    fn rational_error(&self) -> f64 {
        let mut most: f64 = 0.0;
        for curve in [self.equator, self.meridian] {
            for i in 0..=32 {
                let angle = std::f64::consts::PI * f64::from(i) / 32.0 * 4.0 / f64::from(curve.m.max(1)) * 0.5;
                most = most.max((curve.radius(angle, true).log - curve.radius(angle, false).log).abs());
            }
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published rule: rational radii stay while they are near and no exponent is above 4.
    #[test]
    fn rational_radii_stay_while_they_are_near_the_exact_ones() {
        let with = |n: [f64; 3]| Supershaped {
            equator: Curve { m: 5, n },
            meridian: Curve { m: 4, n: [2.0; 3] },
            semi_axes: DVec3::ONE,
            rotation: DMat3::IDENTITY,
            center: DVec3::ZERO,
            ties: Ties::Free,
            rational: true,
        };
        let near = with([2.5, 3.0, 3.5]);
        let error = near.rational_error();
        assert!(error > 1e-3 && error < 0.5, "{error}");
        assert!(near.stays_rational(1.01 * error) && !near.stays_rational(0.99 * error));
        assert!(with([4.0; 3]).stays_rational(10.0) && !with([4.01, 4.0, 4.0]).stays_rational(10.0));
    }
}
