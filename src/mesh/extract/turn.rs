//! Edges between fans, turned along creases.
//!
//! Let A and B have the face F in common, with fans from a and b, and let s–t be the only segment
//! in F and the line a–b cross F in a point x of its interior. The triangles (a, s, b) and (b, t,
//! a) that take the place of (s, t, a) and (t, s, b) are, within A, the cone from a over the path
//! s–x–t, and within B that from b. The path is simple, as s and t lie in the boundary of F, and it
//! meets no other segment, as F has none: so all is as before, with the path in place of the
//! segment. Faces may be turned in any number and order, as paths of different faces do not meet.
//!
//! [Regions](super::region) of several cells have fans as well, and what two fans have in common is
//! a rectangle of faces then. That, like an ambiguous face, may hold several segments, and the path
//! s–x–t may be in the way of another: of the segments whose ends have different normals, the one
//! closest to x is turned, if the path is clear of all others by more than the rounding. Two fans
//! have no more than one edge in common so. Where the line a–b misses the rectangle, x is the point
//! of it next to the line, and a vertex: the two loops are s–x–t there.

use glam::{DVec2, DVec3, Vec3, Vec3A};

use super::Sampler;
use super::probe::Probe;
use super::samples::{Samples, cell_number, split_cell};
use super::sharp::{AT_ONCE, Fan, Fans};
use crate::mesh::feature::{INSET, Segment};
use crate::{Cancelled, Run};
use rvachev_num::jobs;

impl Fans {
    /// Finds out which edges between fans are turned, and to what.
    pub(super) fn turn<S: Sampler>(
        &mut self,
        (samples, sampler): (&Samples<'_>, &S),
        run: &Run,
    ) -> Result<(), Cancelled> {
        let all = &*self;
        let of_fans = |probe: &mut Probe<'_, S>, n: usize, fans: &[Fan]| {
            run.check()?;
            let mut found = Vec::with_capacity(fans.len());
            for (low, fan) in (n * AT_ONCE..).zip(fans) {
                let ring = all.of(low);
                // Of two fans the lower one sees to it.
                let turns = |&nth: &usize| ring[nth].turns & (ring[nth].face % 2 == 1);
                let turned = |nth| all.turned(samples, probe, (low, fan), ring, nth);
                found.extend((0..ring.len()).filter(turns).filter_map(turned));
            }
            Ok(found)
        };
        let found: Result<Vec<Vec<Turned>>, Cancelled> =
            jobs::try_chunks_with(&all.fans, AT_ONCE, || Probe::new(samples, sampler), of_fans);
        let fans = self.fans.len() as u32;
        for Turned { fans: [low, high], segments, at } in found?.into_iter().flatten() {
            let places = [(low, segments[0]), (high, segments[1])].map(|(fan, nth)| {
                let fan = &self.fans[fan as usize];
                (fan.list as usize, fan.segments.start as usize + usize::from(nth))
            });
            let across = match at {
                None => [high, low],
                Some(at) => {
                    let normals = places.map(|(list, n)| self.segments[list][n].normal);
                    self.bend([low, high], *at, (normals[0] + normals[1]).normalize_or(normals[0]));
                    [fans + self.points.len() as u32 - 1; 2]
                }
            };
            for ((list, segment), across) in places.into_iter().zip(across) {
                self.segments[list][segment].turn(across);
            }
        }
        Ok(())
    }

