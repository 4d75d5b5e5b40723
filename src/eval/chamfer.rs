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

use glam::DVec3;

use super::bevel::Sample;
use crate::{Dual, Interval, Real};
use rvachev_field::VALUE_LIMIT;

/// At edges sharper than this (16°) the face stays as it is there.
const SHARPEST: f64 = -0.96;

/// Gradients shorter than this tell no direction.
const LEVEL: f64 = 1e-12;

/// Where the gradients change by less, the operands are planes.
const FLAT: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
pub(super) struct Chamfer {
    /// How far from the edge the face begins, along either operand's surface.
    pub(super) leg: f64,
    /// The operands' slopes are at most this.
    pub(super) steepest: f64,
}

/// What the face's height is made of.
struct Parts {
    /// Unit gradients, and their lengths before.
    normals: [DVec3; 2],
    lengths: [f64; 2],
    /// X and Y.
    distances: [f64; 2],
    cosine: f64,
}

impl Parts {
    fn of(sides: [Sample; 2]) -> Option<Parts> {
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
    pub(super) fn height(self, sides: [Sample; 2]) -> f64 {
        let Some(parts) = Parts::of(sides) else { return f64::NEG_INFINITY };
        let (k, m) = factors(parts.cosine);
        ((parts.distances[0] + parts.distances[1]) / m + self.leg * k).min(VALUE_LIMIT)
    }

    /// The unit gradients of the operands, along which [`slope`](Self::slope) asks for changes.
    pub(super) fn normals(self, sides: [Sample; 2]) -> [DVec3; 2] {
        sides.map(|(_, gradient)| gradient.normalize_or_zero())
    }

    /// The gradient of T; `turns[i][j]` is the derivative of operand i's gradient along the unit
    /// gradient of operand j.
    pub(super) fn slope(self, sides: [Sample; 2], turns: [[DVec3; 2]; 2]) -> DVec3 {
        let Some(Parts { normals, lengths, distances, cosine }) = Parts::of(sides) else { return DVec3::ZERO };
        let (k, m) = factors(cosine);
        let turns = [0, 1].map(|i| turns[i].map(|turn| turn / lengths[i]));
        let steady = cosine <= SHARPEST || k < 1e-6;
        let turning =
            if steady { DVec3::ZERO } else { turns[0][1] - cosine * turns[0][0] + turns[1][0] - cosine * turns[1][1] };
        let sum = (distances[0] + distances[1]) / m;
        let own = |i: usize| normals[i] - distances[i] * turns[i][i];
        // k′ = −1/(4k) and m′ = 1/m.
        let along = if steady { 0.0 } else { -0.25 * self.leg / k - sum / (m * m) };
        (own(0) + own(1)) / m + along * turning
    }

    /// T where the operands have these values and gradients.
    pub(super) fn range(self, values: [Interval; 2], gradients: [[Interval; 3]; 2]) -> Interval {
        let everything = Interval::new(f64::NEG_INFINITY, VALUE_LIMIT);
        let lengths = gradients.map(length);
        if !lengths.iter().all(|length| length.lo() >= LEVEL) {
            return everything;
        }
        let normals = [0, 1].map(|i| gradients[i].map(|d| (d / lengths[i]).narrowed_by(Interval::new(-1.0, 1.0))));
        let [n, o] = normals;
        let cosine = n[0] * o[0] + n[1] * o[1] + n[2] * o[2];
        let (most, short) = factors(cosine.lo().clamp(SHARPEST, 1.0));
        let (least, long) = factors(cosine.hi().clamp(SHARPEST, 1.0));
        let sum = values[0] / lengths[0] + values[1] / lengths[1];
        let height = sum / Interval::new(short, long) + Interval::new(least, most) * Interval::point(self.leg);
        height.narrowed_by(everything)
    }

    /// T and its slopes along the variables of `sides` where the operands are planes.
    pub(super) fn plane(self, sides: [Dual<Interval>; 2], gradients: [[Interval; 3]; 2]) -> Option<Dual<Interval>> {
        if !gradients.iter().flatten().all(|side| side.width() <= FLAT) {
            return None;
        }
        let Parts { lengths, cosine, .. } =
            Parts::of(gradients.map(|gradient| (0.0, DVec3::from_array(gradient.map(Interval::mid)))))?;
        let (k, m) = factors(cosine);
        let lifted = |c: f64| Dual::constant(Interval::point(c));
        let [x, y] = [0, 1].map(|i| sides[i] * lifted(1.0 / (lengths[i] * m)));
        Some(x + y + lifted(self.leg * k))
    }
}

/// The length of a vector.
pub(super) fn length(d: [Interval; 3]) -> Interval {
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}
