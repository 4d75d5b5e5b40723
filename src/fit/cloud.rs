//! Clouds brought to a size near 1 about 0, thinned to what is searched.

use glam::DVec3;

use super::check::check_depth;
use super::error::FitError;
use super::random::Random;
use super::settings::FitSettings;
use crate::field::COORDINATE_LIMIT;
use crate::geom::PointCloud;

/// The searched points of a cloud, in units of its size.
pub(super) struct Scaled {
    pub(super) points: Vec<DVec3>,
    pub(super) normals: Option<Vec<DVec3>>,
    pub(super) center: DVec3,
    /// The root mean square distance from the centre, in length units.
    pub(super) size: f64,
}

impl Scaled {
    pub(super) fn of(
        cloud: &PointCloud,
        settings: &FitSettings,
        kind: &'static str,
        parameters: usize,
    ) -> Result<Scaled, FitError> {
        settings.check()?;
        let needed = 2 * parameters + 2;
        if cloud.len() < needed {
            return Err(FitError::TooFew { kind, points: cloud.len(), parameters, needed });
        }
        let all = cloud.positions();
        let farthest = all.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        if farthest > COORDINATE_LIMIT {
            let (property, allowed) = ("from the origin", "at most 1000000000");
            return Err(FitError::Extent { property, value: farthest, allowed });
        }
        let order: Vec<usize> = if all.len() > settings.search_points {
            Random::new(settings.seed).chosen(all.len(), settings.search_points)
        } else {
            (0..all.len()).collect()
        };
        let center = order.iter().map(|i| all[*i]).sum::<DVec3>() / order.len() as f64;
        let square = order.iter().map(|i| all[*i].distance_squared(center)).sum::<f64>() / order.len() as f64;
        let size = square.sqrt();
        if size == 0.0 {
            return Err(FitError::Flat { points: cloud.len(), extent: "all in one place" });
        }
        if !(1e-6..=1e8).contains(&size) {
            let (property, allowed) = ("in size", "0.000001 to 100000000");
            return Err(FitError::Extent { property, value: size, allowed });
        }
        let points: Vec<DVec3> = order.iter().map(|i| (all[*i] - center) / size).collect();
        check_depth(&points)?;
        let normals = cloud.normals().map(|normals| order.iter().map(|i| normals[*i].as_dvec3()).collect());
        Ok(Scaled { points, normals, center, size })
    }
}
