//! Slices: the field on a plane, as a picture.
//!
//! ```text
//!    +-----------------+      inside warm, outside cool, the deeper the further from the
//!    | .-----.         |      surface; isolines at even steps; the surface as a dark line
//!    |( inside )  out  |
//!    | `-----´         |
//!    +-----------------+
//! ```
//!
//! How near a pixel is to an isoline is seen from its value and the change to its neighbours:
//! |f − level|/|∇f|, in pixels; lines keep their width whatever the slope.

use glam::{DVec2, Vec3};
use rvachev_num::{Meter, jobs};

use super::contour::aside;
use super::settings::{RenderError, check_memory, check_size, setting};
use crate::distance::compiled_with;
use crate::eval::Program;
use crate::geom::{to_byte, to_linear};
use crate::{Bounds, Cancelled, Image, Plane, PlaneBounds, Run, Solid};

/// How far the region of a slice goes beyond the solid, in proportion to its size.
const MARGIN: f64 = 0.08;

/// Values of which the least and the greatest are found at once.
const AT_ONCE: usize = 1 << 14;

/// A solid cut by a plane: its field on a rectangle of the plane.
///
/// ```
/// use rvachev::{Plane, SliceSettings, Solid};
///
/// let part = Solid::cuboid([4.0, 3.0, 2.0]) - Solid::cylinder(1.0, 3.0);
/// let slice = part.slice(&Plane::xy(0.0))?;
/// let picture = slice.picture(&SliceSettings { width: 80, ..SliceSettings::default() })?;
/// assert_eq!(picture.width(), 80);
/// let contours = slice.contours(1e-4)?;
/// assert_eq!(contours.len(), 2);
/// let area: f64 = contours.iter().map(|contour| contour.area()).sum();
/// assert!((area - (12.0 - std::f64::consts::PI)).abs() < 0.01);
/// # Ok::<(), rvachev::error::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Slice {
    pub(super) field: Program,
    pub(super) surface: Program,
    pub(super) plane: Plane,
    pub(super) region: PlaneBounds,
}

/// How a slice is drawn.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct SliceSettings {
    /// Width of the picture in pixels, 1 to 65 535; its height follows from the region. Default:
    /// 800.
    pub width: u32,
    /// Where isolines are drawn. Default: at multiples of a round number, about 16 of them.
    pub isolines: Isolines,
    /// Colour of the inside, in sRGB. Default: a warm sand.
    pub inside: [u8; 3],
    /// Colour of the outside, in sRGB. Default: a cool grey.
    pub outside: [u8; 3],
}

impl Default for SliceSettings {
    fn default() -> SliceSettings {
        SliceSettings { width: 800, isolines: Isolines::Auto, inside: [236, 176, 106], outside: [126, 162, 196] }
    }
}

/// Where isolines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Isolines {
    /// At multiples of a round number.
    #[default]
    Auto,
    /// At multiples of this value, which must be above 0.
    Every(f64),
    /// Nowhere.
    None,
}

impl Solid {
    /// The solid cut by a plane, over all of it with a small margin.
    ///
    /// # Errors
    /// What is wrong with the solid or the plane; an unbounded solid wants
    /// [`slice_within`](Solid::slice_within).
    pub fn slice(&self, plane: &Plane) -> Result<Slice, RenderError> {
        self.slice_with(plane, None, &Run::default())
    }

    /// The solid cut by a plane, within a rectangle of the plane's coordinates.
    ///
    /// # Errors
    /// What is wrong with the solid, the plane or the rectangle.
    pub fn slice_within(&self, plane: &Plane, region: PlaneBounds) -> Result<Slice, RenderError> {
        self.slice_with(plane, Some(region), &Run::default())
    }

