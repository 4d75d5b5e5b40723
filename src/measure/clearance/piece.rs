//! Parts of the patches of a surface, with a number of each corner.

use glam::{DMat3, DVec3};
use rvachev_field::{Patches, Subpatch, Zone};

/// How far what is moved is drawn in from its sides, as a part of how far it goes.
const ASIDE: f64 = 0.6;

/// A part of a patch, and a number of each of its corners, NaN where none is known.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) part: Subpatch,
    pub(super) numbers: [f64; 3],
}

impl Piece {
    /// A whole patch, of whose corners no number is known.
    pub(super) fn whole(patches: &Patches, n: usize) -> Piece {
        Piece { part: patches.whole(n), numbers: [f64::NAN; 3] }
    }

    /// With the numbers of its corners.
    pub(super) fn numbered(self, number: impl Fn(DVec3) -> f64) -> Piece {
        Piece { numbers: self.part.points.map(number), ..self }
    }

    /// Its four parts, which share corners: they are told the numbers of those between its own.
    pub(super) fn divided(&self, number: impl Fn(DVec3) -> f64) -> [Piece; 4] {
        let parts = self.part.divided();
        let (ends, middles) = (self.numbers, parts[3].points.map(number));
        let corner = |k: usize| [ends[k], middles[k], middles[(k + 2) % 3]];
        let numbers = [corner(0), corner(1), corner(2), middles];
        [0, 1, 2, 3].map(|k| Piece { part: parts[k], numbers: numbers[k] })
    }

    /// The unit normal of its triangle, outwards; 0 of one without area.
    pub(super) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.part.points;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// No point of it is farther from its middle.
    pub(super) fn reach(&self) -> f64 {
        self.part.longest_side() / 3f64.sqrt() + self.part.sag
    }

    /// Its triangle, moved along its normal and drawn in from its sides: each point of it goes no
    /// farther than this.
    ///
    /// ```text
    ///      .-------------.      What is at the sides of a surface meets what the surface touches beside
    ///       \ .-------. /       it, and has to keep off that too.
    /// ```
    pub(super) fn moved(&self, by: f64) -> [DVec3; 3] {
        let [a, b, c] = self.part.points;
        let sides = [b.distance(c), c.distance(a), a.distance(b)];
        // The middle of the circle within.
        let weights = sides.map(|side| side / sides.iter().sum::<f64>().max(f64::MIN_POSITIVE));
        let middle = weights[0] * a + weights[1] * b + weights[2] * c;
        let reach = self.part.points.iter().fold(0.0, |most, p| middle.distance(*p).max(most));
        let part = if reach > 0.0 { (ASIDE * by.abs() / reach).min(1.0) } else { 0.0 };
        let along = (1.0 - ASIDE * ASIDE).sqrt() * by * self.normal();
        self.part.points.map(|p| p.lerp(middle, part) + along)
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.part.points.iter().sum::<DVec3>() / 3.0
    }

    /// A zone that holds it, moved by a vector.
    pub(super) fn zone(&self, by: DVec3) -> Zone {
        let [a, b, c] = self.part.points;
        let axes = DMat3::from_cols(0.5 * (b - a), 0.5 * (c - a), DVec3::ZERO);
        Zone::of_frame(0.5 * (b + c) + by, axes).inflated(self.part.sag)
    }
}
