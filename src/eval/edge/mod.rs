//! Fillets and chamfers: blends along the edge where two operands meet.
//!
//! For a union, with the operands' values x and y positive inside (true distances for a fillet):
//!
//! ```text
//!     fillet    a ball of radius r rolls outside along both operands; where it is between them
//!               its surface takes the place of max(x, y)
//!     chamfer   max(x, y, T), where T = 0 is a plane that meets both surfaces at a leg from the edge
//! ```
//!
//! The other operations are those of complements (De Morgan). Both forms exceed max(x, y).
//!
//! A fillet is exact where the ball fits and touches each operand once. Operands that are joins are
//! taken [part by part](sides). It needs parts that are smooth within a radius of the edge; where they
//! have edges of their own it goes round them in a mitre.
//!
//! Source: J. R. Rossignac and A. A. G. Requicha, *Constant-radius blending in solid
//! modelling* (1984), for the rolling ball.

mod chamfer;
mod fillet;
mod lanes;
mod pair;
mod rise;
mod sides;

use glam::{DAffine3, DVec3};

use self::chamfer::{Chamfer, length};
use self::fillet::{FADES, Fillet, STEEPEST};
use self::sides::{Side, join, sides};
use super::Program;
use super::composite::{Locals, Whole, finish, points64, roundoff, with_evaluator, write_gradients};
use crate::solid::Operation;
use crate::{Blend, Bounds, Dual, Interval, ParamError, Real};
use rvachev_field::kernel::CHUNK;
use rvachev_field::{AnyField, Chunk, Way, Zone, steep_slopes};
#[cfg(feature = "formula")]
use rvachev_num::symbol::Symbol;

/// The blend of two operands that are given as programs.
#[derive(Clone, Debug)]
pub(crate) struct EdgeBlend {
    operands: [Whole; 2],
    /// −1 for an operand whose complement is joined.
    signs: [f64; 2],
    /// −1 for the complement of a union of complements.
    sign: f64,
    shape: Shape,
    /// What is told of all its leaves, and how many are evaluated: blends may be nested deeply.
    is_steady: bool,
    jumps: bool,
    leaves: usize,
}

#[derive(Clone, Debug)]
enum Shape {
    Fillet(Fillet, Box<[Side; 2]>),
    Chamfer(Chamfer),
}

impl Shape {
    fn filleted(fillet: Fillet, operands: [&Program; 2], signs: [f64; 2]) -> Shape {
        Shape::Fillet(fillet, Box::new(sides(operands, signs)))
    }
}

/// Differences of gradients are taken over this part of the leg, point by point and in lanes.
const TURN: f64 = 1e-4;
const TURN_OF_LANES: f64 = 1e-2;

/// A value and its gradient.
type Sample = (f64, DVec3);

impl EdgeBlend {
    /// The blend of two operands whose slopes are at most `steepest`.
    pub(super) fn new(operation: Operation, blend: Blend, operands: [Program; 2], steepest: [f64; 2]) -> EdgeBlend {
        let (sign, signs) = match operation {
            Operation::Union => (1.0, [1.0, 1.0]),
            Operation::Difference => (-1.0, [-1.0, 1.0]),
            Operation::Intersection | Operation::SymmetricDifference => (-1.0, [-1.0, -1.0]),
        };
        let shape = match blend {
            Blend::Chamfer { leg } => Shape::Chamfer(Chamfer { leg, steepest: steepest[0].max(steepest[1]) }),
            Blend::Fillet { radius } => Shape::filleted(Fillet { radius }, operands.each_ref(), signs),
            _ => Shape::filleted(Fillet { radius: 0.0 }, operands.each_ref(), signs),
        };
        EdgeBlend::of(operands, signs, sign, shape)
    }

    fn of(operands: [Program; 2], signs: [f64; 2], sign: f64, shape: Shape) -> EdgeBlend {
        let is_steady = operands.iter().all(Program::is_steady);
        let jumps = operands.iter().any(Program::jumps);
        let leaves = operands.iter().map(Program::evaluated_leaves).sum();
        EdgeBlend { operands: operands.map(Whole::new), signs, sign, shape, is_steady, jumps, leaves }
    }

    /// How many leaves the operands evaluate.
    pub(super) fn leaves(&self) -> usize {
        self.leaves
    }

    /// The radius or leg.
    pub(super) fn size(&self) -> f64 {
        match &self.shape {
            Shape::Fillet(fillet, _) => fillet.radius,
            Shape::Chamfer(chamfer) => chamfer.leg,
        }
    }

    /// Where an operand's value is below the negative of this, the blend is the join.
    fn reach(&self) -> f64 {
        match &self.shape {
            Shape::Fillet(fillet, _) => fillet.reach(),
            Shape::Chamfer(chamfer) => chamfer.reach(),
        }
    }

    /// Whether the blend may be more than the join where the operands have these values.
    fn near(&self, [x, y]: [f64; 2]) -> bool {
        match &self.shape {
            Shape::Fillet(fillet, _) => fillet.near([x, y]),
            Shape::Chamfer(chamfer) => x.min(y) >= -chamfer.reach(),
        }
    }

