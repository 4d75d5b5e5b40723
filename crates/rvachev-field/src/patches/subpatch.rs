//! Parts of patches, divided into four at a time.

use glam::DVec3;

use super::Patches;
use super::face::double;

/// A part of a patch.
#[derive(Clone, Copy, Debug)]
pub struct Subpatch {
    /// Its corners.
    pub points: [DVec3; 3],
    /// How far the middles of its sides are off the straight lines.
    pub(super) bends: [DVec3; 3],
    /// No point of it is farther off the triangle of its corners.
    pub sag: f64,
}

impl Subpatch {
    /// Its four parts: the sides of each are parallel to its own and half as long, so that they
    /// bend by a quarter.
    pub fn divided(&self) -> [Subpatch; 4] {
        let ends = self.points;
        let middles = [0, 1, 2].map(|k| 0.5 * (ends[k] + ends[(k + 1) % 3]) + self.bends[k]);
        // With the side that the first one is parallel to.
        let of = |points: [DVec3; 3], side: usize| {
            let bends = [0, 1, 2].map(|k| 0.25 * self.bends[(side + k) % 3]);
            Subpatch { points, bends, sag: 0.25 * self.sag }
        };
        let corner = |k: usize| of([ends[k], middles[k], middles[(k + 2) % 3]], k);
        [corner(0), corner(1), corner(2), of(middles, 2)]
    }

    /// How long it is.
    pub fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.points[k].distance(self.points[(k + 1) % 3])).fold(0.0, f64::max)
    }

    /// Moved by a vector.
    pub(super) fn moved(&self, by: DVec3) -> Subpatch {
        Subpatch { points: self.points.map(|p| p + by), ..*self }
    }

    /// A triangle.
    pub(super) fn flat(points: [DVec3; 3]) -> Subpatch {
        Subpatch { points, bends: [DVec3::ZERO; 3], sag: 0.0 }
    }
}

impl Patches {
    /// A whole patch, counted as the hierarchy sorts them.
    pub fn whole(&self, at: usize) -> Subpatch {
        let (face, sides, unit) = (&self.faces[at], &self.sides[at], self.frame.unit);
        let [a, e, f] = [face.a, sides.e, sides.f].map(double);
        let points = [a, a + e, a + f].map(|p| self.frame.outward(p));
        let bends = self.quadratics.get(at).map_or([DVec3::ZERO; 3], |quadratic| {
            let [c, d, e] = [quadratic.c, quadratic.d, quadratic.e].map(|by| 0.25 * unit * double(by));
            [c, e + c + d, d]
        });
        Subpatch { points, bends, sag: unit * f64::from(face.sag) }
    }
}
