//! How much of the key light and of the sky a point sees.
//!
//! Every point sends a few rays, and its neighbours send others: a block of 4 × 4 pixels uses 16
//! times as many directions. 5 × 5 pixels, those on its border at half weight, have each of them
//! once, so that their mean is as smooth as if every point had sent them all:
//!
//! ```text
//!      ½  1  1  1  ½       pixel (x, y) uses the pattern (x mod 4, y mod 4);
//!      a  b  c  d  a       a at both ends counts once
//! ```
//!
//! Only neighbours of the same piece, about the same normal and the same tangent plane count. Where
//! some do not, beside an edge or in a fillet that is a few pixels wide, the point itself sends the
//! rays of the patterns that are missing: all directions count alike at every pixel.
//!
//! Sources: A. Keller, W. Heidrich, *Interleaved sampling* (2001); M. Roberts, *The unreasonable
//! effectiveness of quasirandom sequences* (2018), for the directions; R. Cook, L. Porter,
//! L. Carpenter, *Distributed ray tracing* (1984).

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3, Vec4};

use super::facets::Facets;
use super::scene::Scene;
use super::settings::RenderSettings;
use super::shade::Visibility;
use super::spot::Spot;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// Rays to each of the two lights, of one pixel: the lanes of a vector.
const RAYS: usize = 4;

/// Patterns, and the order in which a block of 4 × 4 pixels uses them: neighbours differ most.
const PATTERNS: usize = 16;
const ORDER: [usize; PATTERNS] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

/// Pixels that a mean reaches to each side.
pub(super) const REACH: usize = 2;

/// Points along the side of a tile.
pub(super) const TILE: usize = 32;

/// Points whose rays to a light without extent are traced together.
const TOGETHER: usize = 1 << 16;

/// Facets are about so many pixels wide when the solid fills the picture, and there are at least
/// and at most so many along its longest side.
const PIXELS: u32 = 4;
const FEWEST: u32 = 64;
const MOST: u32 = 256;

/// What hides the key light and the sky.
pub(super) struct Obstacles<'a> {
    scene: &'a Scene,
    facets: Arc<Facets>,
    key: DVec3,
    /// Directions to points of the key light, by pattern: a lane a ray. None if it casts no shadow,
    /// or has no extent.
    shadows: Vec<[Vec4; 3]>,
    is_hard: bool,
    /// Directions to the sky, by pattern, z along the normal; none if nothing hides it.
    skies: Vec<[Vec4; 3]>,
    middle: DVec3,
    /// Half the diagonal of the solid's box.
    radius: f64,
}

