//! Exact ranges of the slope of a Gielis curve over arcs.
//!
//! ```text
//!     t = mθ/4    C = |cos t|/a    D = |sin t|/b    p = C^n₂/S    q = D^n₃/S    S = C^n₂ + D^n₃
//!
//!     (ln r)′ = (m/4n₁)·B₁      B₁ = n₂ p tan t − n₃ q cot t
//!     (ln r)″ = (m²/16n₁)·B₂    B₂ = n₂ p (1 + (1 − n₂ q) tan² t − n₃ q)
//!                                  + n₃ q (1 + (1 − n₃ p) cot² t − n₂ p)
//! ```
//!
//! Where B₂ has one sign the slope is monotone, and its range over an arc is that between the ends
//! of the arc, told by two evaluations. The few short arcs where it turns are sought once, and
//! ranges of the slope kept with them. B₁ is odd about the zeros of the sine and of the cosine and
//! B₂ is even: one quarter of a turn of t tells all of them.

use std::f64::consts::FRAC_PI_2;

use super::{Gielis, leaf::half};
use crate::{Interval, Real};

/// Rounding of an angle, in radians.
pub(super) const ANGLE: f64 = 4e-15;

/// This near to the zeros of the sine and of the cosine, in terms of t, slopes are told by
/// intervals.
const NEAR: f64 = 1e-7;

/// A slope that varies by less than this, relative to itself where it is above 1, is taken as it
/// is.
const SMALL: f64 = 1e-5;

/// Arcs of t are not halved below this width.
const NARROW: f64 = 1e-9;

/// Nor beyond this number in all.
const BUDGET: u32 = 2000;

/// A short interval of the angle where something may turn, and its range there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) value: Interval,
}

impl Turn {
    /// Those of a list, sorted by angle, that an arc meets.
    pub(super) fn within(turns: &[Turn], from: f64, to: f64) -> impl Iterator<Item = &Turn> {
        let first = turns.partition_point(|turn| turn.to < from);
        turns[first..].iter().take_while(move |turn| turn.from <= to)
    }
}

/// What is known at an angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// One over the radius.
    pub(super) inverse: Interval,
    /// `(ln r)′`.
    pub(super) slope: Interval,
}

/// What is known over an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// The part of it that was asked for.
    pub(super) angle: Interval,
    /// What is known at its ends, where they are not at a zero of the sine or the cosine.
    pub(super) ends: [Option<Jet>; 2],
    /// `(ln r)′`.
    pub(super) slope: Interval,
}

/// The slope of one turn of a Gielis curve, of the standard radius.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tangents {
    curve: Gielis,
    span: f64,
    /// Where the slope turns, by angle.
    turns: Vec<Turn>,
    /// Where it has no bound, by angle.
    cusps: Vec<f64>,
}

impl Tangents {
    /// The slope over the angles from 0 to `span`; m is not 0.
    pub(super) fn new(curve: Gielis, span: f64) -> Tangents {
        let (quarter, scale) = (quarter(&curve), 0.25 * curve.m / curve.n1);
        let by_angle = |t: f64| 4.0 * t / curve.m;
        let mut turns = Vec::new();
        for k in (0..).map(f64::from).take_while(|k| by_angle(k * FRAC_PI_2) <= span + NEAR) {
            let start = k * FRAC_PI_2;
            let forward = quarter.iter().map(|turn| (start + turn.from, start + turn.to, turn.value));
            let end = start + FRAC_PI_2;
            let back = quarter.iter().rev().map(|turn| (end - turn.to, end - turn.from, -turn.value));
            let mut put = |(from, to, value): (f64, f64, Interval)| {
                turns.push(Turn { from: by_angle(from) - ANGLE, to: by_angle(to) + ANGLE, value: value * scale });
            };
            if k % 2.0 == 0.0 { forward.for_each(&mut put) } else { back.for_each(&mut put) }
        }
        Tangents { curve, span, turns, cusps: curve.cusps().collect() }
    }

