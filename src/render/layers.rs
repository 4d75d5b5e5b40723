//! What each pixel sees, as numbers: the layers of a picture.
//!
//! ```text
//!    eye *---------.  depth along the axis
//!         \  ray    :
//!          \________*)  depth along the ray, position, normal, leaf; mask: whether there is one
//! ```

use glam::{DVec3, Vec3};

use super::gbuffer::{GBuffer, Surface, Window};
use super::scene::Scene;
use super::settings::{RenderError, check_memory, check_size};
use crate::{Camera, Cancelled, Image, RangeImage, Rays, Run, Solid, View};

/// What the pixels of a picture see, through their middles.
///
/// ```
/// use rvachev::{Camera, Solid, View};
///
/// let ball = Solid::sphere(1.0);
/// let camera = Camera::framing_view(&ball.bounds()?, View::Front);
/// let layers = ball.layers(&camera, 65, 65)?;
/// let depth = layers.depth();
/// // The middle of the ball is nearest.
/// let nearest = depth.pixel(32, 32).expect("within the picture");
/// assert!((nearest - (camera.eye.length() - 1.0)).abs() < 1e-5);
/// assert_eq!(depth.pixel(0, 0), Some(f64::INFINITY));
/// assert_eq!(layers.mask().pixel(32, 32), Some(true));
/// assert_eq!(layers.owner().pixel(32, 32), Some(Some(0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Layers {
    camera: Camera,
    rays: Rays,
    seen: GBuffer,
}

impl Solid {
    /// What the pixels of a picture of `width` × `height` see.
    ///
    /// # Errors
    /// What is wrong with the solid, the camera or the size: see [`RenderError`].
    pub fn layers(&self, camera: &Camera, width: u32, height: u32) -> Result<Layers, RenderError> {
        self.scene()?.layers(camera, width, height, &Run::default())
    }
}

impl Scene {
    /// What the pixels of a picture of `width` × `height` see.
    ///
    /// # Errors
    /// What is wrong with the camera or the size, or that the work was cancelled.
    pub fn layers(&self, camera: &Camera, width: u32, height: u32, run: &Run) -> Result<Layers, RenderError> {
        check_size(width, height)?;
        check_memory(width, height)?;
        camera.check()?;
        let rays = camera.rays(width, height);
        let seen = self.surfaces_with(&rays, Window::whole(width, height), run)?;
        Ok(Layers { camera: *camera, rays, seen })
    }

    /// A perspective camera that just holds the solid itself, with a small margin, in a picture
    /// whose width is `aspect` times its height: closer than [`Camera::framing`], which must hold
    /// the corners of a box. Of the solid it is known that it lies in small boxes; those are held.
    #[must_use]
    pub fn framing(&self, view: View, aspect: f64) -> Camera {
        Camera::framing_view(&self.bounds(), view).fitted_to(&self.hull(), aspect)
    }
}

impl Layers {
    /// The camera that sees it.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// An image of what `f` makes of each pixel: its ray and what it meets.
    fn image<P: Copy + Send + Sync>(&self, blank: P, f: impl Fn(DVec3, DVec3, &Surface) -> P + Sync) -> Image<P> {
        self.image_on(blank, &Run::default(), f).unwrap_or_else(|Cancelled| unreachable!("nobody has the token"))
    }

    fn image_on<P: Copy + Send + Sync>(
        &self,
        blank: P,
        run: &Run,
        f: impl Fn(DVec3, DVec3, &Surface) -> P + Sync,
    ) -> Result<Image<P>, Cancelled> {
        let Window { width, height, .. } = self.seen.window();
        Image::by_rows([width, height], blank, run, |y, row| {
            let seen = &self.seen.surfaces()[y as usize * width as usize..];
            for ((to, surface), x) in row.iter_mut().zip(seen).zip(0..) {
                let (origin, direction) = self.rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
                *to = f(origin, direction, surface);
            }
        })
    }

    /// Depth along the axis of the view, in length units, as depth cameras give it; infinite
    /// where there is nothing.
    #[must_use]
    pub fn depth(&self) -> Image<f64> {
        self.depth_on(&Run::default()).unwrap_or_else(|Cancelled| unreachable!("nobody has the token"))
    }

    fn depth_on(&self, run: &Run) -> Result<Image<f64>, Cancelled> {
        let forward = self.rays.forward();
        self.image_on(f64::INFINITY, run, |_, direction, surface| {
            if surface.is_hit() { surface.distance * direction.dot(forward) } else { f64::INFINITY }
        })
    }

    /// Depth along each pixel's ray, in length units, as laser scanners give it; infinite where
    /// there is nothing.
    #[must_use]
    pub fn depth_along_rays(&self) -> Image<f64> {
        self.image(f64::INFINITY, |_, _, surface| surface.distance)
    }

    /// Unit normals out of the solid, in world coordinates; 0 where there is nothing.
    #[must_use]
    pub fn normal(&self) -> Image<Vec3> {
        self.image(Vec3::ZERO, |_, _, surface| surface.normal)
    }

    /// Points of the surface in world coordinates; infinite where there is nothing.
    #[must_use]
    pub fn position(&self) -> Image<DVec3> {
        self.image(DVec3::INFINITY, |origin, direction, surface| {
            if surface.is_hit() { origin + surface.distance * direction } else { DVec3::INFINITY }
        })
    }

    /// Whether there is something.
    #[must_use]
    pub fn mask(&self) -> Image<bool> {
        self.image(false, |_, _, surface| surface.is_hit())
    }

    /// The number of the leaf that is seen, as [`Owner::index`](crate::Owner::index) but for the
    /// owners of imported meshes; `None` where there is nothing.
    #[must_use]
    pub fn owner(&self) -> Image<Option<u32>> {
        self.image(None, |_, _, surface| surface.is_hit().then_some(surface.owner))
    }

    /// The depth image with the camera's geometry, to be turned into points, with noise if
    /// wanted.
    #[must_use]
    pub fn range_image(&self) -> RangeImage {
        self.range_image_with(&Run::default()).unwrap_or_else(|Cancelled| unreachable!("nobody has the token"))
    }

    /// [`range_image`](Layers::range_image) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// ```
    /// use rvachev::{Camera, Run, Solid};
    ///
    /// let ball = Solid::sphere(1.0);
    /// let layers = ball.layers(&Camera::framing(&ball.bounds()?), 64, 48)?;
    /// let range = layers.range_image_with(&Run { threads: 1, ..Run::default() })?;
    /// assert_eq!(range, layers.range_image());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn range_image_with(&self, run: &Run) -> Result<RangeImage, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let [to_depths, to_normals] = run.stages([1.0, 1.0]);
        let depth = self.depth_on(&to_depths)?;
        let normals = self.image_on(Vec3::ZERO, &to_normals, |_, _, surface| surface.normal)?;
        let intrinsics = self.camera.intrinsics(depth.width(), depth.height());
        match RangeImage::new(depth, intrinsics, self.camera.pose()) {
            Ok(range) => Ok(range.with_normals(normals)),
            Err(_) => unreachable!("the camera has been checked"),
        }
    }
}
