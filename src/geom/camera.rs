//! Where a picture is taken from.
//!
//! ```text
//!        up                       perspective: rays leave the eye, and the height of the
//!         |    target             view is an angle, the field of view
//!   eye   |   .*
//!     *---+--'                    orthographic: rays are parallel, and the height of the
//!      `-- right                  view is a length
//! ```
//!
//! The world has +z up. The default view of [`Camera::framing`] is a three-quarter view: the
//! eye is in front of the box (towards −y), to its right (+x) and above it (+z).

use glam::DVec3;

use super::unit;
use crate::Bounds;
use crate::{Angle, deg, rad};
use rvachev_field::check::SMALLEST_LENGTH;

/// A camera: an eye, what it looks at, and how it projects.
///
/// Plain data: any values can be written, and [`Camera::check`] says what is wrong with them.
///
/// ```
/// use glam::DVec3;
/// use rvachev::{Bounds, Camera};
///
/// let camera = Camera::framing(&Bounds::from_center(DVec3::ZERO, DVec3::ONE));
/// camera.check()?;
/// // The middle of the picture looks at the middle of the box.
/// let (origin, direction) = camera.ray(320.0, 240.0, 640, 480);
/// assert!(origin.cross(direction).length() < 1e-12);
/// # Ok::<(), rvachev::error::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Camera {
    /// The position of the eye, in length units.
    pub eye: DVec3,
    /// The point that appears in the middle of the picture; must not be the eye.
    pub target: DVec3,
    /// The direction that points up in the picture. Of any length but 0, and not along the
    /// view; it need not be at a right angle to it.
    pub up: DVec3,
    /// How points are projected.
    pub projection: Projection,
}

/// How a camera projects, and how much it takes in from bottom to top.
///
/// How much it takes in from left to right follows from the picture's aspect ratio: pixels
/// are square.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Projection {
    /// Rays meet in the eye.
    Perspective {
        /// Angle from the bottom to the top of the picture, at least 10⁻⁹ radians and below 180
        /// degrees.
        fov: Angle,
    },
    /// Rays are parallel to the view, and start in the plane through the eye.
    Orthographic {
        /// Length from the bottom to the top of the picture, in length units, at least 10⁻⁹.
        height: f64,
    },
}

/// What is wrong with a camera.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("camera: {parameter} is {value}; {allowed}")]
#[non_exhaustive]
pub struct CameraError {
    /// The parameter.
    pub parameter: &'static str,
    /// Its value.
    pub value: String,
    /// What is allowed.
    pub allowed: &'static str,
}

/// The vertical field of view of [`Camera::framing`]: about that of a portrait lens, which keeps
/// parallel edges nearly parallel.
pub(super) const FRAMING_FOV: Angle = deg(30.0);

/// The direction from the box to the eye of the default view: 34° to the right of the front
/// and 29° above it, so that no face of a box is seen edge-on or hides another.
const FRAMING_DIRECTION: DVec3 = DVec3::new(2.0, -3.0, 2.0);

/// How much larger than the box the view is when it is fitted.
pub(super) const FRAMING_MARGIN: f64 = 1.06;

/// The narrowest field of view: focal lengths of pictures stay finite.
const NARROWEST: Angle = rad(1e-9);

impl Camera {
    /// A perspective camera; `fov` is the vertical field of view, at least 10⁻⁹ radians and below
    /// 180 degrees.
    #[must_use]
    pub fn perspective(
        eye: impl Into<DVec3>,
        target: impl Into<DVec3>,
        up: impl Into<DVec3>,
        fov: impl Into<Angle>,
    ) -> Camera {
        let projection = Projection::Perspective { fov: fov.into() };
        Camera { eye: eye.into(), target: target.into(), up: up.into(), projection }
    }

    /// An orthographic camera; `height` is what the picture spans from bottom to top, in
    /// length units, at least 10⁻⁹.
    #[must_use]
    pub fn orthographic(eye: impl Into<DVec3>, target: impl Into<DVec3>, up: impl Into<DVec3>, height: f64) -> Camera {
        Camera {
            eye: eye.into(),
            target: target.into(),
            up: up.into(),
            projection: Projection::Orthographic { height },
        }
    }

