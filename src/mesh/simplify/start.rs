//! What drawing vertices together starts from: creases, planes, and the points to stay near.

use glam::{DVec3, Vec3};

use super::collapse::Corners;
use super::quadric::Quadric;
use crate::geom::Mesh;
use crate::mesh::deviation::Probe;

/// The normals on the two sides of a crease are farther apart than this: those of the corners of a
/// smooth surface are the same to the last digit.
const CREASE: f32 = 0.02;

/// What is off a plane by less, in tolerances, is on it.
const FLAT: f64 = 0.03;

/// Between vertices only points count that are farther off than this, in tolerances.
const MIDDLE: f64 = 0.1;

/// How much more a crease weighs than the faces beside it.
const ALONG: f64 = 4.0;

/// Each triangle with the normals at its corners.
pub(super) fn corners_of(mesh: &Mesh) -> Vec<Corners> {
    let of_vertices = mesh.normals();
    let of_corners = mesh.corner_normals();
    let normal = |number: usize, k: usize| match (of_corners, of_vertices) {
        (Some(corners), _) => corners[number][k],
        (None, Some(normals)) => normals[mesh.triangles()[number][k] as usize],
        (None, None) => Vec3::ZERO,
    };
    let corners = |(number, &vertices)| Corners { vertices, normals: [0, 1, 2].map(|k| normal(number, k)) };
    mesh.triangles().iter().enumerate().map(corners).collect()
}

/// The triangles at each vertex.
pub(super) fn stars_of(triangles: &[Corners], vertices: usize) -> Vec<Vec<u32>> {
    let mut stars = vec![Vec::new(); vertices];
    for (number, triangle) in (0u32..).zip(triangles) {
        triangle.vertices.iter().for_each(|v| stars[*v as usize].push(number));
    }
    stars
}

/// The other ends of the creases at each vertex: sides whose two triangles have other normals
/// there, or other owners.
pub(super) fn creases_of(triangles: &[Corners], stars: &[Vec<u32>], owners: Option<&[u32]>) -> Vec<Vec<u32>> {
    let mut creases = vec![Vec::new(); stars.len()];
    for (number, triangle) in (0u32..).zip(triangles) {
        for k in 0..3 {
            let (a, b) = (triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
            let beyond: Vec<u32> =
                stars[a as usize].iter().copied().filter(|t| *t != number && triangles[*t as usize].has(b)).collect();
            let is_crease = match beyond[..] {
                [other] => {
                    let far = |v: u32| triangle.normal_at(v).distance(triangles[other as usize].normal_at(v)) > CREASE;
                    far(a) || far(b) || owners.is_some_and(|of| of[number as usize] != of[other as usize])
                }
                // What is open, or of three sheets, stays.
                _ => true,
            };
            if is_crease && !creases[a as usize].contains(&b) {
                creases[a as usize].push(b);
                creases[b as usize].push(a);
            }
        }
    }
    creases
}

/// The planes at each vertex: those of its triangles, by their areas, and those across its creases.
pub(super) fn quadrics_of(triangles: &[Corners], positions: &[DVec3], creases: &[Vec<u32>]) -> Vec<Quadric> {
    let mut quadrics = vec![Quadric::NONE; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.vertices.map(|v| positions[v as usize]);
        let cross = (b - a).cross(c - a);
        let Some(normal) = cross.try_normalize() else { continue };
        let plane = Quadric::plane(normal, a, cross.length());
        triangle.vertices.iter().for_each(|v| quadrics[*v as usize].add(&plane));
        for k in 0..3 {
            let (from, to) = (triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
            if !creases[from as usize].contains(&to) {
                continue;
            }
            let side = positions[to as usize] - positions[from as usize];
            if let Some(across) = side.cross(normal).try_normalize() {
                let plane = Quadric::plane(across, positions[from as usize], ALONG * side.length_squared());
                [from, to].iter().for_each(|v| quadrics[*v as usize].add(&plane));
            }
        }
    }
    quadrics
}

/// A point of the surface, and the normal of the side of it that a triangle stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) at: DVec3,
    pub(super) normal: DVec3,
    /// The square of how far triangles may be from it.
    pub(super) most: f64,
}

/// The points that each triangle stands for: the vertices and what is off between, from `origin`,
/// each with a tolerance of its own. Those within flat parts that have all of it are left out:
/// their borders tell.
pub(super) fn points_of(
    probes: &[Probe],
    (triangles, stars, positions): (&[Corners], &[Vec<u32>], &[DVec3]),
    (creases, origin): (&[Vec<u32>], DVec3),
    (tolerance, parts): (f64, &[f64]),
) -> Vec<Vec<Point>> {
    let near = FLAT * tolerance;
    let most = |vertex: u32| (tolerance * parts[vertex as usize]).powi(2);
    let is_flat = |vertex: u32| {
        let p = positions[vertex as usize];
        let is_on = |t: &u32| {
            let triangle = &triangles[*t as usize];
            let normal = triangle.normal_at(vertex).as_dvec3();
            triangle.vertices.iter().all(|v| (positions[*v as usize] - p).dot(normal).abs() < near)
        };
        creases[vertex as usize].is_empty() && stars[vertex as usize].iter().all(is_on)
    };
    let flat: Vec<bool> = (0..stars.len() as u32).map(is_flat).collect();
    let is_within = |vertex: u32| {
        let mut around = stars[vertex as usize].iter().flat_map(|t| triangles[*t as usize].vertices);
        parts[vertex as usize] == 1.0 && around.all(|v| flat[v as usize])
    };
    let mut points = vec![Vec::new(); triangles.len()];
    for probe in probes {
        let triangle = &triangles[probe.triangle as usize];
        let (normal, most) = match probe.vertex {
            Some(vertex) if !creases[vertex as usize].is_empty() => continue,
            Some(vertex) if probe.off < near && is_within(vertex) => continue,
            None if probe.off < MIDDLE * tolerance => continue,
            Some(vertex) => (triangle.normal_at(vertex).as_dvec3(), most(vertex)),
            None => {
                let normal = triangle.normals.iter().sum::<Vec3>().as_dvec3().normalize_or_zero();
                (normal, triangle.vertices.iter().map(|v| most(*v)).fold(f64::INFINITY, f64::min))
            }
        };
        points[probe.triangle as usize].push(Point { at: probe.foot - origin, normal, most });
    }
    // On a crease a vertex is a point of each side, as near to the surface as the mesh can tell.
    for (vertex, star) in (0u32..).zip(stars).filter(|(vertex, _)| !creases[*vertex as usize].is_empty()) {
        let mut sides: Vec<Vec3> = Vec::new();
        for &number in star {
            let normal = triangles[number as usize].normal_at(vertex);
            if sides.iter().all(|side| side.distance(normal) > CREASE) {
                sides.push(normal);
                let (at, normal) = (positions[vertex as usize], normal.as_dvec3());
                points[number as usize].push(Point { at, normal, most: most(vertex) });
            }
        }
    }
    points
}
