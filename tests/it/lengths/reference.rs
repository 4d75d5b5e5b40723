//! Distances by brute force: to the triangles of a mesh of the solid, with the mesh's own error.
//!
//! Triangles are in a k-d tree (a bounding-volume hierarchy by median splits), so that thousands of
//! points can be asked.

use glam::DVec3;
use rvachev::{Bounds, CellSize, MeshSettings, Solid, error::MeshingError};

/// The triangles of a solid's mesh, and how far each is from the surface.
pub struct Surface {
    triangles: Vec<Triangle>,
    tree: Vec<Branch>,
    cell: f64,
    is_whole: bool,
}

struct Triangle {
    corners: [DVec3; 3],
    error: f64,
}

/// Triangles that are together: their box and their largest error.
struct Branch {
    bounds: Bounds,
    error: f64,
    from: usize,
    to: usize,
    /// The second of two halves, the first being the next of the list; none of a leaf.
    other: usize,
}

/// So many triangles are in a leaf.
const LEAF: usize = 8;

impl Surface {
    /// Of the mesh with so many cells along the longest side; `None` if the mesh is empty.
    pub fn new(solid: &Solid, cells: u32) -> Result<Option<Surface>, MeshingError> {
        let bounds = solid.finite_bounds()?;
        let mesh = solid.mesh(&MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() })?;
        let cell = bounds.longest_side() / f64::from(cells);
        let corners = |t: &[u32; 3]| t.map(|i| mesh.positions()[i as usize].as_dvec3());
        let corners: Vec<[DVec3; 3]> = mesh.triangles().iter().map(corners).collect();
        let errors = errors(solid, &corners, cell)?;
        let triangles = corners.into_iter().zip(errors).map(|(corners, error)| Triangle { corners, error });
        let mut surface =
            Surface { triangles: triangles.collect(), tree: Vec::new(), cell, is_whole: mesh.possibly_lost() == 0 };
        surface.grow(0, surface.triangles.len());
        Ok((!surface.triangles.is_empty()).then_some(surface))
    }

    /// Adds the branch of some triangles to the tree; gives its number.
    fn grow(&mut self, from: usize, to: usize) -> usize {
        let part = &mut self.triangles[from..to];
        let corners = part.iter().flat_map(|t| t.corners);
        let bounds = corners.fold(Bounds::EMPTY, |all, p| all.union(&Bounds::new(p, p)));
        let error = part.iter().map(|t| t.error).fold(0.0, f64::max);
        let number = self.tree.len();
        self.tree.push(Branch { bounds, error, from, to, other: 0 });
        if to - from > LEAF {
            let (axis, half) = (bounds.size().max_position(), (to - from) / 2);
            let middle = |t: &Triangle| t.corners.iter().map(|p| p[axis]).sum::<f64>();
            part.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
            self.grow(from, from + half);
            self.tree[number].other = self.grow(from + half, to);
        }
        number
    }

    /// The same of a solid that is known to have no features that its mesh may lose: faces that
    /// meet are suspect as well.
    pub fn known_whole(self) -> Surface {
        Surface { is_whole: true, ..self }
    }

    /// Whether the mesh has lost nothing.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The distance from a point to the surface: at least, and at most. Where the mesh may have
    /// lost a part, nothing is known of the least.
    pub fn distance(&self, p: DVec3) -> [f64; 2] {
        let mut nearest = f64::INFINITY;
        self.visit(p, |_, way, triangles| {
            let is_near = way < nearest;
            for triangle in triangles.iter().filter(|_| is_near) {
                nearest = nearest.min(p.distance(closest(p, triangle.corners)));
            }
            is_near
        });
        // Any triangle nearly as near may stand for the part of the surface that is nearest.
        let reach = nearest + 2.0 * self.cell;
        let mut error = 0.0_f64;
        self.visit(p, |branch, way, triangles| {
            if way >= reach || branch.error <= error {
                return false;
            }
            for triangle in triangles {
                if p.distance(closest(p, triangle.corners)) < reach {
                    error = error.max(triangle.error);
                }
            }
            true
        });
        [if self.is_whole { (nearest - error).max(0.0) } else { 0.0 }, nearest + error]
    }

    /// Goes through the branches, nearer ones first, with their least distances from a point and,
    /// of leaves, their triangles; and on to the halves of those for which this says so.
    fn visit(&self, p: DVec3, mut enters: impl FnMut(&Branch, f64, &[Triangle]) -> bool) {
        let mut pending = vec![0];
        while let Some(number) = pending.pop() {
            let branch = &self.tree[number];
            let way = branch.bounds.distance_squared(p).sqrt();
            let triangles = if branch.other == 0 { &self.triangles[branch.from..branch.to] } else { &[] };
            if enters(branch, way, triangles) && branch.other != 0 {
                let mut halves = [branch.other, number + 1];
                let way = |n: &usize| self.tree[*n].bounds.distance_squared(p);
                if way(&halves[0]) < way(&halves[1]) {
                    halves.reverse();
                }
                pending.extend(halves);
            }
        }
    }

    /// A point of the mesh, by a triangle's number and two numbers from 0 to 1.
    pub fn point(&self, triangle: usize, [u, v]: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].corners;
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        a + u * (b - a) + v * (c - a)
    }

    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }
}

/// How far triangles are from the surface: twice the largest value over its slope at seven points
/// of each, and the two thousandths of a cell that a vertex may be off.
fn errors(solid: &Solid, triangles: &[[DVec3; 3]], cell: f64) -> Result<Vec<f64>, rvachev::SolidError> {
    let points = triangles
        .iter()
        .flat_map(|&[a, b, c]| [a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0]);
    let points: Vec<DVec3> = points.collect();
    let (values, gradients) = (solid.values(&points)?, solid.gradients(&points)?);
    let off: Vec<f64> = values.iter().zip(&gradients).map(|(v, g)| (v.abs() / g.length()).min(cell)).collect();
    // `min` passes over what is not a number: a value of 0 without a slope.
    Ok(off.chunks(7).map(|off| 2.0 * off.iter().copied().fold(0.0, f64::max) + 2e-3 * cell).collect())
}

/// The point of a triangle that is nearest to `p`.
fn closest(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    let sum = va + vb + vc;
    a + vb / sum * ab + vc / sum * ac
}

#[test]
fn brute_force_finds_the_distance_to_a_box() -> Result<(), MeshingError> {
    let block = Solid::cuboid([2.0, 3.0, 4.0]);
    let surface = Surface::new(&block, 16)?.expect("a box has a surface");
    assert!(surface.is_whole());
    let mut random = crate::support::Random::new(1200);
    for _ in 0..200 {
        let p = random.vector(-3.0, 3.0);
        let ([least, most], want) = (surface.distance(p), crate::support::value(&block, p).abs());
        assert!((least..=most).contains(&want) && most - least < 0.01, "{p}: {least} to {most}, not {want}");
    }
    Ok(())
}
