//! Polygon with holes, of any number of edges.
//!
//! ```text
//!     f = ± distance to the nearest edge, + inside
//! ```
//!
//! The nearest edge is found through a hierarchy of boxes; the number of edges to the left at a
//! point's height gives the sign. In a small region few edges can be nearest: there the polygon is
//! narrowed to a leaf of these alone, which runs on lanes.

mod contours;
mod edge;
mod fill;
mod levels;
mod near;
mod patch;
mod snap;
mod sweep;
mod tree;

use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DVec2};

use super::super::{AnyField, Chunk, ParamError, VALUE_LIMIT, Way, Zone};
use crate::kernel::Element;
use crate::{Bounds, Dual, Interval, Real};
use edge::Edge;
use levels::Levels;
use near::{NearEdges, Reference};
use patch::Patch;
use rvachev_num::symbol::Symbol;
use rvachev_num::{Cancelled, Run};
use tree::Tree;

/// A polygon in the plane, with holes and islands, by true distance (1-Lipschitz).
///
#[doc = picture!(
    "profile_polygon" = "docs/gallery/profile_polygon.png",
    "profile_polygon_with_holes" = "docs/gallery/profile_polygon_with_holes.png",
)]
///
/// `f = ± distance to the nearest edge`, positive inside. The edge is found through a hierarchy
/// of boxes: thousands of edges are no burden.
///
/// It is given by its contours, each a list of points in either sense, closed by itself (a point
/// that repeats the one before it is left out, as is a last one that repeats the first). A point is
/// inside if an odd number of contours go round it: a contour within another is a hole, one within
/// the hole an island.
///
/// Contours may touch themselves and one another, at corners or along edges: what two of them have
/// in common is no border, as between two squares side by side, or on the two ways of a bridge that
/// leads to a hole. Corners are one that are nearer to each other than 2·10⁻¹² of the size of the
/// whole (and rounding, far from the origin), and an edge that passes a corner so near leads
/// through it: so much may be rounded where a drawing is turned or written. Edges do not cross;
/// coordinates are within ±10⁹ and edges at least 10⁻⁹ long. What is wrong is found by exact
/// arithmetic and said when the profile is compiled: with the contour, the edge and the point.
/// Until then nothing is computed; n edges take some n log n steps, and one more for each pair that
/// lies on one another.
///
/// ```
/// use rvachev::{Polygon, Profile};
/// use glam::DVec2;
///
/// let frame = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
/// let window = [[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]];
/// let polygon = Polygon::new([frame, window]);
/// assert_eq!(polygon.area(), 10.0);
/// let profile = Profile::from(polygon);
/// assert_eq!(profile.value(DVec2::new(0.25, 1.5))?, 0.25);
/// assert_eq!(profile.value(DVec2::new(2.0, 1.5))?, -0.5);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Polygon(Arc<Shape>);

struct Shape {
    contours: Vec<Vec<DVec2>>,
    /// Worked out when it is first asked for.
    border: OnceLock<Border>,
}

/// The edges that the even-odd rule makes of the contours; none if there is something wrong with
/// these.
struct Border {
    /// In the order of the tree.
    edges: Vec<Edge>,
    tree: Tree,
    levels: Levels,
    min: DVec2,
    max: DVec2,
    /// All edges as a list, which lanes run, if they are few.
    list: Option<NearEdges>,
    error: Option<ParamError>,
}

/// A list of edges is at most this long: beyond, the hierarchy is quicker.
const FEW_EDGES: usize = 12;

/// Of a region in which more edges than this could be nearest nothing more is asked.
const MANY_EDGES: usize = 64;

impl Polygon {
    /// The polygon within these contours.
    #[must_use]
    pub fn new<C, P>(contours: impl IntoIterator<Item = C>) -> Polygon
    where
        C: IntoIterator<Item = P>,
        P: Into<DVec2>,
    {
        let closed = |contour: C| {
            let mut points: Vec<DVec2> = contour.into_iter().map(Into::into).collect();
            points.dedup();
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            points
        };
        Polygon::of_points(&contours.into_iter().map(closed).collect::<Vec<_>>())
    }

    fn of_points(contours: &[Vec<DVec2>]) -> Polygon {
        Polygon(Arc::new(Shape { contours: contours.to_vec(), border: OnceLock::new() }))
    }

    fn border(&self) -> &Border {
        self.0.border.get_or_init(|| {
            let border = Border::new(&self.0.contours, &Run::default());
            border.unwrap_or_else(|Cancelled| unreachable!("nobody has the token"))
        })
    }

    /// The contours as they were given, but for points that repeat the one before them, and last
    /// ones that repeat the first.
    #[must_use]
    pub fn contours(&self) -> &[Vec<DVec2>] {
        &self.0.contours
    }

