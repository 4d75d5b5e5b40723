//! Cone and truncated cone.

use glam::DVec3;

use super::{Field, ParamError, check, slope::lipschitz_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A circular cone about the z axis, pointed or truncated, centred at the origin (the base is
/// at z = −height/2), by true distance (1-Lipschitz).
///
#[doc = picture!("cone" = "docs/gallery/cone.png", "cone_truncated" = "docs/gallery/cone_truncated.png")]
///
/// In the half-plane of `r = √(x² + y²)` and z it is a trapezoid. Inside, f is the distance
/// to the nearest of the planes of its edges; outside, minus that to the nearest edge.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `bottom_radius`, `top_radius` | length | 0 to 10⁹, one of them at least 10⁻⁹ |
/// | `height` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Cone, Solid};
/// use glam::DVec3;
///
/// let tip = Solid::from(Cone { bottom_radius: 3.0, top_radius: 0.0, height: 4.0 });
/// assert_eq!(tip.value(DVec3::new(0.0, 0.0, 3.0))?, -1.0);
/// assert!((tip.value(DVec3::new(5.5, 0.0, 1.0))? + 3.8).abs() < 1e-12);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Radius at z = −height/2.
    pub bottom_radius: f64,
    /// Radius at z = height/2; 0 for a point.
    pub top_radius: f64,
    /// Length along z.
    pub height: f64,
}

impl Field for Cone {
    fn name(&self) -> &'static str {
        "cone"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let zero = x.lift(0.0);
        let narrowing = self.bottom_radius - self.top_radius;
        let slant = (narrowing * narrowing + self.height * self.height).sqrt();
        let (rise, run) = (self.height / slant, narrowing / slant);
        let r = x.norm_as(y, Euclid);
        // Off the slanted edge, and along it from its middle.
        let from_middle = r - 0.5 * (self.bottom_radius + self.top_radius);
        let off = from_middle.scale_add(rise, z * run);
        let along = from_middle.scale_add(-run, z * rise);
        let cap = z.abs() - 0.5 * self.height;
        let side = off.norm_as((along.abs() - 0.5 * slant).max(zero), Euclid);
        // Of the caps only the nearer one can be met before the side is.
        let radius = z.select(z.lift(self.top_radius), z.lift(self.bottom_radius));
        let end = cap.norm_as((r - radius).max(zero), Euclid);
        let inside = -off.max(cap);
        inside.select(inside, -side.min(end))
    }

    fn bounds(&self) -> Bounds {
        let radius = self.bottom_radius.max(self.top_radius);
        let half = DVec3::new(radius, radius, 0.5 * self.height);
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::within("bottom_radius", self.bottom_radius, 0.0, check::LARGEST_LENGTH)?;
        check::within("top_radius", self.top_radius, 0.0, check::LARGEST_LENGTH)?;
        if self.top_radius < check::SMALLEST_LENGTH {
            check::length("bottom_radius", self.bottom_radius)?;
        }
        check::length("height", self.height)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Cone> {
        // Of a pointed one what is left is not in the middle of its height.
        let narrowing = self.bottom_radius - self.top_radius;
        let (slant, part) = (narrowing.hypot(self.height), depth / self.height);
        let left = Cone {
            bottom_radius: self.bottom_radius - part * (slant + narrowing),
            top_radius: self.top_radius - part * (slant - narrowing),
            height: self.height - 2.0 * depth,
        };
        left.check().is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        lipschitz_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        let (across, up) = (d.truncate().length(), 0.5 * self.height * d.z);
        (self.bottom_radius * across - up).max(self.top_radius * across + up)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * (self.bottom_radius.max(self.top_radius) + self.height).min(reach)
    }
}
