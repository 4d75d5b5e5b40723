//! Smooth cells whose triangles would be too far off the surface: a vertex in their middle.
//!
//! ```text
//!          m   ____   n      With normals m and n at p and q, the surface between them is above the
//!          \ .'    `. /      chord p–q, and the more so the larger (p − q)·(m − n) is. If that is too
//!           p--------q       much, the loop of the cell has a fan instead, around a point that is as
//!                            far above the middle of the loop as the surface.
//! ```
//!
//! Let the surface be at the height h(x) = −½ xᵀKx. To first order its normal is (Kx, 1), so that
//! (p − q)·(m − n) is (x − y)ᵀK(x − y) for the points above x and y. With r the way from the middle of some
//! points to each of them, the surface is above the middle of the points by half the mean of rᵀKr. Hence
//!
//! * the middle of a triangle is below the surface by a 18th of the sum of (p − q)·(m − n) over its sides;
//! * the surface is above the middle of a polygon on it by half the mean of n·(p − middle) over its corners.
//!
//! What is of third order is left out. The triangles of a fan are off by half as much as those of the table, or
//! less, and no more values of the field are needed for them. That fans are embedded is shown in
//! [`sharp`](super::sharp).

use glam::Vec3;

use super::samples::Samples;
use super::sharp::Segment;
use crate::mesh::feature::are_within;
use crate::mesh::loops::{CellLoop, LONGEST};

/// The distance of a triangle's middle from the surface, in cells, beyond which there is a fan.
const FAR: f32 = 0.01;

/// If no two of the normals at a triangle's corners are farther apart than this, the triangle is not far off:
/// its sides have a length of at most 3√2 cells together.
pub(super) const SPREAD: f32 = 18.0 * FAR / (3.0 * std::f32::consts::SQRT_2);

/// The cosine of half the angle between such normals, rounded up: 1 − ⅛ SPREAD² is below it.
const FLAT: f32 = 0.999_78;

/// Whether a smooth cell is to have a vertex in its middle, given the normals at the vertices of its loop, their sum,
/// and the triangles that it has otherwise.
#[inline(always)]
pub(super) fn is_bulge(
    samples: &Samples<'_>,
    normals: &[Vec3],
    sum: Vec3,
    mut triangles: impl Iterator<Item = [u32; 3]>,
) -> bool {
    let step = samples.lattice.step() as f32;
    !are_within(normals, sum, FLAT) && triangles.any(|triangle| off(triangle.map(|n| samples.get(n))) > FAR * step)
}

/// How far the middle of a triangle, given by the positions of its corners and the normals there, is off the
/// surface.
fn off([a, b, c]: [(Vec3, Vec3); 3]) -> f32 {
    let bend = |(p, m): (Vec3, Vec3), (q, n): (Vec3, Vec3)| (p - q).dot(m - n);
    (bend(a, b) + bend(b, c) + bend(c, a)).abs() / 18.0
}

/// The point of the surface above the middle of a polygon on it.
fn top(corners: &[(Vec3, Vec3)]) -> Vec3 {
    let share = 1.0 / corners.len() as f32;
    let middle = corners.iter().map(|(at, _)| share * at).sum::<Vec3>();
    let normal = corners.iter().map(|(_, normal)| normal).sum::<Vec3>().normalize_or_zero();
    let height: f32 = corners.iter().map(|(at, normal)| 0.5 * share * normal.dot(at - middle)).sum();
    middle + height * normal
}

/// A smooth cell with a fan.
pub(super) struct Bulge {
    pub(super) cell: [u32; 3],
    pub(super) outline: CellLoop,
    /// Those on the edges of the loop, in order.
    pub(super) vertices: [u32; LONGEST],
}

impl Bulge {
    fn vertices(&self) -> &[u32] {
        &self.vertices[..self.outline.len()]
    }

    /// The point of its fan, in length units.
    pub(super) fn top(&self, samples: &Samples<'_>) -> Vec3 {
        let mut corners = [(Vec3::ZERO, Vec3::ZERO); LONGEST];
        let list = self.vertices().iter().zip(&mut corners);
        list.for_each(|(&vertex, corner)| *corner = samples.get(vertex));
        top(&corners[..self.outline.len()])
    }

    pub(super) fn segments(&self, samples: &Samples<'_>) -> impl Iterator<Item = Segment> {
        self.vertices().iter().enumerate().map(|(n, &from)| Segment {
            from,
            cell: self.cell,
            face: self.outline.face(n),
            turns: false,
            across: None,
            normal: samples.normal(from),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_triangles_and_polygons_holds_on_a_sphere() {
        // A ball 16 cells across.
        let corner = |x: f32, y: f32| {
            let normal = Vec3::new(x, y, 8.0).normalize();
            (8.0 * normal, normal)
        };
        let corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            let triangle = triangle.map(|n: usize| corners[n]);
            let middle = triangle.iter().map(|(at, _)| at).sum::<Vec3>() / 3.0;
            let depth = 8.0 - middle.length();
            assert!(depth > 0.02 && (off(triangle) / depth - 1.0).abs() < 0.02, "{depth}, {}", off(triangle));
        }
        assert!((top(&corners).length() - 8.0).abs() < 5e-4, "{}", top(&corners).length());
        let fan = [(top(&corners), top(&corners) / 8.0), corners[0], corners[1]];
        assert!(off(fan) < 0.6 * off([corners[0], corners[1], corners[2]]));
    }

    #[test]
    fn flat_cells_are_not_far_off() {
        assert!(f64::from(FLAT) > 1.0 - f64::from(SPREAD).powi(2) / 8.0);
        let (a, b) = (Vec3::X, Vec3::Y);
        let corners = [Vec3::ZERO, a + b, a + Vec3::Z];
        // The corners of a cell that are farthest apart, and normals that are.
        let lean = |toward: Vec3| (Vec3::Z + SPREAD / 3f32.sqrt() * toward.normalize_or_zero()).normalize();
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        assert!(off(corners.map(|at| (at, lean(at - middle)))) < FAR);
    }
}
