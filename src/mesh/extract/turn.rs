//! Edges between fans, turned along creases.
//!
//! Let A and B have the face F in common, with fans from a and b, and let s–t be the only
//! segment in F and the line a–b cross F in a point x of its interior. The triangles (a, s, b) and (b, t, a) that take the place of
//! (s, t, a) and (t, s, b) are, within A, the cone from a over the path s–x–t, and within B
//! that from b. The path is simple, as s and t lie in the boundary of F, and it meets no other
//! segment, as F has none: so all is as before, with the path in place of the segment. Faces
//! may be turned in any number and order, as paths of different faces do not meet.
//!
//! [Regions](super::region) of several cells have fans as well, and what two fans have in common is a
//! rectangle of faces then. That, like an ambiguous face, may hold several segments, and the path s–x–t may be
//! in the way of another: of the segments whose ends have different normals, the one closest to x is turned, if
//! the path is clear of all others by more than the rounding. Two fans have no more than one edge in common so.
//! Where the line a–b misses the rectangle, x is the point of it next to the line, and a vertex: the two loops
//! are s–x–t there.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use super::samples::{Samples, cell_number, split_cell};
use super::sharp::{Fans, Segment};
use crate::mesh::feature::INSET;
use crate::run::{Cancelled, Run};

impl Fans {
    /// Finds out which edges between fans are turned, and to what.
    pub(super) fn turn(&mut self, samples: &Samples<'_>, run: &Run) -> Result<(), Cancelled> {
        let all = &*self;
        let of_segment = |fan, segment| {
            run.check()?;
            Ok(all.across(samples, fan, segment))
        };
        let of_fan = |fan: usize| all.of(fan).iter().map(move |segment| of_segment(fan, segment));
        let turns: Result<Vec<Option<(u32, Turn)>>, Cancelled> =
            (0..all.fans.len()).into_par_iter().flat_map_iter(of_fan).collect();
        // Two fans have a point in common: it is numbered for the first, and found by the second.
        let mut known: HashMap<[u32; 2], u32> = HashMap::new();
        let fans = self.fans.len() as u32;
        let points = &mut self.points;
        for (segment, turn) in self.segments.iter_mut().zip(turns?) {
            segment.across = turn.map(|(other, turn)| match turn {
                Turn::Edge => other,
                Turn::Point { at, ends } => *known.entry(ends).or_insert_with(|| {
                    points.push(at);
                    fans + points.len() as u32 - 1
                }),
            });
        }
        Ok(())
    }

    /// The fan on the other side of a segment, if the edge between the two is turned there. Both find the same.
    fn across(&self, samples: &Samples<'_>, fan: usize, segment: &Segment) -> Option<(u32, Turn)> {
        if !segment.turns {
            return None;
        }
        let axis = usize::from(segment.face / 2);
        let mut cell = segment.cell;
        cell[axis] = if segment.face % 2 == 1 { cell[axis] + 1 } else { cell[axis].checked_sub(1)? };
        let (block, within) = split_cell(cell);
        let cells = self.cells(samples.find(block)?);
        let other = cells.binary_search_by_key(&cell_number(within), |&(cell, _)| cell).ok()?;
        let other = cells[other].1;
        Some((other, self.turned(samples, fan, other as usize, segment)?))
    }

