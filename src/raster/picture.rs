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
use super::layers::{Facing, LayerSource};
use crate::Image;

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
        let pixel = |(x, y): (u32, u32)| {
            let (Some(id), Some(point)) = (self.id(x, y), self.point(x, y)) else { return Ok([0; 4]) };
            let number = id.operand as usize;
            let Some(operand) = operands.get(number) else {
                return Err(RasterError::Operand { operand: number, operands: operands.len() });
            };
            let outward = operand.normal(id.face, point);
            let normal = match id.facing {
                _ if outward == DVec3::ZERO => -view.direction(f64::from(x) + 0.5, f64::from(y) + 0.5),
                Facing::Front => outward,
                Facing::Back => -outward,
            };
            let lit = |direction: DVec3| normal.dot(direction).max(0.0);
            let share = 0.5 * (1.0 + normal.dot(up));
            let light = KEY * lit(key) + FILL * lit(fill) + SKY * share + GROUND * (1.0 - share);
            let color = Vec3::from_array(colors[number % colors.len()].map(|c| f32::from(c) / 255.0));
            let seen = (color.map(linear) * light as f32).map(encoded);
            let [r, g, b] = seen.to_array().map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
            Ok([r, g, b, 255])
        };
        let (width, height) = (view.width(), view.height());
        let pixels: Result<Vec<[u8; 4]>, RasterError> =
            (0..u64::from(width) * u64::from(height)).into_par_iter().map(|i| pixel(place(i, width))).collect();
        Ok(Image::new(width, height, pixels?)?)
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

/// Column and row of the pixel of this number.
fn place(number: u64, width: u32) -> (u32, u32) {
    ((number % u64::from(width)) as u32, (number / u64::from(width)) as u32)
}

/// From sRGB to linear.
fn linear(c: f32) -> f32 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// From linear to sRGB.
fn encoded(c: f32) -> f32 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}
