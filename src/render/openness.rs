//! How much of the key light and of the sky a point sees.
//!
//! Every point sends a few rays, and its neighbours send others: a block of 4 × 4 pixels uses 16
//! times as many directions. The mean over 5 × 5 pixels, those on its border at half weight,
//! has each of them once, so that the result is as smooth as if every point had sent them all:
//!
//! ```text
//!      ½  1  1  1  ½       pixel (x, y) uses the pattern (x mod 4, y mod 4);
//!      a  b  c  d  a       a at both ends counts once
//! ```
//!
//! Only neighbours of the same piece, about the same normal and the same tangent plane count.
//!
//! Sources: A. Keller, W. Heidrich, *Interleaved sampling* (2001); M. Roberts, *The unreasonable
//! effectiveness of quasirandom sequences* (2018), for the directions; R. Cook, L. Porter,
//! L. Carpenter, *Distributed ray tracing* (1984).

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::scene::Scene;
use super::shade::Openness;
use super::spot::Spot;

/// Rays to each of the two lights, of one pixel.
const RAYS: usize = 4;

/// Patterns, and the order in which a block of 4 × 4 pixels uses them: neighbours differ most.
const PATTERNS: usize = 16;
const ORDER: [usize; PATTERNS] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

/// Pixels that the mean reaches to each side.
pub(super) const REACH: usize = 2;

/// Points whose rays are traced together.
const TOGETHER: usize = 1 << 14;

/// What hides the key light and the sky.
pub(super) struct Obstacles<'a> {
    scene: &'a Scene,
    key: DVec3,
    /// Directions to points of the key light, relative to its middle, by pattern; none if it
    /// casts no shadow.
    shadows: Vec<DVec2>,
    /// Directions to the sky, relative to the normal, by pattern; none if nothing hides it.
    skies: Vec<DVec2>,
    middle: DVec3,
    /// Half the diagonal of the solid's box.
    radius: f64,
}

/// A request for a ray.
#[derive(Clone, Copy)]
struct Ask {
    spot: u32,
    sky: bool,
}

