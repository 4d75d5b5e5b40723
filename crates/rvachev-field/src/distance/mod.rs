//! The distance to a leaf's surface, for leaves whose value is not the distance.
//!
//! ```text
//!     d(x) = sign f(x) · |x − y|,   y the surface point nearest to x,  f(y) = 0,  x − y ∥ ∇f(y)
//! ```
//!
//! y is searched by steps, each of which evaluates the leaf's value and gradient once.
//!
//! * Of a convex leaf, inside: from up to three tangent planes known beforehand, each of
//!   another side of the body, y slides along its tangent plane to below x, by the secant
//!   curvature. For a concave field every tangent plane holds the body, so the least height
//!   of x below those met is the distance, from above.
//! * Outside of it, y is the point nearest to x of the half-spaces below the last three
//!   tangent planes and one that stands for those before: a bundle method, which converges at
//!   rounded and sharp edges alike. Its distance is one from below.
//! * Of any other leaf, and behind deformations, surface points are found beforehand on a net
//!   of cells; y slides on from the one that is nearest to the cell of x, and what is found
//!   is neither less than the distance nor more than that to the point it came from.
//!
//! The sign is the leaf's own. Convex leaves behind affine maps are measured to some tenths
//! of a per cent of the distance for lengths up to a tenth of the smallest half-size (to 4 %
//! where knife edges of exponents above 1 meet, and below edges rounded more sharply than
//! the length); behind deformations to some per cent more where the deformation curves the
//! surface within the length.
//!
//! Sources: Y. Haugazeau, *Sur les inéquations variationnelles et la minimisation de
//! fonctionnelles convexes* (1968), for the cuts; J. Barzilai and J. M. Borwein, *Two-point
//! step size gradient methods* (1988).

mod chain;
mod feet;
mod follow;
mod lanes;
mod sample;
mod solve;
mod step;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use self::chain::Chain;
use self::feet::Feet;
use self::follow::SURE;
use self::step::Plane;
use super::{AnyField, AnyWarp, Chunk, ParamError, VALUE_LIMIT, Way, Zone, smallest_stretch, steep_slopes};
use crate::kernel::CHUNK;
use crate::{Bounds, Dual, Interval};
#[cfg(feature = "formula")]
use rvachev_num::symbol::Symbol;

/// By how much of itself what is found at a convex leaf may exceed the true distance, and by
/// how much two values at one distance may differ.
const LOOSE: f64 = 0.05;
const LOOSE_BELOW: f64 = 0.01;

/// How far behind a surface point found beside a leaf that is not convex the sign must have
/// changed, as a part of the length asked for.
const SLACK: f64 = 1e-3;

/// What is known of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// Convex, in the frame of the points.
    Convex,
    /// Anything.
    Free,
}

/// A leaf's distance, in the lengths of the frame before a chain of maps.
#[derive(Debug)]
pub struct Distance {
    chain: Chain,
    shape: Shape,
    /// Tangent planes to start from, of a convex leaf.
    planes: Vec<(Plane, [f64; 3])>,
    /// Surface points to start from, of any other that is bounded.
    feet: Option<Feet>,
    /// The length that is asked for: what counts is which side of it the distance is on.
    asked: f64,
    /// `|d| ≥ |f|` times this.
    least: f64,
    /// The leaf's box.
    bounds: Bounds,
}

impl Distance {
    /// The distance to `leaf` as it looks through `chain` (for each deformation the affine
    /// map before it) and `to_leaf`; `asked` is the length that is asked for.
    pub fn new(
        chain: Vec<(DAffine3, Arc<dyn AnyWarp>)>,
        to_leaf: DAffine3,
        leaf: Arc<dyn AnyField>,
        asked: f64,
    ) -> Distance {
        let shape = if leaf.convex() && chain.is_empty() { Shape::Convex } else { Shape::Free };
        let planes = if shape == Shape::Free { Vec::new() } else { sample::planes(&*leaf, &to_leaf) };
        let stretch = 1.0 / smallest_stretch(&to_leaf.matrix3.inverse());
        let least = if shape == Shape::Convex && stretch.is_normal() { 1.0 / stretch } else { 0.0 };
        let planes = planes.into_iter().map(|plane: Plane| (plane, [plane[0], plane[1], plane[2]])).collect();
        let chain = Chain { maps: chain, to_leaf, leaf };
        let asked = asked.abs();
        let mut distance = Distance { chain, shape, planes, feet: None, asked, least, bounds: Bounds::ALL };
        distance.bounds = distance.bounds_under(&DAffine3::IDENTITY);
        if shape == Shape::Free {
            let reach = distance.bounds.max.abs().max(distance.bounds.min.abs()).max_element();
            let slack = distance.roundoff(reach) + SLACK * asked;
            distance.feet = Feet::new(&distance.chain, &distance.bounds, slack);
        }
        distance
    }

