//! The few edges of a polygon that can be nearest in some region.
//!
//! The sign is that of a reference point, turned by every edge between it and the point: all
//! edges that meet the region are among those that can be nearest in it. Unlike the side of
//! the nearest edge it is certain in single precision but for points next to an edge, however
//! thin the polygon is.

use std::sync::Arc;

use glam::{DAffine3, DVec2};

use super::super::super::{AnyField, Chunk, Field, ParamError, VALUE_LIMIT, Way, Zone, bits, steep_slopes};
use super::{Edge, Patch};
use crate::{Bounds, Dual, Interval, Real};
use rvachev_num::symbol::Symbol;

/// The nearest of a list of edges, as a formula: what lanes run.
#[derive(Clone, Debug)]
struct Nearest {
    items: Box<[Item]>,
    /// The sign at the reference point.
    sign: f64,
    reach: f64,
}

/// An edge as it is seen from the reference point.
#[derive(Clone, Copy, Debug)]
struct Item {
    edge: Edge,
    /// Across the lines from the reference point through the start and the end.
    across: [DVec2; 2],
    /// On which side of the edge the reference point is: 1 on its left, else −1.
    side: f64,
}

/// What the sign is counted from: crossings of edges on the straight way from here.
#[derive(Clone, Copy)]
pub(super) enum Reference {
    /// A point where the sign is known.
    Point(DVec2, f64),
    /// The far end of the x axis, which is outside.
    Infinity,
}

impl Item {
    fn new(edge: Edge, reference: Reference) -> Item {
        let (across, away) = match reference {
            Reference::Point(c, _) => ([edge.start, edge.end].map(|v| (c - v).perp()), c - edge.start),
            Reference::Infinity => ([DVec2::Y; 2], DVec2::X),
        };
        Item { edge, across, side: if edge.along.perp().dot(away) >= 0.0 { 1.0 } else { -1.0 } }
    }

    /// The distance, and −1 if the edge is between the point and the reference point, else 1.
    /// Both edges at a corner count the way past it alike, to the last bit.
    #[inline(always)]
    fn look<R: Real>(&self, x: R, y: R) -> (R, R) {
        let (one, other) = (x.lift(1.0), x.lift(-1.0));
        let (distance, s) = self.edge.distances(x, y);
        let [first, last] = self.across;
        let at_start = (x - self.edge.start.x).scale_add(first.x, (y - self.edge.start.y) * first.y);
        let at_end = (x - self.edge.end.x).scale_add(last.x, (y - self.edge.end.y) * last.y);
        let between = at_start.select(at_end.select(one, other), at_end.select(other, one));
        let sides = s.select(one, other) * self.side;
        (distance, between.max(sides))
    }
}

impl Field for Nearest {
    fn name(&self) -> &'static str {
        "polygon"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let mut nearest = x.lift(VALUE_LIMIT);
        let mut sign = x.lift(self.sign);
        let mut i = 0;
        while i < self.items.len() {
            let (distance, crossing) = self.items[i].look(x, y);
            nearest = nearest.min(distance);
            sign = sign * crossing;
            i += 1;
        }
        // On an edge, where crossings are counted with the points above, its own slope is inwards.
        (-nearest).select(nearest, sign.select(nearest, -nearest))
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
    /// The leaf of `edges`; `reach` is the largest coordinate of the polygon.
    pub(super) fn new(edges: &[Edge], reference: Reference, reach: f64) -> NearEdges {
        let items = edges.iter().map(|edge| Item::new(*edge, reference)).collect();
        let sign = if let Reference::Point(_, sign) = reference { sign } else { -1.0 };
        NearEdges(Nearest { items, sign, reach })
    }

    /// The leaf of what is nearest over a patch, its signs counted from a point of the patch
    /// that is clear of all lines of edges. `None` if there is no such point.
    pub(super) fn over_patch(
        patch: &Patch,
        edges: &[Edge],
        reach: f64,
        value: impl Fn(DVec2) -> f64,
    ) -> Option<NearEdges> {
        let clear = |p: DVec2| {
            let from_lines = edges.iter().map(|edge| edge.along.perp_dot(p - edge.start).abs());
            from_lines.fold(f64::INFINITY, f64::min)
        };
        let points = patch.inner_points().map(|p| (p, clear(p)));
        let (point, room) = points.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let reference = Reference::Point(point, value(point).signum());
        (room > 4.0 * margin(patch, reach)).then(|| NearEdges::new(edges, reference, reach))
    }

