//! One triangle in a picture: which pixels it covers, and at which depth.
//!
//! ```text
//!        a ------------- b         e_ab(p) = (b − a) × (p − a) ≥ 0 for p on the inner side of
//!         \      . p    /          an edge; p is covered if it is on the inner side of all
//!          \           /           three, or on an edge that is a top or a left one
//!           \         /            key(p) = (e_bc key_a + e_ca key_b + e_ab key_c) / area
//!            `-- c --'
//! ```
//!
//! Coordinates are rounded to a fraction of a pixel, so edge functions are integers; f64 holds
//! them exactly, and lanes of f64 are quick everywhere. So triangles that share an edge cover
//! every pixel along it once, and a closed mesh stays closed: what is drawn is the mesh with
//! its vertices moved by at most 2⁻¹⁰ of a pixel (2⁻¹⁴ in pictures of up to 1024 pixels a side).
//! Whether a triangle is seen from its front is told by the moved vertices as well.
//!
//! Source: J. Pineda, *A parallel algorithm for polygon rasterization* (1988).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::layers::{Facing, Fragments, LANES, Tile};

/// A triangle with its corners at fractions of a pixel, clockwise in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    x: [i32; 3],
    y: [i32; 3],
    /// z without perspective, 1/z with it.
    key: [f64; 3],
    face: u32,
    facing: Facing,
}

/// As many runs are handed on at once.
const BATCH: usize = 32;

/// Runs on their way to whoever draws them.
pub(super) struct Batch {
    runs: [Fragments; BATCH],
    count: usize,
}

impl Batch {
    pub(super) fn new() -> Batch {
        Batch { runs: [Fragments::pixel(0, f64::INFINITY, Facing::Front, 0); BATCH], count: 0 }
    }

    #[inline(always)]
    fn push(&mut self, run: Fragments, sink: &mut dyn FnMut(&[Fragments])) {
        self.runs[self.count] = run;
        self.count += 1;
        if self.count == BATCH {
            self.flush(sink);
        }
    }

    pub(super) fn flush(&mut self, sink: &mut dyn FnMut(&[Fragments])) {
        if self.count > 0 {
            sink(&self.runs[..self.count]);
            self.count = 0;
        }
    }
}

impl Triangle {
    /// A triangle from its corners' coordinates in fractions of a pixel, anticlockwise in the
    /// picture if it is seen from its front; `None` if it has no area.
    #[inline]
    pub(super) fn new(corners: [(i32, i32, f64); 3], face: u32) -> Option<Triangle> {
        let [a, b, c] = corners;
        let (ux, uy) = (i64::from(b.0 - a.0), i64::from(b.1 - a.1));
        let (vx, vy) = (i64::from(c.0 - a.0), i64::from(c.1 - a.1));
        let area = ux * vy - uy * vx;
        let (facing, [a, b, c]) = match area {
            0 => return None,
            1.. => (Facing::Back, corners),
            _ => (Facing::Front, [a, c, b]),
        };
        Some(Triangle { x: [a.0, b.0, c.0], y: [a.1, b.1, c.1], key: [a.2, b.2, c.2], face, facing })
    }

    /// Whether it is seen from its front.
    #[inline]
    pub(super) fn is_front(&self) -> bool {
        self.facing == Facing::Front
    }

    /// The first and last column and row whose pixels' middles are within the triangle's box;
    /// empty if the last is before the first.
    #[inline(always)]
    pub(super) fn pixels(&self, fraction: u32) -> [i32; 4] {
        let half = 1 << (fraction - 1);
        let ([x0, x1, x2], [y0, y1, y2]) = (self.x, self.y);
        let (left, right) = (x0.min(x1).min(x2), x0.max(x1).max(x2));
        let (top, bottom) = (y0.min(y1).min(y2), y0.max(y1).max(y2));
        [
            (left + half - 1) >> fraction,
            (right - half) >> fraction,
            (top + half - 1) >> fraction,
            (bottom - half) >> fraction,
        ]
    }

