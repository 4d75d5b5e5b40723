//! Explicit surfaces: points, meshes and samples of single primitives without a field.
//!
//! | | |
//! |---|---|
//! | [`ParametricSurface`] | point, tangents and exact normal by two parameters |
//! | [`ParametricCurve`] | the same of plane curves |
//! | [`PatchSettings`] | its meshes: closed and manifold by construction |
//! | [`ParametricSurface::sample`] | points uniform by area |

mod adaptive;
mod curve;
mod parametric;
mod parametric_curve;
mod patch;
mod polar;
mod sampling;
mod spacing;
pub(crate) mod stitch;

pub use parametric::{Frame, Parametric, ParametricSurface};
pub use parametric_curve::ParametricCurve;
pub use patch::{PatchError, PatchSettings, Spacing};
pub use sampling::SurfacePoint;

pub use crate::geom::QuadMesh;
