//! Circle.

use glam::{DVec2, DVec3};

use super::super::{Field, ParamError, check, leaf::falling_range};
use super::{column, flattened};
use crate::{Bounds, Euclid, Interval, Real};

/// A disc about the origin of the plane: `f = radius − √(x² + y²)`, the true distance
/// (1-Lipschitz).
///
#[doc = picture!("profile_circle" = "docs/gallery/profile_circle.png")]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Circle, Profile};
/// use glam::DVec2;
///
/// let disc = Profile::from(Circle { radius: 2.0 });
/// assert_eq!(disc.value(DVec2::new(0.0, 1.5))?, 0.5);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Radius in length units.
    pub radius: f64,
}

impl Field for Circle {
    fn name(&self) -> &'static str {
        "circle"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        -x.norm_as(y, Euclid) + self.radius
    }

    fn bounds(&self) -> Bounds {
        column(DVec2::splat(self.radius))
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

    fn eroded(&self, depth: f64) -> Option<Circle> {
        let left = Circle { radius: self.radius - depth };
        left.check().is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, flattened(region))
    }

    fn support(&self, d: DVec3) -> f64 {
        if d.z == 0.0 { self.radius * d.truncate().length() } else { f64::INFINITY }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.radius.min(reach)
    }
}
