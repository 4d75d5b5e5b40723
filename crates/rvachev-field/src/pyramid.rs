//! Regular pyramid.

use std::sync::Arc;

use glam::DVec3;

use super::kaleidoscope::RegularPolygon;
use super::{AnyField, Field, HalfSpace, ParamError, check, slope::lipschitz_range};
use crate::{Bounds, Euclid, Interval, Real};

/// A pyramid on a regular polygon, along the z axis and centred at the origin (base at
/// z = −height/2, apex at z = height/2), with a corner on the side of positive x, by true
/// distance (1-Lipschitz).
///
#[doc = picture!("pyramid" = "docs/gallery/pyramid.png")]
///
/// The point is folded to the sector of one face. Inside, f is the distance to the nearer of
/// the planes of face and base; outside, minus that to the nearest of face and base, each cut
/// at its edges.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `sides` | none | 3 to 1000 |
/// | `radius` | length | 10⁻⁹ to 10⁹; of the circle through the corners of the base |
/// | `height` | length | 10⁻⁹ to 10⁹ |
///
/// ```
/// use rvachev::{Pyramid, Solid};
/// use glam::DVec3;
///
/// let roof = Solid::from(Pyramid::new(4, 3.0, 2.0));
/// assert!((roof.value(DVec3::new(0.0, 0.0, 3.0))? + 2.0).abs() < 1e-12);
/// assert!(roof.value(DVec3::new(3.0, 0.0, -1.0))?.abs() < 1e-12);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pyramid {
    base: RegularPolygon,
    height: f64,
}

impl Pyramid {
    /// A pyramid with `sides` faces besides the base, whose base has its corners at `radius`
    /// from the z axis.
    #[must_use]
    pub fn new(sides: u32, radius: f64, height: f64) -> Pyramid {
        Pyramid { base: RegularPolygon::new(sides, radius), height }
    }

    /// Number of faces besides the base.
    #[must_use]
    pub fn sides(&self) -> u32 {
        self.base.sides
    }

    /// Distance of the base's corners from the z axis.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.base.radius
    }

    /// Length along z.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height
    }
}

impl Field for Pyramid {
    fn name(&self) -> &'static str {
        "pyramid"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let zero = x.lift(0.0);
        let RegularPolygon { inscribed, half_edge, .. } = self.base;
        let height = self.height;
        let [u, v] = self.base.fold(x, y);
        let (side, past) = (u - inscribed, v - half_edge);
        let floor = -z - 0.5 * height;
        // The face: off it, and up it from the edge of the base.
        let slant = (inscribed * inscribed + height * height).sqrt();
        let (rise, run) = (height / slant, inscribed / slant);
        let off = side.scale_add(rise, floor * -run);
        let up = side.scale_add(-run, floor * -rise);
        // The edge between two faces: off it within the face, and along it from its middle.
        let edge = (half_edge * half_edge + slant * slant).sqrt();
        let (steep, flat) = (slant / edge, half_edge / edge);
        let beside = up.scale_add(flat, past * steep);
        let along = (up - 0.5 * slant).scale_add(steep, (past + 0.5 * half_edge) * -flat);
        let to_edge = beside.norm_as((along.abs() - 0.5 * edge).max(zero), Euclid);
        // Below the face's lower edge the base is nearer than anything of the face.
        let to_face = off.norm_as(up.min(-beside).select(zero, to_edge), Euclid);
        let to_base = side.max(zero).nested_as(past.max(zero), floor, Euclid, Euclid);
        let inside = -off.max(floor);
        inside.select(inside, -to_face.min(to_base))
    }

    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        let RegularPolygon { inscribed, .. } = self.base;
        let wall = |normal: DVec3, through: DVec3| -> Arc<dyn AnyField> {
            let normal = normal.normalize();
            Arc::new(HalfSpace { normal, offset: normal.dot(through) })
        };
        let apex = 0.5 * self.height * DVec3::Z;
        let faces = self.base.normals().map(|n| wall((self.height * n).extend(inscribed), apex));
        faces.chain([wall(-DVec3::Z, -apex)]).collect()
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

    fn range(&self, region: [Interval; 3]) -> Interval {
        lipschitz_range(self, region)
    }

    fn support(&self, d: DVec3) -> f64 {
        let up = 0.5 * self.height * d.z;
        (self.base.support(d.truncate()) - up).max(up)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * (self.base.radius + self.height).min(reach)
    }
}
