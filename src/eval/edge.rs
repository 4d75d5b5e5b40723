//! Fillets and chamfers: blends along the edge where two operands meet.
//!
//! For a union, with the operands' values x and y positive inside (true distances for a fillet;
//! for a chamfer any of slope up to 4 will do):
//!
//! ```text
//!     fillet    a ball of radius r rolls outside along both operands: its centre runs on the
//!               curve x = y = −r. With q the point of the curve nearest to p, the blend is
//!               |p − q| − r where p − q lies between the two gradients at q, else max(x, y)
//!     chamfer   with q the point of the edge x = y = 0 nearest to p, n₁ and n₂ the unit
//!               gradients there and c = n₁·n₂: max(x, y, ((n₁ + n₂)·(p − q) + w√((1−c)/2))
//!               / √(2 + 2c)), a plane that cuts a face of width w
//! ```
//!
//! The other operations are those of complements (De Morgan). q is found by Newton steps on
//! both conditions at once, each the nearest point to p of the line where the two tangent
//! planes meet; for planes one step is exact. Since q is nearest, the gradient of the fillet
//! is `(p − q)/|p − q|` without second derivatives. Both forms exceed max(x, y), and change
//! by at most 1 per length unit.
//!
//! A fillet is exact where the ball fits and touches each operand once. It needs operands
//! that are smooth within a radius of the edge; where they have edges of their own it falls
//! back on the join there.
//!
//! Source: J. R. Rossignac and A. A. G. Requicha, *Constant-radius blending in solid
//! modelling* (1984), for the rolling ball.

use glam::{DAffine3, DVec3};

use super::composite::{Locals, Slopes, Whole, finish, points64, roundoff, with_evaluator, write_gradients};
use super::{Program, Tape};
use crate::field::{AnyField, Chunk, Zone, steep_slopes};
use crate::num::kernel::CHUNK;
use crate::num::symbol::Symbol;
use crate::solid::Operation;
use crate::{Blend, Bounds, Dual, Interval, ParamError, Real};

/// The blend of two operands that are given as programs of true distance.
#[derive(Clone, Debug)]
pub(crate) struct EdgeBlend {
    operands: [Whole; 2],
    /// −1 for an operand whose complement is joined.
    signs: [f64; 2],
    /// −1 for the complement of a union of complements.
    sign: f64,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Fillet(f64),
    Chamfer(f64),
}

/// As many Newton steps are made from a point to the edge.
const STEPS: usize = 4;

/// Slopes are at most 1, but for the approximation of distances below.
const STEEPEST: f64 = 1.05;

/// A chamfer ends where the sum of the unit gradients is shorter than this.
const LEAST_ACROSS: f64 = 1e-3;

/// A value and its gradient.
type Sample = (f64, DVec3);

impl EdgeBlend {
    pub(super) fn new(operation: Operation, blend: Blend, operands: [Program; 2]) -> EdgeBlend {
        let (sign, signs) = match operation {
            Operation::Union => (1.0, [1.0, 1.0]),
            Operation::Difference => (-1.0, [-1.0, 1.0]),
            Operation::Intersection | Operation::SymmetricDifference => (-1.0, [-1.0, -1.0]),
        };
        let shape = match blend {
            Blend::Fillet { radius } => Shape::Fillet(radius),
            Blend::Chamfer { width } => Shape::Chamfer(width),
            _ => Shape::Fillet(0.0),
        };
        EdgeBlend { operands: operands.map(Whole::new), signs, sign, shape }
    }

    /// The radius or width.
    pub(super) fn size(&self) -> f64 {
        match self.shape {
            Shape::Fillet(size) | Shape::Chamfer(size) => size,
        }
    }

    /// Where an operand is farther away than this, the blend is the join. (Where the operands
    /// meet at an acute angle, the ball touches one of them up to two radii from the other.)
    fn reach(&self) -> f64 {
        match self.shape {
            Shape::Fillet(radius) => 2.0 * radius,
            // The face is within its width of both operands.
            Shape::Chamfer(width) => 4.0 * width,
        }
    }