    /// Distance at a point, and its gradient.
    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let value = self.chain.value(p.to_array());
        let (height, normal) = self.search(p, value);
        (self.settled(p, value, height), -normal)
    }

    /// How far a box is from the leaf's, at least.
    fn gap(&self, low: DVec3, high: DVec3) -> f64 {
        (self.bounds.min - high).max(low - self.bounds.max).max(DVec3::ZERO).length()
    }

    /// The distance at p, from a value of the leaf and what the search for the surface found:
    /// never of another sign than the value, never below the bound that the slope gives, nor
    /// nearer than the leaf's box.
    fn settled(&self, p: DVec3, value: f64, height: f64) -> f64 {
        let least = value.abs() * self.least;
        let signed = if value < 0.0 { -height } else { height };
        let found = if signed.is_nan() || signed.is_infinite() { value.abs() } else { signed.max(0.0).max(least) };
        let size = found.min(VALUE_LIMIT);
        if value > 0.0 {
            size.max(f64::MIN_POSITIVE)
        } else if value < 0.0 {
            -size.max(self.gap(p, p)).max(f64::MIN_POSITIVE)
        } else {
            -self.gap(p, p)
        }
    }
}

impl AnyField for Distance {
    fn name(&self) -> &'static str {
        self.chain.leaf.name()
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        // Backwards: the leaf's box in the frame of the last deformation, and its images.
        let inverse = self.chain.to_leaf.inverse();
        let mut maps = self.chain.maps.iter().rev();
        let Some((first, warp)) = maps.next() else {
            return self.chain.leaf.bounds_under(&(*map * inverse));
        };
        let mut bounds = warp.bounds(&self.chain.leaf.bounds_under(&inverse));
        let mut before = first.inverse();
        for (map, warp) in maps {
            bounds = warp.bounds(&bounds.transformed(&before));
            before = map.inverse();
        }
        bounds.transformed(&(*map * before))
    }

    fn check(&self) -> Result<(), ParamError> {
        self.chain.leaf.check()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // Errors of the leaf, and of its coordinates, in lengths before the chain.
        let mut zone = Zone::of_bounds(&Bounds::new(DVec3::splat(-reach), DVec3::splat(reach)));
        let mut error = 3e-7 * reach;
        for (map, warp) in &self.chain.maps {
            zone = zone.mapped(map);
            error += warp.roundoff_over(zone.hull()) / self.stretch_of(map);
            zone = zone.warped(&**warp);
        }
        let own = self.chain.leaf.roundoff(zone.mapped(&self.chain.to_leaf).reach());
        // The slope of a leaf is about 1 in its own frame, so errors of its value are lengths
        // there; gauges of slender shapes are flatter.
        let total = error + 4.0 * own / smallest_stretch(&self.chain.to_leaf.matrix3);
        if total.is_nan() { f64::INFINITY } else { total }
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.at(DVec3::from_array(p)).0
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = self.at(DVec3::from_array(p.map(Dual::value)));
        let along = |axis: usize| (0..3).map(|i| gradient[i] * p[i].d[axis]).sum();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let sides = p.map(Dual::value);
        let (low, high) = (sides.map(Interval::lo), sides.map(Interval::hi));
        let zone = Zone::of_bounds(&Bounds::new(DVec3::from_array(low), DVec3::from_array(high)));
        Dual::new(self.range(&zone), steep_slopes(1.0, p))
    }

    fn exact(&self) -> bool {
        true
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn jumps(&self) -> bool {
        !self.chain.maps.is_empty()
    }

    fn growth(&self) -> DVec3 {
        // By a length as much, and by what the search may miss of it.
        DVec3::splat(1.05)
    }

    fn convex(&self) -> bool {
        // Its true value is; what is found of it is only nearly so.
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        match self.shape {
            Shape::Convex => self.supported_range(zone),
            Shape::Free => self.followed_range(zone),
        }
    }

    /// Where the leaf rises about a zone, as far as its surface is, so does the distance to that.
    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let far = self.range(zone).magnitude();
        if !(self.chain.maps.is_empty() && far.is_finite()) {
            return 0;
        }
        let map = &self.chain.to_leaf;
        let ways: Vec<Way> = ways.iter().map(|way| way.mapped(&map.matrix3)).collect();
        self.chain.leaf.rises(&zone.inflated(far).mapped(map), &ways)
    }

    /// To first order: the leaf's value by the length of its gradient. The search does not
    #[cfg(feature = "formula")]
    /// fit an expression tree.
    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        Symbol::over_slope(p, |p| self.chain.symbol(p))
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let prepared = self.prepared(placement);
        for at in (0..out.len()).step_by(CHUNK) {
            let part = at..out.len().min(at + CHUNK);
            let found = prepared.search(points.map(|axis| &axis[part.clone()]));
            out[part.clone()].copy_from_slice(&found[0][..part.len()]);
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        // It settles the few doubtful signs; there are no kernels of gradients in `f64`.
        let Chunk { points: [x, y, z], placement, out: [out] } = chunk;
        for (i, to) in out.iter_mut().enumerate() {
            *to = placement.finish(self.value(placement.apply([x[i], y[i], z[i]])));
        }
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, mut out } = chunk;
        let prepared = self.prepared(placement);
        let len = out[0].len();
        for at in (0..len).step_by(CHUNK) {
            let part = at..len.min(at + CHUNK);
            let found = prepared.search(points.map(|axis| &axis[part.clone()]));
            for (to, from) in out.iter_mut().zip(&found) {
                to[part.clone()].copy_from_slice(&from[..part.len()]);
            }
        }
    }

    fn takes_short(&self) -> bool {
        self.chain.leaf.takes_short()
    }
}

