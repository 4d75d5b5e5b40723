//! Exact ranges of the gauge of a Gielis curve over boxes.
//!
//! ```text
//!          far
//!       +--------+        g(x, y) = √(x² + y²) / r(θ) grows along every ray from the origin:
//!       |  box   | far    its least value over a box is on an edge that faces the origin, its
//!       +--------+        largest on one that looks away. On an edge x = c it is c / X(θ), on
//!     .   near            an edge y = c it is c / Y(θ), with the curve's own coordinates
//!    o                    X = r cos θ and Y = r sin θ.
//! ```
//!
//! So four corners and the extremes of X and Y between them give the range. The extremes are
//! sought once, when the shape is built: intervals of the angle are halved until the derivative
//! of X (or Y) has one sign there or X varies by less than a millionth. What is left of the
//! second kind, a few dozen short intervals with the range of X in each, is the table. r is
//! even in θ, so angles from 0 to π do.
//!
//! The derivatives come of the slope (ln r)′ ([`Tangents`]); it is unbounded at the zeros of the
//! cosine where n₂ < 1, and at those of the sine where n₃ < 1.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

use rvachev_num::order;

use super::tangents::{ANGLE, Arc, Tangents, Turn, power_slope};
use super::{Gielis, Radius, gielis::Winding, leaf::half};
use crate::{Dual, Interval, Real};

/// A coordinate that varies by less than this, relative to itself, is taken as it is.
const SMALL: f64 = 1e-6;

/// Intervals of the angle are not halved below this width.
const NARROW: f64 = 1e-9;

/// Nor beyond this number in all.
const BUDGET: u32 = 40_000;

/// What is known of a curve over an interval of the angle.
struct Piece {
    radius: Interval,
    /// Derivatives of the logarithm of the radius and, over r, of X and Y.
    slopes: [Interval; 3],
    direction: [Interval; 2],
}

impl Piece {
    /// Range of r (0), X (1) or Y (2).
    fn value(&self, which: usize) -> Interval {
        if which == 0 { self.radius } else { self.radius * self.direction[which - 1] }
    }
}

/// A Gielis curve over the angles from 0 to `span`, with the extremes of its coordinates.
#[derive(Clone, PartialEq)]
pub(super) struct Outline {
    curve: Gielis,
    radius: Radius,
    winding: Winding,
    span: f64,
    /// The radius, if it is the same all round.
    circle: Option<Interval>,
    /// Of other curves of one turn.
    tangents: Option<Tangents>,
    /// Where the radius turns, by angle.
    turns: Vec<Turn>,
    /// Where X turns.
    x_turns: Vec<Turn>,
    /// Where Y turns.
    y_turns: Vec<Turn>,
    /// Relative error of the radius in plain `f64`; infinite where slopes are.
    error: f64,
    extent: [Interval; 3],
}

impl fmt::Debug for Outline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Outline({} and {} turns)", self.x_turns.len(), self.y_turns.len())
    }
}

impl Outline {
    /// The outline of `curve` over the angles from 0 to `span`, which is π or π/2.
    pub(super) fn new(curve: Gielis, radius: Radius, span: f64) -> Outline {
        let winding = curve.winding();
        let (turns, x_turns, y_turns) = (Vec::new(), Vec::new(), Vec::new());
        let (tangents, extent) = (None, [Interval::ALL; 3]);
        let is_standard = radius == Radius::Standard;
        let circle = (is_standard && curve.is_circle()).then(|| radius_of_circle(&curve));
        let mut outline =
            Outline { curve, radius, winding, span, circle, tangents, turns, x_turns, y_turns, error: 0.0, extent };
        outline.seek();
        if is_standard && winding == Winding::Once && circle.is_none() {
            outline.tangents = Some(Tangents::new(curve, span));
        }
        outline
    }

    /// Range of the radius.
    pub(super) fn radius(&self) -> Interval {
        self.extent[0]
    }

