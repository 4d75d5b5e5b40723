//! What can be said about a mesh: whether it is closed, manifold, free of self-intersection and
//! of which topology, and what it measures.
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
//! Vertices are the same if their index is. Positions are compared as they are, without a
//! tolerance, and signs are exact: the report holds for the f32 numbers that are written.

mod fans;
mod lists;
mod meet;
mod overlap;

use std::fmt;

use glam::{DMat3, DVec3};

use self::fans::{Fans, repeats};
use self::lists::{mapped, sorted};
use self::meet::is_degenerate;
use self::overlap::{LISTED, Overlaps};
use crate::geom::Mesh;
use crate::geom::figures::{point, size};
use crate::{Cancelled, Run};
use rvachev_num::figures;
use rvachev_num::{Bounds, jobs};

/// The findings of [`Mesh::check`].
///
/// The default is that of a mesh without triangles.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MeshReport {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices, used or not.
    pub vertices: usize,
    /// Vertices that no triangle uses; triangles with a repeated index do not count.
    pub unused_vertices: usize,
    /// Edges that a single triangle uses: the mesh has a hole there.
    pub boundary_edges: usize,
    /// Edges that more than two triangles use, or two in the same direction.
    pub non_manifold_edges: usize,
    /// Vertices whose triangles form neither a single ring nor, at a boundary, a single fan.
    pub non_manifold_vertices: usize,
    /// Triangles whose corners are exactly on a line, those with a repeated index included.
    pub degenerate_triangles: usize,
    /// Triangles that name a vertex twice. They take no part in edges, vertices and shells.
    pub repeated_indices: usize,
    /// Vertices at the very position of another one that is counted already.
    pub duplicate_vertices: usize,
    /// Triangles with the same three vertices as another one that is counted already, in
    /// whatever order.
    pub duplicate_triangles: usize,
    /// Pairs of triangles that have a point in common besides the vertices and the edge that
    /// they share by index: one crosses, touches or overlaps the other, or is folded onto it.
    /// Degenerate triangles take no part.
    pub self_intersections: usize,
    /// The first such pairs, at most 16, in the order of their triangles' numbers.
    pub intersecting_pairs: Vec<[u32; 2]>,
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
    /// The inertia tensor about the centroid for density 1; see [`Mesh::inertia`].
    pub inertia: Option<DMat3>,
    /// The smallest box that holds all vertices.
    pub bounds: Bounds,
    /// Vertices on edges of the lattice that are off the surface to keep clear of the nodes, by up
    /// to a thousandth of a cell, or by two steps of `f32` where these are more, far from the
    /// origin; or where the value jumps from one side to the other, as distances that are searched
    /// may; and those between larger and smaller cells, see
    /// [`ThinFeatures::Refine`](crate::ThinFeatures::Refine). `None` if the mesh was not made from
    /// a solid.
    pub clamped_vertices: Option<usize>,
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

    /// Whether the mesh is the boundary of a solid: closed and manifold, without
    /// self-intersections, duplicates and unused vertices, of positive volume.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.is_closed()
            && self.is_manifold()
            && self.self_intersections == 0
            && self.duplicate_vertices + self.duplicate_triangles + self.unused_vertices == 0
            && self.volume > 0.0
    }
}

/// As a few lines of text: what the mesh is, then whatever is wrong with it.
///
/// ```
/// use rvachev::{MeshSettings, Solid};
///
/// let report = Solid::sphere(1.0).mesh(&MeshSettings::default())?.check();
/// println!("{report}");
/// # Ok::<(), rvachev::error::MeshingError>(())
/// ```
impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let closed = if self.is_closed() { "closed" } else { "not closed" };
        let manifold = if self.is_manifold() { "manifold" } else { "not manifold" };
        let crossing = if self.self_intersections == 0 { "free of" } else { "with" };
        writeln!(f, "{} triangles, {} vertices, {} shells", self.triangles, self.vertices, self.shells)?;
        write!(f, "{closed}, {manifold}, {crossing} self-intersections")?;
        if let Some(genus) = self.genus {
            write!(f, ", genus {genus}")?;
        }
        write!(f, "\nvolume {}, area {}", figures(self.volume, 7), figures(self.area, 7))?;
        if let Some(c) = self.centroid {
            write!(f, ", centroid {}", point(c, self.bounds.longest_side()))?;
        }
        if !self.bounds.is_empty() {
            write!(f, "\n{}", size(self.bounds.size()))?;
        }
        let defects = [
            (self.boundary_edges, "boundary edges"),
            (self.non_manifold_edges, "non-manifold edges"),
            (self.non_manifold_vertices, "non-manifold vertices"),
            (self.degenerate_triangles, "degenerate triangles"),
            (self.repeated_indices, "triangles with a repeated index"),
            (self.duplicate_vertices, "duplicate vertices"),
            (self.duplicate_triangles, "duplicate triangles"),
            (self.unused_vertices, "unused vertices"),
            (self.self_intersections, "pairs of triangles that intersect"),
        ];
        for (count, what) in defects.into_iter().filter(|d| d.0 > 0) {
            write!(f, "\n{count} {what}")?;
        }
        if let Some([a, b]) = self.intersecting_pairs.first() {
            write!(f, ", the first of them {a} and {b}")?;
        }
        Ok(())
    }
}

