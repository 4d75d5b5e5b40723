//! The face of a chamfer, told by the operands' values and slopes at the point itself.
//!
//! With X = x/|∇x| and Y = y/|∇y| the distances, to first order, and c the cosine between the
//! gradients:
//!
//! ```text
//!     T = (X + Y) / m + l·k       k = √((1 − c)/2)     m = √(2 + 2c)
//!
//!          |  y
//!          |·
//!        l | ·            T = 0 is the dotted plane; on either operand's surface it is
//!          |  ·           the leg l away from the edge
//!     -----+---·---- x
//!             l
//! ```
//!
//! For planes T is the distance to that plane: with q on the edge and unit normals n₁, n₂, X + Y =
//! (n₁ + n₂)·(p − q), m is the length of n₁ + n₂, and k the sine of half the angle between them: at
//! a leg from the edge along a plane X + Y is −l·√(1 − c²) = −l·k·m. Where the angle between the
//! operands changes from the edge to the rim of the face, c is that at the rim: the legs of balls,
//! pipes and planes are off by 2 % at l a twelfth of their radius, by 7 % at a quarter, and not at
//! all where they meet at a right angle throughout, as the caps of an extrusion do. There is
//! nothing to search for, so T goes on steadily wherever the gradients do. Operands that face each
//! other closer than 0.28 l are bridged.
//!
//! With n and o the unit gradients, and A and B the matrices of the operands' second derivatives,
//! each divided by the length of its gradient,
//!
//! ```text
//!     ∇X = n − X·A n      ∇c = A (o − c n) + B (n − c o)
//!     ∇T = (∇X + ∇Y)/m − (l/(4k) + (X + Y)/m³) ∇c
//! ```
//!
//! so ranges of first and second derivatives over a box ([`Jet`]) bound the slopes of T in it: rays
//! go from there by Newton's method, and boxes that the face does not cross are told by the value
//! in their middle and those slopes.

use glam::DVec3;

use super::bevel::Sample;
use crate::{Interval, Jet, Real};
use rvachev_field::VALUE_LIMIT;

/// At edges sharper than this (16°) the face stays as it is there.
const SHARPEST: f64 = -0.96;

/// Where k is less both operands are one plane, and T is as steady as they are.
const EVEN: f64 = 1e-6;

/// How far off T may be at a point, in proportion to the lengths about it.
const ROUNDING: f64 = 1e-12;

/// Gradients shorter than this tell no direction.
const LEVEL: f64 = 1e-12;

#[derive(Clone, Copy, Debug)]
pub(super) struct Chamfer {
    /// How far from the edge the face begins, along either operand's surface.
    pub(super) leg: f64,
    /// The operands' slopes are at most this.
    pub(super) steepest: f64,
}

/// What the face's height is made of.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    /// Unit gradients, and their lengths before.
    pub(super) normals: [DVec3; 2],
    lengths: [f64; 2],
    /// X and Y.
    distances: [f64; 2],
    cosine: f64,
}

impl Parts {
    /// None where an operand has no slope.
    pub(super) fn of(sides: [Sample; 2]) -> Option<Parts> {
        let lengths = sides.map(|(_, gradient)| gradient.length());
        if lengths.iter().any(|&length| length.is_nan() || length < LEVEL) {
            return None;
        }
        let normals = [0, 1].map(|i| sides[i].1 / lengths[i]);
        let distances = [0, 1].map(|i| sides[i].0 / lengths[i]);
        Some(Parts { normals, lengths, distances, cosine: normals[0].dot(normals[1]).clamp(SHARPEST, 1.0) })
    }
}

/// k and m.
fn factors(cosine: f64) -> (f64, f64) {
    ((0.5 * (1.0 - cosine)).max(0.0).sqrt(), (2.0 + 2.0 * cosine).sqrt())
}

impl Chamfer {
    /// Where an operand's value is below the negative of this, T is negative, and the blend is the
    /// join.
    pub(super) fn reach(self) -> f64 {
        self.steepest * self.leg
    }

    /// The value T; below all others where an operand has no slope.
    pub(super) fn height(self, parts: Option<&Parts>) -> f64 {
        let Some(parts) = parts else { return f64::NEG_INFINITY };
        let (k, m) = factors(parts.cosine);
        ((parts.distances[0] + parts.distances[1]) / m + self.leg * k).min(VALUE_LIMIT)
    }

    /// How far off the value may be at a point so far from the origin.
    pub(super) fn rounding(self, parts: Option<&Parts>, reach: f64) -> f64 {
        let Some(parts) = parts else { return 0.0 };
        let least = parts.lengths[0].min(parts.lengths[1]).min(1.0);
        let (k, _) = factors(parts.cosine);
        ROUNDING * (reach / least + self.leg / k.max(EVEN))
    }

