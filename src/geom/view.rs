//! Cameras by name and by motion, and their geometry as numbers.
//!
//! ```text
//!            z │  elevation            camera coordinates, those of computer vision:
//!              │ ╱ eye
//!              │╱                          *──→ x right
//!              *───────                   ╱│
//!             ╱  azimuth            z into ↓ y down
//!            ╱    (anticlockwise)
//! ```
//!
//! [`Camera::pose`] takes camera coordinates to the world; [`Intrinsics`] take them to pixels.
//!
//! Source: R. Hartley, A. Zisserman, *Multiple View Geometry in Computer Vision* (2004), 6.1,
//! for the matrix of the pinhole camera.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::camera::{Camera, FRAMING_FOV, FRAMING_MARGIN, Projection};
use crate::{Angle, Bounds, deg};

/// From where a solid is looked at. The world has +z up, and its front is towards −y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum View {
    /// From the front, right and above: no face of a box is seen edge-on or hides another.
    #[default]
    ThreeQuarter,
    /// From −y.
    Front,
    /// From +y.
    Back,
    /// From −x.
    Left,
    /// From +x.
    Right,
    /// From +z, with +y up in the picture.
    Top,
    /// From −z, with −y up in the picture.
    Bottom,
}

impl View {
    /// Every view.
    pub const ALL: [View; 7] =
        [View::ThreeQuarter, View::Front, View::Back, View::Left, View::Right, View::Top, View::Bottom];

    /// The direction from the solid to the eye, of length 1.
    #[must_use]
    pub fn direction(self) -> DVec3 {
        match self {
            View::ThreeQuarter => DVec3::new(2.0, -3.0, 2.0).normalize(),
            View::Front => -DVec3::Y,
            View::Back => DVec3::Y,
            View::Left => -DVec3::X,
            View::Right => DVec3::X,
            View::Top => DVec3::Z,
            View::Bottom => -DVec3::Z,
        }
    }

    /// The direction that points up in the picture.
    #[must_use]
    pub fn up(self) -> DVec3 {
        match self {
            View::Top => DVec3::Y,
            View::Bottom => -DVec3::Y,
            _ => DVec3::Z,
        }
    }
}

/// Camera coordinates to pixels: what calibration gives for a real camera.
///
/// A point (x, y, z) of camera coordinates (x right, y down, z along the view) appears at
/// (fx·x/z + cx, fy·y/z + cy), in pixels from the top left corner of the picture; for parallel
/// rays at (fx·x + cx, fy·y + cy).
///
/// ```
/// use glam::DVec3;
/// use rvachev::Camera;
///
/// let camera = Camera::look_at([0.0, -5.0, 0.0], [0.0, 0.0, 0.0]);
/// let lens = camera.intrinsics(640, 480);
/// // From the world to the camera, and to the picture.
/// let p = camera.pose().inverse().transform_point3(DVec3::new(0.0, 1.0, 0.5));
/// let pixel = lens.project(p).expect("it is in front of the camera");
/// assert!((pixel.x - 320.0).abs() < 1e-9 && pixel.y < 240.0);
/// assert!(lens.unproject(pixel, p.z).distance(p) < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Intrinsics {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Focal length in widths of a pixel; for parallel rays, pixels to a length unit.
    pub fx: f64,
    /// Focal length in heights of a pixel; for parallel rays, pixels to a length unit.
    pub fy: f64,
    /// Column of the principal point.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
    /// Whether rays are parallel.
    pub parallel: bool,
}

impl Intrinsics {
    /// The calibration matrix K, with the focal lengths and the principal point.
    #[must_use]
    pub fn matrix(&self) -> DMat3 {
        DMat3::from_cols(DVec3::X * self.fx, DVec3::Y * self.fy, DVec3::new(self.cx, self.cy, 1.0))
    }

