//! Meshes within a chord tolerance, by rings of as many vertices as each needs.
//!
//! ```text
//!     ●            pole              a row's height allows half of the tolerance along the
//!    / \                             meridian; the other half allows each ring its chords, the
//!   *---*          a narrow ring     more of them the wider it is and the more upright the
//!  / \ / \                           surface stands on it (a flat top needs none in between)
//! *---*---*---*    a wide one
//! ```
//!
//! Two rings are joined by walking around both and stepping on the one that is behind. The mesh
//! is then measured against the surface, and made again with a budget corrected by what was found.
//!
//! # How near to the fewest
//!
//! With a tolerance of t, triangles of a smooth convex surface of curvature K number at least
//! `N = ∫√K dA / (1.5·√3·t)` (each equilateral in the metric of the curvature, its error being half
//! of its squared circumradius). Rings of right triangles come to 1.30·N where all goes by the
//! formula; measured, they take 1.38·N on a sphere and 1.64·N on an ellipsoid of 1 : 2 : 3.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::curve::By;
use super::parametric::{ParametricSurface, Shape};
use super::patch::PatchError;
use super::spacing::{Arc, Chain, Sample};
use crate::geom::{Corner, QuadMesh};
use crate::{Cancelled, Run};
use rvachev_num::Meter;

/// Budgets tried until the mesh is within the tolerance and not far below it.
const ATTEMPTS: usize = 5;

/// The mesh of one sheet within `tolerance` of the surface, appended to `mesh`.
pub(super) fn append(
    surface: &ParametricSurface,
    tolerance: f64,
    mesh: &mut QuadMesh,
    run: &Run,
) -> Result<(), PatchError> {
    let rings = Rings::new(surface);
    let mut budget = tolerance;
    let mut best: Option<Draft> = None;
    for attempt in 0..ATTEMPTS {
        // Any of them may be the last: each is half of what is left.
        let part = |attempt: usize| 1.0 - 0.5f64.powi(attempt as i32);
        let (draft, error) = rings.measured(budget, &run.stage(part(attempt), part(attempt + 1)))?;
        let fits = error <= tolerance;
        if fits && best.as_ref().is_none_or(|b| draft.triangles.len() < b.triangles.len()) {
            best = Some(draft);
        }
        if fits && error > 0.9 * tolerance {
            break;
        }
        // The error is proportional to the budget, roughly: a little below the tolerance.
        let wanted = 0.96 * tolerance / error.max(0.2 * tolerance);
        budget *= if fits { wanted.max(1.0) } else { wanted.min(0.9) };
    }
    // The least budget that was tried may still miss it: then on, by halves.
    let draft = match best {
        Some(draft) => draft,
        None => {
            let mut halved = (1..20).map(|halvings| rings.measured(budget * 0.5f64.powi(halvings), run));
            // Whatever fits, or that it was cancelled.
            let found = halved.find(|found| found.as_ref().map_or(true, |(_, error)| *error <= tolerance));
            let missed = PatchError::Tolerance { value: tolerance, least: rings.finest, most: rings.size };
            found.ok_or(missed)??.0
        }
    };
    run.check()?;
    rings.finish(&draft, mesh);
    Ok(())
}

/// A surface ready to be cut into rings.
struct Rings<'a> {
    surface: &'a ParametricSurface,
    meridian: Arc,
    equator: Arc,
    along: Chain,
    around: Chain,
    /// Whether the surface ends in points, first and last.
    poles: [bool; 2],
    joined: bool,
    size: f64,
    finest: f64,
}

/// Triangles between vertices that are given by a row and a parameter of the equator.
struct Draft {
    rows: Vec<f64>,
    /// Of each row the parameters around, the last being that of the first vertex again; a pole has
    /// one.
    around: Vec<Vec<f64>>,
    /// Corners as (row, place around); the last place of a row is its first vertex.
    triangles: Vec<[(usize, usize); 3]>,
}

/// The range of tolerances, relative to the size.
pub(super) const TOLERANCES: [f64; 2] = [1e-6, 0.3];