    /// The gradient of T; `turns[i][j]` is the derivative of operand i's gradient along the unit
    /// gradient of operand j.
    pub(super) fn slope(self, parts: &Parts, turns: [[DVec3; 2]; 2]) -> DVec3 {
        let Parts { normals, lengths, distances, cosine } = *parts;
        let (k, m) = factors(cosine);
        let turns = [0, 1].map(|i| turns[i].map(|turn| turn / lengths[i]));
        let steady = cosine <= SHARPEST || k < EVEN;
        let turning =
            if steady { DVec3::ZERO } else { turns[0][1] - cosine * turns[0][0] + turns[1][0] - cosine * turns[1][1] };
        let sum = (distances[0] + distances[1]) / m;
        let own = |i: usize| normals[i] - distances[i] * turns[i][i];
        // k′ = −1/(4k) and m′ = 1/m.
        let along = if steady { 0.0 } else { -0.25 * self.leg / k - sum / (m * m) };
        (own(0) + own(1)) / m + along * turning
    }

    /// The most that T is where the operands have these values, whatever their normals are: with
    /// 2ψ the angle between these, s = X + Y and m = 2 cos ψ it is (s + l·sin 2ψ)/m.
    pub(super) fn most(self, values: [Interval; 2]) -> f64 {
        let [x, y] = values.map(Interval::hi);
        if x > 0.0 || y > 0.0 {
            return VALUE_LIMIT;
        }
        // Distances are no less than values by the steepest slope.
        let beyond = self.leg + (x + y) / self.steepest;
        if beyond < 0.0 { 0.5 * beyond } else { self.leg }
    }

    /// T where the operands have these values and gradients.
    pub(super) fn range(self, values: [Interval; 2], gradients: [[Interval; 3]; 2]) -> Interval {
        let everything = Interval::new(f64::NEG_INFINITY, self.most(values));
        let lengths = gradients.map(length);
        if !lengths.iter().all(|length| length.lo() >= LEVEL) {
            return everything;
        }
        let [n, o] = normals(gradients, lengths);
        let cosine = dot(n, o);
        let (most, short) = factors(cosine.lo().clamp(SHARPEST, 1.0));
        let (least, long) = factors(cosine.hi().clamp(SHARPEST, 1.0));
        let sum = values[0] / lengths[0] + values[1] / lengths[1];
        let height = sum / Interval::new(short, long) + Interval::new(least, most) * Interval::point(self.leg);
        height.narrowed_by(everything)
    }

    /// Ranges of the gradient of T, as [`slope`](Self::slope) has it; without bound where the
    /// operands' normals may turn without.
    pub(super) fn slopes(self, sides: [&Jet; 2]) -> [Interval; 3] {
        let lengths = sides.map(|side| length(side.d));
        if !lengths.iter().all(|length| length.lo() >= LEVEL) {
            return [Interval::ALL; 3];
        }
        let normals = normals(sides.map(|side| side.d), lengths);
        let cosine = dot(normals[0], normals[1]);
        let [least, most] = [cosine.lo(), cosine.hi()].map(|cosine| factors(cosine.clamp(SHARPEST, 1.0)));
        let (k, m) = (Interval::new(most.0, least.0), Interval::new(least.1, most.1));
        let distances = [0, 1].map(|i| sides[i].v / lengths[i]);
        // How the unit gradients turn along themselves, and their cosine all about.
        let (mut own, mut turning) = ([[Interval::ZERO; 3]; 2], [Interval::ZERO; 3]);
        for i in 0..2 {
            let turn = sides[i].turn(normals[i]);
            let other = sides[i].turn([0, 1, 2].map(|axis| normals[1 - i][axis] - cosine * normals[i][axis]));
            for axis in 0..3 {
                own[i][axis] = normals[i][axis] - distances[i].times(turn[axis] / lengths[i]);
                turning[axis] = turning[axis] + other[axis] / lengths[i];
            }
        }
        let sum = (distances[0] + distances[1]) / m;
        let along = -(Interval::point(0.25 * self.leg) / k) - sum / m.square();
        // At sharper edges the face is as it is there.
        let is_told = cosine.lo() > SHARPEST && k.lo() >= EVEN;
        let along = if is_told { along } else { along.hull(Interval::ZERO) };
        [0, 1, 2].map(|axis| (own[0][axis] + own[1][axis]) / m + along.times(turning[axis]))
    }
}

/// Unit vectors along two that are so long.
fn normals(vectors: [[Interval; 3]; 2], lengths: [Interval; 2]) -> [[Interval; 3]; 2] {
    [0, 1].map(|i| vectors[i].map(|d| (d / lengths[i]).narrowed_by(Interval::new(-1.0, 1.0))))
}

fn dot(a: [Interval; 3], b: [Interval; 3]) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The length of a vector.
pub(super) fn length(d: [Interval; 3]) -> Interval {
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}