    /// Range of X.
    pub(super) fn x(&self) -> Interval {
        self.extent[1]
    }

    /// Range of Y, which is not negative.
    pub(super) fn y(&self) -> Interval {
        self.extent[2]
    }

    /// Range of r and of `(ln r)′` over an interval of the angle; only of the angles between the
    /// cusps that the angle `beside` is between, if there is one.
    fn slope(&self, angle: Interval, beside: Option<f64>) -> (Interval, Interval) {
        match self.tangents.as_ref().and_then(|tangents| tangents.over(angle, ANGLE, beside)) {
            Some(arc) => (self.radius_over(&arc), arc.slope),
            None => self.slope_by_intervals(angle, beside),
        }
    }

    /// Range of r over an arc.
    fn radius_over(&self, arc: &Arc) -> Interval {
        let [first, last] =
            [(arc.ends[0], arc.angle.lo()), (arc.ends[1], arc.angle.hi())].map(|(jet, end)| match jet {
                Some(jet) => Interval::point(1.0) / jet.inverse,
                None => self.curve.radius_at(Interval::around(end, ANGLE), self.radius, self.winding),
            });
        let turns = Turn::within(&self.turns, arc.angle.lo() - ANGLE, arc.angle.hi() + ANGLE);
        turns.fold(first.hull(last), |all, turn| all.hull(turn.value))
    }

    /// The same as [`slope`](Self::slope), by the formula on intervals.
    fn slope_by_intervals(&self, angle: Interval, beside: Option<f64>) -> (Interval, Interval) {
        let curve = &self.curve;
        if let Some(radius) = self.circle {
            return (radius, Interval::point(0.0));
        }
        let radius = || curve.radius_at(angle, self.radius, self.winding);
        if curve.m == 0.0 {
            return (radius(), Interval::point(0.0));
        }
        if self.radius == Radius::Rational {
            let r = radius();
            let dual = curve.radius_at(Dual::variable(angle, 0), self.radius, self.winding);
            return (r, dual.gradient()[0] / r);
        }
        let (mut sin, mut cos) = (angle * (0.25 * curve.m)).sin_cos();
        if let (Some(beside), Winding::Once) = (beside, self.winding) {
            let sides = (beside * (0.25 * curve.m)).sin_cos();
            sin = if curve.n3 < 1.0 { half(sin, sides.0) } else { sin };
            cos = if curve.n2 < 1.0 { half(cos, sides.1) } else { cos };
        }
        let (first, mut slope) = power_slope(curve, sin, cos);
        if let Winding::Many { turns, cos: step_cos, sin: step_sin, sign } = self.winding {
            // The hull of the turns that may be the one that counts.
            let mut most = first * sign;
            let (mut c, mut s) = (step_cos, step_sin);
            for _ in 1..turns {
                let (sum, next) = power_slope(curve, sin * c + cos * s, cos * c - sin * s);
                let sum = sum * sign;
                if sum.lo() > most.hi() {
                    slope = next;
                } else if sum.hi() >= most.lo() {
                    slope = slope.hull(next);
                }
                most = most.max(sum);
                (c, s) = (c * step_cos - s * step_sin, s * step_cos + c * step_sin);
            }
        }
        let r = if self.winding == Winding::Once { (first * (-1.0 / curve.n1)).exp2() } else { radius() };
        (r, slope * (0.25 * curve.m / curve.n1))
    }

    fn piece(&self, angle: Interval) -> Piece {
        let (radius, slope) = self.slope_by_intervals(angle, None);
        let (sin, cos) = angle.sin_cos();
        Piece { radius, slopes: [slope, slope * cos - sin, slope * sin + cos], direction: [cos, sin] }
    }

