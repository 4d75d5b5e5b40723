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

use super::buffers::Buffers;
use super::error::RasterError;
use super::layers::{Facing, LayerSource, Tile};
use super::target::{NOTHING, Target};
use crate::geom::{to_byte, to_linear};
use crate::{Image, Run};
use rvachev_num::{Meter, jobs};

/// Strengths of the lights.
const KEY: f64 = 0.95;
const FILL: f64 = 0.18;
const SKY: f64 = 0.38;
const GROUND: f64 = 0.14;

/// Pixels of a row of a tile.
const SIDE: usize = Tile::SIDE as usize;

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
        self.picture_with(operands, colors, &Run::default())
    }

    /// [`picture`](Buffers::picture) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`picture`](Buffers::picture), and [`RasterError::Cancelled`].
    pub fn picture_with(
        &self,
        operands: &[&dyn LayerSource],
        colors: &[[u8; 3]],
        run: &Run,
    ) -> Result<Image, RasterError> {
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
        let shade = |color: Vec3, normal: DVec3| {
            let lit = |direction: DVec3| normal.dot(direction).max(0.0);
            let share = 0.5 * (1.0 + normal.dot(up));
            let light = KEY * lit(key) + FILL * lit(fill) + SKY * share + GROUND * (1.0 - share);
            let [r, g, b] = (color * light as f32).to_array().map(to_byte);
            [r, g, b, 255]
        };
        // Neighbours of a row that show one face are asked for their normals together.
        let row = |target: &Target, i: usize, left: u32, y: u32, out: &mut [[u8; 4]]| {
            let (mut points, mut normals) = ([DVec3::ZERO; SIDE], [DVec3::ZERO; SIDE]);
            let point = view.points(f64::from(y) + 0.5);
            let is_seen = |i: usize| target.operand[i] != NOTHING && target.depth[i] < f64::INFINITY;
            let mut at = 0;
            while at < out.len() {
                if !is_seen(i + at) {
                    at += 1;
                    continue;
                }
                let id = target.id(i + at);
                let same = |n: &usize| is_seen(i + n) && target.id(i + n) == id;
                let count = (at..out.len()).take_while(same).count();
                let number = id.operand as usize;
                let Some(layers) = operands.get(number) else {
                    return Err(RasterError::Operand { operand: number, operands: operands.len() });
                };
                for (to, n) in points[..count].iter_mut().zip(at..) {
                    *to = point(f64::from(left + n as u32) + 0.5, target.depth[i + n]);
                }
                layers.normals(id.face, &points[..count], &mut normals[..count]);
                let color = colors[number % colors.len()];
                for ((out, outward), n) in out[at..at + count].iter_mut().zip(&normals[..count]).zip(at..) {
                    let normal = match id.facing {
                        _ if *outward == DVec3::ZERO => {
                            -view.direction(f64::from(left + n as u32) + 0.5, f64::from(y) + 0.5)
                        }
                        Facing::Front => *outward,
                        Facing::Back => -*outward,
                    };
                    *out = shade(color, normal);
                }
                at += count;
            }
            Ok(())
        };
        let (width, height) = (view.width(), view.height());
        let [across, _] = Tile::grid(width, height);
        let mut pixels = vec![[0; 4]; width as usize * height as usize];
        // A row of tiles at a time.
        let run = run.stage(0.0, 1.0);
        let meter = Meter::new(&run, height);
        let of_band = |band: usize, pixels: &mut [[u8; 4]]| {
            let (top, tiles) = (band as u32 * Tile::SIDE, &self.tiles[band * across as usize..][..across as usize]);
            for ((line, pixels), y) in pixels.chunks_mut(width as usize).enumerate().zip(top..) {
                meter.check()?;
                for (target, (part, left)) in tiles.iter().zip(pixels.chunks_mut(SIDE).zip((0..).step_by(SIDE))) {
                    row(target, line * SIDE, left, y, part)?;
                }
                meter.add(1);
            }
            Ok::<_, RasterError>(())
        };
        run.install(|| jobs::try_chunks_mut(&mut pixels, (width * Tile::SIDE) as usize, of_band))?;
        Ok(Image::new(width, height, pixels)?)
    }

    /// A picture of depth: grey, from light where it is nearest to dark where it is farthest;
    /// where nothing is seen, alpha is 0.
    ///
    /// # Errors
    ///
    /// None but an internal one.
    pub fn depth_picture(&self) -> Result<Image, RasterError> {
        self.depth_picture_with(&Run::default())
    }

    /// [`depth_picture`](Buffers::depth_picture) with a choice of threads, a cancel token and a
    /// progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`depth_picture`](Buffers::depth_picture), and [`RasterError::Cancelled`].
    pub fn depth_picture_with(&self, run: &Run) -> Result<Image, RasterError> {
        let run = run.stage(0.0, 1.0);
        let [gathering, shading] = run.stages([1.0, 1.0]);
        let depths = self.depth_image(&gathering)?;
        let (near, far) = depths.range().unwrap_or_default();
        let range = (far - near).max(f64::MIN_POSITIVE);
        let grey = |depth: &f64| {
            if !depth.is_finite() {
                return [0; 4];
            }
            let level = NEAREST + (FARTHEST - NEAREST) * ((depth - near) / range);
            let level = level.round() as u8;
            [level, level, level, 255]
        };
        Ok(depths.map_on([0; 4], &shading, grey)?)
    }
}
