//! What a rolling ball leaves out: the material of a fillet.
//!
//! ```text
//!     U       the union of all open balls of the radius r outside of the operands
//!     D(x)    how far x is from U; 0 within it
//!     a, b    how far x is from the two nearest operands
//!     fill    min(D, r/2) − max(0, a + b − 2r)/4 − δ > 0
//! ```
//!
//! The complement of U is the closing of the operands' union by the ball, so nothing is filled that
//! the ball reaches, and flush faces stay as they are. Between convex operands the second term is 0
//! all over the fill, which is the closing then: let x be outside of both, a + b ≥ 2r and b < r.
//! With n the normal at the foot of x on B, x' = x + (r − b) n is r from B and, since a ≥ 2r − b,
//! no nearer to A; so it is the centre of a ball of U that holds x. An edge that an operand has by
//! itself is filled beside the other operand only, and less and less so away from it.
//!
//! Far below the surface no value counts but as one that is below: it is held at −4r, so that a
//! point as far from all joints costs nothing, however many fillets the operands have themselves.
//!
//! Intersections are the unions of complements, and so are differences. δ is how far the measured
//! distance may be off.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::composite::unscaled;
use super::even::{either, ends};
use super::few::{Few, Lane};
use super::room::{Room, meets};
use super::signed::Signed;
use crate::{Bounds, Dual, Interval, ParamError, Real};
use rvachev_field::VALUE_LIMIT;
use rvachev_field::kernel::{distinct, repeat};
use rvachev_field::{AnyField, Chunk, EmptyBalls, Layer, Way, Zone, steep_slopes};
use rvachev_num::symbol::Symbol;

/// D counts up to this part of the radius.
const MOST: f64 = 0.5;

/// How fast a fillet fades away from the joint.
const FADE: f64 = 0.25;

/// Nothing is filled that is farther than this from an operand, in radii.
pub(super) const FARTHEST: f64 = 2.0 + MOST / FADE;

/// An operand: how far outside of it points are, and a box beyond which it is far.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) distance: Signed,
    pub(super) bounds: Bounds,
}

/// The material between operands, or that of all concave edges of one.
#[derive(Clone, Debug)]
pub(super) struct Fill {
    pub(super) radius: f64,
    /// The distance to where the ball's centre may be, positive where it may not.
    pub(super) ball: Signed,
    /// The operands; none where it is of no account how far they are.
    pub(super) sides: Vec<Side>,
    /// How much is left out for the sake of flush faces.
    pub(super) margin: f64,
    /// Where there may be any.
    room: Room,
}

/// The distances to the two nearest operands, held at the farthest, and which these are.
#[derive(Clone, Copy)]
struct Two {
    distances: [f64; 2],
    sides: [usize; 2],
}

impl Two {
    fn new(farthest: f64) -> Two {
        Two { distances: [farthest; 2], sides: [usize::MAX; 2] }
    }

    fn add(&mut self, side: usize, distance: f64) {
        if distance < self.distances[0] {
            self.distances = [distance, self.distances[0]];
            self.sides = [side, self.sides[0]];
        } else if distance < self.distances[1] {
            self.distances[1] = distance;
            self.sides[1] = side;
        }
    }
}

impl Fill {
    /// All over space.
    pub(super) fn new(radius: f64, ball: Signed, sides: Vec<Side>, margin: f64) -> Fill {
        Fill { radius, ball, sides, margin, room: Room::all() }
    }

    /// In boxes alone, and not beyond the hull.
    pub(super) fn within(mut self, boxes: Vec<Bounds>, hull: Bounds) -> Fill {
        self.room = Room::within(boxes, hull, MOST * self.radius);
        self
    }

    fn farthest(&self) -> f64 {
        FARTHEST * self.radius
    }

    fn two(&self, p: DVec3) -> Option<Two> {
        self.two_of(p, |number| self.sides[number].distance.value(p))
    }

    fn height(&self, ball: f64, two: Option<Two>) -> f64 {
        let most = (ball - self.radius).min(MOST * self.radius);
        let beyond = two.map_or(0.0, |Two { distances: [a, b], .. }| (a + b - 2.0 * self.radius).max(0.0));
        (most - FADE * beyond - self.margin).max(self.lowest())
    }

    /// Values are held there.
    fn lowest(&self) -> f64 {
        -self.farthest()
    }

