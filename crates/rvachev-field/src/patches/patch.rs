//! A triangle with curved sides.

use glam::DVec3;

use crate::Bounds;

/// A triangle with curved sides, `P(b) = Σ bᵢ pᵢ + 4 (b₀b₁ u₀ + b₁b₂ u₁ + b₂b₀ u₂)`.
///
/// `b` are barycentric coordinates, pᵢ the corners and uᵢ the displacements of the middles of the
/// sides: that of side i, from corner i to corner i + 1, lies at `(pᵢ + pᵢ₊₁)/2 + uᵢ`. Two patches
/// that share a side's corners and displacement meet there without a gap. Flat if all
/// displacements are zero.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// The corners, counter-clockwise as seen from outside.
    pub corners: [DVec3; 3],
    /// How far the middles of the sides are off those of the straight ones.
    pub displacements: [DVec3; 3],
}

impl Patch {
    /// The flat triangle.
    pub fn flat(corners: [DVec3; 3]) -> Patch {
        Patch { corners, displacements: [DVec3::ZERO; 3] }
    }

    /// The point at barycentric coordinates.
    pub fn point(&self, b: [f64; 3]) -> DVec3 {
        let mut point = DVec3::ZERO;
        for i in 0..3 {
            point += b[i] * self.corners[i] + 4.0 * b[i] * b[(i + 1) % 3] * self.displacements[i];
        }
        point
    }

    /// The unit normal at barycentric coordinates, by the winding; zero where there is none.
    pub fn normal(&self, b: [f64; 3]) -> DVec3 {
        // Derivatives by the three coordinates as if they were independent.
        let slopes = [0, 1, 2].map(|i| {
            let (next, last) = ((i + 1) % 3, (i + 2) % 3);
            self.corners[i] + 4.0 * (b[next] * self.displacements[i] + b[last] * self.displacements[last])
        });
        (slopes[1] - slopes[0]).cross(slopes[2] - slopes[0]).normalize_or_zero()
    }

    /// Whether it is a flat triangle with straight sides.
    pub fn is_flat(&self) -> bool {
        self.displacements == [DVec3::ZERO; 3]
    }

    /// Whether every number of it is finite.
    pub(super) fn is_finite(&self) -> bool {
        self.corners.iter().chain(&self.displacements).all(|v| v.is_finite())
    }

    /// A box that holds it: that of the control points of its Bézier form.
    pub fn bounds(&self) -> Bounds {
        let middles =
            [0, 1, 2].map(|i| 0.5 * (self.corners[i] + self.corners[(i + 1) % 3]) + 2.0 * self.displacements[i]);
        Bounds::from_points(self.corners.into_iter().chain(middles))
    }
}
