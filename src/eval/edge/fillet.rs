//! The surface of a ball that rolls along two operands.
//!
//! Its centre is where x ≤ −r and y ≤ −r, a set E, and the material of the blend is what no such ball
//! reaches: with q the point of E nearest to p, the blend is |p − q| − r if q is on the edge of E, where
//! x = y = −r, and the join of the operands if it is on a face. q is found by steps, each to the point
//! nearest to p of what the tangent planes at the one before leave of E: exact for planes at once, and of
//! second order for what bends. Since q is nearest, the gradient is `(p − q)/|p − q|` without
//! second derivatives, and the slope is 1.
//!
//! Where the steps do not arrive (an operand has an edge of its own there), what the first of them
//! tells is taken, by the values and slopes at p alone: the blend goes round that edge in a mitre.

use glam::DVec3;

use super::Sample;

/// At most so many steps are made from a point to the nearest centre of a ball.
const STEPS: usize = 8;

/// The last one is shorter than this, in radii.
const STILL: f64 = 1e-3;

/// From the third on, each is shorter than the one before by this.
const SHRINKS: f64 = 0.7;

/// Slopes are at most 1, but for the approximation of distances below.
pub(super) const STEEPEST: f64 = 1.05;

/// A foot that is farther off, in radii, is not where the ball touches: the share of the first foot
/// grows by so much with what it is off.
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

    /// Whether there are steps to make where the parts have these values. Well inside of either, at r
    /// and more, the blend is taken to be the join: no surface is near.
    pub(super) fn near(self, [x, y]: [f64; 2]) -> bool {
        x.min(y) >= -self.reach() && x.max(y) < self.radius
    }

    /// The ball's surface at p, where p is between the lines of contact.
    fn ball(self, p: DVec3, foot: &Foot) -> Option<Sample> {
        if foot.touches != [true; 2] {
            return None;
        }
        let away = p - foot.q;
        Some((away.length() - self.radius, away.normalize_or_zero()))
    }
}

/// The search for the centre of a ball that is nearest to a point.
#[derive(Clone, Copy)]
pub(super) struct Search {
    fillet: Fillet,
    p: DVec3,
    /// After the first step, and after the last one.
    first: Foot,
    last: Foot,
    steps: usize,
    /// How far off the last foot is, in radii.
    off: f64,
    pub(super) ended: bool,
}

impl Search {
    /// The first step, from where the parts are like this; none if there is no ball near.
    pub(super) fn start(fillet: Fillet, p: DVec3, here: [Sample; 2]) -> Option<Search> {
        let mut foot = Foot { q: p, touches: [false; 2], moved: 0.0 };
        let found = foot.step(p, here, fillet);
        found.then_some(Search { fillet, p, first: foot, last: foot, steps: 1, off: f64::INFINITY, ended: false })
    }

    /// Where the parts are asked for next.
    pub(super) fn at(&self) -> DVec3 {
        self.last.q
    }

    /// The next step, from where the parts are like this.
    pub(super) fn go_on(&mut self, sides: [Sample; 2]) {
        let before = self.last.moved;
        self.off = self.last.off(sides, self.fillet);
        self.ended = self.steps == STEPS;
        if self.ended {
            return;
        }
        self.steps += 1;
        if !self.last.step(self.p, sides, self.fillet) {
            (self.off, self.ended) = (f64::INFINITY, true);
        } else if self.last.moved <= STILL * self.fillet.radius {
            // It is where it was, though it may touch another part than it did.
            (self.off, self.ended) = (self.last.off(sides, self.fillet), true);
        } else {
            // On a part's medial axis it does not come to rest.
            self.ended = self.steps > 2 && self.last.moved > SHRINKS * before;
        }
    }

    /// How far from the point its foot tells of the feet of others: not as far as where they are taken to be
    /// too far away, and nowhere if it has not arrived.
    pub(super) fn tells(&self) -> f64 {
        let arrived = self.off.max(self.last.moved / self.fillet.radius) <= TELLING;
        if arrived { self.fillet.farthest() - self.p.distance(self.last.q) } else { 0.0 }
    }

    /// The blend, at least `join`.
    pub(super) fn blend(&self, join: Sample) -> Sample {
        let at_least = |foot: &Foot| self.fillet.ball(self.p, foot).filter(|ball| ball.0 > join.0).unwrap_or(join);
        let share = (FADING * (self.off - ARRIVED)).clamp(0.0, 1.0);
        if share == 0.0 {
            return at_least(&self.last);
        }
        let (from, to) = (if share < 1.0 { at_least(&self.last) } else { join }, at_least(&self.first));
        (from.0 + share * (to.0 - from.0), from.1.lerp(to.1, share))
    }
}

/// The centre of a ball nearest to a point, as far as it is known.
#[derive(Clone, Copy)]
struct Foot {
    q: DVec3,
    /// Which of the parts the ball touches.
    touches: [bool; 2],
    /// How far the last step has moved q.
    moved: f64,
}

impl Foot {
    /// How far off it is where the parts are like this, in radii.
    fn off(&self, sides: [Sample; 2], fillet: Fillet) -> f64 {
        let off = |i: usize| {
            let over = sides[i].0 / fillet.radius + 1.0;
            if self.touches[i] { over.abs() } else { over.max(0.0) }
        };
        off(0).max(off(1))
    }

    /// A step: to the point nearest to p where neither of the tangent planes at q is above −r. False if
    /// there is none near.
    fn step(&mut self, p: DVec3, sides: [Sample; 2], fillet: Fillet) -> bool {
        let from = self.q - p;
        let [(u, a), (v, b)] = sides.map(|(value, slope)| (slope.dot(from) - (value + fillet.radius), slope));
        let Some((way, touches)) = least([a, b], [u, v]) else { return false };
        *self = Foot { q: p + way, touches, moved: (p + way).distance(self.q) };
        way.length() <= fillet.farthest()
    }
}

/// The shortest d with a·d ≤ u and b·d ≤ v, and which of them it reaches.
fn least([a, b]: [DVec3; 2], [u, v]: [f64; 2]) -> Option<(DVec3, [bool; 2])> {
    if u >= 0.0 && v >= 0.0 {
        return Some((DVec3::ZERO, [false; 2]));
    }
    let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
    // To one of the planes, if that is behind the other.
    if u < 0.0 && ab * u <= v * aa && aa > 0.0 {
        return Some((a * (u / aa), [true, false]));
    }
    if v < 0.0 && ab * v <= u * bb && bb > 0.0 {
        return Some((b * (v / bb), [false, true]));
    }
    let determinant = aa * bb - ab * ab;
    let parallel = determinant <= 1e-6 * aa * bb;
    if parallel || determinant.is_nan() {
        return None;
    }
    let weights = [(bb * u - ab * v) / determinant, (aa * v - ab * u) / determinant];
    Some((weights[0] * a + weights[1] * b, [true; 2]))
}
