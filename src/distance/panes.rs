//! Panes: flat patches of one plane that hang together, as a few large ones (mesh decimation within
//! planes).
//!
//! ```text
//!     .__.__.__.__.           .___________.
//!     |\ |\ |\ |\ |           |\_         |
//!     |_\|_\|_\|_\|    ->     |  \___     |
//!     |\ |\ |\ |\ |           |      \__  |
//!     |_\|_\|_\|_\|           |_________\_|
//! ```
//!
//! A vertex within a pane goes to one of its neighbours, and so does one that is between two others
//! on a straight rim, as long as no triangle turns over or gets slender. The rim stays as it is: it
//! is what neighbours are sewn to.

use glam::{DVec2, DVec3};

use super::piece::Piece;
use super::quilt::often;
use super::seam::Seams;
use crate::{Cancelled, Run};

/// Vertices may be off their pane by this part of the tolerance, and off a straight rim.
pub(super) const OFF: f64 = 0.02;

/// Twice the area of a triangle is no less than this part of the square of its longest side.
const SLENDER: f64 = 0.02;

/// No triangle, and no vertex.
const NONE: u32 = u32::MAX;

/// Triangles of a pane, and how far they are off the surface.
pub(super) struct Pane {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) off: f64,
}

/// The panes of flat pieces that are so far off the surface, whose vertices may be so far off their
/// planes.
pub(super) fn panes(
    flat: &[(Piece, f64)],
    positions: &[DVec3],
    seams: &Seams,
    slack: f64,
    run: &Run,
) -> Result<Vec<Pane>, Cancelled> {
    // By side, the pieces on either side of it; of more than two none is the other's neighbour.
    let mut beside = vec![[NONE; 2]; seams.list.len()];
    for (number, (piece, _)) in flat.iter().enumerate() {
        for hem in piece.hems {
            let place = &mut beside[hem.seam as usize][hem.side];
            *place = if *place == NONE { number as u32 } else { NONE - 1 };
        }
    }
    let mut pane_of = vec![NONE; flat.len()];
    let mut own = vec![NONE; positions.len()];
    let mut panes = Vec::new();
    for first in 0..flat.len() {
        often(first, run)?;
        if pane_of[first] != NONE {
            continue;
        }
        let number = panes.len() as u32;
        let mut plane = Plane::of(flat[first].0.corners.map(|v| positions[v as usize]));
        let mut pieces = vec![first];
        pane_of[first] = number;
        let mut at = 0;
        while at < pieces.len() {
            for hem in flat[pieces[at]].0.hems {
                let next = beside[hem.seam as usize][1 - hem.side] as usize;
                if pane_of.get(next) != Some(&NONE) {
                    continue;
                }
                let corners = flat[next].0.corners.map(|v| positions[v as usize]);
                if plane.is_along(corners, slack) {
                    plane.take(corners);
                    pane_of[next] = number;
                    pieces.push(next);
                }
            }
            at += 1;
        }
        let triangles: Vec<[u32; 3]> = pieces.iter().map(|n| flat[*n].0.corners).collect();
        let bend = triangles.iter().flatten().map(|v| plane.off(positions[*v as usize])).fold(0.0, f64::max);
        let off = pieces.iter().map(|n| flat[*n].1).fold(0.0, f64::max);
        // The plane is known the better the more of it there is: those that were taken first may be
        // off it.
        panes.push(match bend <= slack && triangles.len() > 2 {
            true => Pane { triangles: fewer(triangles, &plane, positions, slack, &mut own), off: off + 2.0 * bend },
            false => Pane { triangles, off },
        });
    }
    Ok(panes)
}

/// The mean plane of triangles: their middle, and a normal as long as twice their area.
struct Plane {
    middle: DVec3,
    normal: DVec3,
    area: f64,
}

impl Plane {
    fn of(corners: [DVec3; 3]) -> Plane {
        let mut plane = Plane { middle: DVec3::ZERO, normal: DVec3::ZERO, area: 0.0 };
        plane.take(corners);
        plane
    }

    fn take(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        let middle = (a + b + c) / 3.0;
        self.area += area;
        self.middle = if self.area > 0.0 { self.middle + (middle - self.middle) * (area / self.area) } else { middle };
        self.normal += normal;
    }

    fn off(&self, p: DVec3) -> f64 {
        self.normal.normalize_or_zero().dot(p - self.middle).abs()
    }

    /// Whether a triangle is in the plane, and turned as that is.
    fn is_along(&self, corners: [DVec3; 3], slack: f64) -> bool {
        let [a, b, c] = corners;
        (b - a).cross(c - a).dot(self.normal) > 0.0 && corners.iter().all(|p| self.off(*p) <= slack)
    }
}

