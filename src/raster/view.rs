//! From the world to pixels and depths.
//!
//! ```text
//!      eye                     picture
//!       * - - - - - - - - - - - | - - - *  p         q = p − eye,   depth z = q·forward
//!         \  near |             |                    perspective    x = w/2 + s (q·right)/z
//!           \     |             |                                   y = h/2 − s (q·up)/z
//!             ----> forward     |                    orthographic   the same without / z
//! ```
//!
//! x grows to the right and y down from the top left corner, in pixels, as in
//! [`Camera::ray`]; s is pixels per length unit (at depth 1 with perspective). What is linear
//! over a triangle in the picture is the *key*: z without and 1/z with perspective.

use glam::DVec3;

use super::error::RasterError;
use crate::geom::Rays;
use crate::{Camera, Projection};

/// A camera and the size of its picture: where points of space appear, and how deep.
///
/// Depth is the distance from the eye *along the view*, in length units: the distance from the
/// plane through the eye, and not the length of the ray.
///
/// ```
/// use glam::DVec3;
/// use rvachev::raster::RasterView;
/// use rvachev::Camera;
///
/// let camera = Camera::orthographic(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO, DVec3::Z, 4.0);
/// let view = RasterView::new(&camera, 100, 100)?;
/// let [x, y, depth] = view.project(DVec3::new(1.0, 0.0, 2.0));
/// assert_eq!([x, y, depth], [75.0, 0.0, 5.0]);
/// assert_eq!(view.point(x, y, depth), DVec3::new(1.0, 0.0, 2.0));
/// # Ok::<(), rvachev::raster::RasterError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RasterView {
    pub(super) camera: Camera,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) near: f64,
    pub(super) parallel: bool,
    /// Pixels per length unit; with perspective, at depth 1.
    scale: f64,
    axes: [DVec3; 3],
    rays: Rays,
    /// Binary digits of a pixel that coordinates are rounded to.
    pub(super) fraction: u32,
    /// Coordinates in the picture are held within this many pixels of its corner.
    pub(super) guard: f64,
}

/// The largest side of a picture, in pixels.
const LARGEST: u32 = 16384;

/// Unless told otherwise, what is nearer than this part of the distance from the eye to its
/// target is not seen.
const NEAR: f64 = 1e-3;

/// Edge functions are sums of two products of differences of coordinates, and must be exact in
/// f64: coordinates have a sign and at most this many binary digits.
const DIGITS: u32 = 25;

/// Coordinates and scales are of a size within this and its inverse, so that products of a few
/// of them are finite.
const HUGE: f64 = 1e60;

impl RasterView {
    /// The view of a camera in a picture of `width` × `height` pixels, each 1 to 16384.
    ///
    /// What is nearer than the near plane is not seen. With perspective it lies at a thousandth
    /// of the distance from the eye to the target, without at the eye;
    /// [`with_near`](RasterView::with_near) moves it.
    ///
    /// # Errors
    ///
    /// [`RasterError::Camera`] or [`RasterError::Setting`].
    pub fn new(camera: &Camera, width: u32, height: u32) -> Result<RasterView, RasterError> {
        camera.check()?;
        let error = |setting, value: &dyn std::fmt::Display, allowed| {
            Err(RasterError::Setting { setting, value: value.to_string(), allowed })
        };
        for (name, side) in [("width", width), ("height", height)] {
            if !(1..=LARGEST).contains(&side) {
                return error(name, &side, "1 to 16384 pixels");
            }
        }
        for (name, v) in [("eye", camera.eye), ("target", camera.target)] {
            if v.abs().max_element() > HUGE {
                return error(name, &v, "coordinates up to 1e60");
            }
        }
        let (scale, parallel) = match camera.projection {
            Projection::Perspective { fov } => (f64::from(height) / (2.0 * (fov.radians() / 2.0).tan()), false),
            Projection::Orthographic { height: length } => (f64::from(height) / length, true),
        };
        if !(1.0 / HUGE..=HUGE).contains(&scale) {
            return error("pixels per length unit", &scale, "1e-60 to 1e60");
        }
        // Twice the picture on every side leaves most triangles that reach out of it whole.
        let reach = 2 + width.max(height).next_power_of_two().ilog2();
        let fraction = (DIGITS - reach).min(16);
        Ok(RasterView {
            camera: *camera,
            width,
            height,
            near: if parallel { 0.0 } else { NEAR * camera.eye.distance(camera.target) },
            parallel,
            scale,
            axes: camera.axes(),
            rays: camera.rays(width, height),
            fraction,
            guard: f64::from(1 << reach) - 1.0,
        })
    }

