//! Sphere.

use glam::DVec3;

use super::{Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A sphere about the origin: `f = r − |p|`, the true distance (1-Lipschitz).
///
#[doc = picture!("sphere" = "docs/gallery/sphere.png")]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Solid, Sphere};
/// use glam::DVec3;
///
/// let ball = Solid::from(Sphere { radius: 2.0 });
/// assert_eq!(ball.value(DVec3::new(0.0, 0.0, 3.0))?, -1.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Radius in length units.
    pub radius: f64,
}

impl Field for Sphere {
    fn name(&self) -> &'static str {
        "sphere"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        -x.nested_as(y, z, Euclid, Euclid) + self.radius
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(DVec3::splat(-self.radius), DVec3::splat(self.radius))
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("radius", self.radius)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Sphere> {
        let left = Sphere { radius: self.radius - depth };
        left.check().is_ok().then_some(left)
    }

    fn least_radius(&self) -> f64 {
        self.radius
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.radius)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, direction: DVec3) -> f64 {
        self.radius * direction.length()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.radius.min(reach)
    }
}
