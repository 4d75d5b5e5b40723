//! Errors of single entry points. Those of solids and of their parameters stand at the root:
//! [`SolidError`](crate::SolidError), [`ParamError`](crate::ParamError).

pub use crate::geom::{CameraError, ImageError, MeshError, PointCloudError};
pub use crate::io::save::SaveError;
#[cfg(feature = "import")]
pub use crate::io::{LoadError, ReadError};
pub use crate::mesh::MeshingError;
pub use crate::query::PrepareError;
pub use crate::render::RenderError;
#[cfg(feature = "formula")]
#[doc(inline)]
pub use rvachev_field::FormulaError;
