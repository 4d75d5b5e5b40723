//! Extruded profiles among the candidates: what sections between parallel planes show.
//!
//! ```text
//!      |      |   |          planes across a direction bound slabs; the section in the middle of a slab
//!      | - - -|- -|          is of outer rings, which are added, and inner ones, which are cut;
//!      |______|___|          they end at any two of the planes that have the slab between them;
//!                            bays of outer rings are cut as well
//! ```

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::bases::{Base, Grain, apart, bases, polygon};
use super::bays::bays;
use super::bits::Bits;
use super::body::Body;
use super::candidates::BEYOND;
use super::directions::about;
use super::leaf::{Leaf, Shape};
use super::outline::Outline;
use super::pool::Pool;
use super::queries::Queries;
use super::regions::{Form, Regions};
use super::samples::{Kind, Samples};
use super::sections::{Ring, area};
use super::settings::PartKinds;
use crate::{Cancelled, Cuboid, Gielis, Prism, Rectangle, Run, Superpolygon};

/// Directions at most, and slabs of each.
const DIRECTIONS: usize = 5;
const SLABS: usize = 12;

/// Planes that are nearer to each other are one; planes across a direction, as a cosine.
const THIN: f64 = 0.003;
const ACROSS: f64 = 0.9998;

/// Pairs of ends of a profile at most.
const PAIRS: usize = 10;

/// Rings whose corners are nearer than this to each other are one, in diagonals.
const SAME: f64 = 0.004;

/// Rings of less area are left out, in squares of the diagonal.
const LEAST: f64 = 1e-5;

/// Bays of less area are left out, what reaches out of the ring included.
const WIDE: f64 = 1e-3;

/// Rectangles turned by less, in radians, are left to the boxes.
const ALONG: f64 = 0.004;

/// A ring with the slabs that it is in.
struct Prismatic {
    ring: Ring,
    slabs: [usize; 2],
}

/// Puts the profiles that sections show among the candidates.
pub(super) fn propose(
    pool: &mut Pool,
    body: &Body,
    samples: &Samples,
    regions: &Regions,
    queries: &Queries,
    kinds: PartKinds,
    run: &Run,
) -> Result<(), Cancelled> {
    let grain = match samples.kind {
        Kind::Cad => Grain { tolerance: 0.0018, short: 0.0 },
        Kind::Voxels => Grain { tolerance: 0.003, short: 0.018 },
        Kind::Scan => Grain { tolerance: f64::max(0.004, 1.5 * samples.noise), short: 0.035 },
    };
    let all = directions(samples, regions);
    for (i, (frame, planes)) in all.iter().enumerate() {
        run.report(i as f64 / all.len() as f64);
        for prismatic in prismatics(body, samples, frame, planes, run)? {
            run.check()?;
            let adds = prismatic.ring.area > 0.0;
            for base in bases(&prismatic.ring.points, grain) {
                push(pool, frame, &base, (adds, prismatic.slabs), planes, queries, kinds);
            }
            if adds {
                let corners = polygon(&prismatic.ring.points, grain);
                // Where corners were cut off they are not among the points.
                let ring = if grain.short == 0.0 { &prismatic.ring.points } else { &corners };
                for bay in bays(ring, &corners, BEYOND) {
                    run.check()?;
                    let cuts = if area(&bay) > WIDE { bases(&bay, grain) } else { Vec::new() };
                    for base in cuts.iter().filter(|base| !matches!(base, Base::Supershape { .. })) {
                        push(pool, frame, base, (false, prismatic.slabs), planes, queries, kinds);
                    }
                }
            }
        }
    }
    Ok(())
}

/// Directions that most of the planes face, each with the heights that slabs end at.
fn directions(samples: &Samples, regions: &Regions) -> Vec<(DMat3, Vec<f64>)> {
    let mut found: Vec<(f64, DMat3, Vec<f64>)> = Vec::new();
    for axis in regions.frames.iter().flat_map(|frame| [frame.x_axis, frame.y_axis, frame.z_axis]) {
        let frame = about(axis);
        if found.iter().any(|f| f.1.z_axis.dot(frame.z_axis).abs() > ACROSS) {
            continue;
        }
        let across = regions.regions.iter().filter_map(|region| match region.form {
            Form::Plane { normal, offset } if normal.dot(frame.z_axis).abs() > ACROSS => {
                Some((offset * normal.dot(frame.z_axis).signum(), region.share))
            }
            _ => None,
        });
        let mut planes: Vec<f64> = across.clone().map(|plane| plane.0).collect();
        let share: f64 = across.map(|plane| plane.1).sum();
        if planes.is_empty() {
            continue;
        }
        let heights = || samples.points.iter().map(|p| p.dot(frame.z_axis));
        planes.extend([heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)]);
        order::numbers(&mut planes);
        planes.dedup_by(|a, b| *a - *b < THIN);
        found.push((share, frame, planes));
    }
    order::falling(&mut found, |a| a.0);
    found.truncate(DIRECTIONS);
    found.into_iter().map(|(_, frame, planes)| (frame, planes)).collect()
}

