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

use std::sync::Arc;

use glam::Vec4;

use super::draft::Draft;
use super::gbuffer::{Surface, Window};
use super::lines::Lines;
use super::materials::Materials;
use super::occlusion::{Obstacles, REACH, TILE};
use super::scene::Scene;
use super::settings::{RenderSettings, Style};
use super::shade::{Studio, Visibility};
use super::spot::Spot;
use crate::raster::Tile;
use crate::{Cancelled, Rays, Run};
use rvachev_num::{Meter, jobs};

/// Pixels of a band, about: some tens of megabytes.
const BAND: u32 = 1 << 19;

/// Rows that a thread makes at a time where nothing hides light: as many as a tile of a draft has.
const PLAIN_ROWS: u32 = Tile::SIDE;

/// Rays of a pixel that meet what one of so many before them has met, about as it is turned, have
/// its light where nothing is hidden.
const KNOWN: usize = 3;

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
    /// Empty where nothing hides light.
    open: Vec<Visibility>,
}

impl Band {
    /// How much light there is at a place.
    fn open(&self, at: usize) -> Visibility {
        self.open.get(at).copied().unwrap_or(Visibility::FULL)
    }

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
        let RenderSettings { width, height, .. } = *self.settings;
        let part = |row: u32| f64::from(row) / f64::from(height);
        let run = &run.stage(part(top), part(end));
        let Some(obstacles) = &self.obstacles else { return self.plain((top, end), run, finish, pixels) };
        // One pixel for the comparison with neighbours, and what the means reach.
        let halo = 1 + REACH as u32;
        let (first, last) = (top.saturating_sub(halo), (end + halo).min(height));
        let window = Window { top: first, height: last - first, ..Window::whole(width, height) };
        // How long it takes to see what the pixels show, how much light is there, what is at edges,
        // how much light is there, and to shade all.
        let [to_see, to_light, to_divide, to_match, to_shade] = run.stages([0.35, 0.3, 0.2, 0.05, 0.1]);
        let seen = self.surfaces(window, &to_see)?;
        let spots: Vec<Spot> = jobs::in_order(seen.len(), |i| {
            let (x, y) = (i as u32 % width, first + i as u32 / width);
            self.spot(x, y, &seen[i])
        });
        drop(seen);
        let rows = (width as usize, first as usize);
        let open = obstacles.smoothed(&spots, rows, |t| self.rays.pixel_size(t), &to_light)?;
        to_light.report(1.0);
        let band = Band { top: first, width, spots, open };
        let fine = self.fine(&band, (top, end), &to_divide)?;
        to_divide.report(1.0);
        let light = self.fine_light(&band, &fine, &to_match)?;
        to_match.report(1.0);
        let meter = Meter::new(&to_shade, end - top);
        jobs::try_chunks_mut(pixels, width as usize, |row, pixels| {
            meter.check()?;
            let y = top + row as u32;
            let behind = self.behind(f64::from(y) + 0.5);
            for (x, pixel) in (0..width).zip(pixels) {
                let at = band.place(x, y);
                let light = match fine.numbers[at] {
                    u32::MAX => self.shade(&band.spots[at], band.open(at), || behind),
                    number => light[number as usize],
                };
                *pixel = finish(light.to_array());
            }
            meter.add(1);
            Ok::<_, Cancelled>(())
        })?;
        run.report(1.0);
        Ok(())
    }

    /// How far lines reach from the pixels that they are drawn between, if there are any.
    fn reach(&self) -> u32 {
        if self.settings.style == Style::Technical { Lines::reach(self.settings.height) } else { 0 }
    }

    /// The rows from `top` to `end` of a picture without shadows, whose pixels know of those beside
    /// them alone: some rows at a time by each thread, so that what is known of them stays near.
    fn plain<P: Pixel>(
        &self,
        (top, end): (u32, u32),
        run: &Run,
        finish: &(impl Fn([f32; 4]) -> P + Sync),
        pixels: &mut [P],
    ) -> Result<(), Cancelled> {
        let RenderSettings { width, height, samples, style, .. } = *self.settings;
        let columns = width as usize;
        let halo = u32::from(samples > 1 || style == Style::Technical) + self.reach();
        let (first, last) = (top.saturating_sub(halo), (end + halo).min(height));
        let window = Window { top: first, height: last - first, ..Window::whole(width, height) };
        let [to_see, to_shade] = run.stages([0.6, 0.4]);
        let seen = self.surfaces(window, &to_see)?;
        let rows = PLAIN_ROWS * (1 + self.reach());
        let meter = Meter::new(&to_shade, end - top);
        // Nobody is told of the few rays at edges.
        let unheard = Run { progress: None, ..run.clone() };
        jobs::try_chunks_mut(pixels, rows as usize * columns, |part, pixels| {
            meter.check()?;
            let top = top + part as u32 * rows;
            let end = top + (pixels.len() / columns) as u32;
            let (first, last) = (top.saturating_sub(halo).max(first), (end + halo).min(last));
            let own = &seen[(first - window.top) as usize * columns..(last - window.top) as usize * columns];
            let rows = (first..).zip(own.chunks(columns));
            let spots = rows.flat_map(|(y, row)| (0..).zip(row).map(move |(x, surface)| self.spot(x, y, surface)));
            let band = Band { top: first, width, spots: spots.collect(), open: Vec::new() };
            let fine = self.fine(&band, (top, end), &unheard)?;
            let light = self.fine_light(&band, &fine, &unheard)?;
            let lines = (style == Style::Technical).then(|| Lines {
                height,
                samples,
                width,
                spots: &band.spots,
                fine: &fine,
                pixel: &self.rays,
            });
            for (y, row) in (top..).zip(pixels.chunks_mut(columns)) {
                // Without shadows the ground looks like what is behind it.
                let behind = self.behind(f64::from(y) + 0.5);
                let empty = finish(behind.to_array());
                for (x, pixel) in (0..width).zip(row) {
                    let at = band.place(x, y);
                    let spot = &band.spots[at];
                    *pixel = match fine.numbers[at] {
                        u32::MAX if spot.is_solid() => finish(self.solid(spot, Visibility::FULL).to_array()),
                        u32::MAX => empty,
                        number => {
                            let light = light[number as usize];
                            finish(lines.as_ref().map_or(light, |lines| lines.drawn(light, at)).to_array())
                        }
                    };
                }
                meter.add(1);
            }
            Ok::<_, Cancelled>(())
        })?;
        run.report(1.0);
        Ok(())
    }

    /// The pixels at edges, and what their rays meet.
    ///
    /// Rows and columns of the rays are sheared, so that no two of the n² are at the same height
    /// or side: an outline near the horizontal or vertical passes them one by one.
    fn fine(&self, band: &Band, (top, end): (u32, u32), run: &Run) -> Result<Fine, Cancelled> {
        let RenderSettings { samples, width, style, .. } = *self.settings;
        let mut numbers = vec![u32::MAX; band.spots.len()];
        // Lines are drawn where there are fine rays, be it one a pixel.
        if samples < 2 && style != Style::Technical {
            return Ok(Fine { numbers, spots: Vec::new() });
        }
        let hard = self.obstacles.as_ref().is_some_and(Obstacles::is_hard);
        let differ = |a: usize, b: usize| {
            let (one, other) = (&band.spots[a], &band.spots[b]);
            let pixel = |distance| self.rays.pixel_size(distance);
            one.differs(other, pixel) || hard && (band.open(a).key - band.open(b).key).abs() > SHADOW_EDGE
        };
        // Lines are wider than a pixel: what is about an edge is sampled more often as well.
        let reach = self.reach();
        let (first, last) = (top.saturating_sub(reach).max(band.top), (end + reach).min(band.end()));
        let columns = width as usize;
        // By pixel, whether it differs from the one to its right, and from the one below.
        let mut steps = vec![[false; 2]; band.spots.len()];
        jobs::for_chunks_mut(&mut steps, columns, |row, steps| {
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
        let each: Vec<(u32, u32)> = (0..n * n).map(|k| (k % n, k / n)).collect();
        let ray = |number: usize| {
            let (x, y) = pixels[number / each.len()];
            let (i, j) = each[number % each.len()];
            self.rays.ray(f64::from(x) + within(i, j), f64::from(y) + within(j, i))
        };
        let count = pixels.len() * each.len();
        let spots = match &self.draft {
            Some(draft) => {
                let hits = draft.samples(&numbers, band.top, n, pixels.len());
                let spot = |number: usize| match &hits[number] {
                    hit if hit.is_hit() || self.ground.is_some() => {
                        let (origin, direction) = ray(number);
                        Spot::new(origin, direction, hit, self.ground)
                    }
                    _ => Spot::NOTHING,
                };
                (0..count).map(spot).collect()
            }
            None => {
                let rays = jobs::in_order(count, ray);
                let hits = self.scene.hits(&rays, run)?;
                jobs::in_order(count, |n| Spot::new(rays[n].0, rays[n].1, &hits[n], self.ground))
            }
        };
        Ok(Fine { numbers, spots })
    }

    /// The mean of the light along the fine rays of each pixel.
    fn fine_light(&self, band: &Band, fine: &Fine, run: &Run) -> Result<Vec<Vec4>, Cancelled> {
        let n = self.settings.samples;
        let n2 = (n * n) as usize;
        let mut places = vec![0; fine.spots.len() / n2];
        for (place, number) in fine.numbers.iter().enumerate() {
            if *number != u32::MAX {
                places[*number as usize] = place;
            }
        }
        let open = match &self.obstacles {
            None => Vec::new(),
            Some(obstacles) => {
                let hard = obstacles.is_hard();
                let matched: Vec<Option<Visibility>> =
                    jobs::in_order(fine.spots.len(), |k| self.matching(band, &fine.spots[k], places[k / n2], hard));
                let alone: Vec<usize> = (0..matched.len()).filter(|k| matched[*k].is_none()).collect();
                let spots: Vec<Spot> = alone.iter().map(|k| fine.spots[*k]).collect();
                let mut open: Vec<Visibility> = matched.iter().map(|open| open.unwrap_or(Visibility::FULL)).collect();
                for (k, seen) in alone.iter().zip(obstacles.seen(&spots, TILE, |i| alone[i], run)?) {
                    open[*k] = seen;
                }
                open
            }
        };
        let open = |k: usize| open.get(k).copied().unwrap_or(Visibility::FULL);
        let shares_light = self.obstacles.is_none();
        // What is behind a row of rays is the same all along it.
        let row = |k: u32| self.behind(f64::from(band.top) + (f64::from(k) + 0.5) / f64::from(n));
        let behind: Vec<Vec4> =
            if places.is_empty() { Vec::new() } else { (0..n * (band.end() - band.top)).map(row).collect() };
        Ok(jobs::in_order(places.len(), |number| {
            let behind = &behind[places[number] / band.width as usize * n as usize..];
            let (mut sum, mut known) = (Vec4::ZERO, [(&Spot::NOTHING, Vec4::ZERO); KNOWN]);
            for (k, spot) in fine.spots[number * n2..][..n2].iter().enumerate() {
                let found = known.iter().find(|(other, _)| shares_light && spot.looks_like(other));
                let light = found.map(|(_, light)| *light).unwrap_or_else(|| {
                    let light = self.shade(spot, open(number * n2 + k), || behind[k / n as usize]);
                    known.rotate_right(1);
                    known[0] = (spot, light);
                    light
                });
                sum += light;
            }
            sum / n2 as f32
        }))
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
                    let open = band.open(at);
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
    fn surfaces(&self, window: Window, run: &Run) -> Result<Arc<Vec<Surface>>, Cancelled> {
        match &self.draft {
            Some(draft) => Ok(Arc::new(draft.surfaces(window, run)?)),
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
    fn shade(&self, spot: &Spot, open: Visibility, behind: impl FnOnce() -> Vec4) -> Vec4 {
        if spot.is_solid() {
            self.solid(spot, open)
        } else if spot.is_ground() {
            self.studio.ground(behind(), open)
        } else {
            behind()
        }
    }

    /// What a spot on the solid looks like.
    fn solid(&self, spot: &Spot, open: Visibility) -> Vec4 {
        self.studio.surface(spot, &self.materials.at(&self.studio, spot.owner, spot.point), open)
    }
}