    /// What is known at an angle, give or take `error`; nothing close to a zero of the sine or the
    /// cosine.
    pub(super) fn jet(&self, angle: f64, error: f64) -> Option<Jet> {
        let Gielis { m, n1, n2, n3, a, b, .. } = self.curve;
        let t = 0.25 * m * angle;
        let (sin, cos) = t.sin_cos();
        let (s, c) = (sin.abs(), cos.abs());
        // How far off t may be.
        let off = 0.25 * m * error + 3e-16 * (1.0 + t.abs());
        if c.min(s) < 0.5 * NEAR || off > 1e-3 * NEAR {
            return None;
        }
        let (lc, ls) = ((c / a).log2() * n2, (s / b).log2() * n3);
        let ratio = (ls - lc).exp2();
        let (p, q) = if ratio.is_finite() { (1.0 / (1.0 + ratio), ratio / (1.0 + ratio)) } else { (0.0, 1.0) };
        let sum = if lc >= ls { lc + ratio.ln_1p() * LOG2_E } else { ls + (lc - ls).exp2().ln_1p() * LOG2_E };
        let inverse = (sum / n1).exp2();
        let (tan, cot) = (sin / cos, cos / sin);
        let (by_cos, by_sin) = (n2 * p * tan, n3 * q * cot);
        let steep = by_cos.abs() + by_sin.abs();
        // The terms are powers of the sine and the cosine, of exponents up to n and 2 more.
        let rounding = 1e-15 * (8.0 + lc.abs() + ls.abs() + n2 + n3);
        let relative = 1.1 * off * ((n2 + 2.0) / c + (n3 + 2.0) / s) + rounding;
        if relative > 1e-2 {
            return None;
        }
        let of_sum = 1e-15 * (4.0 + p * (lc.abs() + n2) + q * (ls.abs() + n3));
        let of_inverse = 1.1 * steep * off / n1 + of_sum / n1 + 1e-15 * (4.0 + (sum / n1).abs());
        let scale = 0.25 * m / n1;
        Some(Jet {
            inverse: Interval::around(inverse, inverse * of_inverse),
            slope: Interval::around(scale * (by_cos - by_sin), scale * steep * relative),
        })
    }

    /// What is known over an arc whose ends may be off by `error`; only of the angles between the
    /// cusps that `beside` is between, if it is given. Nothing where there may be a cusp in the arc
    /// otherwise.
    pub(super) fn over(&self, angle: Interval, error: f64, beside: Option<f64>) -> Option<Arc> {
        // What is below 0 is its mirror image.
        let (mut from, mut to) = (angle.lo().max(0.0), angle.hi());
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        match beside {
            Some(beside) => {
                low = self.cusps.iter().copied().filter(|cusp| *cusp <= beside).fold(low, f64::max);
                high = self.cusps.iter().copied().filter(|cusp| *cusp > beside).fold(high, f64::min);
                (from, to) = (from.max(low), to.min(high));
            }
            None if self.cusps.iter().any(|cusp| *cusp >= from - error - ANGLE && *cusp <= to + error + ANGLE) => {
                return None;
            }
            None => {}
        }
        let is_known = angle.lo() >= -NEAR && to <= self.span + NEAR && from <= to;
        if !is_known {
            return None;
        }
        // Turns at the cusps are of one side.
        let is_beside = |turn: &&Turn| (low..=high).contains(&(0.5 * (turn.from + turn.to)));
        let ends = [from, to].map(|end| self.jet(end, error));
        let mut slope: Option<Interval> = None;
        let mut hold = |more: Interval| slope = Some(slope.map_or(more, |slope| slope.hull(more)));
        for (end, jet) in [from, to].into_iter().zip(&ends) {
            match jet {
                Some(jet) => hold(jet.slope),
                None => hold(Turn::within(&self.turns, end, end).find(is_beside)?.value),
            }
        }
        Turn::within(&self.turns, from - error, to + error).filter(is_beside).for_each(|turn| hold(turn.value));
        Some(Arc { angle: Interval::new(from, to), ends, slope: slope? })
    }
}

const LOG2_E: f64 = std::f64::consts::LOG2_E;

/// The logarithm of the sum of powers S, and B₁.
pub(super) fn power_slope(curve: &Gielis, sin: Interval, cos: Interval) -> (Interval, Interval) {
    let c = (cos.abs() * (1.0 / curve.a)).log2();
    let s = (sin.abs() * (1.0 / curve.b)).log2();
    let sum = (c * curve.n2).log2_sum_exp2(s * curve.n3);
    let sign = |x: Interval| x.select(Interval::point(1.0), Interval::point(-1.0));
    // C^(n−1)/S is at most 1/C.
    let weight = |log: Interval, n: f64| (log * (n - 1.0) - sum).min(-log).exp2() * n;
    let from_cos = weight(c, curve.n2) * (sin * (1.0 / curve.a)) * sign(cos);
    let from_sin = weight(s, curve.n3) * (cos * (1.0 / curve.b)) * sign(sin);
    (sum, from_cos - from_sin)
}

