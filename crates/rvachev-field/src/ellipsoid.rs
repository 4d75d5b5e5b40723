//! Ellipsoid.

use glam::DVec3;

use super::{Cuboid, Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Real};

/// An ellipsoid about the origin with its axes along x, y and z. The value is a bound: it
/// has the sign of the distance and is never larger (1-Lipschitz).
///
#[doc = picture!("ellipsoid" = "docs/gallery/ellipsoid.png")]
///
/// With the gauge `G = |(x/a, y/b, z/c)|` and the smallest semi-axis s:
/// `f = min(s·(1 − G), distance inside the box of half-sizes a, b, c)`.
///
/// Inside, the first is below the distance because the distance to a convex surface is
/// concave along the ray from the centre, where it is s. Outside, the box is nearer than the
/// ellipsoid that it holds; beyond the ends of a long ellipsoid, where the gauge falls by
/// s/a per unit only, it is the distance. On an axis beyond the surface f is the distance.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each |
///
/// ```
/// use rvachev::{Ellipsoid, Solid};
/// use glam::DVec3;
///
/// let egg = Solid::from(Ellipsoid { semi_axes: DVec3::new(5.0, 2.0, 1.0) });
/// assert_eq!(egg.value(DVec3::ZERO)?, 1.0);
/// assert_eq!(egg.value(DVec3::new(8.0, 0.0, 0.0))?, -3.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Half the lengths along x, y and z.
    pub semi_axes: DVec3,
}

impl Field for Ellipsoid {
    fn name(&self) -> &'static str {
        "ellipsoid"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let a = self.semi_axes;
        let s = a.x.min(a.y).min(a.z);
        let gauge = (x * (s / a.x)).nested_as(y * (s / a.y), z * (s / a.z), Euclid, Euclid);
        let hull = Cuboid { size: 2.0 * a };
        (-gauge + s).min(hull.eval([x, y, z]))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-self.semi_axes, self.semi_axes)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("semi_axes", self.semi_axes)
    }

    fn convex(&self) -> bool {
        true
    }

    fn least_radius(&self) -> f64 {
        self.semi_axes.min_element().powi(2) / self.semi_axes.max_element()
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        (self.semi_axes * d).length() * (1.0 + 1e-14)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.semi_axes.length().min(reach)
    }
}
