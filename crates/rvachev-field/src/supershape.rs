//! Supershape: the spherical product of two Gielis curves.
//!
//! ```text
//!     surface   ( a₁ r₁(θ)r₂(φ) cos θ cos φ,  a₂ r₁r₂ sin θ cos φ,  a₃ r₂(φ) sin φ )
//!     θ = atan2(y, x),  ρ = √(x² + y²),  u = ρ/r₁,  φ = atan2(z, u),  λ = √(u² + z²)
//!     G = λ / r₂(φ)      f = r_in·(1 − G)
//! ```
//!
//! after scaling by the semi-axes. G is the gauge, homogeneous of degree 1, and equals
//! 1 − F2 for Fougerolle's second field. It is the gauge of the meridian at `(u, z)`, where
//! u = ρ/r₁ is the gauge of the equator at `(x, y)`; over a box u and z are independent, so the
//! ranges of two gauges in the plane, one after the other, give that of G exactly.
//!
//! Creases: at θ = π where the equator's m is not even (but not for odd m with n2 = n3 and
//! a = b); along meridians where turns of an envelope cross; and wherever a curve has a corner
//! itself (see [`Gielis`]). Where the meridian's radius is not stationary at the pole there is
//! a tip.
//!
//! The radius of the sections may be an envelope of the equator's turns. The solid is then the
//! product of the envelope with the meridian; it is the union (or intersection) of the products
//! of the single turns where the meridian has no undercut, that is, where with each point it
//! holds the whole way from there straight to the z axis. With an undercut (a meridian with
//! dented poles or a star) the product of the outer envelope has hollows that the union fills.
//!
//! Source: Y. D. Fougerolle et al.; J. Gielis, B. Beirinckx, E. Bastiaens, *Superquadrics
//! with rational and irrational symmetry* (2003).

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::erased::reach;
use super::gielis::{Polar, Winding};
use super::leaf::half;
use super::outline::Outline;
use super::{Along, Case, Field, Gielis, Kernel, ParamError, Radius, Segment, Turns, check};
use crate::{Bounds, Dual, Euclid, Interval, Real};
use rvachev_num::{Cancelled, Run};

