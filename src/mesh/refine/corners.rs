//! Corners of the surface that are known, and whether a mesh has them.
//!
//! ```text
//!        /\             Triangles may all be on the surface, and what is thinner than a cell be missing.
//!    ___/  \___        Of a surface that is flat between creases the corners tell: one that is far from
//!    -----------        all triangles is lost.
//! ```

use glam::DVec3;
use rvachev_field::{Patch, Patches};

use super::Job;
use crate::eval::Program;
use crate::geom::Mesh;
use crate::mesh::slopes::Slopes;
use crate::{Cancelled, Run};
use rvachev_num::jobs;

/// Corners that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 1 << 12;

/// How far from a corner both sides are looked for, in tolerances.
const ASIDE: f64 = 0.5;

/// The corners of leaves within the limits that are no farther from the surface than a part of the
/// tolerance, as their values tell.
pub(super) fn corners(job: Job<'_>, tolerance: f64, run: &Run) -> Result<Vec<DVec3>, Cancelled> {
    let program = job.program;
    let mut all = program.corners();
    all.retain(|corner| job.limits.contains(*corner));
    if all.is_empty() {
        return Ok(all);
    }
    let found = Slopes::within(program, tolerance).at(&all, run)?;
    let near = all.into_iter().zip(found).filter(|(_, slope)| slope.value.abs() < 0.1 * tolerance);
    Ok(near.map(|(corner, _)| corner).collect())
}

/// The corners that a mesh is farther from than the tolerance, with how far that is.
pub(super) fn lost(
    mesh: &Mesh,
    corners: &[DVec3],
    (program, tolerance): (&Program, f64),
    run: &Run,
) -> Result<Vec<(DVec3, f64)>, Cancelled> {
    // An empty mesh has other warnings.
    if corners.is_empty() || mesh.triangles().is_empty() {
        return Ok(Vec::new());
    }
    let flat: Vec<Patch> = mesh.triangles().iter().map(|triangle| Patch::flat(mesh.corners(*triangle))).collect();
    let patches = Patches::new(&flat, run)?;
    let far = |corner: &DVec3| {
        let distance = patches.nearest(*corner).map_or(f64::INFINITY, |foot| foot.distance);
        (distance > tolerance && has_both_sides(program, *corner, ASIDE * tolerance)).then_some((*corner, distance))
    };
    let of_chunk = |corners: &[DVec3]| {
        run.check()?;
        Ok(corners.iter().filter_map(far).collect::<Vec<_>>())
    };
    let found: Result<Vec<Vec<_>>, Cancelled> = jobs::try_chunks(corners, AT_ONCE, |_, chunk| of_chunk(chunk));
    Ok(found?.concat())
}

/// Whether there is inside and outside next to a point: a corner within the solid is none of its
/// surface.
fn has_both_sides(program: &Program, p: DVec3, by: f64) -> bool {
    let steps = [-1.0, 0.0, 1.0];
    let around = steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| DVec3::new(*x, *y, z))));
    let inside = around.filter(|way| *way != DVec3::ZERO).filter(|way| program.value(p + by * *way) > 0.0).count();
    inside > 0 && inside < 26
}
