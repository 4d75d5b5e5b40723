//! From chosen leaves to the result: names, measures, what is left over.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};

use super::super::deviations::Deviation;
use super::super::error::FitError;
use super::bits::WORD;
use super::body::Body;
use super::intent::Meant;
use super::leaf::Leaf;
use super::places::places;
use super::queries::MARGIN;
use super::refine::owner;
use super::repeated::repeated;
use super::result::{PartFit, PartLeaf, Snap, Topology, Unexplained};
use super::samples::Samples;
use super::seen::seen;
use super::sobol::Sobol;
use super::times::PartTimes;
use super::words::describe;
use crate::{Bounds, Run};
use rvachev_num::{jobs, order};

/// Points that the volumes in common are estimated from.
const POINTS: usize = 1 << 14;

/// Points that one thread asks for at a time.
const CHUNK: usize = 256;

/// Wrong points are of one place if their cells touch, so many of them along the diagonal.
const PLACES: f64 = 24.0;

/// Places with less wrong volume are not told of, as a share of the part's.
const TOLD: f64 = 1e-3;

/// The result for leaves in diagonals about the centre.
pub(super) fn finish(
    leaves: &[(bool, Leaf)],
    meant: Vec<Meant>,
    body: &Body,
    samples: &Samples,
    known: &[u64],
    topology: Topology,
    run: &Run,
) -> Result<PartFit, FitError> {
    let size = samples.size;
    let mut shares = vec![0.0; leaves.len()];
    let mut distances = Vec::with_capacity(samples.points.len());
    for (p, weight) in samples.points.iter().zip(&samples.weights) {
        let (owner, distance) = owner(leaves, *p);
        shares[owner.unwrap_or(0)] += weight;
        distances.push(size * distance);
    }
    let (iou, unexplained) = compared(leaves, body, samples, known, run)?;
    let seen = seen(leaves, samples, run)?;
    let (mut leaves, snaps) = named(leaves, meant, &shares, &seen);
    let (solid, patterns) = repeated(&leaves, size).ok_or(FitError::NoSurface { inliers: 0.0 })?;
    describe(&mut leaves, size);
    solid.bounds()?;
    let topology_of_input = body.topology;
    let deviation = Deviation::of(distances.into_iter());
    Ok(PartFit {
        leaves,
        solid,
        patterns,
        snaps,
        iou,
        deviation,
        topology,
        topology_of_input,
        unexplained,
        times: PartTimes::default(),
    })
}

/// The leaves in length units, called by their kinds, and what was changed of them.
fn named(leaves: &[(bool, Leaf)], meant: Vec<Meant>, shares: &[f64], seen: &[f64]) -> (Vec<PartLeaf>, Vec<Snap>) {
    let mut counts: BTreeMap<(&'static str, bool), usize> = BTreeMap::new();
    let (mut named, mut snaps) = (Vec::new(), Vec::new());
    for ((((adds, _), Meant { leaf, changes }), surface), seen) in leaves.iter().zip(meant).zip(shares).zip(seen) {
        let kind = leaf.kind();
        let count = counts.entry((kind, *adds)).or_insert(0);
        *count += 1;
        let name = if *adds { format!("{kind} {count}") } else { format!("cut {kind} {count}") };
        snaps.extend(changes.iter().map(|change| Snap::of(named.len(), change)));
        let text = String::new();
        named.push(PartLeaf {
            adds: *adds,
            leaf,
            name,
            tilt: DAffine3::IDENTITY,
            text,
            surface: *surface,
            seen: *seen,
        });
    }
    (named, snaps)
}

/// The volume in common over that of either, and the places where they differ.
fn compared(
    leaves: &[(bool, Leaf)],
    body: &Body,
    samples: &Samples,
    known: &[u64],
    run: &Run,
) -> Result<(f64, Vec<Unexplained>), FitError> {
    let Samples { centre, size, .. } = *samples;
    let bounds = body.bounds;
    let margin = MARGIN * bounds.size();
    let (low, span) = (bounds.min - margin, bounds.size() + 2.0 * margin);
    let points: Vec<DVec3> = Sobol::new().take(POINTS).map(|p| low + span * p).collect();
    // Of the first points it is known whether they are inside.
    let contains = |i: usize, p: DVec3| match known.get(i / WORD) {
        Some(word) => word >> (i % WORD) & 1 == 1,
        None => body.contains(p),
    };
    let sides = |(nth, chunk): (usize, &[DVec3])| {
        run.check()?;
        let side = |(i, p): (usize, &DVec3)| {
            let local = (*p - centre) / size;
            let found = leaves.iter().fold(
                false,
                |inside, (adds, leaf)| {
                    if inside != *adds && leaf.contains(local) { *adds } else { inside }
                },
            );
            [contains(nth * CHUNK + i, *p), found]
        };
        Ok::<Vec<_>, FitError>(chunk.iter().enumerate().map(side).collect())
    };
    let sides: Vec<Vec<[bool; 2]>> = jobs::try_chunks(&points, CHUNK, |nth, chunk| sides((nth, chunk)))?;
    let (mut both, mut either, mut filled) = (0_usize, 0_usize, 0_usize);
    // Those that are missing apart from those that are too many.
    let mut wrong = [Vec::new(), Vec::new()];
    for (p, [there, found]) in points.iter().zip(sides.into_iter().flatten()) {
        both += usize::from(there && found);
        either += usize::from(there || found);
        filled += usize::from(there);
        if there != found {
            wrong[usize::from(found)].push(((*p - centre) / size, *p));
        }
    }
    let iou = both as f64 / either.max(1) as f64;
    let mut told = Vec::new();
    for (wrong, missing) in wrong.into_iter().zip([true, false]) {
        for place in places(wrong, 1.0 / PLACES) {
            let share = place.len() as f64 / filled.max(1) as f64;
            if share > TOLD {
                let points = || place.iter().map(|(_, p)| *p);
                let bounds = Bounds::new(
                    points().fold(DVec3::INFINITY, DVec3::min),
                    points().fold(DVec3::NEG_INFINITY, DVec3::max),
                );
                told.push(Unexplained { bounds, share, missing });
            }
        }
    }
    order::falling(&mut told, |a| a.share);
    Ok((iou, told))
}