/// A supershape about the origin, valued `f = r_in·(1 − G)` in length units, where `r_in` is
/// the radius of a sphere about the origin inside it.
///
#[doc = picture!(
    "supershape" = "docs/gallery/supershape.png",
    "supershape_hexagon" = "docs/gallery/supershape_hexagon.png",
    "supershape_flower" = "docs/gallery/supershape_flower.png",
    "supershape_shell" = "docs/gallery/supershape_shell.png",
    "supershape_irrational" = "docs/gallery/supershape_irrational.png",
)]
///
/// With r₁ the radius of the equator, r₂ that of the meridian, and (x, y, z) in units of the
/// semi-axes:
///
/// ```text
/// surface   (r₁(θ)r₂(φ) cos θ cos φ, r₁r₂ sin θ cos φ, r₂ sin φ)
/// gauge     θ = atan2(y, x),  ρ = √(x² + y²),  φ = atan2(z·r₁, ρ)
///           G = √((ρ/r₁)² + z²) / r₂(φ)
/// ```
///
/// A gauge, not a distance; in general not convex: no Lipschitz constant is promised.
///
/// Creases: at θ = π where the equator's m is not even (but not for odd m with n2 = n3 and
/// a = b); along meridians where turns of an envelope cross; wherever a curve has a corner
/// itself (see [`Gielis`]). Where the meridian's radius is not stationary at the pole there is
/// a tip.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `equator` | none | see [`Gielis`]; any m, and envelopes of several turns |
/// | `meridian` | none | see [`Gielis`]; any m, angles in [−π/2, π/2] of the first turn |
/// | `scale` | length | 10⁻⁹ to 10⁹ each |
/// | `radius` | none | [`Radius::Standard`] or [`Radius::Rational`] |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)·max(n2, n3)/n1` (at least
/// `4·10⁻⁶·(size + |f|)`) of the true value for m up to 12 and n2, n3 of at least 1; below 1
/// slopes are unbounded at the zeros of the sine and cosine, and errors grow to some `(10⁻⁷ m)^n`.
///
/// Sources: Y. D. Fougerolle et al.; J. Gielis, B. Beirinckx, E. Bastiaens, *Superquadrics
/// with rational and irrational symmetry* (2003).
///
/// ```
/// use rvachev::{Gielis, Solid, Supershape, Turns};
/// use glam::DVec3;
///
/// let star = Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
/// assert!((star.gauge(DVec3::new(0.5, -0.3, 0.8)) - 0.800000617660).abs() < 1e-12);
/// assert!(Solid::from(star).contains(DVec3::new(0.5, -0.3, 0.8))?);
///
/// // m = 5/2: the sections are stars of crossing arms, or the pentagons in their middles.
/// let arms = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
/// let star = Supershape::new(arms, Gielis::circle());
/// let core = Supershape::new(arms.with_turns(Turns::Inner), Gielis::circle());
/// let p = DVec3::new(1.2 * 0.4f64.cos(), 1.2 * 0.4f64.sin(), 0.0);
/// assert!(star.gauge(p) < 1.0 && core.gauge(p) > 1.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Supershape {
    equator: Gielis,
    meridian: Gielis,
    scale: DVec3,
    radius: Radius,
    winding: Winding,
    inverse: DVec3,
    /// Those of the equator and of the meridian, when they are first asked for; none if a parameter
    /// is out of its range.
    outlines: Arc<OnceLock<Option<[Outline; 2]>>>,
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
        let (winding, outlines) = (equator.winding(), Arc::default());
        Supershape { equator, meridian, scale, radius, winding, inverse: scale.recip(), outlines }
    }

    /// The supershape with semi-axes `scale` in place of 1.
    #[must_use]
    pub fn scaled(&self, scale: impl Into<DVec3>) -> Supershape {
        let scale = scale.into();
        Supershape { scale, inverse: scale.recip(), ..self.clone() }
    }

    /// Outlines take milliseconds, so that they wait until the shape is used.
    fn outlines(&self) -> Option<&[Outline; 2]> {
        let Supershape { equator, meridian, radius, .. } = *self;
        let both = || [Outline::new(equator, radius, PI), Outline::new(meridian, radius, FRAC_PI_2)];
        self.outlines.get_or_init(|| self.check_curves().is_ok().then(both)).as_ref()
    }

    /// The radius of a sphere about the origin inside the shape.
    fn inscribed(&self) -> f64 {
        self.outlines().map_or(f64::NAN, |[equator, meridian]| {
            self.scale.min_element() * meridian.radius().lo() * equator.radius().lo().min(1.0)
        })
    }

    fn check_curves(&self) -> Result<(), ParamError> {
        self.equator.check("equator", self.radius)?;
        self.meridian.check("meridian", self.radius)?;
        if self.meridian.turns != Turns::Principal {
            let turns = f64::from(self.meridian.closing_turns().unwrap_or(1));
            return Err(ParamError::new("meridian.turns", turns, "1: a meridian is a part of the first turn"));
        }
        Ok(())
    }

    /// The supershape with the rational radius.
    #[must_use]
    pub fn rational(&self) -> Supershape {
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

    /// The semi-axes that the product of the curves is scaled by.
    #[must_use]
    pub fn scale(&self) -> DVec3 {
        self.scale
    }

    /// Which formula gives the radii of the curves.
    #[must_use]
    pub fn radius(&self) -> Radius {
        self.radius
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
        if gauge == 0.0 { -self.inscribed() } else { p.length() * (1.0 - 1.0 / gauge) }
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (x, y, z) = (x * self.inverse.x, y * self.inverse.y, z * self.inverse.z);
        let rho = x.norm_as(y, Euclid);
        let u = rho * self.equator.inverse_radius_at(y.atan2(x), self.radius, self.winding);
        u.norm_as(z, Euclid) * self.meridian.inverse_radius_at(z.atan2(u), self.radius, Winding::Once)
    }

    #[inline(always)]
    fn case<const RATIONAL: bool, const MANY: bool>(&self) -> Curves<RATIONAL, MANY> {
        let (inverse, inscribed) = (self.inverse, self.inscribed());
        let winding = if MANY { self.winding.by_turns() } else { Winding::Once };
        let seam = !MANY && std::hint::black_box(false);
        let equator = Polar { curve: self.equator, winding, seam };
        let meridian = Polar { curve: self.meridian, winding: Winding::Once, seam };
        Curves { inverse, inscribed, equator, meridian }
    }

    /// Ranges of the gauge u of the equator and of the derivatives over a region; only over what is
    /// on the same sides of all creases as a point, if there is one.
    fn slopes_over(&self, p: [Dual<Interval>; 3], beside: Option<DVec3>) -> (Interval, [Interval; 3]) {
        let [x, mut y, mut z] = self.scaled_down(p.map(Dual::value));
        let Some([equator, meridian]) = self.outlines() else { return (Interval::ALL, [Interval::ALL; 3]) };
        if !(x.magnitude() + y.magnitude() + z.magnitude()).is_finite() {
            return (Interval::ALL, [Interval::ALL; 3]);
        }
        let (mut longitude, mut latitude) = (None, None);
        if let Some(p) = beside.map(|p| p * self.inverse) {
            longitude = Some(p.y.abs().atan2(p.x));
            // A cusp at an angle of 0 parts the halves.
            y = if self.equator.cusps().any(|angle| angle == 0.0) { half(y, p.y) } else { y };
            // The meridian's other cusps are in cones.
            if self.meridian.cusps().take_while(|angle| *angle <= FRAC_PI_2).eq([0.0]) {
                (z, latitude) = (half(z, p.z), Some(BESIDE));
            }
        }
        // Outlines know one half of the plane, the other is its mirror image.
        let mirrored = |slope: Interval, of: Interval| {
            if of.contains(0.0) { slope.hull(-slope) } else { of.select(slope, -slope) }
        };
        let [dx, dy, dz] = [0, 1, 2].map(|axis| p[axis].d.map(|d| d * self.inverse[axis]));
        let level = [0, 1, 2].map(|i| [dx[i], mirrored(dy[i], y)]);
        let u = equator.gauge(x, y.abs());
        let du = equator.rises(x, y.abs(), level, longitude);
        let dz = dz.map(|d| mirrored(d, z));
        let (zero, one) = (Interval::point(0.0), Interval::point(1.0));
        let [by_u, by_z, x, y, z] = meridian.rises(
            u,
            z.abs(),
            [[one, zero], [zero, one], [du[0], dz[0]], [du[1], dz[1]], [du[2], dz[2]]],
            latitude,
        );
        // Where u is steep, as at a cusp of the equator, its own part tells the sign.
        let slope = |i: usize, whole: Interval| whole.narrowed_by(change(by_u, du[i]) + change(by_z, dz[i]));
        let slopes = [slope(0, x), slope(1, y), slope(2, z)];
        (u, slopes.map(|slope| slope * -self.inscribed()))
    }

    /// What is known along a segment that does not cross the plane y = 0.
    fn along_segment(&self, segment: &Segment) -> Option<Along> {
        let [equator, meridian] = self.outlines()?;
        let ends = segment.ends.map(|end| self.scaled_down(end));
        let [dx, mut dy, mut dz] = self.scaled_down(segment.slopes);
        let is_finite = ends.iter().flatten().all(|side| side.magnitude().is_finite());
        let is_above = ends.iter().all(|[_, y, _]| y.lo() >= 0.0);
        if !is_finite || !is_above && ends.iter().any(|[_, y, _]| y.hi() > 0.0) {
            return None;
        }
        let half = ends.map(|[x, y, _]| [x, y.abs()]);
        dy = if is_above { dy } else { -dy };
        let (u, du) = equator.along(half, [dx, dy], segment.length)?;
        let z = ends[0][2].hull(ends[1][2]);
        dz = if z.contains(0.0) { dz.hull(-dz) } else { z.select(dz, -dz) };
        let (zero, one) = (Interval::point(0.0), Interval::point(1.0));
        let [by_u, by_z, whole] = meridian.rises(u, z.abs(), [[one, zero], [zero, one], [du, dz]], None);
        // Where u is steep, as at a cusp of the equator, its own part tells the sign.
        let slope = whole.narrowed_by(change(by_u, du) + change(by_z, dz)) * -self.inscribed();
        Some(Along { value: self.height(meridian.gauge(u, z.abs())), slope })
    }

    /// How far off values are where radii are, relative to themselves.
    fn error(&self, relative: f64, reach: f64) -> f64 {
        let bounds = Field::bounds(self);
        relative * bounds.min.abs().max(bounds.max).length().min(reach)
    }

    /// The value that belongs to a gauge.
    fn height(&self, gauge: Interval) -> Interval {
        -gauge * self.inscribed() + self.inscribed()
    }

    /// The region in units of the semi-axes.
    fn scaled_down(&self, region: [Interval; 3]) -> [Interval; 3] {
        let [x, y, z] = region;
        [x * self.inverse.x, y * self.inverse.y, z * self.inverse.z]
    }
}

