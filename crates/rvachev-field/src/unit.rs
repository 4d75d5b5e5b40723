//! Unit vectors.

use glam::DVec3;

/// A vector at length 1, without overflow or underflow on the way; NaN for one of length 0.
pub fn unit(v: DVec3) -> DVec3 {
    /// Squares of lengths between this and its inverse are exact but for rounding.
    const LEAST: f64 = 1e-200;
    let square = v.length_squared();
    let v = if square > LEAST && square < 1.0 / LEAST { v } else { v / v.abs().max_element() };
    v.normalize()
}
