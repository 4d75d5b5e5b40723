//! The nearest points of two surfaces.
//!
//! ```text
//!        a               Over a flat triangle with corners a, b, c, the squared distance from a set, less the
//!       / \              squared distance from any point, is concave: at a point p of it
//!      / p \                  d²(p) ≥ Σ λᵢ d²(corner i) − Σ λᵢ |corner i − p|²
//!     b-----c            and the last sum is at most a third of the longest side squared.
//!  ~~~~~~~~~~~~~ set
//! ```
//!
//! The patches of one surface are divided, those that may be nearest first left, until none can be
//! nearer than the best point by more than a tolerance. The bound is off by the square of the size:
//! of a gap that is even, it takes few divisions. Where the other solid's value changes by 1 per
//! length unit at most, a range of it is a bound as well, and mostly a better one.

use glam::DVec3;
use rayon::prelude::*;
use rvachev_field::Patches;

use super::piece::Piece;
use super::{AT_ONCE, Side, chunks, distance};
use crate::{Cancelled, Run};

/// How near the least distance is found, as a part of it.
const RELATIVE: f64 = 1e-3;

/// After so many points the work ends, with what tolerance there is.
const MOST: usize = 1 << 21;

/// So many patches are tried first.
const FIRST: usize = 512;

/// The nearest points that were found, and what none is nearer than.
pub(super) struct Found {
    pub(super) points: [DVec3; 2],
    pub(super) least: f64,
}

/// The nearest points of the patches of both.
pub(super) fn search(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Found, Cancelled> {
    let (patches, others) = (&from.surface.patches, &to.surface.patches);
    let mut best = (f64::INFINITY, DVec3::ZERO);
    for n in (0..patches.len()).step_by(patches.len().div_ceil(FIRST)) {
        let p = patches.point(n, [0.0; 2]);
        best = nearer(best, (distance(others, p), p));
    }
    let box_of_others = others.bounds();
    let first = |n: usize| {
        let piece = Piece::whole(patches, n);
        // What is beyond the box of the other is no nearer than that.
        let to_box =
            piece.points.iter().map(|p| box_of_others.distance_squared(*p).sqrt()).fold(f64::INFINITY, f64::min);
        (to_box - 2.0 * piece.longest_side() < best.0).then(|| piece.numbered(|p| distance(others, p)))
    };
    let mut pieces: Vec<Piece> = Vec::new();
    for chunk in chunks(patches.len()) {
        run.check()?;
        pieces.par_extend(chunk.into_par_iter().filter_map(first));
    }
    let is_gentle = to.program.is_gentle();
    let (mut asked, mut least) = (3 * pieces.len(), f64::INFINITY);
    loop {
        for piece in &pieces {
            let ends = piece.numbers.into_iter().zip(piece.points);
            best = ends.fold(best, nearer);
        }
        let enough = best.0 - slack.max(RELATIVE * best.0);
        let bound = |piece: &Piece| {
            let least = least_of(piece, patches);
            if least >= enough || !is_gentle {
                return least;
            }
            least.max(-to.program.range_zone(&piece.zone(patches, DVec3::ZERO)).hi())
        };
        let bounds: Vec<f64> = pieces.par_iter().map(bound).collect();
        // Those that are left as they are, or left at all.
        let is_done = asked > MOST || best.0 <= slack;
        let left = bounds.iter().copied().filter(|bound| is_done || *bound >= enough);
        least = left.fold(least, f64::min);
        if is_done || bounds.iter().all(|bound| *bound >= enough) {
            break;
        }
        let open: Vec<Piece> =
            pieces.iter().zip(&bounds).filter(|(_, bound)| **bound < enough).map(|(piece, _)| *piece).collect();
        asked += 3 * open.len();
        let mut next = Vec::with_capacity(4 * open.len());
        for chunk in open.chunks(16 * AT_ONCE) {
            run.check()?;
            next.par_extend(chunk.par_iter().flat_map_iter(|piece| piece.divided(patches, |p| distance(others, p))));
        }
        pieces = next;
    }
    let there = others.nearest(best.1).map_or(best.1, |foot| foot.point);
    Ok(Found { points: [best.1, there], least: least.min(best.0) })
}

/// What no point of a piece is nearer to the other surface than.
fn least_of(piece: &Piece, patches: &Patches) -> f64 {
    let corner = piece.numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let longest = piece.longest_side();
    (corner * corner - longest * longest / 3.0).max(0.0).sqrt() - piece.off(patches)
}

fn nearer(a: (f64, DVec3), b: (f64, DVec3)) -> (f64, DVec3) {
    if b.0 < a.0 { b } else { a }
}
