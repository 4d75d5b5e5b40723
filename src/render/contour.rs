//! Contours of a slice: closed, oriented, on the surface.
//!
//! ```text
//!     outside o-------o          a grid of signs; on each edge whose ends differ a root is
//!             |   .-*-|--.       bracketed; in each cell roots are joined with the inside to
//!             |  *    |          the left. A chord is then refined: from its middle across
//!             +--|----o          to the curve, again and again until it deviates by less
//!      inside    |               than the tolerance. At a corner the last two tangents are
//!                                made to meet.
//! ```
//!
//! What lies beyond the region counts as outside, so that every contour is closed. Features
//! smaller than a cell of the grid, which has 256 along its longer side, may be missed.
//!
//! Source: W. Lorensen, H. Cline (1987), in the plane; the ambiguous cells are decided by the
//! sign in their middle.

use std::collections::HashMap;

use glam::DVec2;

use super::settings::{RenderError, setting};
use super::slice::Slice;
use crate::{PlaneBounds, Polyline};

/// Cells along the longer side of the region.
const CELLS: f64 = 256.0;

/// The finest tolerance, in longer sides of the region: a circle has some 10⁵ points then.
const FINEST: f64 = 1e-9;

/// A chord is halved at most this many times.
const DEEPEST: u32 = 14;

/// Where a contour crosses the grid: an edge between two neighbouring nodes.
type Crossing = (u32, u32, bool);

impl Slice {
    /// The contours of the solid on the plane: closed polylines with the inside to the left, so
    /// that outlines run anticlockwise and holes clockwise. Points are on the surface to within
    /// rounding; in between, and at corners, contours deviate by no more than about `tolerance`. One below 10⁻⁹ of
    /// the region's longer side counts as that.
    ///
    /// Where the solid goes on beyond the region, its contour follows the region's border. A
    /// face that lies in the plane counts as outside.
    ///
    /// # Errors
    /// If the tolerance is not above 0.
    pub fn contours(&self, tolerance: f64) -> Result<Vec<Polyline>, RenderError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(setting("tolerance", tolerance, "finite and above 0"));
        }
        let tolerance = tolerance.max(FINEST * (self.region.max - self.region.min).max_element());
        let grid = Nodes::new(self);
        let mut next: HashMap<Crossing, Crossing> = HashMap::new();
        let mut starts: Vec<Crossing> = Vec::new();
        for j in 0..grid.rows.len() as u32 - 1 {
            for i in 0..grid.columns.len() as u32 - 1 {
                for [from, to] in grid.segments(self, i, j).into_iter().flatten() {
                    next.insert(from, to);
                    starts.push(from);
                }
            }
        }
        let mut contours = Vec::new();
        for start in starts {
            let mut points = Vec::new();
            let mut at = start;
            // Every crossing has one way in and one way out, so that the way leads back.
            while let Some(to) = next.remove(&at) {
                points.push(grid.root(self, at));
                at = to;
            }
            if points.len() > 1 {
                let refined = self.refined(&points, tolerance, grid.cell);
                let kept = thinned(&refined, 0.25 * tolerance);
                if kept.len() > 2 {
                    contours.push(Polyline::closed(kept));
                }
            }
        }
        Ok(contours)
    }

    /// Whether a point is of the solid: within the region, and inside.
    fn inside(&self, p: DVec2) -> bool {
        let PlaneBounds { min, max } = self.region;
        p.cmpge(min).all() && p.cmple(max).all() && self.surface.value(self.plane.point(p)) > 0.0
    }

    /// The root between a point inside and one outside.
    fn root(&self, mut inside: DVec2, mut outside: DVec2) -> DVec2 {
        // Doubles have no more digits than this to halve.
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if middle == inside || middle == outside {
                break;
            }
            if self.inside(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        0.5 * (inside + outside)
    }

    /// Roots joined by chords that deviate by less than the tolerance.
    fn refined(&self, points: &[DVec2], tolerance: f64, cell: f64) -> Vec<DVec2> {
        let mut refined = Vec::with_capacity(2 * points.len());
        for (i, &a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            refined.push(a);
            // Depth first, left before right.
            let mut pending = vec![(a, b, 0)];
            while let Some((a, b, depth)) = pending.pop() {
                let mut found = None;
                if depth < DEEPEST && a.distance(b) > 0.5 * tolerance {
                    found = self.across(a, b, cell);
                }
                match found {
                    // An S has its middle on the chord: halved once, it has not.
                    Some((p, away)) if away > 0.5 * tolerance || depth == 0 => {
                        pending.push((p, b, depth + 1));
                        pending.push((a, p, depth + 1));
                    }
                    _ => {
                        if b != points[(i + 1) % points.len()] {
                            refined.push(b);
                        }
                    }
                }
            }
        }
        refined
    }

    /// The point of the curve across from the middle of a chord, and how far it is from it.
    fn across(&self, a: DVec2, b: DVec2, cell: f64) -> Option<(DVec2, f64)> {
        let middle = 0.5 * (a + b);
        // The inside is to the left.
        let left = (b - a).perp().try_normalize()?;
        let inside = self.inside(middle);
        let way = if inside { -left } else { left };
        // Outwards by doubling steps, no further than the curve can be between two roots.
        let mut reach = 0.02 * a.distance(b);
        let most = a.distance(b).min(2.0 * cell);
        loop {
            let there = middle + way * reach;
            if self.inside(there) != inside {
                let p = if inside { self.root(middle, there) } else { self.root(there, middle) };
                return Some((p, p.distance(middle)));
            }
            if reach >= most {
                return None;
            }
            reach = (2.0 * reach).min(most);
        }
    }
}

