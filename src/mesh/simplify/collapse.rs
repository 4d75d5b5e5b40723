//! Vertices drawn into neighbours, one after the other (half-edge collapse).
//!
//! ```text
//!        l                     l            v takes the place of u: the two triangles at the side u–v are
//!       /|\                   / \           gone, the others at u have their corner at v. That is done if
//!    --/ | \--             --/   \--        l and r alone are next to both (else sheets would be joined),
//!     u--|--v      ---->         v          no triangle turns from its normals, and each point that the
//!    --\ | /--             --\   /--        triangles at u stood for is near one of those that are left.
//!       \|/                   \ /
//!        r                     r
//! ```

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec3, Vec3};

use super::near::distance_squared;
use super::quadric::Quadric;
use super::start::{Point, corners_of, creases_of, points_of, quadrics_of, stars_of};
use crate::geom::{Mesh, MeshError};
use crate::mesh::deviation::Probe;
use crate::{Cancelled, Run};

/// A triangle keeps this much of its area as it is seen along the normals of its corners, or nearly
/// what it had.
const FACING: f64 = 0.3;

/// The height of a triangle, in parts of its longest side: thinner ones come about only from ones
/// that are as thin.
const THIN: f64 = 0.03;
const THINNEST: f64 = 1e-3;

/// Vertices that have less of the tolerance are kept.
const KEPT: f64 = 0.05;

/// So many ways are tried to draw a vertex.
const TARGETS: usize = 4;

/// No vertex is of more triangles.
const MOST: usize = 40;

/// What is so many tolerances off the planes of a vertex is not looked at.
const FAR: f64 = 8.0;

/// How much a long way counts beside the distance from the planes: where all is flat, short sides
/// go first.
const LENGTH: f64 = 1e-3;

/// Vertices that are drawn before it is asked whether to go on.
const AT_ONCE: usize = 1 << 10;

/// A triangle, and the normals of the surface at its corners.
#[derive(Clone, Copy)]
pub(super) struct Corners {
    pub(super) vertices: [u32; 3],
    pub(super) normals: [Vec3; 3],
}

impl Corners {
    pub(super) fn has(&self, vertex: u32) -> bool {
        self.vertices.contains(&vertex)
    }

    pub(super) fn normal_at(&self, vertex: u32) -> Vec3 {
        (0..3).find(|k| self.vertices[*k] == vertex).map_or(Vec3::ZERO, |k| self.normals[k])
    }

    /// The same with another vertex in place of one, and its normal.
    fn with(mut self, vertex: u32, other: u32, normal: Vec3) -> Corners {
        for k in 0..3 {
            if self.vertices[k] == vertex {
                (self.vertices[k], self.normals[k]) = (other, normal);
            }
        }
        self
    }
}

/// The order of the heap: the least cost first, then the vertex. Of costs, which are not negative,
/// the bits have their order.
type Entry = Reverse<(u64, u32)>;

/// The cost of a vertex that is not to be drawn.
const NEVER: u64 = f64::INFINITY.to_bits();

/// A mesh while its vertices are drawn together.
pub(super) struct Collapse {
    tolerance: f64,
    positions: Vec<DVec3>,
    triangles: Vec<Corners>,
    is_gone: Vec<bool>,
    /// The triangles at each vertex.
    stars: Vec<Vec<u32>>,
    /// The other ends of creases at each vertex.
    creases: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    /// The points that each triangle stands for.
    points: Vec<Vec<Point>>,
    is_kept: Vec<bool>,
    /// The bits of what drawing a vertex costs at least: of its entries in the heap that one
    /// counts.
    costs: Vec<u64>,
    heap: BinaryHeap<Entry>,
    /// Points with the place of the triangle that is nearest among those that are left: kept, so as
    /// not to be made anew.
    parted: Vec<(Point, usize)>,
}

/// What drawing one vertex into another would make.
struct Draw {
    from: u32,
    to: u32,
    dying: [u32; 2],
    /// The triangles that are left at the first, as they will be.
    kept: Vec<(u32, Corners)>,
}

impl Collapse {
    /// A mesh to be drawn together within parts of a tolerance, one for each vertex.
    pub(super) fn new(mesh: &Mesh, probes: &[Probe], tolerance: f64, parts: &[f64]) -> Collapse {
        // Squares of large coordinates would cancel.
        let origin = mesh.bounds().center();
        let positions: Vec<DVec3> = mesh.positions().iter().map(|p| p.as_dvec3() - origin).collect();
        let triangles = corners_of(mesh);
        let stars = stars_of(&triangles, positions.len());
        let creases = creases_of(&triangles, &stars, mesh.owners());
        let quadrics = quadrics_of(&triangles, &positions, &creases);
        let points = points_of(probes, (&triangles, &stars, &positions), (&creases, origin), (tolerance, parts));
        Collapse {
            tolerance,
            is_gone: vec![false; triangles.len()],
            costs: vec![NEVER; positions.len()],
            positions,
            triangles,
            stars,
            creases,
            quadrics,
            points,
            is_kept: parts.iter().map(|part| *part < KEPT).collect(),
            heap: BinaryHeap::new(),
            parted: Vec::new(),
        }
    }

