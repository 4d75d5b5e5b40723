//! Range images: depth with a camera, turned to points.
//!
//! ```text
//!        eye *----------------.---*  point = eye + distance · ray
//!            |<--- depth --->|       depth along the axis of the view: distance · cos
//! ```
//!
//! Noise is added along the ray, as a range finder makes it. Each pixel has random numbers of
//! its own, made from the seed and its place, so that the result depends on nothing else.
//!
//! Sources: G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number generators*
//! (2014), for the generator; G. Box, M. Muller (1958) for normal deviates.

use std::sync::Arc;

use glam::{DAffine3, DVec2, Vec3};
use rvachev_num::Meter;

use super::{Image, Intrinsics, PointCloud, PointCloudError};
use crate::{Cancelled, Run};

/// A depth image of a camera whose geometry is known.
///
/// ```
/// use rvachev::range_image::{Coordinates, Noise};
/// use rvachev::{Camera, Solid};
///
/// let ball = Solid::sphere(1.0);
/// let camera = Camera::framing(&ball.bounds()?);
/// let range = ball.layers(&camera, 64, 48)?.range_image();
/// let noisy = range.with_noise(&Noise { deviation: 0.01, missing: 0.1, seed: 7 })?;
/// let cloud = noisy.points(Coordinates::World)?;
/// assert!(cloud.positions().iter().all(|p| (p.length() - 1.0).abs() < 0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RangeImage {
    depth: Image<f64>,
    normals: Option<Arc<Image<Vec3>>>,
    intrinsics: Intrinsics,
    pose: DAffine3,
}

/// What the coordinates of points refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Coordinates {
    /// The camera: x right, y down, z along the view, the eye at 0.
    Camera,
    /// The world that the solid is in.
    World,
}

/// How a range finder errs.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Noise {
    /// Standard deviation of the error along the ray, in length units, at least 0. Default: 0.
    pub deviation: f64,
    /// The share of the pixels that are missing, 0 to 1. Default: 0.
    pub missing: f64,
    /// What the random numbers are made from. Default: 0.
    pub seed: u64,
}

