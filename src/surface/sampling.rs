//! Points on a surface, uniform by area.
//!
//! ```text
//!     area element    |∂S/∂s × ∂S/∂t|  =  sum over the triangles of a fine grid
//!
//!     a triangle by its area, a point in it, moved to the surface, taken with a chance that
//!     is the ratio of the two area elements
//! ```
//!
//! The proposal is flat, the surface is not: a draw is accepted with the surface's area element
//! at the point over that of its cell, so that the result is uniform on the surface itself and
//! not on the grid.

use glam::{DVec2, DVec3};

use super::curve::By;
use super::parametric::{ParametricSurface, Shape};
use super::patch::{PatchError, count};
use crate::Run;
use rvachev_num::Meter;

/// A point of a surface with its outward unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfacePoint {
    /// The point, in length units.
    pub point: DVec3,
    /// The outward unit normal.
    pub normal: DVec3,
}

/// A small generator of uniform numbers: the same seed gives the same ones on every machine.
/// Source: G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number generators* (2014).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Cells along each parameter.
const CELLS: usize = 256;

/// The most points of one call.
const MOST: u64 = 1 << 27;

/// Points that are drawn before it is looked whether to go on.
const CHUNK: usize = 4096;

impl ParametricSurface {
    /// `n` points with normals, uniform by area over the curved surface (its flat ends are not
    /// sampled; of two sheets, this one). The same seed gives the same points.
    ///
    /// The density is that of the area to the fineness of a grid of 256 × 256 cells, whose share of
    /// the area is measured; within a cell it follows the curvature to second order.
    ///
    /// ```
    /// use rvachev::surface::ParametricSurface;
    /// use rvachev::Superellipsoid;
    ///
    /// let shape = Superellipsoid::new([1.0, 2.0, 3.0], 0.3, 0.8);
    /// let cloud = ParametricSurface::of(&shape)?.sample(1000, 7)?;
    /// assert_eq!(cloud.len(), 1000);
    /// for s in &cloud {
    ///     assert!((shape.gauge(s.point) - 1.0).abs() < 1e-12);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// More than 2²⁷ points.
    pub fn sample(&self, n: usize, seed: u64) -> Result<Vec<SurfacePoint>, PatchError> {
        self.sample_with(n, seed, &Run::default())
    }

    /// [`sample`](ParametricSurface::sample) with a cancel token and a progress sink; on one
    /// thread.
    ///
    /// # Errors
    ///
    /// Those of [`sample`](ParametricSurface::sample), and [`PatchError::Cancelled`].
    pub fn sample_with(&self, n: usize, seed: u64, run: &Run) -> Result<Vec<SurfacePoint>, PatchError> {
        count("n", n as u64, 0, MOST)?;
        let run = run.stage(0.0, 1.0);
        let cells = Cells::new(self);
        let mut random = SplitMix(seed);
        let meter = Meter::new(&run, n);
        let mut points = Vec::with_capacity(n);
        while points.len() < n {
            meter.check()?;
            let chunk = CHUNK.min(n - points.len());
            points.extend((0..chunk).map(|_| cells.draw(&mut random)));
            meter.add(chunk as u64);
        }
        run.report(1.0);
        Ok(points)
    }
}

/// A grid over the surface with the areas of its cells, summed up.
struct Cells<'a> {
    surface: &'a ParametricSurface,
    /// Parameters of the lines of the grid.
    lines: [Vec<f64>; 2],
    areas: Vec<f64>,
}

impl<'a> Cells<'a> {
    fn new(surface: &'a ParametricSurface) -> Cells<'a> {
        let arcs = [surface.meridian_arc(By::Even), surface.equator_arc(By::Even)];
        let lines = arcs.map(|arc| {
            let chain = arc.chain(CELLS as u32);
            (0..=CELLS).map(|i| chain.parameter(chain.length() * i as f64 / CELLS as f64)).collect::<Vec<f64>>()
        });
        // Two pieces each way of a cell: the curves at their ends are shared by whole rows.
        let points = [(&surface.meridian, &lines[0]), (&surface.equator, &lines[1])].map(|(curve, line)| {
            let at = |i: usize| if i.is_multiple_of(2) { line[i / 2] } else { 0.5 * (line[i / 2] + line[i / 2 + 1]) };
            (0..=2 * CELLS).map(|i| curve.at(at(i), By::Even).point).collect::<Vec<DVec2>>()
        });
        let corner = |i: usize, j: usize| surface.point_of(points[0][i], points[1][j]);
        let piece = |i: usize, j: usize| {
            let (a, c) = (corner(i, j), corner(i + 1, j + 1));
            let (b, d) = (corner(i, j + 1), corner(i + 1, j));
            0.5 * (c - a).cross(d - b).length()
        };
        let mut areas = Vec::with_capacity(CELLS * CELLS);
        let mut sum = 0.0;
        for i in (0..2 * CELLS).step_by(2) {
            for j in (0..2 * CELLS).step_by(2) {
                sum += piece(i, j) + piece(i, j + 1) + piece(i + 1, j) + piece(i + 1, j + 1);
                areas.push(sum);
            }
        }
        Cells { surface, lines, areas }
    }

    /// The point at a place of a cell.
    fn point(&self, i: usize, j: usize, s: f64, t: f64) -> SurfacePoint {
        let between = |line: &[f64], i: usize, s: f64| line[i] + (line[i + 1] - line[i]) * s;
        let (m, e) = (between(&self.lines[0], i, s), between(&self.lines[1], j, t));
        let (m, e) = (self.surface.meridian.at(m, By::Even), self.surface.equator.at(e, By::Even));
        SurfacePoint {
            point: self.surface.point_of(m.point, e.point),
            normal: self.surface.normal_of(m.normal, e.normal, e.point),
        }
    }

    fn draw(&self, random: &mut SplitMix) -> SurfacePoint {
        let total = self.areas[self.areas.len() - 1];
        loop {
            let at = random.unit() * total;
            let cell = self.areas.partition_point(|&sum| sum <= at).min(self.areas.len() - 1);
            let (i, j) = (cell / CELLS, cell % CELLS);
            let (s, t) = (random.unit(), random.unit());
            // The area element within the cell, relative to its mean, by differences over it.
            let piece = self.element(i, j, s, t);
            let mean = self.areas[cell] - if cell > 0 { self.areas[cell - 1] } else { 0.0 };
            if random.unit() * MOST_UNEVEN * mean <= piece && self.is_within(i, j, s, t) {
                return self.point(i, j, s, t);
            }
        }
    }

    /// The area element at a place of a cell, in cells.
    fn element(&self, i: usize, j: usize, s: f64, t: f64) -> f64 {
        const H: f64 = 1.0 / 32.0;
        let (s, t) = (s.clamp(H, 1.0 - H), t.clamp(H, 1.0 - H));
        let across = |ds: f64, dt: f64| self.point(i, j, s + ds, t + dt).point - self.point(i, j, s - ds, t - dt).point;
        across(H, 0.0).cross(across(0.0, H)).length() / (4.0 * H * H)
    }

    /// Whether the point belongs to the surface: Barr's bowls are cut across their parameters.
    fn is_within(&self, i: usize, j: usize, s: f64, t: f64) -> bool {
        let Shape::BarrBowl { end, .. } = self.surface.shape else { return true };
        self.point(i, j, s, t).point.x.abs() <= end * self.surface.semi_axes().x
    }
}

/// An area element is hardly ever more than this many times the mean of its cell.
const MOST_UNEVEN: f64 = 2.5;
