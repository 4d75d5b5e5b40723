//! A picture of deviations: points by their colours, beside a bar that says what these mean.

use glam::DVec2;

use super::error::FitError;
use super::inspect::{Deviations, color};
use crate::geom::{Camera, Image, PointCloud, label, legend};

/// What there is no point in.
const BACKGROUND: [u8; 4] = [40, 42, 46, 255];

/// Points are squares of so many pixels to either side of the middle, in a picture of so many
/// pixels.
const POINT: f64 = 1.0 / 300.0;

/// Larger pictures are refused.
const LARGEST: u32 = 16_384;

impl Deviations {
    /// A picture of the cloud as a camera sees it, each point by its deviation: blue at −`reach`
    /// and beyond, white at 0, red at `reach` and beyond, as [`colored`](Deviations::colored) does
    /// it; nearer points hide those behind. At the right stands a bar with the numbers, in length
    /// units.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `reach` | length | above 0 |
    /// | `width`, `height` | pixels | 1 to 16384 |
    ///
    /// # Errors
    ///
    /// [`FitError::Setting`] of a number out of its range, [`FitError::Points`] if the cloud has
    /// another number of points, [`FitError::Camera`] of a camera that sees nothing.
    ///
    /// ```
    /// use rvachev::fit::inspect;
    /// use rvachev::surface::ParametricSurface;
    /// use rvachev::{Bounds, Camera, PointCloud, Solid, Superellipsoid};
    ///
    /// let made = Superellipsoid::new([1.0, 1.0, 1.1], 1.0, 1.0);
    /// let scan = ParametricSurface::of(&made)?.sample(2000, 1)?;
    /// let scan = PointCloud::new(scan.iter().map(|s| s.point).collect())?;
    /// let report = inspect(&Solid::sphere(1.0), &scan)?;
    /// let camera = Camera::framing(&Bounds::from_center([0.0, 0.0, 0.0], [1.1, 1.1, 1.1]));
    /// let picture = report.picture(&scan, 0.1, &camera, 320, 240)?;
    /// // The top is too high: the first point from above is red.
    /// let column = (0..240).filter_map(|y| picture.pixel(160, y)).find(|pixel| pixel[0] > 100);
    /// assert!(column.is_some_and(|[r, _, b, _]| r > b));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn picture(
        &self,
        cloud: &PointCloud,
        reach: f64,
        camera: &Camera,
        width: u32,
        height: u32,
    ) -> Result<Image, FitError> {
        let colored = self.colored(cloud, reach)?;
        for (setting, value) in [("width", width), ("height", height)] {
            if !(1..=LARGEST).contains(&value) {
                return Err(FitError::Setting { setting, value: value.to_string(), allowed: "1 to 16384" });
            }
        }
        camera.check()?;
        let lens = camera.intrinsics(width, height);
        let to_camera = camera.pose().inverse();
        let mut pixels = vec![BACKGROUND; width as usize * height as usize];
        let mut depths = vec![f64::INFINITY; pixels.len()];
        let half = (POINT * f64::from(width.min(height))).round().max(1.0);
        let colors = colored.colors().unwrap_or_default();
        for (p, color) in cloud.positions().iter().zip(colors) {
            let p = to_camera.transform_point3(*p);
            let Some(at) = lens.project(p).filter(|at| at.is_finite()) else { continue };
            let size = DVec2::new(f64::from(width), f64::from(height));
            let (least, most) = ((at - half).max(DVec2::ZERO), (at + half).min(size));
            for y in least.y as usize..most.y.max(0.0) as usize {
                for x in least.x as usize..most.x.max(0.0) as usize {
                    let pixel = y * width as usize + x;
                    if p.z < depths[pixel] {
                        depths[pixel] = p.z;
                        pixels[pixel] = [color[0], color[1], color[2], 255];
                    }
                }
            }
        }
        let labels = [1.0, 0.5, 0.0, -0.5, -1.0].map(|part| label(part * reach, reach, true));
        legend(&mut pixels, width as usize, &labels, |at| color((2.0 * at - 1.0) * reach, reach));
        Ok(Image::new(width, height, pixels)?)
    }
}
