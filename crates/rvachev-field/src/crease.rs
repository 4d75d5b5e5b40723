//! Planes at which slopes have no bound.

use glam::DVec3;

/// A plane at which the slopes of a leaf have no bound: `normal · p = offset`.
#[derive(Clone, Copy, Debug)]
pub struct Crease {
    /// Across the plane; of any length.
    pub normal: DVec3,
    /// Where it is.
    pub offset: f64,
    /// Whether the value jumps there.
    pub jumps: bool,
}