    /// The gradient of the height, from those of what it is made of.
    fn slope(&self, ball: f64, slope: DVec3, two: Option<Two>, side: impl Fn(usize) -> DVec3) -> DVec3 {
        let mut all = if ball - self.radius < MOST * self.radius { slope } else { DVec3::ZERO };
        self.fading(two).for_each(|number| all -= FADE * side(number));
        all
    }

    /// The operands that the fillet fades away from.
    fn fading(&self, two: Option<Two>) -> impl Iterator<Item = usize> + use<> {
        let count = self.sides.len();
        let fades = two.filter(|Two { distances: [a, b], .. }| a + b > 2.0 * self.radius);
        fades.into_iter().flat_map(|two| two.sides).filter(move |number| *number < count)
    }

    /// The value of the ball's field where this is at a level, where it does not fade away from
    /// operands: the ball is as far as its radius there.
    fn level_of_ball(&self, zone: &Zone, level: f64) -> Option<f64> {
        let height = self.margin + level;
        let is_ball = self.sides.is_empty() && height < MOST * self.radius && self.room.depths(zone).lo() > level;
        is_ball.then_some(self.ball.sign * (self.radius + height))
    }

    /// The steepest that it is.
    fn steepness(&self) -> f64 {
        if self.sides.is_empty() { 1.0 } else { 1.0 + 2.0 * FADE }
    }
}