    /// Whether the blend is worth the steps to the edge where the operands have these values:
    /// not beyond its reach, and not well inside of either, where the join says enough.
    fn near(&self, [x, y]: [f64; 2]) -> bool {
        x.min(y) >= -self.reach() && x.max(y) < self.size()
    }

    /// What both operands are at the curve that q lies on.
    fn depth(&self) -> f64 {
        match self.shape {
            Shape::Fillet(radius) => -radius,
            Shape::Chamfer(_) => 0.0,
        }
    }

    /// Whether the blend, moved by `shift`, may differ from the join over a zone.
    pub(super) fn reaches(&self, zone: &Zone, shift: f64) -> bool {
        let reach = self.reach() + shift.abs();
        self.ranges(zone).iter().all(|range| range.hi() >= -reach)
    }

    fn ranges(&self, zone: &Zone) -> [Interval; 2] {
        [0, 1].map(|i| self.operands[i].range_zone(zone) * Interval::point(self.signs[i]))
    }

    /// The same blend over a zone, from simpler operands.
    pub(super) fn reduced(&self, zone: &Zone) -> Option<EdgeBlend> {
        let leaves = |[a, b]: [&Program; 2]| a.leaf_count() + b.leaf_count();
        // From a point of the zone the steps lead at most this far.
        let near = zone.inflated(4.0 * self.reach());
        let operands = [0, 1].map(|i| self.operands[i].reduced(&near));
        let simpler = leaves(operands.each_ref()) < leaves(self.operands.each_ref().map(|operand| &**operand));
        simpler.then(|| EdgeBlend { operands: operands.map(Whole::new), ..*self })
    }

    fn sample(&self, i: usize, p: DVec3) -> Sample {
        let (value, gradient) = self.operands[i].gradient(p);
        (self.signs[i] * value, self.signs[i] * gradient)
    }

    /// Value and gradient of the blend, as a union.
    fn at(&self, p: DVec3) -> Sample {
        self.told(p).0
    }

    /// The same, and whether it tells anything of the points around: not where the search for
    /// the foot has failed, as it does on an operand's medial axis. Beside such a point the
    /// blend may be far above the join.
    fn told(&self, p: DVec3) -> (Sample, bool) {
        let here = [self.sample(0, p), self.sample(1, p)];
        let join = larger(here[0], here[1]);
        if !self.near(here.map(|(value, _)| value)) {
            return (join, true);
        }
        let mut foot = Foot::new(p);
        let mut sides = here;
        for _ in 0..STEPS {
            if !foot.step(p, sides, self.depth(), self.farthest()) {
                // Faces that are flush are parallel all about.
                let [a, b] = sides.map(|(_, gradient)| gradient.normalize_or_zero());
                return (join, a.dot(b) > 0.999);
            }
            sides = [self.sample(0, foot.q), self.sample(1, foot.q)];
        }
        (self.shaped(p, &foot, sides, join), self.arrived(sides))
    }

    /// Whether a foot with these operands is on the curve.
    fn arrived(&self, sides: [Sample; 2]) -> bool {
        let off = sides.iter().map(|(value, _)| (value - self.depth()).abs()).fold(0.0, f64::max);
        off <= 0.05 * self.size()
    }

    /// No blend is above this where it is above the join.
    fn largest(&self) -> f64 {
        match self.shape {
            Shape::Fillet(_) => self.farthest(),
            Shape::Chamfer(width) => 2.0 * width + width / LEAST_ACROSS,
        }
    }

    /// Steps end this far from the point.
    fn farthest(&self) -> f64 {
        4.0 * self.reach()
    }