    /// The number of edges of the border: those of the contours, without what two of them have in
    /// common, and parted where corners are on them; 0 if there is something wrong with the
    /// contours.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.border().edges.len()
    }

    /// The area, holes left out; 0 if there is something wrong with the contours.
    #[must_use]
    pub fn area(&self) -> f64 {
        let Border { edges, min, max, .. } = self.border();
        let centre = 0.5 * (*min + *max);
        let twice: f64 = edges.iter().map(|e| (e.start - centre).perp_dot(e.end - centre)).sum();
        0.5 * twice
    }

    /// What is wrong with the contours.
    ///
    /// # Errors
    /// A contour with fewer than 3 points, a coordinate that is not a number, an edge that is
    /// too short, a place where edges cross, or contours of which the even-odd rule leaves nothing.
    pub fn check(&self) -> Result<(), ParamError> {
        self.border().error.clone().map_or(Ok(()), Err)
    }

    /// Of a polygon with x ≥ 0 and edges on x = 0, one that goes on beyond those edges: the
    /// same to its right, with no border on the axis. (From there no distance is shorter than
    /// before: what is added begins at ends of other edges and leads away.)
    pub fn across_axis(&self) -> Option<Polygon> {
        let of_points =
            |pick: fn(f64, f64) -> f64, from| self.0.contours.iter().flatten().map(|p| p.x).fold(from, pick);
        if of_points(f64::min, f64::INFINITY) != 0.0 {
            return None;
        }
        let beyond = -of_points(f64::max, 0.0);
        let mut found = false;
        let extended = self.0.contours.iter().map(|contour| {
            let count = contour.len();
            let on_axis = |i: usize| contour[i % count].x == 0.0;
            let mut points = Vec::with_capacity(count + 4);
            for (i, point) in contour.iter().enumerate() {
                let (before, after) = (on_axis(i + count - 1), on_axis(i + 1));
                let out = DVec2::new(beyond, point.y);
                match (on_axis(i), before, after) {
                    (true, false, true) => points.extend([*point, out]),
                    (true, true, false) => points.extend([out, *point]),
                    (true, true, true) => {}
                    _ => points.push(*point),
                }
                found |= on_axis(i) && after;
            }
            points
        });
        let extended: Vec<Vec<DVec2>> = extended.collect();
        (found && self.check().is_ok()).then(|| Polygon::of_points(&extended))
    }

    /// The leaf for a solid.
    pub fn leaf(&self) -> Arc<dyn AnyField> {
        Arc::new(self.clone())
    }
}

impl fmt::Debug for Polygon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let points: usize = self.0.contours.iter().map(Vec::len).sum();
        write!(f, "Polygon({} contours, {points} points)", self.0.contours.len())
    }
}

impl Border {
    fn new(contours: &[Vec<DVec2>], run: &Run) -> Result<Border, Cancelled> {
        let (mut edges, error) = match contours::edges(contours, run)? {
            Ok(edges) => (edges, None),
            Err(error) => (Vec::new(), Some(error)),
        };
        run.check()?;
        let tree = Tree::build(&mut edges, |edge| edge);
        let levels = Levels::new(&edges, run)?;
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for edge in &edges {
            min = min.min(edge.start);
            max = max.max(edge.start);
        }
        let mut border = Border { edges, tree, levels, min, max, list: None, error };
        if (1..=FEW_EDGES).contains(&border.edges.len()) {
            border.list = Some(NearEdges::new(&border.edges, Reference::Infinity, border.reach()));
        }
        Ok(border)
    }

    /// The largest coordinate.
    fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// The nearest edge and the signed distance to it.
    fn nearest(&self, p: DVec2, guess: usize) -> (usize, f64) {
        let (edge, distance) = self.tree.nearest(&self.edges, p, guess).unwrap_or((0, VALUE_LIMIT));
        (edge, if self.levels.is_inside(&self.edges, p) { distance } else { -distance })
    }

    fn value(&self, p: DVec2) -> f64 {
        self.nearest(p, 0).1
    }

    /// The edges that can be nearest in the patch or within `margin` of it; `None` if they are
    /// too many to ask for.
    fn candidates(&self, patch: &Patch, value: f64, margin: f64) -> Option<Vec<Edge>> {
        let reach = value.abs() + 2.0 * (patch.radius + margin);
        let mut found = Vec::new();
        self.tree.within(patch.centre, reach, |i| {
            let edge = self.edges[i];
            if edge.distance(patch.centre) <= reach {
                found.push(edge);
            }
            found.len() <= MANY_EDGES
        });
        (found.len() <= MANY_EDGES).then_some(found)
    }

    /// The edges that can be nearest in the patch, unless they are too many to ask for.
    fn near(&self, patch: &Patch) -> Option<Vec<Edge>> {
        let margin = near::margin(patch, self.reach());
        let candidates = self.candidates(patch, self.value(patch.centre), margin)?;
        Some(near::nearest_over(patch, candidates.into_iter(), margin))
    }

    fn over(&self, patch: Option<Patch>) -> Interval {
        let Some(patch) = patch.filter(|_| !self.edges.is_empty()) else { return Interval::ALL };
        let value = self.value(patch.centre);
        let rounding = 1e-14 * (self.reach() + patch.centre.abs().max_element() + patch.radius);
        let by_slope = Interval::around(value, patch.radius + rounding);
        if by_slope.lo() > 0.0 || by_slope.hi() < 0.0 {
            return by_slope;
        }
        match self.candidates(&patch, value, rounding) {
            Some(edges) => patch.range(value, edges.iter(), rounding),
            None => by_slope,
        }
    }

