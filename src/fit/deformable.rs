//! Tapered, twisted and bent superellipsoids as a family to fit.
//!
//! The bend is a vector b across the axis, the curvature in the direction of its centre: smooth at
//! 0, and no two of them are the same bend. A point of the deformed solid is taken back by
//!
//! ```text
//!     A = 1 − b·(X, Y)    h = √(A² + k²Z²)    w = Z²/(A + h)      k = |b|
//!     (x, y) = (X, Y) − w·b      z = atan2(kZ, A)/k               bend
//!     turned by −ω·z                                              twist
//!     x/(1 + k_x t), y/(1 + k_y t),  t = clamp(z/a₃, −1, 1)       taper
//! ```
//!
//! and the derivatives by the same steps backwards.
//!
//! Source: A. H. Barr, *Global and local deformations of solid primitives* (1984); F. Solina,
//! R. Bajcsy, *Recovery of parametric models from range images* (1990).

use std::f64::consts::PI;
use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::Real;

use super::kernel::{LogGauge, Model};
use super::superquadric::{Superquadric, log_gauge};

/// Parameters: those of the superellipsoid's shape, two tapers, twist, bend, and the pose.
pub(super) const PARAMETERS: usize = 16;

/// The range of a taper: beyond it a face shrinks to an edge.
const TAPER: f64 = 0.9;

/// The largest twist between the middle and an end, and the largest bend, in radians.
const TURN: f64 = PI;
const ARC: f64 = 2.8;

/// The largest twist in radians over the cloud's size: what is flat would be twisted by any rate.
const RATE: f64 = 16.0;

/// How near the solid may come to the centre of curvature, in proportion.
const NEAR: f64 = 0.98;

#[derive(Clone, Copy, Debug)]
pub(super) struct Deformable {
    /// With the pose.
    pub(super) base: Superquadric,
    pub(super) taper: [f64; 2],
    /// Radians a length unit.
    pub(super) twist: f64,
    /// Curvature times the direction of its centre.
    pub(super) bend: DVec2,
}

impl Model<PARAMETERS> for Deformable {
    fn pose(&self) -> (DMat3, DVec3) {
        (self.base.rotation, self.base.center)
    }

    #[inline(always)]
    fn log_gauge<R: Real>(&self, q: [R; 3], rows: &mut [R; PARAMETERS]) -> LogGauge<R> {
        let [x, y, z] = q;
        let (b, [kx, ky], twist) = (self.bend, self.taper, self.twist);
        let one = x.lift(1.0);
        // Bend; a curvature of 10⁻⁵ of the cloud's size is none.
        let k2 = b.length_squared() + 1e-10;
        let k = k2.sqrt();
        let a = x.scale_add(-b.x, y.scale_add(-b.y, one));
        let h = (a.square() + z.square() * k2).sqrt() + 1e-12;
        let d = (a + h).max(x.lift(1e-6));
        let w = z.square() / d;
        let (x1, y1) = (w.scale_add(-b.x, x), w.scale_add(-b.y, y));
        let z1 = (z * k).atan2(a) * (1.0 / k);
        // Twist.
        let (sin, cos) = (z1 * twist).sin_cos();
        let (x2, y2) = (cos * x1 + sin * y1, cos * y1 - sin * x1);
        // Taper.
        let height = self.base.semi_axes.z;
        let t = (z1 * (1.0 / height)).min(one).max(-one);
        let within = (z1.abs() * (1.0 / height) - 1.0).select(x.lift(0.0), one);
        let (sx, sy) = (one / t.scale_add(kx, one), one / t.scale_add(ky, one));
        let (x3, y3) = (x2 * sx, y2 * sy);
        let LogGauge { log2, gradient: [gx, gy, gz], radius } =
            log_gauge(self.base.e, self.base.semi_axes, [x3, y3, z1], rows);
        // And back.
        let (px, py) = (gx * x3 * sx, gy * y3 * sy);
        rows[5] = -(px * t);
        rows[6] = -(py * t);
        let along = (px * kx + py * ky) * within;
        rows[4] = rows[4] + along * t;
        let (gx, gy) = (gx * sx, gy * sy);
        let turn = gx * y2 - gy * x2;
        rows[7] = turn * z1;
        let gz = gz - along * (1.0 / height) + turn * twist;
        let (gx, gy) = (cos * gx - sin * gy, sin * gx + cos * gy);
        let p = gx * b.x + gy * b.y;
        let (over_h, over_h2) = (one / h, one / h.square());
        let by_a = p * w * over_h - gz * z * over_h2;
        let by_z = gz * a * over_h2 - p * (z * 2.0 - w * z * over_h * k2) / d;
        let by_k = p * w * z.square() * over_h / d + gz * (a * z * over_h2 - z1) * (1.0 / k2);
        rows[8] = by_k * b.x - w * gx - x * by_a;
        rows[9] = by_k * b.y - w * gy - y * by_a;
        LogGauge { log2, gradient: [by_a.scale_add(-b.x, gx), by_a.scale_add(-b.y, gy), by_z], radius }
    }