    /// Where a point of camera coordinates appears; `None` beside or behind a perspective camera.
    #[must_use]
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        let depth = if self.parallel { 1.0 } else { p.z };
        (depth > 0.0).then(|| DVec2::new(self.fx * p.x / depth + self.cx, self.fy * p.y / depth + self.cy))
    }

    /// The point, in camera coordinates, that appears at a pixel and is `depth` away along the
    /// axis of the view.
    #[must_use]
    pub fn unproject(&self, pixel: impl Into<DVec2>, depth: f64) -> DVec3 {
        let pixel = pixel.into();
        let scale = if self.parallel { 1.0 } else { depth };
        DVec3::new((pixel.x - self.cx) / self.fx * scale, (pixel.y - self.cy) / self.fy * scale, depth)
    }
}

impl Camera {
    /// A perspective camera with the lens of [`Camera::framing`] and z up; with y up if it looks
    /// along z.
    #[must_use]
    pub fn look_at(eye: impl Into<DVec3>, target: impl Into<DVec3>) -> Camera {
        let (eye, target) = (eye.into(), target.into());
        let across = (target - eye).truncate().length();
        let up = if across <= 1e-9 * (target - eye).length() { DVec3::Y } else { DVec3::Z };
        Camera::perspective(eye, target, up, FRAMING_FOV)
    }

    /// A perspective camera that holds the whole box with a small margin, from the given side,
    /// in any picture that is at least as wide as it is high. [`Camera::parallel`] makes it an
    /// engineering view, [`Camera::fitted`] fits it to another aspect ratio, and
    /// [`Scene::framing`](crate::Scene::framing) to the solid in place of its box.
    ///
    /// ```
    /// use rvachev::{Bounds, Camera, View};
    /// use glam::DVec3;
    ///
    /// let bounds = Bounds::from_center(DVec3::ZERO, DVec3::ONE);
    /// let front = Camera::framing_view(&bounds, View::Front).parallel();
    /// let (_, direction) = front.ray(0.0, 0.0, 10, 10);
    /// assert_eq!(direction, DVec3::Y);
    /// ```
    #[must_use]
    pub fn framing_view(bounds: &Bounds, view: View) -> Camera {
        Camera::perspective(view.direction(), DVec3::ZERO, view.up(), FRAMING_FOV).fitted(bounds, 1.0)
    }

    /// The same view without perspective: what is as far away as the target keeps its size.
    #[must_use]
    pub fn parallel(mut self) -> Camera {
        if let Projection::Perspective { fov } = self.projection {
            let height = 2.0 * self.eye.distance(self.target) * (fov.radians() / 2.0).tan();
            self.projection = Projection::Orthographic { height };
        }
        self
    }

    /// The camera moved about its target: by `azimuth` about `up`, anticlockwise seen from
    /// above, and by `elevation` towards `up`, but no nearer to it than 0.1°.
    ///
    /// A camera that does not pass [`Camera::check`], and an angle that is not finite, leave it
    /// where it is.
    ///
    /// ```
    /// use rvachev::{deg, Camera};
    /// use glam::DVec3;
    ///
    /// let camera = Camera::look_at([0.0, -4.0, 0.0], [0.0, 0.0, 0.0]);
    /// assert!(camera.orbit(deg(90.0), deg(0.0)).eye.distance(DVec3::X * 4.0) < 1e-12);
    /// assert!(camera.orbit(deg(0.0), deg(30.0)).eye.distance(DVec3::new(0.0, -12f64.sqrt(), 2.0)) < 1e-12);
    /// ```
    #[must_use]
    pub fn orbit(mut self, azimuth: impl Into<Angle>, elevation: impl Into<Angle>) -> Camera {
        let (azimuth, elevation) = (azimuth.into(), elevation.into());
        if self.check().is_err() || !azimuth.is_finite() || !elevation.is_finite() {
            return self;
        }
        let [right, ..] = self.axes();
        let up = self.up / self.up.abs().max_element();
        let up = up.normalize();
        // Level, and towards the eye.
        let level = right.cross(up);
        let distance = self.eye.distance(self.target);
        let risen = ((self.eye - self.target) / distance).dot(up).clamp(-1.0, 1.0).asin();
        let elevation = (risen + elevation.radians()).clamp(-STEEPEST.radians(), STEEPEST.radians());
        let (sin, cos) = azimuth.sin_cos();
        let level = cos * level + sin * right;
        self.eye = self.target + distance * (elevation.cos() * level + elevation.sin() * up);
        self
    }

