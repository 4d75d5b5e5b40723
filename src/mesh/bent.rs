//! Edges of a mesh are bent where the surface is.
//!
//! ```text
//!            c                     c
//!           / \                   /|\           The middle of an edge goes along the normal to the surface,
//!          /   \                 / | \          and the triangles on both sides are cut in two. Where two
//!         a-----b               a--m--b         or three edges of a triangle are bent, it is cut in three
//!          \   /                 \ | /          or four.
//!           \ /                   \|/
//! ```
//!
//! So rounds and bevels as small as a cell, and rims, get more triangles, and nothing else does. Parts
//! that are near to each other may pass through each other then: it is for pictures.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::slopes::{Slope, Slopes};
use crate::eval::Program;
use crate::geom::Mesh;
use crate::{Cancelled, Run};

/// So often the way to the surface is doubled or halved.
const STEPS: usize = 8;

/// Normals are alike that have this cosine at least.
const LIKE: f64 = 0.2;

/// A mesh whose edges are bent where their middles are farther from the surface than a tolerance,
/// along the normal, but nearer than half of the edge; and their halves again, so many times. A mesh
/// without normals or owners stays as it is.
pub(crate) fn bent(
    mesh: Mesh,
    program: &Program,
    (tolerance, times): (f64, u32),
    run: &Run,
) -> Result<Mesh, Cancelled> {
    let Some(mut bent) = Bent::new(&mesh) else { return Ok(mesh) };
    let (count, mut first) = (mesh.positions().len(), 0);
    for time in 0..times {
        let [done, next] = [time, time + 1].map(|time| f64::from(time) / f64::from(times));
        let middles = bent.middles(first, (program, tolerance), &run.stage(done, next))?;
        first = bent.positions.len() as u32;
        bent.bend(&middles);
    }
    Ok(if bent.positions.len() > count { bent.into_mesh(&mesh).unwrap_or(mesh) } else { mesh })
}

/// A mesh in pieces.
struct Bent {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    faces: Vec<Face>,
}

#[derive(Clone, Copy)]
struct Face {
    corners: [u32; 3],
    normals: [Vec3; 3],
    owner: u32,
}

impl Face {
    fn new(corners: [(u32, Vec3); 3], owner: u32) -> Face {
        Face { corners: corners.map(|(vertex, _)| vertex), normals: corners.map(|(_, normal)| normal), owner }
    }
}

/// The numbers of its ends, the lower one first.
type Edge = [u32; 2];

/// The way from the middle of an edge along the normal, outwards or inwards.
#[derive(Clone, Copy)]
struct Way {
    edge: Edge,
    middle: DVec3,
    normal: DVec3,
    /// Those of the edge's ends.
    normals: [Vec3; 2],
    is_outwards: bool,
    length: f64,
}

impl Way {
    fn at(&self, by: f64) -> DVec3 {
        self.middle + by * self.normal
    }

    /// The way to the surface, given the slopes a tolerance outwards and inwards: `None` where they
    /// are on its two sides.
    fn turned(&self, beside: [&Slope; 2]) -> Option<Way> {
        match [beside[0].value > 0.0, beside[1].value < 0.0] {
            [true, false] => Some(*self),
            [false, true] => Some(Way { normal: -self.normal, is_outwards: false, ..*self }),
            _ => None,
        }
    }
}

/// How far a way goes on, at least and at most. At first there is no end to it.
struct Search {
    way: Way,
    reach: [f64; 2],
    /// The normal where it was last asked.
    facing: DVec3,
}

impl Search {
    fn new(way: Way, least: f64) -> Search {
        Search { way, reach: [least, f64::INFINITY], facing: DVec3::ZERO }
    }

    fn is_too_far(&self) -> bool {
        let [least, most] = self.reach;
        most.is_infinite() && least > 0.5 * self.way.length
    }

    fn next(&self) -> f64 {
        let [least, most] = self.reach;
        if most.is_finite() { least.midpoint(most) } else { 2.0 * least }
    }

    fn step(&mut self, slope: &Slope) {
        self.reach[usize::from((slope.value > 0.0) != self.way.is_outwards)] = self.next();
        self.facing = slope.normal();
    }

    /// Where it ends, on a surface that faces as one of the edge's ends does: what it meets beyond
    /// a concave edge is another face.
    fn end(&self) -> Option<DVec3> {
        let is_own = self.way.normals.iter().any(|normal| normal.as_dvec3().dot(self.facing) > LIKE);
        (is_own && self.reach[1].is_finite()).then(|| self.way.at(self.reach[0]))
    }
}