impl PartialEq for Supershape {
    fn eq(&self, other: &Supershape) -> bool {
        let parameters = |shape: &Supershape| (shape.equator, shape.meridian, shape.scale, shape.radius);
        parameters(self) == parameters(other)
    }
}

/// How fast a value changes that has a slope by something that changes so fast: not at all where
/// that does not, however steep it is.
fn change(slope: Interval, by: Interval) -> Interval {
    if by == Interval::point(0.0) { by } else { slope * by }
}

/// An angle between the equator and whatever may be next.
const BESIDE: f64 = 1e-3;

/// The parameters, without what is computed from them.
impl fmt::Debug for Supershape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Supershape { equator, meridian, scale, radius, .. } = self;
        let mut text = f.debug_struct("Supershape");
        text.field("equator", equator).field("meridian", meridian).field("scale", scale);
        text.field("radius", radius).finish()
    }
}

/// A supershape on lanes, by the kind of its curves.
struct Curves<const RATIONAL: bool, const MANY: bool> {
    inverse: DVec3,
    inscribed: f64,
    equator: Polar<RATIONAL, MANY, true>,
    meridian: Polar<RATIONAL, false, true>,
}

impl<const RATIONAL: bool, const MANY: bool> Case for Curves<RATIONAL, MANY> {
    #[inline(always)]
    fn value<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (x, y, z) = (x * self.inverse.x, y * self.inverse.y, z * self.inverse.z);
        let rho = x.norm_as(y, Euclid);
        let u = rho * y.atan2(x).of_one(&self.equator);
        let gauge = u.norm_as(z, Euclid) * z.atan2(u).of_one(&self.meridian);
        gauge.scale_add(-self.inscribed, x.lift(self.inscribed))
    }
}