    /// The blend at p, given the foot and the operands there.
    fn shaped(&self, p: DVec3, foot: &Foot, sides: [Sample; 2], join: Sample) -> Sample {
        // A foot that has not been reached is of no use.
        if !self.arrived(sides) {
            return join;
        }
        let away = p - foot.q;
        let shaped = match self.shape {
            Shape::Fillet(radius) => {
                let between = foot.weights[0] <= 0.0 && foot.weights[1] <= 0.0;
                let distance = away.length();
                if !between || distance == 0.0 {
                    // At the centre of the ball, any direction is as good.
                    return if between { (-radius, join.1) } else { join };
                }
                (distance - radius, away / distance)
            }
            Shape::Chamfer(width) => {
                let [a, b] = sides.map(|(_, gradient)| gradient.normalize_or_zero());
                let c = a.dot(b);
                let across = (2.0 + 2.0 * c).sqrt();
                if across < LEAST_ACROSS || away.length() > 2.0 * width {
                    return join;
                }
                let height = (a + b).dot(away) + width * (0.5 * (1.0 - c)).max(0.0).sqrt();
                (height / across, (a + b) / across)
            }
        };
        larger(join, shaped)
    }
}

/// The one with the larger value.
fn larger(a: Sample, b: Sample) -> Sample {
    if a.0 >= b.0 { a } else { b }
}

/// The point of the edge curve nearest to a point, as far as it is known.
#[derive(Clone, Copy)]
struct Foot {
    q: DVec3,
    /// q − p in terms of the two gradients.
    weights: [f64; 2],
}

impl Foot {
    fn new(p: DVec3) -> Foot {
        Foot { q: p, weights: [0.0; 2] }
    }

    /// A Newton step: the point nearest to p of the line on which both tangent planes at q
    /// have the value `depth`. False if there is no such line near.
    fn step(&mut self, p: DVec3, sides: [Sample; 2], depth: f64, farthest: f64) -> bool {
        let [(x, a), (y, b)] = sides;
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let determinant = aa * bb - ab * ab;
        let parallel = determinant <= 1e-6 * aa * bb;
        if parallel || determinant.is_nan() {
            return false;
        }
        let from = self.q - p;
        let (u, v) = (a.dot(from) - (x - depth), b.dot(from) - (y - depth));
        self.weights = [(bb * u - ab * v) / determinant, (aa * v - ab * u) / determinant];
        let step = self.weights[0] * a + self.weights[1] * b;
        self.q = p + step;
        step.length() <= farthest
    }
}