    /// The default view: a perspective three-quarter view from front, right and above that
    /// holds the whole box with a small margin, in any picture that is at least as wide as it
    /// is high. Follow with [`Camera::fitted`] for a narrower one.
    ///
    /// A box that is empty or unbounded is replaced by the cube of half-size 1.
    #[must_use]
    pub fn framing(bounds: &Bounds) -> Camera {
        let eye = FRAMING_DIRECTION;
        Camera::perspective(eye, DVec3::ZERO, DVec3::Z, FRAMING_FOV).fitted(bounds, 1.0)
    }

    /// The default view without perspective.
    #[must_use]
    pub fn framing_orthographic(bounds: &Bounds) -> Camera {
        let eye = FRAMING_DIRECTION;
        Camera::orthographic(eye, DVec3::ZERO, DVec3::Z, 1.0).fitted(bounds, 1.0)
    }

    /// The camera moved, not turned, so that it looks at the middle of the box and just holds
    /// all of it, with a small margin, in a picture whose width is `aspect` times its height:
    /// a perspective camera by its distance, an orthographic one by its height.
    ///
    /// A box that is empty or unbounded is replaced by the cube of half-size 1. A camera that
    /// does not pass [`Camera::check`] is returned as it is.
    #[must_use]
    pub fn fitted(mut self, bounds: &Bounds, aspect: f64) -> Camera {
        if self.check().is_err() || !(aspect > 0.0 && aspect.is_finite()) {
            return self;
        }
        let mut bounds = *bounds;
        if bounds.is_empty() || !bounds.is_finite() {
            bounds = Bounds::from_center(DVec3::ZERO, DVec3::ONE);
        }
        let center = bounds.center();
        let radius = bounds.half_extents().length();
        // A point still needs a view of some size: one in proportion to its coordinates.
        let radius = if radius > 0.0 { radius } else { center.abs().max_element().max(1.0) };
        let [right, up, forward] = self.axes();
        let seen = bounds.corners().map(|p| {
            let p = p - center;
            DVec3::new(p.dot(right).abs() / aspect, p.dot(up).abs(), p.dot(forward))
        });
        let distance = match &mut self.projection {
            Projection::Perspective { fov } => {
                // A corner at depth z is in view if |y| ≤ (distance + z)·slope.
                let slope = (fov.radians() / 2.0).tan() / FRAMING_MARGIN;
                let needed = seen.map(|p| p.x.max(p.y) / slope - p.z);
                needed.into_iter().fold(0.01 * radius, f64::max)
            }
            Projection::Orthographic { height } => {
                let half = seen.map(|p| p.x.max(p.y));
                *height = 2.0 * FRAMING_MARGIN * half.into_iter().fold(0.01 * radius, f64::max);
                2.0 * radius
            }
        };
        self.target = center;
        self.eye = center - forward * distance;
        self
    }

    /// The ray through a point of a picture of `width` × `height` pixels: its origin, and its
    /// direction of length 1. `x` grows to the right and `y` down from the top left corner of
    /// the picture, in pixels, so that the middle of the first pixel is (0.5, 0.5).
    ///
    /// NaN for a camera that does not pass [`Camera::check`]. For many rays of one picture,
    /// take [`Camera::rays`].
    #[must_use]
    pub fn ray(&self, x: f64, y: f64, width: u32, height: u32) -> (DVec3, DVec3) {
        self.rays(width, height).ray(x, y)
    }

    /// The rays of a picture of `width` × `height` pixels.
    #[must_use]
    pub fn rays(&self, width: u32, height: u32) -> Rays {
        let (width, height) = (f64::from(width), f64::from(height));
        let [right, up, forward] = self.axes();
        let (half_height, parallel) = match self.projection {
            Projection::Perspective { fov } => ((fov.radians() / 2.0).tan(), false),
            Projection::Orthographic { height } => (height / 2.0, true),
        };
        let pixel = 2.0 * half_height / height;
        let across = right * pixel;
        let down = -up * pixel;
        Rays { eye: self.eye, forward, corner: -0.5 * (across * width + down * height), across, down, parallel }
    }

