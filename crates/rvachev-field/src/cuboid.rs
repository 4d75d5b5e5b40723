//! Box (cuboid).

use glam::DVec3;

use super::{Field, ParamError, check, leaf::falling_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A box about the origin with edges along the axes, by true distance (1-Lipschitz).
///
#[doc = picture!("cuboid" = "docs/gallery/cuboid.png")]
///
/// With `q = |p| − size/2`: `f = −|max(q, 0)| − min(max(q_x, q_y, q_z), 0)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `size` | length | 10⁻⁹ to 10⁹ each |
///
/// ```
/// use rvachev::{Cuboid, Solid};
/// use glam::DVec3;
///
/// let brick = Solid::from(Cuboid { size: DVec3::new(4.0, 2.0, 1.0) });
/// assert_eq!(brick.value(DVec3::new(5.0, 5.0, 0.0))?, -5.0);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Lengths of the edges along x, y and z.
    pub size: DVec3,
}

impl Field for Cuboid {
    fn name(&self) -> &'static str {
        "box"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let qx = x.abs() - 0.5 * self.size.x;
        let qy = y.abs() - 0.5 * self.size.y;
        let qz = z.abs() - 0.5 * self.size.z;
        let zero = x.lift(0.0);
        let (ox, oy, oz) = (qx.max(zero), qy.max(zero), qz.max(zero));
        let outside = ox.nested_as(oy, oz, Euclid, Euclid);
        -(outside + qx.max(qy).max(qz).min(zero))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-0.5 * self.size, 0.5 * self.size)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("size", self.size)
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

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.size.length().min(reach)
    }
}
