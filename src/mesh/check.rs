//! What can be said about a mesh: whether it is closed, manifold and of which topology.
//!
//! ```text
//!   an edge between two triangles,     a vertex whose triangles       one whose triangles
//!   used once in each direction        close to a single ring         make two rings
//!
//!          *-------*                        *-----*                    *---*     *---*
//!         / \  ↑↓ /                        / \   / \                    \ / \   / \ /
//!        /   \   /                        *---- * --*                    *---- * --*
//!       *-----* *                          \   / \ /                    / \ /   \ / \
//!                                           *---*                      *---*     *---*
//! ```
//!
//! Everything is found by sorting: directed edges by their two ends, corners by their vertex,
//! vertices by their position. Positions are compared as they are, without a tolerance.

use glam::DVec3;
use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::geom::Mesh;

/// The findings of [`Mesh::check`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices, used or not.
    pub vertices: usize,
    /// Vertices that no triangle uses.
    pub unused_vertices: usize,
    /// Edges that a single triangle uses: the mesh has a hole there.
    pub boundary_edges: usize,
    /// Edges that more than two triangles use, or two in the same direction.
    pub non_manifold_edges: usize,
    /// Vertices whose triangles form neither a single ring nor, at a boundary, a single fan.
    pub non_manifold_vertices: usize,
    /// Triangles with a repeated index, or with an area of 0 as computed in f64 from the f32
    /// positions.
    pub degenerate_triangles: usize,
    /// Vertices at the very position of another one that is counted already.
    pub duplicate_vertices: usize,
    /// Connected pieces of surface; triangles hang together by shared edges.
    pub shells: usize,
    /// Vertices − edges + triangles, of what the triangles use.
    pub euler_characteristic: i64,
    /// The number of handles, over all shells: shells − Euler characteristic / 2. `None` if
    /// the mesh is not closed and manifold.
    pub genus: Option<i64>,
    /// The enclosed volume, in cubic length units; see [`Mesh::volume`].
    pub volume: f64,
    /// The area, in square length units.
    pub area: f64,
    /// The centroid of the enclosed volume; see [`Mesh::centroid`].
    pub centroid: Option<DVec3>,
    /// The smallest box that holds all vertices.
    pub bounds: Bounds,
}

impl MeshReport {
    /// Whether every edge has two triangles or more: there are triangles, and no boundary.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.triangles > 0 && self.boundary_edges == 0
    }

    /// Whether edges and vertices are manifold and consistently oriented, and no triangle is
    /// degenerate. A mesh with a boundary can be.
    #[must_use]
    pub fn is_manifold(&self) -> bool {
        self.non_manifold_edges == 0 && self.non_manifold_vertices == 0 && self.degenerate_triangles == 0
    }
}

impl Mesh {
    /// Examines the mesh. Takes a fraction of a second for a million triangles.
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    ///
    /// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let report = Mesh::new(positions, triangles)?.check();
    /// assert!(report.is_closed() && report.is_manifold());
    /// assert_eq!((report.shells, report.genus), (1, Some(0)));
    /// # Ok::<(), rvachev::MeshError>(())
    /// ```
    #[must_use]
    pub fn check(&self) -> MeshReport {
        let edges = Edges::new(self.triangles());
        let fans = Fans::new(self.positions().len(), self.triangles());
        let euler_characteristic = fans.used as i64 - edges.count as i64 + self.triangles().len() as i64;
        let mut report = MeshReport {
            triangles: self.triangles().len(),
            vertices: self.positions().len(),
            unused_vertices: self.positions().len() - fans.used,
            boundary_edges: edges.boundary,
            non_manifold_edges: edges.non_manifold,
            non_manifold_vertices: fans.non_manifold,
            degenerate_triangles: degenerate_triangles(self),
            duplicate_vertices: duplicate_vertices(self),
            shells: edges.shells,
            euler_characteristic,
            genus: None,
            volume: self.volume(),
            area: self.area(),
            centroid: self.centroid(),
            bounds: self.bounds(),
        };
        if report.is_closed() && report.is_manifold() {
            report.genus = Some(report.shells as i64 - euler_characteristic / 2);
        }
        report
    }
}

/// What the edges tell.
struct Edges {
    count: usize,
    boundary: usize,
    non_manifold: usize,
    shells: usize,
}

