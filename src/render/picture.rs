//! Pixels: what each sees, the light there, and more rays where neighbours show different things.
//!
//! ```text
//!   rays of a band of rows --> spots --> visibility (shadow and sky rays, smoothed)
//!                               |            |
//!                               v            v
//!   pixels at edges: n² rays --> spots --> shaded --> mean
//! ```
//!
//! A picture is made in bands of rows. Each looks at a few rows above and below it as well, so
//! that the result does not depend on how it is divided, nor on the number of threads.
//!
//! A ray inside an edge pixel has the visibility of the best match among the nine pixels about it;
//! without a match it sends shadow and sky rays of its own.

use glam::{DVec3, Vec4};
use rayon::prelude::*;

use super::draft::Draft;
use super::gbuffer::{Surface, Window};
use super::lines::Lines;
use super::materials::Materials;
use super::occlusion::{Obstacles, REACH, TILE};
use super::scene::Scene;
use super::settings::{RenderSettings, Style};
use super::shade::{Studio, Visibility};
use super::spot::Spot;
use crate::{Cancelled, Rays, Run};
use rvachev_num::{Meter, jobs};

/// Pixels of a band, about: some tens of megabytes.
const BAND: u32 = 1 << 19;

/// Shares of the key light that differ by more show the edge of a hard shadow.
const SHADOW_EDGE: f32 = 0.3;

/// All that a picture needs.
pub(super) struct Picture<'a> {
    pub(super) scene: &'a Scene,
    /// What is drawn in place of the scene.
    pub(super) draft: Option<Draft<'a>>,
    pub(super) studio: Studio,
    pub(super) rays: Rays,
    pub(super) settings: &'a RenderSettings,
    pub(super) materials: Materials,
    /// The height of the ground.
    pub(super) ground: Option<f64>,
    /// What hides light, where anything does.
    pub(super) obstacles: Option<Obstacles<'a>>,
}

/// What a pixel of a finished picture can be.
pub(super) trait Pixel: Copy + Default + Send {}

impl<P: Copy + Default + Send> Pixel for P {}

/// A band of rows with those around it that it depends on.
struct Band {
    /// The first row of the picture that it holds.
    top: u32,
    width: u32,
    spots: Vec<Spot>,
    open: Vec<Visibility>,
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
    /// All pixels, row by row from the top, as what `finish` makes of them: linear light, weighted
    /// by alpha.
    pub(super) fn pixels<P: Pixel>(
        &self,
        run: &Run,
        finish: impl Fn([f32; 4]) -> P + Sync,
    ) -> Result<Vec<P>, Cancelled> {
        let RenderSettings { width, height, .. } = *self.settings;
        let mut pixels = vec![P::default(); width as usize * height as usize];
        for (top, end) in self.bands() {
            let place = |row: u32| row as usize * width as usize;
            self.band((top, end), run, &finish, &mut pixels[place(top)..place(end)])?;
        }
        run.report(1.0);
        Ok(pixels)
    }