    /// The solid cut by a plane, within a rectangle of the plane's coordinates or over all of it,
    /// with a cancel token and a progress sink: the solid is compiled if it has not been.
    ///
    /// ```
    /// use rvachev::{Plane, Run, SliceSettings, Solid};
    ///
    /// let run = Run { threads: 2, ..Run::default() };
    /// let slice = Solid::sphere(1.0).slice_with(&Plane::xy(0.0), None, &run)?;
    /// let picture = slice.picture_with(&SliceSettings { width: 40, ..SliceSettings::default() }, &run)?;
    /// assert_eq!([picture.width(), picture.height()], [40, 40]);
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, the plane or the rectangle, or that the work was cancelled; an
    /// unbounded solid wants a rectangle.
    pub fn slice_with(&self, plane: &Plane, region: Option<PlaneBounds>, run: &Run) -> Result<Slice, RenderError> {
        let run = run.stage(0.0, 1.0);
        let programs = run.install(|| compiled_with(self, &run))?;
        let region = match region {
            Some(region) => region,
            None => seen(&self.finite_bounds()?, plane),
        };
        if !plane.is_finite() {
            let value = format!("through {} across {}", plane.origin(), plane.normal());
            return Err(setting("plane", value, "finite, with a normal that is not 0"));
        }
        let size = region.max - region.min;
        if !(size.is_finite() && size.min_element() > 0.0) {
            let value = format!("{} to {}", region.min, region.max);
            return Err(setting("region", value, "finite, with min below max along both axes"));
        }
        run.report(1.0);
        Ok(Slice { field: programs.field.clone(), surface: programs.surface.clone(), plane: *plane, region })
    }
}

impl Slice {
    /// The plane.
    #[must_use]
    pub fn plane(&self) -> &Plane {
        &self.plane
    }

    /// The rectangle, in the plane's coordinates.
    #[must_use]
    pub fn region(&self) -> PlaneBounds {
        self.region
    }

    /// The height of a picture `width` pixels wide.
    fn height(&self, width: u32) -> f64 {
        let size = self.region.max - self.region.min;
        (f64::from(width) * size.y / size.x).round().max(1.0)
    }

    /// The true values at the middles of the pixels of a picture `width` pixels wide, from the
    /// top left.
    ///
    /// # Errors
    /// If the width, or the height that follows from it, is not from 1 to 65 535, or both make more
    /// pixels than fit into memory.
    pub fn values(&self, width: u32) -> Result<Image<f64>, RenderError> {
        self.values_with(width, &Run::default())
    }

    /// [`values`](Slice::values) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// As for [`values`](Slice::values), or that the work was cancelled.
    pub fn values_with(&self, width: u32, run: &Run) -> Result<Image<f64>, RenderError> {
        let run = run.stage(0.0, 1.0);
        let values = run.install(|| self.values_on(&self.plane, width, &run))?;
        run.report(1.0);
        Ok(values)
    }

    /// The same on a plane beside the slice's.
    fn values_on(&self, plane: &Plane, width: u32, run: &Run) -> Result<Image<f64>, RenderError> {
        let height = self.height(width).min(f64::from(u32::MAX)) as u32;
        check_size(width, height)?;
        check_memory(width, height)?;
        let PlaneBounds { min, max } = self.region;
        let middle = |i: u32, count: u32| (f64::from(i) + 0.5) / f64::from(count);
        let columns: Vec<f64> = (0..width).map(|i| min.x + (max.x - min.x) * middle(i, width)).collect();
        let rows: Vec<f64> = (0..height).map(|j| max.y - (max.y - min.y) * middle(j, height)).collect();
        let point = |i: usize| plane.point(DVec2::new(columns[i % columns.len()], rows[i / columns.len()]));
        Ok(Image::new(width, height, self.field.sampled(columns.len() * rows.len(), point, run)?)?)
    }

