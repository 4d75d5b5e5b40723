//! Superellipsoid.
//!
//! ```text
//!     ρ = ‖(x/a₁, y/a₂)‖ with p = 2/e₂        e → 0  box
//!     G = ‖(ρ, z/a₃)‖    with p = 2/e₁        e = 1  round
//!     f = r_in·(1 − G)                        e = 2  bevelled, e > 2  pinched
//! ```
//!
//! G is the gauge: the factor by which the solid is scaled to carry its surface through the
//! point. It rises with |x|, |y| and |z|, so its range over a box is two evaluations.
//!
//! Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981).

use std::fmt;

use glam::DVec3;

use super::erased::reach;
use super::{Case, Field, Kernel, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Norm, NormKind, Powers, Real};

/// A superellipsoid about the origin, valued `f = r_in·(1 − G)` in length units, where
/// `r_in` is the radius of its largest inscribed sphere and G the gauge.
///
#[doc = picture!(
    "superellipsoid_cube" = "docs/gallery/superellipsoid_cube.png",
    "superellipsoid_cylinder" = "docs/gallery/superellipsoid_cylinder.png",
    "superellipsoid_cushion" = "docs/gallery/superellipsoid_cushion.png",
    "superellipsoid_ellipsoid" = "docs/gallery/superellipsoid_ellipsoid.png",
    "superellipsoid_double_cone" = "docs/gallery/superellipsoid_double_cone.png",
    "superellipsoid_octahedron" = "docs/gallery/superellipsoid_octahedron.png",
    "superellipsoid_pinched" = "docs/gallery/superellipsoid_pinched.png",
)]
///
/// ```text
/// ρ = (|x/a₁|^(2/e₂) + |y/a₂|^(2/e₂))^(e₂/2)
/// G = (ρ^(2/e₁) + |z/a₃|^(2/e₁))^(e₁/2)
/// ```
///
/// 1-Lipschitz where it is convex (both exponents at most 2), and so never more than the
/// distance; beyond, it is pinched along the axis planes, the slope is unbounded there and no
/// Lipschitz constant exists.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each |
/// | `e1` | none | 0.01 to 10: shapes the meridians (0 square, 1 round, 2 bevelled) |
/// | `e2` | none | 0.01 to 10: shapes the sections across z |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)` of the true value for exponents
/// of 0.05 to 2.5.
///
/// Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981).
///
/// ```
/// use rvachev::{Solid, Superellipsoid};
/// use glam::DVec3;
///
/// let pill = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 0.5, 1.5);
/// assert!((pill.gauge(DVec3::new(0.3, -0.4, 1.1)) - 0.47327047558333357).abs() < 1e-15);
/// assert!(Solid::from(pill).contains(DVec3::new(0.3, -0.4, 1.1))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Superellipsoid {
    semi_axes: DVec3,
    e1: f64,
    e2: f64,
    inverse: DVec3,
    inner: Norm,
    outer: Norm,
    inscribed: f64,
    circumscribed: f64,
}

impl Superellipsoid {
    /// The superellipsoid with these semi-axes and exponents; they are checked when the solid
    /// is compiled.
    #[must_use]
    pub fn new(semi_axes: impl Into<DVec3>, e1: f64, e2: f64) -> Superellipsoid {
        let semi_axes = semi_axes.into();
        let inverse = semi_axes.recip();
        let (s1, s2) = (slope_norm(e1), slope_norm(e2));
        Superellipsoid {
            semi_axes,
            e1,
            e2,
            inverse,
            inner: Norm::of_exponent(e2),
            outer: Norm::of_exponent(e1),
            inscribed: 1.0 / inverse.x.norm(inverse.y, s2).norm(inverse.z, s1),
            circumscribed: semi_axes.x.norm(semi_axes.y, radius_norm(e2)).norm(semi_axes.z, radius_norm(e1)),
        }
    }

    /// The semi-axes.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// The exponents `[e1, e2]`.
    #[must_use]
    pub fn exponents(&self) -> [f64; 2] {
        [self.e1, self.e2]
    }

    /// The gauge G: below 1 inside, 1 on the surface; `p / G(p)` lies on the surface.
    #[must_use]
    pub fn gauge(&self, p: impl Into<DVec3>) -> f64 {
        self.gauge_of(p.into().to_array())
    }

    /// Barr's inside–outside function `F = G^(2/e1)`: below 1 inside.
    #[must_use]
    pub fn barr(&self, p: impl Into<DVec3>) -> f64 {
        self.gauge(p).powf(2.0 / self.e1)
    }

    /// Solina's `F^e1 = G²`: below 1 inside.
    #[must_use]
    pub fn solina(&self, p: impl Into<DVec3>) -> f64 {
        self.gauge(p).powi(2)
    }

    /// Fougerolle's first field `F1 = 1 − G²`: positive inside.
    #[must_use]
    pub fn f1(&self, p: impl Into<DVec3>) -> f64 {
        1.0 - self.solina(p)
    }

    /// Fougerolle's second field `F2 = 1 − G`: positive inside.
    #[must_use]
    pub fn f2(&self, p: impl Into<DVec3>) -> f64 {
        1.0 - self.gauge(p)
    }

    /// The radial distance `|p|·(1 − 1/G)` (Gross and Boult): negative inside, an upper bound
    /// of the distance in absolute value. At the origin, minus the inscribed radius.
    #[must_use]
    pub fn radial_distance(&self, p: impl Into<DVec3>) -> f64 {
        let p = p.into();
        let gauge = self.gauge(p);
        if gauge == 0.0 { -self.inscribed } else { p.length() * (1.0 - 1.0 / gauge) }
    }