    /// The same, some rows at a time.
    pub(super) fn rows<P: Pixel, E: From<Cancelled>>(
        &self,
        run: &Run,
        finish: impl Fn([f32; 4]) -> P + Sync,
        mut take: impl FnMut(&[P]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut pixels = Vec::new();
        for (top, end) in self.bands() {
            pixels.resize((end - top) as usize * self.settings.width as usize, P::default());
            self.band((top, end), run, &finish, &mut pixels)?;
            take(&pixels)?;
        }
        run.report(1.0);
        Ok(())
    }

    /// The first row of each band and the one after its last.
    fn bands(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let RenderSettings { width, height, .. } = *self.settings;
        let rows = (BAND / width).clamp(16, height.max(16));
        (0..height).step_by(rows as usize).map(move |top| (top, (top + rows).min(height)))
    }

    /// The rows from `top` to `end`.
    fn band<P: Pixel>(
        &self,
        (top, end): (u32, u32),
        run: &Run,
        finish: &(impl Fn([f32; 4]) -> P + Sync),
        pixels: &mut [P],
    ) -> Result<(), Cancelled> {
        let RenderSettings { width, height, style, samples, .. } = *self.settings;
        let part = |row: u32| f64::from(row) / f64::from(height);
        let run = &run.stage(part(top), part(end));
        let obstacles = self.obstacles.as_ref();
        if samples < 2 && obstacles.is_none() && style != Style::Technical {
            return self.plain((top, end), run, finish, pixels);
        }
        // One pixel for the comparison with neighbours, and what the means and the lines reach.
        let halo = 1 + (REACH as u32).max(if style == Style::Technical { Lines::reach(height) } else { 0 });
        let (first, last) = (top.saturating_sub(halo), (end + halo).min(height));
        let window = Window { top: first, height: last - first, ..Window::whole(width, height) };
        // How long it takes to see what the pixels show, how much light is there, what is at edges,
        // how much light is there, and to shade all.
        let [light, match_light] = if obstacles.is_some() { [0.3, 0.05] } else { [0.0, 0.0] };
        let [to_see, to_light, to_divide, to_match, to_shade] = run.stages([0.35, light, 0.2, match_light, 0.1]);
        let seen = self.surfaces(window, &to_see)?;
        let spots: Vec<Spot> = jobs::in_order(seen.len(), |i| {
            let (x, y) = (i as u32 % width, first + i as u32 / width);
            self.spot(x, y, &seen[i])
        });
        drop(seen);
        let open = match obstacles {
            None => vec![Visibility::FULL; spots.len()],
            Some(obstacles) => {
                let rows = (width as usize, first as usize);
                obstacles.smoothed(&spots, rows, |t| self.rays.pixel_size(t), &to_light)?
            }
        };
        to_light.report(1.0);
        let band = Band { top: first, width, spots, open };
        let fine = self.fine(&band, (top, end), obstacles, &to_divide)?;
        to_divide.report(1.0);
        let light = self.fine_light(&band, &fine, obstacles, &to_match)?;
        to_match.report(1.0);
        let n2 = (samples * samples) as usize;
        let lines = (style == Style::Technical).then(|| Lines {
            height,
            samples,
            width,
            spots: &band.spots,
            fine: &fine,
            pixel: &self.rays,
        });
        let meter = Meter::new(&to_shade, end - top);
        (top..end).into_par_iter().zip(pixels.par_chunks_mut(width as usize)).try_for_each(|(y, row)| {
            meter.check()?;
            let behind = self.behind(f64::from(y) + 0.5);
            for (x, pixel) in (0..width).zip(row) {
                let at = band.place(x, y);
                let mut light = match fine.numbers[at] {
                    u32::MAX => self.shade(&band.spots[at], band.open[at], behind),
                    number => {
                        let own = &light[number as usize * n2..][..n2];
                        own.iter().copied().sum::<Vec4>() / n2 as f32
                    }
                };
                if let Some(lines) = &lines {
                    light = lines.drawn(light, at);
                }
                *pixel = finish(light.to_array());
            }
            meter.add(1);
            Ok::<_, Cancelled>(())
        })?;
        run.report(1.0);
        Ok(())
    }

    /// The rows from `top` to `end` of a picture whose pixels have one ray each, and no shadows or
    /// lines: they need not know of each other.
    fn plain<P: Pixel>(
        &self,
        (top, end): (u32, u32),
        run: &Run,
        finish: &(impl Fn([f32; 4]) -> P + Sync),
        pixels: &mut [P],
    ) -> Result<(), Cancelled> {
        let RenderSettings { width, height, .. } = *self.settings;
        let window = Window { top, height: end - top, ..Window::whole(width, height) };
        let seen = self.surfaces(window, &run.stage(0.0, 0.8))?;
        let rows = seen.par_chunks(width as usize).zip(pixels.par_chunks_mut(width as usize));
        let to_shade = run.stage(0.8, 1.0);
        let meter = Meter::new(&to_shade, end - top);
        (top..end).into_par_iter().zip(rows).try_for_each(|(y, (surfaces, row))| {
            meter.check()?;
            // Without shadows the ground looks like what is behind it.
            let behind = finish(self.behind(f64::from(y) + 0.5).to_array());
            for ((x, surface), pixel) in (0..width).zip(surfaces).zip(row) {
                *pixel = if surface.is_hit() {
                    finish(self.solid(&self.spot(x, y, surface), Visibility::FULL).to_array())
                } else {
                    behind
                };
            }
            meter.add(1);
            Ok::<_, Cancelled>(())
        })?;
        run.report(1.0);
        Ok(())
    }

    /// The pixels at edges, and what their rays meet.
    ///
    /// Rows and columns of the rays are sheared, so that no two of the n² are at the same height
    /// or side: an outline near the horizontal or vertical passes them one by one.
    fn fine(
        &self,
        band: &Band,
        (top, end): (u32, u32),
        obstacles: Option<&Obstacles<'_>>,
        run: &Run,
    ) -> Result<Fine, Cancelled> {
        let RenderSettings { samples, width, height, style, .. } = *self.settings;
        let mut numbers = vec![u32::MAX; band.spots.len()];
        // Lines are drawn where there are fine rays, be it one a pixel.
        if samples < 2 && style != Style::Technical {
            return Ok(Fine { numbers, spots: Vec::new() });
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
        let columns = width as usize;
        // By pixel, whether it differs from the one to its right, and from the one below.
        let mut steps = vec![[false; 2]; band.spots.len()];
        steps.par_chunks_mut(columns).enumerate().for_each(|(row, steps)| {
            let start = row * columns;
            for (x, step) in steps.iter_mut().enumerate() {
                let (at, below) = (start + x, start + x + columns);
                *step = [x + 1 < columns && differ(at, at + 1), below < band.spots.len() && differ(at, below)];
            }
        });
        let is_edge = |x: u32, y: u32| {
            let at = band.place(x, y);
            steps[at] != [false; 2] || x > 0 && steps[at - 1][0] || at >= columns && steps[at - columns][1]
        };
        let edges = (first..last).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| is_edge(x, y));
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
        // The rows and columns of a draft are level.
        let lean = |j: u32| if self.draft.is_some() { 0.5 } else { (f64::from(j) + 0.5) / f64::from(n) };
        let within = |i: u32, j: u32| (f64::from(i) + lean(j)) / f64::from(n);
        let rays: Vec<(DVec3, DVec3)> = pixels
            .par_iter()
            .flat_map_iter(|&(x, y)| {
                (0..n * n).map(move |k| {
                    let (i, j) = (k % n, k / n);
                    self.rays.ray(f64::from(x) + within(i, j), f64::from(y) + within(j, i))
                })
            })
            .collect();
        let hits = match &self.draft {
            Some(draft) => draft.samples(&numbers, band.top, n, pixels.len()),
            None => self.scene.hits(&rays, run)?,
        };
        let spots = jobs::in_order(rays.len(), |n| Spot::new(rays[n].0, rays[n].1, &hits[n], self.ground));
        Ok(Fine { numbers, spots })
    }

    /// The light along each fine ray.
    fn fine_light(
        &self,
        band: &Band,
        fine: &Fine,
        obstacles: Option<&Obstacles<'_>>,
        run: &Run,
    ) -> Result<Vec<Vec4>, Cancelled> {
        let n = self.settings.samples;
        let n2 = (n * n) as usize;
        let mut places = vec![0; fine.spots.len() / n2];
        for (place, number) in fine.numbers.iter().enumerate() {
            if *number != u32::MAX {
                places[*number as usize] = place;
            }
        }
        let hard = obstacles.is_some_and(Obstacles::is_hard);
        let matched: Vec<Option<Visibility>> = jobs::in_order(fine.spots.len(), |k| match obstacles {
            None => Some(Visibility::FULL),
            Some(_) => self.matching(band, &fine.spots[k], places[k / n2], hard),
        });
        let alone: Vec<usize> = (0..matched.len()).filter(|k| matched[*k].is_none()).collect();
        let spots: Vec<Spot> = alone.iter().map(|k| fine.spots[*k]).collect();
        let mut open: Vec<Visibility> = matched.iter().map(|open| open.unwrap_or(Visibility::FULL)).collect();
        if let Some(obstacles) = obstacles {
            for (k, seen) in alone.iter().zip(obstacles.seen(&spots, TILE, |i| alone[i], run)?) {
                open[*k] = seen;
            }
        }
        let row = |place: usize| f64::from(band.top + place as u32 / band.width);
        let shade = |(k, spot): (usize, &Spot)| {
            let down = (k % n2) as u32 / n;
            let y = row(places[k / n2]) + (f64::from(down) + 0.5) / f64::from(n);
            self.shade(spot, open[k], self.behind(y))
        };
        Ok(jobs::in_order(fine.spots.len(), |k| shade((k, &fine.spots[k]))))
    }

    /// The visibility of a spot, from the pixel at `place` and those about it; none if none of
    /// them is on the same face.
    fn matching(&self, band: &Band, spot: &Spot, place: usize, hard: bool) -> Option<Visibility> {
        if !spot.is_solid() && !spot.is_ground() {
            return Some(Visibility::FULL);
        }
        let width = band.width as usize;
        let (x, y) = (place % width, place / width);
        let near = 2.0 * self.rays.pixel_size(spot.distance);
        let mut best: Option<(f64, Visibility)> = None;
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

    /// What the pixels of some rows see through their middles.
    fn surfaces(&self, window: Window, run: &Run) -> Result<Vec<Surface>, Cancelled> {
        match &self.draft {
            Some(draft) => {
                run.check()?;
                Ok(draft.surfaces(window))
            }
            None => Ok(self.scene.surfaces_with(&self.rays, window, run)?.into_surfaces()),
        }
    }

    /// What the ray through the middle of a pixel meets.
    #[inline]
    fn spot(&self, x: u32, y: u32, surface: &Surface) -> Spot {
        if self.ground.is_none() && !surface.is_hit() {
            return Spot::NOTHING;
        }
        let (origin, direction) = self.rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        Spot::new(origin, direction, surface, self.ground)
    }

    /// What is behind the solid in row `y`.
    fn behind(&self, y: f64) -> Vec4 {
        self.studio.background(y / f64::from(self.settings.height))
    }

    /// What a spot looks like with this behind it.
    fn shade(&self, spot: &Spot, open: Visibility, behind: Vec4) -> Vec4 {
        if spot.is_solid() {
            self.solid(spot, open)
        } else if spot.is_ground() {
            self.studio.ground(behind, open)
        } else {
            behind
        }
    }

    /// What a spot on the solid looks like.
    fn solid(&self, spot: &Spot, open: Visibility) -> Vec4 {
        self.studio.surface(spot, &self.materials.at(&self.studio, spot.owner, spot.point), open)
    }
}
