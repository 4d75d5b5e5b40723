//! Superpolygon: the plane shape within a Gielis curve.
//!
//! ```text
//!     G = √(x² + y²) / r(θ),  θ = atan2(y, x)        f = r_in·(1 − G)
//! ```
//!
//! after scaling by `radius`; r is the radius of the [`Gielis`] curve.
//!
//! Source: J. Gielis, *A generic geometric transformation* (2003).

use std::f64::consts::PI;
use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};

use super::super::gielis::{Polar, Winding};
use super::super::leaf::half;
use super::super::outline::Outline;
use super::super::{Case, Field, Gielis, Kernel, ParamError, Radius, check};
use crate::{Bounds, Dual, Euclid, Interval, OfOne, Real};
use rvachev_num::{Cancelled, Run};

/// What is within a [`Gielis`] curve, valued `f = r_in·(1 − G)` in length units: the gauge is
/// `G = √(x² + y²)/(radius·r(θ))` and `r_in` the radius of a circle about the origin inside.
///
#[doc = picture!("profile_superpolygon" = "docs/gallery/profile_superpolygon.png")]
///
/// A gauge, not a distance; in general not convex: no Lipschitz constant is promised.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `curve` | none | see [`Gielis`]; its standard radius |
/// | `radius` | length | 10⁻⁹ to 10⁹: what the curve's radius of 1 becomes |
///
/// Source: J. Gielis, *A generic geometric transformation that unifies a wide range of natural
/// and abstract shapes* (2003).
///
/// ```
/// use rvachev::{Gielis, Profile, Superpolygon};
/// use glam::DVec2;
///
/// let star = Profile::from(Superpolygon::new(Gielis::new(5.0, 0.6, 1.7, 1.7), 3.0));
/// assert!(star.contains(DVec2::new(2.9, 0.0))?);
/// assert!(!star.contains(DVec2::new(-2.9, 0.0))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Superpolygon {
    curve: Gielis,
    radius: f64,
    winding: Winding,
    inverse: f64,
    /// When it is first asked for; none if a parameter is out of its range.
    outline: Arc<OnceLock<Option<Outline>>>,
}

impl PartialEq for Superpolygon {
    fn eq(&self, other: &Superpolygon) -> bool {
        (self.curve, self.radius) == (other.curve, other.radius)
    }
}

impl fmt::Debug for Superpolygon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Superpolygon").field("curve", &self.curve).field("radius", &self.radius).finish()
    }
}

impl Superpolygon {
    /// The shape within `curve`, scaled by `radius`; both are checked when the profile is
    /// compiled.
    #[must_use]
    pub fn new(curve: Gielis, radius: f64) -> Superpolygon {
        Superpolygon { curve, radius, winding: curve.winding(), inverse: 1.0 / radius, outline: Arc::default() }
    }

    /// The outline takes milliseconds, so that it waits until the shape is used.
    fn outline(&self) -> Option<&Outline> {
        let outline = || Outline::new(self.curve, Radius::Standard, PI);
        self.outline.get_or_init(|| self.curve.check("curve", Radius::Standard).is_ok().then(outline)).as_ref()
    }

    /// The radius of a circle about the origin inside the shape.
    fn inscribed(&self) -> f64 {
        self.outline().map_or(f64::NAN, |outline| self.radius * outline.radius().lo())
    }

    /// The curve.
    #[must_use]
    pub fn curve(&self) -> Gielis {
        self.curve
    }

    /// What the curve's radius of 1 becomes.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The gauge G: below 1 inside, 1 on the curve; `p / G(p)` lies on the curve.
    #[must_use]
    pub fn gauge(&self, p: DVec2) -> f64 {
        self.gauge_of(p.x, p.y)
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, x: R, y: R) -> R {
        let inverse = self.curve.inverse_radius_at(y.atan2(x), Radius::Standard, self.winding);
        x.norm_as(y, Euclid) * self.inverse * inverse
    }
}

/// A superpolygon on lanes, by the kind of its curve.
struct Section<P> {
    inverse: f64,
    inscribed: f64,
    radius: P,
}

