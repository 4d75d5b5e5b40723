//! Where leaves stand.

use glam::{DAffine3, DMat3, DVec3};

use super::saturate;
use crate::Real;

/// Where a leaf stands: the map from the points that it is given to its own frame, the factor
/// of its value, and what is added after it.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Rows of the map: `[m_x, m_y, m_z, t]` each.
    rows: [[f64; 4]; 3],
    /// The factor of the value.
    pub scale: f64,
    /// The level or offset that the leaf is seen at.
    pub shift: f64,
}

impl Placement {
    /// Where nothing is moved.
    pub const IDENTITY: Placement =
        Placement { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], scale: 1.0, shift: 0.0 };

    /// A leaf behind a map, its value scaled, then shifted.
    pub fn new(map: &DAffine3, scale: f64, shift: f64) -> Placement {
        let m = map.matrix3.transpose();
        let row = |axis: usize| {
            let r = m.col(axis);
            [r.x, r.y, r.z, map.translation[axis]]
        };
        Placement { rows: [row(0), row(1), row(2)], scale, shift }
    }

    /// The leaf's value, as it counts outside of its frame.
    #[inline(always)]
    pub fn finish<R: Real>(&self, value: R) -> R {
        saturate(value.scale_add(self.scale, value.lift(self.shift)))
    }

    /// The map.
    pub fn map(&self) -> DAffine3 {
        let [x, y, z] = self.rows.map(|[x, y, z, _]| DVec3::new(x, y, z));
        let translation = DVec3::from_array(self.rows.map(|row| row[3]));
        DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z).transpose(), translation)
    }

    /// The point in the leaf's frame.
    #[inline(always)]
    pub fn apply<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let r = &self.rows;
        [
            x.scale_add(r[0][0], y.scale_add(r[0][1], z.scale_add(r[0][2], z.lift(r[0][3])))),
            x.scale_add(r[1][0], y.scale_add(r[1][1], z.scale_add(r[1][2], z.lift(r[1][3])))),
            x.scale_add(r[2][0], y.scale_add(r[2][1], z.scale_add(r[2][2], z.lift(r[2][3])))),
        ]
    }

    /// A gradient of the leaf's frame, in that of the points.
    #[inline(always)]
    pub fn pull<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let r = &self.rows;
        [
            x.scale_add(r[0][0], y.scale_add(r[1][0], z * r[2][0])),
            x.scale_add(r[0][1], y.scale_add(r[1][1], z * r[2][1])),
            x.scale_add(r[0][2], y.scale_add(r[1][2], z * r[2][2])),
        ]
    }
}

/// The smallest stretch of an affine map: its least singular value.
pub fn smallest_stretch(m: &DMat3) -> f64 {
    // The largest eigenvalue of A⁻¹A⁻ᵀ by Jacobi rotations: relative accuracy where it counts.
    let inverse = m.inverse();
    let mut s = inverse * inverse.transpose();
    for _ in 0..12 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let off = s.col(j)[i];
            if off.abs() <= 1e-300 {
                continue;
            }
            let theta = 0.5 * (s.col(j)[j] - s.col(i)[i]) / off;
            let tangent = theta.signum() / (theta.abs() + (1.0 + theta * theta).sqrt());
            let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
            let sin = tangent * cos;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(i)[i] = cos;
            turn.col_mut(j)[j] = cos;
            turn.col_mut(j)[i] = sin;
            turn.col_mut(i)[j] = -sin;
            s = turn.transpose() * s * turn;
        }
    }
    1.0 / s.x_axis.x.max(s.y_axis.y).max(s.z_axis.z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn the_smallest_stretch_is_the_least_singular_value() {
        let turn = |angle: f64| DMat3::from_quat(DQuat::from_rotation_z(angle) * DQuat::from_rotation_x(0.7 * angle));
        for scale in [DVec3::new(2.0, 3.0, 5.0), DVec3::new(1e-3, 1.0, 1e3), DVec3::ONE] {
            let m = turn(0.4) * DMat3::from_diagonal(scale) * turn(1.9);
            let found = smallest_stretch(&m);
            assert!((found / scale.min_element() - 1.0).abs() < 1e-9, "{found} for {scale}");
        }
    }
}
