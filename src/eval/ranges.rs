//! Ranges of nodes, and the boxes that they are asked over.

use glam::DVec3;
use rvachev_field::Zone;

use super::program::Kind;
use crate::{Bounds, Interval};

/// The range of a node from those of its operands.
pub(super) fn joined(kind: &Kind, mut operands: impl Iterator<Item = Interval>) -> Interval {
    let Some(first) = operands.next() else { return Interval::ALL };
    match kind {
        Kind::Shift(by) => first + *by,
        Kind::Join { op, rule, .. } => operands.fold(first, |all, next| rule.join(*op, all, next)),
        Kind::Leaf(_) => Interval::ALL,
    }
}

/// The zone's hull as a box, a little larger, so that what only touches it counts as met.
pub(super) fn hull_of(zone: &Zone) -> Bounds {
    let hull = zone.hull();
    let low = DVec3::from_array(hull.map(Interval::lo));
    let high = DVec3::from_array(hull.map(Interval::hi));
    let margin = 1e-9 * (high - low).length() + 1e-13 * (low.abs() + high.abs()).element_sum();
    let margin = if margin.is_finite() { margin } else { 0.0 };
    Bounds::new(low - margin, high + margin)
}
