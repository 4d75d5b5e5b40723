//! Feature points: where a cell holds a crease or a corner, a vertex on it.
//!
//! ```text
//!      x0                    The normals at the vertices of the cell's loop spread more than a
//!     --o---.                smooth surface's do. Their planes meet near the crease: a first p.
//!       q0 ·.\               Then the field is asked at points q on the way from p to each
//!            p x  crease     vertex, for the planes that the sides have close to p, and p moves
//!       q1 · /               to where those meet; and once more, closer.
//!     --o---'
//!      x1
//! ```
//!
//! Each step is a damped Gauss–Newton step (see [`Planes`]) that is held in the cell. On
//! plane sides the first is exact; on curved ones the error falls from d²/2R to δ²d²/2R, with
//! d the distance of the vertices, R the radius of curvature and δ = 1/10 at last. Where the
//! cell turns out smooth, though strongly curved, the planes are nearly the same, and p
//! ends on the surface.
//!
//! Source: L. P. Kobbelt, M. Botsch, U. Schwanecke and H.-P. Seidel, Feature sensitive surface
//! extraction from volume data (2001), for the idea.

use glam::{DVec3, Vec3};

use super::loops::{CellLoop, LONGEST};
use super::qef::Planes;

/// Normals of a cell that differ by less than this are those of a smooth surface: the cosine
/// of the angle between them.
pub(super) const SMOOTH: f32 = 0.9;
/// The cosine of half that angle, rounded up.
const HALF_SMOOTH: f32 = 0.975;

/// How far feature points stay from the faces of their cell, in cells.
const INSET: f64 = 1.0 / 128.0;

/// The damping of the steps; it takes the distance from the crease to a hundredth a step.
const DAMPING: f64 = 3e-3;

/// Where the field is asked, as parts of the way from the feature point to a vertex: a step each.
const CLOSER: [f64; 2] = [0.4, 0.1];

/// A value and a gradient of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slope {
    /// The value, in length units.
    pub value: f64,
    /// The gradient, inward.
    pub gradient: DVec3,
}

/// Whether no two of the normals of a cell's vertices differ as those of a crease do.
pub(super) fn is_smooth(vertices: &[(Vec3, Vec3)]) -> bool {
    let Some((_, first)) = vertices.first() else { return true };
    // If all are within half the angle of the first, no two differ by more than it.
    if vertices.iter().all(|(_, normal)| first.dot(*normal) > HALF_SMOOTH) {
        return true;
    }
    let mut pairs = (0..vertices.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    pairs.all(|(a, b)| vertices[a].1.dot(vertices[b].1) > SMOOTH)
}

/// A cell whose surface is not smooth. Positions are in cells, from the lattice's first node.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) cell: [u32; 3],
    pub(super) outline: CellLoop,
    /// The vertices of the loop.
    vertices: [DVec3; LONGEST],
    /// The outward normals there; later those that the sides of the vertices have close to `at`.
    normals: [DVec3; LONGEST],
    /// The segments, from vertex n to the next, whose ends have different normals, as bits.
    pub(super) split: u16,
    /// The feature point.
    pub(super) at: DVec3,
    /// The sides' planes close to it.
    pub(super) planes: Planes,
}

impl Candidate {
    /// The cell with a first feature point. `given` are the vertices on the edges of the loop, in
    /// order, with their outward normals.
    pub(super) fn new(cell: [u32; 3], outline: CellLoop, given: &[(DVec3, Vec3)]) -> Candidate {
        let mut candidate = Candidate {
            cell,
            outline,
            vertices: [DVec3::ZERO; LONGEST],
            normals: [DVec3::ZERO; LONGEST],
            split: 0,
            at: DVec3::ZERO,
            planes: Planes::NONE,
        };
        for (n, &(position, normal)) in given.iter().enumerate() {
            candidate.vertices[n] = position;
            candidate.normals[n] = normal.as_dvec3().normalize_or_zero();
            candidate.at += position / given.len() as f64;
            if candidate.normals[n] != DVec3::ZERO {
                candidate.planes.add(candidate.normals[n], candidate.normals[n].dot(position));
            }
            let (_, next) = given[(n + 1) % given.len()];
            candidate.split |= u16::from(normal.dot(next) < SMOOTH) << n;
        }
        candidate.settle();
        candidate
    }

    /// The vertices and the normals that their sides have close to the feature point.
    fn sides(&mut self) -> impl Iterator<Item = (&DVec3, &mut DVec3)> {
        self.vertices.iter().zip(&mut self.normals).take(self.outline.len())
    }

    /// The normal close to the feature point, on the side of vertex n of the loop; 0 if it is not
    /// known.
    pub(super) fn normal(&self, n: usize) -> Vec3 {
        self.normals[n].as_vec3()
    }

    fn settle(&mut self) {
        let low = self.cell.map(f64::from).into();
        self.at = settle(&self.planes, self.at, low, low + 1.0, 1);
    }

    /// The direction of the crease, if there are two sides and no more.
    pub(super) fn crease(&self) -> Option<DVec3> {
        let normals = &self.normals[..self.outline.len()];
        let pairs = (0..normals.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let across = pairs.map(|(a, b)| normals[a].cross(normals[b]));
        let along = across.max_by(|u, v| u.length_squared().total_cmp(&v.length_squared()))?;
        let unit = along.try_normalize()?;
        // A third side would have a normal along the crease of the two.
        (along.length() > 0.3 && normals.iter().all(|normal| normal.dot(unit).abs() < 0.2)).then_some(unit)
    }

    /// Where the planes meet if the point may leave the cell, by one cell at most.
    pub(super) fn unbound(&self) -> DVec3 {
        let low = DVec3::from_array(self.cell.map(f64::from));
        settle(&self.planes, self.at, low - 1.0, low + 2.0, 3)
    }
}

/// The point of a box of cells, clear of its faces, that the planes lead to in some steps.
pub(super) fn settle(planes: &Planes, from: DVec3, low: DVec3, high: DVec3, steps: usize) -> DVec3 {
    (0..steps).fold(from, |at, _| planes.nearest(at, DAMPING, low + INSET, high - INSET))
}

/// Moves feature points closer to the creases. `slopes` tells values and gradients at points, for cells of
/// size `step`; without any, the points stay.
pub(super) fn refine(
    candidates: &mut [Candidate],
    step: f64,
    mut slopes: impl FnMut(&[DVec3], &mut Vec<Slope>) -> bool,
) {
    let (mut points, mut found) = (Vec::new(), Vec::new());
    for part in CLOSER {
        points.clear();
        found.clear();
        for candidate in candidates.iter_mut() {
            let at = candidate.at;
            points.extend(candidate.sides().map(|(vertex, _)| at + part * (*vertex - at)));
        }
        if !slopes(&points, &mut found) || found.len() != points.len() {
            return;
        }
        let mut asked = points.iter().zip(&found);
        for candidate in candidates.iter_mut() {
            let mut planes = Planes::NONE;
            for ((_, normal), (point, slope)) in candidate.sides().zip(&mut asked) {
                let steepness = slope.gradient.length();
                let depth = slope.value / (steepness * step);
                // A plane that is farther away than the cell tells nothing; neither does NaN.
                if steepness > 0.0 && depth.abs() < 1.0 {
                    *normal = -slope.gradient / steepness;
                    planes.add(*normal, normal.dot(*point) + depth);
                }
            }
            if !planes.is_empty() {
                candidate.planes = planes;
                candidate.settle();
            }
        }
    }
}
