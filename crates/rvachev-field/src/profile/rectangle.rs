//! Rectangle, its corners sharp or rounded.

use glam::{DVec2, DVec3};

use super::super::{Field, ParamError, check, leaf::falling_range, rfunction::DistanceAnd};
use super::{column, flattened};
use crate::{Bounds, Dual, Interval, Real};

/// A rectangle about the origin of the plane, by true distance (1-Lipschitz);
/// `radius` rounds its corners.
///
#[doc = picture!(
    "profile_rectangle" = "docs/gallery/profile_rectangle.png",
    "profile_rounded_rectangle" = "docs/gallery/profile_rounded_rectangle.png",
)]
///
/// With `q = (|x| − size.x/2, |y| − size.y/2) + radius`:
/// `f = radius − |max(q, 0)| − min(max(q_1, q_2), 0)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `size` | length | 10⁻⁹ to 10⁹ each: the lengths of the sides |
/// | `radius` | length | 0 (sharp corners) to half the shorter side |
///
/// ```
/// use rvachev::{Profile, Rectangle};
/// use glam::DVec2;
///
/// let plate = Profile::from(Rectangle { size: DVec2::new(4.0, 2.0), radius: 0.5 });
/// assert_eq!(plate.value(DVec2::new(1.8, 0.0))?, 0.19999999999999996);
/// assert!(!plate.contains(DVec2::new(1.95, 0.95))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Lengths of the sides along x and y.
    pub size: DVec2,
    /// Radius of the corners.
    pub radius: f64,
}

impl Rectangle {
    /// How far within the pairs of sides of its core a point is.
    #[inline(always)]
    fn within<R: Real>(&self, [x, y, _]: [R; 3]) -> [R; 2] {
        let within = |x: R, size: f64| x.lift(0.5 * size - self.radius) - x.abs();
        [within(x, self.size.x), within(y, self.size.y)]
    }
}

impl Field for Rectangle {
    fn name(&self) -> &'static str {
        "rectangle"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let [a, b] = self.within(p);
        a.monotone(b, &DistanceAnd) + self.radius
    }

    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        if self.radius > 0.0 { vec![self.dual_range(p)] } else { self.within(p).into() }
    }

    fn bounds(&self) -> Bounds {
        column(0.5 * self.size)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("size.x", self.size.x)?;
        check::length("size.y", self.size.y)?;
        check::within("radius", self.radius, 0.0, 0.5 * self.size.min_element())
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Rectangle> {
        let left = Rectangle { size: self.size - 2.0 * depth, radius: (self.radius - depth).max(0.0) };
        left.check().is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        falling_range(self, flattened(region))
    }

    fn support(&self, d: DVec3) -> f64 {
        if d.z != 0.0 {
            return f64::INFINITY;
        }
        let d = d.truncate();
        (0.5 * self.size - self.radius).dot(d.abs()) + self.radius * d.length() * (1.0 + 1e-15)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.size.length().min(reach)
    }
}