impl<'a> Obstacles<'a> {
    /// Those of a scene under a light from `key`, if anything is to be hidden.
    pub(super) fn new(
        scene: &'a Scene,
        key: DVec3,
        settings: &RenderSettings,
        run: &Run,
    ) -> Result<Option<Obstacles<'a>>, Cancelled> {
        let RenderSettings { width, height, style, shadows, softness, occlusion, .. } = *settings;
        if !(style.has_shadows() && (shadows || occlusion)) {
            return Ok(None);
        }
        let cells = (width.max(height) / PIXELS).clamp(FEWEST, MOST);
        let Some(facets) = scene.facets(cells, run)? else { return Ok(None) };
        // The R₂ sequence in the unit square, and the disc from it.
        let disc = |i: usize| {
            let at = |step: f64| (0.5 + step * i as f64).fract();
            let radius = at(0.754_877_666_246_693).sqrt();
            DVec2::from_angle(std::f64::consts::TAU * at(0.569_840_290_998_053)) * radius
        };
        let spread = (0.5 * softness).radians().tan();
        let (t, b) = key.any_orthonormal_pair();
        let to_light = |i: usize| {
            let d = spread * disc(i);
            (key + d.x * t + d.y * b).normalize()
        };
        let to_sky = |i: usize| {
            let d = disc(i);
            d.extend((1.0 - d.length_squared()).max(0.0).sqrt().max(0.02)).normalize()
        };
        let has_soft = shadows && spread > 0.0;
        let bounds = scene.bounds();
        Ok(Some(Obstacles {
            scene,
            facets,
            key,
            shadows: if has_soft { patterns(to_light) } else { Vec::new() },
            is_hard: shadows && !has_soft,
            skies: if occlusion { patterns(to_sky) } else { Vec::new() },
            middle: bounds.center(),
            radius: bounds.half_extents().length(),
        }))
    }

    /// Whether the edges of shadows are hard.
    pub(super) fn is_hard(&self) -> bool {
        self.is_hard
    }

    /// What the points of some rows of a picture see, whose first row is `top`: the mean of those
    /// about each of them. `pixel` tells how large a pixel is at a distance.
    pub(super) fn smoothed(
        &self,
        spots: &[Spot],
        (width, top): (usize, usize),
        pixel: impl Fn(f64) -> f64 + Sync,
        run: &Run,
    ) -> Result<Vec<Visibility>, Cancelled> {
        let [to_see, to_smooth] = run.stages([0.7, 0.3]);
        let own = self.seen(spots, width, |at| number(at % width, top + at / width), &to_see)?;
        let rows = Rows { spots, seen: &own, width, top };
        let mut means = rows.smoothed(pixel, |spot, pattern| self.open(spot, ORDER[pattern]), &to_smooth)?;
        if self.is_hard() {
            // The edges of a light without extent stay as they are.
            means.iter_mut().zip(&own).for_each(|(mean, own)| mean.key = own.key);
        }
        Ok(means)
    }

    /// What each point sees by its own rays; `pattern` gives a number for the point at an index.
    /// They go tile by tile of a picture with rows of `width`, as neighbours meet the same facets.
    pub(super) fn seen(
        &self,
        spots: &[Spot],
        width: usize,
        pattern: impl Fn(usize) -> usize + Sync,
        run: &Run,
    ) -> Result<Vec<Visibility>, Cancelled> {
        let across = width.div_ceil(TILE).max(1);
        let down = spots.len().div_ceil(TILE * width.max(1));
        // By the number of a tile: the runs of places in its rows.
        let runs = |tile: usize| {
            let (top, left) = (tile / across * TILE, tile % across * TILE);
            let run = move |row: usize| {
                (row * width + left).min(spots.len())..(row * width + width.min(left + TILE)).min(spots.len())
            };
            (top..top + TILE).map(run)
        };
        let open = |at: usize| self.open(&spots[at], ORDER[pattern(at) % PATTERNS]);
        let [to_gather, to_trace] = run.stages(if self.is_hard() { [0.5, 0.5] } else { [1.0, 0.0] });
        let meter = Meter::new(&to_gather, across * down);
        let tiles: Result<Vec<Vec<Visibility>>, Cancelled> = jobs::try_in_order(across * down, |tile| {
            meter.check()?;
            let found = runs(tile).flatten().map(open).collect();
            meter.add(1);
            Ok(found)
        });
        let tiles = tiles?;
        let mut seen = vec![Visibility::FULL; spots.len()];
        for (tile, found) in tiles.iter().enumerate() {
            let mut rest = &found[..];
            for run in runs(tile) {
                let (row, after) = rest.split_at(run.len());
                seen[run].copy_from_slice(row);
                rest = after;
            }
        }
        if self.is_hard() {
            let chunks = spots.len().div_ceil(TOGETHER);
            for (n, (chunk, seen)) in spots.chunks(TOGETHER).zip(seen.chunks_mut(TOGETHER)).enumerate() {
                let part = |n: usize| n as f64 / chunks as f64;
                self.hard(chunk, seen, &to_trace.stage(part(n), part(n + 1)))?;
            }
        }
        Ok(seen)
    }

    /// What a point sees by its own rays to facets.
    fn open(&self, spot: &Spot, pattern: usize) -> Visibility {
        let share = self.share(spot);
        if share == 0.0 {
            return Visibility::FULL;
        }
        let origin = self.start(spot);
        let mut open = Visibility::FULL;
        if let Some(directions) = self.shadows.get(pattern) {
            // What faces away from a part of the light is dark there by its slope.
            let [x, y, z] = directions;
            let asked = (x * spot.normal.x + y * spot.normal.y + z * spot.normal.z).cmpgt(Vec4::ZERO).bitmask();
            if asked != 0 {
                let hits = self.facets.hits(origin, directions, asked);
                let hidden = hits.iter().filter(|distance| distance.is_finite()).count();
                open.key = 1.0 - share * hidden as f32 / asked.count_ones() as f32;
            }
        }
        if let Some([x, y, up]) = self.skies.get(pattern) {
            let n = spot.normal;
            let (t, b) = across(n);
            let directions = [x * t.x + y * b.x + up * n.x, x * t.y + y * b.y + up * n.y, x * t.z + y * b.z + up * n.z];
            // What is far away hides less of the sky: light comes in from its sides.
            let hits = self.facets.hits(origin, &directions, (1 << RAYS) - 1);
            let near = hits.iter().filter(|distance| distance.is_finite());
            let hidden: f64 = near.map(|distance| (-distance / (1.2 * self.radius)).exp()).sum();
            open.sky = 1.0 - share * hidden as f32 / RAYS as f32;
        }
        open
    }

    /// Of a light without extent, whose shadows' edges would show the facets, the first hits in
    /// the scene decide.
    fn hard(&self, spots: &[Spot], seen: &mut [Visibility], run: &Run) -> Result<(), Cancelled> {
        let lit = |spot: &Spot| self.share(spot) > 0.0 && self.key.dot(spot.normal.as_dvec3()) > 0.0;
        let asked: Vec<usize> = (0..spots.len()).filter(|&i| lit(&spots[i])).collect();
        let rays: Vec<(DVec3, DVec3)> = asked.iter().map(|&i| (self.start(&spots[i]), self.key)).collect();
        for (&i, hit) in asked.iter().zip(self.scene.hits(&rays, run)?) {
            if hit.is_hit() {
                seen[i].key = 1.0 - self.share(&spots[i]);
            }
        }
        Ok(())
    }

    /// The ray epsilon off the surface.
    fn start(&self, spot: &Spot) -> DVec3 {
        spot.point + self.scene.ray_epsilon() * spot.normal.as_dvec3()
    }

    /// How much of what hides light counts at a spot.
    fn share(&self, spot: &Spot) -> f32 {
        if spot.is_ground() {
            // Far out on the ground, shadows are let fade.
            let away = spot.point.distance(self.middle) / self.radius;
            return ((3.2 - away) / 1.6).clamp(0.0, 1.0) as f32;
        }
        // From inside the solid all light is hidden; its walls are lit as if none was.
        if spot.is_solid() && spot.is_front() { 1.0 } else { 0.0 }
    }
}