    /// Fills the table.
    fn seek(&mut self) {
        let mut found: [Vec<Turn>; 3] = Default::default();
        let mut last = [0.0f64; 3];
        let mut steepest = 0.0f64;
        let mut evaluated = 0;
        let mut stack = self.first_pieces();
        while let Some((lo, hi)) = stack.pop() {
            let half = 0.5 * (hi - lo);
            let middle = lo + half;
            let reach = Interval::around(0.0, half + ANGLE);
            let whole = self.piece(Interval::new(lo, hi).inflate(ANGLE));
            let mut values = [0, 1, 2].map(|i| whole.value(i));
            if whole.slopes.iter().any(|slope| slope.contains(0.0)) {
                let centre = self.piece(Interval::point(middle));
                for (i, value) in values.iter_mut().enumerate() {
                    *value = value.narrowed_by(centre.value(i) + whole.radius * whole.slopes[i] * reach);
                }
            }
            evaluated += 1;
            let last_resort = 2.0 * half <= NARROW || evaluated > BUDGET;
            let settled = |i: usize| {
                let turns = whole.slopes[i].contains(0.0);
                !turns || values[i].width() <= SMALL * values[i].magnitude().min(f64::MAX)
            };
            if !last_resort && !(0..3).all(settled) {
                stack.push((middle, hi));
                stack.push((lo, middle));
                continue;
            }
            steepest = steepest.max(whole.slopes[0].magnitude());
            for i in 0..3 {
                let way = if whole.slopes[i].contains(0.0) { 0.0 } else { whole.slopes[i].lo().signum() };
                if way == 0.0 {
                    found[i].push(Turn { from: lo - ANGLE, to: hi + ANGLE, value: values[i] });
                } else if last[i] == -way {
                    // A corner exactly between two pieces.
                    found[i].push(self.turn_at(i, lo));
                }
                last[i] = way;
            }
        }
        for (i, turns) in found.iter().enumerate() {
            let ends = self.turn_at(i, 0.0).value.hull(self.turn_at(i, self.span).value);
            self.extent[i] = turns.iter().fold(ends, |all, turn| all.hull(turn.value));
        }
        [self.turns, self.x_turns, self.y_turns] = found;
        let scales = self.curve.a.log2().abs() + self.curve.b.log2().abs();
        self.error = steepest * ANGLE + 1e-15 * (4.0 + self.curve.condition() * (2.0 + scales));
    }

    fn turn_at(&self, i: usize, angle: f64) -> Turn {
        let value = self.piece(Interval::around(angle, 2.0 * ANGLE)).value(i);
        Turn { from: angle - ANGLE, to: angle + ANGLE, value }
    }

    /// Pieces to begin with, the last one first: between zeros of the sine and the cosine.
    fn first_pieces(&self) -> Vec<(f64, f64)> {
        let quarter = std::f64::consts::TAU / self.curve.m;
        let mut cuts: Vec<f64> = (0..=8).map(|i| self.span * f64::from(i) / 8.0).collect();
        let zeros = (1..=64).map(|k| f64::from(k) * quarter).take_while(|zero| *zero < self.span);
        cuts.extend(zeros);
        order::numbers(&mut cuts);
        cuts.windows(2).rev().map(|ends| (ends[0], ends[1])).filter(|(lo, hi)| lo < hi).collect()
    }

