//! Leaves behind one pointer, each with its own kernels.
//!
//! A formula is generic over the number and so cannot be called through a pointer; what is
//! called is the list of evaluations that the engine runs, instantiated once per leaf. A
//! kernel runs over a chunk of points, so the call through the pointer costs nothing.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::outlined::{Outlined, zone_range, zone_rises};
use super::placed::{Gradient, Value};
use super::{Along, Crease, Field, ParamError, Placement, Segment, Way, Zone, bits, steepest};
use crate::kernel::{Element, run};
use crate::{Bounds, Dual, Interval, Jet};
use rvachev_num::symbol::Symbol;
use rvachev_num::{Cancelled, Run};

/// A chunk of points to run a kernel over; all slices are of one length, a multiple of the widest
/// vectors ([`CHUNK`](crate::kernel::CHUNK) is one). What is left over is filled with copies of the
/// last point.
pub struct Chunk<'a, E, const OUT: usize> {
    /// Coordinates, in the frame that the placement maps from.
    pub points: [&'a [E]; 3],
    /// Where the leaf stands.
    pub placement: &'a Placement,
    /// Where results go.
    pub out: [&'a mut [E]; OUT],
}

/// The triangles of a leaf that is flat between creases, in its frame.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    /// The corners, each once.
    pub positions: Vec<DVec3>,
    /// Three of them each, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Whether they leave no opening.
    pub is_closed: bool,
    /// How far the surface may be off them.
    pub rounding: f64,
}

/// What is between two planes.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// A unit vector across them.
    pub normal: DVec3,
    /// Its product with points of the layer is from this
    pub low: f64,
    /// to this.
    pub high: f64,
    /// The cosine between the normal and the directions that the value rises along where it has the
    /// level is no less; −1 where nothing is known.
    pub least_cosine: f64,
}

impl Layer {
    /// The same of the negated value.
    #[must_use]
    pub fn turned(self) -> Layer {
        Layer { normal: -self.normal, low: -self.high, high: -self.low, ..self }
    }
}

/// A field that tells balls in which no value is above 0.
pub trait EmptyBalls {
    /// The radius of such a ball for each point, and its middle, in the frame of the points, which
    /// the placement maps by lengths alone. Where the field is well below 0 the ball holds the
    /// point, and the farther from it, the farther it reaches.
    fn empty_balls(&self, chunk: Chunk<'_, f32, 4>);
}

/// A [`Field`], erased to the evaluations that the engine runs.
pub trait AnyField: Any + Debug + Send + Sync {
    /// What errors call it.
    fn name(&self) -> &'static str;
    /// All that the value depends on, as text: leaves of one type with the same text are the
    /// same.
    fn signature(&self) -> String {
        text(&self)
    }
    /// Works out what takes long, before the first question.
    fn prepare(&self, _run: &Run) -> Result<(), Cancelled> {
        Ok(())
    }
    /// The box of the shape after a map.
    fn bounds_under(&self, map: &DAffine3) -> Bounds;
    /// Whether every parameter is in its range.
    fn check(&self) -> Result<(), ParamError>;
    /// How far off single precision may be within `reach` of the origin.
    fn roundoff(&self, reach: f64) -> f64;
    /// The same in a region of the leaf's frame.
    fn roundoff_over(&self, region: [Interval; 3]) -> f64 {
        self.roundoff(reach(region))
    }

    /// Ranges of numbers of which the least has the sign of the value.
    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        vec![self.dual_range(p)]
    }

