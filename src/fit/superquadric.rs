//! Superellipsoids as a family to fit.
//!
//! ```text
//!     w_z = (|z|/(a₃G))^p₁    w_ρ = 1 − w_z    v_x = (|x|/(a₁ρ))^p₂    v_y = 1 − v_x    H = entropy
//!     ∂ln G/∂e₁ = H(w)/2     ∂ln G/∂e₂ = w_ρ·H(v)/2     ∂ln G/∂ln a = −(w_ρv_x, w_ρv_y, w_z)
//! ```
//!
//! All terms are bounded. The gradient of ln G is (w_ρv_x/x, w_ρv_y/y, w_z/z).

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI, SQRT_2};

use glam::{DMat3, DVec3};
use rvachev_num::Real;

use super::kernel::{LogGauge, Model, joined};
use super::pose;

/// Parameters: two exponents, three logarithms of semi-axes, and the pose.
pub(super) const PARAMETERS: usize = 11;

/// The range of the exponents: convex ones that a surface can be told from.
pub(super) const EXPONENTS: [f64; 2] = [0.01, 2.0];

/// The range of the semi-axes, in units of the cloud's root mean square radius.
const SEMI_AXES: [f64; 2] = [1e-4, 1e2];

/// The power of Thomsen's approximation of an ellipsoid's area.
const THOMSEN: f64 = 1.6075;

#[derive(Clone, Copy, Debug)]
pub(super) struct Superquadric {
    pub(super) e: [f64; 2],
    pub(super) semi_axes: DVec3,
    pub(super) rotation: DMat3,
    pub(super) center: DVec3,
}

impl Model<PARAMETERS> for Superquadric {
    fn pose(&self) -> (DMat3, DVec3) {
        (self.rotation, self.center)
    }

    #[inline(always)]
    fn log_gauge<R: Real>(&self, q: [R; 3], rows: &mut [R; PARAMETERS]) -> LogGauge<R> {
        log_gauge(self.e, self.semi_axes, q, rows)
    }

    fn sizes(&self) -> (std::ops::Range<usize>, f64) {
        (2..5, 0.5 * self.semi_axes.element_product().ln())
    }

    fn moved(&self, step: &[f64; PARAMETERS]) -> Superquadric {
        let e = [0, 1].map(|k| (self.e[k] + step[k]).clamp(EXPONENTS[0], EXPONENTS[1]));
        let semi_axes = self.semi_axes * DVec3::new(step[2].exp(), step[3].exp(), step[4].exp());
        let (rotation, center) = pose::moved(self.rotation, self.center, &step[5..]);
        Superquadric { e, semi_axes, rotation, center }
    }

    fn limits(&self) -> [[f64; 2]; PARAMETERS] {
        let mut limits = [[0.0; 2]; PARAMETERS];
        for (limit, e) in limits.iter_mut().zip(self.e) {
            *limit = [(EXPONENTS[0] - e).max(-0.5), (EXPONENTS[1] - e).min(0.5)];
        }
        for (limit, a) in limits[2..5].iter_mut().zip(self.semi_axes.to_array()) {
            *limit = [(SEMI_AXES[0] / a).ln().max(-0.7), (SEMI_AXES[1] / a).ln().min(0.7)];
        }
        limits[5..8].fill([-0.5, 0.5]);
        let reach = 2.0 * self.semi_axes.max_element();
        limits[8..].fill([-reach, reach]);
        limits
    }

    /// That of an ellipsoid: Knud Thomsen's formula.
    fn log_area(&self) -> (f64, [f64; PARAMETERS]) {
        let [a, b, c] = self.semi_axes.to_array().map(|a| a.powf(THOMSEN));
        let sum = a * b + a * c + b * c;
        let mut slopes = [0.0; PARAMETERS];
        slopes[2..5].copy_from_slice(&[(a * b + a * c) / sum, (a * b + b * c) / sum, (a * c + b * c) / sum]);
        ((4.0 * PI).ln() + (sum / 3.0).ln() / THOMSEN, slopes)
    }
}

/// A share over a coordinate: shares vanish at 0 as |x|^p, p ≥ 1.
#[inline(always)]
fn over<R: Real>(share: R, x: R, a: f64) -> R {
    share * x / (x.square() + (1e-10 * a).powi(2))
}

/// `ln G`, its gradient, and its derivatives by the exponents and the logarithms of the semi-axes.
#[inline(always)]
pub(super) fn log_gauge<R: Real, const N: usize>(
    [e1, e2]: [f64; 2],
    semi_axes: DVec3,
    q: [R; 3],
    rows: &mut [R; N],
) -> LogGauge<R> {
    let [x, y, z] = q;
    let inverse = semi_axes.recip();
    let (u, v, w) = ((x.abs() * inverse.x).log2(), (y.abs() * inverse.y).log2(), (z.abs() * inverse.z).log2());
    let (across, vx, vy, inner) = joined(u * (2.0 / e2), v * (2.0 / e2));
    let (along, wr, wz, outer) = joined(across * (e2 / e1), w * (2.0 / e1));
    rows[0] = outer * 0.5;
    rows[1] = wr * inner * 0.5;
    let (sx, sy) = (wr * vx, wr * vy);
    (rows[2], rows[3], rows[4]) = (-sx, -sy, -wz);
    let gradient = [over(sx, x, semi_axes.x), over(sy, y, semi_axes.y), over(wz, z, semi_axes.z)];
    let radius = (x.square() + y.square() + z.square() + 1e-30).sqrt();
    LogGauge { log2: along * (0.5 * e1), gradient, radius }
}

impl Superquadric {
    /// The same solid written with another axis as the polar one, where both exponents agree; else
    /// one like it. `turns` cyclic shifts.
    pub(super) fn permuted(&self, turns: usize) -> Superquadric {
        let (r, a) = (self.rotation, self.semi_axes);
        match turns % 3 {
            0 => *self,
            1 => Superquadric {
                e: [self.e[1], self.e[0]],
                semi_axes: DVec3::new(a.y, a.z, a.x),
                rotation: DMat3::from_cols(r.y_axis, r.z_axis, r.x_axis),
                ..*self
            },
            _ => Superquadric {
                e: [self.e[1], self.e[0]],
                semi_axes: DVec3::new(a.z, a.x, a.y),
                rotation: DMat3::from_cols(r.z_axis, r.x_axis, r.y_axis),
                ..*self
            },
        }
    }

    /// The solid turned by 45° about z that looks like it: a square is a square's dual, of exponent
    /// 2 − e. Only where the semi-axes across z are alike. Source: W. Liu et al., *Robust and
    /// accurate superquadric recovery* (2022).
    pub(super) fn dual(&self) -> Option<Superquadric> {
        let a = self.semi_axes;
        let ratio = a.x / a.y;
        if !(0.5..=2.0).contains(&ratio) {
            return None;
        }
        let e = self.e[1];
        let factor =
            if e <= 1.0 { (1.0 - SQRT_2) * e + SQRT_2 } else { (FRAC_1_SQRT_2 - 1.0) * e + 2.0 - FRAC_1_SQRT_2 };
        let across = factor * a.x.min(a.y);
        Some(Superquadric {
            e: [self.e[0], (2.0 - e).clamp(EXPONENTS[0], EXPONENTS[1])],
            semi_axes: DVec3::new(across, across, a.z),
            rotation: self.rotation * DMat3::from_rotation_z(FRAC_PI_4),
            center: self.center,
        })
    }
}