    /// The camera moved, not turned, so that it just holds every point, with a small margin, in
    /// a picture whose width is `aspect` times its height; what is free is centred.
    ///
    /// A camera that does not pass [`Camera::check`], and no points at all, leave it as it is.
    #[must_use]
    pub fn fitted_to(mut self, points: &[DVec3], aspect: f64) -> Camera {
        let points = || points.iter().filter(|p| p.is_finite());
        let count = points().count();
        if self.check().is_err() || !(aspect > 0.0 && aspect.is_finite()) || count == 0 {
            return self;
        }
        let [right, up, forward] = self.axes();
        let middle = points().sum::<DVec3>() / count as f64;
        let seen = |p: &DVec3| DVec3::new((p - middle).dot(right), (p - middle).dot(up), (p - middle).dot(forward));
        let radius = points().map(|p| p.distance(middle)).fold(0.0, f64::max);
        // A point still needs a view of some size: one in proportion to its coordinates.
        let radius = if radius > 0.0 { radius } else { middle.abs().max_element().max(1.0) };
        let most = |f: &dyn Fn(DVec3) -> f64| points().map(|p| f(seen(p))).fold(f64::NEG_INFINITY, f64::max);
        let eye = match &mut self.projection {
            Projection::Perspective { fov } => {
                // A point is within the picture's sides if |x − eye.x| ≤ (z − eye.z)·slope: the
                // extreme points of each pair of sides tell how far back the eye must be, and
                // how far to the side.
                let slope = (fov.radians() / 2.0).tan() / FRAMING_MARGIN;
                let across = slope * aspect;
                let (a, b) = (most(&|p| p.x - across * p.z), most(&|p| -p.x - across * p.z));
                let (c, d) = (most(&|p| p.y - slope * p.z), most(&|p| -p.y - slope * p.z));
                let nearest = most(&|p| -p.z);
                let back = ((a + b) / (2.0 * across)).max((c + d) / (2.0 * slope)).max(nearest + 0.01 * radius);
                DVec3::new((a - b) / 2.0, (c - d) / 2.0, -back)
            }
            Projection::Orthographic { height } => {
                let (a, b) = (most(&|p| p.x), most(&|p| -p.x));
                let (c, d) = (most(&|p| p.y), most(&|p| -p.y));
                *height = FRAMING_MARGIN * ((a + b) / aspect).max(c + d).max(0.01 * radius);
                DVec3::new((a - b) / 2.0, (c - d) / 2.0, -2.0 * radius)
            }
        };
        self.eye = middle + eye.x * right + eye.y * up + eye.z * forward;
        self.target = self.eye + (-eye.z) * forward;
        self
    }

    /// Camera coordinates (x right, y down, z along the view) to the world.
    #[must_use]
    pub fn pose(&self) -> DAffine3 {
        let [right, up, forward] = self.axes();
        DAffine3::from_mat3_translation(DMat3::from_cols(right, -up, forward), self.eye)
    }

    /// Camera coordinates to the pixels of a picture of `width` × `height`.
    #[must_use]
    pub fn intrinsics(&self, width: u32, height: u32) -> Intrinsics {
        let (w, h) = (f64::from(width), f64::from(height));
        let (f, parallel) = match self.projection {
            Projection::Perspective { fov } => (h / (2.0 * (fov.radians() / 2.0).tan()), false),
            Projection::Orthographic { height } => (h / height, true),
        };
        Intrinsics { width, height, fx: f, fy: f, cx: w / 2.0, cy: h / 2.0, parallel }
    }
}

/// An orbit rises no higher than this.
const STEEPEST: Angle = deg(89.9);
