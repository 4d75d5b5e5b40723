//! Why there is no fit.

use crate::error::{CameraError, ImageError, PointCloudError};
use crate::eval::CompileError;
use crate::{Cancelled, SolidError};

/// What is missing for a fit, or was in its way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There are fewer points than tell the parameters.
    #[error("{points} points are too few: a {kind} has {parameters} parameters and wants {needed} points or more")]
    TooFew {
        /// What was to be fitted.
        kind: &'static str,
        /// How many points there are.
        points: usize,
        /// How many parameters there are.
        parameters: usize,
        /// How many points are needed.
        needed: usize,
    },
    /// The points that are dense enough to be a surface are in one plane, on a line or in a point.
    #[error(
        "the {points} points that are a surface are {extent}: they do not tell how deep the object is; \
         add points of another side of it"
    )]
    Flat {
        /// How many they are.
        points: usize,
        /// Where they are.
        extent: &'static str,
    },
    /// Hardly any point is near the best solid that was found.
    #[error(
        "only {:.1} % of the points are of the best solid that was found: they are strewn, or of \
         several objects; fit a part of them",
        100.0 * inliers
    )]
    NoSurface {
        /// Their share, 0 to 1.
        inliers: f64,
    },
    /// The mesh or the points enclose nothing.
    #[error(
        "no place is inside of the {count} {of}, by their winding number: they are of an open surface, or face \
         inwards; close them, or turn them round"
    )]
    Hollow {
        /// Triangles or points.
        of: &'static str,
        /// How many there are.
        count: usize,
    },
    /// The cloud is too small, too large or too far away for lengths of solids.
    #[error(
        "the cloud is {value:?} {property}; allowed: {allowed}; scale or move it first, or leave out points far from the rest"
    )]
    Extent {
        /// What is told of the cloud.
        property: &'static str,
        /// Its value, in length units.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A setting is out of its range.
    #[error("{setting} is {value}; allowed: {allowed}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The solid that was found, or is to be compared with, is not valid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The solid's surface was not found.
    #[error("the solid cannot be meshed, which its principal axes are taken from: {what}")]
    Meshing {
        /// Why not.
        what: String,
    },
    /// The cloud is not the one that was asked about.
    #[error(transparent)]
    Points(#[from] PointCloudError),
    /// The camera of a picture sees nothing.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The picture's size is none.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// There are not as many labels as there are things to label.
    #[error("{labels} labels for {count} {of}; one each is needed")]
    Labels {
        /// How many labels were given.
        labels: usize,
        /// How many are needed.
        count: usize,
        /// What is labelled.
        of: &'static str,
    },
    /// Creases are told by normals, which the cloud does not have.
    #[error("the cloud of {points} points has no normals, which creases are told by; add normals or give labels")]
    NoNormals {
        /// How many points there are.
        points: usize,
    },
    /// A segment cannot be fitted.
    #[error("segment {label}: {source}; give its points the label of a neighbour, or leave them out")]
    Segment {
        /// Its label.
        label: u32,
        /// Why not.
        source: Box<FitError>,
    },
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<CompileError> for FitError {
    fn from(error: CompileError) -> FitError {
        match error {
            CompileError::Solid(error) => error.into(),
            CompileError::Cancelled(cancelled) => cancelled.into(),
        }
    }
}
