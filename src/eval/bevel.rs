//! The face of a chamfer as a leaf: positive where it adds material to a union.
//!
//! ```text
//!     min(T, x + l', y + l')      T = 0 the plane across the edge, x and y the operands' values
//! ```
//!
//! T is told by the operands' values and slopes ([`Chamfer`]). It is negative where an operand is
//! farther away than the leg, which the other two terms say as well, and over whole boxes.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::chamfer::Chamfer;
use super::composite::{Locals, Slopes, Whole, finish, points64, roundoff, with_evaluator, write_gradients};
use super::{Program, Tape};
use crate::{Bounds, Dual, Interval, ParamError, Real};
use rvachev_field::{AnyField, Chunk, VALUE_LIMIT, Way, Zone, bits};
use rvachev_num::symbol::Symbol;

/// Differences of gradients are taken over this part of the leg, point by point and in lanes.
const TURN: f64 = 1e-4;
const TURN_OF_LANES: f64 = 1e-2;

/// A value and its gradient.
pub(super) type Sample = (f64, DVec3);

/// The face between two operands that are given as programs.
#[derive(Clone, Debug)]
pub(super) struct Bevel {
    operands: [Whole; 2],
    /// −1 for an operand whose complement is joined.
    signs: [f64; 2],
    chamfer: Chamfer,
    bounds: Bounds,
}

impl Bevel {
    pub(super) fn new(operands: [Program; 2], signs: [f64; 2], chamfer: Chamfer, bounds: Bounds) -> Bevel {
        Bevel { operands: operands.map(Whole::new), signs, chamfer, bounds }
    }

    fn leaves(&self) -> usize {
        self.operands.iter().map(|operand| operand.leaf_count()).sum()
    }

    fn ranges(&self, zone: &Zone) -> [Interval; 2] {
        [0, 1].map(|i| self.operands[i].range_zone(zone) * Interval::point(self.signs[i]))
    }

    /// The operands' values over a box, with their slopes along the variables of `p`.
    fn duals(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 2] {
        [0, 1].map(|i| self.operands[i].evaluate(p, &mut Vec::new()) * self.signs[i])
    }

    fn samples(&self, p: DVec3) -> [Sample; 2] {
        [0, 1].map(|i| {
            let (value, gradient) = self.operands[i].gradient(p);
            (self.signs[i] * value, self.signs[i] * gradient)
        })
    }

    /// The least of the terms, and which operand's it is, if it is one's.
    fn least(&self, height: f64, here: [Sample; 2]) -> (f64, Option<usize>) {
        let near = here.map(|(value, _)| value + self.chamfer.reach());
        let which = if near[0] <= near[1] { 0 } else { 1 };
        if near[which] < height { (near[which], Some(which)) } else { (height.max(-VALUE_LIMIT), None) }
    }

    /// Value and gradient.
    fn at(&self, p: DVec3) -> Sample {
        let here = self.samples(p);
        match self.least(self.chamfer.height(here), here) {
            (value, Some(which)) => (value, here[which].1),
            (value, None) => {
                let by = TURN * self.chamfer.leg;
                let beside = self.chamfer.normals(here).map(|normal| self.samples(p + by * normal));
                let turn = |i: usize, j: usize| (beside[j][i].1 - here[i].1) / by;
                (value, self.chamfer.slope(here, [0, 1].map(|i| [turn(i, 0), turn(i, 1)])))
            }
        }
    }

    fn held(&self, height: Interval, values: [Interval; 2]) -> Interval {
        let reach = Interval::point(self.chamfer.reach());
        height.min(values[0] + reach).min(values[1] + reach)
    }

