//! The face of a chamfer as a leaf: positive where it adds material to a union.
//!
//! ```text
//!     min(max(T, x, y), x + l', y + l')     T = 0 the plane across the edge,
//!                                           x and y the operands' values
//! ```
//!
//! The faces of an operand's parts are joined as these are, and so are those of a leaf's walls. Of
//! walls A and B that is (A | b) & (B | b), each with its face. A face holds its own operands, so
//! that of B takes nothing away beside A. Beyond both walls the two faces meet in a mitre.
//!
//! T is told by the operands' values and slopes ([`Chamfer`]). It is negative where an operand is
//! farther away than the leg, which the last two terms say as well, and over whole boxes.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::chamfer::{Chamfer, Parts};
use super::composite::{Locals, Slopes, Whole, finish, points64, roundoff, with_evaluator, write_gradients};
use super::even::{either, ends};
use super::{Program, Tape};
use crate::{Bounds, Dual, Interval, Jet, ParamError, Real};
use rvachev_field::{AnyField, Chunk, VALUE_LIMIT, Way, Zone, bits, chained, mean_value_range};
use rvachev_num::symbol::Symbol;

/// Differences of gradients are taken over this part of the leg, point by point and in lanes.
const TURN: f64 = 1e-4;
const TURN_OF_LANES: f64 = 1e-2;

/// T of planes changes by 1 per length unit, and by less than this where balls roll along both
/// operands that are as large as the leg.
const STEEPEST: f64 = 4.0;

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

    fn samples(&self, p: DVec3) -> [Sample; 2] {
        [0, 1].map(|i| {
            let (value, gradient) = self.operands[i].gradient(p);
            (self.signs[i] * value, self.signs[i] * gradient)
        })
    }

    /// The value of the terms, and which operand's it is, if it is one's.
    fn chosen(&self, height: f64, here: [Sample; 2]) -> (f64, Option<usize>) {
        let values = here.map(|(value, _)| value);
        let (low, high) = if values[0] <= values[1] { (0, 1) } else { (1, 0) };
        let (value, which) = if values[high] > height { (values[high], Some(high)) } else { (height, None) };
        let near = values[low] + self.chamfer.reach();
        if near < value { (near, Some(low)) } else { (value.max(-VALUE_LIMIT), which) }
    }

    /// Value and gradient.
    fn at(&self, p: DVec3) -> Sample {
        let here = self.samples(p);
        let parts = Parts::of(here);
        match (self.chosen(self.chamfer.height(parts.as_ref()), here), parts) {
            ((value, Some(which)), _) => (value, here[which].1),
            ((value, None), None) => (value, DVec3::ZERO),
            ((value, None), Some(parts)) => {
                let by = TURN * self.chamfer.leg;
                let beside = parts.normals.map(|normal| self.samples(p + by * normal));
                let turn = |i: usize, j: usize| (beside[j][i].1 - here[i].1) / by;
                (value, self.chamfer.slope(&parts, [0, 1].map(|i| [turn(i, 0), turn(i, 1)])))
            }
        }
    }

    fn held(&self, height: Interval, values: [Interval; 2]) -> Interval {
        let reach = Interval::point(self.chamfer.reach());
        height.max(values[0]).max(values[1]).min(values[0] + reach).min(values[1] + reach)
    }

    /// What is known of T over a zone, by the operands' values there, and of their slopes and its
    /// own over the hull.
    fn face(&self, zone: &Zone, values: [Interval; 2]) -> Face {
        let here = Jet::point(zone.hull());
        let sides = [0, 1].map(|i| self.operands[i].evaluate(here, &mut Vec::new()) * self.signs[i]);
        let slopes = self.chamfer.slopes(sides.each_ref());
        let coarse = self.chamfer.range(values, sides.map(|side| side.d));
        let parts = Parts::of(self.samples(zone.centre));
        let centre = self.chamfer.height(parts.as_ref());
        let rounding = self.chamfer.rounding(parts.as_ref(), zone.reach() + centre.abs());
        let height = mean_value_range(zone, Interval::around(centre, rounding), slopes, coarse);
        Face { height, slopes, sides }
    }

    /// Values and gradients of a chunk.
    fn chunk(&self, local: &Locals, is_steep: bool) -> Slopes {
        let tapes: [&Tape; 2] = self.operands.each_ref().map(Whole::tape);
        with_evaluator(|evaluator| {
            let mut sample = |at: &Locals| [0, 1].map(|i| at.gradients(evaluator, tapes[i]).times(self.signs[i]));
            let here = sample(local);
            let (mut out, mut faces) = (Slopes::new(local.count()), Vec::with_capacity(local.count()));
            // Beside each point of the face, along the one normal and along the other.
            let by = TURN_OF_LANES * self.chamfer.leg;
            let mut near = Locals::none();
            for i in 0..local.count() {
                let sides = here.each_ref().map(|side| side.at(i));
                let parts = Parts::of(sides);
                let (value, which) = self.chosen(self.chamfer.height(parts.as_ref()), sides);
                out.set(i, (value, which.map_or(DVec3::ZERO, |which| sides[which].1)));
                if let (true, None, Some(parts)) = (is_steep, which, parts) {
                    faces.push((i, parts));
                    parts.normals.into_iter().for_each(|normal| near.push(local.get(i) + by * normal));
                }
            }
            if faces.is_empty() {
                return out;
            }
            let beside = sample(&near);
            for (n, (i, parts)) in faces.into_iter().enumerate() {
                let turn = |k: usize, side: usize| (beside[k].at(2 * n + side).1 - here[k].at(i).1) / by;
                let slope = self.chamfer.slope(&parts, [0, 1].map(|k| [turn(k, 0), turn(k, 1)]));
                out.set(i, (f64::from(out.value[i]), slope));
            }
            out
        })
    }
}

