//! Explicit surfaces: points, meshes and samples of single primitives without a field.
//!
//! | | |
//! |---|---|
//! | [`ParametricSurface`] | point, tangents and exact normal by two parameters |
//! | [`ParametricCurve`] | the same of plane curves |
//! | [`PatchSettings`] | its meshes: closed and manifold by construction |
//! | [`ParametricSurface::sample`] | points uniform by area |
//! | [`PointMethod`] | Franklin and Barr's six methods for points of superquadrics |
//! | [`ControlPolygon`], [`SubdivisionRevolution`], [`ControlGrid`] | subdivision |

mod adaptive;
mod curve;
mod parametric;
mod parametric_curve;
mod patch;
mod points;
mod polar;
mod power;
mod sampling;
mod spacing;
mod stitch;
mod subdivision;

pub use parametric::{Frame, ParametricSurface};
pub use parametric_curve::ParametricCurve;
pub use patch::{PatchError, PatchSettings, Spacing};
pub use points::{
    BinomialSeries, CurveSpread, ExactExplicit, LogTable, PlaneSymmetry, PointError, PointMethod, PointSettings,
    PowerTables, ProductTables, RawParametric, SeriesExplicit, Symmetry, reflect, reflect_plane,
};
pub use sampling::SurfacePoint;
pub use subdivision::{
    ControlGrid, ControlPoint, ControlPolygon, ProfileEnd, SubdivisionError, SubdivisionRevolution, Tension,
    hyperbola_of_ellipse,
};
