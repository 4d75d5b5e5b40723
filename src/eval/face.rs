//! The face of a chamfer where there is one: only what a ball does not reach that rolls along the
//! operands.
//!
//! ```text
//!     min(bevel, fill)
//! ```
//!
//! The ball is large beside the face, so that half of its surface is as far as the nearest point,
//! and a search takes long. But what is far from the bevel's plane, or far out of the ball's reach,
//! is told without one: the fill is asked for where the bevel is not below all that it may be, and
//! only up to the bevel.

use std::sync::Arc;

use glam::DAffine3;

use super::bevel::Bevel;
use super::composite::{points64, unscaled};
use super::few::Few;
use super::fill::Fill;
use super::signed::Signed;
use crate::{Bounds, Dual, Interval, ParamError, Real};
#[cfg(feature = "formula")]
use rvachev_field::VALUE_LIMIT;
use rvachev_field::{Along, AnyField, Chunk, Segment, Way, Zone, steep_slopes};
#[cfg(feature = "formula")]
use rvachev_num::symbol::Symbol;

#[derive(Clone, Debug)]
pub(super) struct Face {
    bevel: Bevel,
    fill: Arc<Fill>,
}

impl Face {
    /// The fill has no sides, and counts to some depth only.
    pub(super) fn new(bevel: Bevel, fill: Fill) -> Face {
        Face { bevel, fill: Arc::new(fill) }
    }

    /// Values of the fill at those points of a chunk at which the bevel's may be above it: their
    /// places, and whether they are below the bevel's.
    fn below(&self, chunk: &Chunk<'_, f32, 1>) -> Vec<(usize, f64)> {
        let Chunk { points, placement, out: [out] } = chunk;
        let lowest = self.fill.lowest();
        let own = |value: f32| (f64::from(value) - placement.shift) / placement.scale;
        let open = Few::of((0..out.len()).filter(|i| own(out[*i]) > lowest), *points);
        if open.places.is_empty() {
            return Vec::new();
        }
        let fill = Signed { field: self.fill.clone(), sign: 1.0 };
        let values = open.values(&fill, &unscaled(placement), (0.0, -lowest));
        open.places.iter().copied().zip(values).filter(|&(i, value)| value < own(out[i])).collect()
    }
}

impl AnyField for Face {
    fn name(&self) -> &'static str {
        "chamfer"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.bevel.bounds_under(map).intersection(&self.fill.bounds_under(map))
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.bevel.roundoff(reach).max(self.fill.roundoff(reach))
    }

    fn exact(&self) -> bool {
        false
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let bevel = self.bevel.value(p);
        bevel.min(self.fill.value_below(p, bevel))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let bevel = self.bevel.dual(p);
        let is_bevel = self.fill.value_below(p.map(Dual::value), bevel.value()) >= bevel.value();
        if is_bevel { bevel } else { self.fill.dual(p) }
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let bevel = self.bevel.dual_range(p);
        if bevel.value().hi() <= self.fill.lowest() { bevel } else { bevel.min(self.fill.dual_range(p)) }
    }

    fn along(&self, segment: &Segment) -> Along {
        let sides = segment.sides();
        let bevel = self.bevel.along(segment);
        let fill = self.fill.range_below(&Zone::of_sides(sides.map(Dual::value)), bevel.value.hi());
        if fill.lo() >= bevel.value.hi() {
            return bevel;
        }
        let [steep, ..] = steep_slopes(1.0, sides);
        Along { value: bevel.value.min(fill), slope: bevel.slope.hull(steep), ..bevel }
    }

    fn convex(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        let bevel = self.bevel.range(zone);
        if bevel.hi() < 0.0 { bevel } else { bevel.min(self.fill.range_below(zone, bevel.hi())) }
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        match self.bevel.rises(zone, ways) {
            0 => 0,
            found => found & self.fill.rises(zone, ways),
        }
    }

    fn steepest(&self, _zone: &Zone) -> f64 {
        f64::INFINITY
    }

    /// Where the fill is above the bevel there is no need of it.
    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let most = self.bevel.range(zone).hi();
        let bevel = self.bevel.narrowed(zone);
        if self.fill.range_below(zone, most).lo() >= most {
            return Some(bevel.unwrap_or_else(|| Arc::new(self.bevel.clone())));
        }
        None
    }

    fn is_formula(&self) -> bool {
        false
    }

    #[cfg(feature = "formula")]
    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with a chamfer are not lowered.
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        self.bevel.lanes32(Chunk { points, placement, out: [&mut *out] });
        for (i, value) in self.below(&Chunk { points, placement, out: [&mut *out] }) {
            out[i] = placement.finish(value) as f32;
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        points64(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out: [value, dx, dy, dz] } = chunk;
        self.bevel.gradients(Chunk { points, placement, out: [&mut *value, &mut *dx, &mut *dy, &mut *dz] });
        let below = self.below(&Chunk { points, placement, out: [&mut *value] });
        for (i, _) in below {
            let p = placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i])));
            let Dual { v, d } = self.fill.dual(Dual::point(p));
            let [x, y, z] = placement.pull(d.map(|slope| slope * placement.scale));
            value[i] = placement.finish(v) as f32;
            (dx[i], dy[i], dz[i]) = (x as f32, y as f32, z as f32);
        }
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn jumps(&self) -> bool {
        self.bevel.jumps()
    }

    fn cost(&self) -> usize {
        2
    }
}
