//! Global deformations: taper, twist and bend, by their exact inverses.
//!
//! ```text
//!     TAPER  t = clamp(z/h, −1, 1),  s = 1 + K t      X = s_x x, Y = s_y y, Z = z
//!     TWIST  φ = ω z                                  rotation by φ about z
//!     BEND   r = along u = (cos α, sin α) of (x, y), γ = κ z
//!            inverse: R = u·(X, Y),  h = √((1 − κR)² + (κZ)²),  γ = atan2(κZ, 1 − κR)
//!                     r = (2R − κ(R² + Z²))/(1 + h),  z = γ/κ
//! ```
//!
//! The field of a deformed solid at X is that of the solid at the pre-image of X. None of
//! the three has a smallest stretch over all of space, so values are not rescaled: near the
//! solid they are lengths up to the local stretch, and no Lipschitz constant is promised.
//!
//! Sources: A. H. Barr, *Global and local deformations of solid primitives* (1984);
//! F. Solina and R. Bajcsy (1990), with their bend put right for κ < 0, |γ| > π/2 and κ → 0.

use std::any::Any;
use std::fmt::Debug;

use glam::DVec3;

use super::{Chunk, ParamError, check};
use crate::num::symbol::Symbol;
use crate::{Bounds, Dual, Interval, Real};

/// A deformation of space: the inverse map, generic over the number.
pub(crate) trait Warp: Debug + Clone + Send + Sync + 'static {
    const NAME: &'static str;

    /// The pre-image of a point.
    fn inverse<R: Real>(&self, p: [R; 3]) -> [R; 3];

    /// The image of a point: what [`inverse`](Warp::inverse) is tested against.
    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3;

    /// A box that holds the image of a box.
    fn bounds(&self, bounds: &Bounds) -> Bounds;

    /// Whether the parameters are in range for a solid within `bounds`.
    fn check(&self, bounds: &Bounds) -> Result<(), ParamError>;

    /// How far lanes of `f32` may be from the true pre-image at points within `reach`.
    fn roundoff(&self, reach: f64) -> f64;
}

