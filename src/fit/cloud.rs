//! Clouds brought to a size near 1 about 0, thinned to what is searched.

use glam::DVec3;

use super::check::{check_depth, check_extent};
use super::error::FitError;
use super::linear::median;
use super::random::Random;
use super::settings::FitSettings;
use crate::geom::PointCloud;

/// The searched points of a cloud, in units of its size.
pub(super) struct Scaled {
    pub(super) points: Vec<DVec3>,
    pub(super) normals: Option<Vec<DVec3>>,
    pub(super) center: DVec3,
    /// The root mean square distance from the centre, in length units.
    pub(super) size: f64,
    /// The points are those of the cloud, in their order.
    pub(super) is_whole: bool,
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
        check_extent(cloud)?;
        let all = cloud.positions();
        let order: Vec<usize> = if all.len() > settings.search_points {
            Random::new(settings.seed).chosen(all.len(), settings.search_points)
        } else {
            (0..all.len()).collect()
        };
        let order = without_strays(all, order);
        let center = order.iter().map(|i| all[*i]).sum::<DVec3>() / order.len() as f64;
        let square = order.iter().map(|i| all[*i].distance_squared(center)).sum::<f64>() / order.len() as f64;
        let size = square.sqrt();
        if size == 0.0 {
            return Err(FitError::Flat { points: cloud.len(), extent: "all in one place" });
        }
        if !(SIZES[0]..=SIZES[1]).contains(&size) {
            let (property, allowed) = ("in size", "0.00001 to 10000000");
            return Err(FitError::Extent { property, value: size, allowed });
        }
        let points: Vec<DVec3> = order.iter().map(|i| (all[*i] - center) / size).collect();
        check_depth(&points)?;
        let normals = cloud.normals().map(|normals| order.iter().map(|i| normals[*i].as_dvec3()).collect());
        Ok(Scaled { is_whole: points.len() == cloud.len(), points, normals, center, size })
    }
}

/// Sizes of clouds of which every fit is a solid: what is found is from 10⁻⁴ to 10² times as large,
/// and lengths of solids are from 10⁻⁹ to 10⁹.
pub(super) const SIZES: [f64; 2] = [1e-5, 1e7];

/// Points further from the middle than so many times the median distance from it are not of the
/// object: a single one would make the size of the cloud its own.
const STRAY: f64 = 100.0;

/// So many points tell where the middle is, and how far from it points are.
const ASKED: usize = 512;

/// The points without those that are far from all others. Half of the points are hardly ever
/// strays: the middle is among those that most of a random choice are near.
fn without_strays(all: &[DVec3], order: Vec<usize>) -> Vec<usize> {
    // At random: a file may have strays at regular places.
    let some: Vec<DVec3> = Random::new(0).chosen(order.len(), ASKED).into_iter().map(|k| all[order[k]]).collect();
    let middle = DVec3::from_array([0, 1, 2].map(|axis| {
        let mut along: Vec<f64> = some.iter().map(|p| p[axis]).collect();
        median(&mut along)
    }));
    let typical = median(&mut some.iter().map(|p| p.distance(middle)).collect::<Vec<_>>());
    let is_near = |i: &usize| typical == 0.0 || all[*i].distance(middle) <= STRAY * typical;
    order.into_iter().filter(is_near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever their order: every third point is a stray.
    #[test]
    fn strays_may_be_at_regular_places() {
        let mut random = Random::new(4);
        let mut point = |i: u32| {
            let p = DVec3::new(random.unit(), random.unit(), random.unit());
            if i.is_multiple_of(3) { 1e5 * (p + 1.0) } else { p }
        };
        let points: Vec<DVec3> = (0..1200).map(&mut point).collect();
        let kept = without_strays(&points, (0..1200).collect());
        assert!(kept.len() == 800 && kept.iter().all(|i| i % 3 != 0), "{}", kept.len());
    }
}
