//! The surface of a ball that rolls along two operands.
//!
//! Its centre runs on the curve x = y = −r. With q the point of the curve nearest to p, the
//! blend is |p − q| − r where p − q lies between the two gradients at q. q is found by Newton
//! steps on both conditions at once, each the nearest point to p of the line where the two
//! tangent planes meet: exact for planes at once, to a thousandth of r for what bends four times
//! less than the ball after two. Since q is nearest, the gradient is `(p − q)/|p − q|` without
//! second derivatives.
//!
//! Where the steps do not arrive (an operand has an edge of its own there), what the first of them
//! tells is taken, by the values and slopes at p alone: the blend goes round that edge in a mitre.

use glam::DVec3;

use super::Sample;

/// As many Newton steps are made from a point to the curve.
pub(super) const STEPS: usize = 3;

/// Slopes are at most 1, but for the approximation of distances below.
pub(super) const STEEPEST: f64 = 1.05;

/// A foot that is farther off the curve, in radii, is not where the ball touches: the share of the
/// first foot grows by so much with what it is off.
const ARRIVED: f64 = 0.05;
const FADING: f64 = 4.0;

/// Feet that are no farther off than this, and have come to rest to this, in radii, tell of the
/// feet of points around.
const TELLING: f64 = 0.01;

/// Slopes are taken to be at most this where the first foot takes over.
pub(super) const FADES: f64 = 30.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Fillet {
    pub(super) radius: f64,
}

impl Fillet {
    /// Where an operand is farther away than this, the blend is the join: where the operands meet
    /// at an acute angle, the ball touches one of them up to two radii from the other.
    pub(super) fn reach(self) -> f64 {
        2.0 * self.radius
    }

    /// Steps end this far from the point, and no blend is above this where it is above the join.
    pub(super) fn farthest(self) -> f64 {
        4.0 * self.reach()
    }

    /// How far off the curve a foot is where the operands are like this, in radii.
    pub(super) fn off(self, sides: [Sample; 2]) -> f64 {
        sides.iter().map(|(value, _)| (value / self.radius + 1.0).abs()).fold(0.0, f64::max)
    }

    /// Whether a foot that is so far off tells of those of points around.
    pub(super) fn tells(self, foot: &Foot, off: f64) -> bool {
        off.max(foot.moved / self.radius) <= TELLING
    }

    /// The ball's surface at p, where p is between the lines of contact.
    fn ball(self, p: DVec3, foot: &Foot) -> Option<Sample> {
        if foot.weights.iter().any(|&weight| weight > 0.0) {
            return None;
        }
        let away = p - foot.q;
        Some((away.length() - self.radius, away.normalize_or_zero()))
    }

    /// The blend at p, at least `join`, from the foot after the first step and the last one, which
    /// is so far off.
    pub(super) fn blend(self, p: DVec3, join: Sample, first: &Foot, last: &Foot, off: f64) -> Sample {
        let at_least = |foot: &Foot| self.ball(p, foot).filter(|ball| ball.0 > join.0).unwrap_or(join);
        let share = (FADING * (off - ARRIVED)).clamp(0.0, 1.0);
        if share == 0.0 {
            return at_least(last);
        }
        let (from, to) = (if share < 1.0 { at_least(last) } else { join }, at_least(first));
        (from.0 + share * (to.0 - from.0), from.1.lerp(to.1, share))
    }
}

/// The point of the centre's curve nearest to a point, as far as it is known.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    pub(super) q: DVec3,
    /// q − p in terms of the two gradients.
    weights: [f64; 2],
    /// How far the last step has moved q.
    moved: f64,
}

impl Foot {
    pub(super) fn new(p: DVec3) -> Foot {
        Foot { q: p, weights: [0.0; 2], moved: 0.0 }
    }

    /// A Newton step: the point nearest to p of the line on which both tangent planes at q are at
    /// −r. False if there is no such line near.
    pub(super) fn step(&mut self, p: DVec3, sides: [Sample; 2], fillet: Fillet) -> bool {
        let [(x, a), (y, b)] = sides;
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let determinant = aa * bb - ab * ab;
        let parallel = determinant <= 1e-6 * aa * bb;
        if parallel || determinant.is_nan() {
            return false;
        }
        let from = self.q - p;
        let (u, v) = (a.dot(from) - (x + fillet.radius), b.dot(from) - (y + fillet.radius));
        self.weights = [(bb * u - ab * v) / determinant, (aa * v - ab * u) / determinant];
        let step = self.weights[0] * a + self.weights[1] * b;
        self.moved = (p + step).distance(self.q);
        self.q = p + step;
        step.length() <= fillet.farthest()
    }
}