impl Bent {
    fn new(mesh: &Mesh) -> Option<Bent> {
        let (normals, corners, owners) = (mesh.normals()?, mesh.corner_normals()?, mesh.owners()?);
        let faces = mesh.triangles().iter().zip(corners).zip(owners);
        let faces = faces.map(|((&corners, &normals), &owner)| Face { corners, normals, owner });
        Some(Bent { positions: mesh.positions().to_vec(), normals: normals.to_vec(), faces: faces.collect() })
    }

    /// The edges to be bent, of those that end in a vertex from `first` on, and where their middles
    /// go.
    fn middles(
        &self,
        first: u32,
        (program, tolerance): (&Program, f64),
        run: &Run,
    ) -> Result<Vec<(Edge, Vec3)>, Cancelled> {
        let [to_look, to_go] = run.stages([0.7, 0.3]);
        let slopes = Slopes::within(program, tolerance);
        let ways: Vec<Way> = self.faces.iter().flat_map(|face| self.ways(face, first)).flatten().collect();
        let beside: Vec<DVec3> = ways.iter().flat_map(|way| [way.at(tolerance), way.at(-tolerance)]).collect();
        let found = slopes.at(&beside, &to_look)?;
        let off = ways.iter().zip(found.chunks(2)).filter_map(|(way, beside)| way.turned([&beside[0], &beside[1]]));
        let mut off: Vec<Search> = off.map(|way| Search::new(way, tolerance)).collect();
        for run in to_go.stages([1.0; STEPS]) {
            off.retain(|search| !search.is_too_far());
            let points: Vec<DVec3> = off.iter().map(|search| search.way.at(search.next())).collect();
            off.iter_mut().zip(slopes.at(&points, &run)?).for_each(|(search, slope)| search.step(&slope));
        }
        Ok(off.iter().filter_map(|search| Some((search.way.edge, search.end()?.as_vec3()))).collect())
    }

    /// Those along the edges of a face. An edge whose faces have the normals of its vertices is one of
    /// both, and counted once.
    fn ways(&self, face: &Face, first: u32) -> [Option<Way>; 3] {
        [[0, 1], [1, 2], [2, 0]].map(|ends| {
            let [from, to] = ends.map(|k| face.corners[k]);
            let normals = ends.map(|k| face.normals[k]);
            let edge = [from.min(to), from.max(to)];
            let is_even = || normals == [from, to].map(|vertex| self.normals[vertex as usize]);
            if edge[1] < first || (from > to && is_even()) {
                return None;
            }
            let [start, end] = edge.map(|vertex| self.positions[vertex as usize].as_dvec3());
            let normal = (normals[0] + normals[1]).as_dvec3().try_normalize()?;
            Some(Way {
                edge,
                middle: start.midpoint(end),
                normal,
                normals,
                is_outwards: true,
                length: start.distance(end),
            })
        })
    }

    fn bend(&mut self, middles: &[(Edge, Vec3)]) {
        let mut ends = vec![false; self.positions.len()];
        let mut numbers = HashMap::new();
        for &(edge, middle) in middles {
            numbers.entry(edge).or_insert_with(|| {
                let [from, to] = edge.map(|vertex| self.normals[vertex as usize]);
                self.positions.push(middle);
                self.normals.push(between(from, to));
                self.positions.len() as u32 - 1
            });
            edge.into_iter().for_each(|vertex| ends[vertex as usize] = true);
        }
        let middle = |from: u32, to: u32| {
            let is_end = ends[from as usize] && ends[to as usize];
            if is_end { numbers.get(&[from.min(to), from.max(to)]).copied() } else { None }
        };
        for n in 0..self.faces.len() {
            let [a, b, c] = self.faces[n].corners;
            self.cut(n, [middle(a, b), middle(b, c), middle(c, a)]);
        }
    }

    /// Cuts a face at the middles of its edges, of which the first is that from its first corner to
    /// its second.
    fn cut(&mut self, number: usize, middles: [Option<u32>; 3]) {
        let Face { corners, normals, owner } = self.faces[number];
        // Turned so that the edges that are bent come first.
        let is_bent = |k: usize| middles[k % 3].is_some();
        let Some(first) = (0..3).find(|k| is_bent(*k) && !is_bent(k + 2)).or(is_bent(0).then_some(0)) else { return };
        let turned = [0, 1, 2].map(|k| (first + k) % 3);
        let [a, b, c] = turned.map(|k| (corners[k], normals[k]));
        let middle = |k: usize| middles[k].map(|vertex| (vertex, between(normals[k], normals[(k + 1) % 3])));
        let length = |from: u32, to: u32| self.positions[from as usize].distance(self.positions[to as usize]);
        let parts = match turned.map(middle) {
            [Some(x), Some(y), Some(z)] => vec![[x, y, z], [a, x, z], [b, y, x], [c, z, y]],
            [Some(x), Some(y), _] if length(a.0, y.0) < length(x.0, c.0) => vec![[x, b, y], [a, x, y], [a, y, c]],
            [Some(x), Some(y), _] => vec![[x, b, y], [a, x, c], [x, y, c]],
            [Some(x), ..] => vec![[a, x, c], [x, b, c]],
            [None, ..] => return,
        };
        let faces: Vec<Face> = parts.into_iter().map(|corners| Face::new(corners, owner)).collect();
        self.faces[number] = faces[0];
        self.faces.extend_from_slice(&faces[1..]);
    }