/// A grid of nodes over a region, with a ring of outside about it.
struct Nodes {
    columns: Vec<f64>,
    rows: Vec<f64>,
    inside: Vec<bool>,
    cell: f64,
}

impl Nodes {
    fn new(slice: &Slice) -> Nodes {
        let PlaneBounds { min, max } = slice.region;
        let size = max - min;
        let cell = size.max_element() / CELLS;
        let axis = |from: f64, length: f64| -> Vec<f64> {
            let count = (length / cell).round().max(2.0) as u32;
            // Off the round coordinates that faces are fond of; the ring lies beyond the border.
            let inner = (0..count).map(|i| from + length * (f64::from(i) + 0.4876) / f64::from(count));
            std::iter::once(from - 0.25 * cell).chain(inner).chain([from + length + 0.25 * cell]).collect()
        };
        let (columns, rows) = (axis(min.x, size.x), axis(min.y, size.y));
        let values = slice.sampled(&slice.surface, &columns, &rows);
        let (width, height) = (columns.len(), rows.len());
        let ring = |i: usize, count: usize| i == 0 || i + 1 == count;
        let inside = values
            .iter()
            .enumerate()
            .map(|(at, v)| *v > 0.0 && !ring(at % width, width) && !ring(at / width, height))
            .collect();
        Nodes { columns, rows, inside, cell }
    }

    fn at(&self, i: u32, j: u32) -> bool {
        self.inside[j as usize * self.columns.len() + i as usize]
    }

    fn point(&self, i: u32, j: u32) -> DVec2 {
        DVec2::new(self.columns[i as usize], self.rows[j as usize])
    }

    /// The root on an edge: from node (i, j) to its right or its upper neighbour.
    fn root(&self, slice: &Slice, (i, j, upwards): Crossing) -> DVec2 {
        let (a, b) = (self.point(i, j), if upwards { self.point(i, j + 1) } else { self.point(i + 1, j) });
        if self.at(i, j) { slice.root(a, b) } else { slice.root(b, a) }
    }

    /// The pieces of contours in the cell whose lowest node is (i, j), the inside to the left.
    fn segments(&self, slice: &Slice, i: u32, j: u32) -> [Option<[Crossing; 2]>; 2] {
        // Anticlockwise: corners, and the edges that follow them.
        let corners = [self.at(i, j), self.at(i + 1, j), self.at(i + 1, j + 1), self.at(i, j + 1)];
        let edges = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
        // Going round, a piece begins where the walk leaves the inside, and ends where it
        // enters it again.
        let leaves: Vec<usize> = (0..4).filter(|&k| corners[k] && !corners[(k + 1) % 4]).collect();
        let enters: Vec<usize> = (0..4).filter(|&k| !corners[k] && corners[(k + 1) % 4]).collect();
        match (&leaves[..], &enters[..]) {
            ([out], [into]) => [Some([edges[*out], edges[*into]]), None],
            ([a, b], [_, _]) => {
                let middle = 0.5 * (self.point(i, j) + self.point(i + 1, j + 1));
                // Two corners inside across from each other: joined through the middle, or apart.
                let turn = if slice.inside(middle) { 1 } else { 3 };
                [*a, *b].map(|out| Some([edges[out], edges[(out + turn) % 4]]))
            }
            _ => [None, None],
        }
    }
}

/// The closed chain without the points that its neighbours' chord passes within `tolerance` of.
fn thinned(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::with_capacity(points.len());
    // What has been left out since the last point that was kept.
    let mut skipped: Vec<DVec2> = Vec::new();
    for (i, &p) in points.iter().enumerate() {
        let Some(&last) = kept.last() else {
            kept.push(p);
            continue;
        };
        let next = points[(i + 1) % points.len()];
        skipped.push(p);
        let chord = next - last;
        let length = chord.length();
        let off = |q: &DVec2| {
            if length == 0.0 { q.distance(last) } else { chord.perp_dot(*q - last).abs() / length }
        };
        if skipped.iter().all(|q| off(q) <= tolerance && (q - last).dot(chord) >= 0.0) {
            continue;
        }
        kept.push(p);
        skipped.clear();
    }
    kept
}