/// A [`Warp`], erased to the evaluations that the engine runs.
pub(crate) trait AnyWarp: Any + Debug + Send + Sync {
    fn name(&self) -> &'static str;
    fn point(&self, p: [f64; 3]) -> [f64; 3];
    fn duals(&self, p: [Dual<f64>; 3]) -> [Dual<f64>; 3];
    fn dual_ranges(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3];
    fn symbols<'a>(&self, p: [Symbol<'a>; 3]) -> [Symbol<'a>; 3];
    fn lanes32(&self, chunk: Chunk<'_, f32, 3>);
    fn lanes64(&self, chunk: Chunk<'_, f64, 3>);
    fn jacobians(&self, chunk: Chunk<'_, f32, 12>);
    fn bounds(&self, bounds: &Bounds) -> Bounds;
    fn check(&self, bounds: &Bounds) -> Result<(), ParamError>;
    fn roundoff(&self, reach: f64) -> f64;
}

/// Linear taper along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Taper {
    pub(crate) kx: f64,
    pub(crate) ky: f64,
    pub(crate) half_height: f64,
}

impl Warp for Taper {
    const NAME: &'static str = "taper";

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let one = z.lift(1.0);
        let t = (z * (1.0 / self.half_height)).min(one).max(-one);
        [x / t.scale_add(self.kx, one), y / t.scale_add(self.ky, one), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let t = (p.z / self.half_height).clamp(-1.0, 1.0);
        DVec3::new(p.x * (1.0 + self.kx * t), p.y * (1.0 + self.ky * t), p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        // Linear in t for fixed (x, y): extremes are at the ends of t's range.
        let t = [b.min.z, b.max.z].map(|z| (z / self.half_height).clamp(-1.0, 1.0));
        let mut out = Bounds::new(DVec3::INFINITY, DVec3::NEG_INFINITY);
        for t in t {
            let s = DVec3::new(1.0 + self.kx * t, 1.0 + self.ky * t, 1.0);
            out = out.union(&Bounds::new(b.min * s, b.max * s));
        }
        out
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        check::length("half_height", self.half_height)?;
        for (name, k) in [("kx", self.kx), ("ky", self.ky)] {
            if k.is_nan() || k.abs() > 0.999 {
                return Err(ParamError::new(
                    name,
                    k,
                    "-0.999 to 0.999 (beyond, the section shrinks to a point or turns inside out)",
                ));
            }
        }
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let stretch = 1.0 / (1.0 - self.kx.abs().max(self.ky.abs()));
        5e-7 * reach * stretch
    }
}

/// Rotation about z in proportion to z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twist {
    /// Radians per length unit.
    pub(crate) rate: f64,
}

impl Warp for Twist {
    const NAME: &'static str = "twist";

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let (sin, cos) = (z * self.rate).sin_cos();
        [x.mul_add(cos, y * sin), y.mul_add(cos, -(x * sin)), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let (sin, cos) = (p.z * self.rate).sin_cos();
        DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let (sin, cos) = (Interval::new(b.min.z, b.max.z) * self.rate).sin_cos();
        let (x, y) = (Interval::new(b.min.x, b.max.x), Interval::new(b.min.y, b.max.y));
        // The circle of the farthest corner holds every turn of the section.
        let reach = x.norm(y, crate::Norm::Euclid).hi();
        let disc = Interval::new(-reach, reach);
        let (x, y) = ((x * cos - y * sin).narrowed_by(disc), (x * sin + y * cos).narrowed_by(disc));
        Bounds::new(DVec3::new(x.lo(), y.lo(), b.min.z), DVec3::new(x.hi(), y.hi(), b.max.z))
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        check::finite("rate", self.rate)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // The angle is rounded relative to itself; beyond some thousand radians the lanes'
        // argument reduction adds its part.
        5e-7 * reach * (1.0 + (self.rate * reach).abs())
    }
}

/// Bend of the z axis to a circle, in the plane of z and (cos angle, sin angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    /// Curvature of the bent axis, per length unit.
    pub(crate) curvature: f64,
    /// Direction towards the centre of curvature, radians from the x axis.
    pub(crate) angle: f64,
}

impl Bend {
    /// Below this curvature a bend moves nothing that could be seen.
    const FLAT: f64 = 1e-30;
}

impl Warp for Bend {
    const NAME: &'static str = "bend";

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let k = self.curvature;
        if k.abs() < Bend::FLAT {
            return [x, y, z];
        }
        let (sin, cos) = self.angle.sin_cos();
        let big_r = x.scale_add(cos, y * sin);
        let opposite = z * k;
        let adjacent = big_r.scale_add(-k, z.lift(1.0));
        let h = adjacent.norm(opposite, crate::Norm::Euclid);
        let bow = big_r.mul_add(big_r, z.square());
        let r = (big_r * 2.0 - bow * k) / (h + 1.0);
        let shift = r - big_r;
        [shift.scale_add(cos, x), shift.scale_add(sin, y), opposite.atan2(adjacent) * (1.0 / k)]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let k = self.curvature;
        let (sin, cos) = self.angle.sin_cos();
        let r = p.x * cos + p.y * sin;
        let gamma = k * p.z;
        let shift = (1.0 - k * r) * p.z * (0.5 * gamma).sin() * sinc(0.5 * gamma);
        DVec3::new(p.x + cos * shift, p.y + sin * shift, (1.0 - k * r) * p.z * sinc(gamma))
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        if !b.is_finite() {
            return Bounds::ALL;
        }
        let k = self.curvature;
        let (sin, cos) = self.angle.sin_cos();
        let (x, y) = (Interval::new(b.min.x, b.max.x), Interval::new(b.min.y, b.max.y));
        let r = x * cos + y * sin;
        let across = (y * cos - x * sin).inflate(0.0);
        // Slices of z keep the dependence of sine and cosine on z small.
        const SLICES: u32 = 64;
        let mut bounds = Bounds::EMPTY;
        for slice in 0..SLICES {
            let at = |i: u32| b.min.z + (b.max.z - b.min.z) * f64::from(i) / f64::from(SLICES);
            let z = Interval::new(at(slice), at(slice + 1)).inflate(1e-12 * b.max.z.abs());
            let left = (-r * k) + 1.0;
            let half_turn = z * (0.5 * k);
            let big_r = r + left * z * half_turn.sin_cos().0 * sinc_range(half_turn);
            let big_z = left * z * sinc_range(z * k);
            let x = big_r * cos - across * sin;
            let y = big_r * sin + across * cos;
            bounds = bounds
                .union(&Bounds::new(DVec3::new(x.lo(), y.lo(), big_z.lo()), DVec3::new(x.hi(), y.hi(), big_z.hi())));
        }
        bounds
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        check::finite("curvature", self.curvature)?;
        check::finite("angle", self.angle)?;
        if self.curvature.abs() < Bend::FLAT {
            return Ok(());
        }
        // Conservative: the box of the solid, rather than the solid, must stay on this side
        // of the centre of curvature and within half a turn.
        let (sin, cos) = self.angle.sin_cos();
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
                "below {limit:.6} in absolute value: the box of the bent solid reaches {reach:.6} towards the \
                 centre of curvature (1/curvature must be beyond) and {height:.6} along z (a half turn at most)"
            ),
        ))
    }

    fn roundoff(&self, reach: f64) -> f64 {
        1e-6 * reach * (1.0 + (self.curvature * reach).abs())
    }
}

