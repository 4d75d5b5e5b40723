//! Points folded into one sector of a regular polygon.
//!
//! A regular polygon of n sides is its own mirror image in n lines. Mirroring a point to the
//! near side of a few of them, `⌈log2 n⌉ + 1` in all, brings it into the sector between a
//! corner (angle 0) and the middle of an edge (angle π/n), and keeps its distance to the
//! polygon: the nearest point of a symmetric convex shape is in the sector of the point.
//!
//! The range [0, kπ/n] of angles is halved by the line at ⌈k/2⌉·π/n, until k is 1.

use glam::{DVec2, DVec3};

use super::{ParamError, check};
use crate::Real;

/// As many mirrors as the largest number of sides needs.
const MIRRORS: usize = 10;

/// A regular polygon about the origin with a corner on the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RegularPolygon {
    pub(super) sides: u32,
    /// Distance of the corners from the centre.
    pub(super) radius: f64,
    /// Distance of the edges from the centre.
    pub(super) inscribed: f64,
    /// Half the length of an edge.
    pub(super) half_edge: f64,
    /// Cosine and sine of π/n.
    sector: [f64; 2],
    /// Cosines and sines of the mirrors' angles; the first `count` count.
    mirrors: [[f64; 2]; MIRRORS],
    count: usize,
}

impl RegularPolygon {
    /// The most sides that a polygon may have.
    pub(super) const MOST_SIDES: u32 = 1000;

    pub(super) fn new(sides: u32, radius: f64) -> RegularPolygon {
        let step = std::f64::consts::PI / f64::from(sides);
        let (sin, cos) = step.sin_cos();
        let mut mirrors = [[1.0, 0.0]; MIRRORS];
        let (mut left, mut count) = (sides, 0);
        for mirror in &mut mirrors {
            if left > 1 {
                left = left.div_ceil(2);
                let (sin, cos) = (f64::from(left) * step).sin_cos();
                *mirror = [cos, sin];
                count += 1;
            }
        }
        RegularPolygon {
            sides,
            radius,
            inscribed: radius * cos,
            half_edge: radius * sin,
            sector: [cos, sin],
            mirrors,
            count,
        }
    }

    /// The unit normals of its edges.
    pub(super) fn normals(&self) -> impl Iterator<Item = DVec2> + use<> {
        let step = std::f64::consts::TAU / f64::from(self.sides);
        (0..self.sides).map(move |edge| DVec2::from_angle((f64::from(edge) + 0.5) * step))
    }

    pub(super) fn check(&self) -> Result<(), ParamError> {
        check::within("sides", f64::from(self.sides), 3.0, f64::from(RegularPolygon::MOST_SIDES))?;
        check::length("radius", self.radius)
    }

    /// The folded point: its distance from the centre along the normal of the edge, and along
    /// the edge from its middle.
    #[inline(always)]
    pub(super) fn fold<R: Real>(&self, x: R, y: R) -> [R; 2] {
        let zero = x.lift(0.0);
        let (mut x, mut y) = (x, y.abs());
        for &[cos, sin] in self.mirrors.iter().take(self.count) {
            let twice = x.scale_add(-sin, y * cos).max(zero) * 2.0;
            x = twice.scale_add(sin, x);
            y = twice.scale_add(-cos, y);
        }
        let [cos, sin] = self.sector;
        [x.scale_add(cos, y * sin), x.scale_add(sin, y * -cos)]
    }

    /// The largest `d · p` over its points p.
    pub(super) fn support(&self, d: DVec2) -> f64 {
        let step = std::f64::consts::TAU / f64::from(self.sides);
        let angle = d.y.atan2(d.x);
        let off = angle - step * (angle / step).round();
        self.radius * d.length() * off.cos() * (1.0 + 1e-14)
    }

    /// Half the sizes of a box with z from −`half_height` up: `[min, max]`.
    pub(super) fn corners(&self, half_height: f64) -> [DVec3; 2] {
        let [left, right] = [DVec2::NEG_X, DVec2::X].map(|d| self.support(d));
        let up = self.support(DVec2::Y);
        [DVec3::new(-left, -up, -half_height), DVec3::new(right, up, half_height)]
    }
}
