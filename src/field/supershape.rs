//! Supershape: the spherical product of two Gielis curves.
//!
//! ```text
//!     surface   ( a₁ r₁(θ)r₂(φ) cos θ cos φ,  a₂ r₁r₂ sin θ cos φ,  a₃ r₂(φ) sin φ )
//!     θ = atan2(y, x),  ρ = √(x² + y²),  φ = atan2(z·r₁, ρ),  λ = √((ρ/r₁)² + z²)
//!     G = λ / r₂(φ)      f = r_in·(1 − G)
//! ```
//!
//! after scaling by the semi-axes. G is the gauge, homogeneous of degree 1, and equals
//! 1 − F2 for Fougerolle's second field. Where the equator's m is odd with n2 ≠ n3 or a ≠ b
//! the surface has a crease at θ = π; where the meridian's radius is not stationary at the
//! pole it has a tip there.
//!
//! Source: Y. D. Fougerolle et al.; J. Gielis, B. Beirinckx, E. Bastiaens, *Superquadrics
//! with rational and irrational symmetry* (2003).

use std::f64::consts::PI;
use std::fmt;

use glam::DVec3;

use super::{Field, Gielis, Kernel, ParamError, Radius, check};
use crate::{Bounds, Dual, Interval, Norm, Real};

/// A supershape about the origin, valued `f = r_in·(1 − G)` in length units, where `r_in` is
/// the radius of a sphere about the origin inside it.
///
/// In general not convex: no Lipschitz constant is promised.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `equator`, `meridian` | none | see [`Gielis`] |
/// | `scale` | length | 10⁻⁹ to 10⁹ each |
/// | `radius` | none | [`Radius::Standard`] or [`Radius::Rational`] |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)·max(n2, n3)/n1` (at least
/// `4·10⁻⁶·(size + |f|)`) of the true value for m up to 12 and n2, n3 of at least 1; below 1
/// slopes are unbounded at the zeros of the sine and cosine, and errors grow to some `(10⁻⁷ m)^n`.
///
/// ```
/// use rvachev::{Gielis, Solid, Supershape};
/// use glam::DVec3;
///
/// let star = Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
/// assert!((star.gauge(DVec3::new(0.5, -0.3, 0.8)) - 0.800000617660).abs() < 1e-12);
/// assert!(Solid::from(star).contains(DVec3::new(0.5, -0.3, 0.8))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Supershape {
    equator: Gielis,
    meridian: Gielis,
    scale: DVec3,
    radius: Radius,
    inverse: DVec3,
    inscribed: f64,
    half_extents: DVec3,
}

impl Supershape {
    /// The supershape of unit scale with the standard radius; parameters are checked when the
    /// solid is compiled.
    #[must_use]
    pub fn new(equator: Gielis, meridian: Gielis) -> Supershape {
        Supershape::with(equator, meridian, DVec3::ONE, Radius::Standard)
    }

    /// The same with semi-axes `scale` and a choice of radius.
    #[must_use]
    pub fn with(equator: Gielis, meridian: Gielis, scale: impl Into<DVec3>, radius: Radius) -> Supershape {
        let scale = scale.into();
        let mut shape = Supershape {
            equator,
            meridian,
            scale,
            radius,
            inverse: scale.recip(),
            inscribed: f64::NAN,
            half_extents: DVec3::NAN,
        };
        if shape.check().is_ok() {
            let turn = Interval::new(-PI, PI);
            let half = Interval::new(-0.5 * PI, 0.5 * PI);
            let (x, least_equator) = equator.extremes(radius, turn, |t| t.sin_cos().1.abs());
            let (y, _) = equator.extremes(radius, turn, |t| t.sin_cos().0.abs());
            let (across, least_meridian) = meridian.extremes(radius, half, |t| t.sin_cos().1.abs());
            let (along, _) = meridian.extremes(radius, half, |t| t.sin_cos().0.abs());
            shape.half_extents = scale * DVec3::new(x * across, y * across, along);
            shape.inscribed = scale.min_element() * least_meridian * least_equator.min(1.0);
        }
        shape
    }

