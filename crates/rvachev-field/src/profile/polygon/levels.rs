//! Which points are inside, by the edges that are side by side at their height.
//!
//! ```text
//!     --/------\-----/--     Between the heights of two corners that follow each other the edges have
//!      /   o    \   /        one order. Heights are halved and halved again, and each edge is noted
//!     /----------\-/----     with the largest parts that it goes all through: some log n of them. At
//!                           each of the log n parts that a point is in, it finds its place by halving.
//! ```
//!
//! An odd number of edges on one side of a point is what is inside. All decisions are by exact
//! arithmetic.
//!
//! Source: M. de Berg et al., *Computational Geometry* (3rd ed., 2008), 10.3 (segment trees).

use std::cmp::Ordering;

use glam::DVec2;
use rvachev_num::{Cancelled, Run};

use super::edge::Edge;
use super::sweep::{order, turn};

/// Edges by their heights.
#[derive(Debug, Default)]
pub(super) struct Levels {
    /// The heights of all corners, from the lowest.
    heights: Vec<f64>,
    /// Where the list of each part begins, and where the last one ends. The parts of part k are 2k
    /// and 2k + 1; the last half of them go from a height to the next.
    first: Vec<u32>,
    /// The numbers of each part's edges, from left to right.
    lists: Vec<u32>,
}

impl Levels {
    pub(super) fn new(edges: &[Edge], run: &Run) -> Result<Levels, Cancelled> {
        let mut heights: Vec<f64> = edges.iter().map(|edge| edge.start.y).collect();
        rvachev_num::order::numbers(&mut heights);
        heights.dedup();
        run.check()?;
        let size = heights.len().saturating_sub(1).next_power_of_two();
        let at = |height: f64| heights.partition_point(|other| *other < height);
        // Nearly in their order, which is then soon made.
        let mut order: Vec<u32> = (0u32..).zip(edges).filter(|(_, e)| e.start.y != e.end.y).map(|(i, _)| i).collect();
        let across = |number: &u32| edges[*number as usize].middle().x;
        order.sort_unstable_by(|a, b| across(a).total_cmp(&across(b)));
        run.check()?;
        let spans: Vec<[usize; 2]> =
            order.iter().map(|number| edges[*number as usize].rising().map(|end| size + at(end.y))).collect();
        let mut first = vec![0u32; 2 * size + 1];
        for part in spans.iter().flat_map(|span| parts(*span)) {
            first[part + 1] += 1;
        }
        for part in 0..2 * size {
            first[part + 1] += first[part];
        }
        run.check()?;
        let (mut next, mut lists) = (first.clone(), vec![0; first[2 * size] as usize]);
        for (number, span) in order.iter().zip(&spans) {
            for part in parts(*span) {
                lists[next[part] as usize] = *number;
                next[part] += 1;
            }
        }
        for ends in first.windows(2) {
            run.check()?;
            let list = &mut lists[ends[0] as usize..ends[1] as usize];
            list.sort_by(|a, b| from_left([a, b].map(|number| edges[*number as usize].rising())));
        }
        Ok(Levels { heights, first, lists })
    }

    /// Whether a point is inside of what has these edges; one on an edge counts as inside if the
    /// inside is to the left.
    pub(super) fn is_inside(&self, edges: &[Edge], p: DVec2) -> bool {
        let size = self.first.len() / 2;
        let above = self.heights.partition_point(|height| *height <= p.y);
        if above == 0 || above == self.heights.len() {
            return false;
        }
        let is_left = |number: &u32| {
            let [low, high] = edges[*number as usize].rising();
            turn(low, high, p) < 0.0
        };
        let (mut part, mut is_inside) = (size + above - 1, false);
        while part > 0 {
            let [from, to] = [part, part + 1].map(|part| self.first[part] as usize);
            is_inside ^= self.lists[from..to].partition_point(is_left) % 2 == 1;
            part /= 2;
        }
        is_inside
    }
}

/// The largest parts that make up what is from one of the last parts up to another.
fn parts([mut low, mut high]: [usize; 2]) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (low < high).then(|| {
            let here = [(low % 2 == 1).then_some(low), (high % 2 == 1).then_some(high - 1)];
            (low, high) = (low.div_ceil(2), high / 2);
            here
        })
    })
    .flatten()
    .flatten()
}

/// The order of two edges, ends from below, that are side by side at some height.
fn from_left([[a, b], [c, d]]: [[DVec2; 2]; 2]) -> Ordering {
    // Which side of one an end of the other is on, where it begins, or, if they begin together,
    // where it ends.
    let below = if a.y >= c.y { turn(c, d, a) } else { -turn(a, b, c) };
    let above = || if b.y <= d.y { turn(c, d, b) } else { -turn(a, b, d) };
    // What is to the left of an edge that rises is before it.
    order(below).then_with(|| order(above())).reverse()
}
