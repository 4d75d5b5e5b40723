//! Whether points tell a solid at all.

use glam::DVec3;

use super::error::FitError;
use super::linear::Principal;
use crate::geom::PointCloud;
use rvachev_field::check::LARGEST_LENGTH;

/// Variances across a plane below this share of the largest one are rounding.
const FLAT: f64 = 1e-14;

/// That points are not all in a plane.
pub(super) fn check_depth(points: &[DVec3]) -> Result<(), FitError> {
    let principal = Principal::of(points.iter().copied());
    let [least, middle, most] = principal.variances;
    let flat = |variance: f64| variance <= FLAT * most;
    if flat(least) {
        let extent = if flat(middle) { "all on one line" } else { "all in one plane" };
        return Err(FitError::Flat { points: points.len(), extent });
    }
    Ok(())
}

/// That points are where solids may be.
pub(super) fn check_extent(cloud: &PointCloud) -> Result<(), FitError> {
    let farthest = cloud.positions().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if farthest > LARGEST_LENGTH {
        let (property, allowed) = ("from the origin", "at most 1000000000");
        return Err(FitError::Extent { property, value: farthest, allowed });
    }
    Ok(())
}