    fn into_mesh(self, of: &Mesh) -> Option<Mesh> {
        let mesh = Mesh::new(self.positions, self.faces.iter().map(|face| face.corners).collect()).ok()?;
        let mesh = mesh.with_normals(self.normals).ok()?;
        let mesh = mesh.with_corner_normals(self.faces.iter().map(|face| face.normals).collect()).ok()?;
        let mesh = mesh.with_owners(self.faces.iter().map(|face| face.owner).collect()).ok()?;
        Some(mesh.with_findings(of.findings().clone()))
    }
}

/// The normal in the middle between two.
fn between(one: Vec3, other: Vec3) -> Vec3 {
    (one + other).normalize_or(one)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::compiled;
    use crate::raster::ClosedMesh;
    use crate::{CellSize, MeshSettings, Profile, Solid, deg};

    fn mesh(solid: &Solid, cell: f64) -> Mesh {
        let settings = MeshSettings { cell: CellSize::Length(cell), owners: true, ..MeshSettings::default() };
        solid.mesh(&settings).unwrap()
    }

    /// In cells of .1, plain and bent so many times.
    fn both(solid: &Solid, times: u32) -> [Mesh; 2] {
        let plain = mesh(solid, 0.1);
        let program = &compiled(solid).unwrap().surface;
        let bent = bent(plain.clone(), program, (0.007, times), &Run::default()).unwrap();
        assert!(ClosedMesh::new(&bent).is_ok(), "it stays closed");
        [plain, bent]
    }

    #[test]
    fn rounds_and_corners_as_small_as_a_cell_are_seen() {
        let disc = Profile::rounded_rectangle([2.0, 0.25], 0.12).revolve().rotate_x(deg(25.0));
        let tooth = Solid::cuboid([1.0, 0.12, 1.0]).rotate_y(deg(20.0)).rotate_x(deg(35.0));
        // How far the volumes are off, once and twice bent, by those that are not.
        for (name, solid, most) in [("disc", disc, [0.5, 0.5]), ("tooth", tooth, [0.25, 0.1])] {
            let exact = mesh(&solid, 0.01).volume();
            let ([plain, once], [_, twice]) = (both(&solid, 1), both(&solid, 2));
            let [plain, once, twice] = [plain, once, twice].map(|mesh| (mesh.volume() - exact).abs());
            assert!(once < most[0] * plain && twice < most[1] * plain, "{name}: {plain}, {once}, {twice}");
        }
    }

    #[test]
    fn concave_edges_stay() {
        // A middle on the plate, within the hub, is no part of the hub's wall far above it.
        let hub = Solid::cone(0.5, 0.45, 0.6).translate([0.0, 0.0, 0.3]) | Solid::cuboid([1.6, 1.6, 0.3]);
        let [plain, bent] = both(&hub, 2);
        assert_eq!(plain.triangles(), bent.triangles());
    }

    #[test]
    fn middles_go_no_farther_than_half_of_their_edges() {
        // The rim of a flat cone is cut off, by more than a cell here and there.
        let cone = Solid::cone(1.0, 0.0, 0.15).rotate_x(deg(7.0));
        let plain = mesh(&cone, 0.1);
        let program = &compiled(&cone).unwrap().surface;
        let middles = Bent::new(&plain).unwrap().middles(0, (program, 0.007), &Run::default()).unwrap();
        assert!(middles.len() > 10);
        for (edge, middle) in middles {
            let [from, to] = edge.map(|vertex| plain.positions()[vertex as usize]);
            let (off, length) = (middle.distance(from.midpoint(to)), from.distance(to));
            assert!(off < length, "{off} of {length}");
        }
    }

    #[test]
    fn what_is_flat_stays_as_it_is() {
        let [plain, bent] = both(&Solid::cuboid([1.0, 0.7, 0.5]).rotate_x(deg(20.0)), 2);
        assert_eq!(plain.triangles(), bent.triangles());
        let [plain, bent] = both(&Solid::sphere(1.0), 2);
        assert_eq!(plain.triangles(), bent.triangles());
    }
}