/// Fewer triangles that cover the same part of a plane.
fn fewer(triangles: Vec<[u32; 3]>, plane: &Plane, positions: &[DVec3], slack: f64, own: &mut [u32]) -> Vec<[u32; 3]> {
    let (along, across) = plane.normal.normalize_or_zero().any_orthonormal_pair();
    let mut sheet = Sheet::default();
    let mut vertices = Vec::new();
    for triangle in triangles {
        let corners = triangle.map(|v| {
            let place = &mut own[v as usize];
            if *place == NONE {
                *place = vertices.len() as u32;
                vertices.push(v);
                let p = positions[v as usize] - plane.middle;
                sheet.points.push(DVec2::new(p.dot(along), p.dot(across)));
            }
            *place
        });
        sheet.triangles.push(corners);
    }
    vertices.iter().for_each(|v| own[*v as usize] = NONE);
    sheet.collapse(slack);
    sheet.triangles.iter().filter(|t| t[0] != NONE).map(|t| t.map(|v| vertices[v as usize])).collect()
}

/// Triangles of a plane; those that are no more have no vertices.
#[derive(Default)]
struct Sheet {
    points: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
}

impl Sheet {
    /// Takes vertices out, in rounds: no two that are neighbours in the same one, so that triangles
    /// grow alike.
    fn collapse(&mut self, slack: f64) {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.points.len()];
        for (number, triangle) in self.triangles.iter().enumerate() {
            triangle.iter().for_each(|v| around[*v as usize].push(number as u32));
        }
        let mut open: Vec<u32> = (0..self.points.len() as u32).collect();
        let mut touched = vec![0u32; self.points.len()];
        let mut round = 0;
        let mut gone = 1;
        while gone > 0 {
            (round, gone) = (round + 1, 0);
            open.retain(|&v| {
                if touched[v as usize] == round {
                    return true;
                }
                let Some(to) = self.target(v, &around[v as usize], slack) else { return true };
                for number in std::mem::take(&mut around[v as usize]) {
                    let triangle = &mut self.triangles[number as usize];
                    triangle.iter().for_each(|corner| touched[*corner as usize] = round);
                    if triangle.contains(&to) {
                        for corner in triangle.iter().filter(|corner| **corner != v) {
                            around[*corner as usize].retain(|own| *own != number);
                        }
                        *triangle = [NONE; 3];
                    } else {
                        triangle.iter_mut().filter(|corner| **corner == v).for_each(|corner| *corner = to);
                        around[to as usize].push(number);
                    }
                }
                gone += 1;
                false
            });
        }
    }

    /// The neighbour that a vertex may go to, if there is one: that which leaves the least slender
    /// triangles.
    fn target(&self, v: u32, around: &[u32], slack: f64) -> Option<u32> {
        // Around it, from one neighbour to the next.
        let step = |number: &u32| {
            let [a, b, c] = self.triangles[*number as usize];
            if a == v {
                [b, c]
            } else if b == v {
                [c, a]
            } else {
                [a, b]
            }
        };
        let steps = || around.iter().map(step);
        let mut first = steps().filter(|[from, _]| !steps().any(|[_, to]| to == *from)).map(|[from, _]| from);
        let mut last = steps().filter(|[_, to]| !steps().any(|[from, _]| from == *to)).map(|[_, to]| to);
        let point = |v: u32| self.points[v as usize];
        let quality = |target: u32| {
            let left = steps().filter(|[a, b]| *a != target && *b != target);
            left.map(|[a, b]| quality([point(target), point(a), point(b)])).fold(f64::INFINITY, f64::min)
        };
        let better = |targets: &mut dyn Iterator<Item = u32>| {
            let all = targets.map(|target| (quality(target), target)).filter(|(own, _)| *own > SLENDER);
            all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, target)| target)
        };
        match (first.next(), last.next()) {
            (None, None) => better(&mut steps().map(|[from, _]| from)),
            (Some(a), Some(b)) if first.next().is_none() && last.next().is_none() => {
                let (from, way) = (point(a), point(b) - point(a));
                let part = (point(v) - from).dot(way) / way.length_squared();
                let is_between = part > 0.0 && part < 1.0 && (from + part * way).distance(point(v)) <= slack;
                if is_between { better(&mut [a, b].into_iter()) } else { None }
            }
            // Where parts meet in a point.
            _ => None,
        }
    }
}

/// Twice the area of a triangle in squares of its longest side; negative if it is turned over.
fn quality([a, b, c]: [DVec2; 3]) -> f64 {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    if longest > 0.0 { (b - a).perp_dot(c - a) / longest } else { 0.0 }
}
