//! Why there is no mesh of a solid.

use glam::DVec3;

use super::extract::ExtractError;
use super::lattice::LatticeError;
use crate::{Cancelled, SolidError};

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshingError {
    /// The solid is at fault, or unbounded while no bounds are given.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The resolution does not suit the bounds.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There are more vertices than 32-bit indices count.
    #[error("{vertices} vertices, allowed: at most {}", u32::MAX)]
    TooLarge {
        /// How many vertices the mesh would have.
        vertices: u64,
    },
    /// The solid leaves the bounds, and the settings do not want it cut.
    #[error("the solid goes on beyond the bounds at {at}; allowed: a solid within them, or `AtBounds::Cap`")]
    LeavesBounds {
        /// A point of the boundary of the bounds that is inside the solid; if there is none, one
        /// of the solid outside of the bounds.
        at: DVec3,
    },
    /// The extraction contradicts itself: a defect of this crate.
    #[error("internal error, please report it: {what}")]
    Internal {
        /// What was found.
        what: String,
    },
}

impl From<ExtractError> for MeshingError {
    fn from(error: ExtractError) -> MeshingError {
        match error {
            ExtractError::Cancelled(cancelled) => MeshingError::Cancelled(cancelled),
            ExtractError::TooLarge { count } => MeshingError::TooLarge { vertices: count },
            other => MeshingError::Internal { what: other.to_string() },
        }
    }
}