    /// Range of the gauge over the box `x × y`, y not negative.
    pub(super) fn gauge(&self, x: Interval, y: Interval) -> Interval {
        let (x0, x1, y0, y1) = (x.lo(), x.hi(), y.lo().max(0.0), y.hi());
        let corners = [[(x0, y0), (x0, y1)], [(x1, y0), (x1, y1)]].map(|pair| pair.map(|(x, y)| self.at(x, y)));
        let [[a, b], [c, d]] = corners;
        let all = a.1.hull(b.1).hull(c.1.hull(d.1));
        let (mut lo, mut hi) = (all.lo(), all.hi());
        if x0 <= 0.0 && x1 >= 0.0 && y0 == 0.0 {
            lo = 0.0;
        }
        // The angle falls along edges y = c from x0 to x1, and along an edge x = c it rises
        // or falls with the sign of c.
        let edges = [
            (&self.x_turns, x0, x0 > 0.0, a.0.min(b.0), a.0.max(b.0)),
            (&self.x_turns, x1, x1 < 0.0, c.0.min(d.0), c.0.max(d.0)),
            (&self.y_turns, y0, y0 > 0.0, c.0, a.0),
            (&self.y_turns, y1, false, d.0, b.0),
        ];
        for (turns, at, near, from, to) in edges {
            // Edges along a ray have their extremes at the corners.
            if at == 0.0 {
                continue;
            }
            for turn in Turn::within(turns, from - ANGLE, to + ANGLE) {
                let there = turn.value.abs();
                if near {
                    lo = lo.min((at.abs() / there.hi()).next_down());
                } else {
                    hi = hi.max((at.abs() / there.lo()).next_up());
                }
            }
        }
        if lo <= hi { Interval::new(lo.max(0.0), hi) } else { Interval::new(0.0, f64::INFINITY) }
    }

    /// The angle of a point and what the gauge may be there.
    #[inline]
    fn at(&self, x: f64, y: f64) -> (f64, Interval) {
        let angle = Real::atan2(y, x);
        let length = x.hypot(y);
        if length == 0.0 {
            return (angle, Interval::point(0.0));
        }
        if let Some(radius) = self.circle {
            let gauge = Interval::point(length) / radius;
            return (angle, gauge.inflate(gauge.hi() * self.error));
        }
        if self.error < 1e-9 {
            let gauge = length / self.curve.radius_at(angle, self.radius, self.winding);
            return (angle, Interval::around(gauge, gauge * self.error));
        }
        let length = Interval::around(length, 1e-15 * length);
        if let Some(jet) = self.tangents.as_ref().and_then(|tangents| tangents.jet(angle, ANGLE)) {
            return (angle, length * jet.inverse);
        }
        let r = self.curve.radius_at(Interval::around(angle, ANGLE), self.radius, self.winding);
        (angle, length / r)
    }

    /// Ranges of the gauge's derivatives over the box `x × y`, y not negative, along vectors; only
    /// of the part of it between the cusps that the angle `beside`, from 0 to π, is between, if
    /// there is one.
    ///
    /// ```text
    ///     g = ρ / r(θ)      g′ = (ρ′ − (ln r)′·ρθ′) / r        ρ′ along the radius, ρθ′ across it
    /// ```
    pub(super) fn rises<const N: usize>(
        &self,
        x: Interval,
        y: Interval,
        along: [[Interval; 2]; N],
        beside: Option<f64>,
    ) -> [Interval; N] {
        // A gauge's gradient is the same all along a ray.
        let angle = angles(x, y).inflate(ANGLE);
        let (radius, slope) = self.slope(angle, beside);
        let [cos, sin] = direction(angle);
        let zero = Interval::point(0.0);
        along.map(|[x, y]| {
            if x == zero && y == zero {
                return zero;
            }
            let across = if slope == zero { zero } else { slope * (cos * y - sin * x) };
            (cos * x + sin * y - across) / radius
        })
    }

