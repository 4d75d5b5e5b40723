//! Smooth cells whose triangles would be too far off the surface: a vertex in their middle.
//!
//! ```text
//!        p _______ q         A surface that is curved falls behind its tangent plane at p by half of
//!        /\      \           (p − q)·m at q. With normals m and n at p and q, the chord p–q is
//!       /   \  ·c \          below it, and the more so the larger (p − q)·(m − n) is.
//!      /______\____\
//!                            If that is too much, the loop of the cell has a fan from c instead.
//! ```
//!
//! Let the surface be at the height h(x) = −½ xᵀKx. To first order its normal is (Kx, 1), so that
//! (p − q)·(m − n) is (x − y)ᵀK(x − y) for the points above x and y. With r the way from the middle of some points to
//! each of them, the surface is above the middle of the points by half the mean of rᵀKr. Hence
//!
//! * the middle of a triangle is below the surface by a 18th of the sum of (p − q)·(m − n) over its sides;
//! * the surface is above the middle of a polygon on it by half the mean of n·(p − middle) over its corners,
//!   which gives c.
//!
//! What is of third order is left out. The triangles of a fan are off by half as much as those of the table, or
//! less, and no more values of the field are needed for them.

use glam::Vec3;

/// The distance of a triangle's middle from the surface, in cells, beyond which there is a fan.
const FAR: f32 = 0.01;

/// If no two of the normals at a triangle's corners are farther apart than this, the triangle is not far off:
/// its sides have a length of at most 3√2 cells together.
pub(super) const SPREAD: f32 = 18.0 * FAR / (3.0 * std::f32::consts::SQRT_2);

/// A vertex of a cell.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// Where it is, in length units.
    pub(super) at: Vec3,
    /// The unit normal.
    pub(super) normal: Vec3,
}

/// Whether the middle of a triangle is too far off the surface, for cells of size `step`.
pub(super) fn is_far([a, b, c]: [Corner; 3], step: f32) -> bool {
    let bend = |p: Corner, q: Corner| (p.at - q.at).dot(p.normal - q.normal);
    (bend(a, b) + bend(b, c) + bend(c, a)).abs() > 18.0 * FAR * step
}

/// The point of the surface in the middle of a polygon on it.
pub(super) fn top(corners: &[Corner]) -> Vec3 {
    let share = 1.0 / corners.len() as f32;
    let middle = corners.iter().map(|corner| share * corner.at).sum::<Vec3>();
    let normal = corners.iter().map(|corner| corner.normal).sum::<Vec3>().normalize_or_zero();
    let height: f32 = corners.iter().map(|corner| share * corner.normal.dot(corner.at - middle)).sum();
    middle + 0.5 * height * normal
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_sphere(x: f32, y: f32) -> Corner {
        let normal = Vec3::new(x, y, 8.0).normalize();
        Corner { at: 8.0 * normal, normal }
    }

    #[test]
    fn what_is_said_of_a_sphere_holds() {
        // A ball 16 cells across.
        let corners = [on_sphere(0.0, 0.0), on_sphere(1.0, 0.0), on_sphere(1.0, 1.0), on_sphere(0.0, 1.0)];
        let top = top(&corners);
        assert!((top.length() - 8.0).abs() < 2e-4, "{}", top.length());
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            let triangle = triangle.map(|n| corners[n]);
            let off = 8.0 - (triangle.iter().map(|corner| corner.at).sum::<Vec3>() / 3.0).length();
            assert!(off > 0.02);
            for step in [0.97, 1.03] {
                let limit = FAR * step * off / FAR;
                // In cells of a size such that it is just about too far.
                let step = limit / FAR;
                assert_eq!(is_far(triangle, step), step < off / FAR);
            }
        }
    }
}
