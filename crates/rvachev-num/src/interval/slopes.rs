//! Ranges of the slopes of norms, and of the cosine.

use super::Interval;
use crate::{Norm, Real};

/// Range of the derivative of `‖(a, b)‖` with respect to `a`: `sign(a)·(|a|/‖(a, b)‖)^(p−1)`,
/// which rises with a and, on either side of a = 0, moves towards 0 (p > 1) as |b| grows.
#[inline(never)]
pub(super) fn slope(a: Interval, b: Interval, norm: Norm) -> Interval {
    let p = norm.p();
    if p < 1.0 {
        // Unbounded near a = 0 (a cusp).
        let is_positive = a.lo > 0.0;
        return match a.contains(0.0) {
            true => Interval::ALL,
            false => {
                let (a, b) = (a.abs(), b.abs());
                let wide = Interval::library(corner_slope(a.hi, b.lo, norm), corner_slope(a.lo, b.hi, norm));
                if is_positive { wide } else { -wide }
            }
        };
    }
    let b = b.abs();
    // It is the absolute value of a: with one slope on either side of 0, up to there.
    if b.hi == 0.0 && (a.hi <= 0.0) != (a.lo >= 0.0) {
        return Interval::point(if a.hi <= 0.0 { -1.0 } else { 1.0 });
    }
    // Upper end: largest a with the b that helps it, and alike below.
    let hi = if a.hi > 0.0 { corner_slope(a.hi, b.lo, norm) } else { -corner_slope(-a.hi, b.hi, norm) };
    let lo = if a.lo < 0.0 { -corner_slope(-a.lo, b.lo, norm) } else { corner_slope(a.lo, b.hi, norm) };
    // At kinks (p = 1 or ∞) every slope between the two sides counts.
    let (lo, hi) = match norm {
        Norm::Sum if a.contains(0.0) => (-1.0, 1.0),
        Norm::Max if a.abs().hi >= b.lo && a.abs().lo <= b.hi => (lo.min(0.0), hi.max(0.0)),
        _ => (lo.min(hi), lo.max(hi)),
    };
    Interval::library_within(lo - 1e-15, hi + 1e-15, -1.0, 1.0)
}

/// The slope at one corner, a ≥ 0 and b ≥ 0.
#[inline(always)]
fn corner_slope(a: f64, b: f64, norm: Norm) -> f64 {
    match norm {
        Norm::Sum => 1.0,
        Norm::Max if a == b => 1.0,
        Norm::Max => f64::from(a > b),
        _ if a == 0.0 => 0.0,
        _ if b == 0.0 => 1.0,
        Norm::Euclid => a / a.norm(b, norm),
        Norm::P { p, .. } | Norm::Steep { p, .. } => (a / a.norm(b, norm)).powf(p - 1.0),
    }
}

/// Range of the cosine: a maximum at every multiple of 2π, a minimum half-way between.
pub(super) fn cosine(x: Interval) -> Interval {
    use std::f64::consts::{PI, TAU};
    if !x.lo.is_finite() || !x.hi.is_finite() || x.width() >= TAU || x.magnitude() > 1e9 {
        return Interval { lo: -1.0, hi: 1.0 };
    }
    // Turns are counted with a margin, so that an extreme at the very end is not missed.
    let margin = 1e-15 * (1.0 + x.magnitude());
    let holds = |phase: f64| ((x.hi + margin - phase) / TAU).floor() >= ((x.lo - margin - phase) / TAU).ceil();
    let (a, b) = (x.lo.cos(), x.hi.cos());
    let wide = Interval::library_within(a.min(b), a.max(b), -1.0, 1.0);
    Interval { lo: if holds(PI) { -1.0 } else { wide.lo }, hi: if holds(0.0) { 1.0 } else { wide.hi } }
}