impl<'a> Rings<'a> {
    fn new(surface: &'a ParametricSurface) -> Rings<'a> {
        let (meridian, equator) = (surface.meridian_arc(By::Even), surface.equator_arc(By::Even));
        let poles = match surface.shape {
            Shape::Ball | Shape::Horn => [true, true],
            Shape::Bowl => [true, false],
            _ => [false, false],
        };
        let size = surface.size();
        Rings {
            surface,
            along: meridian.chain(1024),
            around: equator.chain(1024),
            meridian,
            equator,
            poles,
            joined: surface.shape == Shape::Ring,
            size,
            finest: TOLERANCES[0] * size,
        }
    }

    /// How far a chord of the equator at a row is from the surface, relative to its height above
    /// the equator of unit size: the row's width, foreshortened by the slope of the surface.
    fn reach(&self, row: f64) -> f64 {
        let local = self.meridian.curve.at(row, By::Even);
        let steep = |k: usize| {
            let [first, last] = self.equator.range;
            let at = self.equator.curve.at(first + (last - first) * (k as f64 + 0.5) / 16.0, By::Even);
            let normal = self.surface.normal_of(local.normal, at.normal, at.point);
            self.surface.unplaced(normal).truncate().length()
        };
        local.point.x.abs() * (0..16).map(steep).fold(0.0, f64::max)
    }

    /// A draft within a budget, and how far it is off.
    fn measured(&self, budget: f64, run: &Run) -> Result<(Draft, f64), Cancelled> {
        let [drawing, measuring] = run.stages([1.0, 3.0]);
        let draft = self.draft(budget, &drawing)?;
        let error = self.deviation(&draft, &measuring)?;
        Ok((draft, error))
    }

    fn draft(&self, budget: f64, run: &Run) -> Result<Draft, Cancelled> {
        let half = 0.5 * budget;
        let least = if self.joined { 4 } else { 2 };
        let rows = self.meridian.chords(&self.along, half, least);
        let last = rows.len() - 1;
        let mut cache: HashMap<i32, Vec<f64>> = HashMap::new();
        let mut around = Vec::with_capacity(rows.len());
        let meter = Meter::new(run, rows.len());
        for (i, &row) in rows.iter().enumerate() {
            meter.step()?;
            if (i == 0 && self.poles[0]) || (i == last && self.poles[1]) {
                around.push(vec![self.equator.range[0]]);
                continue;
            }
            // The widest reach between the middles of the rows before and after.
            let before = rows[i.saturating_sub(1)];
            let after = rows[(i + 1).min(last)];
            let reach = (0..=8)
                .map(|k| {
                    row + (before - row) * 0.5 * (1.0 - f64::from(k) / 4.0).max(0.0)
                        + (after - row) * 0.5 * (f64::from(k) / 4.0 - 1.0).max(0.0)
                })
                .map(|t| self.reach(t))
                .fold(0.0, f64::max);
            // In steps of a tenth, so that rings alike share their samples.
            let step = (half / reach.max(1e-9)).min(self.size).log(1.1).floor() as i32;
            let ring = cache.entry(step).or_insert_with(|| self.equator.chords(&self.around, 1.1f64.powi(step), 4));
            around.push(ring.clone());
        }
        if self.joined {
            let first = around[0].clone();
            around[last] = first;
        }
        let mut triangles = vec![];
        for i in 0..last {
            join(i, &around[i], &around[i + 1], &mut triangles);
        }
        Ok(Draft { rows, around, triangles })
    }

    fn samples(&self, draft: &Draft) -> (Vec<Sample>, Vec<Vec<Sample>>) {
        let rows = draft.rows.iter().map(|&t| self.meridian.sample(t, self.meridian.texture(t))).collect();
        let ring = |ts: &Vec<f64>| ts.iter().map(|&t| self.equator.sample(t, self.equator.texture(t))).collect();
        (rows, draft.around.iter().map(ring).collect())
    }

    /// The point at a place of the mesh's parameters.
    fn point(&self, row: f64, around: f64) -> DVec3 {
        let (m, e) = (self.meridian.curve.at(row, By::Even), self.equator.curve.at(around, By::Even));
        self.surface.point_of(m.point, e.point)
    }

    /// The largest distance of the surface from the planes of the triangles, over ten places of
    /// each.
    fn deviation(&self, draft: &Draft, run: &Run) -> Result<f64, Cancelled> {
        let meter = Meter::new(run, draft.triangles.len());
        let points: Vec<Vec<DVec3>> = draft
            .rows
            .iter()
            .zip(&draft.around)
            .map(|(&row, around)| around.iter().map(|&t| self.point(row, t)).collect())
            .collect();
        let mut worst = 0.0f64;
        for corners in &draft.triangles {
            meter.step()?;
            let [a, b, c] = corners.map(|(row, at)| points[row][at]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let rows = corners.map(|(row, _)| draft.rows[row]);
            // A pole lies at every parameter around: at the middle of the other two.
            let mut ts = corners.map(|(row, at)| draft.around[row][at]);
            for k in 0..3 {
                if draft.around[corners[k].0].len() == 1 {
                    ts[k] = 0.5 * (ts[(k + 1) % 3] + ts[(k + 2) % 3]);
                }
            }
            for weights in PLACES {
                let mix = |v: [f64; 3]| v[0] * weights[0] + v[1] * weights[1] + v[2] * weights[2];
                let p = self.point(mix(rows), mix(ts));
                worst = worst.max((p - a).dot(normal).abs());
            }
        }
        Ok(worst)
    }

    fn finish(&self, draft: &Draft, mesh: &mut QuadMesh) {
        let (rows, around) = self.samples(draft);
        let last = rows.len() - 1;
        let surface = self.surface;
        let mut starts = vec![];
        for (i, row) in rows.iter().enumerate() {
            if self.joined && i == last {
                starts.push(starts[0]);
                continue;
            }
            starts.push(mesh.positions.len() as u32);
            let pole = around[i].len() == 1;
            let count = if pole { 1 } else { around[i].len() - 1 };
            for e in &around[i][..count] {
                mesh.positions.push(surface.point_of(row.point, e.point));
                let normal = surface.normal_of(row.normal, e.normal, e.point);
                let up = if i == 0 { DVec3::NEG_Z } else { DVec3::Z };
                mesh.normals.push(if pole { surface.placed(up) } else { normal });
            }
        }
        let vertex = |(row, at): (usize, usize)| {
            let count = around[row].len();
            starts[row] + if at + 1 == count { 0 } else { at as u32 }
        };
        for &corners in &draft.triangles {
            let corners = if surface.mirrored() { [corners[0], corners[2], corners[1]] } else { corners };
            let middle = corners.iter().map(|&(row, _)| row).sum::<usize>();
            let texture = corners.map(|(row, at)| DVec2::new(around[row][at].texture, rows[row].texture));
            let wide = |k: usize| around[corners[k].0].len() > 1;
            let mean = (0..3).filter(|&k| wide(k)).map(|k| texture[k].x).sum::<f64>()
                / (0..3).filter(|&k| wide(k)).count() as f64;
            let corner = |k: usize| {
                let (row, at) = corners[k];
                // The side on which the triangle is.
                let above = usize::from(middle > 3 * row);
                let (e, place) = if wide(k) {
                    (around[row][at], texture[k])
                } else {
                    let [first, last] = self.equator.range;
                    (self.equator.sample(first + (last - first) * mean, mean), DVec2::new(mean, texture[k].y))
                };
                let after = usize::from(mean > place.x);
                let m = rows[row].sides[above];
                Corner { normal: surface.normal_of(m, e.sides[after], e.point), texture: place }
            };
            mesh.triangles.push(corners.map(vertex));
            mesh.triangle_corners.push([corner(0), corner(1), corner(2)]);
        }
        if matches!(surface.shape, Shape::Tube | Shape::Bowl) {
            for (end, row) in [(0, 0), (1, last)] {
                if !self.poles[end] {
                    self.cap(row == last, starts[row], around[row].len() as u32 - 1, mesh);
                }
            }
        }
    }

    /// A flat fan across an end.
    fn cap(&self, last: bool, start: u32, count: u32, mesh: &mut QuadMesh) {
        let axis = self.surface.placed(DVec3::Z);
        let normal = if last { axis } else { -axis };
        let center = axis * mesh.positions[start as usize].dot(axis);
        let middle = mesh.positions.len() as u32;
        mesh.positions.push(center);
        mesh.normals.push(normal);
        for i in 0..count {
            let (a, b) = (start + i, start + (i + 1) % count);
            let forward = last != self.surface.mirrored();
            let triangle = if forward { [a, b, middle] } else { [b, a, middle] };
            mesh.triangle_corners.push(triangle.map(|v| {
                let p = self.surface.unplaced(mesh.positions[v as usize] - center).truncate();
                Corner { normal, texture: DVec2::splat(0.5) + p / (2.0 * self.size) }
            }));
            mesh.triangles.push(triangle);
        }
    }
}

/// Places in a triangle.
const PLACES: [[f64; 3]; 10] = [
    [0.5, 0.5, 0.0],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.75, 0.25, 0.0],
    [0.25, 0.75, 0.0],
    [0.75, 0.0, 0.25],
    [0.25, 0.0, 0.75],
    [0.0, 0.75, 0.25],
    [0.0, 0.25, 0.75],
];

/// The triangles between two rings, anticlockwise seen from outside.
fn join(row: usize, lower: &[f64], upper: &[f64], triangles: &mut Vec<[(usize, usize); 3]>) {
    let (mut i, mut j) = (0, 0);
    let ends = (lower.len() - 1, upper.len() - 1);
    while i < ends.0 || j < ends.1 {
        // Step where the next edge's middle comes first.
        let next = |ring: &[f64], at: usize| ring[at] + ring[at + 1];
        let step_lower = j == ends.1 || (i < ends.0 && next(lower, i) <= next(upper, j));
        if step_lower {
            triangles.push([(row, i), (row, i + 1), (row + 1, j)]);
            i += 1;
        } else {
            triangles.push([(row, i), (row + 1, j + 1), (row + 1, j)]);
            j += 1;
        }
    }
}