    /// Right, up and forward: unit vectors at right angles; NaN where they are not defined.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        let forward = unit(self.target - self.eye);
        let right = unit(forward.cross(unit(self.up)));
        [right, right.cross(forward), forward]
    }

    /// Whether the camera can take a picture.
    ///
    /// # Errors
    ///
    /// [`CameraError`] names the parameter, its value and what is allowed: points and vectors must
    /// be finite, the eye must not be the target, `up` must be neither 0 nor along the view, the
    /// field of view must be at least 10⁻⁹ radians and below 180 degrees, the height of the view
    /// finite and at least 10⁻⁹.
    pub fn check(&self) -> Result<(), CameraError> {
        let error = |parameter, value: &dyn std::fmt::Display, allowed| {
            Err(CameraError { parameter, value: value.to_string(), allowed })
        };
        for (name, v) in [("eye", self.eye), ("target", self.target), ("up", self.up)] {
            if !v.is_finite() {
                return error(name, &v, "every component must be finite");
            }
        }
        let [right, _, forward] = self.axes();
        if !forward.is_finite() {
            return error("target", &self.target, "it must differ from the eye");
        }
        if !unit(self.up).is_finite() {
            return error("up", &self.up, "it must not be zero");
        }
        // Nearer to the view than this, rounding decides where up is.
        let sine = forward.cross(unit(self.up)).length();
        if !right.is_finite() || sine < 1e-9 {
            return error("up", &self.up, "it must not be parallel to the view");
        }
        match self.projection {
            Projection::Perspective { fov } if !(fov >= NARROWEST && fov < Angle::HALF_TURN) => {
                error("field of view", &fov, "it must be at least 1e-9 radians and below 180°")
            }
            Projection::Orthographic { height } if !(height >= SMALLEST_LENGTH && height.is_finite()) => {
                error("height of the view", &height, "it must be finite and at least 1e-9")
            }
            _ => Ok(()),
        }
    }
}

/// The rays of one picture, with all that they share computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    eye: DVec3,
    forward: DVec3,
    /// From the middle of the picture to its top left corner.
    corner: DVec3,
    /// One pixel to the right.
    across: DVec3,
    /// One pixel down.
    down: DVec3,
    parallel: bool,
}