impl AnyField for EdgeBlend {
    fn name(&self) -> &'static str {
        match self.shape {
            Shape::Fillet(_) => "fillet",
            Shape::Chamfer(_) => "chamfer",
        }
    }

    fn bounds_under(&self, _map: &DAffine3) -> Bounds {
        // Told by the node, from its operands.
        Bounds::ALL
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4.0 * (roundoff(&self.operands[0], reach) + roundoff(&self.operands[1], reach)) + 1e-6 * reach
    }

    fn exact(&self) -> bool {
        true
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let p = DVec3::from_array(p);
        let here = [0, 1].map(|i| self.signs[i] * self.operands[i].value(p));
        if !self.near(here) {
            return self.sign * here[0].max(here[1]);
        }
        self.sign * self.at(p).0
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = self.at(DVec3::from_array(p.map(Dual::value)));
        let along = |i: usize| (0..3).map(|axis| gradient[axis] * p[axis].gradient()[i]).sum::<f64>() * self.sign;
        Dual::new(self.sign * value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let hull = p.map(Dual::value);
        Dual::new(self.range(&Zone::of_sides(hull)), steep_slopes(STEEPEST, p))
    }

    fn convex(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        let [x, y] = self.ranges(zone);
        let join = x.max(y);
        let reach = self.reach();
        if x.hi() < -reach || y.hi() < -reach {
            return join * Interval::point(self.sign);
        }
        // The blend is at least the join, whatever became of its steps. Within reach of the
        // ball it is the distance from the centre curve, of slope 1; beyond, no more than the
        // longest way to a foot.
        let ((centre, _), told) = self.told(zone.centre);
        let steepest = if matches!(self.shape, Shape::Fillet(_)) { STEEPEST } else { 4.0 };
        let radius = steepest * zone.extent().length();
        // Close to where the steps arrive they arrive from all about, and where they fail they
        // fail all about.
        let extent = zone.extent().length();
        let close = extent < if told { 0.25 } else { 0.05 } * self.size();
        let below = (told || close) && centre + radius < 0.0;
        let hi = if below { centre + radius } else { join.hi().max(self.largest()) };
        let lo = if close { join.lo().max(centre - radius) } else { join.lo() };
        Interval::new(lo, hi.max(lo)) * Interval::point(self.sign)
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with a fillet are not lowered; its join stands in for it.
        let [a, b] = [0, 1].map(|i| self.operands[i].evaluate(p, &mut Vec::new()) * self.signs[i]);
        a.max(b) * self.sign
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let local = Locals::of(&chunk.points, chunk.placement);
        let [out] = chunk.out;
        let mut values = [[0.0f32; CHUNK]; 2];
        let tapes = [self.operands[0].tape(), self.operands[1].tape()];
        let mut near = false;
        with_evaluator(|evaluator| {
            for i in 0..2 {
                local.values(evaluator, tapes[i], &mut values[i]);
                let sign = self.signs[i] as f32;
                values[i].iter_mut().for_each(|v| *v *= sign);
            }
        });
        for (x, y) in values[0].iter().zip(&values[1]).take(local.count) {
            near |= self.near([f64::from(*x), f64::from(*y)]);
        }
        if near {
            out.copy_from_slice(&self.chunk(&local, tapes).value[..out.len()]);
        } else {
            for (i, out) in out.iter_mut().enumerate() {
                *out = self.sign as f32 * values[0][i].max(values[1][i]);
            }
        }
        finish(chunk.placement, out);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        points64(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let local = Locals::of(&chunk.points, chunk.placement);
        let tapes = [self.operands[0].tape(), self.operands[1].tape()];
        write_gradients(chunk.placement, &self.chunk(&local, tapes), chunk.out);
    }

    fn takes_short(&self) -> bool {
        true
    }
}

impl EdgeBlend {
    /// Values and gradients of a chunk.
    fn chunk(&self, local: &Locals, tapes: [&Tape; 2]) -> Slopes {
        with_evaluator(|evaluator| {
            let mut sample = |at: &Locals| -> [Slopes; 2] { [0, 1].map(|i| at.gradients(evaluator, tapes[i])) };
            let signed = |slopes: &[Slopes; 2], i: usize| -> [Sample; 2] {
                [0, 1].map(|k| {
                    let (value, gradient) = slopes[k].at(i);
                    (self.signs[k] * value, self.signs[k] * gradient)
                })
            };
            let here = sample(local);
            let mut feet: Vec<(Foot, bool)> = Vec::with_capacity(local.count);
            for i in 0..local.count {
                let near = self.near(signed(&here, i).map(|(value, _)| value));
                feet.push((Foot::new(local.get(i)), near));
            }
            let mut at = Locals { ..*local };
            let mut there: Option<[Slopes; 2]> = None;
            for _ in 0..STEPS {
                let sides = there.as_ref().unwrap_or(&here);
                for (i, (foot, near)) in feet.iter_mut().enumerate() {
                    *near = *near && foot.step(local.get(i), signed(sides, i), self.depth(), self.farthest());
                    at.set(i, foot.q);
                }
                if !feet.iter().any(|(_, near)| *near) {
                    break;
                }
                there = Some(sample(&at));
            }
            let sides = there.as_ref().unwrap_or(&here);
            let mut out = Slopes { value: [0.0; CHUNK], gradient: [[0.0; CHUNK]; 3] };
            for (i, (foot, near)) in feet.iter().enumerate() {
                let [x, y] = signed(&here, i);
                let join = larger(x, y);
                let shaped = if *near { self.shaped(local.get(i), foot, signed(sides, i), join) } else { join };
                out.set(i, (self.sign * shaped.0, self.sign * shaped.1));
            }
            out
        })
    }
}
