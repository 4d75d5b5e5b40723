//! Plane curves by a parameter, each with its normal.
//!
//! ```text
//!                    point                        normal (a multiple of the gauge's gradient)
//!     superellipse   (ring + cos^e t, sin^e t)    (cos^(2−e) t, sin^(2−e) t)
//!     hyperbola      (sec^e t, tan^e t)           (sec^(2−e) t, −tan^(2−e) t)
//!     Gielis         r(t)·(cos t, sin t)          e_r − (r′/r)·e_t
//! ```
//!
//! Powers are signed. The normals need no derivative of the point, which is unbounded at the
//! axes for e < 1.
//!
//! By the angle t the points of a squarish superellipse crowd at its corners: `t` within 10⁻²⁵
//! of a quarter turn would be needed to reach its sides. Each curve therefore has a second
//! parameter, in which it runs evenly: the polar angle (the point is `d/G(d)` of a direction d),
//! the height of a hyperbola. Quarter turns are the same in both.

use std::f64::consts::PI;

use glam::DVec2;

use crate::{Dual, Gielis, Norm, Radius, Real, Turns, rad};
use rvachev_field::power::{sign, signed_power};

/// A curve of unit size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    /// By an angle, moved by `ring` along its first axis.
    Superellipse { e: f64, ring: f64 },
    /// `u^p − |v|^p = 1` with p = 2/e and |v| up to `end`.
    Hyperbola { e: f64, end: f64 },
    /// The other branch, u and v exchanged.
    Bowl { e: f64, end: f64 },
    /// `v = u²/2`, |u| up to `end`.
    Parabola { end: f64 },
    /// In polar form.
    Gielis { curve: Gielis, radius: Radius, turns: u32 },
}

/// Which parameter a curve is run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    /// The angle of the textbook formula.
    Angle,
    /// The one in which points lie evenly.
    Even,
}

/// A point of a curve of unit size, and a vector along its outward normal there, of a length
/// near 1. At a corner the normal is that of the symmetric bisector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) point: DVec2,
    pub(super) normal: DVec2,
}

impl Curve {
    /// A Gielis curve with its turns resolved.
    pub(super) fn gielis(curve: Gielis, radius: Radius) -> Curve {
        let turns = if curve.turns == Turns::Principal { 1 } else { curve.closing_turns().unwrap_or(1) };
        Curve::Gielis { curve, radius, turns }
    }

    /// The range of the whole curve in the parameter.
    pub(super) fn range(&self, by: By) -> [f64; 2] {
        match *self {
            Curve::Superellipse { .. } | Curve::Gielis { .. } => [-PI, PI],
            Curve::Hyperbola { e, end } => {
                let last = if even_height(e, by) { end } else { angle_of_tan(end, e) };
                [-last, last]
            }
            Curve::Bowl { e, end } => {
                let reach = height_of(end, e);
                let last = if even_height(e, by) { reach } else { angle_of_tan(reach, e) };
                [-last, last]
            }
            Curve::Parabola { end } => [-end, end],
        }
    }

    /// The point and normal at a parameter.
    pub(super) fn at(&self, t: f64, by: By) -> Local {
        match *self {
            Curve::Superellipse { e, ring } => {
                let (sin, cos) = rad(t).sin_cos();
                let local = if by == By::Even && e < 1.0 { radial(e, sin, cos) } else { raw(e, sin, cos) };
                Local { point: local.point + DVec2::new(ring, 0.0), ..local }
            }
            Curve::Hyperbola { e, end } => hyperbola(e, t, end, even_height(e, by)),
            Curve::Bowl { e, end } => {
                let Local { point, normal } = hyperbola(e, t, height_of(end, e), even_height(e, by));
                Local { point: DVec2::new(point.y, point.x), normal: -DVec2::new(normal.y, normal.x) }
            }
            Curve::Parabola { .. } => {
                // Divided first: the square of its length may overflow.
                let normal = DVec2::new(t, -1.0) / t.abs().max(1.0);
                Local { point: DVec2::new(t, 0.5 * t * t), normal: normal.normalize() }
            }
            Curve::Gielis { curve, radius, turns } => gielis(&curve, radius, turns, t),
        }
    }

    /// The point of the hyperbola with exponent `e` whose secant u has the logarithm
    /// `exp(ln_log)`, on the side of `side`. (Squarish hyperbolas are flat about their apex: with
    /// e = 0.01 half of their height has secants whose logarithm is below 10⁻⁶⁰.)
    pub(super) fn at_secant(e: f64, ln_log: f64, side: f64) -> Local {
        let (p, log) = (2.0 / e, ln_log.exp());
        let t = p * log;
        // ln(1 − e^(−t)), and ln t where the two are the same.
        let rest = if t < 1e-9 { p.ln() + ln_log } else { (-(-t).exp_m1()).ln() };
        hyperbola(e, (log + rest / p).exp().copysign(side), f64::INFINITY, true)
    }