impl Field for Supershape {
    fn name(&self) -> &'static str {
        "supershape"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let inscribed = self.inscribed();
        self.gauge_of(p).scale_add(-inscribed, p[0].lift(inscribed))
    }

    fn prepare(&self, run: &Run) -> Result<(), Cancelled> {
        run.check()?;
        self.outlines();
        Ok(())
    }

    fn bounds(&self) -> Bounds {
        let Some([equator, meridian]) = self.outlines() else { return Bounds::ALL };
        // The meridian reaches farthest from the axis and along it at different angles.
        let (across, along) = (meridian.x().hi(), meridian.y().hi());
        let high = DVec3::new(equator.x().hi() * across, equator.y().hi() * across, along);
        let low = DVec3::new(equator.x().lo() * across, -high.y, -high.z);
        let ends = (self.scale * low, self.scale * high);
        let rounding = 1e-14 * (ends.1 - ends.0);
        Bounds::new(ends.0 - rounding, ends.1 + rounding)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.check_curves()?;
        check::lengths("scale", self.scale)
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.inscribed())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        let [x, y, z] = self.scaled_down(region);
        let Some([equator, meridian]) = self.outlines() else { return Interval::ALL };
        if !(x.magnitude() + y.magnitude() + z.magnitude()).is_finite() {
            return Interval::ALL;
        }
        let u = equator.gauge(x, y.abs());
        self.height(meridian.gauge(u, z.abs()))
    }

    fn creases(&self) -> Vec<DVec3> {
        let upright = self.equator.cusp_normals().into_iter().map(|normal| normal * self.inverse);
        // Of the meridian's cusps, that at the equator is in a plane.
        let level = self.meridian.cusps().any(|angle| angle == 0.0).then_some(DVec3::Z);
        upright.chain(level).collect()
    }

    fn slopes(&self, region: [Interval; 3]) -> [Interval; 3] {
        self.slopes_over(Dual::point(region), None).1
    }

    fn slopes_beside(&self, p: [Dual<Interval>; 3], beside: DVec3) -> [Interval; 3] {
        self.slopes_over(p, Some(beside)).1
    }

    fn along(&self, segment: &Segment) -> Along {
        self.along_segment(segment).unwrap_or_else(|| Along::of(Field::dual_range(self, segment.sides())))
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let (u, slopes) = self.slopes_over(p, None);
        let z = p[2].v * self.inverse.z;
        let value = match self.outlines() {
            Some([_, meridian]) if (u.magnitude() + z.magnitude()).is_finite() => {
                self.height(meridian.gauge(u, z.abs()))
            }
            _ => Interval::ALL,
        };
        Dual::new(value, slopes)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        // Lanes need no outlines; one loop for a single turn, whose chain of operations is so long
        // that it takes half the time on several vectors at once, and one for several turns.
        match (self.radius, self.winding) {
            (Radius::Standard, Winding::Once) => kernel.run_case_wide(&self.case::<false, false>()),
            (Radius::Standard, _) => kernel.run_case(&self.case::<false, true>()),
            (Radius::Rational, _) => kernel.run_case(&self.case::<true, true>()),
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.error(self.equator.roundoff() + self.meridian.roundoff(), reach)
    }

    fn roundoff_over(&self, region: [Interval; 3]) -> f64 {
        let [x, y, z] = self.scaled_down(region);
        let is_finite = (x.magnitude() + y.magnitude() + z.magnitude()).is_finite();
        let Some([equator, meridian]) = self.outlines().filter(|_| is_finite) else {
            return Field::roundoff(self, reach(region));
        };
        let first = equator.roundoff(x, y.abs());
        let u = equator.gauge(x, y.abs());
        // What is wrong of u turns the meridian's angle.
        let u = Interval::new(u.lo() * (1.0 - first), u.hi() * (1.0 + first));
        self.error(first + meridian.roundoff(u, z.abs()), reach(region))
    }
}
