//! Supertoroid.
//!
//! ```text
//!     ρ = ‖(x/a₁, y/a₂)‖    with p = 2/e₂        ring: e₂ → 0 square, 1 round, 2 bevelled
//!     G = ‖(ρ − ring, z/a₃)‖ with p = 2/e₁       tube: the same by e₁
//!     f = r·(1 − G)                              1/r: the largest slope of G
//!
//!        z ↑   ╭───╮           ╭───╮ a₃
//!          │   │ · │     ·     │ · │────→ x/a₁
//!              ╰───╯           ╰───╯
//!                        0     ring  ring + 1
//! ```
//!
//! G is the gauge in tube radii: the factor by which the tube is thickened about its core to
//! carry the surface through the point. x and y enter through ρ alone and ρ through one term,
//! so plain interval arithmetic gives the exact range.
//!
//! Where Barr's parametric form has a ring below 1, part of its patch is not on the zero set;
//! such rings are refused.
//!
//! Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981), who writes
//! `R/√(a₁² + a₂²)` for the ring.

use glam::DVec3;

use super::superellipsoid::{slope_norm, support_norm};
use super::{Case, Field, Kernel, ParamError, check};
use crate::{Bounds, Norm, Powers, Real};

/// The ring is at most this many tube radii: beyond, single precision has no digits left for
/// the tube.
const LARGEST_RING: f64 = 1000.0;

/// A supertoroid about the z axis, centred at the origin, valued `f = r·(1 − G)` in length
/// units, where `1/r` is the largest slope of the gauge G.
///
#[doc = picture!(
    "supertoroid" = "docs/gallery/supertoroid.png",
    "supertoroid_frame" = "docs/gallery/supertoroid_frame.png",
    "supertoroid_bevelled" = "docs/gallery/supertoroid_bevelled.png",
)]
///
/// ```text
/// ρ = (|x/a₁|^(2/e₂) + |y/a₂|^(2/e₂))^(e₂/2)
/// G = (|ρ − ring|^(2/e₁) + |z/a₃|^(2/e₁))^(e₁/2)
/// ```
///
/// 1-Lipschitz where both exponents are at most 2, and so never more than the distance;
/// beyond, it is pinched and no Lipschitz constant exists. It is not convex.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each: half-widths of the tube along x, y and z |
/// | `ring` | `semi_axes.x` along x, `semi_axes.y` along y | 1 (no hole) to 1000: radius of the tube's core |
/// | `e1` | none | 0.01 to 10: shapes the tube's section (0 square, 1 round, 2 bevelled) |
/// | `e2` | none | 0.01 to 10: shapes the ring |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)` of the true value for exponents
/// of 0.05 to 2, `size` being the larger of x and y half-extent of the solid.
///
/// Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981), who writes
/// `R/√(a₁² + a₂²)` for the ring.
///
/// ```
/// use rvachev::{Solid, Supertoroid};
/// use glam::DVec3;
///
/// let frame = Supertoroid::new(DVec3::new(1.2, 0.8, 0.6), 1.5, 0.3, 0.7);
/// let p = DVec3::new(1.5, 0.4, 0.2);
/// assert!((frame.gauge(p) - 0.336280192061495).abs() < 1e-14);
/// assert!(Solid::from(frame).contains(p)?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supertoroid {
    semi_axes: DVec3,
    ring: f64,
    e1: f64,
    e2: f64,
    inverse: DVec3,
    inner: Norm,
    outer: Norm,
    scale: f64,
}

impl Supertoroid {
    /// The supertoroid with these half-widths of the tube, this radius of the core in terms of
    /// them, and these exponents; they are checked when the solid is compiled.
    #[must_use]
    pub fn new(semi_axes: impl Into<DVec3>, ring: f64, e1: f64, e2: f64) -> Supertoroid {
        let semi_axes = semi_axes.into();
        let inverse = semi_axes.recip();
        Supertoroid {
            semi_axes,
            ring,
            e1,
            e2,
            inverse,
            inner: Norm::of_exponent(e2),
            outer: Norm::of_exponent(e1),
            scale: 1.0 / inverse.x.norm(inverse.y, slope_norm(e2)).norm(inverse.z, slope_norm(e1)),
        }
    }

    /// The half-widths of the tube.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// The radius of the tube's core, in terms of the semi-axes.
    #[must_use]
    pub fn ring(&self) -> f64 {
        self.ring
    }

    /// The exponents `[e1, e2]`.
    #[must_use]
    pub fn exponents(&self) -> [f64; 2] {
        [self.e1, self.e2]
    }

    /// The gauge G in tube radii: 0 on the core, below 1 inside, 1 on the surface.
    #[must_use]
    pub fn gauge(&self, p: DVec3) -> f64 {
        self.gauge_of(p.to_array())
    }

    /// Barr's inside–outside function `F = G^(2/e1)`: below 1 inside.
    #[must_use]
    pub fn barr(&self, p: DVec3) -> f64 {
        self.gauge(p).powf(2.0 / self.e1)
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let i = self.inverse;
        let rho = (x * i.x).norm(y * i.y, self.inner);
        (rho - self.ring).norm(z * i.z, self.outer)
    }

    fn half_extents(&self) -> DVec3 {
        self.semi_axes * DVec3::new(self.ring + 1.0, self.ring + 1.0, 1.0)
    }
}

/// A supertoroid on lanes, whatever its exponents are.
struct ByPowers {
    inverse: DVec3,
    ring: f64,
    scale: f64,
    norms: [Powers<true>; 2],
}

impl Case for ByPowers {
    #[inline(always)]
    fn value<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (i, [inner, outer]) = (self.inverse, self.norms);
        let rho = (x * i.x).norm_as(y * i.y, inner);
        (rho - self.ring).norm_as(z * i.z, outer).scale_add(-self.scale, x.lift(self.scale))
    }
}

impl Field for Supertoroid {
    fn name(&self) -> &'static str {
        "supertoroid"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        self.gauge_of(p).scale_add(-self.scale, p[0].lift(self.scale))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-self.half_extents(), self.half_extents())
    }

    fn creases(&self) -> Vec<DVec3> {
        let pinched = [self.e2 > 2.0, self.e2 > 2.0, self.e1 > 2.0];
        DVec3::AXES.into_iter().zip(pinched).filter_map(|(axis, is_pinched)| is_pinched.then_some(axis)).collect()
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("semi_axes", self.semi_axes)?;
        check::within("ring", self.ring, 1.0, LARGEST_RING)?;
        check::within("e1", self.e1, 0.01, 10.0)?;
        check::within("e2", self.e2, 0.01, 10.0)
    }

    fn support(&self, direction: DVec3) -> f64 {
        let d = (direction * self.semi_axes).abs();
        let across = d.x.norm(d.y, support_norm(self.e2));
        (self.ring * across + across.norm(d.z, support_norm(self.e1))) * (1.0 + 1e-14)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        let Supertoroid { inverse, ring, scale, .. } = *self;
        kernel.run_case(&ByPowers {
            inverse,
            ring,
            scale,
            norms: [Powers::steep(self.inner), Powers::steep(self.outer)],
        });
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // A horn's surface passes the origin, where a tube radius is what errors are relative to.
        let size = self.half_extents().length().min(reach + self.scale);
        let p = self.inner.p().min(1.0) * self.outer.p().min(1.0);
        if p == 1.0 {
            return 4e-6 * size;
        }
        // Across a cusp a displacement d of a coordinate moves G by some (d/a)^p / p.
        let displaced = 1e-6 * reach / self.semi_axes.min_element();
        size * (4e-6 + 4.0 / p * displaced.powf(p))
    }
}
