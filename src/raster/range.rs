//! Depth buffers as range images.

use super::buffers::Buffers;
use super::error::RasterError;
use crate::{RangeImage, Run};

impl Buffers {
    /// The depth buffer as a range image, of the same kind as those that rays make: depths along
    /// the view, with the camera's intrinsics and pose. From it come points, of the camera's or
    /// of the world's coordinates, and the noise of a range finder.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::range_image::{Coordinates, Noise};
    /// use rvachev::raster::{Buffers, ClosedMesh, Facing, RasterView};
    /// use rvachev::surface::{ParametricSurface, PatchSettings};
    /// use rvachev::{Camera, Superellipsoid, deg};
    ///
    /// let mesh = ParametricSurface::of(&Superellipsoid::new([1.0, 1.0, 1.0], 1.0, 1.0))?.mesh(&PatchSettings::default())?;
    /// let camera = Camera::perspective([3.0, -4.0, 2.0], DVec3::ZERO, DVec3::Z, deg(30.0));
    /// let view = RasterView::new(&camera, 64, 48)?;
    /// let mut buffers = Buffers::new(&view);
    /// buffers.draw(&view.layers(ClosedMesh::new(&mesh)?), 0, Facing::Front)?;
    /// let noisy = buffers.range_image()?.with_noise(&Noise { deviation: 0.002, missing: 0.1, seed: 7 })?;
    /// let cloud = noisy.points(Coordinates::World)?;
    /// assert!(cloud.positions().len() > 500);
    /// assert!(cloud.positions().iter().all(|p| (p.length() - 1.0).abs() < 0.02));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`RasterError::Range`] for a camera whose numbers are too extreme for intrinsics.
    pub fn range_image(&self) -> Result<RangeImage, RasterError> {
        self.range_image_with(&Run::default())
    }

    /// [`range_image`](Buffers::range_image) with a choice of threads, a cancel token and a
    /// progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`range_image`](Buffers::range_image), and [`RasterError::Cancelled`].
    pub fn range_image_with(&self, run: &Run) -> Result<RangeImage, RasterError> {
        let view = self.view();
        let (width, height) = (view.width(), view.height());
        let depth = self.depth_image(&run.stage(0.0, 1.0))?;
        let camera = view.camera();
        Ok(RangeImage::new(depth, camera.intrinsics(width, height), camera.pose())?)
    }
}
