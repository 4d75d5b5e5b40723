//! What is all around a point.

use glam::DVec3;

use super::program::Program;

/// Values of less than this, in proportion to lengths about the solid, are rounding.
pub(crate) const ROUNDING: f64 = 1e-13;

/// How far beside a point it is looked, in proportion to the same.
pub(crate) const BESIDE: f64 = 1e-10;

/// Directions along which it is looked: along no axis, as faces are.
pub(crate) const AROUND: [[f64; 3]; 14] = [
    [0.97, 0.21, 0.12],
    [-0.94, 0.17, -0.29],
    [0.24, 0.95, -0.19],
    [0.15, -0.96, 0.23],
    [-0.11, 0.28, 0.95],
    [0.27, -0.13, -0.95],
    [0.51, 0.66, 0.55],
    [-0.62, 0.49, 0.61],
    [0.57, -0.64, 0.52],
    [0.63, 0.52, -0.57],
    [-0.49, -0.55, 0.67],
    [-0.61, 0.58, -0.54],
    [0.48, -0.53, -0.70],
    [-0.66, -0.54, -0.52],
];

impl Program {
    /// The value at a point; above 0 where it is 0 but for rounding, as on a face that operands
    /// share, and inside is all around. `scale` is of lengths about the solid.
    pub(crate) fn value_or_around(&self, p: DVec3, scale: f64) -> f64 {
        let value = self.value(p);
        if value > 0.0 || value <= -ROUNDING * scale {
            return value;
        }
        let is_inside = |direction: [f64; 3]| self.value(p + BESIDE * scale * DVec3::from_array(direction)) > 0.0;
        if AROUND.into_iter().all(is_inside) { f64::MIN_POSITIVE } else { value }
    }
}