    /// Values and gradients of a chunk.
    fn chunk(&self, local: &Locals, is_steep: bool) -> Slopes {
        let tapes: [&Tape; 2] = self.operands.each_ref().map(Whole::tape);
        with_evaluator(|evaluator| {
            let mut sample = |at: &Locals| [0, 1].map(|i| at.gradients(evaluator, tapes[i]).times(self.signs[i]));
            let here = sample(local);
            let (mut out, mut faces) = (Slopes::default(), Vec::new());
            for i in 0..local.count {
                let sides = here.each_ref().map(|side| side.at(i));
                let (value, which) = self.least(self.chamfer.height(sides), sides);
                out.set(i, (value, which.map_or(DVec3::ZERO, |which| sides[which].1)));
                faces.extend(which.is_none().then_some(i));
            }
            if faces.is_empty() || !is_steep {
                return out;
            }
            let by = TURN_OF_LANES * self.chamfer.leg;
            let beside = [0, 1].map(|side| {
                let mut at = Locals { ..*local };
                for &i in &faces {
                    let normal = self.chamfer.normals(here.each_ref().map(|side| side.at(i)))[side];
                    at.set(i, local.get(i) + by * normal);
                }
                sample(&at)
            });
            for i in faces {
                let sides = here.each_ref().map(|side| side.at(i));
                let turn = |k: usize, side: usize| (beside[side][k].at(i).1 - sides[k].1) / by;
                let slope = self.chamfer.slope(sides, [0, 1].map(|k| [turn(k, 0), turn(k, 1)]));
                out.set(i, (f64::from(out.value[i]), slope));
            }
            out
        })
    }
}

impl AnyField for Bevel {
    fn name(&self) -> &'static str {
        "chamfer"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.bounds.transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4.0 * (roundoff(&self.operands[0], reach) + roundoff(&self.operands[1], reach)) + 1e-6 * reach
    }

    fn exact(&self) -> bool {
        false
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let here = self.samples(DVec3::from_array(p));
        self.least(self.chamfer.height(here), here).0
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = self.at(DVec3::from_array(p.map(Dual::value)));
        let along = |i: usize| (0..3).map(|axis| gradient[axis] * p[axis].gradient()[i]).sum::<f64>();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let here = self.duals(Dual::point(p.map(Dual::value)));
        let (values, gradients) = (here.map(Dual::value), here.map(Dual::gradient));
        // Along the variables of p.
        let sides = here.map(|Dual { v, d }| {
            let along = |i: usize| d[0] * p[0].d[i] + d[1] * p[1].d[i] + d[2] * p[2].d[i];
            Dual::new(v, [along(0), along(1), along(2)])
        });
        match self.chamfer.plane(sides, gradients) {
            Some(plane) => {
                let reach = Dual::constant(Interval::point(self.chamfer.reach()));
                plane.min(sides[0] + reach).min(sides[1] + reach)
            }
            // How the operands bend is not known.
            None => Dual::new(self.held(self.chamfer.range(values, gradients), values), [Interval::ALL; 3]),
        }
    }

    fn convex(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        let values = self.ranges(zone);
        let far = self.held(Interval::ALL, values);
        if far.hi() < 0.0 {
            return Interval::new(-VALUE_LIMIT, far.hi());
        }
        let gradients = self.duals(Dual::point(zone.hull())).map(Dual::gradient);
        self.held(self.chamfer.range(values, gradients), values)
    }

    /// What a plane takes turns round nowhere but where the operands do, in zones that are small
    /// beside it.
    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        if self.chamfer.leg <= 2.0 * zone.radius() {
            return bits(ways, |_| false);
        }
        let turned = |i: usize| -> Vec<Way> { ways.iter().map(|way| way.flip_if(self.signs[i] < 0.0)).collect() };
        self.operands[0].rises(zone, &turned(0)) & self.operands[1].rises(zone, &turned(1))
    }

    fn steepest(&self, _zone: &Zone) -> f64 {
        f64::INFINITY
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let leaves = self.leaves();
        if leaves <= 2 {
            return None;
        }
        // Operands are asked for beside a point as well.
        let near = zone.inflated(2.0 * TURN_OF_LANES * self.chamfer.leg);
        let operands = self.operands.each_ref().map(|operand| Whole::new(operand.reduced(&near)));
        let simpler = Bevel { operands, ..self.clone() };
        (simpler.leaves() < leaves).then(|| Arc::new(simpler) as Arc<dyn AnyField>)
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with a chamfer are not lowered.
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let [out] = chunk.out;
        let local = Locals::of(&chunk.points, chunk.placement);
        out.copy_from_slice(&self.chunk(&local, false).value[..out.len()]);
        finish(chunk.placement, out);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        points64(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let local = Locals::of(&chunk.points, chunk.placement);
        write_gradients(chunk.placement, &self.chunk(&local, true), chunk.out);
    }

    fn is_steady(&self) -> bool {
        self.operands.iter().all(|operand| operand.is_steady())
    }

    fn cost(&self) -> usize {
        4
    }

    fn jumps(&self) -> bool {
        self.operands.iter().any(|operand| operand.jumps())
    }
}