    /// The field as a picture: inside and outside tinted, isolines, and the surface as a line.
    /// Where a face lies in the plane, what is just above it counts, as
    /// [`Side::Above`](crate::Side::Above) does for contours.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn picture(&self, settings: &SliceSettings) -> Result<Image, RenderError> {
        self.picture_with(settings, &Run::default())
    }

    /// [`picture`](Slice::picture) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// If a setting is out of its range, or the work was cancelled.
    pub fn picture_with(&self, settings: &SliceSettings, run: &Run) -> Result<Image, RenderError> {
        let run = run.stage(0.0, 1.0);
        let picture = run.install(|| self.drawn(settings, &run))?;
        run.report(1.0);
        Ok(picture)
    }

    fn drawn(&self, settings: &SliceSettings, run: &Run) -> Result<Image, RenderError> {
        if let Isolines::Every(step) = settings.isolines
            && !(step > 0.0 && step.is_finite())
        {
            return Err(setting("isolines", step, "finite and above 0"));
        }
        let above = self.plane.moved_by(aside(&self.surface, &self.plane, self.region, 0.0));
        let [to_value, to_draw] = run.stages([0.8, 0.2]);
        let values = self.values_on(&above, settings.width, &to_value)?;
        let (width, height) = (values.width() as usize, values.height() as usize);
        let v = values.pixels();
        let size = (self.region.max - self.region.min).max_element();
        let step = match settings.isolines {
            Isolines::Auto => Some(round(span(v, size) / 16.0)),
            Isolines::Every(step) => Some(step),
            Isolines::None => None,
        };
        // Where the tints are half as deep as they get.
        let depth = 4.0 * step.unwrap_or(size / 20.0);
        // Lines keep their width on paper.
        let scale = (values.width() as f32 / 800.0).clamp(0.5, 4.0);
        let linear = |color: [u8; 3]| Vec3::from_array(color.map(|c| to_linear(f32::from(c) / 255.0)));
        let (inside, outside) = (linear(settings.inside), linear(settings.outside));
        let drawn = |at: usize| {
            let (x, y) = (at % width, at / width);
            // The steeper side of each axis: a kink does not thin a line.
            let slope = |a: Option<usize>, b: Option<usize>| {
                let change = |o: Option<usize>| o.map_or(0.0, |o| (v[o] - v[at]).abs());
                change(a).max(change(b))
            };
            let across = slope((x > 0).then(|| at - 1), (x + 1 < width).then(|| at + 1));
            let down = slope((y > 0).then(|| at - width), (y + 1 < height).then(|| at + width));
            let change = across.hypot(down).max(1e-300);
            let ink = |away: f64, half: f32| (half + 0.5 - (away / change) as f32).clamp(0.0, 1.0);
            let tint = if v[at] > 0.0 { inside } else { outside };
            // Pale at the surface, deeper away from it.
            let deep = (v[at].abs() / (v[at].abs() + depth)) as f32;
            let mut color = Vec3::splat(0.94).lerp(tint, 0.22 + 0.78 * deep);
            if let Some(step) = step {
                let nearest = (v[at] / step).round();
                let fifth = nearest % 5.0 == 0.0;
                // Where lines would run together they fade into a tone.
                let room = (step / change / 4.0).min(1.0) as f32;
                let strength = room * if fifth { 0.55 } else { 0.30 };
                color = color.lerp(tint * 0.12, strength * ink((v[at] - nearest * step).abs(), 0.35 * scale));
            }
            color = color.lerp(Vec3::new(0.008, 0.012, 0.02), ink(v[at].abs(), 1.0 * scale));
            let [r, g, b] = color.to_array().map(to_byte);
            [r, g, b, 255]
        };
        let meter = Meter::new(&to_draw, height);
        let mut pixels = vec![[0; 4]; width * height];
        jobs::try_chunks_mut(&mut pixels, width, |row, pixels| {
            meter.step()?;
            for (x, pixel) in pixels.iter_mut().enumerate() {
                *pixel = drawn(row * width + x);
            }
            Ok::<(), Cancelled>(())
        })?;
        Ok(Image::new(values.width(), values.height(), pixels)?)
    }
}

/// The rectangle of a plane that a box is seen in, with a small margin.
pub(super) fn seen(bounds: &Bounds, plane: &Plane) -> PlaneBounds {
    let bounds = if bounds.is_empty() { Bounds::from_center(plane.origin(), glam::DVec3::ONE) } else { *bounds };
    let corners = bounds.corners().map(|corner| plane.coordinates(corner));
    let min = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
    let max = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
    let margin = MARGIN * (max - min).max_element();
    PlaneBounds { min: min - margin, max: max + margin }
}

/// From the least to the greatest value, but no more than what a distance changes by.
fn span(values: &[f64], size: f64) -> f64 {
    let ends = |chunk: usize| {
        let some = &values[chunk * AT_ONCE..values.len().min((chunk + 1) * AT_ONCE)];
        some.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
    };
    let ends = jobs::in_order(values.len().div_ceil(AT_ONCE), ends);
    let low = ends.iter().map(|ends| ends[0]).fold(f64::INFINITY, f64::min);
    let high = ends.iter().map(|ends| ends[1]).fold(f64::NEG_INFINITY, f64::max);
    let span = (high - low).min(2.0 * size);
    if span > 0.0 { span } else { size }
}

/// The nearest of 1, 2 and 5 times a power of ten.
fn round(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    steps.into_iter().min_by(|a, b| (a / x).ln().abs().total_cmp(&(b / x).ln().abs())).unwrap_or(x)
}