/// What is wrong with a range image or its noise.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RangeImageError {
    /// A parameter is out of its range.
    #[error("{parameter} is {value}; allowed: {allowed}")]
    Parameter {
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl RangeImage {
    /// From depths along the axis of the view, in length units, infinite (or NaN) where there
    /// is nothing, with the camera's intrinsics and its pose in the world.
    ///
    /// # Errors
    ///
    /// If the image is not of the size that the intrinsics are for, a focal length is not above
    /// 0, or a number of the camera is not finite.
    pub fn new(depth: Image<f64>, intrinsics: Intrinsics, pose: DAffine3) -> Result<RangeImage, RangeImageError> {
        let error = |parameter, value: String, allowed| Err(RangeImageError::Parameter { parameter, value, allowed });
        let (size, wanted) = ((depth.width(), depth.height()), (intrinsics.width, intrinsics.height));
        if size != wanted {
            return error("size of the depth image", format!("{size:?}"), "that of the intrinsics");
        }
        let focal = [intrinsics.fx, intrinsics.fy];
        if !focal.iter().all(|f| *f > 0.0 && f.is_finite()) {
            return error("focal length", format!("{focal:?}"), "finite and above 0");
        }
        if !(intrinsics.cx.is_finite() && intrinsics.cy.is_finite()) {
            return error("principal point", format!("({}, {})", intrinsics.cx, intrinsics.cy), "finite");
        }
        if !pose.is_finite() {
            return error("pose", format!("{pose}"), "finite");
        }
        Ok(RangeImage { depth, normals: None, intrinsics, pose })
    }

    /// With a unit normal for every pixel, in the world.
    pub(crate) fn with_normals(mut self, normals: Image<Vec3>) -> RangeImage {
        self.normals = Some(Arc::new(normals));
        self
    }

    /// Depths along the axis of the view, infinite where there is nothing.
    #[must_use]
    pub fn depth(&self) -> &Image<f64> {
        &self.depth
    }

    /// Camera coordinates to pixels.
    #[must_use]
    pub fn intrinsics(&self) -> &Intrinsics {
        &self.intrinsics
    }

    /// Camera coordinates to the world.
    #[must_use]
    pub fn pose(&self) -> DAffine3 {
        self.pose
    }

    /// The same image as a range finder would see it. The same seed gives the same noise.
    ///
    /// # Errors
    ///
    /// If a parameter is out of its range.
    pub fn with_noise(&self, noise: &Noise) -> Result<RangeImage, RangeImageError> {
        self.with_noise_on(noise, &Run::default())
    }

    /// [`with_noise`](RangeImage::with_noise) on a [`Run`]: a choice of threads, a cancel token and
    /// a progress sink. The noise does not depend on it.
    ///
    /// ```
    /// use rvachev::range_image::Noise;
    /// use rvachev::{Camera, Run, Solid};
    ///
    /// let ball = Solid::sphere(1.0);
    /// let range = ball.layers(&Camera::framing(&ball.bounds()?), 64, 48)?.range_image();
    /// let noise = Noise { deviation: 0.01, missing: 0.1, seed: 7 };
    /// let alone = range.with_noise_on(&noise, &Run { threads: 1, ..Run::default() })?;
    /// assert_eq!(alone, range.with_noise(&noise)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`with_noise`](RangeImage::with_noise), and [`RangeImageError::Cancelled`].
    pub fn with_noise_on(&self, noise: &Noise, run: &Run) -> Result<RangeImage, RangeImageError> {
        let error = |parameter, value: f64, allowed| {
            let value = value.to_string();
            Err(RangeImageError::Parameter { parameter, value, allowed })
        };
        if !(noise.deviation >= 0.0 && noise.deviation.is_finite()) {
            return error("deviation", noise.deviation, "0 or more, finite");
        }
        if !(0.0..=1.0).contains(&noise.missing) {
            return error("missing", noise.missing, "0 to 1");
        }
        let noisy = |depth: f64, index: u64| {
            let mut random = Random::new(noise.seed, index);
            if random.unit() < noise.missing || !depth.is_finite() {
                return f64::INFINITY;
            }
            let error = noise.deviation * random.normal();
            // Along the ray: less of it along the axis.
            depth + error * self.cosine(self.pixel(index))
        };
        let [width, height] = [self.depth.width(), self.depth.height()];
        let depth = Image::by_rows([width, height], f64::INFINITY, &run.stage(0.0, 1.0), |y, row| {
            let first = u64::from(y) * u64::from(width);
            let depths = &self.depth.pixels()[first as usize..];
            for ((to, depth), index) in row.iter_mut().zip(depths).zip(first..) {
                *to = noisy(*depth, index);
            }
        })?;
        Ok(RangeImage { depth, normals: self.normals.clone(), ..*self })
    }

    /// The middle of the pixel with this number.
    fn pixel(&self, index: u64) -> DVec2 {
        let width = u64::from(self.intrinsics.width);
        DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5)
    }

    /// Cosine of the angle between a pixel's ray and the axis.
    fn cosine(&self, pixel: DVec2) -> f64 {
        if self.intrinsics.parallel { 1.0 } else { self.intrinsics.unproject(pixel, 1.0).length().recip() }
    }

    /// The points that the pixels see, row by row, without those that see nothing; with normals
    /// if it was made from a solid.
    ///
    /// # Errors
    ///
    /// If depths are so large that a point is not finite.
    pub fn points(&self, coordinates: Coordinates) -> Result<PointCloud, PointCloudError> {
        self.points_with(coordinates, &Run::default())
    }

    /// [`points`](RangeImage::points) with a cancel token and a progress sink; on one thread.
    ///
    /// ```
    /// use rvachev::range_image::Coordinates;
    /// use rvachev::{Camera, Progress, Run, Solid};
    ///
    /// let ball = Solid::sphere(1.0);
    /// let range = ball.layers(&Camera::framing(&ball.bounds()?), 64, 48)?.range_image();
    /// let progress = Some(Progress::new(|part| println!("{:.0} %", 100.0 * part)));
    /// let cloud = range.points_with(Coordinates::World, &Run { progress, ..Run::default() })?;
    /// assert_eq!(cloud, range.points(Coordinates::World)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`points`](RangeImage::points), and [`PointCloudError::Cancelled`].
    pub fn points_with(&self, coordinates: Coordinates, run: &Run) -> Result<PointCloud, PointCloudError> {
        let run = run.stage(0.0, 1.0);
        run.check()?;
        let world = coordinates == Coordinates::World;
        let back = self.pose.matrix3.transpose();
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        let reading = run.stage(0.0, 0.9);
        let meter = Meter::new(&reading, self.depth.height());
        let width = self.depth.width() as usize;
        for (row, first) in self.depth.pixels().chunks_exact(width).zip((0u64..).step_by(width)) {
            meter.step()?;
            for (depth, index) in row.iter().zip(first..).filter(|(depth, _)| depth.is_finite()) {
                let p = self.intrinsics.unproject(self.pixel(index), *depth);
                positions.push(if world { self.pose.transform_point3(p) } else { p });
                if let Some(all) = &self.normals {
                    let n = all.pixels()[index as usize];
                    normals.push(if world { n } else { (back * n.as_dvec3()).as_vec3() });
                }
            }
        }
        let cloud = PointCloud::new(positions)?;
        let cloud = if self.normals.is_some() { cloud.with_normals(normals)? } else { cloud };
        run.report(1.0);
        Ok(cloud)
    }
}

/// A stream of random numbers.
struct Random(u64);

impl Random {
    /// The stream of a pixel.
    fn new(seed: u64, index: u64) -> Random {
        let mut random = Random(seed);
        // Through the mixer, so that neighbouring seeds and pixels have nothing in common.
        random.0 = random.next() ^ index.wrapping_mul(0xd134_2543_de82_ef95);
        random.0 = random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform from 0, inclusive, to 1, exclusive.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Of mean 0 and standard deviation 1.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }
}
