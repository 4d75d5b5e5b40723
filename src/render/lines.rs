//! Lines of a technical drawing: outlines and creases.
//!
//! ```text
//!    +--+--+--+--+       between two neighbouring samples there is
//!    |  |  |##|##|       an outline where one misses the solid or lies off the other's
//!    +--+--+--+--+         tangent plane: a step in depth
//!    |  |##|##|##|       a crease where they touch and their normals differ by an angle
//!    +--+--+--+--+
//! ```
//!
//! A sample is ink if such a place is within half the line's width of it; a pixel is as dark as
//! its share of ink.
//!
//! Source: T. Saito, T. Takahashi, *Comprehensible rendering of 3-D shapes* (1990).

use glam::{Vec3, Vec4};

use super::picture::Fine;
use super::spot::Spot;
use crate::Rays;

/// Nearly black, linear.
const INK: Vec3 = Vec3::new(0.011, 0.014, 0.02);

/// Neighbours whose normals differ by more (cosine of 20°) are on both sides of a crease.
const CREASE: f32 = 0.94;

/// Off the tangent plane by more than this many pixels is a step in depth.
const STEP: f64 = 2.5;

/// The samples of a band, and what is needed to draw lines over it.
pub(super) struct Lines<'a> {
    /// Height of the whole picture.
    pub(super) height: u32,
    /// Samples along a pixel's side.
    pub(super) samples: u32,
    /// Pixels of a row.
    pub(super) width: u32,
    pub(super) spots: &'a [Spot],
    pub(super) fine: &'a Fine,
    pub(super) pixel: &'a Rays,
}

#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Line {
    None,
    Crease,
    Outline,
}

impl Lines<'_> {
    /// Half the widths of creases and outlines, in pixels.
    fn half_widths(height: u32) -> [f64; 2] {
        // In proportion to the picture, as if it was printed in one size.
        let scale = (f64::from(height) / 600.0).clamp(0.6, 4.0);
        [0.55 * scale, 1.15 * scale]
    }

    /// How many pixels from an edge there can be ink.
    pub(super) fn reach(height: u32) -> u32 {
        Lines::half_widths(height)[1].ceil() as u32 + 1
    }

    /// The pixel at `place` with the lines over it.
    pub(super) fn drawn(&self, light: Vec4, place: usize) -> Vec4 {
        if self.fine.numbers[place] == u32::MAX {
            return light;
        }
        let n = self.samples as i64;
        let (x, y) = ((place as u32 % self.width) as i64 * n, (place as u32 / self.width) as i64 * n);
        let [thin, thick] = Lines::half_widths(self.height).map(|half| half * n as f64);
        let reach = thick.ceil() as i64;
        // Every edge about the pixel once, between a sample and its right and lower neighbour.
        let mut edges: Vec<(f64, f64, f64)> = Vec::new();
        for v in y - reach..=y + n + reach {
            for u in x - reach..=x + n + reach {
                let Some(own) = self.at(u, v) else { continue };
                for (du, dv) in [(1, 0), (0, 1)] {
                    let Some(next) = self.at(u + du, v + dv) else { continue };
                    let radius = match self.between(own, next) {
                        Line::None => continue,
                        Line::Crease => thin,
                        Line::Outline => thick,
                    };
                    edges.push((u as f64 + 0.5 * du as f64, v as f64 + 0.5 * dv as f64, radius));
                }
            }
        }
        if edges.is_empty() {
            return light;
        }
        let mut ink = 0.0;
        for v in y..y + n {
            for u in x..x + n {
                // Half a sample of softness at the border of a line.
                let cover = edges.iter().map(|(a, b, radius)| {
                    let away = (u as f64 - a).hypot(v as f64 - b);
                    (radius - away + 0.5).clamp(0.0, 1.0)
                });
                ink += cover.fold(0.0, f64::max);
            }
        }
        let ink = (ink / (n * n) as f64) as f32;
        light * (1.0 - ink) + INK.extend(1.0) * ink
    }

    /// The sample in a column and row of all samples: that of the pixel where it has one only.
    fn at(&self, u: i64, v: i64) -> Option<&Spot> {
        let n = i64::from(self.samples);
        let (x, y) = (u.div_euclid(n), v.div_euclid(n));
        if x < 0 || y < 0 || x >= i64::from(self.width) {
            return None;
        }
        let place = (y * i64::from(self.width) + x) as usize;
        let spot = self.spots.get(place)?;
        Some(match self.fine.numbers[place] {
            u32::MAX => spot,
            number => {
                let k = v.rem_euclid(n) * n + u.rem_euclid(n);
                &self.fine.spots[number as usize * (n * n) as usize + k as usize]
            }
        })
    }

    fn between(&self, a: &Spot, b: &Spot) -> Line {
        match (a.is_solid(), b.is_solid()) {
            (false, false) => return Line::None,
            (true, true) => {}
            _ => return Line::Outline,
        }
        let pixel = self.pixel.pixel_size(a.distance.min(b.distance)) / f64::from(self.samples);
        if a.steps(b) > STEP * pixel {
            return Line::Outline;
        }
        if a.normal.dot(b.normal) < CREASE { Line::Crease } else { Line::None }
    }
}
