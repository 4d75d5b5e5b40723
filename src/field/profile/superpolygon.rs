//! Superpolygon: the plane shape within a Gielis curve.
//!
//! ```text
//!     G = √(x² + y²) / r(θ),  θ = atan2(y, x)        f = r_in·(1 − G)
//! ```
//!
//! after scaling by `size`; r is the radius of the [`Gielis`] curve.
//!
//! Source: J. Gielis, *A generic geometric transformation* (2003).

use std::f64::consts::PI;

use glam::DVec2;

use super::super::{Field, Gielis, Kernel, ParamError, Radius, check};
use super::{column, flattened};
use crate::{Bounds, Dual, Interval, Norm, Real};

/// What is within a [`Gielis`] curve, valued `f = r_in·(1 − G)` in length units: G is the
/// gauge and `r_in` the radius of a circle about the origin inside the curve.
///
/// In general not convex: no Lipschitz constant is promised.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `curve` | none | see [`Gielis`]; its standard radius |
/// | `size` | length | 10⁻⁹ to 10⁹: what the curve's radius of 1 becomes |
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superpolygon {
    curve: Gielis,
    size: f64,
    inverse: f64,
    inscribed: f64,
    half: DVec2,
}

impl Superpolygon {
    /// The shape within `curve`, scaled by `size`; both are checked when the profile is
    /// compiled.
    #[must_use]
    pub fn new(curve: Gielis, size: f64) -> Superpolygon {
        let mut shape = Superpolygon { curve, size, inverse: 1.0 / size, inscribed: f64::NAN, half: DVec2::NAN };
        if shape.check().is_ok() {
            let turn = Interval::new(-PI, PI);
            let (x, least) = curve.extremes(Radius::Standard, turn, |t| t.sin_cos().1.abs());
            let (y, _) = curve.extremes(Radius::Standard, turn, |t| t.sin_cos().0.abs());
            shape.inscribed = size * least;
            shape.half = size * DVec2::new(x, y);
        }
        shape
    }

    /// The curve.
    #[must_use]
    pub fn curve(&self) -> Gielis {
        self.curve
    }

    /// What the curve's radius of 1 becomes.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The gauge G: below 1 inside, 1 on the curve; `p / G(p)` lies on the curve.
    #[must_use]
    pub fn gauge(&self, p: DVec2) -> f64 {
        self.gauge_of(p.x, p.y)
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, x: R, y: R) -> R {
        let radius = self.curve.radius_at(y.atan2(x), Radius::Standard);
        x.norm(y, Norm::Euclid) * self.inverse / radius
    }
}

impl Field for Superpolygon {
    fn name(&self) -> &'static str {
        "superpolygon"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        self.gauge_of(x, y).scale_add(-self.inscribed, x.lift(self.inscribed))
    }

    fn bounds(&self) -> Bounds {
        column(self.half)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.curve.check("curve", Radius::Standard)?;
        check::length("size", self.size)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        // Direct intervals lose the angle's tie to the radius; the mean-value form keeps it
        // over small regions that the cut of the angle does not meet.
        let region = flattened(region);
        let direct = self.eval(region);
        let [x, y, _] = region;
        if x.lo() <= 0.0 && y.contains(0.0) || !x.width().is_finite() || !y.width().is_finite() {
            return direct;
        }
        let image = self.eval(Dual::point(region));
        let mut mean = self.eval(region.map(|side| Interval::point(side.mid())));
        for (slope, side) in image.gradient().into_iter().zip(region) {
            mean = mean + slope * Interval::around(0.0, 0.5 * side.width());
        }
        direct.narrowed_by(mean)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        kernel.run(self);
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.curve.roundoff() * self.half.length().min(reach)
    }
}