    /// The normals just before and just after a parameter: they differ at a corner.
    pub(super) fn normals_about(&self, t: f64, by: By) -> [DVec2; 2] {
        let normal = self.at(t, by).normal;
        let smooth = match *self {
            Curve::Superellipse { e, .. } | Curve::Hyperbola { e, .. } | Curve::Bowl { e, .. } => e < 2.0,
            Curve::Parabola { .. } => true,
            Curve::Gielis { .. } => false,
        };
        if smooth {
            return [normal; 2];
        }
        // Near enough for a corner's normals to be right to single precision.
        let [first, last] = self.range(by);
        let step = 1e-8 * (last - first);
        [-step, step].map(|step| {
            let near = self.at(t + step, by).normal;
            if near.normalize().dot(normal.normalize()) < 1.0 - 1e-9 { near } else { normal }
        })
    }
}

/// Whether the even parameter of a hyperbola is its height v: for e > 1 that has a cusp at 0,
/// and the angle is even enough.
fn even_height(e: f64, by: By) -> bool {
    by == By::Even && e <= 1.0
}

/// The angle whose tangent is `t^(1/e)`.
fn angle_of_tan(t: f64, e: f64) -> f64 {
    t.powf(1.0 / e).atan()
}

/// v of the hyperbola's point at u = `end`: `(end^p − 1)^(1/p)`, p = 2/e, without overflow.
pub(super) fn height_of(end: f64, e: f64) -> f64 {
    let p = 2.0 / e;
    let rest = -(-p * end.ln()).exp_m1();
    if rest > 0.0 { end * rest.powf(1.0 / p) } else { 0.0 }
}

/// The superellipse by its angle.
fn raw(e: f64, sin: f64, cos: f64) -> Local {
    let point = DVec2::new(signed_power(cos, e), signed_power(sin, e));
    let normal = if sin == 0.0 || cos == 0.0 {
        DVec2::new(cos, sin)
    } else if e <= 2.0 {
        DVec2::new(signed_power(cos, 2.0 - e), signed_power(sin, 2.0 - e))
    } else {
        // The same times |cos·sin|^(e − 2).
        DVec2::new(sign(cos) * sin.abs().powf(e - 2.0), sign(sin) * cos.abs().powf(e - 2.0))
    };
    Local { point, normal }
}

/// The superellipse by its polar angle, for e < 1.
fn radial(e: f64, sin: f64, cos: f64) -> Local {
    let point = DVec2::new(cos, sin) / cos.norm(sin, Norm::of_exponent(e));
    let power = 2.0 / e - 1.0;
    Local { point, normal: DVec2::new(signed_power(point.x, power), signed_power(point.y, power)) }
}

/// The hyperbola, by its height or by its angle, which beyond the `end` is that of the end:
/// squarish ones reach it within 10⁻⁸ of a right angle.
fn hyperbola(e: f64, t: f64, end: f64, by_height: bool) -> Local {
    let (point, sin) = if by_height || t.abs() >= angle_of_tan(end, e) {
        let t = if by_height { t } else { end.copysign(t) };
        let u = 1.0.norm(t, Norm::of_exponent(e));
        // sin = tan/sec, each to the power e.
        (DVec2::new(u, t), signed_power(t / u, 1.0 / e))
    } else {
        let (sin, cos) = t.sin_cos();
        (DVec2::new(cos.powf(-e), signed_power(sin / cos, e)), sin)
    };
    let normal = if sin == 0.0 {
        DVec2::X
    } else if e <= 2.0 {
        DVec2::new(1.0, -signed_power(sin, 2.0 - e))
    } else {
        DVec2::new(sin.abs().powf(e - 2.0), -sign(sin))
    };
    Local { point, normal }
}

/// The Gielis curve; of several turns the one that counts.
fn gielis(curve: &Gielis, radius: Radius, turns: u32, theta: f64) -> Local {
    let quarter = 0.25 * curve.m;
    // What is so large has no digits left for the angle, and its multiples may overflow.
    let theta = if theta.abs() > 1e15 { theta % (2.0 * PI) } else { theta };
    let of_turn = |turn: u32| {
        let (sin, cos) = rad(quarter * (theta + f64::from(turn) * 2.0 * PI)).sin_cos();
        let sin = Dual::new(sin, [quarter * cos, 0.0, 0.0]);
        let cos = Dual::new(cos, [-quarter * sin.value(), 0.0, 0.0]);
        let r = curve.radius_of_phase(sin, cos, radius);
        (r.value(), r.gradient()[0])
    };
    let mut best = of_turn(0);
    for turn in 1..turns {
        let other = of_turn(turn);
        if (other.0 > best.0) == (curve.turns == Turns::Outer) {
            best = other;
        }
    }
    let (r, slope) = best;
    let (sin, cos) = rad(theta).sin_cos();
    let radial = DVec2::new(cos, sin);
    let bent = slope / r;
    let normal = (radial - bent * radial.perp()) / (1.0 + bent.abs());
    Local { point: r * radial, normal }
}
