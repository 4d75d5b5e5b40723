//! Box (cuboid).

use std::sync::Arc;

use glam::DVec3;

use super::{AnyField, Field, ParamError, Slab, check, leaf::falling_range, rfunction::DistanceAnd};
use crate::{Bounds, Dual, Interval, Real};

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

impl Cuboid {
    /// How far within its pairs of faces a point is.
    #[inline(always)]
    fn within<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let within = |x: R, size: f64| x.lift(0.5 * size) - x.abs();
        [within(x, self.size.x), within(y, self.size.y), within(z, self.size.z)]
    }
}

impl Field for Cuboid {
    fn name(&self) -> &'static str {
        "box"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let [a, b, c] = self.within(p);
        a.monotone3(b, c, &DistanceAnd)
    }

    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        self.within(p).into()
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        let slab = |axis: usize| Slab { normal: DVec3::AXES[axis], thickness: self.size[axis] };
        (0..3).map(|axis| Arc::new(slab(axis)) as Arc<dyn AnyField>).collect()
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

    fn eroded(&self, depth: f64) -> Option<Cuboid> {
        let left = Cuboid { size: self.size - 2.0 * depth };
        Field::check(&left).is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, region)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.size.length().min(reach)
    }
}
