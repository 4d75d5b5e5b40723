//! A program as a leaf: the sign of a measured distance, or a distance that needs no measuring.

use std::cell::RefCell;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DVec3};

use super::list::List;
use super::{Evaluator, Gradients, Program, Tape};
use crate::{Bounds, Dual, Interval, Jet, ParamError};
use rvachev_field::kernel::{CHUNK, distinct, repeat};
use rvachev_field::{AnyField, Chunk, Layer, Placement, Way, Zone, level_layers};
use rvachev_num::symbol::Symbol;

#[derive(Debug)]
struct Composite {
    program: Whole,
    bounds: Bounds,
    /// Whether its value is the true distance on one side, and nowhere steeper.
    is_distance: bool,
}

/// A program as a leaf, which is within the bounds.
pub(crate) fn as_leaf(program: Program, bounds: Bounds) -> Arc<dyn AnyField> {
    Arc::new(Composite { program: Whole::new(program), bounds, is_distance: false })
}

/// The same of one whose value is the true distance on the side that it is asked for.
pub(super) fn as_distance(program: Program, bounds: Bounds) -> Arc<dyn AnyField> {
    Arc::new(Composite { program: Whole::new(program), bounds, is_distance: true })
}

/// A program with its tape over all of space, which is made when lanes first ask for it.
#[derive(Clone)]
pub(super) struct Whole {
    program: Program,
    tape: OnceLock<Tape>,
}

impl Whole {
    pub(super) fn new(program: Program) -> Whole {
        Whole { program, tape: OnceLock::new() }
    }

    pub(super) fn tape(&self) -> &Tape {
        self.tape.get_or_init(|| Tape::new(&self.program, &Bounds::ALL))
    }
}

impl Deref for Whole {
    type Target = Program;

    fn deref(&self) -> &Program {
        &self.program
    }
}

impl std::fmt::Debug for Whole {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.program.fmt(f)
    }
}

impl AnyField for Composite {
    fn name(&self) -> &'static str {
        "blend"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.bounds.transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        roundoff(&self.program, reach)
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.program.value(DVec3::from_array(p))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.program.evaluate(p, &mut Vec::new())
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        self.program.evaluate(p, &mut Vec::new())
    }

    fn jet(&self, p: [Jet; 3]) -> Jet {
        self.program.evaluate(p, &mut Vec::new())
    }

    fn exact(&self) -> bool {
        self.is_distance
    }

    fn growth(&self) -> DVec3 {
        if self.is_distance { DVec3::ONE } else { DVec3::INFINITY }
    }

    fn convex(&self) -> bool {
        false
    }

    fn axes(&self) -> [bool; 3] {
        self.program.axes()
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.program.range_zone(zone)
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        self.program.rises(zone, ways)
    }

    fn enters(&self, zone: &Zone, ways: &[Way], level: f64) -> u8 {
        self.program.enters(zone, ways, level)
    }

    fn layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        let by_leaf = self.program.layers(zone, level);
        by_leaf.or_else(|| self.is_distance.then(|| level_layers(self, zone, level)).flatten())
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        self.program.evaluate(p, &mut Vec::new())
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        self.lanes32_within(chunk, f64::INFINITY);
    }

    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, band: f64) {
        let local = Locals::of(&chunk.points, chunk.placement);
        let [out] = chunk.out;
        // Where values are shifted, others decide.
        let band = if chunk.placement.shift == 0.0 { band / chunk.placement.scale } else { f64::INFINITY };
        with_evaluator(|evaluator| local.values(evaluator, self.program.tape(), band, &mut *out));
        finish(chunk.placement, out, local.count());
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let mut local = [(); 3].map(|()| [0.0; CHUNK]);
        for i in 0..out.len() {
            let p = placement.apply([0, 1, 2].map(|axis| points[axis][i]));
            (local[0][i], local[1][i], local[2][i]) = (p[0], p[1], p[2]);
        }
        let [x, y, z] = local.each_ref().map(|axis| &axis[..out.len()]);
        with_evaluator(|evaluator| evaluator.shortest_values_f64(self.program.tape(), [x, y, z], out));
        out.iter_mut().for_each(|value| *value = placement.finish(*value));
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let local = Locals::of(&chunk.points, chunk.placement);
        let slopes = with_evaluator(|evaluator| local.gradients(evaluator, self.program.tape()));
        write_gradients(chunk.placement, &slopes, chunk.out);
    }

    fn is_formula(&self) -> bool {
        self.program.unlowered().is_none()
    }

    fn is_steady(&self) -> bool {
        self.program.is_steady()
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        if self.program.leaf_count() < 2 {
            return None;
        }
        let program = self.program.reduced(zone);
        let is_simpler = program.leaf_count() < self.program.leaf_count();
        is_simpler.then(|| Arc::new(Composite { program: Whole::new(program), ..*self }) as Arc<dyn AnyField>)
    }

    fn jumps(&self) -> bool {
        self.program.jumps()
    }
}

