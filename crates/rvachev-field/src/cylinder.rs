//! Circular cylinder.

use std::sync::Arc;

use glam::DVec3;

use super::check::LARGEST_LENGTH;
use super::{AnyField, Field, ParamError, Slab, check, leaf::falling_range, rfunction::DistanceAnd};
use crate::{Bounds, Dual, Euclid, Interval, Real};

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

impl Cylinder {
    /// How far within its side and its end faces a point is.
    #[inline(always)]
    fn within<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 2] {
        [x.lift(self.radius) - x.norm_as(y, Euclid), z.lift(0.5 * self.height) - z.abs()]
    }
}

impl Field for Cylinder {
    fn name(&self) -> &'static str {
        "cylinder"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let [side, cap] = self.within(p);
        side.monotone(cap, &DistanceAnd)
    }

    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        self.within(p).into()
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        // The longest has no ends that count.
        if self.height >= LARGEST_LENGTH {
            return Vec::new();
        }
        let side = Cylinder { height: LARGEST_LENGTH, ..*self };
        vec![Arc::new(side), Arc::new(Slab { normal: DVec3::Z, thickness: self.height })]
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

    fn eroded(&self, depth: f64) -> Option<Cylinder> {
        let left = Cylinder { radius: self.radius - depth, height: self.height - 2.0 * depth };
        Field::check(&left).is_ok().then_some(left)
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