impl Mesh {
    /// Examines the mesh. A million triangles take about a second on one core; the work is
    /// spread over the threads of the current rayon pool, whose number does not change the
    /// result.
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    ///
    /// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let report = Mesh::new(positions, triangles)?.check();
    /// assert!(report.is_sound());
    /// assert_eq!((report.shells, report.genus), (1, Some(0)));
    /// # Ok::<(), rvachev::error::MeshError>(())
    /// ```
    #[must_use]
    pub fn check(&self) -> MeshReport {
        // A run that nobody else holds is not cancelled.
        self.check_with(&Run::default()).unwrap_or_else(|Cancelled| MeshReport::default())
    }

    /// [`check`](Mesh::check) with a choice of threads, a cancel token and a progress sink.
    ///
    /// ```
    /// use rvachev::{Cancelled, MeshSettings, Run, Solid};
    ///
    /// let mesh = Solid::torus(2.0, 0.5).mesh(&MeshSettings::default())?;
    /// let run = Run { threads: 1, ..Run::default() };
    /// assert_eq!(mesh.check_with(&run)?, mesh.check());
    /// run.cancel.cancel();
    /// assert_eq!(mesh.check_with(&run), Err(Cancelled));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Cancelled`] if the token was.
    pub fn check_with(&self, run: &Run) -> Result<MeshReport, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let report = run.install(|| self.examined(&run))?;
        run.report(1.0);
        Ok(report)
    }

    fn examined(&self, run: &Run) -> Result<MeshReport, Cancelled> {
        // How long each stage takes, more or less.
        let [to_turn, to_compare, to_sort] = run.stages([0.4, 0.5, 0.1]);
        let (mut fans, mut measure) = (Err(Cancelled), Err(Cancelled));
        jobs::both(&mut || fans = Fans::new(self, &to_turn), &mut || measure = self.measure_with(run));
        let (fans, measure) = (fans?, measure?);
        let overlaps = Overlaps::find(self, &fans, LISTED, &to_compare)?;
        let duplicate_vertices = duplicate_vertices(self, &to_sort)?;
        let repeated_indices = self.triangles().iter().filter(|&&t| repeats(t)).count();
        let faces = self.triangles().len() - repeated_indices;
        let mut report = MeshReport {
            triangles: self.triangles().len(),
            vertices: self.positions().len(),
            unused_vertices: self.positions().len() - fans.used,
            boundary_edges: fans.boundary_edges,
            non_manifold_edges: fans.non_manifold_edges,
            non_manifold_vertices: fans.non_manifold_vertices,
            degenerate_triangles: overlaps.degenerate,
            repeated_indices,
            duplicate_vertices,
            duplicate_triangles: fans.duplicate_triangles,
            self_intersections: overlaps.count,
            intersecting_pairs: overlaps.pairs,
            shells: fans.shells,
            euler_characteristic: fans.used as i64 - fans.edges as i64 + faces as i64,
            genus: None,
            volume: measure.volume,
            area: measure.area,
            centroid: measure.centroid,
            inertia: measure.inertia,
            bounds: self.bounds(),
            clamped_vertices: self.clamped_vertices(),
        };
        if report.is_closed() && report.is_manifold() {
            report.genus = Some(report.shells as i64 - report.euler_characteristic / 2);
        }
        Ok(report)
    }
}

/// Triangles that are degenerate, or have a point in common with another one that they do not share
/// by index; not more than so many pairs.
pub(super) fn intersecting(mesh: &Mesh, run: &Run) -> Result<Vec<[u32; 3]>, Cancelled> {
    const MOST: usize = 1 << 12;
    let [to_turn, to_compare] = run.stages([0.45, 0.55]);
    let overlaps = Overlaps::find(mesh, &Fans::new(mesh, &to_turn)?, MOST, &to_compare)?;
    let mut found: Vec<[u32; 3]> =
        overlaps.pairs.iter().flatten().map(|number| mesh.triangles()[*number as usize]).collect();
    if overlaps.degenerate > 0 {
        found.extend(mesh.triangles().iter().filter(|&&t| repeats(t) || is_degenerate(mesh.corners(t))));
    }
    Ok(found)
}

fn duplicate_vertices(mesh: &Mesh, run: &Run) -> Result<usize, Cancelled> {
    // Adding 0 makes −0 and 0 the same.
    let keys: Vec<[u32; 3]> = mapped(mesh.positions(), |p| p.to_array().map(|x| (x + 0.0).to_bits()), run)?;
    // Any mixture of the bits will do: what counts is that equal ones are together.
    let mixed = |key: &[u32; 3]| key.iter().fold(0u32, |all, bits| (all ^ bits).wrapping_mul(0x9e37_79b9));
    let keys = sorted(&keys, |key| mixed(key) >> 20, run)?;
    Ok(keys.windows(2).filter(|w| w[0] == w[1]).count())
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
}
