//! Superellipse (Lamé curve).
//!
//! ```text
//!     G = ‖(x/a, y/b)‖ with p = 2/e       e → 0  rectangle,  e = 1  ellipse
//!     f = r_in·(1 − G)                    e = 2  rhombus,    e > 2  pinched
//! ```
//!
//! The plane section of a [`Superellipsoid`](crate::Superellipsoid), valued in the same way.

use glam::{DVec2, DVec3};

use super::super::{Case, Field, Kernel, ParamError, check, leaf::falling_range};
use super::{column, flattened};
use crate::{Bounds, Euclid, Interval, Norm, NormKind, Powers, Real};

/// A superellipse (Lamé curve) about the origin of the plane, valued `f = r_in·(1 − G)` in
/// length units: `G = (|x/a|^(2/e) + |y/b|^(2/e))^(e/2)` is the gauge and `r_in` the radius of
/// the largest inscribed circle.
///
#[doc = picture!("profile_superellipse" = "docs/gallery/profile_superellipse.png")]
///
/// 1-Lipschitz for an exponent of at most 2, and so never more than the distance; beyond, the
/// curve is pinched along the axes and slopes are unbounded there.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each |
/// | `exponent` | none | 0.01 to 10: 0 square, 1 round, 2 bevelled |
///
/// ```
/// use rvachev::{Profile, Superellipse};
/// use glam::DVec2;
///
/// let squircle = Profile::from(Superellipse::new(DVec2::new(2.0, 1.0), 0.5));
/// assert!(squircle.contains(DVec2::new(1.6, 0.8))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superellipse {
    semi_axes: DVec2,
    exponent: f64,
    inverse: DVec2,
    norm: Norm,
    inscribed: f64,
}

impl Superellipse {
    /// The superellipse with these semi-axes and exponent; they are checked when the profile
    /// is compiled.
    #[must_use]
    pub fn new(semi_axes: impl Into<DVec2>, exponent: f64) -> Superellipse {
        let semi_axes = semi_axes.into();
        let inverse = semi_axes.recip();
        // The norm dual to that of G bounds its slope.
        let slope = Norm::new(if exponent <= 1.0 { f64::INFINITY } else { 2.0 / (exponent - 1.0) });
        Superellipse {
            semi_axes,
            exponent,
            inverse,
            norm: Norm::of_exponent(exponent),
            inscribed: 1.0 / inverse.x.norm(inverse.y, slope),
        }
    }

    /// The semi-axes.
    #[must_use]
    pub fn semi_axes(&self) -> DVec2 {
        self.semi_axes
    }

    /// The exponent.
    #[must_use]
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// The gauge G: below 1 inside, 1 on the curve; `p / G(p)` lies on the curve.
    #[must_use]
    pub fn gauge(&self, p: DVec2) -> f64 {
        self.gauge_of(p.x, p.y)
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, x: R, y: R) -> R {
        (x * self.inverse.x).norm(y * self.inverse.y, self.norm)
    }
}

/// A superellipse by the kind of its norm.
struct OfKind<N> {
    inverse: DVec2,
    inscribed: f64,
    norm: N,
}

impl<N: NormKind> Case for OfKind<N> {
    #[inline(always)]
    fn value<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let gauge = (x * self.inverse.x).norm_as(y * self.inverse.y, self.norm);
        gauge.scale_add(-self.inscribed, x.lift(self.inscribed))
    }
}

impl Field for Superellipse {
    fn name(&self) -> &'static str {
        "superellipse"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        self.gauge_of(x, y).scale_add(-self.inscribed, x.lift(self.inscribed))
    }

    fn bounds(&self) -> Bounds {
        column(self.semi_axes)
    }

    fn creases(&self) -> Vec<DVec3> {
        if self.exponent > 2.0 { vec![DVec3::X, DVec3::Y] } else { Vec::new() }
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("semi_axes.x", self.semi_axes.x)?;
        check::length("semi_axes.y", self.semi_axes.y)?;
        check::within("exponent", self.exponent, 0.01, 10.0)
    }

    fn convex(&self) -> bool {
        self.exponent <= 2.0
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, flattened(region))
    }

    fn support(&self, d: DVec3) -> f64 {
        if d.z != 0.0 {
            return f64::INFINITY;
        }
        let dual = Norm::new(if self.exponent >= 2.0 { f64::INFINITY } else { 2.0 / (2.0 - self.exponent) });
        let d = (d.truncate() * self.semi_axes).abs();
        d.x.norm(d.y, dual) * (1.0 + 1e-14)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        let Superellipse { inverse, inscribed, .. } = *self;
        match self.norm {
            Norm::Euclid => kernel.run_case(&OfKind { inverse, inscribed, norm: Euclid }),
            Norm::P { p, inv } => kernel.run_case(&OfKind { inverse, inscribed, norm: Powers::<false> { p, inv } }),
            other => kernel.run_case(&OfKind { inverse, inscribed, norm: Powers::steep(other) }),
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let size = self.semi_axes.max_element().min(reach);
        if self.convex() {
            return 4e-6 * size;
        }
        // Across a cusp a displacement d of a coordinate moves G by (d/a)^(2/e).
        let displaced = 1e-6 * reach / self.semi_axes.min_element();
        size * (4e-6 + 4.0 * displaced.powf(2.0 / self.exponent))
    }
}