    /// The blend's range over a zone, and whether the blend, moved by `shift`, may have another
    /// sign there than the join.
    pub(super) fn survey(&self, zone: &Zone, shift: f64) -> (Interval, bool) {
        let (values, shift) = (self.ranges(zone), shift.abs());
        let join = values[0].max(values[1]);
        let near = |by: f64| values.iter().all(|value| value.hi() >= -(self.reach() + by));
        let (range, reaches) = match &self.shape {
            _ if !near(shift) => (join, false),
            Shape::Fillet(fillet, sides) => {
                (if near(0.0) { self.fillet_range(*fillet, sides, join, zone).0 } else { join }, true)
            }
            Shape::Chamfer(chamfer) => {
                let height = chamfer.range(values, self.gradients(zone));
                (if near(0.0) { self.chamfered_range(values, height) } else { join }, height.hi() >= -shift)
            }
        };
        (range * Interval::point(self.sign), reaches)
    }

    /// The operands' gradients over a zone.
    fn gradients(&self, zone: &Zone) -> [[Interval; 3]; 2] {
        self.duals(Dual::point(zone.hull())).map(Dual::gradient)
    }

    fn ranges(&self, zone: &Zone) -> [Interval; 2] {
        [0, 1].map(|i| self.operands[i].range_zone(zone) * Interval::point(self.signs[i]))
    }

    /// The operands' values over a box, with their slopes along the variables of `p`.
    fn duals(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 2] {
        [0, 1].map(|i| self.operands[i].evaluate(p, &mut Vec::new()) * self.signs[i])
    }

    /// The same blend over a zone, from simpler operands.
    pub(super) fn reduced(&self, zone: &Zone) -> Option<EdgeBlend> {
        if self.leaves <= 2 {
            return None;
        }
        // Operands are asked for at most this far from the point.
        let near = zone.inflated(match &self.shape {
            Shape::Fillet(fillet, _) => fillet.farthest(),
            Shape::Chamfer(chamfer) => 2.0 * TURN_OF_LANES * chamfer.leg,
        });
        let operands = [0, 1].map(|i| self.operands[i].reduced(&near));
        let simpler = operands.iter().map(Program::evaluated_leaves).sum::<usize>() < self.leaves;
        simpler.then(|| {
            let shape = match &self.shape {
                Shape::Fillet(fillet, sides) => {
                    let reduced = [0, 1].map(|i| sides[i].reduced(&operands[i], self.signs[i]));
                    Shape::Fillet(*fillet, Box::new(reduced))
                }
                Shape::Chamfer(chamfer) => Shape::Chamfer(*chamfer),
            };
            EdgeBlend::of(operands, self.signs, self.sign, shape)
        })
    }

    fn sample(&self, i: usize, p: DVec3) -> Sample {
        let (value, gradient) = self.operands[i].gradient(p);
        (self.signs[i] * value, self.signs[i] * gradient)
    }

    fn samples(&self, p: DVec3) -> [Sample; 2] {
        [self.sample(0, p), self.sample(1, p)]
    }

    /// Value and gradient of the blend, as a union.
    fn at(&self, p: DVec3) -> Sample {
        match &self.shape {
            Shape::Fillet(fillet, sides) => self.filleted(*fillet, sides, p).0,
            Shape::Chamfer(chamfer) => self.chamfered(*chamfer, p),
        }
    }

    fn chamfered(&self, chamfer: Chamfer, p: DVec3) -> Sample {
        let here = self.samples(p);
        let join = larger(here[0], here[1]);
        let height = chamfer.height(here);
        if !(self.near(here.map(|(value, _)| value)) && height > join.0) {
            return join;
        }
        let by = TURN * chamfer.leg;
        let beside = chamfer.normals(here).map(|normal| self.samples(p + by * normal));
        let turn = |i: usize, j: usize| (beside[j][i].1 - here[i].1) / by;
        (height, chamfer.slope(here, [0, 1].map(|i| [turn(i, 0), turn(i, 1)])))
    }

    /// The blend, and how far around it tells anything: nowhere if the search for a foot has failed, as it
    /// does on an operand's medial axis and beside its own edges.
    fn filleted(&self, fillet: Fillet, sides: &[Side; 2], p: DVec3) -> (Sample, f64) {
        let here = self.samples(p);
        if !self.near(here.map(|(value, _)| value)) {
            return (larger(here[0], here[1]), f64::INFINITY);
        }
        let parts = [0, 1].map(|i| sides[i].samples(here[i], p));
        let mut told = f64::INFINITY;
        let blend = join(sides, |i, j| {
            let pair = [&sides[0].parts[i], &sides[1].parts[j]];
            let (blend, tells) = fillet.between(pair, [parts[0][i], parts[1][j]], p);
            told = told.min(tells);
            blend
        });
        // Well inside, parts tell less than the operands do.
        (larger(blend, larger(here[0], here[1])), told)
    }

