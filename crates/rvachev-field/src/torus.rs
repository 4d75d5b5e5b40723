//! Circular torus.

use glam::DVec3;

use super::{Field, ParamError, check};
use crate::{Bounds, Euclid, Real};

/// A ring about the z axis, centred at the origin, by true distance (1-Lipschitz): all points
/// within `tube` of a circle in the plane z = 0.
///
#[doc = picture!("torus" = "docs/gallery/torus.png")]
///
/// `f = tube − |(√(x² + y²) − radius, z)|`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius` | length | 10⁻⁹ to 10⁹; of the circle, from the axis to the middle of the tube |
/// | `tube` | length | 10⁻⁹ to `radius` |
///
/// A fatter tube would cross itself on the axis, where this formula is no longer the distance.
///
/// ```
/// use rvachev::{Solid, Torus};
/// use glam::DVec3;
///
/// let ring = Solid::from(Torus { radius: 3.0, tube: 1.0 });
/// assert_eq!(ring.value(DVec3::new(0.0, 3.0, 0.5))?, 0.5);
/// assert_eq!(ring.value(DVec3::ZERO)?, -2.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Distance from the axis to the middle of the tube.
    pub radius: f64,
    /// Radius of the tube.
    pub tube: f64,
}

impl Field for Torus {
    fn name(&self) -> &'static str {
        "torus"
    }

    // Every coordinate occurs once, so that the range by intervals is exact.
    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let off = x.norm_as(y, Euclid) - self.radius;
        -off.norm_as(z, Euclid) + self.tube
    }

    fn bounds(&self) -> Bounds {
        let reach = self.radius + self.tube;
        let half = DVec3::new(reach, reach, self.tube);
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("radius", self.radius)?;
        check::length("tube", self.tube)?;
        check::within("tube", self.tube, check::SMALLEST_LENGTH, self.radius)
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Torus> {
        let left = Torus { tube: self.tube - depth, ..*self };
        left.check().is_ok().then_some(left)
    }

    fn least_radius(&self) -> f64 {
        self.tube.min(self.radius - self.tube)
    }

    fn support(&self, d: DVec3) -> f64 {
        self.radius * d.truncate().length() + self.tube * d.length()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * (self.radius + self.tube).min(reach)
    }
}