impl AnyField for Fill {
    fn name(&self) -> &'static str {
        "fillet"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.room.bounds().transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let sides = self.sides.iter().map(|side| 2.0 * FADE * side.distance.field.roundoff(reach)).fold(0.0, f64::max);
        self.ball.field.roundoff(reach) + sides + 1e-6 * (self.radius + reach)
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let p = DVec3::from_array(p);
        let (depth, _) = self.room.depth(p);
        if depth < self.lowest() { depth } else { self.height(self.ball.value(p), self.two(p)).min(depth) }
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let at = DVec3::from_array(p.map(Dual::value));
        let (depth, way) = self.room.depth(at);
        let looked = || {
            let (ball, two) = (self.ball.value(at), self.two(at));
            let height = self.height(ball, two);
            if depth < height {
                (depth, way)
            } else if height <= self.lowest() {
                (height, DVec3::ZERO)
            } else {
                (height, self.slope(ball, self.ball.slope(at), two, |number| self.sides[number].distance.slope(at)))
            }
        };
        let (value, slope) = if depth < self.lowest() { (depth, way) } else { looked() };
        let along = |axis: usize| (0..3).map(|i| slope[i] * p[i].d[axis]).sum();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Dual::new(self.range(&Zone::of_sides(p.map(Dual::value))), steep_slopes(self.steepness(), p))
    }

    fn exact(&self) -> bool {
        false
    }

    fn convex(&self) -> bool {
        false
    }

    fn axes(&self) -> [bool; 3] {
        let of_boxes = self.room.held().map(ends);
        let of_sides = self.sides.iter().map(|side| side.distance.field.axes());
        of_boxes.chain(of_sides).fold(self.ball.field.axes(), either)
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        let point = Interval::point;
        let depth = self.room.depths(zone);
        let lowest = point(self.lowest());
        if depth.hi() < 0.0 {
            return Interval::new(lowest.min(depth).lo(), depth.hi());
        }
        let most = (self.ball.range(zone) - point(self.radius)).min(point(MOST * self.radius));
        let fade = if self.sides.is_empty() {
            point(0.0)
        } else {
            let farthest = point(self.farthest());
            let (mut low, mut high) = (Two::new(self.farthest()), Two::new(self.farthest()));
            for (number, side) in self.sides.iter().enumerate().filter(|(_, side)| meets(zone, &side.bounds)) {
                let range = side.distance.range(zone).min(farthest);
                low.add(number, range.lo());
                high.add(number, range.hi());
            }
            let sum = Interval::new(low.distances.iter().sum(), high.distances.iter().sum());
            (sum - point(2.0 * self.radius)).max(point(0.0)) * point(FADE)
        };
        (most - fade - point(self.margin)).max(lowest).min(depth)
    }

    /// Towards the joint the ball is farther off and the operands are nearer. Outside of the boxes
    /// nothing is told.
    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        if !self.room.holds(zone) {
            return 0;
        }
        let turned = |sign: f64, fade: f64| -> Vec<Way> {
            let own = ways.iter().map(|way| Way { sway: way.sway + fade * way.middle.length(), ..*way });
            own.map(|way| way.flip_if(sign < 0.0)).collect()
        };
        // The more of the two nearest operands may become farther, the faster the ball is to: its
        // slope is 1, as all distances' is.
        let (mut by_sides, mut but_one) = (u8::MAX, u8::MAX);
        for side in self.sides.iter().filter(|side| meets(zone, &side.bounds)) {
            let own = side.distance.field.rises(zone, &turned(-side.distance.sign, 0.0));
            (by_sides, but_one) = (by_sides & own, but_one & own | by_sides & !own);
        }
        let ball = |fade: f64| self.ball.field.rises(zone, &turned(self.ball.sign, fade));
        let mut found = by_sides & ball(0.0);
        let highest = self.ball.range(zone).hi() - self.radius;
        // Beyond the most that counts of the ball only operands do.
        if highest < MOST * self.radius {
            found |= but_one & ball(FADE) | ball(2.0 * FADE);
        }
        found & self.room.off_hull(zone, highest.min(MOST * self.radius), ways)
    }

    fn enters(&self, zone: &Zone, ways: &[Way], level: f64) -> u8 {
        let Some(level) = self.level_of_ball(zone, level) else { return self.rises(zone, ways) };
        let own: Vec<Way> = ways.iter().map(|way| way.flip_if(self.ball.sign < 0.0)).collect();
        self.ball.field.enters(zone, &own, level)
    }

    fn inward(&self, zone: &Zone) -> Option<DVec3> {
        Some(self.ball.sign * self.ball.field.inward(zone)?)
    }

    fn layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        let found = self.ball.field.layers(zone, self.level_of_ball(zone, level)?)?;
        Some(if self.ball.sign < 0.0 { found.into_iter().map(Layer::turned).collect() } else { found })
    }

    fn slope_bound(&self) -> Option<f64> {
        Some(self.steepness())
    }

    fn steepest(&self, _zone: &Zone) -> f64 {
        self.steepness()
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let mut simpler = self.clone();
        let mut is_simpler = false;
        if let Some(room) = self.room.narrowed(zone) {
            (simpler.room, is_simpler) = (room, true);
        }
        if let Some(field) = self.ball.field.narrowed(zone) {
            (simpler.ball.field, is_simpler) = (field, true);
        }
        // Beyond the second of the least upper ends no operand is one of the two nearest.
        let mut high = Two::new(self.farthest());
        let ranges: Vec<Interval> = self
            .sides
            .iter()
            .enumerate()
            .map(|(number, side)| {
                let is_near = meets(zone, &side.bounds);
                let range = if is_near { side.distance.range(zone) } else { Interval::point(f64::INFINITY) };
                high.add(number, range.hi());
                range
            })
            .collect();
        let [first, second] = high.distances;
        if !self.sides.is_empty() && first + second <= 2.0 * self.radius {
            (simpler.sides, is_simpler) = (Vec::new(), true);
        } else if !self.sides.is_empty() {
            let mut near = Vec::new();
            for (side, range) in self.sides.iter().zip(&ranges) {
                if range.lo() <= second {
                    let field = side.distance.field.narrowed(zone);
                    is_simpler |= field.is_some();
                    let field = field.unwrap_or_else(|| side.distance.field.clone());
                    near.push(Side { distance: Signed { field, ..side.distance }, bounds: side.bounds });
                }
            }
            // One that stands for all that are far keeps the others from counting as none.
            if near.is_empty() {
                near.extend(self.sides.first().cloned());
            }
            is_simpler |= near.len() < self.sides.len();
            simpler.sides = near;
        }
        is_simpler.then(|| Arc::new(simpler) as Arc<dyn AnyField>)
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with a fillet are not lowered.
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        self.lanes32_within(chunk, f64::INFINITY);
    }

    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, band: f64) {
        self.values(chunk, band);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        self.values(chunk, f64::INFINITY);
    }

    /// Operands are asked for their slopes where the fillet fades away, and nowhere else.
    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out } = chunk;
        let (own, count) = (unscaled(placement), distinct(points));
        let local = |i: usize| DVec3::from_array(placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i]))));
        // The slopes of parts are those of the frame that the points are in.
        let mut all: Vec<(f64, DVec3)> = (0..count)
            .map(|i| {
                let (depth, way) = self.room.depth(local(i));
                (depth, DVec3::from_array(placement.pull(way.to_array())))
            })
            .collect();
        let open = Few::of((0..count).filter(|i| all[*i].0 >= self.lowest()), points);
        let balls = open.slopes(&self.ball, &own);
        let is_near = |(n, _): &(usize, &usize)| self.height(balls[*n].0, None) > self.lowest();
        let near: Vec<usize> = open.places.iter().enumerate().filter(is_near).map(|(n, _)| n).collect();
        let asked = Few::of(near.iter().map(|n| open.places[*n]), points);
        let sides: Vec<Vec<f64>> = (self.sides.iter())
            .map(|side| asked.values(&side.distance, &own, (2.0 * self.radius, self.farthest())))
            .collect();
        let mut twos = vec![None; count];
        for (n, &i) in asked.places.iter().enumerate() {
            twos[i] = self.two_of(local(i), |number| sides[number][n]);
        }
        let mut fading: Vec<(usize, usize)> = Vec::new();
        for (&i, &(ball, slope)) in open.places.iter().zip(&balls) {
            let height = self.height(ball, twos[i]);
            if all[i].0 < height {
                continue;
            }
            all[i] = (height, DVec3::ZERO);
            if height > self.lowest() {
                all[i].1 = self.slope(ball, slope, None, |_| DVec3::ZERO);
                fading.extend(self.fading(twos[i]).map(|number| (number, i)));
            }
        }
        for (number, side) in self.sides.iter().enumerate() {
            let here = Few::of(fading.iter().filter(|(own, _)| *own == number).map(|(_, i)| *i), points);
            if here.places.is_empty() {
                continue;
            }
            for (i, (_, slope)) in here.places.iter().zip(here.slopes(&side.distance, &own)) {
                all[*i].1 -= FADE * slope;
            }
        }
        let [value, dx, dy, dz] = out;
        for (i, (v, slope)) in all.into_iter().enumerate() {
            value[i] = placement.finish(v) as f32;
            let scaled = slope * placement.scale;
            (dx[i], dy[i], dz[i]) = (scaled.x as f32, scaled.y as f32, scaled.z as f32);
        }
        [value, dx, dy, dz].into_iter().for_each(|list| repeat(list, count));
    }

    fn empty_balls(&self) -> Option<&dyn EmptyBalls> {
        Some(self)
    }

    fn cost(&self) -> usize {
        4
    }
}

