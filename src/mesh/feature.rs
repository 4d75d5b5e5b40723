//! Feature points: where a cell holds a crease or a corner, a vertex on it.
//!
//! ```text
//!      x0                    The normals at the vertices of the cell's loop spread more than a
//!     --o---.                smooth surface's do. Their planes meet near the crease: a first p.
//!       q0 ·.\               Then the field is asked at points q on the way from p to each
//!            p x  crease     vertex, for the planes that the sides have close to p, and p moves
//!       q1 · /               to where those meet.
//!     --o---'
//!      x1
//! ```
//!
//! Vertices with nearly the same normal share a point, on the way to the middle of them.
//!
//! Each step is a damped Gauss–Newton step (see [`Planes`]) that is held in the cell. On
//! plane sides the first is exact; on curved ones the error falls from d²/2R to δ²d²/2R, with
//! d the distance of the vertices, R the radius of curvature and δ = 2/5. Where the
//! cell turns out smooth, though strongly curved, the planes are nearly the same, and p
//! ends on the surface.
//!
//! Source: L. P. Kobbelt, M. Botsch, U. Schwanecke and H.-P. Seidel, Feature sensitive surface
//! extraction from volume data (2001), for the idea.

use glam::{DVec3, UVec3, Vec3};

use super::loops::{CellLoop, LONGEST};
use super::qef::Planes;

/// Normals of a cell that differ by less than this are those of a smooth surface: the cosine
/// of the angle between them.
pub(super) const SMOOTH: f32 = 0.9;
/// The square of the cosine of half that angle, rounded up: no two normals that are closer to their mean than that
/// differ by more.
pub(super) const HALF_SMOOTH: f32 = 0.950_1;

/// Normals of vertices that are on the same side of a crease, with little between them: the cosine of 11°.
const ALIKE: f32 = 0.98;

/// How far feature points stay from the faces of their cell, in cells.
pub(super) const INSET: f64 = 1.0 / 128.0;

/// Normals of a side that is not the one that was asked for: the cosine of 45°.
const ASTRAY: f64 = 0.7;

/// The damping of the steps; it takes the distance from the crease to a hundredth a step.
const DAMPING: f64 = 3e-3;

/// Where the field is asked, as a part of the way from the feature point to a vertex. Much closer, and what
/// is found is the side of the crease that the first point missed it to.
const CLOSER: f64 = 0.4;

/// A value and a gradient of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slope {
    /// The value, in length units.
    pub value: f64,
    /// The gradient, inward.
    pub gradient: DVec3,
}

/// Whether two of some normals differ as those of a crease do.
pub(super) fn differ(normals: &[Vec3]) -> bool {
    for (n, a) in normals.iter().enumerate() {
        for b in &normals[..n] {
            if a.dot(*b) <= SMOOTH {
                return true;
            }
        }
    }
    false
}

/// A vertex of a cell's loop.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    /// Its number.
    pub(super) vertex: u32,
    /// Its position in cells, from the cell's first node.
    pub(super) at: Vec3,
    /// The outward normal there; later that which its side has close to the feature point, 0 if it is not
    /// known.
    pub(super) normal: Vec3,
}

/// A cell whose surface is not smooth. Positions are in cells, from the lattice's first node.
///
/// The vertices of its loop, in order, are in a list of those of many cells.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) cell: [u32; 3],
    pub(super) outline: CellLoop,
    /// The place of the first of its vertices in the list.
    pub(super) first: u32,
    /// The segments, from vertex n to the next, whose ends have different normals, as bits.
    pub(super) split: u16,
    /// The feature point.
    pub(super) at: DVec3,
    /// The sides' planes close to it.
    pub(super) planes: Planes,
}

impl Candidate {
    /// The cell with a first feature point. `sides` are the vertices on the edges of the loop, in order.
    pub(super) fn new(cell: [u32; 3], outline: CellLoop, first: u32, sides: &[Side]) -> Candidate {
        let mut candidate = Candidate { cell, outline, first, split: 0, at: DVec3::ZERO, planes: Planes::NONE };
        let low = candidate.low();
        for (n, side) in sides.iter().enumerate() {
            let (position, normal) = (low + side.at.as_dvec3(), side.normal.as_dvec3());
            candidate.at += position / sides.len() as f64;
            if let Some(normal) = normal.try_normalize() {
                candidate.planes.add(normal, normal.dot(position));
            }
            let next = sides.get(n + 1).unwrap_or(&sides[0]).normal;
            candidate.split |= u16::from(side.normal.dot(next) < SMOOTH) << n;
        }
        candidate.settle();
        candidate
    }

    #[inline(always)]
    fn low(&self) -> DVec3 {
        UVec3::from_array(self.cell).as_dvec3()
    }