    /// The same view with the near plane at this depth, in length units: above 0 with
    /// perspective; any, also behind the eye, without.
    ///
    /// # Errors
    ///
    /// [`RasterError::Setting`].
    pub fn with_near(self, near: f64) -> Result<RasterView, RasterError> {
        let (least, allowed) = match self.parallel {
            true => (-HUGE, "-1e60 to 1e60 without perspective"),
            false => (1.0 / HUGE, "1e-60 to 1e60 with perspective"),
        };
        if !(least..=HUGE).contains(&near) {
            return Err(RasterError::Setting { setting: "near", value: near.to_string(), allowed });
        }
        Ok(RasterView { near, ..self })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The depth of the near plane, in length units.
    #[must_use]
    pub fn near(&self) -> f64 {
        self.near
    }

    /// Where a point appears: x to the right and y down in pixels, and its depth in length
    /// units. With perspective, x and y have a meaning where the depth is above 0 only.
    #[must_use]
    pub fn project(&self, p: DVec3) -> [f64; 3] {
        self.picture(self.relative(p))
    }

    /// The point at pixel coordinates (x, y) with a depth in length units.
    #[must_use]
    pub fn point(&self, x: f64, y: f64, depth: f64) -> DVec3 {
        let [right, up, forward] = self.axes;
        let unit = if self.parallel { 1.0 / self.scale } else { depth / self.scale };
        let across = (x - 0.5 * f64::from(self.width)) * unit;
        let above = (0.5 * f64::from(self.height) - y) * unit;
        self.camera.eye + across * right + above * up + depth * forward
    }

    /// The points of a row, at pixel coordinate y, by x and depth.
    #[inline]
    pub(super) fn points(&self, y: f64) -> impl Fn(f64, f64) -> DVec3 + use<> {
        let [right, up, forward] = self.axes;
        let (unit, half) = (1.0 / self.scale, 0.5 * f64::from(self.width));
        let (right, above) = (unit * right, (0.5 * f64::from(self.height) - y) * unit * up);
        let (eye, parallel) = (self.camera.eye, self.parallel);
        move |x, depth| {
            let across = (x - half) * right + above;
            if parallel { eye + across + depth * forward } else { eye + depth * (across + forward) }
        }
    }

    /// The length along the ray through pixel coordinates (x, y) to a depth, both in length
    /// units.
    #[must_use]
    pub fn distance(&self, x: f64, y: f64, depth: f64) -> f64 {
        if self.parallel { depth } else { self.point(x, y, depth).distance(self.camera.eye) }
    }

    /// The point at pixel coordinates with a depth, how far along its ray it is, and the unit
    /// vector along that.
    #[inline]
    pub(crate) fn sight(&self, x: f64, y: f64, depth: f64) -> (DVec3, f64, DVec3) {
        let point = self.point(x, y, depth);
        if self.parallel {
            return (point, depth, self.axes[2]);
        }
        let way = point - self.camera.eye;
        let distance = way.length();
        (point, distance, way / distance)
    }

    /// The direction of the ray at pixel coordinates (x, y), of length 1.
    #[must_use]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.rays.ray(x, y).1
    }

    /// Right, up and forward: unit vectors at right angles.
    pub(super) fn axes(&self) -> [DVec3; 3] {
        self.axes
    }

    /// Coordinates along right, up and forward, from the eye.
    #[inline]
    pub(super) fn relative(&self, p: DVec3) -> DVec3 {
        let q = p - self.camera.eye;
        let [right, up, forward] = self.axes;
        DVec3::new(q.dot(right), q.dot(up), q.dot(forward))
    }

    /// Pixel coordinates and depth of a point that is relative to the eye.
    #[inline]
    pub(super) fn picture(&self, q: DVec3) -> [f64; 3] {
        let s = if self.parallel { self.scale } else { self.scale / q.z };
        [0.5 * f64::from(self.width) + s * q.x, 0.5 * f64::from(self.height) - s * q.y, q.z]
    }

    /// The value that is above 0 on the inner side of a bound of what can be drawn: the near
    /// plane, and four planes far out of the picture.
    #[inline]
    pub(super) fn clearance(&self, bound: usize, q: DVec3) -> f64 {
        let weight = if self.parallel { 1.0 } else { q.z };
        let (half_width, half_height) = (0.5 * f64::from(self.width), 0.5 * f64::from(self.height));
        match bound {
            0 => q.z - self.near,
            1 => self.scale * q.x + (self.guard + half_width) * weight,
            2 => (self.guard - half_width) * weight - self.scale * q.x,
            3 => self.scale * q.y + (self.guard - half_height) * weight,
            _ => (self.guard + half_height) * weight - self.scale * q.y,
        }
    }

    /// The number of [clearances](RasterView::clearance).
    pub(super) const BOUNDS: usize = 5;

    /// What is linear over the picture of a triangle.
    #[inline]
    pub(super) fn key(&self, depth: f64) -> f64 {
        if self.parallel { depth } else { 1.0 / depth }
    }
}
