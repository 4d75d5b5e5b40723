//! Bend of the z axis to a circle.
//!
//! ```text
//!     r = along u = (cos α, sin α) of (x, y), γ = κ z
//!     inverse: R = u·(X, Y),  h = √((1 − κR)² + (κZ)²),  γ = atan2(κZ, 1 − κR)
//!              r = (2R − κ(R² + Z²))/(1 + h),  z = γ/κ
//! ```
//!
//! Sources: A. H. Barr, *Global and local deformations of solid primitives* (1984);
//! F. Solina and R. Bajcsy (1990), with their bend put right for κ < 0, |γ| > π/2 and κ → 0.

use glam::DVec3;

use super::{Warp, meets_cut};
use crate::{Angle, Bounds, Dual, Euclid, Interval, Real};
use crate::{ParamError, check};
use rvachev_num::figures;

/// Bend of the z axis to a circle, in the plane of z and (cos angle, sin angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Curvature of the bent axis, per length unit.
    pub curvature: f64,
    /// Direction towards the centre of curvature, from the x axis towards y.
    pub angle: Angle,
}

impl Bend {
    /// Below this curvature a bend moves nothing that could be seen.
    const FLAT: f64 = 1e-30;

    /// The ranges of (1 − cos κz)/κ and of sin κz/κ over one of z.
    fn turned(&self, z: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        use std::f64::consts::{FRAC_PI_2, PI};
        let k = self.curvature;
        let bow = |z: f64| z * (0.5 * k * z).sin() * sinc(0.5 * k * z);
        let along = |z: f64| z * sinc(k * z);
        let (near, far) =
            (if z[0] <= 0.0 && z[1] >= 0.0 { 0.0 } else { z[0].abs().min(z[1].abs()) }, z[0].abs().max(z[1].abs()));
        let (q, s) = ([bow(near), bow(far)], [along(z[0]), along(z[1])]);
        let holds = |turn: f64| (z[0].min(z[1]) * k.abs()..=z[0].max(z[1]) * k.abs()).contains(&turn);
        if far * k.abs() > PI {
            return ([0.0, 2.0 / k], [-1.0 / k.abs(), 1.0 / k.abs()]);
        }
        let low = if holds(-FRAC_PI_2) { -1.0 / k.abs() } else { s[0].min(s[1]) };
        let high = if holds(FRAC_PI_2) { 1.0 / k.abs() } else { s[0].max(s[1]) };
        (q, [low, high])
    }
}

impl Warp for Bend {
    const NAME: &'static str = "bend";

    /// Slopes have no bounds where it is cut.
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let k = self.curvature;
        if k.abs() < Bend::FLAT {
            return [x, y, z];
        }
        let (sin, cos) = self.angle.radians().sin_cos();
        let big_r = x.scale_add(cos, y * sin);
        let opposite = z * k;
        let adjacent = big_r.scale_add(-k, z.lift(1.0));
        let h = adjacent.norm_as(opposite, Euclid);
        let bow = big_r.mul_add(big_r, z.square());
        let r = (big_r * 2.0 - bow * k) / (h + 1.0);
        let shift = r - big_r;
        [shift.scale_add(cos, x), shift.scale_add(sin, y), opposite.atan2(adjacent) * (1.0 / k)]
    }

    fn slopes(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        let mut image = self.inverse(p);
        let (sin, cos) = self.angle.radians().sin_cos();
        let [x, y, z] = p.map(Dual::value);
        let k = self.curvature;
        if meets_cut(z * k, (x * cos + y * sin).scale_add(-k, Interval::point(1.0))) {
            image[2].d = [Interval::ALL; 3];
        }
        image
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let k = self.curvature;
        let (sin, cos) = self.angle.radians().sin_cos();
        let r = p.x * cos + p.y * sin;
        let gamma = k * p.z;
        let shift = (1.0 - k * r) * p.z * (0.5 * gamma).sin() * sinc(0.5 * gamma);
        DVec3::new(p.x + cos * shift, p.y + sin * shift, (1.0 - k * r) * p.z * sinc(gamma))
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        if !b.is_finite() {
            return Bounds::ALL;
        }
        // With q = (1 − cos γ)/κ and s = sin γ/κ a point goes to r + q (1 − κ r) and (1 − κ r) s:
        // linear in each coordinate across, in q and in s, so that the corners of their ranges tell
        // the box.
        let k = self.curvature;
        let (sin, cos) = self.angle.radians().sin_cos();
        let (bow, along) = self.turned([b.min.z, b.max.z]);
        let mut bounds = Bounds::EMPTY;
        for corner in b.corners() {
            let left = 1.0 - k * (corner.x * cos + corner.y * sin);
            for (q, s) in bow.into_iter().zip(along) {
                let image = DVec3::new(corner.x + cos * q * left, corner.y + sin * q * left, left * s);
                bounds = bounds.union(&Bounds::new(image, image));
            }
        }
        bounds.inflate(1e-14 * (b.min.abs().max(b.max.abs()).max_element() + bounds.longest_side()))
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        check::finite("curvature", self.curvature)?;
        check::angle("angle", self.angle, -1e9, 1e9)?;
        if self.curvature.abs() < Bend::FLAT || b.is_empty() {
            return Ok(());
        }
        // Conservative: the box of the solid, rather than the solid, must stay on this side
        // of the centre of curvature and within half a turn.
        let (sin, cos) = self.angle.radians().sin_cos();
        let inward = self.curvature.signum() * DVec3::new(cos, sin, 0.0);
        let reach = b.corners().into_iter().map(|c| c.dot(inward)).fold(f64::NEG_INFINITY, f64::max);
        let reach = if reach.is_nan() { f64::INFINITY } else { reach };
        let height = b.min.z.abs().max(b.max.z.abs());
        let by_reach = if reach > 0.0 { 1.0 / reach } else { f64::INFINITY };
        let limit = by_reach.min(std::f64::consts::PI / height);
        if self.curvature.abs() < limit {
            return Ok(());
        }
        Err(ParamError::new(
            "curvature",
            self.curvature,
            format_args!(
                "below {} in absolute value: the box of the bent solid reaches {} towards the \
                 centre of curvature (1/curvature must be beyond) and {} along z (a half turn at most)",
                figures(limit, 6),
                figures(reach, 6),
                figures(height, 6)
            ),
        ))
    }

    fn roundoff(&self, reach: f64) -> f64 {
        1e-6 * reach * (1.0 + (self.curvature * reach).abs())
    }
}

/// `sin(x)/x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}
