//! Half-space.

use glam::DVec3;

use super::outlined::Outlined;
use super::{Field, ParamError, check, unit};
use crate::{Bounds, Interval, Real};

/// Everything on one side of a plane: `f = offset − n·p`, the true distance (1-Lipschitz).
///
#[doc = picture!("half_space" = "docs/gallery/half_space.png")]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `normal` | none | not zero; of any length, it points out of the solid |
/// | `offset` | length | −10⁹ to 10⁹, distance of the plane from the origin along the normal |
///
/// A half-space is unbounded: join it with something bounded before meshing.
///
/// ```
/// use rvachev::{HalfSpace, Solid};
/// use glam::DVec3;
///
/// let ground = Solid::from(HalfSpace { normal: DVec3::Z, offset: 0.0 });
/// assert!(ground.contains(DVec3::new(3.0, 4.0, -0.1))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Direction out of the solid.
    pub normal: DVec3,
    /// Distance of the plane from the origin, along the normal.
    pub offset: f64,
}

impl HalfSpace {
    #[inline(always)]
    fn unit(&self) -> DVec3 {
        unit(self.normal)
    }
}

impl Field for HalfSpace {
    fn name(&self) -> &'static str {
        "half-space"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let n = self.unit();
        let height = x.scale_add(-n.x, y.scale_add(-n.y, z * -n.z));
        height + self.offset
    }

    fn bounds(&self) -> Bounds {
        let n = self.unit();
        let mut bounds = Bounds::ALL;
        for axis in 0..3 {
            // Only a plane across an axis bounds anything.
            if n[axis] == 1.0 {
                bounds.max[axis] = self.offset;
            } else if n[axis] == -1.0 {
                bounds.min[axis] = -self.offset;
            }
        }
        bounds
    }

    fn check(&self) -> Result<(), ParamError> {
        check::direction("normal", self.normal)?;
        check::finite("offset", self.offset)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<HalfSpace> {
        let left = HalfSpace { offset: self.offset - depth, ..*self };
        left.check().is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        self.over(region)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        1e-6 * (reach + self.offset.abs().min(reach))
    }
}
