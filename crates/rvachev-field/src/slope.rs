//! Ranges that follow from slopes: by a Lipschitz bound, and by the mean-value form.

use super::outlined::Outlined;
use crate::{Dual, Interval};

/// Range of a formula with slope at most 1: the value at the centre give or take half the
/// diagonal, or the range by intervals where that is narrower.
pub(super) fn lipschitz_range(leaf: &impl Outlined, region: [Interval; 3]) -> Interval {
    let wide = leaf.over(region);
    let centre = region.map(Interval::mid);
    let value = leaf.at(centre);
    // Slope at most about 1: rounding is relative to the coordinates.
    let size = centre.iter().fold(value.abs(), |sum, c| sum + c.abs());
    wide.narrowed_by(Interval::around(value, half_diagonal(region) + 1e-14 * size))
}

/// How far a point of a box is from its middle at most, rounding of the middle included.
pub(super) fn half_diagonal(region: [Interval; 3]) -> f64 {
    let squared = region.iter().fold(0.0, |sum, side| sum + side.width() * side.width());
    let rounding = region.iter().fold(0.0, |sum, side| sum + side.magnitude());
    0.5 * squared.sqrt() * (1.0 + 1e-14) + 1e-15 * rounding
}

/// The mean-value form: what is at the centre plus the range of the slopes times the offset
/// from it. Its excess shrinks with the square of the box. `over` is the formula over the
/// box, with slopes; `centre` its value at the middle.
pub(super) fn mean_value_range(over: Dual<Interval>, centre: Interval, region: [Interval; 3]) -> Interval {
    let mut range = centre;
    for (slope, side) in over.gradient().into_iter().zip(region) {
        range = range + slope * (side - side.mid());
    }
    over.value().narrowed_by(range)
}