    /// What the edge between two fans is turned to, at segment `nth` in the ring of the lower one,
    /// if it is: one that turns, in an upper face.
    fn turned<S: Sampler>(
        &self,
        samples: &Samples<'_>,
        probe: &mut Probe<'_, S>,
        (low, below): (usize, &Fan),
        ring: &[Segment],
        nth: usize,
    ) -> Option<Turned> {
        let segment = &ring[nth];
        let axis = usize::from(segment.face / 2);
        let mut cell = segment.cell(below.span.low);
        cell[axis] += 1;
        let (block, within) = split_cell(cell);
        let high = self.of_cell(samples.find_near(below.block as usize, block)?, cell_number(within))?;
        let next = |n: usize| ring.get(n + 1).unwrap_or(&ring[0]).from;
        // Where a segment is in the ring of an upper fan, the other way round.
        let within = |n: usize, high: u32| {
            let others = self.of(high as usize);
            let ends = |at: usize| (others[at].from, others.get(at + 1).unwrap_or(&others[0]).from);
            (0..others.len()).find(|&at| ends(at) == (next(n), ring[n].from) && others[at].face + 1 == segment.face)
        };
        // A cell that is cut has two fans.
        let twin = self.fans[high as usize].half.as_ref().map(|half| half.twin);
        let (high, other) =
            [Some(high), twin].into_iter().flatten().find_map(|high| Some((high, within(nth, high)?)))?;
        let above = &self.fans[high as usize];
        let (a, b) = (below.at.as_dvec3(), above.at.as_dvec3());
        // What the two have in common: a part of a plane of the lattice.
        let mut shared = below.span.intersection(&above.span);
        (shared.low[axis], shared.high[axis]) = (above.span.low[axis], above.span.low[axis]);
        let (first, last) = (samples.node(shared.low).as_dvec3(), samples.node(shared.high).as_dvec3());
        let x = a + (b - a) * ((first[axis] - a[axis]) / (b[axis] - a[axis]));
        // More than the rounding of the line above.
        let margin = 1e-12 * first.abs().max(last.abs()).max_element();
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        let is_straight = across.into_iter().all(|n| x[n] > first[n] + margin && x[n] < last[n] - margin);
        let flat = |p: DVec3| DVec2::new(p[across[0]], p[across[1]]);
        let (aim, straight) = (flat(x), x);
        // A line that misses it is bent.
        let mut bent = Vec3::ZERO;
        let x = if is_straight {
            aim
        } else {
            bent = samples.limited(x.as_vec3());
            let inset = INSET * samples.lattice.step() as f32;
            for n in across {
                let (low, high) = (first[n] as f32, last[n] as f32);
                bent[n] = bent[n].clamp((low + inset).next_up(), (high - inset).next_down());
            }
            bent[axis] = first[axis] as f32;
            flat(bent.as_dvec3())
        };
        // It has to be in the part of the face that the halves of cells have.
        let crossing = if is_straight { straight } else { bent.as_dvec3() };
        let least = 4.0 * margin;
        if [below, above].iter().filter_map(|fan| fan.half.as_ref()).any(|half| !half.has(crossing, least)) {
            return None;
        }
        // Where the segments are that both fans have in it.
        let is_shared = |n: &usize| {
            let cell = ring[*n].cell(below.span.low);
            ring[*n].face == segment.face
                && cell[axis] + 1 == shared.low[axis]
                && across.iter().all(|&n| (shared.low[n]..shared.high[n]).contains(&cell[n]))
        };
        let common = || (0..ring.len()).filter(is_shared);
        let place = |vertex: u32| (vertex, flat(self.position(samples, vertex).as_dvec3()));
        let ends = |n: usize| [place(ring[n].from), place(next(n))];
        // Most often there is no other.
        let is_alone = ring.iter().filter(|other| other.face == segment.face).count() == 1;
        let others = || common().filter(|&n| n != nth);
        // The edge can take the place of one of them: that which it is closest to.
        let distance = |n: usize| {
            let [(_, s), (_, t)] = ends(n);
            (t - s).perp_dot(x - s).abs() / (t - s).length()
        };
        // The first of those that are equally close.
        let is_closer = |n: usize| distance(n).total_cmp(&distance(nth)).then(n.cmp(&nth)).is_lt();
        let is_between = |n: usize| above.half.is_none() || within(n, high).is_some();
        if !is_alone && others().any(|n| ring[n].turns && is_closer(n) && is_between(n)) {
            return None;
        }
        // A point that is no closer to the line than the segment is not worth it.
        let is_worth_it = || {
            let [(_, s), (_, t)] = ends(nth);
            (aim - x).length() < 0.5 * (aim - s).length().min((aim - t).length())
        };
        if !(is_straight || is_worth_it()) {
            return None;
        }
        let reach = 4.0 * margin * (last - first).max_element();
        let is_clear = |n: usize| ends(nth).into_iter().all(|end| is_apart([end, (NONE, x)], ends(n), reach));
        if !(is_alone || others().all(is_clear)) {
            return None;
        }
        if !is_straight {
            // A point off the surface is worse than none.
            let step = probe.step;
            let place = Vec3A::from(bent - samples.node(below.span.low)) / step;
            if probe.is_off(below.block as usize, &below.span, place) {
                return None;
            }
        }
        let segments = [nth as u16, other as u16];
        Some(Turned { fans: [low as u32, high], segments, at: (!is_straight).then(|| Box::new(bent)) })
    }
}

/// An edge between two fans that is turned: to the straight line from one feature point to the
/// other, or to a way by a point between the two.
struct Turned {
    fans: [u32; 2],
    /// The places of its segments in the rings of the two.
    segments: [u16; 2],
    /// Few have one.
    at: Option<Box<Vec3>>,
}

/// The number of a point that is no vertex.
const NONE: u32 = u32::MAX;

/// Whether two segments, by numbers and places of their ends, have no point in common but an end.
/// `reach` is more than the rounding of twice the area of a triangle.
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