impl Distance {
    fn stretch_of(&self, map: &DAffine3) -> f64 {
        smallest_stretch(&map.matrix3)
    }

    /// The distance to a convex leaf changes by at most 1 per length unit and is concave; what
    /// is found of it exceeds it by a little.
    fn supported_range(&self, zone: &Zone) -> Interval {
        let leaf = self.chain.range(zone);
        let sign = Interval::new(
            if leaf.lo() > 0.0 { leaf.lo() * self.least } else { f64::NEG_INFINITY },
            if leaf.hi() < 0.0 { leaf.hi() * self.least } else { f64::INFINITY },
        );
        if !zone.is_finite() {
            return sign;
        }
        let radius = zone.radius();
        let (value, gradient) = self.at(zone.centre);
        let along = zone.axes.transpose() * gradient;
        let rise = radius.min(along.abs().element_sum() + gradient.abs().dot(zone.slack));
        let rounding = 1e-9 * (value.abs() + radius) + 1e-13 * zone.reach();
        let hi = value + rise;
        let hi = hi + LOOSE * hi.abs() + rounding;
        let lo = value - radius;
        let lo = lo - LOOSE_BELOW * lo.abs() - rounding;
        if hi.is_finite() && lo.is_finite() { Interval::new(lo, hi).narrowed_by(sign) } else { sign }
    }

    /// Of other leaves, what is found is no less than the distance, but for [`SURE`], and no
    /// more than that to a known surface point.
    ///
    /// ```text
    ///     f keeps its sign within ρ of the zone   ⇒   |d| ≥ ρ
    /// ```
    fn followed_range(&self, zone: &Zone) -> Interval {
        let hull = zone.hull();
        let gap = self.gap(DVec3::from_array(hull.map(Interval::lo)), DVec3::from_array(hull.map(Interval::hi)));
        // Rounding may count a face of the box to its neighbour.
        let gap = gap - 1e-13 * zone.reach();
        let outside = if gap > 0.0 { Interval::new(f64::NEG_INFINITY, -gap) } else { Interval::ALL };
        let Some(feet) = self.feet.as_ref().filter(|_| zone.is_finite()) else {
            return signed(self.chain.range(zone), f64::MIN_POSITIVE, f64::INFINITY).narrowed_by(outside);
        };
        let rounding = 1e-9 * zone.radius() + 1e-13 * zone.reach();
        if gap > self.asked {
            return Interval::new(-feet.farthest(hull).max(gap) - feet.slack - rounding, -gap);
        }
        let far = feet.at(zone.centre)[0].point.distance(zone.centre) - zone.radius();
        // First the length that is asked for, then what may be.
        let mut clear = f64::MIN_POSITIVE;
        let mut leaf = None;
        for by in [(1.0 + 2.0 * SURE) * (self.asked + 3.0 * feet.slack), 0.5 * far] {
            if clear < by && by <= far {
                let about = self.chain.range(&zone.inflated(by));
                if about.lo() <= 0.0 && about.hi() >= 0.0 {
                    break;
                }
                (leaf, clear) = (Some(about), by);
            }
        }
        let leaf = leaf.unwrap_or_else(|| self.chain.range(zone));
        let least = ((clear - 2.0 * feet.slack) / (1.0 + SURE) - rounding).max(f64::MIN_POSITIVE);
        let most = feet.farthest(hull).max(gap) + feet.slack + rounding;
        signed(leaf, least, most).narrowed_by(outside)
    }
}

/// Of the sign that a leaf's range leaves, and from `least` to `most` from 0.
fn signed(leaf: Interval, least: f64, most: f64) -> Interval {
    let most = most.max(least);
    if leaf.lo() > 0.0 {
        Interval::new(least, most)
    } else if leaf.hi() < 0.0 {
        Interval::new(-most, -least)
    } else {
        Interval::new(-most, most)
    }
}

/// Rows of a matrix.
fn rows(m: &DMat3) -> [[f64; 3]; 3] {
    m.transpose().to_cols_array_2d()
}