    /// Runs over a chunk, each point starting from the edge that was nearest to the last one.
    fn each<E: Element + Into<f64>, const OUT: usize>(
        &self,
        chunk: Chunk<'_, E, OUT>,
        at: impl Fn([f64; 3], &mut usize) -> [f64; OUT],
    ) {
        let Chunk { points: [x, y, z], out: mut columns, .. } = chunk;
        let mut guess = 0;
        let mut last = None;
        for (i, ((x, y), z)) in x.iter().zip(y).zip(z).enumerate() {
            let point = [(*x).into(), (*y).into(), (*z).into()];
            // Chunks end with copies of one point.
            let values = match last {
                Some((known, values)) if known == point => values,
                _ => at(point, &mut guess),
            };
            last = Some((point, values));
            for (column, value) in columns.iter_mut().zip(values) {
                if let Some(to) = column.get_mut(i) {
                    *to = E::from_f64(value);
                }
            }
        }
    }

    fn values<E: Element + Into<f64>>(&self, chunk: Chunk<'_, E, 1>) {
        let placement = *chunk.placement;
        self.each(chunk, |p, guess| {
            let [x, y, _] = placement.apply(p);
            let (edge, value) = self.nearest(DVec2::new(x, y), *guess);
            *guess = edge;
            [placement.finish(value)]
        });
    }

    /// The signed distance by the nearest edge and its slopes; the edge found is the next guess.
    fn dual(&self, [x, y, _]: [Dual<f64>; 3], guess: &mut usize) -> Dual<f64> {
        let (number, value) = self.nearest(DVec2::new(x.value(), y.value()), *guess);
        *guess = number;
        match self.edges.get(number) {
            Some(edge) if value >= 0.0 => edge.distances(x, y).0,
            Some(edge) => -edge.distances(x, y).0,
            None => x.lift(-VALUE_LIMIT),
        }
    }
}

impl AnyField for Polygon {
    fn signature(&self) -> String {
        format!("{:?}", self.0.contours)
    }

    fn name(&self) -> &'static str {
        "polygon"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        let m = map.matrix3;
        let mut bounds = Bounds::EMPTY;
        for edge in &self.border().edges {
            let p = map.transform_point3(edge.start.extend(0.0));
            bounds = bounds.union(&Bounds::new(p, p));
        }
        for axis in 0..3 {
            if m.z_axis[axis] != 0.0 && !bounds.is_empty() {
                bounds.min[axis] = f64::NEG_INFINITY;
                bounds.max[axis] = f64::INFINITY;
            }
        }
        bounds
    }

    fn prepare(&self, run: &Run) -> Result<(), Cancelled> {
        if self.0.border.get().is_none() {
            let _ = self.0.border.set(Border::new(&self.0.contours, run)?);
        }
        Ok(())
    }

    fn check(&self) -> Result<(), ParamError> {
        Polygon::check(self)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.border().reach().min(reach)
    }

    fn value(&self, [x, y, _]: [f64; 3]) -> f64 {
        self.border().value(DVec2::new(x, y))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.border().dual(p, &mut 0)
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        near::unit_slopes(self.border().over(Patch::of_box(p[0].value(), p[1].value())), p)
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
        near::is_concave(&self.border().near(&Patch::of_zone(zone)?)?)
    }

    fn axes(&self) -> [bool; 3] {
        [true, true, false]
    }

    fn growth(&self) -> glam::DVec3 {
        glam::DVec3::ONE
    }

    fn range(&self, zone: &Zone) -> Interval {
        self.border().over(Patch::of_zone(zone))
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let near = Patch::of_zone(zone).and_then(|patch| self.border().near(&patch));
        near.map_or(0, |edges| near::rises(&edges, ways))
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        let patch = Patch::of_zone(zone)?;
        let edges = self.border().near(&patch)?;
        if edges.is_empty() || edges.len() > FEW_EDGES || edges.len() == self.border().edges.len() {
            return None;
        }
        let leaf = NearEdges::over_patch(&patch, &edges, self.border().reach(), |p| self.border().value(p))?;
        Some(Arc::new(leaf))
    }

    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        NearEdges::symbol_of(&self.border().edges, p)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        match &self.border().list {
            Some(list) => list.lanes32(chunk),
            None => self.border().values(chunk),
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        match &self.border().list {
            Some(list) => list.lanes64(chunk),
            None => self.border().values(chunk),
        }
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        if let Some(list) = &self.border().list {
            return list.gradients(chunk);
        }
        let placement = *chunk.placement;
        self.border().each(chunk, |p, guess| {
            let value = self.border().dual(placement.apply(Dual::point(p)), guess);
            let [x, y, z] = value.gradient().map(|slope| slope * placement.scale);
            [placement.finish(value.value()), x, y, z]
        });
    }
}

#[cfg(test)]
mod slope_tests;
#[cfg(test)]
mod tests;