    /// The formula on symbols, for as many edges as there are.
    pub(super) fn symbol_of<'a>(edges: &[Edge], [x, y, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // A balanced tree: fidget's own walks go as deep as it is.
        let look = |edge: &Edge| Item::new(*edge, Reference::Infinity).look(x, y);
        let mut level: Vec<(Symbol<'a>, Symbol<'a>)> = edges.iter().map(look).collect();
        while level.len() > 1 {
            let both = |pair: &[(Symbol<'a>, Symbol<'a>)]| match *pair {
                [a, b] => (a.0.min(b.0), a.1 * b.1),
                _ => pair[0],
            };
            level = level.chunks(2).map(both).collect();
        }
        match level.pop() {
            Some((nearest, crossings)) => crossings.select(-nearest, nearest),
            None => x.lift(-VALUE_LIMIT),
        }
    }

    fn value_at(&self, p: DVec2) -> f64 {
        self.0.eval([p.x, p.y, 0.0])
    }

    fn edges(&self) -> impl Iterator<Item = &Edge> {
        self.0.items.iter().map(|item| &item.edge)
    }

    fn over(&self, patch: Option<Patch>) -> Interval {
        match patch {
            Some(patch) => {
                let rounding = 1e-14 * (self.0.reach + patch.centre.abs().max_element() + patch.radius);
                patch.range(self.value_at(patch.centre), self.edges(), rounding)
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

/// The directions along which the signed distance rises where these edges can be nearest: into the
/// polygon across all of them, and so across their corners.
pub(super) fn rises(edges: &[Edge], ways: &[Way]) -> u8 {
    let across = |edge: &Edge, Way { middle, sway }: Way| edge.along.perp().dot(middle.truncate()) > sway;
    bits(ways, |way| !edges.is_empty() && edges.iter().all(|edge| across(edge, way)))
}

/// Whether the signed distance is concave where only these edges can be nearest, `false` if it is
/// convex: of one that is a line, of two either where each is within the other's line, or beyond.
///
/// ```text
///      inside            \_            Their region is where both lines leave it, or where one does.
///     ________    ________\ outside
///             \     inside
/// ```
pub(super) fn is_concave(edges: &[Edge]) -> Option<bool> {
    match edges {
        [_] => Some(true),
        [a, b] => {
            let height = |edge: &Edge, p: DVec2| edge.along.perp_dot(p - edge.start);
            let shared = |edge: &Edge, p: DVec2| p == edge.start || p == edge.end;
            let ends = [(a, b.start), (a, b.end), (b, a.start), (b, a.end)];
            let heights = ends.map(|(edge, p)| if shared(edge, p) { 0.0 } else { height(edge, p) });
            let are = |is: fn(&f64) -> bool| heights.iter().all(is);
            if are(|height| *height >= 0.0) { Some(true) } else { are(|height| *height <= 0.0).then_some(false) }
        }
        _ => None,
    }
}

/// By how much points may lie outside of the zone that they are said to be in: lanes round
/// their coordinates.
pub(super) fn margin(patch: &Patch, reach: f64) -> f64 {
    2e-6 * (patch.centre.abs().max_element() + patch.radius + reach)
}

/// A range and slopes of a function that changes by at most 1 per length unit.
pub(super) fn unit_slopes(value: Interval, [x, y, _]: [Dual<Interval>; 3]) -> Dual<Interval> {
    Dual::new(value, steep_slopes(1.0, [x, y, Dual::constant(Interval::point(0.0))]))
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

    fn is_faceted(&self) -> bool {
        true
    }

    fn convex(&self) -> bool {
        false
    }

    fn is_concave_over(&self, zone: &Zone) -> Option<bool> {
        let patch = Patch::of_zone(zone)?;
        is_concave(&nearest_over(&patch, self.edges().copied(), margin(&patch, self.0.reach)))
    }

    fn axes(&self) -> [bool; 3] {
        [true, true, false]
    }

    fn growth(&self) -> glam::DVec3 {
        glam::DVec3::ONE
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.over(Patch::of_zone(zone))
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let near = |patch: Patch| nearest_over(&patch, self.edges().copied(), margin(&patch, self.0.reach));
        Patch::of_zone(zone).map_or(0, |patch| rises(&near(patch), ways))
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let patch = Patch::of_zone(zone)?;
        let margin = margin(&patch, self.0.reach);
        let near = nearest_over(&patch, self.edges().copied(), margin);
        if near.len() >= self.0.items.len() {
            return None;
        }
        let leaf = NearEdges::over_patch(&patch, &near, self.0.reach, |p| self.value_at(p))?;
        Some(Arc::new(leaf))
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
