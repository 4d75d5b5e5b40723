//! Charts of what is at a distance from patches: maps of triangles and squares onto it.
//!
//! ```text
//!          \   |     |
//!           \  |     |        Beyond faces it is faces, moved; about edges canals, half from either face's side;
//!     ._     \ |     |        about corners parts of balls. Edges and corners are those whose normals point apart
//!       `.    \|_____|        on the side that it is on.
//!     ---`----'
//! ```

use glam::{DVec2, DVec3};
use rvachev_num::order;

use super::facets::CREASE;
use super::offset_faces::{Offset, Piece};
use crate::{Bounds, Cancelled, Run};

/// Beyond the edge of a face its neighbour is looked for so many tolerances away.
const BEYOND: f64 = 5.0;

/// The cosine from which on a normal is not that of a patch.
const TURNED: f64 = 0.7;

/// The cosine up to which normals are too far apart for a part of a ball between them.
const OPPOSITE: f64 = -0.7;

/// A direction of about unit length that nothing is built along.
const ACROSS: DVec3 = DVec3::new(0.5477, 0.6123, 0.5711);

/// A map of a triangle or a square onto a surface.
pub(super) enum Chart {
    /// A patch, moved: its corners and the middles of its sides.
    Face([DVec3; 6]),
    /// About a side of a patch, from the patch's normals half of the way to the neighbour's.
    Canal { side: [DVec3; 3], from: [DVec3; 3], to: [DVec3; 3], by: f64 },
    /// About a corner, between three normals.
    Ball { corner: DVec3, normals: [DVec3; 3], by: f64 },
}

/// The shape functions of a quadratic curve with ends and middle.
fn curve(u: f64) -> [f64; 3] {
    [(1.0 - u) * (1.0 - 2.0 * u), u * (2.0 * u - 1.0), 4.0 * u * (1.0 - u)]
}

/// A point by shape functions.
fn sum<const N: usize>(weights: [f64; N], points: &[DVec3; N]) -> DVec3 {
    weights.iter().zip(points).map(|(weight, p)| *weight * *p).sum()
}

impl Chart {
    pub(super) fn at(&self, at: DVec2) -> DVec3 {
        let [s, t] = at.to_array();
        match self {
            Chart::Face(nodes) => {
                let l = [1.0 - s - t, s, t];
                let corner = |i: usize| l[i] * (2.0 * l[i] - 1.0);
                let side = |i: usize| 4.0 * l[i] * l[(i + 1) % 3];
                sum([corner(0), corner(1), corner(2), side(0), side(1), side(2)], nodes)
            }
            Chart::Canal { side, from, to, by } => {
                let weights = curve(s);
                let [from, to] = [from, to].map(|normals| sum(weights, normals).normalize_or_zero());
                sum(weights, side) + *by * between(from, to, 0.5 * t)
            }
            Chart::Ball { corner, normals, by } => {
                let normal = sum([1.0 - s - t, s, t], normals).normalize_or_zero();
                *corner + *by * normal
            }
        }
    }
}

/// A part of the way from one unit vector to another, along a great circle.
fn between(from: DVec3, to: DVec3, part: f64) -> DVec3 {
    let angle = f64::atan2(from.cross(to).length(), from.dot(to));
    if angle < 1e-9 { from } else { (from * ((1.0 - part) * angle).sin() + to * (part * angle).sin()) / angle.sin() }
}

