//! Where tangent planes meet: points on creases and in corners.
//!
//! ```text
//!     minimise  Σ (nᵢ·x − dᵢ)² + λ |x − s|²
//! ```
//!
//! Planes of one side of a crease count once, however many there are. The second term holds the
//! point where the planes leave it free, along a crease.

use glam::{DMat3, DVec3};

use super::facets::CREASE;
use crate::mesh::Slope;

/// The weight of where the point is.
const DAMPING: f64 = 1e-4;

/// A tangent plane n·x = d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: DVec3,
    pub(super) d: f64,
}

impl Plane {
    /// That of a linear function with a slope; none where it has no gradient.
    pub(super) fn of(at: DVec3, slope: &Slope) -> Option<Plane> {
        let normal = slope.normal();
        (normal != DVec3::ZERO).then(|| Plane { normal, d: normal.dot(at + slope.newton()) })
    }

    pub(super) fn distance(&self, p: DVec3) -> f64 {
        (self.normal.dot(p) - self.d).abs()
    }

    fn is_like(&self, other: &Plane) -> bool {
        self.normal.distance(other.normal) < CREASE
    }
}

/// Planes that were seen now, and of those before them the other face's, if all are of one: beside a
/// crease whose sides are not looked at from near enough only the greater of both values is seen,
/// on both sides. One face after the other, each alone, leads to the crease slowly or not at all.
pub(super) fn with_known(mut seen: Vec<Plane>, known: &[Plane]) -> Vec<Plane> {
    if let [first, ..] = seen[..]
        && seen.iter().all(|own| own.is_like(&first))
    {
        seen.extend(known.iter().filter(|own| !own.is_like(&first)));
    }
    seen
}

/// A step onto the surface from a point with a slope, the planes of earlier ones being known. Beside
/// a hollow edge these lead from one face to the other and back, so it goes to where both meet.
pub(super) fn slide(from: DVec3, slope: &Slope, known: &mut Vec<Plane>) -> DVec3 {
    *known = with_known(Plane::of(from, slope).into_iter().collect(), known);
    if known.len() > 1 { meet(known, from) } else { from + slope.newton() }
}

/// The point near `from` where planes meet.
pub(super) fn meet(planes: &[Plane], from: DVec3) -> DVec3 {
    let sides = sides(planes);
    let mut point = from;
    // Each step takes what the damping has left to its square.
    for _ in 0..2 {
        let mut matrix = DMat3::from_diagonal(DVec3::splat(DAMPING));
        let mut fall = DVec3::ZERO;
        for Plane { normal: n, d } in &sides {
            matrix += DMat3::from_cols(*n * n.x, *n * n.y, *n * n.z);
            fall += *n * (d - n.dot(point));
        }
        point += matrix.inverse() * fall;
    }
    point
}

/// One plane for each side: the mean of those whose normals are alike.
fn sides(planes: &[Plane]) -> Vec<Plane> {
    let mut sides: Vec<(Plane, f64)> = Vec::new();
    for plane in planes {
        let alike = |(side, count): &&mut (Plane, f64)| (side.normal / *count).distance(plane.normal) < CREASE;
        match sides.iter_mut().find(alike) {
            Some((side, count)) => {
                side.normal += plane.normal;
                side.d += plane.d;
                *count += 1.0;
            }
            None => sides.push((*plane, 1.0)),
        }
    }
    let mean = |(side, _): &(Plane, f64)| {
        let length = side.normal.length();
        Plane { normal: side.normal / length, d: side.d / length }
    };
    sides.iter().map(mean).collect()
}
