//! Meshes that are known to enclose a solid.

use glam::DVec3;
use rayon::prelude::*;

use super::error::RasterError;
use crate::{Cancelled, Mesh, Run};
use rvachev_num::jobs;

/// Triangles whose edges a thread lists at once.
const AT_ONCE: usize = 1 << 12;

/// A mesh whose surface is closed and faces outward, as every join of layers needs it.
///
/// Closed means that every edge is used as often in one direction as in the other, so that a ray
/// leaves as often as it enters; edges of four triangles, separate shells and cavities are all
/// right. Vertices at the same position count as one, so it does not matter whether a seam is
/// welded.
///
/// ```
/// use rvachev::raster::ClosedMesh;
/// use rvachev::{CellSize, MeshSettings, Solid};
///
/// let settings = MeshSettings { cell: CellSize::LongestSide(16), ..MeshSettings::default() };
/// let mesh = Solid::sphere(1.0).mesh(&settings)?;
/// let closed = ClosedMesh::new(&mesh)?;
/// assert_eq!(closed.mesh().triangles().len(), mesh.triangles().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ClosedMesh<'a> {
    mesh: &'a Mesh,
}

impl<'a> ClosedMesh<'a> {
    /// Looks whether the mesh is closed and faces outward. A mesh without triangles is closed,
    /// and encloses nothing.
    ///
    /// # Errors
    ///
    /// [`RasterError::Open`] or [`RasterError::InsideOut`].
    pub fn new(mesh: &'a Mesh) -> Result<ClosedMesh<'a>, RasterError> {
        ClosedMesh::new_with(mesh, &Run::default())
    }

    /// [`new`](ClosedMesh::new) on a [`Run`].
    ///
    /// # Errors
    ///
    /// [`RasterError::Open`] or [`RasterError::InsideOut`], or that the work was cancelled.
    pub fn new_with(mesh: &'a Mesh, run: &Run) -> Result<ClosedMesh<'a>, RasterError> {
        let run = run.stage(0.0, 1.0);
        let closed = run.install(|| ClosedMesh::seen(mesh, &run))?;
        run.report(1.0);
        Ok(closed)
    }

    fn seen(mesh: &'a Mesh, run: &Run) -> Result<ClosedMesh<'a>, RasterError> {
        let [to_look, to_weld, to_compare] = run.stages([0.4, 0.3, 0.3]);
        if !uneven_edges(mesh.triangles(), &to_look)?.is_empty() {
            let welded = by_position(mesh, &to_weld)?;
            let triangles: Vec<[u32; 3]> =
                jobs::in_order(mesh.triangles().len(), |n| mesh.triangles()[n].map(|i| welded[i as usize]));
            let uneven = uneven_edges(&triangles, &to_compare)?;
            if let Some(&first) = uneven.first() {
                let at = mesh.positions()[first as usize].as_dvec3();
                return Err(RasterError::Open { edges: uneven.len(), at });
            }
        }
        let volume = mesh.volume();
        if volume < 0.0 {
            return Err(RasterError::InsideOut { volume });
        }
        Ok(ClosedMesh { mesh })
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a Mesh {
        self.mesh
    }
}

/// For every edge that is not used as often in one direction as in the other, its lower end.
fn uneven_edges(triangles: &[[u32; 3]], run: &Run) -> Result<Vec<u32>, Cancelled> {
    run.check()?;
    // Both ends, lower first, and the direction in the lowest bit.
    let of_chunk = |_, triangles: &[[u32; 3]]| {
        run.check()?;
        let uses = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[from, to]| from != to);
        let key = |[from, to]: [u32; 2]| (u64::from(from.min(to)) << 32 | u64::from(from.max(to)), from > to);
        Ok::<Vec<(u64, bool)>, Cancelled>(uses.map(key).collect())
    };
    let mut uses = jobs::try_chunks(triangles, AT_ONCE, of_chunk)?.concat();
    run.check()?;
    run.report(0.2);
    uses.par_sort_unstable();
    run.check()?;
    run.report(0.8);
    let is_uneven = |edge: &&[(u64, bool)]| 2 * edge.iter().filter(|e| e.1).count() != edge.len();
    Ok(uses.chunk_by(|a, b| a.0 == b.0).filter(is_uneven).map(|edge| (edge[0].0 >> 32) as u32).collect())
}

/// For every vertex the first one at its position.
fn by_position(mesh: &Mesh, run: &Run) -> Result<Vec<u32>, Cancelled> {
    run.check()?;
    // Adding 0 makes −0 and 0 the same.
    let key = |i: u32| mesh.positions()[i as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..mesh.positions().len() as u32).collect();
    order.par_sort_unstable_by_key(|&i| (key(i), i));
    run.check()?;
    run.report(0.8);
    let mut first = vec![0; order.len()];
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &i in same {
            first[i as usize] = same[0];
        }
    }
    Ok(first)
}

/// How the normal of a triangle changes over it: between those of the corners, which at a crease
/// are those of its side.
pub(crate) struct Slant {
    /// A corner, and the normal there, of any length.
    corner: DVec3,
    normal: DVec3,
    /// The shares of the other corners rise along these, and the normal by so much with each.
    along: [DVec3; 2],
    by: [DVec3; 2],
}

impl Slant {
    /// That of a triangle; of one that has no area, and of none, the normal is 0.
    #[inline]
    pub(crate) fn new(mesh: &Mesh, triangle: u32) -> Slant {
        let even = |normal: DVec3| Slant { corner: DVec3::ZERO, normal, along: [DVec3::ZERO; 2], by: [DVec3::ZERO; 2] };
        let Some(&corners) = mesh.triangles().get(triangle as usize) else { return even(DVec3::ZERO) };
        let [a, b, c] = mesh.corners(corners);
        let (ab, ac) = (b - a, c - a);
        let area = ab.cross(ac);
        let normals = match (mesh.corner_normals(), mesh.normals()) {
            (Some(all), _) => all[triangle as usize],
            (None, Some(all)) => corners.map(|i| all[i as usize]),
            (None, None) => return even(area),
        };
        let square = area.length_squared();
        if square == 0.0 {
            return even(DVec3::ZERO);
        }
        // Barycentric coordinates by parts of the area.
        let share = area * square.recip();
        let [na, nb, nc] = normals.map(|normal| normal.as_dvec3());
        Slant { corner: a, normal: na, along: [ac.cross(share), share.cross(ab)], by: [nb - na, nc - na] }
    }

    /// The unit normal at a point of the triangle.
    #[inline]
    pub(crate) fn normal(&self, point: DVec3) -> DVec3 {
        let Slant { corner, normal, along: [v, w], by: [b, c] } = self;
        let from = point - *corner;
        (*normal + from.dot(*v) * *b + from.dot(*w) * *c).normalize_or_zero()
    }
}
