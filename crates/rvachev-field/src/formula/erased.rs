//! A formula as a leaf of the engine.

use std::cell::RefCell;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::gradients::STEEPEST;
use super::slope::Slope;
use super::{Formula, bulk, gradients};
use crate::{AnyField, Chunk, Crease, ParamError, VALUE_LIMIT, Zone, chained};
use crate::{Bounds, Dual, Interval};
use rvachev_num::symbol::Symbol;

thread_local! {
    static REGISTERS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// The value of the solid from that of the formula: what is undefined is outside.
pub(super) fn turned(value: f64) -> f64 {
    if value.is_nan() { -VALUE_LIMIT } else { (-value).clamp(-VALUE_LIMIT, VALUE_LIMIT) }
}

/// A derivative of the solid from that of the formula.
fn turned_slope(slope: f64) -> f64 {
    if slope.is_nan() { 0.0 } else { (-slope).clamp(-f64::from(STEEPEST), f64::from(STEEPEST)) }
}

impl AnyField for Formula {
    fn signature(&self) -> String {
        self.text()
    }

    fn name(&self) -> &'static str {
        "formula"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.bounds().transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Formula::check(self)
    }

    fn convex(&self) -> bool {
        false
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.roundoff_within(reach)
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        turned(REGISTERS.with_borrow_mut(|registers| self.0.code.plan().value(p, registers)))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let point = p.map(|c| Slope { v: c.value(), d: c.gradient() });
        let value = self.0.code.plan().value(point, &mut Vec::new());
        if value.v.is_nan() {
            return Dual::constant(-VALUE_LIMIT);
        }
        Dual::new(turned(value.v), value.d.map(turned_slope))
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        self.dual_range_of(p)
    }

    fn creases(&self, region: [Interval; 3]) -> Vec<Crease> {
        self.jumps_in(region).unwrap_or_default()
    }

    fn slopes_beside(&self, p: [Dual<Interval>; 3], beside: DVec3) -> [Interval; 3] {
        // Where it does not tell all jumps there are no sides.
        if self.jumps_in(p.map(Dual::value)).is_none() {
            return self.dual_range_of(p).d;
        }
        chained(Interval::ALL, self.slopes_of_side(p.map(Dual::value), beside), p).d
    }

    fn exact(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.range_over(zone)
    }

    fn of_surface(&self) -> Option<Arc<dyn AnyField>> {
        self.taken_apart().map(|formula| Arc::new(formula) as Arc<dyn AnyField>)
    }

    fn axes(&self) -> [bool; 3] {
        self.0.code.axes
    }

    fn prefetch(&self, zones: &[Zone]) {
        self.survey(zones);
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        self.narrowed_to(zone).map(|formula| Arc::new(formula) as Arc<dyn AnyField>)
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        let [x, y, z] = p.map(Symbol::tree);
        p[0].of_tree(-self.tree().remap_xyz(x, y, z))
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        bulk::single(self, chunk);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        bulk::double(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        gradients::gradients(self, chunk);
    }

    fn cost(&self) -> usize {
        // So many operations are as much as a superquadric.
        1 + self.len() / 8
    }
}