/// What is known over a zone: ranges of T, of its slopes, and of the operands.
struct Face {
    height: Interval,
    slopes: [Interval; 3],
    sides: [Jet; 2],
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
        self.chosen(self.chamfer.height(Parts::of(here).as_ref()), here).0
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = self.at(DVec3::from_array(p.map(Dual::value)));
        let along = |i: usize| (0..3).map(|axis| gradient[axis] * p[axis].gradient()[i]).sum::<f64>();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let zone = Zone::of_sides(p.map(Dual::value));
        let Face { height, slopes, sides } = self.face(&zone, self.ranges(&zone));
        let [x, y] = sides.map(|side| chained(side.v, side.d, p));
        let reach = Dual::constant(Interval::point(self.chamfer.reach()));
        chained(height, slopes, p).max(x).max(y).min(x + reach).min(y + reach)
    }

    fn convex(&self) -> bool {
        false
    }

    fn axes(&self) -> [bool; 3] {
        let of_operands = self.operands.iter().map(|operand| operand.axes());
        of_operands.fold(ends(&self.bounds), either)
    }

    fn range(&self, zone: &Zone) -> Interval {
        let values = self.ranges(zone);
        let far = self.held(Interval::ALL, values);
        if far.hi() < 0.0 {
            return Interval::new(-VALUE_LIMIT, far.hi());
        }
        self.held(self.face(zone, values).height, values)
    }

    /// It rises where the slopes of its face tell so, and those of what is less there: the face
    /// jumps where an operand's normal does.
    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let values = self.ranges(zone);
        let face = self.face(zone, values);
        let most = face.height.max(values[0]).max(values[1]);
        let found = if face.height.hi() < most.lo() { u8::MAX } else { bits(ways, |way| way.is_rise(face.slopes)) };
        let of_operand = |found: u8, i: usize| {
            let is_least = values[i].lo() + self.chamfer.reach() <= most.hi();
            if found == 0 || !is_least && values[i].hi() < most.lo() {
                return found;
            }
            let turned: Vec<Way> = ways.iter().map(|way| way.flip_if(self.signs[i] < 0.0)).collect();
            found & self.operands[i].rises(zone, &turned)
        };
        (0..2).fold(found, of_operand)
    }

    /// Where operands' normals turn steadily: T jumps where they do.
    fn slope_bound(&self) -> Option<f64> {
        self.operands.iter().all(|operand| operand.has_gentle_leaves()).then_some(STEEPEST)
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
        out[..local.count()].copy_from_slice(&self.chunk(&local, false).value);
        finish(chunk.placement, out, local.count());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;

    /// Where a rim lies in a face of an operand slopes have bounds: to either side of the face it is
    /// the same plane.
    #[test]
    fn slopes_at_rims_have_bounds() {
        let post = Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7);
        for plate in [Solid::cuboid([2.0, 2.0, 0.4]), Solid::cylinder(1.0, 0.4)] {
            let operands = [&plate, &post].map(|solid| solid.surface_program().expect("the solid is valid"));
            let bevel = Bevel::new(operands, [1.0; 2], Chamfer { leg: 0.15, steepest: 1.0 }, Bounds::ALL);
            let rim = Bounds::from_center(DVec3::new(0.65, 0.0, 0.2), DVec3::splat(0.02));
            let Dual { d, .. } = bevel.dual_range(Dual::point(Zone::of_bounds(&rim).hull()));
            assert!(d.iter().all(|slope| slope.width() < 1.0), "{d:?}");
        }
    }

    /// The leaf changes by no more than its slopes say, and they are known beside its rims.
    #[test]
    fn slopes_of_faces_hold_all_changes() {
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0;
        let plate = Solid::cuboid([2.0, 2.0, 0.4]);
        let posts = [
            Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7),
            Solid::cylinder(0.5, 2.0).rotate_x(crate::rad(0.4)),
            Solid::torus(0.5, 0.3),
            Solid::cuboid([0.7, 0.5, 1.0]).twist(crate::rad(0.5)),
        ];
        let leg = 0.15;
        for (number, post) in posts.into_iter().enumerate() {
            for signs in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                let operands = [&plate, &post].map(|solid| solid.surface_program().expect("the solid is valid"));
                let bevel = Bevel::new(operands, signs, Chamfer { leg, steepest: 1.0 }, Bounds::ALL);
                let (mut told, mut near) = (0, 0);
                for n in 0..800 {
                    let centre = DVec3::new(0.8, 0.8, 0.5) * vector(40 * n);
                    let half = (0.1 + random(n)) * 0.02;
                    if bevel.samples(centre).iter().any(|(value, _)| value.abs() > leg) {
                        continue;
                    }
                    near += 1;
                    let zone = Zone::of_sides([0, 1, 2].map(|axis| Interval::around(centre[axis], half)));
                    let (range, dual) = (bevel.range(&zone), bevel.dual_range(Dual::point(zone.hull())));
                    told += u32::from(dual.d.iter().all(|slope| slope.width() < 1.0));
                    for pair in 1..8 {
                        let [p, q] = [2 * pair, 2 * pair + 1].map(|m| centre + half * vector(40 * n + m));
                        let [v, w] = [p, q].map(|p| bevel.value(p.to_array()));
                        let slack = 1e-9 * (1.0 + v.abs() + w.abs());
                        for range in [range, dual.v] {
                            assert!(range.lo() - slack <= v && v <= range.hi() + slack, "{number}: {v} {range:?} {p}");
                        }
                        let terms = [0, 1, 2].map(|axis| dual.d[axis].times(Interval::point(q[axis] - p[axis])));
                        let change = terms[0] + terms[1] + terms[2];
                        assert!(
                            change.lo() - slack <= w - v && w - v <= change.hi() + slack,
                            "{number} {signs:?}: {} from {p} to {q}, {change:?}",
                            w - v
                        );
                    }
                }
                assert!(told * 2 > near && near > 30, "{number} {signs:?}: {told} of {near}");
            }
        }
    }
}