    /// Radius of the largest inscribed sphere, `1 / max |∇G|` where the solid is convex.
    #[must_use]
    pub fn inscribed_radius(&self) -> f64 {
        self.inscribed
    }

    /// Radius of the smallest sphere about the origin that holds the solid.
    #[must_use]
    pub fn circumscribed_radius(&self) -> f64 {
        self.circumscribed
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let inverse = self.inverse;
        (x * inverse.x).nested(y * inverse.y, z * inverse.z, self.inner, self.outer)
    }
}

/// The norm whose dual bounds the slope of G: p = 2/(e − 1), ∞ for e ≤ 1.
pub(super) fn slope_norm(e: f64) -> Norm {
    Norm::new(if e <= 1.0 { f64::INFINITY } else { 2.0 / (e - 1.0) })
}

/// The norm that gives the circumscribed radius: p = 2/(1 − e), ∞ for e ≥ 1.
fn radius_norm(e: f64) -> Norm {
    Norm::new(if e >= 1.0 { f64::INFINITY } else { 2.0 / (1.0 - e) })
}

/// The norm of the support function: p = 2/(2 − e), ∞ for e ≥ 2.
pub(super) fn support_norm(e: f64) -> Norm {
    Norm::new(if e >= 2.0 { f64::INFINITY } else { 2.0 / (2.0 - e) })
}

/// The parameters, without what is computed from them.
impl fmt::Debug for Superellipsoid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Superellipsoid { semi_axes, e1, e2, .. } = self;
        f.debug_struct("Superellipsoid").field("semi_axes", semi_axes).field("e1", e1).field("e2", e2).finish()
    }
}

/// A superellipsoid by the kind of its norms.
struct Exponents<N> {
    inverse: DVec3,
    inscribed: f64,
    inner: N,
    outer: N,
}

impl<N: NormKind> Case for Exponents<N> {
    #[inline(always)]
    fn value<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let i = self.inverse;
        let gauge = (x * i.x).nested_as(y * i.y, z * i.z, self.inner, self.outer);
        gauge.scale_add(-self.inscribed, x.lift(self.inscribed))
    }
}

impl Field for Superellipsoid {
    fn name(&self) -> &'static str {
        "superellipsoid"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        self.gauge_of(p).scale_add(-self.inscribed, p[0].lift(self.inscribed))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-self.semi_axes, self.semi_axes)
    }

    fn creases(&self) -> Vec<DVec3> {
        let pinched = [self.e2 > 2.0, self.e2 > 2.0, self.e1 > 2.0];
        DVec3::AXES.into_iter().zip(pinched).filter_map(|(axis, is_pinched)| is_pinched.then_some(axis)).collect()
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("semi_axes", self.semi_axes)?;
        check::within("e1", self.e1, 0.01, 10.0)?;
        check::within("e2", self.e2, 0.01, 10.0)
    }

    fn convex(&self) -> bool {
        self.e1 <= 2.0 && self.e2 <= 2.0
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.inscribed)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, direction: DVec3) -> f64 {
        let d = (direction * self.semi_axes).abs();
        d.x.norm(d.y, support_norm(self.e2)).norm(d.z, support_norm(self.e1)) * (1.0 + 1e-14)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        // Two loops cover all exponents, and a third that of ellipsoids, a single root.
        let Superellipsoid { inverse, inscribed, .. } = *self;
        match (self.inner.by_powers(), self.outer.by_powers()) {
            _ if self.inner == Norm::Euclid && self.outer == Norm::Euclid => {
                kernel.run_case(&Exponents { inverse, inscribed, inner: Euclid, outer: Euclid });
            }
            (Norm::P { p, inv }, Norm::P { p: q, inv: q_inv }) => {
                let (inner, outer) = (Powers::<false> { p, inv }, Powers { p: q, inv: q_inv });
                kernel.run_case_wide(&Exponents { inverse, inscribed, inner, outer });
            }
            (inner, outer) => {
                let (inner, outer) = (Powers::steep(inner), Powers::steep(outer));
                kernel.run_case(&Exponents { inverse, inscribed, inner, outer });
            }
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // The circumscribed radius is no less than the largest semi-axis.
        let within = reach <= self.semi_axes.max_element();
        let size = if within { reach } else { self.circumscribed.min(reach) };
        if self.convex() {
            return 4e-6 * size;
        }
        // Across a cusp a displacement d of a coordinate moves G by (d/a)^(2/e).
        let p = 2.0 / self.e1.max(self.e2);
        let displaced = 1e-6 * reach / self.semi_axes.min_element();
        size * (4e-6 + 4.0 * displaced.powf(p))
    }

    fn roundoff_over(&self, region: [Interval; 3]) -> f64 {
        let reach = reach(region);
        let all = Field::roundoff(self, reach);
        if self.convex() {
            return all;
        }
        // Away from the cusps slopes are bounded.
        let displaced = 1e-6 * reach;
        let slopes = Field::slopes(self, region.map(|side| side.inflate(displaced)));
        let steepest: f64 = slopes.iter().map(|slope| slope.magnitude()).sum();
        all.min(4e-6 * self.circumscribed.min(reach) + displaced * steepest)
    }
}
