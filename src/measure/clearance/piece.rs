//! Parts of the patches of a surface, divided into four at a time.

use glam::{DMat3, DVec3};
use rvachev_field::{Patches, Zone};

/// A part of a patch: its corners in the patch's coordinates, where they are, and a number of each,
/// NaN where none is known.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    patch: u32,
    corners: [[f64; 2]; 3],
    pub(super) points: [DVec3; 3],
    pub(super) numbers: [f64; 3],
}

/// The corners of a patch in its coordinates.
const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// How far what is moved is drawn in from its sides, as a part of how far it goes.
const ASIDE: f64 = 0.6;

impl Piece {
    /// A whole patch, of whose corners no number is known.
    pub(super) fn whole(patches: &Patches, n: usize) -> Piece {
        let points = CORNERS.map(|at| patches.point(n, at));
        Piece { patch: n as u32, corners: CORNERS, points, numbers: [f64::NAN; 3] }
    }

    /// With the numbers of corners of which none is known.
    pub(super) fn numbered(self, number: impl Fn(DVec3) -> f64) -> Piece {
        let numbers = [0, 1, 2].map(|k| {
            let own = self.numbers[k];
            if own.is_nan() { number(self.points[k]) } else { own }
        });
        Piece { numbers, ..self }
    }

    /// Its four parts, which share corners: they are told the numbers of those between its own.
    pub(super) fn divided(&self, patches: &Patches, number: impl Fn(DVec3) -> f64) -> [Piece; 4] {
        let middles = self.middles(patches).map(|(at, point)| (at, point, number(point)));
        let ends = [0, 1, 2].map(|k| (self.corners[k], self.points[k], self.numbers[k]));
        let part = |of: [([f64; 2], DVec3, f64); 3]| Piece {
            patch: self.patch,
            corners: of.map(|at| at.0),
            points: of.map(|at| at.1),
            numbers: of.map(|at| at.2),
        };
        let corner = |k: usize| part([ends[k], middles[k], middles[(k + 2) % 3]]);
        [corner(0), corner(1), corner(2), part(middles)]
    }

    fn middles(&self, patches: &Patches) -> [([f64; 2], DVec3); 3] {
        [0, 1, 2].map(|k| {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % 3]);
            let at = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            (at, patches.point(self.patch as usize, at))
        })
    }

    pub(super) fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.points[k].distance(self.points[(k + 1) % 3])).fold(0.0, f64::max)
    }

    /// How far it is off its triangle at most: a patch is quadratic, so that it is four thirds of
    /// how far it is in the middle of a side.
    pub(super) fn off(&self, patches: &Patches) -> f64 {
        if patches.is_flat() {
            return 0.0;
        }
        let middles = self.middles(patches);
        let off = |k: usize| middles[k].1.distance(0.5 * (self.points[k] + self.points[(k + 1) % 3]));
        4.0 / 3.0 * (0..3).map(off).fold(0.0, f64::max)
    }

    /// The unit normal of its triangle, outwards; 0 of one without area.
    pub(super) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.points;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// No point of it is farther from its middle.
    pub(super) fn reach(&self, patches: &Patches) -> f64 {
        self.longest_side() / 3f64.sqrt() + self.off(patches)
    }

    /// Its triangle, moved along its normal and drawn in from its sides: each point of it goes no
    /// farther than this.
    ///
    /// ```text
    ///      .-------------.      What is at the sides of a surface meets what the surface touches beside
    ///       \ .-------. /       it, and has to keep off that too.
    /// ```
    pub(super) fn moved(&self, by: f64) -> [DVec3; 3] {
        let [a, b, c] = self.points;
        let sides = [b.distance(c), c.distance(a), a.distance(b)];
        // The middle of the circle within.
        let weights = sides.map(|side| side / sides.iter().sum::<f64>().max(f64::MIN_POSITIVE));
        let middle = weights[0] * a + weights[1] * b + weights[2] * c;
        let reach = self.points.iter().fold(0.0, |most, p| middle.distance(*p).max(most));
        let part = if reach > 0.0 { (ASIDE * by.abs() / reach).min(1.0) } else { 0.0 };
        let along = (1.0 - ASIDE * ASIDE).sqrt() * by * self.normal();
        self.points.map(|p| p.lerp(middle, part) + along)
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.points.iter().sum::<DVec3>() / 3.0
    }

    /// A zone that holds it, moved by a vector.
    pub(super) fn zone(&self, patches: &Patches, by: DVec3) -> Zone {
        let [a, b, c] = self.points;
        let axes = DMat3::from_cols(0.5 * (b - a), 0.5 * (c - a), DVec3::ZERO);
        Zone::of_frame(0.5 * (b + c) + by, axes).inflated(self.off(patches))
    }
}
