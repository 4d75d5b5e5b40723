//! Triangles near a surface, and their vertices on it.

use glam::DVec3;
use rvachev_num::order;

use super::crease::{Plane, meet, slide, with_known};
use super::seam::{SETTLED, STEPS};
use crate::error::MeshingError;
use crate::eval::Program;
use crate::mesh::{Slopes, Subject};
use crate::{Bounds, Cancelled, CellSize, Features, Mesh, MeshSettings, Run, ThinFeatures};

/// What a mesh is whole with: the Euler characteristic of eight bodies, or of one with as many
/// handles and one more.
const WHOLE: usize = 16;

/// A vertex whose corners have normals that differ by more, in radians, is on a crease.
pub(super) const CREASE: f64 = 0.05;

/// How far from a crease its sides are looked at, in parts of the way to a triangle's middle: less
/// each time that the vertex is nearer.
const ASIDE: [f64; 4] = [0.2, 0.05, 0.01, 0.002];

/// The last of them only where it is farther than values may be off.
const LAST: f64 = ASIDE[3];

/// No vertex is moved farther than this in all, in parts of its shortest side.
const STRIDE: f64 = 0.4;

/// A mesh of what of a program is in a box, its creases sharp.
pub(super) fn sharp(program: &Program, bounds: Bounds, cell: f64, run: &Run) -> Result<Mesh, MeshingError> {
    let settings = MeshSettings {
        cell: CellSize::Length(cell),
        features: Features::Sharp,
        thin: ThinFeatures::Ignore,
        ..MeshSettings::default()
    };
    Subject { program, bounds, palette: None, whole: None }.mesh(&settings, run)
}

/// Triangles, each corner with its normal.
#[derive(Debug, Default)]
pub(super) struct Facets {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) normals: Vec<[DVec3; 3]>,
}

impl Facets {
    /// Those triangles of a mesh that are to be kept.
    pub(super) fn new(mesh: &Mesh, keep: impl Fn(&[DVec3; 3]) -> bool) -> Facets {
        let of_vertices = mesh.normals().unwrap_or_default();
        let of_corners = mesh.corner_normals();
        let mut facets =
            Facets { positions: mesh.positions().iter().map(|p| p.as_dvec3()).collect(), ..Facets::default() };
        for (number, triangle) in mesh.triangles().iter().enumerate() {
            if !keep(&mesh.corners(*triangle)) {
                continue;
            }
            let normals = match of_corners {
                Some(corners) => corners[number],
                None => triangle.map(|v| of_vertices.get(v as usize).copied().unwrap_or_default()),
            };
            facets.triangles.push(*triangle);
            facets.normals.push(normals.map(|n| n.as_dvec3()));
        }
        facets
    }

    /// Leaves out triangles on the faces of a box that cuts the surface off: those that are nearer
    /// to a face than to the surface. Where both meet at a small angle not all of their corners are
    /// on the face.
    pub(super) fn leave_faces(&mut self, of: &Bounds, slopes: &Slopes<'_>, run: &Run) -> Result<(), Cancelled> {
        let gap = |p: DVec3| (p - of.min).abs().min((of.max - p).abs()).min_element();
        let middle = |t: usize| {
            let [a, b, c] = self.triangles[t].map(|v| self.positions[v as usize]);
            ((a + b + c) / 3.0, a.distance(b).max(b.distance(c)).max(c.distance(a)))
        };
        let near = (0..self.triangles.len()).map(|t| (t, middle(t))).filter(|(_, (p, size))| gap(*p) < *size);
        let (near, middles): (Vec<usize>, Vec<DVec3>) = near.map(|(t, (p, _))| (t, p)).unzip();
        let mut on_face = vec![false; self.triangles.len()];
        for ((t, p), slope) in near.iter().zip(&middles).zip(slopes.at(&middles, run)?) {
            on_face[*t] = gap(*p) < slope.newton().length();
        }
        let mut other = on_face.iter().map(|on_face| !on_face);
        self.triangles.retain(|_| other.next().unwrap_or(true));
        let mut other = on_face.iter().map(|on_face| !on_face);
        self.normals.retain(|_| other.next().unwrap_or(true));
        Ok(())
    }

    /// Whether they have holes as a wall has that is thinner than the cells of its mesh, and torn
    /// for that: their Euler characteristic is that of many bodies, or of many handles.
    pub(super) fn is_torn(&self) -> bool {
        let mut vertices: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        let side = |[a, b]: [u32; 2]| u64::from(a.min(b)) << 32 | u64::from(a.max(b));
        let of_triangle = |&[a, b, c]: &[u32; 3]| [side([a, b]), side([b, c]), side([c, a])];
        let mut sides: Vec<u64> = self.triangles.iter().flat_map(of_triangle).collect();
        vertices.sort_unstable();
        vertices.dedup();
        sides.sort_unstable();
        sides.dedup();
        (vertices.len() + self.triangles.len()).abs_diff(sides.len()) > WHOLE
    }

    /// The area of all triangles.
    pub(super) fn area(&self) -> f64 {
        let of_triangle = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangles.iter().map(of_triangle).sum()
    }