impl Edges {
    fn new(triangles: &[[u32; 3]]) -> Edges {
        // (both ends, lower first; whether the triangle runs downwards; the triangle)
        let mut uses: Vec<(u64, bool, u32)> = triangles
            .par_iter()
            .enumerate()
            .flat_map_iter(|(t, &[a, b, c])| {
                [[a, b], [b, c], [c, a]].map(|[from, to]| {
                    let ends = u64::from(from.min(to)) << 32 | u64::from(from.max(to));
                    (ends, from > to, t as u32)
                })
            })
            .collect();
        uses.par_sort_unstable();

        let mut edges = Edges { count: 0, boundary: 0, non_manifold: 0, shells: triangles.len() };
        let mut groups = Groups::new(triangles.len());
        for edge in uses.chunk_by(|a, b| a.0 == b.0) {
            edges.count += 1;
            match edge {
                [_] => edges.boundary += 1,
                [(_, false, _), (_, true, _)] => {}
                _ => edges.non_manifold += 1,
            }
            for pair in edge.windows(2) {
                if groups.join(pair[0].2, pair[1].2) {
                    edges.shells -= 1;
                }
            }
        }
        edges
    }
}

/// Disjoint sets of triangles.
struct Groups(Vec<u32>);

impl Groups {
    fn new(count: usize) -> Groups {
        Groups((0..count as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            // Halving the path keeps later walks short.
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    /// Joins the sets of two triangles; whether they were different.
    fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}

/// What the triangles around the vertices tell.
struct Fans {
    used: usize,
    non_manifold: usize,
}

impl Fans {
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> Fans {
        // Around its corner a, the triangle [a, b, c] leads from b to c. Corners are put
        // together by vertex with a counting sort.
        let mut starts = vec![0usize; vertices + 1];
        for &v in triangles.as_flattened() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..vertices {
            starts[v + 1] += starts[v];
        }
        let mut steps = vec![(0, 0); 3 * triangles.len()];
        let mut free = starts.clone();
        for &[a, b, c] in triangles {
            for (corner, step) in [(a, (b, c)), (b, (c, a)), (c, (a, b))] {
                let slot = &mut free[corner as usize];
                steps[*slot] = step;
                *slot += 1;
            }
        }

        let mut fans = Fans { used: 0, non_manifold: 0 };
        for range in starts.windows(2) {
            let steps = &mut steps[range[0]..range[1]];
            if !steps.is_empty() {
                fans.used += 1;
                fans.non_manifold += usize::from(!is_one_fan(steps));
            }
        }
        fans
    }
}

/// Whether the steps around a vertex make a single ring, or a single path.
fn is_one_fan(steps: &mut [(u32, u32)]) -> bool {
    steps.sort_unstable();
    if steps.windows(2).any(|w| w[0].0 == w[1].0) {
        return false;
    }
    let find = |from: u32| steps.binary_search_by_key(&from, |s| s.0).ok();
    // A path begins where no step leads to; a ring, anywhere. Every step that leads to a
    // start of another is counted, so that two steps to the same place leave two beginnings.
    let mut is_reached = vec![false; steps.len()];
    for &(_, to) in steps.iter() {
        if let Some(i) = find(to) {
            is_reached[i] = true;
        }
    }
    let first = is_reached.iter().position(|&r| !r).unwrap_or(0);
    let mut at = first;
    for visited in 1..=steps.len() {
        match find(steps[at].1) {
            Some(next) if next != first => at = next,
            // The end of the path, or the ring is closed: nothing must be left over.
            _ => return visited == steps.len(),
        }
    }
    false
}

fn degenerate_triangles(mesh: &Mesh) -> usize {
    let is_degenerate = |&t: &[u32; 3]| {
        let [a, b, c] = mesh.corners(t);
        (b - a).cross(c - a) == DVec3::ZERO
    };
    mesh.triangles().par_iter().filter(|t| is_degenerate(t)).count()
}

fn duplicate_vertices(mesh: &Mesh) -> usize {
    // Adding 0 makes −0 and 0 the same.
    let mut keys: Vec<[u32; 3]> =
        mesh.positions().par_iter().map(|p| p.to_array().map(|x| (x + 0.0).to_bits())).collect();
    keys.par_sort_unstable();
    keys.windows(2).filter(|w| w[0] == w[1]).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn corners(at: Vec3) -> [Vec3; 4] {
        [at, at + Vec3::X, at + Vec3::Y, at + Vec3::Z]
    }

    fn shifted(by: u32) -> impl Iterator<Item = [u32; 3]> {
        TETRAHEDRON.into_iter().map(move |t| t.map(|i| i + by))
    }

    /// A torus of n × n quadrilaterals.
    fn torus(n: u32) -> Mesh {
        let at = |i: u32, j: u32| (i % n) * n + j % n;
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let turn = std::f64::consts::TAU / f64::from(n);
                let (u, v) = (f64::from(i) * turn, f64::from(j) * turn);
                let r = 2.0 + v.cos();
                let p = DVec3::new(r * u.cos(), r * u.sin(), v.sin());
                positions.push(p.as_vec3());
                let (a, b) = (at(i, j), at(i + 1, j));
                let (c, d) = (at(i + 1, j + 1), at(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        Mesh::new(positions, triangles).unwrap()
    }

    #[test]
    fn closed_shells() {
        let positions = [corners(Vec3::ZERO), corners(Vec3::splat(5.0))].concat();
        let triangles = TETRAHEDRON.into_iter().chain(shifted(4)).collect();
        let report = Mesh::new(positions, triangles).unwrap().check();
        assert!(report.is_closed() && report.is_manifold());
        assert_eq!(report.shells, 2);
        assert_eq!(report.euler_characteristic, 4);
        assert_eq!(report.genus, Some(0));
        assert!((report.volume - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(report.duplicate_vertices + report.unused_vertices, 0);
    }

    #[test]
    fn a_torus_has_one_handle() {
        let report = torus(40).check();
        assert!(report.is_closed() && report.is_manifold());
        assert_eq!((report.euler_characteristic, report.genus), (0, Some(1)));
        let exact = 2.0 * std::f64::consts::PI.powi(2) * 2.0;
        assert!((report.volume / exact - 1.0).abs() < 0.02);
        assert!(report.centroid.unwrap().length() < 1e-6);
    }

    #[test]
    fn a_hole() {
        let mesh = Mesh::new(corners(Vec3::ZERO).into(), TETRAHEDRON[..3].into()).unwrap();
        let report = mesh.check();
        assert_eq!(report.boundary_edges, 3);
        assert!(!report.is_closed() && report.is_manifold());
        assert_eq!(report.genus, None);
    }

    #[test]
    fn a_triangle_the_wrong_way_round() {
        let mut triangles = TETRAHEDRON;
        triangles[0].swap(1, 2);
        let mesh = Mesh::new(corners(Vec3::ZERO).into(), triangles.into()).unwrap();
        let report = mesh.check();
        assert_eq!(report.non_manifold_edges, 3);
        assert!(report.is_closed() && !report.is_manifold());
    }

    #[test]
    fn shells_that_share_an_edge_or_a_vertex() {
        // A second tetrahedron on vertices 0 and 1, then one on vertex 0 alone.
        let mut positions = corners(Vec3::ZERO).to_vec();
        positions.extend([-Vec3::Y, -Vec3::Z]);
        let by_edge = |i: u32| [0, 1, 4, 5][i as usize];
        let turned = |t: [u32; 3]| t.map(by_edge);
        let triangles = TETRAHEDRON.into_iter().chain(TETRAHEDRON.map(turned));
        let mesh = Mesh::new(positions.clone(), triangles.collect()).unwrap();
        let report = mesh.check();
        assert_eq!(report.non_manifold_edges, 1);
        assert_eq!(report.non_manifold_vertices, 2);

        positions.push(-Vec3::X);
        let by_vertex = |i: u32| [0, 6, 4, 5][i as usize];
        let turned = |t: [u32; 3]| t.map(by_vertex);
        let triangles = TETRAHEDRON.into_iter().chain(TETRAHEDRON.map(turned));
        let report = Mesh::new(positions, triangles.collect()).unwrap().check();
        assert_eq!(report.non_manifold_edges, 0);
        assert_eq!(report.non_manifold_vertices, 1);
        assert_eq!(report.shells, 2);
    }

    #[test]
    fn degenerates_and_duplicates() {
        let positions = vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X, Vec3::Y, Vec3::new(-0.0, 0.0, -0.0)];
        let triangles = vec![[0, 1, 2], [0, 1, 1], [0, 1, 3]];
        let report = Mesh::new(positions, triangles).unwrap().check();
        assert_eq!(report.degenerate_triangles, 2);
        assert_eq!(report.duplicate_vertices, 1);
        assert_eq!(report.unused_vertices, 1);
        assert!(!report.is_manifold());
    }

    #[test]
    fn empty() {
        let report = Mesh::default().check();
        assert!(!report.is_closed());
        assert_eq!((report.shells, report.euler_characteristic), (0, 0));
    }

    #[test]
    #[ignore = "a timing, for release builds"]
    fn a_million_triangles() {
        let mesh = torus(708);
        let start = std::time::Instant::now();
        let report = mesh.check();
        println!("{} triangles: {:?}", report.triangles, start.elapsed());
        assert!(report.is_closed() && report.is_manifold());
    }
}
