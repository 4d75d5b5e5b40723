//! Where the search for a superellipsoid begins.

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::linear::{Principal, median};
use super::superquadric::Superquadric;

/// A frame of principal axes, and the mean distances from the centre along them.
pub(super) struct Frame {
    pub(super) center: DVec3,
    pub(super) axes: DMat3,
    pub(super) mean: DVec3,
}

impl Frame {
    fn of(points: &[DVec3], center: DVec3, axes: DMat3) -> Frame {
        let sum: DVec3 = points.iter().map(|p| (axes.transpose() * (p - center)).abs()).sum();
        Frame { center, axes, mean: (sum / points.len() as f64).max(DVec3::splat(1e-3)) }
    }

    /// Of a surface that is seen all around.
    pub(super) fn complete(points: &[DVec3]) -> Frame {
        let principal = Principal::of(points.iter().copied());
        Frame::of(points, principal.mean, principal.axes)
    }

    /// Of a surface that is seen from one side: its rim goes around the centre.
    ///
    /// ```text
    ///          .-^-.          view
    ///        /       \
    ///       +    c    +       the ends across the view; the centre is between them, as deep as they are
    /// ```
    pub(super) fn one_sided(points: &[DVec3], view: DVec3) -> Frame {
        const DIRECTIONS: u32 = 24;
        const ENDS: usize = 4;
        let u = view.any_orthonormal_vector();
        let v = view.cross(u);
        let seen: Vec<DVec3> = points.iter().map(|p| DVec3::new(u.dot(*p), v.dot(*p), view.dot(*p))).collect();
        let mut order: Vec<usize> = (0..seen.len()).collect();
        let mut depths = Vec::new();
        // Least squares of direction · centre = middle.
        let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for k in 0..DIRECTIONS {
            let direction = DVec2::from_angle(std::f64::consts::PI * f64::from(k) / f64::from(DIRECTIONS));
            let along = |i: &usize| direction.dot(seen[*i].truncate());
            let ends = ENDS.min(seen.len());
            let mut middle = 0.0;
            let mut depth = 0.0;
            for side in [1.0, -1.0] {
                if ends < order.len() {
                    order.select_nth_unstable_by(ends - 1, |i, j| (side * along(j)).total_cmp(&(side * along(i))));
                }
                middle += 0.5 * order[..ends].iter().map(along).sum::<f64>() / ends as f64;
                let mut deep: Vec<f64> = order[..ends].iter().map(|i| seen[*i].z).collect();
                order::numbers(&mut deep);
                depth += 0.25 * (deep[(ends - 1) / 2] + deep[ends / 2]);
            }
            depths.push(depth);
            xx += direction.x * direction.x;
            xy += direction.x * direction.y;
            yy += direction.y * direction.y;
            right += direction * middle;
        }
        let determinant = xx * yy - xy * xy;
        let x = (right.x * yy - right.y * xy) / determinant;
        let y = (right.y * xx - right.x * xy) / determinant;
        let center = u * x + v * y + view * median(&mut depths);
        let both = points.iter().copied().chain(points.iter().map(|p| 2.0 * center - p));
        Frame::of(points, center, Principal::of(both).axes)
    }

    /// The three choices of the polar axis, each with these exponents, turned about it by an angle.
    pub(super) fn starts(&self, exponents: &[[f64; 2]], turn: f64) -> Vec<Superquadric> {
        let turned = DMat3::from_rotation_z(turn);
        let mut starts = Vec::new();
        for &e in exponents {
            for k in 0..3 {
                let cyclic = |v: [usize; 3]| v.map(|i| (i + k) % 3);
                let [x, y, z] = cyclic([0, 1, 2]);
                let axes = DMat3::from_cols(self.axes.col(x), self.axes.col(y), self.axes.col(z)) * turned;
                let mut semi_axes = 1.5 * DVec3::new(self.mean[x], self.mean[y], self.mean[z]);
                if turn != 0.0 {
                    let across = (semi_axes.x * semi_axes.y).sqrt();
                    (semi_axes.x, semi_axes.y) = (across, across);
                }
                starts.push(Superquadric { e, semi_axes, rotation: axes, center: self.center });
            }
        }
        starts
    }
}