/// Two unit vectors at right angles to a normal and to each other, which turn steadily with it: the
/// patterns of neighbours in a fillet would not complete each other otherwise. They jump where the
/// normal is along one direction, which no face of a part is likely to have.
fn across(normal: Vec3) -> (Vec3, Vec3) {
    const UNLIKELY: Vec3 = Vec3::new(0.31, -0.57, 0.76);
    let first = normal.cross(UNLIKELY).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    (first, normal.cross(first))
}

/// The directions of each pattern, those of one pattern far apart in their sequence: their
/// components.
fn patterns(direction: impl Fn(usize) -> DVec3) -> Vec<[Vec4; 3]> {
    let lanes = |pattern: usize| [0, 1, 2, 3].map(|ray| direction(pattern + PATTERNS * ray).as_vec3());
    (0..PATTERNS).map(|pattern| [0, 1, 2].map(|axis| Vec4::from_array(lanes(pattern).map(|d| d[axis])))).collect()
}

/// The weights of the pixels that a mean reaches along a row or a column.
const WEIGHTS: [f32; 2 * REACH + 1] = [0.5, 1.0, 1.0, 1.0, 0.5];

/// The number of the pattern that a pixel uses.
#[inline]
fn number(x: usize, y: usize) -> usize {
    x % 4 + 4 * (y % 4)
}