    /// Draws vertices together until none can be.
    pub(super) fn run(&mut self, run: &Run) -> Result<(), Cancelled> {
        let vertices = self.positions.len();
        for vertex in 0..vertices as u32 {
            if (vertex as usize).is_multiple_of(AT_ONCE) {
                run.check()?;
            }
            self.push(vertex);
        }
        let (mut steps, mut left) = (0, vertices);
        while let Some(Reverse((cost, vertex))) = self.heap.pop() {
            steps += 1;
            if usize::is_multiple_of(steps, AT_ONCE) {
                run.check()?;
                run.report(1.0 - left as f64 / vertices as f64);
            }
            if self.costs[vertex as usize] != cost {
                continue;
            }
            self.costs[vertex as usize] = NEVER;
            let mut targets: Vec<(f64, u32)> = self.targets(vertex).collect();
            targets.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            targets.dedup();
            let draw = targets.into_iter().take(TARGETS).find_map(|(_, to)| {
                let draw = self.draw(vertex, to)?;
                self.part(&draw).then_some(draw)
            });
            if let Some(draw) = draw {
                self.take(draw);
                left -= 1;
            }
        }
        Ok(())
    }

    /// Puts a vertex into the heap, by the least that drawing it costs, if it is not there by that.
    fn push(&mut self, vertex: u32) {
        let least = self.targets(vertex).map(|(cost, _)| cost).fold(f64::INFINITY, f64::min).to_bits();
        let before = std::mem::replace(&mut self.costs[vertex as usize], least);
        if least != before && least != NEVER {
            self.heap.push(Reverse((least, vertex)));
        }
    }

    /// The vertices that one may be drawn into, each with what that costs, once or twice.
    fn targets(&self, vertex: u32) -> impl Iterator<Item = (f64, u32)> {
        let v = vertex as usize;
        let (along, is_smooth) = match self.creases[v].len() {
            _ if self.is_kept[v] => (None, false),
            0 => (None, true),
            2 => (Some(&self.creases[v]), false),
            // An end, or a corner.
            _ => (None, false),
        };
        let around = is_smooth.then(|| self.around(vertex)).into_iter().flatten();
        let others = along.into_iter().flatten().copied().chain(around);
        let most = (FAR * self.tolerance).powi(2);
        others.filter_map(move |other| {
            let p = self.positions[other as usize];
            let off = self.quadrics[v].mean(p);
            let length = p.distance_squared(self.positions[v]);
            (off < most).then_some((off + LENGTH * self.tolerance * length.sqrt(), other))
        })
    }

    /// The vertices next to one, those within the mesh twice.
    fn around(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let corners = self.stars[vertex as usize].iter().flat_map(|t| self.triangles[*t as usize].vertices);
        corners.filter(move |other| *other != vertex)
    }

    /// What drawing a vertex into another makes, if the mesh stays manifold and no triangle turns.
    fn draw(&self, from: u32, to: u32) -> Option<Draw> {
        let star = &self.stars[from as usize];
        let mut dying = star.iter().copied().filter(|t| self.triangles[*t as usize].has(to));
        let dying = [dying.next()?, dying.next()?];
        let opposite = dying.map(|t| self.triangles[t as usize].vertices.into_iter().find(|v| *v != from && *v != to));
        let [Some(left), Some(right)] = opposite else { return None };
        if left == right || self.stars[to as usize].len() + star.len() > MOST + 4 {
            return None;
        }
        // The two others alone are next to both.
        let mut beside: Vec<u32> = self.around(to).collect();
        beside.sort_unstable();
        let mut both = self.around(from).filter(|v| beside.binary_search(v).is_ok());
        if both.any(|v| v != left && v != right) {
            return None;
        }
        // A crease that goes on beside the one that is drawn would fall onto it.
        if self.creases[from as usize].iter().any(|v| *v == left || *v == right) {
            return None;
        }
        // Nothing is of fewer than three triangles.
        let at_end = self.stars[to as usize].len() + star.len() - 4;
        if at_end < 3 || [left, right].iter().any(|v| self.stars[*v as usize].len() <= 3) {
            return None;
        }
        let gone = dying.map(|t| self.triangles[t as usize]);
        let mut kept = Vec::with_capacity(star.len());
        for &number in star.iter().filter(|t| !dying.contains(t)) {
            let old = self.triangles[number as usize];
            let own = old.normal_at(from);
            // The side of a crease that it is on is that of the triangle whose normal is nearer.
            let near = |t: &Corners| own.distance_squared(t.normal_at(from));
            let side = if near(&gone[1]) < near(&gone[0]) { gone[1] } else { gone[0] };
            let new = old.with(from, to, side.normal_at(to));
            if !self.is_fair(&old, &new) {
                return None;
            }
            kept.push((number, new));
        }
        Some(Draw { from, to, dying, kept })
    }