    /// The supershape with semi-axes `scale` in place of 1.
    #[must_use]
    pub fn scaled(self, scale: impl Into<DVec3>) -> Supershape {
        Supershape::with(self.equator, self.meridian, scale, self.radius)
    }

    /// The supershape with the rational radius.
    #[must_use]
    pub fn rational(self) -> Supershape {
        Supershape::with(self.equator, self.meridian, self.scale, Radius::Rational)
    }

    /// The curve of the sections across z.
    #[must_use]
    pub fn equator(&self) -> Gielis {
        self.equator
    }

    /// The curve of the meridians.
    #[must_use]
    pub fn meridian(&self) -> Gielis {
        self.meridian
    }

    /// The gauge G: below 1 inside, 1 on the surface; `p / G(p)` lies on the surface.
    #[must_use]
    pub fn gauge(&self, p: impl Into<DVec3>) -> f64 {
        self.gauge_of(p.into().to_array())
    }

    /// Fougerolle's first field `F1 = 1 − G²`: positive inside.
    #[must_use]
    pub fn f1(&self, p: impl Into<DVec3>) -> f64 {
        1.0 - self.gauge(p).powi(2)
    }

    /// Fougerolle's second field `F2 = 1 − G`: positive inside.
    #[must_use]
    pub fn f2(&self, p: impl Into<DVec3>) -> f64 {
        1.0 - self.gauge(p)
    }

    /// The radial distance `|p|·(1 − 1/G)`: negative inside, an upper bound of the distance
    /// in absolute value. At the origin, minus the inscribed radius.
    #[must_use]
    pub fn radial_distance(&self, p: impl Into<DVec3>) -> f64 {
        let p = p.into();
        let gauge = self.gauge(p);
        if gauge == 0.0 { -self.inscribed } else { p.length() * (1.0 - 1.0 / gauge) }
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (x, y, z) = (x * self.inverse.x, y * self.inverse.y, z * self.inverse.z);
        let rho = x.norm(y, Norm::Euclid);
        let r1 = self.equator.radius_at(y.atan2(x), self.radius);
        let phi = (z * r1).atan2(rho);
        let lambda = (rho / r1).norm(z, Norm::Euclid);
        lambda / self.meridian.radius_at(phi, self.radius)
    }
}

/// The parameters, without what is computed from them.
impl fmt::Debug for Supershape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Supershape { equator, meridian, scale, radius, .. } = self;
        let mut text = f.debug_struct("Supershape");
        text.field("equator", equator).field("meridian", meridian).field("scale", scale);
        text.field("radius", radius).finish()
    }
}

impl Field for Supershape {
    fn name(&self) -> &'static str {
        "supershape"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        self.gauge_of(p).scale_add(-self.inscribed, p[0].lift(self.inscribed))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-self.half_extents, self.half_extents)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.equator.check("equator", self.radius)?;
        self.meridian.check("meridian", self.radius)?;
        check::lengths("scale", self.scale)
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.inscribed)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        // Direct intervals lose the angle's tie to the radius; the mean-value form keeps it
        // over small regions.
        let image = self.eval(Dual::point(region));
        let middle = region.map(|side| Interval::point(side.mid()));
        let mut mean = self.eval(middle);
        for (slope, side) in image.gradient().into_iter().zip(region) {
            mean = mean + slope * Interval::around(0.0, 0.5 * side.width());
        }
        self.eval(region).narrowed_by(mean)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        match self.radius {
            Radius::Standard => kernel.run(&Supershape { radius: Radius::Standard, ..*self }),
            Radius::Rational => kernel.run(&Supershape { radius: Radius::Rational, ..*self }),
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let relative = self.equator.roundoff() + self.meridian.roundoff();
        relative * self.half_extents.length().min(reach)
    }
}
