//! Slab: what lies between two parallel planes.

use glam::DVec3;

use super::{Field, ParamError, check, unit};
use crate::{Bounds, Real};

/// Everything between two parallel planes about the origin: `f = thickness/2 − |n·p|`, the
/// true distance (1-Lipschitz).
///
#[doc = picture!("slab" = "docs/gallery/slab.png")]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `normal` | none | not zero; of any length, across the planes |
/// | `thickness` | length | 10⁻⁹ to 10⁹, from plane to plane |
///
/// A slab is unbounded: join it with something bounded before meshing.
///
/// ```
/// use rvachev::{Slab, Solid};
/// use glam::DVec3;
///
/// let layer = Solid::from(Slab { normal: DVec3::Z, thickness: 2.0 });
/// assert_eq!(layer.value(DVec3::new(30.0, -40.0, 0.75))?, 0.25);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Direction across the planes.
    pub normal: DVec3,
    /// Distance of the planes from one another.
    pub thickness: f64,
}

impl Slab {
    #[inline(always)]
    fn unit(&self) -> DVec3 {
        unit(self.normal)
    }
}

impl Field for Slab {
    fn name(&self) -> &'static str {
        "slab"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let n = self.unit();
        let height = x.scale_add(n.x, y.scale_add(n.y, z * n.z));
        -height.abs() + 0.5 * self.thickness
    }

    fn bounds(&self) -> Bounds {
        let n = self.unit();
        let mut bounds = Bounds::ALL;
        for axis in 0..3 {
            // Only planes across an axis bound anything.
            if n[axis].abs() == 1.0 {
                bounds.max[axis] = 0.5 * self.thickness;
                bounds.min[axis] = -0.5 * self.thickness;
            }
        }
        bounds
    }

    fn check(&self) -> Result<(), ParamError> {
        check::direction("normal", self.normal)?;
        check::length("thickness", self.thickness)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Slab> {
        let left = Slab { thickness: self.thickness - 2.0 * depth, ..*self };
        left.check().is_ok().then_some(left)
    }

    fn support(&self, d: DVec3) -> f64 {
        // Bounded along the normal only, up to rounding of the direction.
        let n = self.unit();
        let along = d.dot(n);
        if d == n * along {
            0.5 * self.thickness * along.abs()
        } else if d == DVec3::ZERO {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        1e-6 * (reach + self.thickness.min(reach))
    }
}