    fn sizes(&self) -> (Range<usize>, f64) {
        self.base.sizes()
    }

    fn moved(&self, step: &[f64; PARAMETERS]) -> Deformable {
        let mut base = [0.0; super::superquadric::PARAMETERS];
        base[..5].copy_from_slice(&step[..5]);
        base[5..].copy_from_slice(&step[10..]);
        let base = self.base.moved(&base);
        let taper = [0, 1].map(|i| (self.taper[i] + step[5 + i]).clamp(-TAPER, TAPER));
        let most = (TURN / base.semi_axes.z).min(RATE);
        let twist = (self.twist + step[7]).clamp(-most, most);
        let bend = self.bend + DVec2::new(step[8], step[9]);
        Deformable { base, taper, twist, bend }.bent_validly()
    }

    fn limits(&self) -> [[f64; 2]; PARAMETERS] {
        let base = self.base.limits();
        let mut limits = [[0.0; 2]; PARAMETERS];
        limits[..5].copy_from_slice(&base[..5]);
        limits[10..].copy_from_slice(&base[5..]);
        for (limit, k) in limits[5..7].iter_mut().zip(self.taper) {
            *limit = [(-TAPER - k).max(-0.4), (TAPER - k).min(0.4)];
        }
        let step = 0.5 / self.base.semi_axes.z;
        let most = (TURN / self.base.semi_axes.z).min(RATE);
        limits[7] = [(-most - self.twist).max(-step), (most - self.twist).min(step)];
        limits[8..10].fill([-step, step]);
        limits
    }

    /// That of the undeformed ellipsoid.
    fn log_area(&self) -> (f64, [f64; PARAMETERS]) {
        let (log, base) = self.base.log_area();
        let mut slopes = [0.0; PARAMETERS];
        slopes[..5].copy_from_slice(&base[..5]);
        (log, slopes)
    }

    /// Deformations are drawn to none, in proportion to what they do.
    fn penalty(&self) -> Option<[[f64; 2]; PARAMETERS]> {
        let height = self.base.semi_axes.z;
        let mut penalty = [[0.0; 2]; PARAMETERS];
        penalty[5] = [1.0, self.taper[0]];
        penalty[6] = [1.0, self.taper[1]];
        penalty[7] = [height * height, self.twist];
        penalty[8] = [height * height, self.bend.x];
        penalty[9] = [height * height, self.bend.y];
        Some(penalty)
    }
}

/// Deformations that change less than this share of the size are slight.
const SLIGHT: f64 = 0.15;

impl Deformable {
    /// Whether it is nearly a superellipsoid.
    pub(super) fn is_slight(&self) -> bool {
        let height = self.base.semi_axes.z;
        let [x, y] = self.taper;
        let all = [x, y, self.twist * height, self.bend.length() * height];
        all.iter().all(|size| size.abs() < SLIGHT)
    }

    /// The bend weakened to one that the solid keeps clear of the centre of.
    fn bent_validly(mut self) -> Deformable {
        let a = self.base.semi_axes;
        let [x, y] = [a.x * (1.0 + self.taper[0].abs()), a.y * (1.0 + self.taper[1].abs())];
        // The twisted solid's box is what must keep clear: a square, seen along the bend.
        let toward = self.bend.try_normalize().map_or(1.0, |u| u.x.abs() + u.y.abs());
        let most = (NEAR / (x.hypot(y) * toward)).min(ARC / a.z);
        self.bend = self.bend.clamp_length_max(most);
        self
    }
}