/// The points of some rows of a picture, from row `top` on, and what each sees by its own rays.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub(super) spots: &'a [Spot],
    pub(super) seen: &'a [Visibility],
    pub(super) width: usize,
    pub(super) top: usize,
}

impl Rows<'_> {
    /// The mean of what the points see; `trace` tells what one sees by the rays of a pattern, and
    /// `pixel` how large a pixel is at a distance.
    fn smoothed(
        &self,
        pixel: impl Fn(f64) -> f64 + Sync,
        trace: impl Fn(&Spot, usize) -> Visibility + Sync,
        run: &Run,
    ) -> Result<Vec<Visibility>, Cancelled> {
        let Rows { spots, seen, width, .. } = *self;
        let calm = calm(seen, width);
        let mut means = vec![Visibility::FULL; spots.len()];
        jobs::try_chunks_mut(&mut means, width, |y, row| {
            run.check()?;
            for (x, mean) in row.iter_mut().enumerate() {
                let own = &spots[y * width + x];
                if (own.is_solid() || own.is_ground()) && !self.reached(y).all(|row| calm[row * width + x]) {
                    *mean = self.mean(x, y, 4.0 * pixel(own.distance), &trace);
                }
            }
            Ok(())
        })?;
        Ok(means)
    }

    /// The rows that a mean reaches.
    fn reached(&self, y: usize) -> std::ops::Range<usize> {
        y.saturating_sub(REACH)..(y + REACH + 1).min(self.spots.len() / self.width)
    }

    /// The mean over all patterns, each of them at the points about one that are on the same face
    /// and use it, or, if none does, at the point itself. Points farther than `near` from its
    /// tangent plane are not on its face.
    #[inline]
    fn mean(&self, x: usize, y: usize, near: f64, trace: &impl Fn(&Spot, usize) -> Visibility) -> Visibility {
        let place = y * self.width + x;
        let own = &self.spots[place];
        let is_ground = own.is_ground();
        let (left, right) = (x.saturating_sub(REACH), (x + REACH + 1).min(self.width));
        // Key, sky and weight of each pattern.
        let mut sums = [[0.0f32; 3]; PATTERNS];
        let mut counted = false;
        for row in self.reached(y) {
            let down = WEIGHTS[row + REACH - y];
            for column in left..right {
                let at = row * self.width + column;
                let other = &self.spots[at];
                let counts = if is_ground {
                    other.is_ground()
                } else {
                    other.is_solid() && own.normal.dot(other.normal) > 0.9 && own.steps(other) <= near
                };
                if counts {
                    counted = true;
                    let Visibility { key, sky } = self.seen[at];
                    let weight = down * WEIGHTS[column + REACH - x];
                    let sum = &mut sums[number(column, self.top + row)];
                    *sum = [sum[0] + weight * key, sum[1] + weight * sky, sum[2] + weight];
                }
            }
        }
        if !counted {
            // What counts not even itself has no normal.
            return self.seen[place];
        }
        let (mut key, mut sky) = (0.0, 0.0);
        for (pattern, [own_key, own_sky, weight]) in sums.into_iter().enumerate() {
            if weight > 0.0 {
                key += own_key / weight;
                sky += own_sky / weight;
            } else {
                let missing = trace(own, pattern);
                key += missing.key;
                sky += missing.sky;
            }
        }
        Visibility { key: key / PATTERNS as f32, sky: sky / PATTERNS as f32 }
    }
}