    /// Draws what is in the tile.
    #[inline(always)]
    pub(super) fn draw<S: Simd, const PERSPECTIVE: bool>(
        &self,
        simd: S,
        tile: &Tile,
        fraction: u32,
        batch: &mut Batch,
        sink: &mut dyn FnMut(&[Fragments]),
    ) {
        let [left, right, top, bottom] = self.pixels(fraction);
        let (x0, y0) = (tile.x as i32, tile.y as i32);
        let (left, right) = ((left - x0).max(0), (right - x0).min(tile.width as i32 - 1));
        let (top, bottom) = ((top - y0).max(0), (bottom - y0).min(tile.height as i32 - 1));
        if left > right || top > bottom {
            return;
        }
        let pixel = 1i64 << fraction;
        // Runs start at multiples of their length.
        let left = left & !(LANES as i32 - 1);
        let px = i64::from(x0 + left) * pixel + pixel / 2;
        let py = i64::from(y0 + top) * pixel + pixel / 2;

        // Edge i is opposite to corner i.
        let mut at_left = [0.0; 3];
        let mut step = [[0.0; 2]; 3];
        let mut least = [0.0; 3];
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let (ax, ay) = (i64::from(self.x[a]), i64::from(self.y[a]));
            let (dx, dy) = (i64::from(self.x[b]) - ax, i64::from(self.y[b]) - ay);
            let is_top_or_left = dy < 0 || (dy == 0 && dx > 0);
            at_left[i] = (dx * (py - ay) - dy * (px - ax)) as f64;
            step[i] = [(-dy * pixel) as f64, (dx * pixel) as f64];
            least[i] = if is_top_or_left { 0.0 } else { 1.0 };
            // All of the tile's part of the box on the outer side?
            let reach_x = (step[i][0] * f64::from(right - left)).max(0.0);
            let reach_y = (step[i][1] * f64::from(bottom - top)).max(0.0);
            if at_left[i] + reach_x + reach_y < least[i] {
                return;
            }
        }
        let (ux, uy) = (i64::from(self.x[1] - self.x[0]), i64::from(self.y[1] - self.y[0]));
        let (vx, vy) = (i64::from(self.x[2] - self.x[0]), i64::from(self.y[2] - self.y[0]));
        let inverse = 1.0 / ((ux * vy - uy * vx) as f64);
        let rise = [(self.key[1] - self.key[0]) * inverse, (self.key[2] - self.key[0]) * inverse];

        // Written out edge by edge: what is not inlined here (a closure, `array::map`) would not be
        // compiled for the level.
        let lane = f64x4::simd_from(simd, [0.0, 1.0, 2.0, 3.0]);
        let (lane0, lane1, lane2) = (lane * step[0][0], lane * step[1][0], lane * step[2][0]);
        let run = LANES as f64;
        let run0 = f64x4::splat(simd, run * step[0][0]);
        let run1 = f64x4::splat(simd, run * step[1][0]);
        let run2 = f64x4::splat(simd, run * step[2][0]);
        let zero = f64x4::splat(simd, 0.0);
        let least1 = f64x4::splat(simd, least[1]);
        let least2 = f64x4::splat(simd, least[2]);
        let (rise1, rise2) = (f64x4::splat(simd, rise[0]), f64x4::splat(simd, rise[1]));
        let first_key = f64x4::splat(simd, self.key[0]);
        let (one, nothing) = (f64x4::splat(simd, 1.0), f64x4::splat(simd, f64::INFINITY));
        // Edge functions are whole numbers, so that less their least values they are exact, and one
        // comparison of the smallest of them decides. (A conjunction of masks is a call.)
        for row in top..=bottom {
            let mut e0 = lane0 + f64x4::splat(simd, at_left[0] - least[0]);
            let mut e1 = lane1 + f64x4::splat(simd, at_left[1] - least[1]);
            let mut e2 = lane2 + f64x4::splat(simd, at_left[2] - least[2]);
            let mut at = row * Tile::SIDE as i32 + left;
            let end = row * Tile::SIDE as i32 + right;
            while at <= end {
                let inside = e0.min(e1).min(e2).simd_ge(zero);
                if inside.any_true() {
                    let key = first_key + ((e1 + least1) * rise1 + (e2 + least2) * rise2);
                    let z = if PERSPECTIVE { one / key } else { key };
                    let depth: [f64; LANES] = inside.select(z, nothing).into();
                    batch.push(Fragments { at: at as u32, facing: self.facing, face: self.face, depth }, sink);
                }
                e0 += run0;
                e1 += run1;
                e2 += run2;
                at += LANES as i32;
            }
            for i in 0..3 {
                at_left[i] += step[i][1];
            }
        }
    }
}
