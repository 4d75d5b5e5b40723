//! Fewer triangles within a tolerance: simplification (decimation) by edge collapse.
//!
//! ```text
//!      +--+--+--+--+            Vertices are drawn into neighbours, the least error first, as long
//!      |\ |\ |\ |\ |            as all points of the surface that the triangles stand for are within
//!      | \| \| \| \|   ---->    the tolerance of those that take their place. Flat faces come to few
//!      +--+--+--+--+            triangles; creases are drawn together along themselves only.
//! ```
//!
//! What is left are vertices of the mesh that there was, at their places. A mesh that cuts itself
//! is not handed out: where triangles meet, or are too far off all the same, it is done again with
//! less tolerance there.
//!
//! Sources: M. Garland and P. S. Heckbert, Surface simplification using quadric error metrics
//! (1997), for the order; J. Cohen et al., Simplification envelopes (1996), for a bound on all that
//! is left out.

mod collapse;
mod near;
mod quadric;
mod start;

use self::collapse::Collapse;
use self::near::distance_squared;
use rvachev_num::order;

use super::check::intersecting;
use super::deviation::{self, Probe};
use super::error::MeshingError;
use super::extract::ExtractError;
use crate::eval::Program;
use crate::geom::{Findings, Mesh};
use crate::{Bounds, Run};

/// The part of a tolerance that a mesh may be off before triangles are taken away.
pub(super) const SHARE: f64 = 0.3;

/// Where something is wrong, this part of the tolerance is left for the next time.
const LESS: f64 = 0.35;

/// So often no more is left of the tolerance than near what is wrong, and then in boxes about that.
const PATIENT: usize = 2;

/// How often it is tried without triangles that meet or are too far off.
const ATTEMPTS: usize = 5;

/// The middle of a side depends on which end comes first, by rounding.
const ROUNDING: f64 = 1.001;

/// A mesh of fewer triangles, within a tolerance of the surface as the probes of it tell, and how
/// far what it has lost is.
pub(super) fn simplified(
    mesh: Mesh,
    (probes, lost): (&[Probe], f64),
    (program, tolerance): (&Program, f64),
    run: &Run,
) -> Result<Mesh, MeshingError> {
    // What is farther off already does not come nearer.
    let most = tolerance.max(ROUNDING * deviation::largest(probes));
    let mut parts = vec![1.0; mesh.positions().len()];
    let mut along_x: Vec<u32> = (0..parts.len() as u32).collect();
    order::rising(&mut along_x, |n| f64::from(mesh.positions()[*n as usize].x));
    for attempt in 0..ATTEMPTS {
        let [from, to] = [attempt, attempt + 1].map(|n| 1.0 - 0.25f64.powi(n as i32));
        let [to_draw, to_check, to_compare] = run.stage(from, to).stages([0.8, 0.1, 0.1]);
        let mut collapse = Collapse::new(&mesh, probes, (1.0 - SHARE) * tolerance, &parts);
        run.check()?;
        collapse.run(&to_draw)?;
        let fewer = collapse.into_mesh(&mesh).map_err(ExtractError::from)?;
        let mut wrong = intersecting(&fewer, &to_check)?;
        // Between the points that were compared a surface may come out on the other side.
        let found = deviation::probes(&fewer, program, tolerance, &to_compare)?;
        let far = found.iter().filter(|probe| probe.off > most);
        wrong.extend(far.map(|probe| fewer.triangles()[probe.triangle as usize]));
        if wrong.is_empty() {
            return Ok(told(fewer, (&found, lost), tolerance));
        }
        // Of long triangles the box holds much that is far from them.
        let reach = if attempt < PATIENT { tolerance } else { f64::INFINITY };
        for triangle in wrong {
            run.check()?;
            let corners = fewer.corners(triangle);
            let around = Bounds::from_points(corners).inflate(tolerance);
            let place = |n: &u32| mesh.positions()[*n as usize].as_dvec3();
            let first = along_x.partition_point(|n| place(n).x < around.min.x);
            let boxed = along_x[first..].iter().take_while(|n| place(n).x <= around.max.x);
            let near =
                boxed.filter(|n| around.contains(place(n)) && distance_squared(place(n), corners) <= reach * reach);
            near.for_each(|n| parts[*n as usize] *= LESS);
        }
    }
    Ok(told(mesh, (probes, lost), tolerance))
}

/// The mesh, which says how far it is off.
fn told(mesh: Mesh, (probes, lost): (&[Probe], f64), tolerance: f64) -> Mesh {
    let deviation = Some([deviation::largest(probes).max(lost), tolerance]);
    let findings = Findings { deviation, ..mesh.findings().clone() };
    mesh.with_findings(findings)
}
