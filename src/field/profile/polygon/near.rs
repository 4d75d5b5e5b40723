//! The few edges of a polygon that can be nearest in some region.

use std::sync::Arc;

use glam::DAffine3;

use super::super::super::{AnyField, Chunk, Field, ParamError, Zone};
use super::{Edge, Patch};
use crate::num::symbol::Symbol;
use crate::{Bounds, Dual, Interval, Real};

/// The nearest of a list of edges, as a formula: what lanes run.
#[derive(Clone, Debug)]
struct Nearest {
    edges: Box<[Edge]>,
    reach: f64,
}

impl Field for Nearest {
    fn name(&self) -> &'static str {
        "polygon"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let mut best = x.lift(-super::super::super::VALUE_LIMIT);
        let mut i = 0;
        while i < self.edges.len() {
            let next = self.edges[i].signed(x, y);
            best = if i == 0 { next } else { (best.abs() - next.abs()).select(next, best) };
            i += 1;
        }
        best
    }

    fn bounds(&self) -> Bounds {
        Bounds::ALL
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn exact(&self) -> bool {
        true
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.reach.min(reach)
    }
}

/// A polygon over a region in which no edges but these can be nearest.
#[derive(Debug)]
pub(super) struct NearEdges(Nearest);

impl NearEdges {
    /// The leaf of `edges` if they are few; `reach` is the largest coordinate of the polygon.
    pub(super) fn new(edges: Vec<Edge>, reach: f64) -> NearEdges {
        NearEdges(Nearest { edges: edges.into(), reach })
    }

    fn value_at(&self, patch: &Patch) -> f64 {
        self.0.eval([patch.centre.x, patch.centre.y, 0.0])
    }

    fn over(&self, patch: Option<Patch>) -> Interval {
        match patch {
            Some(patch) => {
                let rounding = 1e-14 * (self.0.reach + patch.centre.abs().max_element() + patch.radius);
                patch.range(self.value_at(&patch), self.0.edges.iter(), rounding)
            }
            None => Interval::ALL,
        }
    }
}

/// Of `edges`, those that can be nearest somewhere in the patch or within `margin` of it.
pub(super) fn nearest_over(patch: &Patch, edges: impl Iterator<Item = Edge>, margin: f64) -> Vec<Edge> {
    let mut bounded: Vec<(f64, Edge)> = Vec::new();
    let mut most = f64::INFINITY;
    for edge in edges {
        let (low, high) = patch.distances(&edge);
        most = most.min(high);
        bounded.push((low, edge));
    }
    bounded.into_iter().filter(|(low, _)| *low <= most + 2.0 * margin).map(|(_, edge)| edge).collect()
}

/// By how much points may lie outside of the zone that they are said to be in: lanes round
/// their coordinates.
pub(super) fn margin(patch: &Patch, reach: f64) -> f64 {
    2e-6 * (patch.centre.abs().max_element() + patch.radius + reach)
}

/// A range and slopes of a function that changes by at most 1 per length unit.
pub(super) fn unit_slopes(value: Interval, [x, y, _]: [Dual<Interval>; 3]) -> Dual<Interval> {
    let slope = Interval::new(-1.0, 1.0);
    let (dx, dy) = (x.gradient(), y.gradient());
    Dual::new(value, std::array::from_fn(|i| slope * dx[i] + slope * dy[i]))
}

impl AnyField for NearEdges {
    fn name(&self) -> &'static str {
        Field::name(&self.0)
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        Field::bounds_under(&self.0, map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Field::check(&self.0)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        Field::roundoff(&self.0, reach)
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.0.value(p)
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.0.dual(p)
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        unit_slopes(self.over(Patch::of_box(p[0].value(), p[1].value())), p)
    }

    fn exact(&self) -> bool {
        true
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.over(Patch::of_zone(zone))
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let patch = Patch::of_zone(zone)?;
        let margin = margin(&patch, self.0.reach);
        let near = nearest_over(&patch, self.0.edges.iter().copied(), margin);
        (near.len() < self.0.edges.len()).then(|| Arc::new(NearEdges::new(near, self.0.reach)) as Arc<dyn AnyField>)
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        self.0.symbol(p)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        self.0.lanes32(chunk);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        self.0.lanes64(chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        self.0.gradients(chunk);
    }
}
