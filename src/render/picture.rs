//! Pixels: what each sees, the light there, and more rays where neighbours show different things.
//!
//! ```text
//!   rays of a band of rows --> spots --> openness (shadow and sky rays, smoothed)
//!                               |            |
//!                               v            v
//!   pixels at edges: n² rays --> spots --> shaded --> mean
//! ```
//!
//! A picture is made in bands of rows. Each looks at a few rows above and below it as well, so
//! that the result does not depend on how it is divided, nor on the number of threads.
//!
//! A ray inside an edge pixel has the openness of the best match among the nine pixels about it;
//! without a match it sends shadow and sky rays of its own.

use glam::{DVec3, Vec4};
use rayon::prelude::*;

use super::gbuffer::Window;
use super::lines::Lines;
use super::openness::{Obstacles, REACH, smoothed};
use super::scene::Scene;
use super::settings::{RenderSettings, Style};
use super::shade::{Material, Openness, Studio};
use super::spot::Spot;
use crate::{Cancelled, Palette, Rays, Run};

/// Pixels of a band, about: some tens of megabytes.
const BAND: u32 = 1 << 19;

/// Shares of the key light that differ by more show the edge of a hard shadow.
const SHADOW_EDGE: f32 = 0.3;

/// All that a picture needs.
pub(super) struct Picture<'a> {
    pub(super) scene: &'a Scene,
    pub(super) studio: Studio,
    pub(super) rays: Rays,
    pub(super) settings: &'a RenderSettings,
    /// The paint of parts, if any is painted.
    pub(super) palette: Option<Palette>,
    /// The height of the ground.
    pub(super) ground: Option<f64>,
    /// What hides light, where anything does.
    pub(super) obstacles: Option<Obstacles<'a>>,
}

/// A band of rows with those around it that it depends on.
struct Band {
    /// The first row of the picture that it holds.
    top: u32,
    width: u32,
    spots: Vec<Spot>,
    open: Vec<Openness>,
}

impl Band {
    /// The place of a pixel of the picture.
    fn place(&self, x: u32, y: u32) -> usize {
        ((y - self.top) * self.width + x) as usize
    }

    fn end(&self) -> u32 {
        self.top + self.spots.len() as u32 / self.width
    }
}

/// Pixels with more than one ray, and these rays.
#[derive(Default)]
pub(super) struct Fine {
    /// By pixel of the band: its number here, or `u32::MAX`.
    pub(super) numbers: Vec<u32>,
    /// n² for each, row by row.
    pub(super) spots: Vec<Spot>,
}