    /// Leaves without edges of their own whose intersection has the inside of this one; none where
    /// it is one itself.
    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        Vec::new()
    }

    /// The value at a point of the leaf's frame.
    fn value(&self, p: [f64; 3]) -> f64;
    /// Value and derivatives at a point.
    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64>;
    /// Ranges of value and derivatives over a box.
    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval>;
    /// The same with ranges of second derivatives; without bound where nothing is known.
    fn jet(&self, p: [Jet; 3]) -> Jet {
        Jet::unbounded(self.dual_range(p.map(|side| side.dual())))
    }
    /// Ranges of the derivatives over the part of a box beside the planes of
    /// [`creases`](AnyField::creases), on the side of each of them that a point is on.
    fn slopes_beside(&self, p: [Dual<Interval>; 3], _beside: DVec3) -> [Interval; 3] {
        self.dual_range(p).d
    }
    /// What is known of the value along a segment of the leaf's frame.
    fn along(&self, segment: &Segment) -> Along {
        Along::of(self.dual_range(segment.sides()))
    }
    /// Whether the value is the true distance.
    fn exact(&self) -> bool;
    /// The points that are at least `depth` inside, as an exact leaf, where that is known.
    fn eroded(&self, _depth: f64) -> Option<Arc<dyn AnyField>> {
        None
    }
    /// No radius of curvature of the surface is less.
    fn least_radius(&self) -> f64 {
        0.0
    }
    /// Whether the surface is flat between creases, however blunt these are.
    fn is_faceted(&self) -> bool {
        false
    }
    /// The triangles of a faceted surface.
    fn facets(&self) -> Option<Facets> {
        None
    }
    /// Three vectors of the leaf's frame, as columns: moved by any of them, the leaf is the same.
    fn period(&self) -> Option<DMat3> {
        None
    }
    /// The radius of a leaf valued `radius·(1 − G)`.
    fn gauge_radius(&self) -> Option<f64> {
        None
    }
    /// How much the box of the points with a value above −c grows along each axis of the
    /// leaf's frame, per unit of c; infinite where nothing is known.
    fn growth(&self) -> DVec3 {
        DVec3::INFINITY
    }
    /// Whether the value is concave, with slope at most 1.
    fn convex(&self) -> bool;
    /// Whether the value is concave over a zone; `false` if it is convex, and nothing where neither
    /// is known.
    fn is_concave_over(&self, _zone: &Zone) -> Option<bool> {
        self.convex().then_some(true)
    }
    /// Planes at which slopes are without bound; those that pass a region of the leaf's frame, and
    /// perhaps more.
    fn creases(&self, _region: [Interval; 3]) -> Vec<Crease> {
        Vec::new()
    }
    /// Layers that hold all points of a zone at which the value is `level`; nothing where that is
    /// not known, or there are many.
    fn layers(&self, _zone: &Zone, _level: f64) -> Option<Vec<Layer>> {
        None
    }
    /// A sound range over a zone of the leaf's frame.
    fn range(&self, zone: &Zone) -> Interval;
    /// The directions, of up to eight, along which the value is found to rise, or to stay,
    /// throughout a zone: by their numbers, as bits.
    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let slopes = self.dual_range(Dual::point(zone.hull())).d;
        bits(ways, |way| way.is_rise(slopes))
    }
    /// The directions, of up to eight, along which what is above a level is found to be entered only,
    /// throughout a zone, whatever the value is elsewhere: it turns from below to above, never back.
    fn enters(&self, zone: &Zone, ways: &[Way], _level: f64) -> u8 {
        self.rises(zone, ways)
    }
    /// The direction along which a zone is most likely to be entered, where the surface tells more
    /// than the value.
    fn inward(&self, _zone: &Zone) -> Option<DVec3> {
        None
    }
    /// The most that the value changes by per length unit anywhere, where that is known.
    fn slope_bound(&self) -> Option<f64> {
        (self.convex() || self.exact()).then_some(1.0)
    }
    /// The most that the value changes by per length unit over a zone.
    fn steepest(&self, zone: &Zone) -> f64 {
        steepest(self.dual_range(Dual::point(zone.hull())).d)
    }
    /// Whether it is a formula of the coordinates: what is searched for is none.
    fn is_formula(&self) -> bool {
        true
    }
    /// A leaf of the same inside, the same surface and the same normals there that is told apart
    /// more easily, where there is one.
    fn of_surface(&self) -> Option<Arc<dyn AnyField>> {
        None
    }
    /// Which of the leaf's own axes the value may depend on.
    fn axes(&self) -> [bool; 3] {
        [true; 3]
    }
    /// Told which zones it will be asked about next; leaves that answer for many of them at once as
    /// quickly as for one do so here.
    fn prefetch(&self, _zones: &[Zone]) {}
    /// A leaf that is cheaper and has the same values over the zone, where there is one.
    fn narrowed(&self, _zone: &Zone) -> Option<Arc<dyn AnyField>> {
        None
    }
    /// The value as an expression tree.
    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a>;
    /// Values of a chunk, on lanes of `f32`.
    fn lanes32(&self, chunk: Chunk<'_, f32, 1>);
    /// The same for who asks about the sign: values that are farther than `band` from 0 may come
    /// nearer to it, as far as the band and no farther.
    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, _band: f64) {
        self.lanes32(chunk);
    }
    /// Numbers with the signs of values, 0 where these are in doubt, at points that are farther
    /// from where the sign turns than `apart`, in lengths of the leaf.
    fn sides32(&self, chunk: Chunk<'_, f32, 1>, _apart: &[f32]) {
        self.lanes32_within(chunk, 0.0);
    }
    /// Values on lanes of `f64`.
    fn lanes64(&self, chunk: Chunk<'_, f64, 1>);
    /// Value and the three derivatives.
    fn gradients(&self, chunk: Chunk<'_, f32, 4>);
    /// What tells balls in which no value is above 0, where that is more than values tell.
    fn empty_balls(&self) -> Option<&dyn EmptyBalls> {
        None
    }
    /// Whether values change as the slopes of `dual_range` say: not those that come of a search.
    fn is_steady(&self) -> bool {
        true
    }
    /// Whether it goes on in another leaf, as the turns of a helix do in each other: by itself it
    /// jumps.
    fn jumps(&self) -> bool {
        false
    }
    /// What a value takes, in those of an ordinary leaf.
    fn cost(&self) -> usize {
        1
    }
    /// The numbers of the parts that the surface is told to be made of; none if it is one.
    fn parts(&self) -> &[u32] {
        &[]
    }
    /// Which of the parts the surface near a point is of: its place among them.
    fn part(&self, _p: DVec3) -> usize {
        0
    }
    /// Whether the surface has colours of its own.
    fn is_colored(&self) -> bool {
        false
    }
    /// The colour of its own that the surface has near a point, in sRGB.
    fn color(&self, _p: DVec3) -> Option<[u8; 3]> {
        None
    }
}

/// The largest coordinate of a region in absolute value.
pub(crate) fn reach(region: [Interval; 3]) -> f64 {
    region.iter().fold(0.0, |reach, side| reach.max(side.magnitude()))
}

fn text(of: &dyn Debug) -> String {
    format!("{of:?}")
}

/// The derivatives, along the variables of `p`, of a value that changes by at most `steepest` per
/// length unit of p.
pub fn steep_slopes(steepest: f64, p: [Dual<Interval>; 3]) -> [Interval; 3] {
    [0, 1, 2].map(|axis| {
        let [x, y, z] = p.map(|side| side.d[axis].magnitude());
        let most = steepest * (1.0 + 1e-12) * (x * x + y * y + z * z).sqrt();
        Interval::new(-most, most)
    })
}

/// A value with its derivatives along the variables of `p`, by its slopes along the axes of p.
///
/// ```
/// use rvachev_field::chained;
/// use rvachev_num::{Dual, Interval};
///
/// // x + 2y along a line with the direction (0.6, 0.8, 0).
/// let zero = Interval::point(0.0);
/// let side = |slope: f64| Dual::new(Interval::new(0.0, 1.0), [Interval::point(slope), zero, zero]);
/// let slopes = [1.0, 2.0, 0.0].map(Interval::point);
/// let value = chained(Interval::new(0.0, 3.0), slopes, [side(0.6), side(0.8), side(0.0)]);
/// assert!((value.gradient()[0].lo() - 2.2).abs() < 1e-12);
/// ```
#[must_use]
pub fn chained(value: Interval, slopes: [Interval; 3], p: [Dual<Interval>; 3]) -> Dual<Interval> {
    // What does not move does not move the value, however steep that is.
    let term = |slope: Interval, d: Interval| if d == Interval::point(0.0) { d } else { slope * d };
    let along = |i: usize| term(slopes[0], p[0].d[i]) + term(slopes[1], p[1].d[i]) + term(slopes[2], p[2].d[i]);
    Dual::new(value, [along(0), along(1), along(2)])
}

impl<F: Field> AnyField for F {
    fn name(&self) -> &'static str {
        Field::name(self)
    }

    fn prepare(&self, run: &Run) -> Result<(), Cancelled> {
        Field::prepare(self, run)
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        Field::bounds_under(self, map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Field::check(self)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        Field::roundoff(self, reach)
    }

    fn roundoff_over(&self, region: [Interval; 3]) -> f64 {
        Field::roundoff_over(self, region)
    }

    fn exact(&self) -> bool {
        Field::exact(self)
    }

    fn eroded(&self, depth: f64) -> Option<Arc<dyn AnyField>> {
        Field::eroded(self, depth).map(|leaf| Arc::new(leaf) as Arc<dyn AnyField>)
    }

    fn axes(&self) -> [bool; 3] {
        let far = Interval::new(-1e9, 1e9);
        self.box_slopes([far; 3]).map(|slope| slope != Interval::ZERO)
    }

    fn convex(&self) -> bool {
        Field::convex(self)
    }

    fn period(&self) -> Option<DMat3> {
        Field::period(self).map(DMat3::from_diagonal)
    }

    fn gauge_radius(&self) -> Option<f64> {
        Field::gauge_radius(self)
    }

    fn growth(&self) -> DVec3 {
        if Field::exact(self) {
            return DVec3::ONE;
        }
        growth(self, &Field::bounds(self), Field::gauge_radius(self))
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.at(p)
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.dual_at(p)
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Field::dual_range(self, p)
    }

    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        Field::faces(self, p)
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        Field::walls(self)
    }

    fn jet(&self, p: [Jet; 3]) -> Jet {
        Field::jet(self, p)
    }

    fn slopes_beside(&self, p: [Dual<Interval>; 3], beside: DVec3) -> [Interval; 3] {
        Field::slopes_beside(self, p, beside)
    }

    fn along(&self, segment: &Segment) -> Along {
        Field::along(self, segment)
    }

    fn range(&self, zone: &Zone) -> Interval {
        let coarse = Field::range(self, zone.hull());
        if coarse.lo() > 0.0 || coarse.hi() < 0.0 || !zone.is_finite() {
            return coarse;
        }
        zone_range(self, zone, coarse)
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        zone_rises(self, zone, ways)
    }

    fn creases(&self, _region: [Interval; 3]) -> Vec<Crease> {
        let crease = |normal| Crease { normal, offset: 0.0, jumps: false };
        Field::creases(self).into_iter().map(crease).collect()
    }

    fn least_radius(&self) -> f64 {
        Field::least_radius(self)
    }

    fn steepest(&self, zone: &Zone) -> f64 {
        let least = Field::steepest(self);
        if least.is_finite() { least } else { steepest(self.box_slopes(zone.hull())) }
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        self.eval(p)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        lanes(self, chunk);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        lanes(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        run(&Gradient(self, chunk.placement), chunk.points, chunk.out);
    }
}

/// [`AnyField::growth`] of a leaf that is not exact.
fn growth(leaf: &dyn Outlined, bounds: &Bounds, gauge_radius: Option<f64>) -> DVec3 {
    if !bounds.is_finite() {
        return DVec3::INFINITY;
    }
    if let Some(radius) = gauge_radius {
        return bounds.min.abs().max(bounds.max.abs()) / radius;
    }
    // A concave function falls from its value at a point at least as fast beyond the
    // surface as before it.
    let top = leaf.at(bounds.center().to_array());
    if leaf.is_concave() && top > 0.0 { bounds.half_extents() / top } else { DVec3::INFINITY }
}

#[inline]
fn lanes<E: Element, F: Field>(field: &F, chunk: Chunk<'_, E, 1>) {
    run(&Value(field, chunk.placement), chunk.points, chunk.out);
}
