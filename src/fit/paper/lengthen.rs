//! Shapes longer where their points end, so that bodies overlap and holes go through the skin.
//!
//! ```text
//!       .-----.                .-----.           points of a pin end at the plate that it stands on: the
//!       |     |                |     |           smallest shape ends there as well, and would only
//!       |     |       →        |     |           touch the plate's
//!     --'-----'--            --|-----|--
//!                              '-----'
//! ```

use glam::DVec3;

use super::segment::Judge;
use crate::fit::cost::Cost;
use crate::fit::gielis::Supershaped;
use crate::fit::kernel::terms;

/// A direction is along an axis of a shape by this cosine.
const ALONG: f64 = 0.95;

/// Exponents with which a shape ends in a flat face.
const SHARP: [f64; 2] = [20.0, 100.0];

/// A longer shape may residual this share of the points more.
const WORSE: f64 = 0.01;

/// A longer shape must reach this share of the length that was asked for.
const REACHED: f64 = 0.6;

/// The shape longer in a direction by a length and the local axis that this is along, if its points
/// fit it nearly as well.
pub(super) fn lengthened(shape: Supershaped, direction: DVec3, by: f64, judge: &Judge) -> Option<(Supershaped, usize)> {
    let k = (shape.rotation.transpose() * direction).abs().max_position();
    let axis = shape.rotation.col(k);
    let side = axis.dot(direction);
    if side.abs() < ALONG {
        return None;
    }
    let axis = axis * side.signum();
    let end = end_along(&shape, axis);
    let goal = shape.center + axis * (end + REACHED * by);
    let mut best = (judge.residual(shape) + WORSE, None);
    for longer in longer(&shape, k, axis, (end + 0.5 * by) / end.max(1e-9), by) {
        for candidate in [longer, judge.settled(longer)] {
            let residual = judge.residual(candidate);
            let (off, _) = terms(&candidate, goal.to_array(), Cost::Normal);
            if residual < best.0 && off < 0.0 {
                best = (residual, Some((candidate, k)));
            }
        }
    }
    best.1
}

/// Where a ray from the centre leaves the shape.
fn end_along(shape: &Supershaped, axis: DVec3) -> f64 {
    let at = shape.semi_axes.max_element();
    let (off, _) = terms(shape, (shape.center + axis * at).to_array(), Cost::Radial);
    (at - off).max(0.0)
}

/// Stretched about the other end, with the ends as they are and flatter.
fn longer(shape: &Supershaped, k: usize, axis: DVec3, factor: f64, by: f64) -> Vec<Supershaped> {
    let mut stretched = *shape;
    stretched.semi_axes[k] *= factor;
    stretched.center += axis * (0.5 * by);
    let mut all = vec![stretched];
    for n in SHARP {
        let mut sharp = stretched;
        let curve = if k == 2 { &mut sharp.meridian } else { &mut sharp.equator };
        if curve.m == 4 && curve.n.iter().all(|own| *own < n) {
            curve.n = [n; 3];
            all.push(sharp);
        }
    }
    all
}