    /// What the edge between two fans is turned to at a segment of the first, if it is.
    fn turned(&self, samples: &Samples<'_>, fan: usize, other: usize, segment: &Segment) -> Option<Turn> {
        // Both fans calculate with the same numbers in the same order.
        let (axis, upper) = (usize::from(segment.face / 2), segment.face % 2 == 1);
        let (low, high) = if upper { (fan, other) } else { (other, fan) };
        let [below, above] = [low, high].map(|fan| &self.fans[fan]);
        let (a, b) = (below.at.as_dvec3(), above.at.as_dvec3());
        // What the two have in common: a part of a plane of the lattice.
        let mut shared = below.span.intersection(&above.span);
        (shared.low[axis], shared.high[axis]) = (above.span.low[axis], above.span.low[axis]);
        let [first, last] = [shared.low, shared.high].map(|node| samples.node(node).as_dvec3());
        let x = a + (b - a) * ((first[axis] - a[axis]) / (b[axis] - a[axis]));
        // More than the rounding of the line above.
        let margin = 1e-12 * first.abs().max(last.abs()).max_element();
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        let is_straight = across.into_iter().all(|n| x[n] > first[n] + margin && x[n] < last[n] - margin);
        let flat = |p: DVec3| DVec2::new(p[across[0]], p[across[1]]);
        let aim = flat(x);
        // A line that misses it is bent.
        let mut bent = samples.limited(x).as_vec3();
        let inset = (INSET * samples.lattice.step()) as f32;
        for n in across {
            let [low, high] = [first[n] as f32, last[n] as f32];
            bent[n] = bent[n].clamp((low + inset).next_up(), (high - inset).next_down());
        }
        bent[axis] = first[axis] as f32;
        let x = if is_straight { aim } else { flat(bent.as_dvec3()) };
        // Where the segments are that both fans have in it.
        let ring = self.of(low);
        let face = 2 * axis as u8 + 1;
        let is_shared = |n: &usize| {
            let cell = ring[*n].cell;
            ring[*n].face == face
                && cell[axis] + 1 == shared.low[axis]
                && across.iter().all(|&n| (shared.low[n]..shared.high[n]).contains(&cell[n]))
        };
        let place = |vertex: u32| (vertex, flat(samples.get(vertex).0.as_dvec3()));
        let ends = |n: usize| [n, (n + 1) % ring.len()].map(|n| place(ring[n].from));
        let common = || (0..ring.len()).filter(is_shared);
        // The edge can take the place of one of them: that which it is closest to.
        let distance = |n: &usize| {
            let [(_, s), (_, t)] = ends(*n);
            (t - s).perp_dot(x - s).abs() / (t - s).length()
        };
        let nearest = common().filter(|&n| ring[n].turns).min_by(|m, n| distance(m).total_cmp(&distance(n)))?;
        let [s, t] = ends(nearest);
        if segment.from != if upper { s.0 } else { t.0 } {
            return None;
        }
        // A point that is no closer to the line than the segment is not worth it.
        let off = (aim - s.1).length().min((aim - t.1).length());
        let is_worth = is_straight || (aim - x).length() < 0.5 * off;
        if !is_worth {
            return None;
        }
        let reach = 4.0 * margin * (last - first).max_element();
        let is_clear = |n: usize| [s, t].into_iter().all(|end| is_apart([end, (NONE, x)], ends(n), reach));
        let turn = if is_straight { Turn::Edge } else { Turn::Point { at: bent, ends: [s.0, t.0] } };
        common().filter(|&n| n != nearest).all(is_clear).then_some(turn)
    }
}

/// What the edge between two fans is turned to.
#[derive(Clone, Copy)]
enum Turn {
    /// The straight line from one feature point to the other.
    Edge,
    /// A way by a point between the two; with the ends of the segment, to tell it by.
    Point { at: Vec3, ends: [u32; 2] },
}

/// The number of a point that is no vertex.
const NONE: u32 = u32::MAX;

/// Whether two segments, by numbers and places of their ends, have no point in common but an end. `reach` is more
/// than the rounding of twice the area of a triangle.
fn is_apart(one: [(u32, DVec2); 2], other: [(u32, DVec2); 2], reach: f64) -> bool {
    let area = |[(_, s), (_, t)]: [(u32, DVec2); 2], (_, p): (u32, DVec2)| (t - s).perp_dot(p - s);
    let [a, b] = other.map(|end| area(one, end));
    if one.iter().any(|(n, _)| other.iter().any(|(m, _)| n == m)) {
        // The one that is not in common is not on the line.
        return a.abs().max(b.abs()) > reach;
    }
    let [c, d] = one.map(|end| area(other, end));
    let one_side = |a: f64, b: f64| a.min(b) > reach || a.max(b) < -reach;
    one_side(a, b) || one_side(c, d)
}