    fn places(&self, triangle: &Corners) -> [DVec3; 3] {
        triangle.vertices.map(|v| self.positions[v as usize])
    }

    /// Whether a triangle faces as its corners do, and is not too thin, or as much as the one that
    /// it takes the place of.
    fn is_fair(&self, old: &Corners, new: &Corners) -> bool {
        let shape = |triangle: &Corners| {
            let [a, b, c] = self.places(triangle);
            let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            let cross = (b - a).cross(c - a);
            let normal = cross.normalize_or_zero();
            let facing = triangle.normals.iter().map(|n| n.as_dvec3().dot(normal)).fold(1.0, f64::min);
            (normal, facing, cross.length() / longest.max(f64::MIN_POSITIVE))
        };
        let ((was, facing_before, height_before), (is, facing, height)) = (shape(old), shape(new));
        was.dot(is) > FACING
            && facing > FACING.min(facing_before - 0.02)
            && height > THINNEST
            && height > THIN.min(0.5 * height_before)
    }

    /// Parts the points that triangles stand for among those that are left, if none is too far from
    /// all.
    fn part(&mut self, draw: &Draw) -> bool {
        let face = |(_, triangle): &(u32, Corners)| {
            let [a, b, c] = self.places(triangle);
            ([a, b, c], (b - a).cross(c - a).normalize_or_zero())
        };
        let faces: Vec<([DVec3; 3], DVec3)> = draw.kept.iter().map(face).collect();
        self.parted.clear();
        for number in &self.stars[draw.from as usize] {
            for &point in &self.points[*number as usize] {
                let mut nearest = (f64::INFINITY, 0);
                for (n, (places, normal)) in faces.iter().enumerate() {
                    // What is beyond a crease does not stand for it, however near.
                    if point.normal != DVec3::ZERO && point.normal.dot(*normal) < FACING {
                        continue;
                    }
                    let square = distance_squared(point.at, *places);
                    if square < nearest.0 {
                        nearest = (square, n);
                    }
                }
                if nearest.0 > point.most {
                    return false;
                }
                self.parted.push((point, nearest.1));
            }
        }
        true
    }

    /// Draws a vertex, the points as they were parted.
    fn take(&mut self, Draw { from, to, dying, kept }: Draw) {
        for number in dying {
            let n = number as usize;
            self.is_gone[n] = true;
            self.points[n] = Vec::new();
            for vertex in self.triangles[n].vertices {
                self.stars[vertex as usize].retain(|t| *t != number);
            }
        }
        for (number, triangle) in &kept {
            self.triangles[*number as usize] = *triangle;
            self.points[*number as usize].clear();
            self.stars[to as usize].push(*number);
        }
        for (point, place) in &self.parted {
            self.points[kept[*place].0 as usize].push(*point);
        }
        self.stars[from as usize] = Vec::new();
        for end in std::mem::take(&mut self.creases[from as usize]) {
            self.creases[end as usize].retain(|v| *v != from);
            if end != to {
                self.creases[end as usize].push(to);
                self.creases[to as usize].push(end);
            }
        }
        let own = self.quadrics[from as usize];
        self.quadrics[to as usize].add(&own);
        // The others next to `to` have the triangles and the ways that they had.
        let mut changed: Vec<u32> = kept.iter().flat_map(|(_, triangle)| triangle.vertices).collect();
        changed.sort_unstable();
        changed.dedup();
        for vertex in changed {
            self.push(vertex);
        }
    }

    /// The mesh that is left of `base`, with what it found.
    pub(super) fn into_mesh(self, base: &Mesh) -> Result<Mesh, MeshError> {
        let mut numbers = vec![u32::MAX; self.positions.len()];
        let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let (mut corners, mut owners) = (Vec::new(), Vec::new());
        for (n, triangle) in self.triangles.iter().enumerate().filter(|(n, _)| !self.is_gone[*n]) {
            triangles.push(triangle.vertices.map(|vertex| {
                let number = &mut numbers[vertex as usize];
                if *number == u32::MAX {
                    *number = positions.len() as u32;
                    positions.push(base.positions()[vertex as usize]);
                    normals.extend(base.normals().map(|normals| normals[vertex as usize]));
                }
                *number
            }));
            corners.push(triangle.normals);
            owners.extend(base.owners().map(|owners| owners[n]));
        }
        let mut mesh = Mesh::new(positions, triangles)?.with_findings(base.findings().clone());
        if base.normals().is_some() {
            mesh = mesh.with_normals(normals)?;
        }
        if base.corner_normals().is_some() {
            mesh = mesh.with_corner_normals(corners)?;
        }
        if base.owners().is_some() {
            mesh = mesh.with_owners(owners)?;
        }
        Ok(mesh)
    }
}