/// How far lanes of a program may be off within `reach` of the origin.
pub(super) fn roundoff(program: &Program, reach: f64) -> f64 {
    let reach = DVec3::splat(reach);
    Tape::new(program, &Bounds::new(-reach, reach)).roundoff()
}

/// Runs `work` with scratch memory that nobody else on this thread is using.
pub(crate) fn with_evaluator<T>(work: impl FnOnce(&mut Evaluator) -> T) -> T {
    thread_local! {
        static SPARE: RefCell<Vec<Evaluator>> = const { RefCell::new(Vec::new()) };
    }
    let mut evaluator = SPARE.with_borrow_mut(Vec::pop).unwrap_or_default();
    let result = work(&mut evaluator);
    SPARE.with_borrow_mut(|spare| spare.push(evaluator));
    result
}

/// A chunk's points in a leaf's own coordinates, each once.
pub(super) struct Locals {
    at: [List; 3],
}

/// Values and gradients of a chunk.
pub(super) struct Slopes {
    pub(super) value: List,
    pub(super) gradient: [List; 3],
}

impl Slopes {
    /// So many, all 0.
    pub(super) fn new(count: usize) -> Slopes {
        Slopes { value: List::zeroes(count), gradient: [(); 3].map(|()| List::zeroes(count)) }
    }

    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> (f64, DVec3) {
        let [x, y, z] = &self.gradient;
        (f64::from(self.value[i]), DVec3::new(f64::from(x[i]), f64::from(y[i]), f64::from(z[i])))
    }

    /// Those of a multiple.
    pub(super) fn times(mut self, factor: f64) -> Slopes {
        if factor != 1.0 {
            for list in std::iter::once(&mut self.value).chain(&mut self.gradient) {
                list.iter_mut().for_each(|v| *v *= factor as f32);
            }
        }
        self
    }

    pub(super) fn set(&mut self, i: usize, (value, gradient): (f64, DVec3)) {
        self.value[i] = value as f32;
        for (axis, slopes) in self.gradient.iter_mut().enumerate() {
            slopes[i] = gradient[axis] as f32;
        }
    }
}

impl Locals {
    pub(super) fn of(points: &[&[f32]; 3], placement: &Placement) -> Locals {
        let own = distinct(*points);
        let [xs, ys, zs] = points.map(|axis| &axis[..own]);
        let mut locals = Locals::none();
        for ((x, y), z) in xs.iter().zip(ys).zip(zs) {
            let p = placement.apply([f64::from(*x), f64::from(*y), f64::from(*z)]);
            locals.push(DVec3::from_array(p));
        }
        locals
    }

    pub(super) fn none() -> Locals {
        Locals { at: [(); 3].map(|()| List::zeroes(0)) }
    }

    fn coordinates(&self) -> [&[f32]; 3] {
        self.at.each_ref().map(|list| &list[..])
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.at[0].len()
    }

    pub(super) fn get(&self, i: usize) -> DVec3 {
        DVec3::new(f64::from(self.at[0][i]), f64::from(self.at[1][i]), f64::from(self.at[2][i]))
    }