    /// The vertices of the loop, in order, of the list of all.
    #[inline(always)]
    pub(super) fn sides<'a>(&self, all: &'a [Side]) -> &'a [Side] {
        &all[self.first as usize..][..self.outline.len()]
    }

    fn settle(&mut self) {
        self.at = settle(&self.planes, self.at, self.low(), self.low() + 1.0, 1);
    }
}

/// The direction of a crease, by the normals around it, if there are two sides and no more.
pub(super) fn crease(normals: impl Iterator<Item = Vec3> + Clone) -> Option<DVec3> {
    let (mut along, mut most) = (Vec3::ZERO, 0.0);
    for (n, a) in normals.clone().enumerate() {
        for b in normals.clone().take(n) {
            let across = a.cross(b);
            let square = across.length_squared();
            if square >= most {
                (along, most) = (across, square);
            }
        }
    }
    let unit = along.try_normalize()?;
    // A third side would have a normal along the crease of the two.
    let two = along.length() > 0.3 && normals.clone().all(|normal| normal.dot(unit).abs() < 0.2);
    two.then(|| unit.as_dvec3())
}

/// The point of a box of cells, clear of its faces, that the planes lead to in some steps.
pub(super) fn settle(planes: &Planes, from: DVec3, low: DVec3, high: DVec3, steps: usize) -> DVec3 {
    (0..steps).fold(from, |at, _| planes.nearest(at, DAMPING, low + INSET, high - INSET))
}

/// Vertices of a cell that have nearly the same normal as the first of them.
#[derive(Clone, Copy, Default)]
struct Group {
    normal: Vec3,
    sum: Vec3,
    size: f32,
}

/// The plane that the surface has close to a point: its outward normal and its distance from the lattice's first
/// node; `None` if the field does not tell.
fn plane(point: DVec3, slope: &Slope, step: f64) -> Option<(DVec3, f64)> {
    let steepness = slope.gradient.length();
    let depth = slope.value / (steepness * step);
    // A plane that is farther away than the cell tells nothing; neither does NaN.
    (steepness > 0.0 && depth.abs() < 1.0).then(|| {
        let normal = -slope.gradient / steepness;
        (normal, normal.dot(point) + depth)
    })
}

/// Moves feature points closer to the creases. `sides` are the vertices of all candidates, one candidate's after the
/// other's. `slopes` tells values and gradients at points, for cells of size `step`; without any, the points stay.
pub(super) fn refine(
    candidates: &mut [Candidate],
    sides: &mut [Side],
    step: f64,
    mut slopes: impl FnMut(&[DVec3], &mut Vec<Slope>) -> bool,
) {
    if candidates.is_empty() {
        return;
    }
    // Vertices that have nearly the same normal are on the same side: they share a point.
    let mut places: Vec<u8> = Vec::with_capacity(sides.len());
    let (mut points, mut found) = (Vec::with_capacity(sides.len()), Vec::new());
    for candidate in candidates.iter() {
        let mut groups = [Group::default(); LONGEST];
        let mut count = 0;
        for side in candidate.sides(sides) {
            let place = groups[..count].iter().position(|group| group.normal.dot(side.normal) > ALIKE).unwrap_or(count);
            if place == count {
                groups[count].normal = side.normal;
                count += 1;
            }
            groups[place].sum += side.at;
            groups[place].size += 1.0;
            places.push(place as u8);
        }
        let (low, at) = (candidate.low(), candidate.at);
        for Group { sum, size, .. } in &groups[..count] {
            points.push(at + CLOSER * (low + (sum / size).as_dvec3() - at));
        }
    }
    if !slopes(&points, &mut found) || found.len() != points.len() {
        return;
    }
    let mut asked = points.iter().zip(&found);
    let mut sides = sides.iter_mut().zip(places);
    for candidate in candidates.iter_mut() {
        let (mut planes, low) = (Planes::NONE, candidate.low());
        let (mut known, mut seen) = ([None; LONGEST], 0);
        for (side, place) in sides.by_ref().take(candidate.outline.len()) {
            let place = usize::from(place);
            // They are met in the order of their first vertices.
            if place == seen {
                known[place] = asked.next().and_then(|(point, slope)| plane(*point, slope, step));
                seen += 1;
            }
            let own = side.normal.as_dvec3();
            match known[place] {
                Some((normal, offset)) if normal.dot(own) > ASTRAY => {
                    side.normal = normal.as_vec3();
                    planes.add(normal, offset);
                }
                // The point has come out on another side of the crease.
                Some(_) => planes.add(own, own.dot(low + side.at.as_dvec3())),
                None => {}
            }
        }
        if !planes.is_empty() {
            candidate.planes = planes;
            candidate.settle();
        }
    }
}
