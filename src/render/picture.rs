//! Pixels: one ray each, and more where a pixel and its neighbours show different things.
//!
//! The picture is divided into bands of rows that are independent of each other, so that the
//! result is the same for any number of threads; a band traces the rows above and below it a
//! second time to compare with.
//!
//! Two neighbours differ if one hits and the other misses, if their normals or the leaves
//! that they belong to differ, if one is in the shadow, or if one lies off the tangent plane
//! of the other: a step in depth.

use glam::{DVec3, Vec4};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

use super::scene::Scene;
use super::settings::RenderSettings;
use super::shade::{Studio, bytes};
use crate::{Cancelled, Rays, Run};

/// Rows of a band: enough to make the rows traced twice a small part, few enough to share
/// the work evenly.
const BAND: u32 = 16;

/// Neighbours whose normals are further apart (cosine of 14°) are sampled more often.
const SAME_NORMAL: f64 = 0.97;

/// Neighbours that are further from the other's tangent plane, in pixels, are a step.
const STEP: f64 = 1.5;

/// What a ray meets.
#[derive(Clone, Copy)]
struct Seen {
    point: DVec3,
    /// Towards the viewer.
    normal: DVec3,
    owner: u32,
    lit: bool,
    distance: f64,
}

/// A ray's colour, and what it meets if anything.
#[derive(Clone, Copy)]
struct Sample {
    /// Linear, weighted by alpha.
    light: Vec4,
    seen: Option<Seen>,
}

/// All that rays need.
pub(super) struct Picture<'a> {
    pub(super) scene: &'a Scene,
    pub(super) studio: Studio,
    pub(super) rays: Rays,
    pub(super) settings: &'a RenderSettings,
}

impl Picture<'_> {
    /// All pixels, row by row from the top.
    pub(super) fn pixels(&self, run: &Run) -> Result<Vec<[u8; 4]>, Cancelled> {
        let RenderSettings { width, height, .. } = *self.settings;
        let mut pixels = vec![[0; 4]; width as usize * height as usize];
        let done = AtomicU32::new(0);
        let bands = pixels.par_chunks_mut((width * BAND) as usize).enumerate();
        bands.try_for_each(|(band, pixels)| {
            self.band(band as u32 * BAND, pixels, run)?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            run.report(f64::from(done) / f64::from(height.div_ceil(BAND)));
            Ok(())
        })?;
        Ok(pixels)
    }

    /// The rows from `top` on.
    fn band(&self, top: u32, pixels: &mut [[u8; 4]], run: &Run) -> Result<(), Cancelled> {
        let RenderSettings { width, height, samples, .. } = *self.settings;
        let end = top + pixels.len() as u32 / width;
        let (first, last) = if samples > 1 { (top.saturating_sub(1), (end + 1).min(height)) } else { (top, end) };
        let mut coarse = Vec::with_capacity((width * (last - first)) as usize);
        for y in first..last {
            run.check()?;
            coarse.extend((0..width).map(|x| self.sample(f64::from(x) + 0.5, f64::from(y) + 0.5)));
        }
        let at = |x: u32, y: u32| &coarse[((y - first) * width + x) as usize];
        for (row, y) in pixels.chunks_mut(width as usize).zip(top..) {
            run.check()?;
            for (pixel, x) in row.iter_mut().zip(0..) {
                let own = at(x, y);
                let differs = samples > 1
                    && (x > 0 && self.differ(own, at(x - 1, y))
                        || x + 1 < width && self.differ(own, at(x + 1, y))
                        || y > first && self.differ(own, at(x, y - 1))
                        || y + 1 < last && self.differ(own, at(x, y + 1)));
                *pixel = bytes(if differs { self.mean(x, y, own) } else { own.light });
            }
        }
        Ok(())
    }

    /// The mean of a pixel's samples; `middle` is the one that is known.
    ///
    /// Rows and columns of the samples are sheared, so that no two of the n² are at the same
    /// height or side: an outline near the horizontal or vertical passes them one by one.
    fn mean(&self, x: u32, y: u32, middle: &Sample) -> Vec4 {
        let n = self.settings.samples;
        let at = |i: u32, j: u32| (f64::from(i) + (f64::from(j) + 0.5) / f64::from(n)) / f64::from(n);
        let mut sum = Vec4::ZERO;
        for j in 0..n {
            for i in 0..n {
                let known = 2 * i + 1 == n && 2 * j + 1 == n;
                sum += if known {
                    middle.light
                } else {
                    self.sample(f64::from(x) + at(i, j), f64::from(y) + at(j, i)).light
                };
            }
        }
        sum / (n * n) as f32
    }

    /// The ray at pixel coordinates (x, y).
    fn sample(&self, x: f64, y: f64) -> Sample {
        let (origin, direction) = self.rays.ray(x, y);
        let Some(hit) = self.scene.first_hit(origin, direction) else {
            return Sample { light: self.studio.background(y / f64::from(self.settings.height)), seen: None };
        };
        let viewer = -direction;
        // Where the gradient vanishes there is no normal; facing the viewer is as good as any.
        let outward = if hit.normal == DVec3::ZERO { viewer } else { hit.normal };
        // From inside the solid, its walls are seen from behind.
        let from_outside = outward.dot(viewer) >= 0.0;
        let normal = if from_outside { outward } else { -outward };
        let key = self.studio.key();
        let shadowed = || self.scene.first_hit(hit.point + self.scene.hair() * normal, key).is_some();
        let lit = normal.dot(key) > 0.0 && !(self.settings.shadows && from_outside && shadowed());
        let seen = Seen { point: hit.point, normal, owner: hit.owner, lit, distance: hit.distance };
        Sample { light: self.studio.surface(normal, viewer, lit), seen: Some(seen) }
    }

    /// Whether an edge may pass between two neighbours.
    fn differ(&self, a: &Sample, b: &Sample) -> bool {
        let (a, b) = match (&a.seen, &b.seen) {
            (Some(a), Some(b)) => (a, b),
            (None, None) => return false,
            _ => return true,
        };
        let between = b.point - a.point;
        let off = between.dot(a.normal).abs().max(between.dot(b.normal).abs());
        a.owner != b.owner
            || a.lit != b.lit
            || a.normal.dot(b.normal) < SAME_NORMAL
            || off > STEP * self.rays.pixel_size(a.distance.min(b.distance))
    }
}