    pub(super) fn push(&mut self, p: DVec3) {
        for (axis, list) in self.at.iter_mut().enumerate() {
            list.push(p[axis] as f32);
        }
    }

    fn values(&self, evaluator: &mut Evaluator, tape: &Tape, band: f64, out: &mut [f32]) {
        let [x, y, z] = self.coordinates();
        evaluator.values_within(tape, band, [x, y, z], out);
    }

    pub(super) fn gradients(&self, evaluator: &mut Evaluator, tape: &Tape) -> Slopes {
        let mut slopes = Slopes::new(self.count());
        let Slopes { value, gradient: [dx, dy, dz] } = &mut slopes;
        let [x, y, z] = self.coordinates();
        evaluator.shortest_gradients(tape, [x, y, z], Gradients { value, dx, dy, dz });
        slopes
    }
}

/// So many values as they count outside of the leaf's frame; the others are like the last.
pub(super) fn finish(placement: &Placement, values: &mut [f32], count: usize) {
    for value in &mut values[..count] {
        *value = placement.finish(f64::from(*value)) as f32;
    }
    repeat(values, count);
}

/// Values and gradients as they count outside of the leaf's frame; those that there are no more of
/// are like the last.
pub(super) fn write_gradients(placement: &Placement, slopes: &Slopes, out: [&mut [f32]; 4]) {
    let [value, dx, dy, dz] = out;
    let count = slopes.value.len();
    for i in 0..count {
        let (v, g) = slopes.at(i);
        let [x, y, z] = placement.pull((g * placement.scale).to_array());
        value[i] = placement.finish(v) as f32;
        (dx[i], dy[i], dz[i]) = (x as f32, y as f32, z as f32);
    }
    [value, dx, dy, dz].into_iter().for_each(|list| repeat(list, count));
}

/// Lanes of `f64`, point by point: they settle a doubtful sign here and there.
pub(super) fn points64(field: &dyn AnyField, chunk: Chunk<'_, f64, 1>) {
    let ([out], own) = (chunk.out, distinct(chunk.points));
    for (i, out) in out[..own].iter_mut().enumerate() {
        let p = chunk.placement.apply([0, 1, 2].map(|axis| chunk.points[axis][i]));
        *out = chunk.placement.finish(field.value(p));
    }
    repeat(out, own);
}

/// The same place, the value as it is.
pub(super) fn unscaled(placement: &Placement) -> Placement {
    let mut unscaled = *placement;
    (unscaled.scale, unscaled.shift) = (1.0, 0.0);
    unscaled
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::Real;
    use rvachev_field::Field;

    /// A ball that counts how often it is asked.
    #[derive(Debug, Default)]
    struct Counted(AtomicU32);

    impl Field for Counted {
        fn name(&self) -> &'static str {
            "ball"
        }

        fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
            self.0.fetch_add(1, Ordering::Relaxed);
            x.lift(1.0) - (x * x + y * y + z * z).sqrt()
        }

        fn bounds(&self) -> Bounds {
            Bounds::new(DVec3::splat(-1.0), DVec3::splat(1.0))
        }

        fn check(&self) -> Result<(), ParamError> {
            Ok(())
        }
    }

    /// What a chunk is filled up with is not asked for point by point.
    #[test]
    fn copies_of_the_last_point_have_its_value() {
        let (field, mut out) = (Counted::default(), [0.0; 32]);
        let mut axis = [0.5; 32];
        axis[..3].copy_from_slice(&[0.5, 0.5, 0.25]);
        axis[3..].fill(0.125);
        let points = [&axis[..]; 3];
        points64(&field, Chunk { points, placement: &Placement::IDENTITY, out: [&mut out] });
        assert_eq!(field.0.into_inner(), 4);
        for (x, value) in axis.iter().zip(out) {
            assert!((value - (1.0 - 3.0_f64.sqrt() * x)).abs() < 1e-12, "{value} at {x}");
        }
        assert_eq!(Locals::of(&[&[1.0, 1.0, 2.0, 2.0]; 3], &Placement::IDENTITY).count(), 3);
    }
}