/// Range of `sin(x)/x`, which falls from 1 at 0 to 0 at ±π.
fn sinc_range(x: Interval) -> Interval {
    let a = x.abs();
    let lo = if a.hi() < std::f64::consts::PI { sinc(a.hi()) } else { -0.25 };
    let hi = if a.lo() < std::f64::consts::PI { sinc(a.lo()) } else { 0.25 };
    Interval::new(lo, hi).inflate(1e-15)
}

/// `sin(x)/x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trip(warp: &impl Warp, p: DVec3) -> f64 {
        let back = warp.inverse(warp.forward(p).to_array());
        (DVec3::from_array(back) - p).length()
    }

    #[test]
    fn bends_agree_with_the_reference_and_invert() {
        let p = DVec3::new(0.3, -0.2, 1.5);
        for (curvature, image) in [
            (0.6, DVec3::new(0.696758009844, 0.270287132591, 1.273755738266)),
            (-0.6, DVec3::new(-0.116561782390, -0.693761036518, 1.337333960492)),
        ] {
            let bend = Bend { curvature, angle: 0.87 };
            assert!((bend.forward(p) - image).length() < 1e-11);
            assert!(round_trip(&bend, p) < 1e-14);
        }
        let far = Bend { curvature: 0.6, angle: 0.87 };
        let image = far.forward(DVec3::new(0.3, -0.2, 4.0));
        assert!((image - DVec3::new(2.121731058144, 1.959343112000, 1.098360201393)).length() < 1e-11);
        assert!(round_trip(&far, DVec3::new(0.3, -0.2, 4.0)) < 1e-13);
    }

    #[test]
    fn bends_of_any_curvature_invert() {
        for curvature in [0.6, -0.6, 1e-3, 1e-9, -1e-12, 0.0] {
            let bend = Bend { curvature, angle: 0.3 };
            for i in 0..1000 {
                let t = |k: f64| ((f64::from(i) * k).fract() - 0.5) * 2.0;
                let p = DVec3::new(0.5 * t(0.618), 0.7 * t(0.414), 2.0 * t(0.732));
                assert!(round_trip(&bend, p) < 1e-14, "{curvature} {p}");
            }
        }
    }

    #[test]
    fn a_chain_agrees_with_the_reference() {
        let p = DVec3::new(0.4, 0.5, 1.2);
        let taper = Taper { kx: 0.5, ky: -0.4, half_height: 2.0 };
        let (twist, bend) = (Twist { rate: 0.6 }, Bend { curvature: 0.3, angle: 0.5 });
        let image = bend.forward(twist.forward(taper.forward(p)));
        assert!((image - DVec3::new(0.304009419006, 0.717961296813, 1.024693146673)).length() < 1e-11);
        assert!(round_trip(&taper, p) < 1e-15 && round_trip(&twist, p) < 1e-15);
    }

    #[test]
    fn boxes_hold_images() {
        let bounds = Bounds::new(DVec3::new(-0.5, -0.7, -2.0), DVec3::new(0.6, 0.4, 1.5));
        let warps: [(&str, &dyn AnyWarp); 3] = [
            ("taper", &Taper { kx: 0.5, ky: -0.4, half_height: 2.0 }),
            ("twist", &Twist { rate: 1.3 }),
            ("bend", &Bend { curvature: -0.6, angle: 0.4 }),
        ];
        for (name, warp) in warps {
            let image = warp.bounds(&bounds);
            for i in 0..4000 {
                let t = |k: f64| (f64::from(i) * k).fract();
                // Outside of the image box no point may have its pre-image in the box.
                let p = image.center() + image.size() * (DVec3::new(t(0.618), t(0.414), t(0.732)) - 0.5) * 1.5;
                let back = DVec3::from_array(warp.point(p.to_array()));
                assert!(image.contains(p) || !bounds.contains(back), "{name} {p}");
            }
        }
    }
}
