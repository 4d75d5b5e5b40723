//! Corners that are one but for rounding, and corners that are on an edge but for rounding.
//!
//! ```text
//!        |  |                 |/            A drawing that is turned, or written with 15 digits, has its corners
//!     ---+ +---     ->     ---+---          beside where they were meant. Corners nearer than the rounding are
//!        |/                   |             one; an edge that passes a corner so near leads through it.
//! ```
//!
//! What is moved is moved by no more than the rounding at a time, and nothing is moved where
//! nothing is so near. Then all is exact again: see [`sweep`](super::sweep).
//!
//! Source: J. D. Hobby, *Practical segment intersection with finite precision output* (1999),
//! without a grid.

use glam::DVec2;
use rvachev_num::{Cancelled, Run};

use super::edge::Edge;
use super::tree::Tree;

/// What of the size of a drawing is rounding, and what of how far it is from the origin.
const OF_SIZE: f64 = 2e-12;
const OF_PLACE: f64 = 8.0 * f64::EPSILON;

/// An edge that leads through a corner may come to pass others as near: it is looked at again so
/// often.
const ROUNDS: usize = 8;

/// Corners between two questions whether to go on.
const OFTEN: usize = 1024;

/// How near to each other corners of these contours are one.
pub(super) fn rounding(contours: &[Vec<DVec2>]) -> f64 {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for p in contours.iter().flatten() {
        (low, high) = (low.min(*p), high.max(*p));
    }
    (OF_SIZE * (high - low).max_element()).max(OF_PLACE * low.abs().max(high.abs()).max_element())
}

/// The corners, from left to right, without those that are near another one; and of each the number
/// of the one that stands for it.
pub(super) fn joined(points: impl Iterator<Item = DVec2>, rounding: f64) -> (Vec<DVec2>, Vec<u32>) {
    let (mut kept, mut stands): (Vec<DVec2>, _) = (Vec::new(), Vec::new());
    // Those that are not yet left behind, by their heights.
    let (mut first, mut near) = (0, std::collections::BTreeMap::<(u64, u32), u32>::new());
    let key = |y: f64| {
        let bits = y.to_bits();
        if y.is_sign_negative() { !bits } else { bits | 1 << 63 }
    };
    for p in points {
        while kept.get(first).is_some_and(|other: &DVec2| other.x < p.x - rounding) {
            near.remove(&(key(kept[first].y), first as u32));
            first += 1;
        }
        let beside = near.range((key(p.y - rounding), 0)..=(key(p.y + rounding), u32::MAX));
        let one = beside.map(|(_, number)| *number).find(|number| kept[*number as usize].distance(p) <= rounding);
        stands.push(one.unwrap_or_else(|| {
            let number = kept.len() as u32;
            kept.push(p);
            near.insert((key(p.y), number), number);
            number
        }));
    }
    (kept, stands)
}

/// An edge from a corner to another, and its number among those that were given.
pub(super) type Way = ([u32; 2], u32);

/// Edges as they lead through all corners that they pass within rounding.
pub(super) fn led(corners: &[DVec2], mut ways: Vec<Way>, rounding: f64, run: &Run) -> Result<Vec<Way>, Cancelled> {
    for _ in 0..ROUNDS {
        let edge = |(ends, _): &Way| {
            let [a, b] = ends.map(|end| corners[end as usize]);
            Edge::new(a, b)
        };
        let mut edges: Vec<(Edge, u32)> = ways.iter().map(edge).zip(0..).collect();
        run.check()?;
        let tree = Tree::build(&mut edges, |(edge, _)| edge);
        run.check()?;
        // The corners that each edge is to lead through, by how far along they are.
        let mut through: Vec<(u32, f64, u32)> = Vec::new();
        for (corner, p) in (0u32..).zip(corners) {
            if (corner as usize).is_multiple_of(OFTEN) {
                run.check()?;
            }
            tree.within(*p, rounding, |at| {
                let (edge, number) = &edges[at];
                let [from, to] = ways[*number as usize].0;
                let along = (*p - edge.start).dot(edge.along);
                let is_between = along > 0.0 && along < (edge.end - edge.start).length();
                if from != corner && to != corner && is_between && edge.distance(*p) <= rounding {
                    through.push((*number, along, corner));
                }
                true
            });
        }
        if through.is_empty() {
            break;
        }
        through.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut parted = Vec::with_capacity(ways.len() + through.len());
        let mut rest = through.into_iter().peekable();
        for (number, ([from, to], edge)) in (0u32..).zip(ways) {
            let mut here = from;
            while let Some((_, _, corner)) = rest.next_if(|(other, ..)| *other == number) {
                parted.push(([here, corner], edge));
                here = corner;
            }
            parted.push(([here, to], edge));
        }
        ways = parted;
    }
    Ok(ways)
}
