//! Triangles that fill a polygon.
//!
//! ```text
//!     ---*---------------     Between the heights of two corners that follow each other no edge begins
//!       / \      *            or ends, so that those that are there bound trapezia, two by two; each
//!     -/---\----/-\------     goes on for as long as both of its edges are side by side.
//! ```

use std::collections::HashMap;

use glam::DVec2;
use rvachev_num::{Cancelled, Run, order};

use super::Polygon;
use super::edge::Edge;

/// For each triangle so many edges may be gone through.
const EFFORT: usize = 64;

impl Polygon {
    /// The edges of the border, from corner to corner, with the inside on the left.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> {
        self.border().edges.iter().map(|edge| [edge.start, edge.end])
    }

    /// Triangles that fill it, counter-clockwise, whose corners may be on sides of others; nothing
    /// if they are more than `most`, or take much longer to find than so many do.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn triangles(&self, most: usize, run: &Run) -> Result<Option<Vec<[DVec2; 3]>>, Cancelled> {
        let mut edges: Vec<&Edge> = self.border().edges.iter().filter(|edge| edge.start.y != edge.end.y).collect();
        let low = |edge: &Edge| edge.start.y.min(edge.end.y);
        order::rising(&mut edges, |edge| low(edge));
        let mut heights: Vec<f64> = edges.iter().flat_map(|edge| [edge.start.y, edge.end.y]).collect();
        order::numbers(&mut heights);
        heights.dedup();
        let mut rest = edges.into_iter().peekable();
        let (mut here, mut open, mut found): (Vec<&Edge>, Vec<Trapezium<'_>>, _) = (Vec::new(), Vec::new(), Vec::new());
        let mut passed = 0;
        for from in heights.iter().copied() {
            run.check()?;
            here.retain(|edge| edge.start.y.max(edge.end.y) > from);
            while let Some(edge) = rest.next_if(|edge| low(edge) <= from) {
                here.push(edge);
            }
            // Just above, where none of them meet.
            let above = here.iter().map(|edge| edge.start.y.max(edge.end.y)).chain(rest.peek().map(|edge| low(edge)));
            let middle = 0.5 * (from + above.fold(f64::INFINITY, f64::min));
            order::rising(&mut here, |a| across(a, middle));
            let mut next: Vec<Trapezium<'_>> =
                here.chunks_exact(2).map(|sides| Trapezium { sides: [sides[0], sides[1]], from }).collect();
            let places: HashMap<_, _> = next.iter().enumerate().map(|(at, own)| (own.key(), at)).collect();
            for own in open {
                match places.get(&own.key()) {
                    // It goes on.
                    Some(at) => next[*at].from = own.from,
                    None => own.fill(from, &mut found),
                }
            }
            open = next;
            passed += here.len();
            if found.len() > most || passed > EFFORT.saturating_mul(most) {
                return Ok(None);
            }
        }
        Ok(Some(found))
    }
}

/// What is between two edges, from a height on.
struct Trapezium<'a> {
    sides: [&'a Edge; 2],
    from: f64,
}

impl Trapezium<'_> {
    /// What tells its edges from others.
    fn key(&self) -> [*const Edge; 2] {
        self.sides.map(std::ptr::from_ref)
    }

    /// Its triangles, up to a height.
    fn fill(&self, to: f64, found: &mut Vec<[DVec2; 3]>) {
        let at = |side: usize, y: f64| DVec2::new(across(self.sides[side], y), y);
        let [a, b, c, d] = [at(0, self.from), at(1, self.from), at(1, to), at(0, to)];
        found.extend((a.x < b.x).then_some([a, b, c]));
        found.extend((d.x < c.x).then_some([a, c, d]));
    }
}

/// Where an edge is at a height.
fn across(edge: &Edge, y: f64) -> f64 {
    if y == edge.end.y {
        return edge.end.x;
    }
    edge.start.x + (y - edge.start.y) / (edge.end.y - edge.start.y) * (edge.end.x - edge.start.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_fill_all_of_it() {
        let frame = [[0.0, 0.0], [4.0, 0.5], [4.0, 3.0], [0.0, 3.0]];
        let window = [[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.5]];
        let star = (0..10).map(|k| {
            let (angle, r) = (0.628 * f64::from(k) + 0.1, if k % 2 == 0 { 3.0 } else { 1.0 });
            [r * angle.cos(), r * angle.sin()]
        });
        for polygon in [Polygon::new([frame, window]), Polygon::new([star.collect::<Vec<_>>()])] {
            let triangles = polygon.triangles(100, &Run::default()).unwrap().unwrap();
            let twice: f64 = triangles.iter().map(|[a, b, c]| (*b - *a).perp_dot(*c - *a)).sum();
            assert!((0.5 * twice - polygon.area()).abs() < 1e-12, "{polygon:?}");
            assert!(triangles.iter().all(|[a, b, c]| (*b - *a).perp_dot(*c - *a) > 0.0));
            assert_eq!(polygon.edges().count(), polygon.edge_count());
            assert!(polygon.triangles(3, &Run::default()).unwrap().is_none());
        }
    }
    #[test]
    fn combs_whose_teeth_end_at_heights_of_their_own_are_given_up_and_cancelled() {
        let teeth = 2000;
        let tooth = |k: i32| [[f64::from(k), 0.0], [f64::from(k) + 0.5, 10.0 + f64::from(k) / 1e3]];
        let mut comb: Vec<[f64; 2]> = (0..teeth).flat_map(tooth).collect();
        comb.extend([[f64::from(teeth), 0.0], [f64::from(teeth), -1.0], [0.0, -1.0]]);
        let comb = Polygon::new([comb]);
        assert!(comb.triangles(1 << 14, &Run::default()).unwrap().is_none());
        let run = Run::default();
        run.cancel.cancel();
        assert_eq!(comb.triangles(1 << 20, &run), Err(Cancelled));
    }
}
