//! Wedge: half a box.

use std::sync::Arc;

use glam::DVec3;

use super::{AnyField, Field, HalfSpace, ParamError, Slab, check, slope::lipschitz_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A ramp: the half of a box about the origin that lies below the plane through two of its
/// edges along y, by true distance (1-Lipschitz).
///
#[doc = picture!("wedge" = "docs/gallery/wedge.png")]
///
/// ```text
///      z
///      |\
///      |  \        x/size_x + z/size_z ≤ 0
///      |____\ x
/// ```
///
/// In the plane of x and z it is a right triangle. Inside, f is the distance to the nearest
/// of its edges' lines or of the two flanks; outside, minus that to the nearest edge, joined
/// with the overhang along y.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `size` | length | 10⁻⁹ to 10⁹ each; of the whole box |
///
/// ```
/// use rvachev::{Solid, Wedge};
/// use glam::DVec3;
///
/// let ramp = Solid::from(Wedge { size: DVec3::new(8.0, 2.0, 6.0) });
/// assert!((ramp.value(DVec3::new(3.0, 0.0, 4.0))? + 5.0).abs() < 1e-12);
/// assert_eq!(ramp.value(DVec3::new(-3.5, 0.0, -2.0))?, 0.5);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wedge {
    /// Lengths of the box along x, y and z.
    pub size: DVec3,
}

impl Field for Wedge {
    fn name(&self) -> &'static str {
        "wedge"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let zero = x.lift(0.0);
        let half = 0.5 * self.size;
        let slant = (half.x * half.x + half.z * half.z).sqrt();
        let (cos, sin) = (half.x / slant, half.z / slant);
        // Off the three edges, and past their ends.
        let off = x.scale_add(sin, z * cos);
        let past = (x.scale_add(cos, z * -sin).abs() - slant).max(zero);
        let (left, low) = (-x - half.x, -z - half.z);
        let past_left = (z.abs() - half.z).max(zero);
        let past_low = (x.abs() - half.x).max(zero);
        let deepest = off.max(left).max(low);
        let nearest = off.norm_as(past, Euclid).min(left.norm_as(past_left, Euclid)).min(low.norm_as(past_low, Euclid));
        let flank = y.abs() - half.y;
        let inside = -deepest.max(flank);
        let out = deepest.select(nearest, zero).norm_as(flank.max(zero), Euclid);
        inside.select(inside, -out)
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        let half = 0.5 * self.size;
        let wall = |normal: DVec3, offset: f64| -> Arc<dyn AnyField> { Arc::new(HalfSpace { normal, offset }) };
        let ramp = wall(DVec3::new(half.z, 0.0, half.x).normalize(), 0.0);
        let flanks = Arc::new(Slab { normal: DVec3::Y, thickness: self.size.y });
        vec![ramp, wall(-DVec3::X, half.x), wall(-DVec3::Z, half.z), flanks]
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
        lipschitz_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        let d = 0.5 * self.size * d;
        (-d.x - d.z).max((d.x - d.z).abs()) + d.y.abs()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.size.length().min(reach)
    }
}
