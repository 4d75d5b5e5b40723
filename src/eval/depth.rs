//! How deep inside of a solid points can be: what is left of it when it is eroded.
//!
//! Boxes are opened in the order of the most that they may hold, the value at the centre and the
//! way from there to a corner: values are distances, and change no faster than points move.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::{Bounds, Cancelled, Run};
use rvachev_field::AnyField;

/// No more boxes than this are opened; what is not known by then may be.
const PATIENCE: usize = 20_000;

/// After so many it is seen whether the work may go on: distances may cost a tenth of a millisecond
/// each.
const OFTEN: usize = 16;

struct Candidate {
    most: f64,
    bounds: Bounds,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Candidate) -> Ordering {
        self.most.total_cmp(&other.most)
    }
}

/// Whether a distance may be above `than` somewhere in a box: it is, unless it is certain that it
/// is not.
pub(super) fn is_deeper(distance: &dyn AnyField, bounds: &Bounds, than: f64, run: &Run) -> Result<bool, Cancelled> {
    let mut heap = BinaryHeap::new();
    if !bounds.is_empty() {
        heap.push(Candidate { most: f64::INFINITY, bounds: *bounds });
    }
    for opened in 0..PATIENCE {
        if opened % OFTEN == 0 {
            run.check()?;
        }
        let Some(Candidate { bounds, .. }) = heap.pop() else { return Ok(false) };
        for part in parts(&bounds) {
            let centre = distance.value(part.center().to_array());
            let most = centre + part.half_extents().length();
            if centre > than {
                return Ok(true);
            }
            if most > than {
                heap.push(Candidate { most, bounds: part });
            }
        }
    }
    Ok(true)
}

/// The greatest distance that is found in a box: one above `enough` if there is one, else the
/// greatest but for a ten-thousandth.
///
/// # Errors
/// That the run was cancelled.
pub(super) fn deepest(distance: &dyn AnyField, bounds: &Bounds, enough: f64, run: &Run) -> Result<f64, Cancelled> {
    const CLOSE: f64 = 1.0 + 1e-4;
    let at = |bounds: &Bounds| distance.value(bounds.center().to_array());
    let mut best = at(bounds);
    let mut heap = BinaryHeap::from([Candidate { most: f64::INFINITY, bounds: *bounds }]);
    for opened in 0..PATIENCE {
        if opened % OFTEN == 0 {
            run.check()?;
        }
        let Some(Candidate { most, bounds }) = heap.pop() else { break };
        if best > enough || most <= best * CLOSE {
            break;
        }
        for part in parts(&bounds) {
            let centre = at(&part);
            best = best.max(centre);
            heap.push(Candidate { most: centre + part.half_extents().length(), bounds: part });
        }
    }
    Ok(best.max(0.0))
}

/// The halves of a box along every axis that it has an extent along.
fn parts(bounds: &Bounds) -> Vec<Bounds> {
    let mut parts: Vec<Bounds> = Vec::with_capacity(8);
    for part in bounds.octants() {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts
}
