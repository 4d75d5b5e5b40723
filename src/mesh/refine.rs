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
//! The mesh of the larger cells without the inset and that of the smaller ones without the caps have the same
//! boundary then, but that a segment of the first may be several of the second. A triangle at such a segment is cut
//! into as many. Each of the two is embedded, they have nothing but the seam in common, and no fan reaches over it: so
//! what is shown of one lattice holds for both together. A crease has a point in the seam if the triangles on both
//! sides are of fans: a fan's loop may take any way in a face.

mod divided;
mod inset;
mod level;
mod piece;
mod place;
mod seam;

use self::inset::Inset;
use self::level::Level;
use self::piece::Piece;
use self::seam::Seam;
use super::blocks::Blocks;
use super::extract::ExtractError;
use super::lattice::Lattice;
use super::resolve::{Among, count, unresolved_cells};
use super::settings::Features;
use super::solid::MeshingError;
use crate::eval::Program;
use crate::geom::Mesh;
use crate::{Bounds, Run};

/// A solid to be meshed, and how.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) program: &'a Program,
    /// The box that the surface is in.
    pub(super) limits: Bounds,
    pub(super) features: Features,
}

/// The mesh on a lattice whose cells are halved where they are unresolved, at most so many times, and how many are left;
/// nothing if the two sides of a seam do not fit, as where the field jumps.
pub(super) fn refined(
    job: Job<'_>,
    (lattice, blocks): (&Lattice, &Blocks),
    halvings: u32,
    run: &Run,
) -> Result<Option<(Mesh, usize)>, MeshingError> {
    let [to_count, to_mesh] = run.stages([0.5, 0.5]);
    let mut levels = vec![Level::new(*lattice, blocks.clone())];
    let mut left = 0;
    for halving in 0..=halvings {
        let [done, next] = [halving, halving + 1].map(|n| f64::from(n) / (f64::from(halvings) + 1.0));
        let Some(last) = levels.last_mut() else { break };
        let run = to_count.stage(done, next);
        let seek = |among| unresolved_cells(&last.blocks, (&last.lattice, job.limits), among, &run);
        if halving == halvings {
            left = count(&seek(Among::OneSided)?);
            break;
        }
        let found = seek(Among::All)?;
        if found.is_empty() {
            break;
        }
        last.inset = Inset::around(&last.lattice, &found);
        let halved = last.halved()?;
        levels.push(halved);
    }
    if let [Level { lattice, blocks, .. }] = &mut levels[..] {
        let mesh = blocks.extract(job.program, (lattice, job.limits), job.features, &to_mesh)?;
        return Ok(Some((mesh, left)));
    }
    grade(&mut levels)?;
    let mut all = Piece::default();
    let mut seam: Option<Seam> = None;
    let times: Vec<f64> = levels.iter().map(|level| level.blocks.cells.len() as f64 + 1.0).collect();
    let whole: f64 = times.iter().sum();
    let mut done = 0.0;
    for (level, time) in levels.iter_mut().zip(times) {
        let run = to_mesh.stage(done / whole, (done + time) / whole);
        done += time;
        let outer = seam.take();
        let (piece, rims) = match level.extract(job, outer.as_ref(), &run) {
            Err(ExtractError::Rifts(_)) => return Ok(None),
            result => result?,
        };
        let start = all.triangles.len() as u32;
        let joined = match &outer {
            None => all.append(piece, &[]),
            Some(outer) => outer.stitch(&mut all, (&level.lattice, piece), &rims),
        };
        let Some(numbers) = joined else { return Ok(None) };
        if !level.inset.is_empty() {
            let rims = rims.into_iter().filter(|rim| !rim.is_outer).map(|rim| rim.moved(start, &numbers));
            seam = Seam::new(job, level, rims, &all);
            if seam.is_none() {
                return Ok(None);
            }
        }
    }
    Ok(Some((all.into_mesh().map_err(ExtractError::from)?, left)))
}

/// Makes each inset so large that the next one is surrounded by blocks of its own level.
fn grade(levels: &mut [Level]) -> Result<(), MeshingError> {
    for n in (1..levels.len()).rev() {
        let around: Vec<[u32; 3]> = levels[n].inset.around_all().collect();
        around.into_iter().for_each(|block| levels[n - 1].inset.add(block.map(|at| at / 2)));
    }
    for n in 1..levels.len() {
        let inset = std::mem::take(&mut levels[n].inset);
        levels[n] = levels[n - 1].halved()?;
        levels[n].inset = inset;
    }
    Ok(())
}
