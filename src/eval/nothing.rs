//! The solid without a point: what is left of one that is eroded away.

use glam::{DAffine3, DVec3};

use crate::{Bounds, Dual, Interval, ParamError};
use rvachev_field::{AnyField, Chunk, VALUE_LIMIT, Zone};
use rvachev_num::symbol::Symbol;

/// Outside everywhere.
#[derive(Debug)]
pub(super) struct Nothing;

impl AnyField for Nothing {
    fn name(&self) -> &'static str {
        "nothing"
    }

    fn bounds_under(&self, _map: &DAffine3) -> Bounds {
        Bounds::EMPTY
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, _reach: f64) -> f64 {
        0.0
    }

    fn value(&self, _p: [f64; 3]) -> f64 {
        -VALUE_LIMIT
    }

    fn dual(&self, _p: [Dual<f64>; 3]) -> Dual<f64> {
        Dual::new(-VALUE_LIMIT, [0.0; 3])
    }

    fn dual_range(&self, _p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Dual::new(Interval::point(-VALUE_LIMIT), [Interval::point(0.0); 3])
    }

    fn exact(&self) -> bool {
        true
    }

    fn growth(&self) -> DVec3 {
        DVec3::ONE
    }

    fn convex(&self) -> bool {
        true
    }

    fn range(&self, _zone: &Zone) -> Interval {
        Interval::point(-VALUE_LIMIT)
    }

    fn axes(&self) -> [bool; 3] {
        [false; 3]
    }

    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let [out] = chunk.out;
        out.fill(chunk.placement.finish(-VALUE_LIMIT) as f32);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        let [out] = chunk.out;
        out.fill(chunk.placement.finish(-VALUE_LIMIT));
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let [value, slopes @ ..] = chunk.out;
        value.fill(chunk.placement.finish(-VALUE_LIMIT) as f32);
        slopes.into_iter().for_each(|slope| slope.fill(0.0));
    }
}
