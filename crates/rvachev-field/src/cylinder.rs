//! Circular cylinder.

use glam::DVec3;

use super::{Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A cylinder about the z axis, centred at the origin, by true distance (1-Lipschitz).
///
#[doc = picture!("cylinder" = "docs/gallery/cylinder.png")]
///
/// With `q = (√(x² + y²) − radius, |z| − height/2)`:
/// `f = −|max(q, 0)| − min(max(q_1, q_2), 0)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius`, `height` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Cylinder, Solid};
/// use glam::DVec3;
///
/// let rod = Solid::from(Cylinder { radius: 1.0, height: 10.0 });
/// assert_eq!(rod.value(DVec3::new(0.0, 0.0, 4.0))?, 1.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius in length units.
    pub radius: f64,
    /// Length along z.
    pub height: f64,
}

impl Field for Cylinder {
    fn name(&self) -> &'static str {
        "cylinder"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let side = x.norm_as(y, Euclid) - self.radius;
        let cap = z.abs() - 0.5 * self.height;
        let zero = x.lift(0.0);
        let (os, oc) = (side.max(zero), cap.max(zero));
        -(os.norm_as(oc, Euclid) + side.max(cap).min(zero))
    }

    fn bounds(&self) -> Bounds {
        let half = DVec3::new(self.radius, self.radius, 0.5 * self.height);
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("radius", self.radius)?;
        check::length("height", self.height)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        self.radius * d.truncate().length() + 0.5 * self.height * d.z.abs()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * (self.radius + self.height).min(reach)
    }
}