impl<P: OfOne> Case for Section<P> {
    #[inline(always)]
    fn value<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let gauge = x.norm_as(y, Euclid) * self.inverse * y.atan2(x).of_one(&self.radius);
        gauge.scale_add(-self.inscribed, x.lift(self.inscribed))
    }
}

impl Superpolygon {
    /// Ranges of the derivatives over a region; only over what is on the same sides of all cusps as
    /// a point, if there is one.
    fn slopes_over(&self, p: [Dual<Interval>; 3], beside: Option<DVec3>) -> [Interval; 3] {
        let (x, mut y) = (p[0].v * self.inverse, p[1].v * self.inverse);
        match self.outline() {
            Some(outline) if (x.magnitude() + y.magnitude()).is_finite() => {
                if let Some(p) = beside.filter(|_| self.curve.cusps().any(|angle| angle == 0.0)) {
                    y = half(y, p.y);
                }
                // The outline knows one half of the plane, the other is its mirror image.
                let mirrored = |d: Interval| if y.contains(0.0) { d.hull(-d) } else { y.select(d, -d) };
                let along = [0, 1, 2].map(|i| [p[0].d[i], mirrored(p[1].d[i])]);
                let slopes = outline.rises(x, y.abs(), along, beside.map(|p| p.y.abs().atan2(p.x)));
                slopes.map(|slope| slope * (-self.inverse * self.inscribed()))
            }
            _ => [Interval::ALL; 3],
        }
    }
}

impl Field for Superpolygon {
    fn name(&self) -> &'static str {
        "superpolygon"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let inscribed = self.inscribed();
        self.gauge_of(x, y).scale_add(-inscribed, x.lift(inscribed))
    }

    fn prepare(&self, run: &Run) -> Result<(), Cancelled> {
        run.check()?;
        self.outline();
        Ok(())
    }

    fn bounds(&self) -> Bounds {
        let Some(outline) = self.outline() else { return Bounds::ALL };
        let (x, y) = (outline.x() * self.radius, outline.y() * self.radius);
        let side = y.hi() * (1.0 + 1e-14);
        Bounds::new(DVec3::new(x.lo(), -side, f64::NEG_INFINITY), DVec3::new(x.hi(), side, f64::INFINITY))
    }

    fn check(&self) -> Result<(), ParamError> {
        self.curve.check("curve", Radius::Standard)?;
        check::length("radius", self.radius)
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.inscribed())
    }

    fn range(&self, [x, y, _]: [Interval; 3]) -> Interval {
        let (x, y) = (x * self.inverse, y * self.inverse);
        match self.outline() {
            Some(outline) if (x.magnitude() + y.magnitude()).is_finite() => {
                -outline.gauge(x, y.abs()) * self.inscribed() + self.inscribed()
            }
            _ => Interval::ALL,
        }
    }

    fn creases(&self) -> Vec<DVec3> {
        self.curve.cusp_normals()
    }

    fn slopes(&self, region: [Interval; 3]) -> [Interval; 3] {
        self.slopes_over(Dual::point(region), None)
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Dual::new(Field::range(self, p.map(Dual::value)), self.slopes_over(p, None))
    }

    fn slopes_beside(&self, p: [Dual<Interval>; 3], beside: DVec3) -> [Interval; 3] {
        self.slopes_over(p, Some(beside))
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        // One turn needs no loop over turns.
        let Superpolygon { curve, winding, inverse, .. } = *self;
        let inscribed = self.inscribed();
        match winding {
            Winding::Once => {
                kernel.run_case(&Section {
                    inverse,
                    inscribed,
                    radius: Polar::<false, false, true> { curve, winding, seam: false },
                });
            }
            Winding::Many { .. } => {
                kernel.run_case(&Section {
                    inverse,
                    inscribed,
                    radius: Polar::<false, true, true> { curve, winding, seam: false },
                });
            }
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let half = Field::bounds(self).half_extents();
        self.curve.roundoff() * half.truncate().length().min(reach)
    }
}