impl Offset<'_> {
    /// The charts, and the pieces that they are of.
    pub(super) fn charts(&self, run: &Run) -> Result<(Vec<Chart>, Vec<Piece>), Cancelled> {
        const NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        let reach = self.near.inflate(self.by.abs() + self.tolerance);
        let patches: Vec<[DVec3; 6]> = (0..self.patches.len())
            .map(|n| NODES.map(|at| self.patches.point(n, at)))
            .filter(|nodes| Bounds::from_points(*nodes).intersects(&reach))
            .collect();
        let beyond = BEYOND * self.tolerance;
        // Their own normals, a little inside: of what is flat they are known.
        let flat: Vec<Option<DVec3>> = patches.iter().map(|nodes| flat_normal(nodes, 1e-2 * self.tolerance)).collect();
        let mut asked = Vec::new();
        for (nodes, _) in patches.iter().zip(&flat).filter(|(_, flat)| flat.is_none()) {
            let middle = nodes[..3].iter().sum::<DVec3>() / 3.0;
            asked.extend(nodes.map(|p| p + (middle - p).clamp_length_max(beyond)));
        }
        let mut told = self.of.at(&asked, run)?.into_iter();
        let mut normals = Vec::with_capacity(patches.len());
        for flat in &flat {
            normals.push(match flat {
                Some(normal) => [*normal; 6],
                None => [(); 6].map(|()| told.next().unwrap_or_default().normal()),
            });
        }
        let (mut charts, mut pieces) = (Vec::new(), Vec::new());
        let whole = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let piece = |charts: &[Chart], corners| Piece { chart: charts.len() as u32 - 1, corners, is_trimmed: false };
        for (nodes, normals) in patches.iter().zip(&mut normals) {
            // What is narrower than places are beside edges has normals of its neighbours.
            let own = flat_normal(nodes, f64::INFINITY).unwrap_or_default();
            normals.iter_mut().filter(|normal| normal.dot(own) < TURNED).for_each(|normal| *normal = own);
            let mut moved = *nodes;
            moved.iter_mut().zip(normals).for_each(|(p, normal)| *p += self.by * *normal);
            charts.push(Chart::Face(moved));
            pieces.push(piece(&charts, whole));
        }
        let mut corners = Vec::new();
        for canal in self.canals((&patches, &normals), beyond, run)? {
            let Chart::Canal { side, from, to, .. } = &canal else { continue };
            for end in [0, 1] {
                corners.push((side[end], from[end]));
                corners.push((side[end], to[end]));
            }
            charts.push(canal);
            pieces.push(piece(&charts, [DVec2::ZERO, DVec2::X, DVec2::ONE]));
            pieces.push(piece(&charts, [DVec2::ZERO, DVec2::ONE, DVec2::Y]));
        }
        for ball in balls(corners, self.by, 0.1 * self.tolerance) {
            charts.push(ball);
            pieces.push(piece(&charts, whole));
        }
        Ok((charts, pieces))
    }

    /// The canals about sides of patches beyond which others have other normals, turned away on the
    /// side that is moved to.
    fn canals(
        &self,
        (patches, normals): (&[[DVec3; 6]], &[[DVec3; 6]]),
        beyond: f64,
        run: &Run,
    ) -> Result<Vec<Chart>, Cancelled> {
        // A part of a side: ends and middle, the normals there, and the way out of the patch.
        struct Part {
            side: [DVec3; 3],
            normals: [DVec3; 3],
            out: DVec3,
        }
        let mut parts = Vec::new();
        for (nodes, normals) in patches.iter().zip(normals) {
            for k in 0..3 {
                let next = (k + 1) % 3;
                let side = [nodes[k], nodes[next], nodes[3 + k]];
                let own = [normals[k], normals[next], normals[3 + k]];
                let count = (side[0].distance(side[1]) / (2.0 * self.cell)).ceil().clamp(1.0, 256.0);
                for n in 0..count as usize {
                    let at = [n as f64, n as f64 + 1.0, n as f64 + 0.5].map(|at| curve(at / count));
                    let side = at.map(|weights| sum(weights, &side));
                    let along = (side[1] - side[0]).normalize_or_zero();
                    let out = side[2] - nodes[(k + 2) % 3];
                    let out = (out - out.dot(along) * along).normalize_or_zero();
                    let normals = at.map(|weights| sum(weights, &own).normalize_or_zero());
                    parts.push(Part { side, normals, out });
                }
            }
        }
        let beside = |part: &Part| {
            let Part { side, normals, out } = part;
            // Ends are looked at a little inside.
            let inner = [0.02, 0.98, 0.5].map(|u| sum(curve(u), side));
            [0, 1, 2].map(|i| {
                let out = (*out - out.dot(normals[i]) * normals[i]).normalize_or_zero();
                inner[i] + beyond * out
            })
        };
        let points: Vec<DVec3> = parts.iter().flat_map(beside).collect();
        let found = self.of.at(&points, run)?;
        let mut canals = Vec::new();
        for (part, found) in parts.iter().zip(found.chunks(3)) {
            let mut to = [0, 1, 2].map(|i| found[i].normal());
            // Ends may be beside another face.
            let middle = to[2];
            to.iter_mut().filter(|normal| normal.dot(middle) < TURNED).for_each(|normal| *normal = middle);
            let turned = (0..3).any(|i| part.normals[i].distance(to[i]) > CREASE);
            // Outwards there are canals about convex edges, inwards about concave ones.
            if turned && (0..3).any(|i| self.by * to[i].dot(part.out) > 0.0) {
                canals.push(Chart::Canal { side: part.side, from: part.normals, to, by: self.by });
            }
        }
        Ok(canals)
    }
}

/// The normal of a patch, if it is flat to within a slack.
fn flat_normal(nodes: &[DVec3; 6], slack: f64) -> Option<DVec3> {
    let [a, b, c, ..] = *nodes;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let is_flat = (0..3).all(|k| nodes[3 + k].distance(0.5 * (nodes[k] + nodes[(k + 1) % 3])) <= slack);
    is_flat.then_some(normal)
}

/// Parts of balls about corners where three or more normals meet: triangles about the mean of all.
fn balls(corners: Vec<(DVec3, DVec3)>, by: f64, slack: f64) -> Vec<Chart> {
    let mut corners = corners;
    // In this order, those at one place are near each other.
    let place = |p: DVec3| p.dot(ACROSS);
    order::rising(&mut corners, |(p, _)| place(*p));
    let mut is_taken = vec![false; corners.len()];
    let mut balls = Vec::new();
    for first in 0..corners.len() {
        if is_taken[first] {
            continue;
        }
        let corner = corners[first].0;
        let mut normals = Vec::<DVec3>::new();
        for at in first..corners.len() {
            let (p, normal) = corners[at];
            if place(p) > place(corner) + slack {
                break;
            }
            if is_taken[at] || p.distance(corner) > slack {
                continue;
            }
            is_taken[at] = true;
            if normals.iter().all(|known| known.distance(normal) > CREASE) {
                normals.push(normal);
            }
        }
        let mean = normals.iter().sum::<DVec3>().normalize_or_zero();
        if normals.len() < 3 || mean == DVec3::ZERO {
            continue;
        }
        let (along, across) = mean.any_orthonormal_pair();
        order::rising(&mut normals, |normal| f64::atan2(normal.dot(across), normal.dot(along)));
        for n in 0..normals.len() {
            let normals = [mean, normals[n], normals[(n + 1) % normals.len()]];
            // About a saddle there is none that all of them are on one side of.
            if (0..3).all(|k| normals[k].dot(normals[(k + 1) % 3]) > OPPOSITE) {
                balls.push(Chart::Ball { corner, normals, by });
            }
        }
    }
    balls
}