impl<'a> Obstacles<'a> {
    /// Those of a scene; `softness` is half the angle that the light appears under.
    pub(super) fn new(scene: &'a Scene, key: DVec3, shadows: bool, softness: f64, occlusion: bool) -> Obstacles<'a> {
        // The R₂ sequence in the unit square, and the disc from it.
        let disc = |i: usize| {
            let at = |step: f64| (0.5 + step * i as f64).fract();
            let radius = at(0.754_877_666_246_693).sqrt();
            DVec2::from_angle(std::f64::consts::TAU * at(0.569_840_290_998_053)) * radius
        };
        let spread = softness.to_radians().tan();
        let count = PATTERNS * RAYS;
        // A light without extent needs one ray, the same for every pixel.
        let shadow_count = if !shadows {
            0
        } else if spread == 0.0 {
            1
        } else {
            count
        };
        let bounds = scene.bounds();
        Obstacles {
            scene,
            key,
            shadows: (0..shadow_count).map(|i| spread * disc(i)).collect(),
            skies: (0..if occlusion { count } else { 0 }).map(disc).collect(),
            middle: bounds.center(),
            radius: bounds.half_extents().length(),
        }
    }

    /// Whether the edges of shadows are hard.
    pub(super) fn is_hard(&self) -> bool {
        self.shadows.len() == 1
    }

    /// What each point sees by its own rays; `pattern` gives a number for the point at an index.
    pub(super) fn seen(&self, spots: &[Spot], pattern: impl Fn(usize) -> usize + Sync) -> Vec<Openness> {
        let mut seen = vec![Openness::FULL; spots.len()];
        if self.shadows.is_empty() && self.skies.is_empty() {
            return seen;
        }
        for (chunk, seen) in seen.chunks_mut(TOGETHER).enumerate() {
            let first = chunk * TOGETHER;
            let spots = &spots[first..first + seen.len()];
            self.trace(spots, |i| pattern(first + i), seen);
        }
        seen
    }

    fn trace(&self, spots: &[Spot], pattern: impl Fn(usize) -> usize + Sync, seen: &mut [Openness]) {
        let wanted: Vec<Vec<(Ask, (DVec3, DVec3))>> = spots
            .par_iter()
            .enumerate()
            .map(|(i, spot)| self.rays(spot, i as u32, ORDER[pattern(i) % PATTERNS]))
            .collect();
        // Rays to one light side by side: they take the same way through space.
        let (keys, skies): (Vec<_>, Vec<_>) = wanted.into_iter().flatten().partition(|(ask, _)| !ask.sky);
        let (asks, rays): (Vec<Ask>, Vec<(DVec3, DVec3)>) = keys.into_iter().chain(skies).unzip();
        let hits = self.scene.first_hits(&rays);
        let mut counts = vec![[0u32; 2]; spots.len()];
        let mut hidden = vec![[0.0f32; 2]; spots.len()];
        for (ask, hit) in asks.iter().zip(&hits) {
            let (spot, kind) = (ask.spot as usize, usize::from(ask.sky));
            counts[spot][kind] += 1;
            if hit.is_hit() {
                // What is far away hides less of the sky: light comes in from its sides.
                let share = if ask.sky { (-hit.distance / (1.2 * self.radius)).exp() as f32 } else { 1.0 };
                hidden[spot][kind] += share;
            }
        }
        for (((seen, counts), hidden), spot) in seen.iter_mut().zip(counts).zip(hidden).zip(spots) {
            let open = |kind: usize| if counts[kind] == 0 { 1.0 } else { 1.0 - hidden[kind] / counts[kind] as f32 };
            // Far out on the ground, shadows are let fade.
            let near = if spot.is_ground() { self.nearness(spot.point) as f32 } else { 1.0 };
            let open = |kind: usize| 1.0 - near * (1.0 - open(kind));
            *seen = Openness { key: open(0), sky: open(1) };
        }
    }

    /// 1 near the solid, 0 where its shadows are not drawn.
    fn nearness(&self, p: DVec3) -> f64 {
        let away = p.distance(self.middle) / self.radius;
        ((3.2 - away) / 1.6).clamp(0.0, 1.0)
    }

    fn rays(&self, spot: &Spot, number: u32, pattern: usize) -> Vec<(Ask, (DVec3, DVec3))> {
        // From inside the solid all light is hidden; its walls are lit as if none was.
        let visible = spot.is_solid() && spot.is_front() || spot.is_ground() && self.nearness(spot.point) > 0.0;
        if !visible {
            return Vec::new();
        }
        let mut rays = Vec::with_capacity(2 * RAYS);
        let origin = spot.point + self.scene.hair() * spot.normal;
        if !self.shadows.is_empty() {
            let (t, b) = self.key.any_orthonormal_pair();
            // The only direction of a light without extent is everyone's.
            let first = if self.is_hard() { 0 } else { pattern };
            for d in self.shadows.iter().skip(first).step_by(PATTERNS) {
                let direction = (self.key + d.x * t + d.y * b).normalize();
                // What faces away from a part of the light is dark there by its slope.
                if direction.dot(spot.normal) > 0.0 {
                    rays.push((Ask { spot: number, sky: false }, (origin, direction)));
                }
            }
        }
        if !self.skies.is_empty() {
            let (t, b) = spot.normal.any_orthonormal_pair();
            for d in self.skies.iter().skip(pattern).step_by(PATTERNS) {
                let up = (1.0 - d.length_squared()).max(0.0).sqrt().max(0.02);
                let direction = (up * spot.normal + d.x * t + d.y * b).normalize();
                rays.push((Ask { spot: number, sky: true }, (origin, direction)));
            }
        }
        rays
    }
}

/// The mean of what the points of a picture see: `width` of them a row.
pub(super) fn smoothed(
    spots: &[Spot],
    seen: &[Openness],
    width: usize,
    pixel: impl Fn(f64) -> f64 + Sync,
) -> Vec<Openness> {
    let height = spots.len() / width;
    let reach = REACH as isize;
    let weight = |d: isize| if d.abs() == reach { 0.5f32 } else { 1.0 };
    let mut mean = vec![Openness::FULL; spots.len()];
    mean.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, mean) in row.iter_mut().enumerate() {
            let own = &spots[y * width + x];
            if !own.is_solid() && !own.is_ground() {
                continue;
            }
            let near = 2.0 * pixel(own.distance);
            let (mut key, mut sky, mut sum) = (0.0, 0.0, 0.0);
            for dy in -reach..=reach {
                for dx in -reach..=reach {
                    let (Some(x), Some(y)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else { continue };
                    if x >= width || y >= height {
                        continue;
                    }
                    let at = y * width + x;
                    let other = &spots[at];
                    let counts = (dx, dy) == (0, 0)
                        || own.same_piece(other)
                            && own.normal.dot(other.normal) > 0.9
                            && (own.is_ground() || own.steps(other) < near * 2.0);
                    if counts {
                        let w = weight(dx) * weight(dy);
                        key += w * seen[at].key;
                        sky += w * seen[at].sky;
                        sum += w;
                    }
                }
            }
            *mean = Openness { key: key / sum, sky: sky / sum };
        }
    });
    mean
}
