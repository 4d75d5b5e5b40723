//! Capsule: a cylinder with hemispherical ends.

use glam::DVec3;

use super::{Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A cylinder with hemispherical ends along the z axis, centred at the origin, by true
/// distance (1-Lipschitz): all points within `radius` of a segment.
///
#[doc = picture!("capsule" = "docs/gallery/capsule.png")]
///
/// `f = radius − |(x, y, max(|z| − height/2 + radius, 0))|`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius` | length | 10⁻⁹ to 10⁹ |
/// | `height` | length | 2·`radius` to 10⁹; from end to end, both hemispheres included |
///
/// ```
/// use rvachev::{Capsule, Solid};
/// use glam::DVec3;
///
/// let pill = Solid::from(Capsule { radius: 1.0, height: 6.0 });
/// assert_eq!(pill.value(DVec3::new(0.0, 0.0, 5.0))?, -2.0);
/// assert_eq!(pill.value(DVec3::new(3.0, 0.0, 1.0))?, -2.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Radius of the cylinder and of the ends.
    pub radius: f64,
    /// Length along z from end to end.
    pub height: f64,
}

impl Capsule {
    /// Half the length of the segment.
    #[inline(always)]
    fn half(&self) -> f64 {
        0.5 * self.height - self.radius
    }
}

impl Field for Capsule {
    fn name(&self) -> &'static str {
        "capsule"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let beyond = (z.abs() - self.half()).max(z.lift(0.0));
        -x.nested_as(y, beyond, Euclid, Euclid) + self.radius
    }

    fn bounds(&self) -> Bounds {
        let half = DVec3::new(self.radius, self.radius, 0.5 * self.height);
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("radius", self.radius)?;
        check::length("height", self.height)?;
        check::within("height", self.height, 2.0 * self.radius, check::LARGEST_LENGTH)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Capsule> {
        let left = Capsule { radius: self.radius - depth, height: self.height - 2.0 * depth };
        left.check().is_ok().then_some(left)
    }

    fn least_radius(&self) -> f64 {
        self.radius
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        self.radius * d.length() + self.half() * d.z.abs()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.height.min(reach)
    }
}