impl Fill {
    /// Values of a chunk. What is outside of the boxes or reached by the ball by more than the band
    /// is not looked into.
    fn values<E: Lane>(&self, chunk: Chunk<'_, E, 1>, band: f64) {
        let Chunk { points, placement, out: [out] } = chunk;
        let band = if placement.shift == 0.0 { band / placement.scale } else { f64::INFINITY };
        let band = band.min(self.farthest());
        let local = |i: usize| DVec3::from_array(placement.apply([0, 1, 2].map(|axis| points[axis][i].to_f64())));
        let count = distinct(points);
        let depths: Vec<f64> = (0..count).map(|i| self.room.depth(local(i)).0).collect();
        let mut all = depths.clone();
        let mut open = Few::of((0..count).filter(|i| depths[*i] > -band), points);
        let own = unscaled(placement);
        let most = (MOST * self.radius).max(band + self.margin);
        let balls = open.values(&self.ball, &own, (self.radius, most));
        open.retain(&balls, |ball, i| {
            let height = (ball - self.radius - self.margin).max(self.lowest());
            all[i] = height.min(depths[i]);
            height > -band
        });
        let sides: Vec<Vec<f64>> = (self.sides.iter())
            .map(|side| open.values(&side.distance, &own, (2.0 * self.radius, self.farthest() + band)))
            .collect();
        for (n, (&i, &ball)) in open.places.iter().zip(&open.known).enumerate() {
            let two = self.two_of(local(i), |number| sides[number][n]);
            all[i] = self.height(ball, two).min(depths[i]);
        }
        for (out, value) in out.iter_mut().zip(all) {
            *out = E::from_f64(placement.finish(value));
        }
        repeat(out, count);
    }

    /// The two nearest operands, by values that are known.
    fn two_of(&self, p: DVec3, value: impl Fn(usize) -> f64) -> Option<Two> {
        let mut two = Two::new(self.farthest());
        for (number, side) in self.sides.iter().enumerate() {
            if side.bounds.contains(p) {
                two.add(number, value(number));
            }
        }
        (!self.sides.is_empty()).then_some(two)
    }
}
