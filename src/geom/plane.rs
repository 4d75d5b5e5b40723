//! Planes with coordinates.
//!
//! ```text
//!        v
//!        |
//!        |   p = origin + x·u + y·v
//!        *----- u
//!       origin         normal = u × v, towards the viewer
//! ```

use glam::{DVec2, DVec3};

use super::unit;

/// A plane, with an origin and two axes at right angles.
///
/// ```
/// use rvachev::Plane;
/// use glam::{DVec2, DVec3};
///
/// let plane = Plane::xz(2.0);
/// assert_eq!(plane.point(DVec2::new(1.0, 3.0)), DVec3::new(1.0, 2.0, 3.0));
/// assert_eq!(plane.normal(), -DVec3::Y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plane {
    origin: DVec3,
    u: DVec3,
    v: DVec3,
}

impl Plane {
    /// The plane at height `z`, seen from above: x to the right, y up.
    #[must_use]
    pub fn xy(z: f64) -> Plane {
        Plane { origin: DVec3::Z * z, u: DVec3::X, v: DVec3::Y }
    }

    /// The plane at `y`, seen from the front: x to the right, z up.
    #[must_use]
    pub fn xz(y: f64) -> Plane {
        Plane { origin: DVec3::Y * y, u: DVec3::X, v: DVec3::Z }
    }

    /// The plane at `x`, seen from the right: y to the right, z up.
    #[must_use]
    pub fn yz(x: f64) -> Plane {
        Plane { origin: DVec3::X * x, u: DVec3::Y, v: DVec3::Z }
    }

    /// The plane through `origin` at a right angle to `normal`, which points to the viewer; v
    /// is as near to +z as can be, or to +y where the normal is along z. `normal` may have any
    /// length; one that is 0 or not finite makes a plane that no solid can be sliced by.
    #[must_use]
    pub fn new(origin: impl Into<DVec3>, normal: impl Into<DVec3>) -> Plane {
        let normal = unit(normal.into());
        let up = if normal.z.abs() > 1.0 - 1e-12 { DVec3::Y } else { DVec3::Z };
        let u = up.cross(normal).normalize();
        Plane { origin: origin.into(), u, v: normal.cross(u) }
    }

    /// Where both coordinates are 0.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The axes, of length 1 and at right angles.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 2] {
        [self.u, self.v]
    }

    /// Towards the viewer, of length 1.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.u.cross(self.v)
    }

    /// The point of space with these coordinates.
    #[must_use]
    pub fn point(&self, p: impl Into<DVec2>) -> DVec3 {
        let p = p.into();
        self.origin + p.x * self.u + p.y * self.v
    }

    /// The coordinates of a point of space, seen along the normal.
    #[must_use]
    pub fn coordinates(&self, p: impl Into<DVec3>) -> DVec2 {
        let p = p.into() - self.origin;
        DVec2::new(p.dot(self.u), p.dot(self.v))
    }

    /// The plane moved along its normal.
    pub(crate) fn moved_by(&self, by: f64) -> Plane {
        Plane { origin: self.origin + by * self.normal(), ..*self }
    }

    /// Whether its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.origin.is_finite() && self.u.is_finite() && self.v.is_finite()
    }
}
