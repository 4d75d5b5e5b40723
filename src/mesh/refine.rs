//! Smaller cells where a feature may be thinner than a cell.
//!
//! ```text
//!     +-----+-----+-----+     Blocks with unresolved cells, and those close to such cells, are the inset: they are
//!     |     |     |     |     meshed in halved cells, and so are blocks of these, as often as is asked for.
//!     +-----+--+--+-----+
//!     |     |__|__|     |     In the seam around the inset, the smaller cells take the contour of the larger
//!     |     |  |  |     |     ones: its vertices, and the signs of its nodes. What is beyond the inset is outside
//!     +-----+--+--+-----+     for the smaller cells, so that they have a closed mesh, with caps in cells beyond.
//! ```
//!
//! The mesh of the larger cells without the inset and that of the smaller ones without the caps
//! have the same boundary then, but that a segment of the first may be several of the second. A
//! triangle at such a segment is cut into as many. Each of the two is embedded, they have nothing
//! but the seam in common, and no fan reaches over it: so what is shown of one lattice holds for
//! both together. A crease has a point in the seam if the triangles on both sides are of fans: a
//! fan's loop may take any way in a face.

mod corners;
mod divided;
mod inset;
mod level;
mod piece;
mod place;
mod rims;
mod seam;
mod side;
mod tolerance;

use self::inset::Inset;
use self::level::Level;
use self::piece::Piece;
use self::seam::Seam;
pub(super) use self::tolerance::within;
use super::blocks::Blocks;
use super::error::MeshingError;
use super::extract::ExtractError;
use super::feature::Crease;
use super::lattice::Lattice;
use super::resolve::{Among, Unresolved, unresolved_cells};
use super::settings::Features;
use super::signs::BLOCK;
use crate::eval::Program;
use crate::geom::{Findings, Mesh};
use crate::{Bounds, Cancelled, Run};

/// A solid to be meshed, and how.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) program: &'a Program,
    /// The box that the surface is in.
    pub(super) limits: Bounds,
    pub(super) features: Features,
    /// How far triangles may be off the surface, if that is asked for.
    pub(super) tolerance: Option<f64>,
}

/// The surface is above what cuts a crease off, from side to side of a cell, by a quarter of the
/// cell times the angle in radians; along a diagonal by half of that again.
const CUT: f64 = 1.5 / 4.0;

impl Job<'_> {
    /// Which normals are those of a crease. A surface that is flat between creases is off triangles
    /// across a crease, and nowhere else: those count that are off by more than the tolerance.
    pub(super) fn crease(&self, lattice: &Lattice) -> Crease {
        match self.tolerance {
            Some(tolerance) if self.program.is_faceted() => Crease::of_angle(tolerance / (CUT * lattice.step())),
            _ => Crease::USUAL,
        }
    }
}

/// The mesh on a lattice whose cells are halved where they are unresolved, at most so many times
/// and as long as f32 has room for them. It says how many blocks have some left.
pub(super) fn refined(
    job: Job<'_>,
    (lattice, blocks): (Lattice, Blocks),
    halvings: u32,
    run: &Run,
) -> Result<Mesh, MeshingError> {
    let [to_find, to_mesh, to_count] = run.stages([0.5, 0.4, 0.1]);
    let (mut levels, mut is_done) = divided(job, (lattice, blocks), halvings, &to_find)?;
    grade(&mut levels);
    loop {
        match meshed(job, &mut levels, &to_mesh)? {
            Ok(mesh) => {
                // What is left in the last level, in blocks that are not of the one around it.
                let last = &levels[levels.len() - 1];
                let mut found = if is_done { Vec::new() } else { unresolved(job, last, Among::OneSided, &to_count)? };
                if let [.., outer, _] = &levels[..] {
                    found.retain(|found| outer.inset.has_half(found.block.map(|at| at / BLOCK as u32)));
                }
                let findings = Findings {
                    possibly_lost: found.len(),
                    lost_at: found.iter().map(|found| last.lattice.region(found.block, BLOCK).center()).collect(),
                    ..mesh.findings().clone()
                };
                return Ok(mesh.with_findings(findings));
            }
            // Without the level that does not fit.
            Err(mismatched) => {
                levels.truncate(mismatched);
                levels[mismatched - 1].forget();
                is_done = false;
            }
        }
    }
}