    /// Ranges of the gauge and of its slope along a segment in the half of the plane where y is not
    /// negative, passed at the pace `slopes` in `length`: the polar angles of a segment are those
    /// between its ends.
    pub(super) fn along(
        &self,
        ends: [[Interval; 2]; 2],
        slopes: [Interval; 2],
        length: f64,
    ) -> Option<(Interval, Interval)> {
        let mut error = ANGLE;
        let polar = ends.map(|[x, y]| {
            let (at, above) = (x.mid(), y.mid().max(0.0));
            let distance = at.hypot(above);
            error = error.max(ANGLE + (x.width() + y.width()) / distance);
            (Real::atan2(above, at), Interval::around(distance, x.width() + y.width() + 1e-15 * distance))
        });
        let [(from, first), (to, last)] = polar;
        // Close to the origin, angles tell nothing.
        if first.lo() <= 0.0 || last.lo() <= 0.0 || error > 1e-9 {
            return None;
        }
        let angle = Interval::new(from, to);
        let zero = Interval::point(0.0);
        let (inverse, slope, gauges) = match (self.circle, &self.tangents) {
            (Some(radius), _) => {
                let inverse = Interval::point(1.0) / radius;
                (inverse, zero, [first * inverse, last * inverse])
            }
            (None, Some(tangents)) => {
                let arc = tangents.over(angle, error, None)?;
                let [Some(low), Some(high)] = arc.ends else { return None };
                let turns = Turn::within(&self.turns, from.min(to) - error, from.max(to) + error);
                let ends = low.inverse.hull(high.inverse);
                let inverse = turns.fold(ends, |all, turn| all.hull(Interval::point(1.0) / turn.value));
                let [at_first, at_last] = if from <= to { [low, high] } else { [high, low] };
                (inverse, arc.slope, [first * at_first.inverse, last * at_last.inverse])
            }
            _ => return None,
        };
        let [cos, sin] = direction(angle.inflate(error));
        let across = if slope == zero { zero } else { slope * (cos * slopes[1] - sin * slopes[0]) };
        let rise = (cos * slopes[0] + sin * slopes[1] - across) * inverse;
        let whole = gauges[0].hull(gauges[1]);
        if rise.lo() >= 0.0 || rise.hi() <= 0.0 {
            return Some((whole, rise));
        }
        let way = Interval::new(0.0, length);
        let range = (gauges[0] + rise * way).narrowed_by(gauges[1] - rise * way);
        Some((Interval::new(range.lo().max(0.0), range.hi().max(0.0)).hull(whole), rise))
    }

    /// By how much, relative to itself, the radius may be off on lanes of `f32` over the box
    /// `x × y`, y not negative.
    pub(super) fn roundoff(&self, x: Interval, y: Interval) -> f64 {
        let (most, steady) = (self.curve.roundoff(), self.curve.steady_roundoff());
        if most <= steady || self.curve.m == 0.0 {
            return most;
        }
        let error = self.curve.phase_error() / (0.25 * self.curve.m);
        let (_, slope) = self.slope(angles(x, y).inflate(2.0 * error), None);
        let steep = 2.0 * error * slope.magnitude();
        if steep < most { steep.max(steady) } else { most }
    }
}

/// The angles of the box `x × y`, y not negative.
fn angles(x: Interval, y: Interval) -> Interval {
    let (x0, x1, y0, y1) = (x.lo(), x.hi(), y.lo().max(0.0), y.hi());
    let least = Real::atan2(if x1 > 0.0 { y0 } else { y1 }, x1);
    let most = Real::atan2(if x0 >= 0.0 { y1 } else { y0 }, x0);
    Interval::new(least, most)
}

/// The cosines and sines of angles from 0 to π, give or take rounding.
fn direction(angle: Interval) -> [Interval; 2] {
    const ROUNDING: f64 = 1e-15;
    let ((sin, cos), (sin_to, cos_to)) = (angle.lo().sin_cos(), angle.hi().sin_cos());
    let upright = if angle.contains(FRAC_PI_2) { 1.0 } else { sin };
    let most = if angle.lo() <= 0.0 { 1.0 } else { cos };
    let least = if angle.hi() >= PI { -1.0 } else { cos_to };
    let sines = Interval::new(sin, sin_to).hull(Interval::point(upright));
    [Interval::new(least, most).inflate(ROUNDING), sines.inflate(ROUNDING)]
}

/// The radius of a curve that is a circle.
fn radius_of_circle(curve: &Gielis) -> Interval {
    let inverse = Interval::point(1.0) / Interval::point(curve.a);
    (inverse.log2() * curve.n2 * (-1.0 / curve.n1)).exp2()
}