/// By point, whether nothing is hidden from any of those of its row that the mean reaches.
fn calm(seen: &[Visibility], width: usize) -> Vec<bool> {
    let mut calm = vec![false; seen.len()];
    jobs::for_chunks_mut(&mut calm, width, |row, calm| {
        let seen = &seen[row * width..][..calm.len()];
        // How many are free up to here; there is nothing to hide beyond the row.
        let mut free = REACH;
        for x in 0..width + REACH {
            free = if seen.get(x).is_none_or(|seen| *seen == Visibility::FULL) { free + 1 } else { 0 };
            if x >= REACH {
                calm[x - REACH] = free > 2 * REACH;
            }
        }
    });
    calm
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::render::gbuffer::Surface;

    /// Two walls at an angle, and what their points see of light: another number each.
    fn corner(width: usize, height: usize) -> (Vec<Spot>, Vec<Visibility>) {
        let spot = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let slope = if x > y { 0.0 } else { 1.0 };
            let surface = Surface {
                distance: 10.0 + slope * (x - y),
                normal: DVec3::new(-slope, slope, 1.0).normalize().as_vec3(),
                owner: 0,
            };
            Spot::new(DVec3::new(x, y, 20.0), -DVec3::Z, &surface, None)
        };
        let seen = |i: usize| Visibility { key: (0.37 * i as f32).fract(), sky: (0.61 * i as f32).fract() };
        ((0..width * height).map(spot).collect(), (0..width * height).map(seen).collect())
    }

    #[test]
    fn rows_are_those_of_the_whole() {
        let (width, height) = (24, 60);
        let (spots, seen) = corner(width, height);
        let trace = |spot: &Spot, pattern: usize| Visibility { key: spot.normal.x + pattern as f32, sky: 0.3 };
        let smoothed = |first: usize, last: usize| {
            let (from, to) = (first * width, last * width);
            let rows = Rows { spots: &spots[from..to], seen: &seen[from..to], width, top: first };
            rows.smoothed(|_| 1.0, trace, &Run::default()).unwrap()
        };
        let whole = smoothed(0, height);
        for (from, to) in [(0, 20), (20, 40), (11, 19), (40, 60)] {
            let (first, last) = (from.max(REACH) - REACH, (to + REACH).min(height));
            let part = smoothed(first, last);
            assert_eq!(part[(from - first) * width..(to - first) * width], whole[from * width..to * width]);
        }
    }

    /// Rounding about the horizontal turns nothing round.
    #[test]
    fn directions_turn_steadily_with_the_normal() {
        for i in 0..64u8 {
            let [(t, b), (other, _)] = [1e-5f32, -1e-5].map(|z| across(Vec2::from_angle(0.1 * f32::from(i)).extend(z)));
            let n = Vec2::from_angle(0.1 * f32::from(i)).extend(0.0);
            assert!((t.length() - 1.0).abs() < 1e-5 && (b.length() - 1.0).abs() < 1e-4 && t.dot(b).abs() < 1e-5);
            assert!(t.dot(n).abs() < 1e-4 && t.distance(other) < 1e-3, "{n}: {t} {other}");
        }
    }

    /// Where each pattern sees another share of light, every pixel beside an edge sees the same.
    #[test]
    fn all_patterns_count_alike_beside_an_edge() {
        let (width, height) = (24, 24);
        let (spots, _) = corner(width, height);
        let of_pattern = |pattern: usize| Visibility { key: 1.0, sky: ORDER[pattern] as f32 / 16.0 };
        let seen: Vec<Visibility> = (0..width * height).map(|at| of_pattern(number(at % width, at / width))).collect();
        let rows = Rows { spots: &spots, seen: &seen, width, top: 0 };
        let means = rows.smoothed(|_| 1.0, |_, pattern| of_pattern(pattern), &Run::default()).unwrap();
        let sky = (0..PATTERNS).map(|pattern| of_pattern(pattern).sky).sum::<f32>() / PATTERNS as f32;
        assert!(means.iter().all(|mean| (mean.sky - sky).abs() < 1e-6 && (mean.key - 1.0).abs() < 1e-6));
    }
}
