//! Explicit surfaces: points, meshes and samples of single primitives without a field.
//!
//! | | |
//! |---|---|
//! | [`ParametricSurface`] | point, tangents and exact normal by two parameters |
//! | [`PatchSettings`] | its meshes: closed and manifold by construction |

mod angle;
mod curve;
mod parametric;
mod patch;
mod spacing;

pub use parametric::{Frame, ParametricSurface};
pub use patch::{PatchError, PatchSettings, Spacing};