/// The levels of cells that are halved where they are unresolved, at most so many times, and
/// whether none are in the last.
fn divided(
    job: Job<'_>,
    (lattice, blocks): (Lattice, Blocks),
    halvings: u32,
    run: &Run,
) -> Result<(Vec<Level>, bool), MeshingError> {
    let mut levels = vec![Level::new(lattice, blocks)];
    for halving in 0..halvings {
        let [done, next] = [0.0, 1.0].map(|by| (f64::from(halving) + by) / f64::from(halvings));
        let last = levels.len() - 1;
        // What turns round in cells with nodes on both sides may be torn: they are halved, too.
        let found = unresolved(job, &levels[last], Among::All, &run.stage(done, next))?;
        if found.is_empty() {
            return Ok((levels, true));
        }
        levels[last].inset = Inset::around(&levels[last].lattice, &found);
        let Some(halved) = levels[last].halved() else {
            levels[last].forget();
            break;
        };
        levels.push(halved);
    }
    Ok((levels, false))
}

fn unresolved(job: Job<'_>, level: &Level, among: Among, run: &Run) -> Result<Vec<Unresolved>, Cancelled> {
    unresolved_cells(&level.blocks, (&level.lattice, job.limits), among, run)
}

/// The mesh of all levels together, or the number of one whose sides of the seam do not fit, as it
/// may be where the field jumps; never the first.
fn meshed(job: Job<'_>, levels: &mut [Level], run: &Run) -> Result<Result<Mesh, usize>, MeshingError> {
    if let [Level { lattice, blocks, .. }] = levels {
        return Ok(Ok(blocks.extract(job, lattice, run)?));
    }
    let mut all = Piece::default();
    let mut seam: Option<Seam> = None;
    let times: Vec<f64> = levels.iter().map(|level| level.blocks.cells.len() as f64 + 1.0).collect();
    let (whole, mut end) = (times.iter().sum::<f64>(), 0.0);
    let stages = times.iter().map(|time| {
        let start = end;
        end += time;
        run.stage(start / whole, end / whole)
    });
    for (n, (level, run)) in levels.iter_mut().zip(stages).enumerate() {
        let outer = seam.take();
        let (piece, rims) = match level.extract(job, outer.as_ref(), &run) {
            Err(ExtractError::Mismatches(_)) if n > 0 => return Ok(Err(n)),
            result => result?,
        };
        run.check()?;
        let start = all.triangles.len() as u32;
        let joined = match &outer {
            None => all.append(piece, &[]),
            Some(outer) => outer.stitch(&mut all, (&level.lattice, piece), &rims),
        };
        let Some(numbers) = joined else { return Ok(Err(n)) };
        if !level.inset.is_empty() {
            run.check()?;
            let rims = rims.into_iter().filter(|rim| !rim.is_outer).map(|rim| rim.moved(start, &numbers));
            seam = Seam::new(job, level, rims, &all);
            if seam.is_none() {
                return Ok(Err(n + 1));
            }
        }
    }
    Ok(Ok(all.into_mesh().map_err(ExtractError::from)?))
}

/// Makes each inset so large that the next one is surrounded by blocks of its own level.
fn grade(levels: &mut [Level]) {
    for n in (1..levels.len()).rev() {
        let around: Vec<[u32; 3]> = levels[n].inset.around_all().collect();
        around.into_iter().for_each(|block| levels[n - 1].inset.add(block.map(|at| at / 2)));
    }
    for n in 1..levels.len() {
        if let Some(halved) = levels[n - 1].halved() {
            levels[n].blocks = halved.blocks;
        }
    }
}
