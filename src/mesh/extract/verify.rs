//! Every feature point is verified by the field, and repaired where it is off the surface.
//!
//! A point that fits the planes of its loop's vertices misses what these do not tell: a side
//! between two others that no edge of the cell crosses. And a cell that two creases pass has no
//! point that fits. In order:
//!
//! 1. The fans are found whose points are off the surface, or far from their planes.
//! 2. Their loops get a vertex on the [third side](super::third), in each face where they skip one,
//!    as do those beyond.
//! 3. A cell whose loop goes over a narrow side twice is cut in two [halves](super::halves), if
//!    both points are on the surface then.
//! 4. Another point that is [too far](super::probe::OFF) off is moved onto the surface: the creases
//!    are cut off by it, but nothing sticks out.
//!
//! All is decided fan by fan and face by face: it does not depend on the number of threads.

use std::collections::BTreeMap;

use glam::{Vec3, Vec3A};

use super::Sampler;
use super::halves::{Cut, Half};
use super::probe::{DOUBTFUL, OFF, Probe, is_beyond};
use super::samples::Samples;
use super::sharp::{AT_ONCE, Fan, Fans};
use super::third::Face;
use crate::mesh::feature::{Crease, Segment, Slope, settle, tangents};
use crate::{Cancelled, Run};
use rvachev_num::jobs;

/// Fans that are looked at together.
const FEW: usize = 32;

/// What becomes of a fan.
enum Repaired {
    /// It stays, but for its loop if that is new.
    Same,
    /// Its point is moved.
    Moved(Vec3),
    /// It becomes two.
    Cut { at: [Vec3; 2], half: Half, cut: Cut },
}

impl Fans {
    /// Verifies all points, and repairs the fans of those that are off.
    pub(super) fn verify<S: Sampler>(
        &mut self,
        samples: &Samples<'_>,
        sampler: &S,
        run: &Run,
    ) -> Result<(), Cancelled> {
        let doubtful = self.doubtful(samples, sampler, run)?;
        let mut faces: Vec<Face> = Vec::new();
        doubtful.iter().for_each(|&(fan, _)| self.faces(samples, fan, &mut faces));
        faces.sort_unstable();
        faces.dedup();
        let thirds = self.each(samples, sampler, run, &faces, |probe, face| {
            face.third(samples, probe, self.fans[face.fans[0] as usize].block as usize)
        })?;
        // The loops that have other vertices, and whether points are off.
        let mut rings: BTreeMap<u32, (Option<Vec<Segment>>, bool)> = BTreeMap::new();
        rings.extend(doubtful.into_iter().map(|(fan, off)| (fan, (None, off))));
        for (face, third) in faces.iter().zip(thirds) {
            let Some((position, normal)) = third else { continue };
            let number = self.first_third + self.thirds.len() as u32;
            let [s, t] = face.ends;
            let mut is_added = false;
            for (fan, from) in [(face.fans[0], s), (face.fans[1], t)] {
                let own = self.of(fan as usize);
                let ring = &mut rings.entry(fan).or_default().0;
                let ring = ring.get_or_insert_with(|| own.to_vec());
                if let Some(n) = ring.iter().position(|segment| segment.from == from) {
                    let mut added = ring[n];
                    (added.from, added.normal) = (number, normal);
                    ring.insert(n + 1, added);
                    is_added = true;
                }
            }
            if is_added {
                self.thirds.push((position, normal));
            }
        }
        let changed: Vec<(u32, Option<Vec<Segment>>, bool)> =
            rings.into_iter().map(|(fan, (ring, off))| (fan, ring, off)).collect();
        let repaired = self.each(samples, sampler, run, &changed, |probe, (fan, ring, off)| {
            self.repaired(samples, probe, *fan, (ring.as_deref(), *off))
        })?;
        let mut list: Vec<Segment> = Vec::new();
        for ((fan, ring, _), repaired) in changed.into_iter().zip(repaired) {
            self.repair(fan, ring, repaired, (&mut list, samples.crease));
        }
        self.segments.push(list);
        Ok(())
    }

    /// What a function tells of each of some things, in their order.
    fn each<S: Sampler, T: Sync, U: Send>(
        &self,
        samples: &Samples<'_>,
        sampler: &S,
        run: &Run,
        all: &[T],
        tell: impl Fn(&mut Probe<'_, S>, &T) -> U + Sync,
    ) -> Result<Vec<U>, Cancelled> {
        let of_chunk = |probe: &mut Probe<'_, S>, _, chunk: &[T]| {
            run.check()?;
            Ok(chunk.iter().map(|one| tell(probe, one)).collect::<Vec<U>>())
        };
        let found: Result<Vec<Vec<U>>, Cancelled> =
            jobs::try_chunks_with(all, FEW, || Probe::new(samples, sampler), of_chunk);
        Ok(found?.into_iter().flatten().collect())
    }