    /// Moves the vertices onto the surface, and takes its normals.
    pub(super) fn polish(&mut self, slopes: &Slopes<'_>, run: &Run) -> Result<(), Cancelled> {
        let creased = self.creased();
        let start = self.positions.clone();
        let limits = self.shortest_sides();
        let held = |at: usize, to: DVec3| start[at] + (to - start[at]).clamp_length_max(STRIDE * limits[at]);
        // Nothing is asked of points without triangles.
        let asked = (0..start.len()).filter(|at| !creased[*at] && limits[*at] > 0.0);
        let mut open: Vec<(usize, Vec<Plane>)> = asked.map(|at| (at, Vec::new())).collect();
        let mut normals = vec![DVec3::ZERO; start.len()];
        for _ in 0..STEPS {
            let points: Vec<DVec3> = open.iter().map(|(at, _)| self.positions[*at]).collect();
            let mut found = slopes.at(&points, run)?.into_iter();
            open.retain_mut(|(at, known)| {
                let (at, slope) = (*at, found.next().unwrap_or_default());
                self.positions[at] = held(at, slide(self.positions[at], &slope, known));
                normals[at] = slope.normal();
                // What is left of a step goes with its square.
                slope.distance() > SETTLED * slopes.precision
            });
        }
        self.take_normals(&normals);
        self.polish_creases(slopes, (&creased, &limits), held, run)
    }

    /// The corners where a vertex is on a crease: their numbers, triangle by triangle.
    fn corners_at(&self, creased: &[bool]) -> Vec<(usize, usize)> {
        let corners = (0..self.triangles.len()).flat_map(|t| [(t, 0), (t, 1), (t, 2)]);
        corners.filter(|(t, k)| creased[self.triangles[*t][*k] as usize]).collect()
    }

    fn polish_creases(
        &mut self,
        slopes: &Slopes<'_>,
        (creased, limits): (&[bool], &[f64]),
        held: impl Fn(usize, DVec3) -> DVec3,
        run: &Run,
    ) -> Result<(), Cancelled> {
        let corners = self.corners_at(creased);
        // The corners by their vertices.
        let mut order: Vec<usize> = (0..corners.len()).collect();
        let vertices: Vec<usize> = corners.iter().map(|(t, k)| self.triangles[*t][*k] as usize).collect();
        order::rising(&mut order, |n| vertices[*n] as f64);
        let mut known: Vec<Vec<Plane>> = vec![Vec::new(); self.positions.len()];
        for aside in ASIDE {
            let beside = |&(t, k): &(usize, usize)| {
                let triangle = self.triangles[t].map(|v| self.positions[v as usize]);
                let middle = triangle.iter().sum::<DVec3>() / 3.0;
                triangle[k].lerp(middle, aside)
            };
            let points: Vec<DVec3> = corners.iter().map(beside).collect();
            let found = slopes.at(&points, run)?;
            let tells = |vertex: usize| aside > LAST || aside * limits[vertex] > slopes.precision;
            for (&(t, k), slope) in corners.iter().zip(&found) {
                let normal = slope.normal();
                if normal != DVec3::ZERO && tells(self.triangles[t][k] as usize) {
                    self.normals[t][k] = normal;
                }
            }
            for group in order.chunk_by(|a, b| vertices[*a] == vertices[*b]) {
                let at = vertices[group[0]];
                if !tells(at) {
                    continue;
                }
                let seen = group.iter().filter_map(|n| Plane::of(points[*n], &found[*n])).collect();
                known[at] = with_known(seen, &known[at]);
                self.positions[at] = held(at, meet(&known[at], self.positions[at]));
            }
        }
        Ok(())
    }

    /// Takes normals of vertices, where there are any.
    fn take_normals(&mut self, found: &[DVec3]) {
        for (triangle, normals) in self.triangles.iter().zip(&mut self.normals) {
            for (v, normal) in triangle.iter().zip(normals) {
                let own = found[*v as usize];
                if own != DVec3::ZERO {
                    *normal = own;
                }
            }
        }
    }

    /// Which vertices have corners whose normals differ.
    pub(super) fn creased(&self) -> Vec<bool> {
        let mut first = vec![DVec3::ZERO; self.positions.len()];
        let mut creased = vec![false; self.positions.len()];
        for (triangle, normals) in self.triangles.iter().zip(&self.normals) {
            for (v, normal) in triangle.iter().zip(normals) {
                let known = &mut first[*v as usize];
                if *known == DVec3::ZERO {
                    *known = *normal;
                } else if known.distance(*normal) > CREASE {
                    creased[*v as usize] = true;
                }
            }
        }
        creased
    }

    fn shortest_sides(&self) -> Vec<f64> {
        let mut shortest = vec![f64::INFINITY; self.positions.len()];
        for triangle in &self.triangles {
            for k in 0..3 {
                let [a, b] = [triangle[k] as usize, triangle[(k + 1) % 3] as usize];
                let length = self.positions[a].distance(self.positions[b]);
                shortest[a] = shortest[a].min(length);
                shortest[b] = shortest[b].min(length);
            }
        }
        // Of slivers the shortest side says nothing of how far off a vertex may be; of points
        // without triangles nothing is asked.
        let typical = shortest.iter().filter(|length| length.is_finite()).sum::<f64>() / shortest.len().max(1) as f64;
        shortest.iter().map(|length| if length.is_finite() { length.max(0.5 * typical) } else { 0.0 }).collect()
    }
}