impl Rays {
    /// The ray at pixel coordinates (x, y): its origin, and its direction of length 1. See
    /// [`Camera::ray`].
    #[must_use]
    #[inline(always)]
    pub fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let offset = self.corner + self.across * x + self.down * y;
        if self.parallel { (self.eye + offset, self.forward) } else { (self.eye, (self.forward + offset).normalize()) }
    }

    /// The least and the greatest pixel coordinates, across and down, at which points of a box may
    /// appear; `None` if rays meet in an eye that all of it is beside or behind.
    pub(crate) fn outline(&self, bounds: &Bounds) -> Option<[[f64; 2]; 2]> {
        if self.parallel {
            let (middle, half) = (bounds.center() - self.eye - self.corner, bounds.half_extents());
            let along = |axis: DVec3| {
                let axis = axis / axis.length_squared();
                let (at, reach) = (middle.dot(axis), half.dot(axis.abs()));
                [at - reach, at + reach]
            };
            return Some([along(self.across), along(self.down)]);
        }
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let axes = [self.across, self.down].map(|axis| axis / axis.length_squared());
        let seen = bounds.corners().map(|corner| corner - self.eye);
        // Nearer to the eye's plane than this, rounding decides on which side it is.
        let depth = |seen: DVec3| seen.dot(self.forward);
        let in_front = |seen: DVec3| depth(seen) > 1e-9 * seen.length();
        for (number, &corner) in seen.iter().enumerate() {
            if in_front(corner) {
                let offset = corner / depth(corner) - self.corner;
                for axis in 0..2 {
                    let at = offset.dot(axes[axis]);
                    low[axis] = low[axis].min(at);
                    high[axis] = high[axis].max(at);
                }
                continue;
            }
            // Where its edges cross the eye's plane, the box goes on to infinity.
            for other in [1, 2, 4].map(|bit| seen[number ^ bit]).into_iter().filter(|&other| in_front(other)) {
                let (near, far) = (depth(corner), depth(other));
                let crossing = corner + (other - corner) * (near / (near - far)).clamp(0.0, 1.0);
                let rounding = 1e-6 * (corner.length() + other.length());
                for axis in 0..2 {
                    let side = crossing.dot(axes[axis]) / axes[axis].length();
                    low[axis] = if side < rounding { f64::NEG_INFINITY } else { low[axis] };
                    high[axis] = if side > -rounding { f64::INFINITY } else { high[axis] };
                }
            }
        }
        (low[0] <= high[0]).then(|| [0, 1].map(|axis| [low[axis], high[axis]]))
    }

    /// Where the rays of a perspective camera meet.
    pub(crate) fn meeting_point(&self) -> Option<DVec3> {
        (!self.parallel).then_some(self.eye)
    }

    /// The direction of the view.
    pub(crate) fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Where the rays of an orthographic camera start: at pixel coordinates (0, 0), and what to add
    /// for a pixel to the right and for one down.
    pub(crate) fn starts(&self) -> Option<[DVec3; 3]> {
        self.parallel.then(|| [self.eye + self.corner, self.across, self.down])
    }

    /// What a pixel spans at distance `t` along a ray near the middle, in length units.
    #[must_use]
    #[inline]
    pub fn pixel_size(&self, t: f64) -> f64 {
        let pixel = self.across.length();
        if self.parallel { pixel } else { pixel * t }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a point appears in a picture, by the inverse of the ray's construction.
    fn project(camera: &Camera, p: DVec3, width: f64, height: f64) -> (f64, f64) {
        let [right, up, forward] = camera.axes();
        let q = p - camera.eye;
        let half = match camera.projection {
            Projection::Perspective { fov } => (fov.radians() / 2.0).tan() * q.dot(forward),
            Projection::Orthographic { height } => height / 2.0,
        };
        let scale = height / (2.0 * half);
        (width / 2.0 + q.dot(right) * scale, height / 2.0 - q.dot(up) * scale)
    }

    #[test]
    fn rays_pass_through_what_they_show() {
        let eye = DVec3::new(3.0, -4.0, 5.0);
        for camera in [
            Camera::perspective(eye, DVec3::ONE, DVec3::Z, deg(50.0)),
            Camera::orthographic(eye, DVec3::ONE, DVec3::Z, 7.0),
        ] {
            for p in [DVec3::ZERO, DVec3::new(0.5, 1.0, -2.0)] {
                let (x, y) = project(&camera, p, 640.0, 480.0);
                let (o, d) = camera.ray(x, y, 640, 480);
                assert!((d.length() - 1.0).abs() < 1e-14);
                assert!((p - o).cross(d).length() < 1e-12);
                assert!((p - o).dot(d) > 0.0);
            }
        }
    }

    #[test]
    fn boxes_appear_where_their_points_do() {
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(13).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 4.0 - 2.0;
        let (mut nowhere, mut partly) = (0, 0);
        for n in 0..2000 {
            let (eye, target) = (vector(4 * n), vector(4 * n + 1));
            let cameras = [
                Camera::perspective(eye, target, DVec3::Z, deg(70.0)),
                Camera::orthographic(eye, target, DVec3::Z, 3.0),
            ];
            for camera in cameras {
                let rays = camera.rays(64, 48);
                let bounds = Bounds::from_center(vector(4 * n + 2), vector(4 * n + 3).abs());
                let outline = rays.outline(&bounds);
                nowhere += usize::from(outline.is_none());
                partly +=
                    usize::from(outline.is_some_and(|[across, _]| across[0].is_infinite() != across[1].is_infinite()));
                for m in 0..20 {
                    let p = bounds.min + bounds.size() * (vector(m + 20 * n) + 2.0) / 4.0;
                    if rays.meeting_point().is_none() || (p - eye).dot(rays.forward()) > 1e-6 {
                        let (x, y) = project(&camera, p, 64.0, 48.0);
                        let [across, down] = outline.expect("a point of it is in front");
                        assert!(across[0] - 1e-6 < x && x < across[1] + 1e-6, "{x} {across:?}");
                        assert!(down[0] - 1e-6 < y && y < down[1] + 1e-6, "{y} {down:?}");
                    }
                }
                // Corners are where the outline ends.
                if let Some([across, _]) =
                    outline.filter(|outline| outline.as_flattened().iter().all(|v| v.is_finite()))
                {
                    let least = bounds
                        .corners()
                        .map(|p| project(&camera, p, 64.0, 48.0).0)
                        .into_iter()
                        .fold(f64::INFINITY, f64::min);
                    assert!((across[0] - least).abs() < 1e-6 * (1.0 + least.abs()));
                }
            }
        }
        assert!(nowhere > 20 && partly > 100, "{nowhere} {partly}");
    }

    #[test]
    fn picture_axes() {
        let camera = Camera::framing(&Bounds::from_center(DVec3::ZERO, DVec3::ONE));
        let at = |p: DVec3| project(&camera, p, 100.0, 100.0);
        assert!(at(DVec3::Z).1 < at(DVec3::ZERO).1, "z is up");
        assert!(at(DVec3::X).0 > at(DVec3::ZERO).0, "x is to the right");
        assert!(camera.eye.x > 0.0 && camera.eye.y < 0.0 && camera.eye.z > 0.0);
        let (_, left) = camera.ray(0.5, 50.0, 100, 100);
        let (_, right) = camera.ray(99.5, 50.0, 100, 100);
        assert!(left.x < right.x);
        // The angle between the middles of the top and bottom edges is the field of view.
        let (_, top) = camera.ray(50.0, 0.0, 100, 100);
        let (_, bottom) = camera.ray(50.0, 100.0, 100, 100);
        assert!((top.angle_between(bottom) - FRAMING_FOV.radians()).abs() < 1e-9);
    }

    #[test]
    fn framing_holds_the_box_tightly() {
        let flat = Bounds::new(DVec3::new(-5.0, 2.0, 100.0), DVec3::new(25.0, 2.5, 101.0));
        let cube = Bounds::from_center(DVec3::splat(1e-3), DVec3::splat(1e-4));
        for bounds in [flat, cube] {
            for base in [Camera::framing(&bounds), Camera::framing_orthographic(&bounds)] {
                for aspect in [0.25, 1.0, 3.0] {
                    let camera = base.fitted(&bounds, aspect);
                    camera.check().unwrap();
                    let mut fill: f64 = 0.0;
                    for p in bounds.corners() {
                        let (x, y) = project(&camera, p, aspect, 1.0);
                        fill = fill.max((x / aspect - 0.5).abs()).max((y - 0.5).abs());
                    }
                    assert!(fill < 0.48 && fill > 0.46, "{aspect}: {fill}");
                }
            }
        }
    }

    #[test]
    fn framing_of_odd_boxes() {
        let point = Bounds::new(DVec3::splat(7.0), DVec3::splat(7.0));
        for bounds in [Bounds::EMPTY, Bounds::ALL, point] {
            Camera::framing(&bounds).check().unwrap();
            Camera::framing_orthographic(&bounds).check().unwrap();
        }
    }

    #[test]
    fn errors_name_the_parameter() {
        let good = Camera::perspective(DVec3::ONE, DVec3::ZERO, DVec3::Z, deg(40.0));
        good.check().unwrap();
        let parameter = |camera: Camera| camera.check().unwrap_err().parameter;
        let nan = DVec3::new(0.0, f64::NAN, 0.0);
        assert_eq!(parameter(Camera { eye: nan, ..good }), "eye");
        let same = DVec3::ONE;
        assert_eq!(parameter(Camera { target: same, ..good }), "target");
        let up = DVec3::ZERO;
        assert_eq!(parameter(Camera { up, ..good }), "up");
        let up = DVec3::splat(-3.0);
        assert_eq!(parameter(Camera { up, ..good }), "up");
        for fov in [0.0, 5e-324, 1e-8, 180.0, -1.0, f64::NAN, f64::INFINITY].map(deg) {
            let projection = Projection::Perspective { fov };
            assert_eq!(parameter(Camera { projection, ..good }), "field of view");
        }
        for height in [0.0, 5e-324, 1e-10, f64::NAN, f64::INFINITY] {
            let projection = Projection::Orthographic { height };
            let camera = Camera { projection, ..good };
            assert_eq!(parameter(camera), "height of the view");
        }
        let bad = Camera { projection: Projection::Perspective { fov: deg(200.0) }, ..good };
        assert_eq!(
            bad.check().unwrap_err().to_string(),
            "camera: field of view is 200°; it must be at least 1e-9 radians and below 180°"
        );
    }
}