    /// The fans whose points are off the surface, or do not fit their planes; and whether they are
    /// off.
    fn doubtful<S: Sampler>(
        &self,
        samples: &Samples<'_>,
        sampler: &S,
        run: &Run,
    ) -> Result<Vec<(u32, bool)>, Cancelled> {
        let of_chunk = |probe: &mut Probe<'_, S>, chunk: usize, fans: &[Fan]| {
            run.check()?;
            let (mut found, mut points) = (Vec::new(), Vec::new());
            let mut number = (chunk * AT_ONCE) as u32;
            for fans in fans.chunk_by(|a, b| a.block == b.block && a.span.is_single() && b.span.is_single()) {
                let block = fans[0].block as usize;
                let step = probe.step;
                let mut note = |n: usize, fan: &Fan, slope: Option<&Slope>| {
                    let is = |part: f32| slope.is_some_and(|slope| is_beyond(slope, part * step));
                    let is_doubtful = fan.is_loose || is(samples.crease.part * DOUBTFUL);
                    found.extend(is_doubtful.then(|| (number + n as u32, is(OFF))));
                };
                match fans {
                    // The point of a region may be in another block.
                    [region] => note(0, region, probe.at(block, &region.span, place(samples, region)).as_ref()),
                    _ => {
                        let low = samples.node(samples.blocks()[block]);
                        points.clear();
                        points.extend(fans.iter().map(|fan| Vec3A::from(fan.at - low) / step));
                        let slopes = probe.of_block(block, &points);
                        fans.iter().enumerate().for_each(|(n, fan)| note(n, fan, slopes.get(n)));
                    }
                }
                number += fans.len() as u32;
            }
            Ok(found)
        };
        let found: Result<Vec<Vec<(u32, bool)>>, Cancelled> =
            jobs::try_chunks_with(&self.fans, AT_ONCE, || Probe::new(samples, sampler), of_chunk);
        Ok(found?.into_iter().flatten().collect())
    }

    /// What becomes of a fan that is off, does not fit, or has another loop.
    fn repaired<S: Sampler>(
        &self,
        samples: &Samples<'_>,
        probe: &mut Probe<'_, S>,
        number: u32,
        (ring, off): (Option<&[Segment]>, bool),
    ) -> Repaired {
        let fan = &self.fans[number as usize];
        let (near, span) = (fan.block as usize, &fan.span);
        let low = samples.node(span.low);
        let is_new = ring.is_some();
        let ring = ring.unwrap_or_else(|| self.of(number as usize));
        let positions: Vec<Vec3> = ring.iter().map(|segment| self.position(samples, segment.from)).collect();
        let places: Vec<Vec3A> = positions.iter().map(|&at| Vec3A::from(at - low) / probe.step).collect();
        let (planes, _) = tangents(&mut ring.to_vec(), &places, samples.crease, |_| ());
        let inside = |at: Vec3A| samples.inside(at, span.low, span.high);
        let back = |at: Vec3| Vec3A::from(at - low) / samples.lattice.step() as f32;
        let own = place(samples, fan);
        if let Some(cut) = Cut::best(ring, &places, span.size(), samples.crease) {
            let at = cut.at.map(inside);
            let fits_better = off || cut.residual < 0.5 * planes.distance(own);
            if fits_better
                && let Some(half) = cut.half(&positions, at, samples.lattice.step())
                && !at.iter().any(|&at| probe.is_off(near, span, back(at)))
            {
                return Repaired::Cut { at, half, cut };
            }
        }
        if !off && !is_new {
            return Repaired::Same;
        }
        let middle = places.iter().sum::<Vec3A>() / places.len() as f32;
        if is_new {
            let at = settle(&planes, middle, [Vec3A::ZERO, span.size()], (3, samples.crease));
            if !probe.is_off(near, span, at) {
                return Repaired::Moved(inside(at));
            }
        }
        if !off {
            return Repaired::Same;
        }
        Repaired::Moved(inside(probe.onto(near, span, own, [middle, places[0]])))
    }

    /// Changes a fan, given its loop if that is new; loops that are new go into a list of their
    /// own.
    fn repair(
        &mut self,
        number: u32,
        ring: Option<Vec<Segment>>,
        repaired: Repaired,
        (list, crease): (&mut Vec<Segment>, Crease),
    ) {
        let mut add = |ring: &mut [Segment]| {
            let count = ring.len();
            let normals: Vec<Vec3> = ring.iter().map(|segment| segment.normal).collect();
            for (n, segment) in ring.iter_mut().enumerate() {
                segment.turns = segment.across().is_none() && normals[n].dot(normals[(n + 1) % count]) < crease.smooth;
            }
            let start = list.len() as u32;
            list.extend_from_slice(ring);
            let normal = normals.iter().sum::<Vec3>().normalize_or(normals[0]);
            (start..list.len() as u32, normal)
        };
        let lists = self.segments.len() as u32;
        let at = match repaired {
            Repaired::Cut { at, half, cut } => {
                let twin = self.fans.len() as u32;
                let own = ring.as_deref().unwrap_or_else(|| self.of(number as usize));
                let [mut ring, mut others] = cut.rings(own, [number, twin]);
                let (segments, normal) = add(&mut others);
                let Fan { block, span, .. } = self.fans[number as usize];
                let other = Some(Box::new(half.other(number)));
                self.fans.push(Fan {
                    list: lists,
                    segments,
                    block,
                    span,
                    at: at[1],
                    normal,
                    is_loose: false,
                    half: other,
                });
                let (segments, normal) = add(&mut ring);
                let fan = &mut self.fans[number as usize];
                (fan.list, fan.segments, fan.normal) = (lists, segments, normal);
                fan.half = Some(Box::new(half.with_twin(twin)));
                Some(at[0])
            }
            Repaired::Moved(_) | Repaired::Same => {
                if let Some(mut ring) = ring {
                    let (segments, normal) = add(&mut ring);
                    let fan = &mut self.fans[number as usize];
                    (fan.list, fan.segments, fan.normal) = (lists, segments, normal);
                }
                if let Repaired::Moved(at) = repaired { Some(at) } else { None }
            }
        };
        if let Some(at) = at {
            self.fans[number as usize].at = at;
        }
    }
}

/// The point of a fan, in cells from the first node of its box.
fn place(samples: &Samples<'_>, fan: &Fan) -> Vec3A {
    Vec3A::from(fan.at - samples.node(fan.span.low)) / samples.lattice.step() as f32
}
