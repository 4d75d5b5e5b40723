//! Regular prism.

use std::sync::Arc;

use glam::DVec3;

use super::kaleidoscope::RegularPolygon;
use super::{AnyField, Field, HalfSpace, ParamError, Slab, check, slope::lipschitz_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A prism on a regular polygon, along the z axis and centred at the origin, with a corner on
/// the positive x axis, by true distance (1-Lipschitz).
///
#[doc = picture!("prism" = "docs/gallery/prism.png")]
///
/// The point is folded to the sector of one edge (u along its normal, v along it from its
/// middle). With `q = (u − inscribed radius, v − edge/2, |z| − height/2)`:
/// `f = −|max(q, 0)| − min(max(q_u, q_z), 0)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `sides` | none | 3 to 1000 |
/// | `radius` | length | 10⁻⁹ to 10⁹; of the circle through the corners |
/// | `height` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Prism, Solid};
/// use glam::DVec3;
///
/// // The head of a bolt, 10 across flats.
/// let head = Solid::from(Prism::across_flats(6, 10.0, 4.0));
/// assert!((head.value(DVec3::new(0.0, 8.0, 0.0))? + 3.0).abs() < 1e-12);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    base: RegularPolygon,
    height: f64,
}

impl Prism {
    /// A prism with `sides` sides whose corners are at `radius` from the z axis.
    #[must_use]
    pub fn new(sides: u32, radius: f64, height: f64) -> Prism {
        Prism { base: RegularPolygon::new(sides, radius), height }
    }

    /// A prism by twice the radius of the circle inside its base: where the number of sides
    /// is even, the distance from flat to flat.
    #[must_use]
    pub fn across_flats(sides: u32, width: f64, height: f64) -> Prism {
        let half_sector = std::f64::consts::PI / f64::from(sides);
        Prism::new(sides, 0.5 * width / half_sector.cos(), height)
    }

    /// Number of sides.
    #[must_use]
    pub fn sides(&self) -> u32 {
        self.base.sides
    }

    /// Distance of the corners from the z axis.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.base.radius
    }

    /// Distance of the flats from the z axis.
    #[must_use]
    pub fn inscribed_radius(&self) -> f64 {
        self.base.inscribed
    }

    /// Length along z.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height
    }
}

impl Field for Prism {
    fn name(&self) -> &'static str {
        "prism"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let zero = x.lift(0.0);
        let [u, v] = self.base.fold(x, y);
        let side = u - self.base.inscribed;
        let cap = z.abs() - 0.5 * self.height;
        // Inside the polygon v is within the edge: it counts outside only.
        let past = (v - self.base.half_edge).max(zero);
        let outside = side.max(zero).nested_as(past, cap.max(zero), Euclid, Euclid);
        -(outside + side.max(cap).min(zero))
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        let side = |normal: DVec3| Arc::new(HalfSpace { normal, offset: self.inscribed_radius() }) as Arc<dyn AnyField>;
        let caps = Arc::new(Slab { normal: DVec3::Z, thickness: self.height });
        self.base.normals().map(|n| side(n.extend(0.0))).chain([caps as Arc<dyn AnyField>]).collect()
    }

    fn bounds(&self) -> Bounds {
        let [min, max] = self.base.corners(0.5 * self.height);
        Bounds::new(min, max)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.base.check()?;
        check::length("height", self.height)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Prism> {
        let left = Prism::new(
            self.sides(),
            self.radius() * (1.0 - depth / self.inscribed_radius()),
            self.height - 2.0 * depth,
        );
        Field::check(&left).is_ok().then_some(left)
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        lipschitz_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        self.base.support(d.truncate()) + 0.5 * self.height * d.z.abs()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * (self.base.radius + self.height).min(reach)
    }
}
