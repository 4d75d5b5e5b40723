//! Points of faces on a side of the surface that no edge of the cells crosses.
//!
//! ```text
//!     +-----x-----+      s and t are on two sides, whose planes meet in x. The face between two cells, seen
//!     |    / \    |      from one of them: if x is outside, there is a third side between the two, and the
//!     |   /-u-\   |      segment s–t becomes s–u–t, with u in the middle of what is of that side in the face.
//!     |  /     \  |
//!     s-/- - - -\-t
//!     +-----------+
//! ```
//!
//! The loops of both cells have u then. A face has one only if s–t is the only segment in it: s–u–t
//! is a path in the face then that meets the face's boundary in its ends alone, and what
//! [`sharp`](super::sharp) says of fans holds.

use glam::{Vec2, Vec3, Vec3A};

use super::Sampler;
use super::probe::{Probe, is_beyond};
use super::samples::{Samples, cell_number, split_cell};
use super::sharp::Fans;
use super::span::Span;
use crate::mesh::feature::{INSET, Segment};

/// How often the place where the surface crosses the way to x is narrowed down.
const STEPS: usize = 8;

/// How close to the surface u is, in cells.
const CLOSE: f32 = 0.02;

/// What u may be off from the plane of the third side, as the cosine of the angle of the normals.
const ALIKE: f32 = 0.95;

/// A face between two cells that have a fan each, with a single segment.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Face {
    /// The fan of the lower cell and that of the upper one.
    pub(super) fans: [u32; 2],
    axis: usize,
    /// The lower cell.
    cell: [u32; 3],
    /// The ends of the segment, as the lower fan's loop has them.
    pub(super) ends: [u32; 2],
}

impl Fans {
    /// The faces of a fan whose segments may skip a third side.
    pub(super) fn faces(&self, samples: &Samples<'_>, fan: u32, faces: &mut Vec<Face>) {
        let own = &self.fans[fan as usize];
        let ring = self.of(fan as usize);
        for (n, segment) in ring.iter().enumerate() {
            let to = ring.get(n + 1).unwrap_or(&ring[0]).from;
            let is_creased = samples.normal(segment.from).dot(samples.normal(to)) < samples.crease.smooth;
            let mut cell = segment.cell(own.span.low);
            let is_beside = |other: &&Segment| other.face == segment.face && other.cell(own.span.low) == cell;
            if !is_creased || ring.iter().filter(is_beside).count() > 1 {
                continue;
            }
            let (axis, is_upper) = (usize::from(segment.face / 2), segment.face % 2 == 1);
            let below = cell;
            let Some(at) = cell[axis].checked_add_signed(if is_upper { 1 } else { -1 }) else { continue };
            cell[axis] = at;
            let (block, within) = split_cell(cell);
            let Some(block) = samples.find_near(own.block as usize, block) else { continue };
            let Some(other) = self.of_cell(block, cell_number(within)) else { continue };
            faces.push(match is_upper {
                true => Face { fans: [fan, other], axis, cell: below, ends: [segment.from, to] },
                false => Face { fans: [other, fan], axis, cell, ends: [to, segment.from] },
            });
        }
    }
}

/// Where two lines meet, each given by a point and a normal.
fn meet([(p, m), (q, n)]: [(Vec2, Vec2); 2]) -> Option<Vec2> {
    let area = m.perp_dot(n);
    let (c, d) = (m.dot(p), n.dot(q));
    let is_clear = area.abs() > 1e-3 * m.length() * n.length();
    is_clear.then(|| Vec2::new(c * n.y - d * m.y, d * m.x - c * n.x) / area)
}

impl Face {
    /// The point on the third side, with the normal there, if there is one.
    pub(super) fn third<S: Sampler>(
        &self,
        samples: &Samples<'_>,
        probe: &mut Probe<'_, S>,
        near: usize,
    ) -> Option<(Vec3, Vec3)> {
        let (step, across) = (probe.step, [(self.axis + 1) % 3, (self.axis + 2) % 3]);
        let span = Span::single(self.cell);
        let low = samples.node(self.cell);
        let flat = |p: Vec3A| Vec2::new(p[across[0]], p[across[1]]);
        let lifted = |p: Vec2| {
            let mut at = Vec3A::ONE;
            (at[across[0]], at[across[1]]) = (p.x, p.y);
            at
        };
        let [(s, m), (t, n)] = self.ends.map(|end| {
            let (position, normal) = samples.get(end);
            (flat(Vec3A::from(position - low) / step), Vec3A::from(normal))
        });
        let held = |p: Vec2| p.clamp(Vec2::splat(INSET), Vec2::splat(1.0 - INSET));
        let start = held(0.5 * (s + t));
        let way = meet([(s, flat(m)), (t, flat(n))])? - start;
        // As far as it is in the face.
        let room = Vec2::select(way.cmpgt(Vec2::ZERO), 1.0 - INSET - start, start - INSET) / way.abs();
        let mut last = room.min_element().min(1.0);
        let mut beyond = probe.at(near, &span, lifted(start + last * way))?;
        if !is_beyond(&beyond, samples.crease.part * CLOSE * step) {
            return None;
        }
        let (mut first, mut before) = (0.0, probe.at(near, &span, lifted(start))?);
        // The false position, with halving of what stays.
        let mut found = None;
        let mut side = 0;
        for _ in 0..STEPS {
            if before.value * beyond.value >= 0.0 {
                return None;
            }
            let by = first + (last - first) * before.value / (before.value - beyond.value);
            let at = start + by * way;
            let slope = probe.at(near, &span, lifted(at))?;
            if !is_beyond(&slope, 0.1 * samples.crease.part * CLOSE * step) {
                found = Some((at, slope));
                break;
            }
            if slope.value * before.value > 0.0 {
                (first, before) = (by, slope);
                beyond.value *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
            } else {
                (last, beyond) = (by, slope);
                before.value *= if side == 2 { 0.5 } else { 1.0 };
                side = 2;
            }
        }
        let (mut at, slope) = found?;
        let (mut normal, _) = slope.surface(step)?;
        if normal.dot(m).max(normal.dot(n)) >= samples.crease.smooth {
            return None;
        }
        let third = (at, flat(normal));
        if let (Some(a), Some(b)) = (meet([(s, flat(m)), third]), meet([(t, flat(n)), third])) {
            let middle = held(0.5 * (a + b));
            let slope = probe.at(near, &span, lifted(middle))?;
            if let Some((other, depth)) = slope.surface(step)
                && depth.abs() <= samples.crease.part * CLOSE
                && other.dot(normal) > ALIKE
            {
                (at, normal) = (middle, other);
            }
        }
        let mut position = samples.limited(low + step * Vec3::from(lifted(at)));
        let (first, last) = (samples.node(span.low), samples.node(span.high));
        for n in across {
            let inset = INSET * step;
            position[n] = position[n].clamp((first[n] + inset).next_up(), (last[n] - inset).next_down());
        }
        position[self.axis] = last[self.axis];
        position.is_finite().then_some((position, normal.into()))
    }
}
