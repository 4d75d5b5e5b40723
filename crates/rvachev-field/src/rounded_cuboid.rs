//! Box with rounded edges and corners.

use glam::DVec3;

use super::{Cuboid, Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Interval, Real};

/// A box about the origin whose edges and corners are rounded, by true distance (1-Lipschitz):
/// all points within `radius` of the box that is smaller by `radius` on every side.
///
#[doc = picture!("rounded_cuboid" = "docs/gallery/rounded_cuboid.png")]
///
/// With `q = |p| − size/2 + radius`: `f = radius − |max(q, 0)| − min(max(q_x, q_y, q_z), 0)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `size` | length | 10⁻⁹ to 10⁹ each; from face to face |
/// | `radius` | length | 0 to half the smallest of `size` |
///
/// ```
/// use rvachev::{RoundedCuboid, Solid};
/// use glam::DVec3;
///
/// let soap = Solid::from(RoundedCuboid { size: DVec3::new(4.0, 2.0, 2.0), radius: 0.5 });
/// assert_eq!(soap.value(DVec3::new(3.0, 0.0, 0.0))?, -1.0);
/// assert!(!soap.contains(DVec3::new(1.9, 0.9, 0.9))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCuboid {
    /// Lengths along x, y and z, from face to face.
    pub size: DVec3,
    /// Radius of the edges and corners.
    pub radius: f64,
}

impl Field for RoundedCuboid {
    fn name(&self) -> &'static str {
        "rounded box"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let core = Cuboid { size: self.size - DVec3::splat(2.0 * self.radius) };
        core.eval(p) + self.radius
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-0.5 * self.size, 0.5 * self.size)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("size", self.size)?;
        check::within("radius", self.radius, 0.0, 0.5 * self.size.min_element())
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<RoundedCuboid> {
        let left = RoundedCuboid { size: self.size - 2.0 * depth, radius: (self.radius - depth).max(0.0) };
        left.check().is_ok().then_some(left)
    }

    fn least_radius(&self) -> f64 {
        self.radius
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        let core = 0.5 * self.size - DVec3::splat(self.radius);
        core.dot(d.abs()) + self.radius * d.length()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.size.length().min(reach)
    }
}