    /// The range of a fillet, as a union, and the steepest slope in it where that is known.
    fn fillet_range(&self, fillet: Fillet, sides: &[Side; 2], join: Interval, zone: &Zone) -> (Interval, f64) {
        // The blend is at least the join, whatever became of its steps. Where they arrive it is a distance, of
        // slope 1; else no more than the longest way to a foot.
        let ((centre, _), told) = self.filleted(fillet, sides, zone.centre);
        let extent = zone.extent().length();
        let (steepest, reach) = if told > 0.0 {
            // Of operands that are not steady no foot tells of those of points more than a radius away: there may be
            // edges between.
            let most = if self.is_steady && !self.jumps { f64::INFINITY } else { fillet.radius };
            (STEEPEST, most.min(told))
        } else {
            // Where a gradient may vanish, as on the axis of a disc, the blend jumps; those of distances that
            // are searched for are not known, and do not vanish.
            let turns = || self.gradients(zone).iter().any(|slope| length(*slope).lo() < 0.1);
            (FADES, if self.is_steady && turns() { 0.0 } else { 0.02 * fillet.radius })
        };
        if extent >= reach {
            return (Interval::new(join.lo(), join.hi().max(fillet.farthest())), f64::INFINITY);
        }
        let radius = steepest * extent;
        // The blend falls back to the join where that is r, and where no foot is found between operands that are
        // closer to each other than the ball is wide.
        let close = extent < 0.25 * fillet.radius;
        let lo = if close { join.lo().max((centre - radius).min(fillet.radius)) } else { join.lo() };
        let hi = if centre + radius < 0.0 { centre + radius } else { join.hi().max(fillet.farthest()) };
        (Interval::new(lo, hi.max(lo)), steepest)
    }

    /// The blend, as a union, where the operands have these values and T is `height`.
    fn chamfered_range(&self, values: [Interval; 2], height: Interval) -> Interval {
        let join = values[0].max(values[1]);
        let lo = if self.within(values) { join.lo().max(height.lo()) } else { join.lo() };
        Interval::new(lo, join.hi().max(height.hi()))
    }

    /// Whether operands with these values are within reach everywhere.
    fn within(&self, values: [Interval; 2]) -> bool {
        values.iter().all(|value| value.lo() >= -self.reach())
    }
}

/// The one with the larger value.
fn larger(a: Sample, b: Sample) -> Sample {
    if a.0 >= b.0 { a } else { b }
}

impl AnyField for EdgeBlend {
    fn name(&self) -> &'static str {
        match self.shape {
            Shape::Fillet(..) => "fillet",
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
        let join = here[0].max(here[1]);
        self.sign
            * match &self.shape {
                _ if !self.near(here) => join,
                Shape::Fillet(..) => self.at(p).0,
                Shape::Chamfer(chamfer) => join.max(chamfer.height(self.samples(p))),
            }
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = self.at(DVec3::from_array(p.map(Dual::value)));
        let along = |i: usize| (0..3).map(|axis| gradient[axis] * p[axis].gradient()[i]).sum::<f64>() * self.sign;
        Dual::new(self.sign * value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let hull = p.map(Dual::value);
        let here = self.duals(Dual::point(hull));
        let (values, gradients) = (here.map(Dual::value), here.map(Dual::gradient));
        // Along the variables of p.
        let sides = here.map(|Dual { v, d }| {
            let along = |i: usize| d[0] * p[0].d[i] + d[1] * p[1].d[i] + d[2] * p[2].d[i];
            Dual::new(v, [along(0), along(1), along(2)])
        });
        let join = sides[0].max(sides[1]);
        let blend = match &self.shape {
            _ if values.iter().any(|value| value.hi() < -self.reach()) => join,
            Shape::Fillet(fillet, sides) => {
                let (range, steepest) = self.fillet_range(*fillet, sides, join.value(), &Zone::of_sides(hull));
                Dual::new(range, if steepest.is_finite() { steep_slopes(steepest, p) } else { [Interval::ALL; 3] })
            }
            Shape::Chamfer(chamfer) => {
                let height = chamfer.range(values, gradients);
                match chamfer.plane(sides, gradients) {
                    _ if height.hi() <= join.value().lo() => join,
                    Some(plane) if self.within(values) => join.max(plane),
                    // How the operands bend is not known.
                    _ => Dual::new(self.chamfered_range(values, height), [Interval::ALL; 3]),
                }
            }
        };
        blend * self.sign
    }

    fn convex(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.survey(zone, 0.0).0
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        self.rising(zone, ways)
    }

    fn steepest(&self, zone: &Zone) -> f64 {
        self.steepest_in(zone)
    }

    #[cfg(feature = "formula")]
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
            out.copy_from_slice(&self.chunk(&local, tapes, false).value[..out.len()]);
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
        write_gradients(chunk.placement, &self.chunk(&local, tapes, true), chunk.out);
    }

    fn is_steady(&self) -> bool {
        self.is_steady
    }

    fn jumps(&self) -> bool {
        self.jumps
    }

    fn takes_short(&self) -> bool {
        true
    }
}