/// B₂, where neither the sine nor the cosine is 0.
fn bend(curve: &Gielis, sin: Interval, cos: Interval) -> Interval {
    let Gielis { n2, n3, a, b, .. } = *curve;
    let ratio = (sin * (1.0 / b)).log2() * n3 - (cos * (1.0 / a)).log2() * n2;
    let one = Interval::point(1.0);
    let unit = Interval::new(0.0, 1.0);
    let (p, q) = ((one / (ratio.exp2() + 1.0)).narrowed_by(unit), (one / ((-ratio).exp2() + 1.0)).narrowed_by(unit));
    let tan = sin / cos;
    let cot = cos / sin;
    let by_cos = p * n2 * ((one - q * n2) * tan.square() + one - q * n3);
    let by_sin = q * n3 * ((one - p * n3) * cot.square() + one - p * n2);
    by_cos + by_sin
}

/// Where B₁ turns, from t = 0 to a quarter of a turn, with what is near to its ends.
fn quarter(curve: &Gielis) -> Vec<Turn> {
    let small = half(Interval::new(0.0, 2.0 * NEAR), 1.0);
    let large = Interval::new(1.0 - NEAR, 1.0);
    let end = FRAC_PI_2 - NEAR;
    let mut turns = vec![Turn { from: 0.0, to: NEAR, value: power_slope(curve, small, large).1 }];
    let over = |from: f64, to: f64| {
        let (sin, cos) = Interval::new(from, to).inflate(ANGLE).sin_cos();
        (half(sin, 1.0), half(cos, 1.0))
    };
    let mut last = 0.0f64;
    let mut evaluated = 0;
    let mut stack: Vec<(f64, f64)> = (0..8).rev().map(|i| f64::from(i) / 8.0).map(|at| (at, at + 0.125)).collect();
    stack.iter_mut().for_each(|(from, to)| {
        (*from, *to) = ((*from * FRAC_PI_2).max(NEAR), (*to * FRAC_PI_2).min(end));
    });
    while let Some((from, to)) = stack.pop() {
        evaluated += 1;
        let (sin, cos) = over(from, to);
        let bend = bend(curve, sin, cos);
        let middle = 0.5 * (from + to);
        let mut value = Interval::ALL;
        if bend.contains(0.0) {
            let (sin_there, cos_there) = over(middle, middle);
            let reach = Interval::around(0.0, 0.5 * (to - from) + ANGLE);
            value = power_slope(curve, sin, cos).1;
            value = value.narrowed_by(power_slope(curve, sin_there, cos_there).1 + bend * reach);
            let is_small = value.width() <= SMALL * value.magnitude().clamp(1.0, 1e100);
            if !is_small && to - from > NARROW && evaluated < BUDGET {
                stack.push((middle, to));
                stack.push((from, middle));
                continue;
            }
        }
        let way = if bend.contains(0.0) { 0.0 } else { bend.lo().signum() };
        if way == 0.0 {
            turns.push(Turn { from, to, value });
        } else if last == -way {
            // A turn exactly between two pieces.
            let (sin, cos) = over(from, from);
            turns.push(Turn { from, to: from, value: power_slope(curve, sin, cos).1 });
        }
        last = way;
    }
    turns.push(Turn { from: end, to: FRAC_PI_2, value: power_slope(curve, large, small).1 });
    turns
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::Radius;
    use rvachev_num::rad;

    fn random(n: u32) -> f64 {
        f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
    }

    /// All over the ranges of the parameters; sharp polygons and stars too.
    fn curves() -> Vec<Gielis> {
        let g = Gielis::new;
        let mut curves = vec![
            g(5.0, 0.3, 0.3, 0.3),
            g(24.0, 0.3, 1.7, 1.7),
            g(4.0, 2.0, 2.0, 2.0),
            g(6.0, 1.0, 1.0, 1.0),
            g(7.0, 1000.0, 0.1, 1000.0),
            Gielis { a: 0.01, b: 100.0, ..g(64.0, 0.05, 5.0, 0.1) },
            Gielis::polygon(6, 60.0),
            Gielis::polygon(3, 1000.0),
        ];
        let power = |low: f64, high: f64, x: f64| low * (high / low).powf(x);
        for n in 0..60 {
            let x = [1, 2, 3, 4, 5, 6].map(|k| random(6 * n + k));
            let n1 = power(0.05, 1000.0, x[0]);
            let exponent = |x: f64| power(0.1, (100.0 * n1).min(1000.0), x);
            let m = if n % 3 == 0 { (x[3] * 24.0).round().max(1.0) } else { 64.0 * x[3] + 1e-3 };
            curves.push(Gielis {
                a: power(0.1, 10.0, x[4]),
                b: power(0.1, 10.0, x[5]),
                ..g(m, n1, exponent(x[1]), exponent(x[2]))
            });
        }
        curves
    }

    #[test]
    fn slopes_and_radii_are_within_what_is_told_of_their_arcs() {
        let (mut told, mut seen) = (0, 0);
        for (number, curve) in (0..).zip(curves()) {
            let tangents = Tangents::new(curve, PI);
            for n in 0..80u32 {
                let at = random(997 * number + 3 * n) * PI;
                let width = 3.0 * 10f64.powf(-8.0 * random(997 * number + 3 * n + 1));
                let (from, to) = (at, (at + width).min(PI));
                let beside = (n % 3 == 0).then(|| from + (to - from) * random(997 * number + 3 * n + 2));
                let Some(arc) = tangents.over(Interval::new(from, to), ANGLE, beside) else { continue };
                told += 1;
                for k in 0..=24 {
                    let angle = arc.angle.lo() + arc.angle.width() * f64::from(k) / 24.0;
                    let (r, slope) = curve.radius_slope(rad(angle), Radius::Standard);
                    let slope = slope / r;
                    // Gradients at the zeros of the sine and the cosine are those of one side.
                    let (sin, cos) = (0.25 * curve.m * angle).sin_cos();
                    if sin.abs().min(cos.abs()) < 1e-9 || !slope.is_finite() || r == 0.0 {
                        continue;
                    }
                    seen += 1;
                    let slack = 1e-6 * slope.abs() + 1e-9;
                    assert!(
                        slope >= arc.slope.lo() - slack && slope <= arc.slope.hi() + slack,
                        "{curve:?}: {slope} at {angle}, {arc:?} beside {beside:?}"
                    );
                    if let Some(jet) = tangents.jet(angle, ANGLE) {
                        let inverse = 1.0 / r;
                        let slack = 1e-11 * inverse * curve.condition().max(1.0) * (1.0 + slope.abs());
                        assert!(
                            inverse >= jet.inverse.lo() - slack && inverse <= jet.inverse.hi() + slack,
                            "{curve:?}: {inverse} at {angle}, {jet:?}"
                        );
                        assert!(
                            slope >= jet.slope.lo() - slack && slope <= jet.slope.hi() + slack,
                            "{curve:?} {jet:?}"
                        );
                    }
                }
            }
        }
        assert!(told > 3000 && seen > 60_000, "{told} {seen}");
    }

    /// Arcs are told tightly: what is told of them is seen, but for a little.
    #[test]
    fn what_is_told_of_arcs_is_seen() {
        for curve in [Gielis::new(5.0, 0.3, 0.3, 0.3), Gielis::new(24.0, 0.3, 1.7, 1.7), Gielis::polygon(6, 60.0)] {
            let tangents = Tangents::new(curve, PI);
            let quarters = (0.5 * curve.m).ceil() as usize + 1;
            assert!(tangents.turns.len() < 24 * quarters, "{curve:?}: {}", tangents.turns.len());
            for n in 0..200 {
                let from = 0.02 + random(2 * n) * 2.8;
                let to = from + 0.3 * random(2 * n + 1);
                let Some(arc) = tangents.over(Interval::new(from, to), ANGLE, None) else { continue };
                let slopes = (0..=400).map(|k| {
                    let angle = from + (to - from) * f64::from(k) / 400.0;
                    let (r, slope) = curve.radius_slope(rad(angle), Radius::Standard);
                    slope / r
                });
                let (low, high) = slopes.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
                let slack = 1e-2 * (high - low) + 1e-4 * high.abs().max(low.abs()).max(1.0);
                assert!(
                    arc.slope.lo() > low - slack && arc.slope.hi() < high + slack,
                    "{curve:?} {arc:?} {low} {high}"
                );
            }
        }
    }
}