/// The rings of the slabs; such as go on in the next slab once.
fn prismatics(
    body: &Body,
    samples: &Samples,
    frame: &DMat3,
    planes: &[f64],
    run: &Run,
) -> Result<Vec<Prismatic>, Cancelled> {
    let mut slabs: Vec<usize> = (0..planes.len().saturating_sub(1)).collect();
    order::falling(&mut slabs, |i| planes[i + 1] - planes[*i]);
    slabs.truncate(SLABS);
    slabs.sort_unstable();
    let mut found: Vec<Prismatic> = Vec::new();
    for slab in slabs {
        run.check()?;
        for ring in body.section(samples, frame, 0.5 * (planes[slab] + planes[slab + 1])) {
            if ring.area.abs() < LEAST {
                continue;
            }
            let is_same = |known: &&mut Prismatic| {
                known.slabs[1] + 1 == slab
                    && (known.ring.area - ring.area).abs() < 0.02 * ring.area.abs()
                    && apart(&ring.points, &known.ring.points) < SAME
                    && apart(&known.ring.points, &ring.points) < SAME
            };
            match found.iter_mut().find(is_same) {
                Some(known) => known.slabs[1] = slab,
                None => found.push(Prismatic { ring, slabs: [slab; 2] }),
            }
        }
    }
    Ok(found)
}

/// Where a profile may end: at the slabs that its ring is in, then farther and farther out.
fn ends([first, last]: [usize; 2], planes: &[f64], adds: bool) -> Vec<[f64; 2]> {
    let top = planes.len() - 1;
    let mut pairs: Vec<[usize; 2]> =
        (0..=first).flat_map(|low| (last + 1..=top).map(move |high| [low, high])).collect();
    order::rising(&mut pairs, |[low, high]| ((first - low) + (high - last - 1)) as f64);
    pairs.truncate(PAIRS);
    // Cuts reach through the outermost planes.
    let low = |i: usize| if i == 0 && !adds { planes[0] - BEYOND } else { planes[i] };
    let high = |i: usize| if i == top && !adds { planes[top] + BEYOND } else { planes[i] };
    pairs.into_iter().map(|[a, b]| [low(a), high(b)]).collect()
}

/// Puts a base with all its ends among the candidates.
fn push(
    pool: &mut Pool,
    frame: &DMat3,
    base: &Base,
    (adds, slabs): (bool, [usize; 2]),
    planes: &[f64],
    queries: &Queries,
    kinds: PartKinds,
) {
    let may = [adds, !adds];
    let Some(Extruded { shape, angle, centre }) = extruded(base, kinds) else { return };
    let rotation = *frame * DMat3::from_rotation_z(angle);
    let leaf = |[low, high]: [f64; 2]| Leaf {
        shape: shape(high - low),
        rotation,
        centre: *frame * DVec3::new(centre.x, centre.y, 0.5 * (low + high)),
    };
    let ends = ends(slabs, planes, adds);
    let Some(longest) = ends.iter().copied().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else { return };
    // What is within the longest one is asked once.
    let longest = leaf(longest);
    let heights: Vec<f64> = queries.points.iter().map(|p| p.dot(frame.z_axis)).collect();
    let within = Bits::of(&queries.points, |p| longest.contains(p));
    let family = pool.family();
    for [low, high] in ends {
        let between = Bits::new(heights.len(), |i| heights[i] > low && heights[i] < high);
        pool.push(leaf([low, high]), within.and(&between), may, family);
    }
}

/// What a base is extruded to.
struct Extruded {
    /// Of a height.
    shape: Box<dyn Fn(f64) -> Shape>,
    /// How far its x axis is turned.
    angle: f64,
    centre: DVec2,
}

/// What a base is extruded to, if that may be used.
fn extruded(base: &Base, kinds: PartKinds) -> Option<Extruded> {
    let of = |shape: Box<dyn Fn(f64) -> Shape>, angle, centre| Some(Extruded { shape, angle, centre });
    match base {
        Base::Outline(Outline { corners, radii }) if kinds.profiles => {
            let centre = corners.iter().sum::<DVec2>() / corners.len() as f64;
            let corners = corners.iter().map(|corner| *corner - centre).collect();
            let outline = Outline { corners, radii: radii.clone() };
            of(Box::new(move |height| Shape::Profile { outline: outline.clone(), height }), 0.0, centre)
        }
        &Base::Rounded { centre, angle, size, radius } => {
            let is_box = radius == 0.0;
            if is_box && angle.abs() < ALONG || !(if is_box { kinds.boxes } else { kinds.profiles }) {
                return None;
            }
            let shape: Box<dyn Fn(f64) -> Shape> = if is_box {
                Box::new(move |height| Shape::Box(Cuboid { size: size.extend(height) }))
            } else {
                Box::new(move |height| Shape::RoundedRectangle { base: Rectangle { size, radius }, height })
            };
            of(shape, angle, centre)
        }
        &Base::Regular { centre, angle, sides, radius } if kinds.prisms => {
            of(Box::new(move |height| Shape::Prism(Prism::new(sides, radius, height))), angle, centre)
        }
        &Base::Supershape { centre, angle, m, n: [n1, n2], radius } if kinds.supershapes => {
            let base = Superpolygon::new(Gielis::new(f64::from(m), n1, n2, n2), radius);
            of(Box::new(move |height| Shape::Supershape { base: base.clone(), height }), angle, centre)
        }
        _ => None,
    }
}
