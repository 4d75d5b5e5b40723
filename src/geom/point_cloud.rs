//! Points of a surface without connections.

use glam::{DVec3, Vec3};

use crate::Cancelled;

/// Points in space, each with a normal and a colour if the cloud has them.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use rvachev::PointCloud;
///
/// let cloud = PointCloud::new(vec![DVec3::X, DVec3::Y])?.with_normals(vec![Vec3::X, Vec3::Y])?;
/// assert_eq!(cloud.len(), 2);
/// # Ok::<(), rvachev::error::PointCloudError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct PointCloud {
    positions: Vec<DVec3>,
    normals: Option<Vec<Vec3>>,
    colors: Option<Vec<[u8; 3]>>,
}

/// Why a point cloud cannot be built from the given parts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PointCloudError {
    /// A position has a component that is NaN or infinite.
    #[error(
        "point {point} is at {position}, which is not finite; {count} of the points are like this, and \
         PointCloud::of_finite leaves them out"
    )]
    Position {
        /// The first such point, counted from 0.
        point: usize,
        /// Where it is.
        position: DVec3,
        /// How many there are.
        count: usize,
    },
    /// A normal has a component that is NaN or infinite.
    #[error("the normal of point {point} is not finite")]
    Normal {
        /// The point, counted from 0.
        point: usize,
    },
    /// There are not as many of an attribute as of points.
    #[error("{given} {attribute} for {points} points; one a point is needed")]
    Count {
        /// What was given.
        attribute: &'static str,
        /// How many.
        given: usize,
        /// Number of points.
        points: usize,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl PointCloud {
    /// A cloud of points, in length units.
    ///
    /// # Errors
    ///
    /// [`PointCloudError::Position`], naming the first that is not finite.
    pub fn new(positions: Vec<DVec3>) -> Result<PointCloud, PointCloudError> {
        if let Some(point) = positions.iter().position(|p| !p.is_finite()) {
            let count = positions.iter().filter(|p| !p.is_finite()).count();
            return Err(PointCloudError::Position { point, position: positions[point], count });
        }
        Ok(PointCloud { positions, normals: None, colors: None })
    }

    /// A cloud of those points that are finite, and the numbers of the others, from 0: scanners
    /// write NaN where they saw nothing.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::PointCloud;
    ///
    /// let (cloud, left_out) = PointCloud::of_finite(vec![DVec3::X, DVec3::NAN, DVec3::Y]);
    /// assert_eq!((cloud.len(), left_out), (2, vec![1]));
    /// ```
    #[must_use]
    pub fn of_finite(positions: Vec<DVec3>) -> (PointCloud, Vec<usize>) {
        let is_left_out = |i: &usize| !positions[*i].is_finite();
        let left_out = (0..positions.len()).filter(is_left_out).collect();
        let positions = positions.into_iter().filter(|p| p.is_finite()).collect();
        (PointCloud { positions, normals: None, colors: None }, left_out)
    }

    fn counted(&self, attribute: &'static str, given: usize) -> Result<(), PointCloudError> {
        let points = self.positions.len();
        if given == points { Ok(()) } else { Err(PointCloudError::Count { attribute, given, points }) }
    }

    /// The same cloud with a unit normal per point, out of the solid.
    ///
    /// # Errors
    ///
    /// [`PointCloudError::Count`] if their number is not that of the points, and
    /// [`PointCloudError::Normal`] if one of them is NaN or infinite.
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<PointCloud, PointCloudError> {
        self.counted("normals", normals.len())?;
        if let Some(point) = normals.iter().position(|normal| !normal.is_finite()) {
            return Err(PointCloudError::Normal { point });
        }
        self.normals = Some(normals);
        Ok(self)
    }

    /// The same cloud with an sRGB colour per point.
    ///
    /// # Errors
    ///
    /// [`PointCloudError::Count`] if their number is not that of the points.
    pub fn with_colors(mut self, colors: Vec<[u8; 3]>) -> Result<PointCloud, PointCloudError> {
        self.counted("colors", colors.len())?;
        self.colors = Some(colors);
        Ok(self)
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The points, in length units.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Their unit normals, if the cloud has them.
    #[must_use]
    pub fn normals(&self) -> Option<&[Vec3]> {
        self.normals.as_deref()
    }

    /// Their sRGB colours, if the cloud has them.
    #[must_use]
    pub fn colors(&self) -> Option<&[[u8; 3]]> {
        self.colors.as_deref()
    }
}