impl Picture<'_> {
    /// All pixels, row by row from the top: linear light, weighted by alpha.
    pub(super) fn pixels(&self, run: &Run) -> Result<Vec<[f32; 4]>, Cancelled> {
        let RenderSettings { width, height, .. } = *self.settings;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        self.bands(run, |band| {
            pixels.extend(band);
            Ok(())
        })?;
        Ok(pixels)
    }

    /// The same, some rows at a time.
    pub(super) fn bands<E: From<Cancelled>>(
        &self,
        run: &Run,
        mut take: impl FnMut(Vec<[f32; 4]>) -> Result<(), E>,
    ) -> Result<(), E> {
        let RenderSettings { width, height, .. } = *self.settings;
        let rows = (BAND / width).clamp(16, height.max(16));
        let mut top = 0;
        while top < height {
            let end = (top + rows).min(height);
            let part = |row: u32| f64::from(row) / f64::from(height);
            take(self.band(top, end, &run.stage(part(top), part(end)))?)?;
            top = end;
        }
        run.report(1.0);
        Ok(())
    }

    /// The rows from `top` to `end`.
    fn band(&self, top: u32, end: u32, run: &Run) -> Result<Vec<[f32; 4]>, Cancelled> {
        let RenderSettings { width, height, style, .. } = *self.settings;
        // One pixel for the comparison with neighbours, and what the mean and the lines reach.
        let halo = 1 + (REACH as u32).max(if style == Style::Technical { Lines::reach(height) } else { 0 });
        let (first, last) = (top.saturating_sub(halo), (end + halo).min(height));
        let window = Window { top: first, height: last - first, ..Window::whole(width, height) };
        let seen = self.scene.surfaces_with(&self.rays, window, &run.stage(0.0, 0.4))?;
        let spots: Vec<Spot> = seen
            .surfaces()
            .par_iter()
            .enumerate()
            .map(|(i, surface)| {
                let (x, y) = (i as u32 % width, first + i as u32 / width);
                let (origin, direction) = self.rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
                Spot::new(origin, direction, surface, self.ground)
            })
            .collect();
        drop(seen);
        run.check()?;
        let obstacles = self.obstacles.as_ref();
        let open = match obstacles {
            None => vec![Openness::FULL; spots.len()],
            Some(obstacles) => {
                let pattern = |i: usize| (i % width as usize) % 4 + 4 * ((first as usize + i / width as usize) % 4);
                let own = obstacles.seen(&spots, pattern);
                let sharp = obstacles.is_hard().then(|| own.clone());
                let mut open = smoothed(&spots, &own, width as usize, |t| self.rays.pixel_size(t));
                // The edges of a light without extent stay as they are.
                for (open, own) in open.iter_mut().zip(sharp.iter().flatten()) {
                    open.key = own.key;
                }
                open
            }
        };
        run.check()?;
        run.report(0.7);
        let band = Band { top: first, width, spots, open };
        let fine = self.fine(&band, top, end, obstacles);
        run.check()?;
        run.report(0.85);
        let light = self.fine_light(&band, &fine, obstacles);
        run.check()?;
        let n2 = (self.settings.samples * self.settings.samples) as usize;
        let lines = (style == Style::Technical).then(|| Lines {
            height,
            samples: self.settings.samples,
            width,
            spots: &band.spots,
            fine: &fine,
            pixel: &self.rays,
        });
        let pixels = (top..end).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| {
            let at = band.place(x, y);
            let mut light = match fine.numbers[at] {
                u32::MAX => self.shade(&band.spots[at], band.open[at], f64::from(y) + 0.5),
                number => {
                    let own = &light[number as usize * n2..][..n2];
                    own.iter().copied().sum::<Vec4>() / n2 as f32
                }
            };
            if let Some(lines) = &lines {
                light = lines.drawn(light, at);
            }
            light.to_array()
        });
        let pixels = pixels.collect();
        run.report(1.0);
        Ok(pixels)
    }

    /// The pixels at edges, and what their rays meet.
    ///
    /// Rows and columns of the rays are sheared, so that no two of the n² are at the same height
    /// or side: an outline near the horizontal or vertical passes them one by one.
    fn fine(&self, band: &Band, top: u32, end: u32, obstacles: Option<&Obstacles<'_>>) -> Fine {
        let RenderSettings { samples, width, height, style, .. } = *self.settings;
        let mut numbers = vec![u32::MAX; band.spots.len()];
        if samples < 2 {
            return Fine { numbers, spots: Vec::new() };
        }
        let hard = obstacles.is_some_and(Obstacles::is_hard);
        let differ = |a: usize, b: usize| {
            let (one, other) = (&band.spots[a], &band.spots[b]);
            let pixel = self.rays.pixel_size(one.distance.min(other.distance));
            one.differs(other, pixel) || hard && (band.open[a].key - band.open[b].key).abs() > SHADOW_EDGE
        };
        // Lines are wider than a pixel: what is about an edge is sampled more often as well.
        let reach = if style == Style::Technical { Lines::reach(height) } else { 0 };
        let (first, last) = (top.saturating_sub(reach).max(band.top), (end + reach).min(band.end()));
        let edges: Vec<(u32, u32)> = (first..last)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| (x, y)))
            .filter(|&(x, y)| {
                let at = band.place(x, y);
                x > 0 && differ(at, at - 1)
                    || x + 1 < width && differ(at, at + 1)
                    || y > band.top && differ(at, at - width as usize)
                    || y + 1 < band.end() && differ(at, at + width as usize)
            })
            .collect();
        let mut pixels = Vec::new();
        for (x, y) in edges {
            for y in y.saturating_sub(reach).max(first)..=(y + reach).min(last - 1) {
                for x in x.saturating_sub(reach)..=(x + reach).min(width - 1) {
                    let number = &mut numbers[band.place(x, y)];
                    if *number == u32::MAX {
                        *number = pixels.len() as u32;
                        pixels.push((x, y));
                    }
                }
            }
        }
        let n = samples;
        let within = |i: u32, j: u32| (f64::from(i) + (f64::from(j) + 0.5) / f64::from(n)) / f64::from(n);
        let rays: Vec<(DVec3, DVec3)> = pixels
            .par_iter()
            .flat_map_iter(|&(x, y)| {
                (0..n * n).map(move |k| {
                    let (i, j) = (k % n, k / n);
                    self.rays.ray(f64::from(x) + within(i, j), f64::from(y) + within(j, i))
                })
            })
            .collect();
        let hits = self.scene.first_hits(&rays);
        let spots = rays.iter().zip(&hits).map(|(ray, hit)| Spot::new(ray.0, ray.1, hit, self.ground)).collect();
        Fine { numbers, spots }
    }

    /// The light along each fine ray.
    fn fine_light(&self, band: &Band, fine: &Fine, obstacles: Option<&Obstacles<'_>>) -> Vec<Vec4> {
        let n = self.settings.samples;
        let n2 = (n * n) as usize;
        let mut places = vec![0; fine.spots.len() / n2];
        for (place, number) in fine.numbers.iter().enumerate() {
            if *number != u32::MAX {
                places[*number as usize] = place;
            }
        }
        let hard = obstacles.is_some_and(Obstacles::is_hard);
        let matched: Vec<Option<Openness>> = fine
            .spots
            .par_iter()
            .enumerate()
            .map(|(k, spot)| match obstacles {
                None => Some(Openness::FULL),
                Some(_) => self.matching(band, spot, places[k / n2], hard),
            })
            .collect();
        let alone: Vec<usize> = (0..matched.len()).filter(|k| matched[*k].is_none()).collect();
        let spots: Vec<Spot> = alone.iter().map(|k| fine.spots[*k]).collect();
        let mut open: Vec<Openness> = matched.iter().map(|open| open.unwrap_or(Openness::FULL)).collect();
        if let Some(obstacles) = obstacles {
            for (k, seen) in alone.iter().zip(obstacles.seen(&spots, |i| alone[i])) {
                open[*k] = seen;
            }
        }
        let row = |place: usize| f64::from(band.top + place as u32 / band.width);
        let shade = |(k, spot): (usize, &Spot)| {
            let down = (k % n2) as u32 / n;
            let y = row(places[k / n2]) + (f64::from(down) + 0.5) / f64::from(n);
            self.shade(spot, open[k], y)
        };
        fine.spots.par_iter().enumerate().map(shade).collect()
    }

    /// The openness of a spot, from the pixel at `place` and those about it; none if none of
    /// them is on the same face.
    fn matching(&self, band: &Band, spot: &Spot, place: usize, hard: bool) -> Option<Openness> {
        if !spot.is_solid() && !spot.is_ground() {
            return Some(Openness::FULL);
        }
        let width = band.width as usize;
        let (x, y) = (place % width, place / width);
        let near = 2.0 * self.rays.pixel_size(spot.distance);
        let mut best: Option<(f64, Openness)> = None;
        let mut edge = (1.0f32, 0.0f32);
        for y in y.saturating_sub(1)..=(y + 1).min(band.spots.len() / width - 1) {
            for x in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                let at = y * width + x;
                let other = &band.spots[at];
                let fits = spot.same_piece(other)
                    && spot.normal.dot(other.normal) > 0.9
                    && (spot.is_ground() || spot.steps(other) < near);
                if fits {
                    let open = band.open[at];
                    edge = (edge.0.min(open.key), edge.1.max(open.key));
                    let away = spot.point.distance_squared(other.point);
                    if best.is_none_or(|(least, _)| away < least) {
                        best = Some((away, open));
                    }
                }
            }
        }
        // On either side of a hard shadow's edge only a ray of its own can tell.
        if hard && edge.1 - edge.0 > SHADOW_EDGE {
            return None;
        }
        best.map(|(_, open)| open)
    }

    /// What a spot looks like, in row `y` of the picture.
    fn shade(&self, spot: &Spot, open: Openness, y: f64) -> Vec4 {
        if !spot.is_solid() {
            let background = self.studio.background(y / f64::from(self.settings.height));
            return if spot.is_ground() { self.studio.ground(background, open) } else { background };
        }
        self.studio.surface(spot.normal, spot.outward, spot.viewer, &self.material(spot), open)
    }

    fn material(&self, spot: &Spot) -> Material {
        let own = self.palette.as_ref().and_then(|p| p.mixture(spot.owner, spot.point, self.settings.paint));
        self.studio.material(own.unwrap_or(self.settings.paint), own.is_some())
    }
}
