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
    pub(super) fn new(corners: [(i32, i32, f64); 3], face: u32) -> Option<Triangle> {
        let [a, b, c] = corners;
        let [ux, uy, vx, vy] = [b.0 - a.0, b.1 - a.1, c.0 - a.0, c.1 - a.1].map(i64::from);
        let area = ux * vy - uy * vx;
        let (facing, [a, b, c]) = match area {
            0 => return None,
            1.. => (Facing::Back, corners),
            _ => (Facing::Front, [a, c, b]),
        };
        Some(Triangle { x: [a.0, b.0, c.0], y: [a.1, b.1, c.1], key: [a.2, b.2, c.2], face, facing })
    }

    /// The first and last column and row whose pixels' middles are within the triangle's box;
    /// empty if the last is before the first.
    pub(super) fn pixels(&self, fraction: u32) -> [i32; 4] {
        let half = 1 << (fraction - 1);
        let first = |v: [i32; 3]| (v[0].min(v[1]).min(v[2]) + half - 1) >> fraction;
        let last = |v: [i32; 3]| (v[0].max(v[1]).max(v[2]) - half) >> fraction;
        [first(self.x), last(self.x), first(self.y), last(self.y)]
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
        let one = 1i64 << fraction;
        let middle = |pixel: i32| i64::from(pixel) * one + one / 2;
        // Runs start at multiples of their length.
        let left = left & !(LANES as i32 - 1);
        let (px, py) = (middle(x0 + left), middle(y0 + top));

        // Edge i is opposite to corner i.
        let mut at_left = [0.0; 3];
        let mut step = [[0.0; 2]; 3];
        let mut least = [0.0; 3];
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let [ax, ay, bx, by] = [self.x[a], self.y[a], self.x[b], self.y[b]].map(i64::from);
            let (dx, dy) = (bx - ax, by - ay);
            let is_top_or_left = dy < 0 || (dy == 0 && dx > 0);
            at_left[i] = (dx * (py - ay) - dy * (px - ax)) as f64;
            step[i] = [(-dy * one) as f64, (dx * one) as f64];
            least[i] = if is_top_or_left { 0.0 } else { 1.0 };
            // All of the tile's part of the box on the outer side?
            let reach_x = (step[i][0] * f64::from(right - left)).max(0.0);
            let reach_y = (step[i][1] * f64::from(bottom - top)).max(0.0);
            if at_left[i] + reach_x + reach_y < least[i] {
                return;
            }
        }
        let [ux, uy, vx, vy] =
            [self.x[1] - self.x[0], self.y[1] - self.y[0], self.x[2] - self.x[0], self.y[2] - self.y[0]].map(i64::from);
        let inverse = 1.0 / ((ux * vy - uy * vx) as f64);
        let rise = [(self.key[1] - self.key[0]) * inverse, (self.key[2] - self.key[0]) * inverse];

        let splat = |x: f64| f64x4::splat(simd, x);
        let lane = f64x4::simd_from(simd, [0.0, 1.0, 2.0, 3.0]);
        let across = step.map(|s| (lane * s[0], splat(s[0] * LANES as f64)));
        let (first_key, nothing) = (splat(self.key[0]), splat(f64::INFINITY));
        for row in top..=bottom {
            let mut e: [f64x4<S>; 3] = [0, 1, 2].map(|i| across[i].0 + at_left[i]);
            let mut at = (row * Tile::SIDE as i32 + left) as u32;
            for _ in (left..=right).step_by(LANES) {
                let inside = e[0].simd_ge(least[0]) & e[1].simd_ge(least[1]) & e[2].simd_ge(least[2]);
                if inside.any_true() {
                    let key = first_key + (e[1] * rise[0] + e[2] * rise[1]);
                    let z = if PERSPECTIVE { 1.0 / key } else { key };
                    let depth: [f64; LANES] = inside.select(z, nothing).into();
                    batch.push(Fragments { at, facing: self.facing, face: self.face, depth }, sink);
                }
                e = [0, 1, 2].map(|i| e[i] + across[i].1);
                at += LANES as u32;
            }
            for i in 0..3 {
                at_left[i] += step[i][1];
            }
        }
    }
}
