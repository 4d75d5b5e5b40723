//! Pictures of buffers: shaded, and of depth.
//!
//! ```text
//!     light = colour · (key · max(n·k, 0) + fill · max(n·f, 0) + sky · (1 + n·up)/2
//!                       + ground · (1 − n·up)/2)
//! ```
//!
//! k from the upper left and f from the right of the camera; linear light, bytes in sRGB
//! (IEC 61966-2-1). Normals are asked of the operands for what is seen only. This is for
//! looking at results: no shadows, one sample a pixel.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::buffers::Buffers;
use super::error::RasterError;
use super::layers::{Facing, LayerSource, Tile};
use super::target::{NOTHING, Target};
use crate::Image;
use crate::geom::{to_byte, to_linear};

/// Strengths of the lights.
const KEY: f64 = 0.95;
const FILL: f64 = 0.18;
const SKY: f64 = 0.38;
const GROUND: f64 = 0.14;

/// Grey levels of the nearest and of the farthest depth of a picture of depth.
const NEAREST: f64 = 245.0;
const FARTHEST: f64 = 50.0;

impl Buffers {
    /// A shaded picture. Operand i has the colour `colors[i % colors.len()]` (red, green, blue in
    /// sRGB); where nothing is seen, alpha is 0.
    ///
    /// # Errors
    ///
    /// [`RasterError::Operand`] if an operand is seen that is not given;
    /// [`RasterError::Setting`] without any colour.
    pub fn picture(&self, operands: &[&dyn LayerSource], colors: &[[u8; 3]]) -> Result<Image, RasterError> {
        if colors.is_empty() {
            let allowed = "one colour or more";
            return Err(RasterError::Setting { setting: "number of colors", value: "0".into(), allowed });
        }
        let view = self.view();
        let [right, up, forward] = view.axes();
        let towards = |x: f64, y: f64, z: f64| (x * right + y * up - z * forward).normalize();
        let (key, fill) = (towards(-0.62, 0.66, 0.62), towards(0.85, 0.05, 0.45));
        let colors: Vec<Vec3> =
            colors.iter().map(|color| Vec3::from_array(color.map(|c| to_linear(f32::from(c) / 255.0)))).collect();
        let pixel = |target: &Target, i: usize, x: u32, y: u32| {
            let depth = target.depth[i];
            if target.operand[i] == NOTHING || depth == f64::INFINITY {
                return Ok([0; 4]);
            }
            let id = target.id(i);
            let number = id.operand as usize;
            let Some(layers) = operands.get(number) else {
                return Err(RasterError::Operand { operand: number, operands: operands.len() });
            };
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let outward = layers.normal(id.face, view.point(x, y, depth));
            let normal = match id.facing {
                _ if outward == DVec3::ZERO => -view.direction(x, y),
                Facing::Front => outward,
                Facing::Back => -outward,
            };
            let lit = |direction: DVec3| normal.dot(direction).max(0.0);
            let share = 0.5 * (1.0 + normal.dot(up));
            let light = KEY * lit(key) + FILL * lit(fill) + SKY * share + GROUND * (1.0 - share);
            let [r, g, b] = (colors[number % colors.len()] * light as f32).to_array().map(to_byte);
            Ok([r, g, b, 255])
        };
        let (width, height) = (view.width(), view.height());
        let [across, _] = Tile::grid(width, height);
        let mut pixels = vec![[0; 4]; width as usize * height as usize];
        // A row of tiles at a time.
        let bands = pixels.par_chunks_mut((width * Tile::SIDE) as usize).zip(self.tiles.par_chunks(across as usize));
        bands.enumerate().try_for_each(|(band, (pixels, tiles))| {
            let top = band as u32 * Tile::SIDE;
            for ((row, line), y) in pixels.chunks_mut(width as usize).enumerate().zip(top..) {
                for (target, (part, left)) in
                    tiles.iter().zip(line.chunks_mut(Tile::SIDE as usize).zip((0..).step_by(Tile::SIDE as usize)))
                {
                    for ((column, out), x) in part.iter_mut().enumerate().zip(left..) {
                        *out = pixel(target, row * Tile::SIDE as usize + column, x, y)?;
                    }
                }
            }
            Ok::<_, RasterError>(())
        })?;
        Ok(Image::new(width, height, pixels)?)
    }

    /// A picture of depth: grey, from light where it is nearest to dark where it is farthest;
    /// where nothing is seen, alpha is 0.
    ///
    /// # Errors
    ///
    /// None but an internal one.
    pub fn depth_picture(&self) -> Result<Image, RasterError> {
        let depths = self.depths();
        let seen = || depths.iter().copied().filter(|d| d.is_finite());
        let (near, far) = seen().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| (a.min(d), b.max(d)));
        let range = (far - near).max(f64::MIN_POSITIVE);
        let grey = |depth: &f64| {
            if !depth.is_finite() {
                return [0; 4];
            }
            let level = NEAREST + (FARTHEST - NEAREST) * ((depth - near) / range);
            let level = level.round() as u8;
            [level, level, level, 255]
        };
        let view = self.view();
        Ok(Image::new(view.width(), view.height(), depths.iter().map(grey).collect())?)
    }
}
