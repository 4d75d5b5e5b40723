//! From a model of the scaled cloud to a fit of all its points.

use glam::{DQuat, DVec3};

use super::cloud::Scaled;
use super::cost::Cost;
use super::covariance::Covariance;
use super::deviations::Deviation;
use super::error::FitError;
use super::kernel::{Model, residuals};
use super::mixture::{Mixture, Weighed};
use super::result::{Fit, SearchReport, Shape};
use super::samples::Samples;
use crate::geom::PointCloud;
use crate::{Cancelled, Field, ParamError, Run, SolidError};
use rvachev_field::check::LARGEST_LENGTH;
use rvachev_num::jobs;

/// If a smaller share of the points is of the solid, it is not what they are of.
const FEWEST: f64 = 0.05;

/// Points that one thread weighs at a time.
const CHUNK: usize = 4096;

/// Weighs all points of a cloud by a model of it, whose shape is given in the cloud's length units.
/// What the model says of the searched points may be known.
pub(super) fn finish<M: Model<N>, const N: usize>(
    cloud: &PointCloud,
    scaled: &Scaled,
    mixture: &Mixture<M>,
    known: Option<Weighed<N>>,
    shape: (Shape, [&'static str; N]),
    search: SearchReport,
    run: &Run,
) -> Result<Fit, FitError> {
    let Mixture { model, noise, .. } = mixture;
    let (shape, names) = shape;
    let Weighed { residuals: off, chances, sums } = known.unwrap_or_else(|| {
        let samples = Samples::<f64>::new(scaled.points.iter().copied());
        mixture.weigh(&samples, Cost::Normal)
    });
    let chance = mixture.chance();
    let weighed = |points: &[DVec3]| -> Result<Vec<(f32, f64)>, Cancelled> {
        run.check()?;
        let samples = Samples::<f64>::new(points.iter().map(|p| (*p - scaled.center) / scaled.size));
        let mut off = vec![0.0; samples.padded()];
        residuals(model, &samples, Cost::Normal, &mut off);
        Ok(off[..samples.len()].iter().map(|d| (chance.at(*d) as f32, *d)).collect())
    };
    let all = cloud.positions();
    let chunks: Vec<Vec<(f32, f64)>> = if scaled.is_whole {
        vec![chances.iter().zip(&off).map(|(p, d)| (*p as f32, *d)).collect()]
    } else {
        run.install(|| jobs::try_chunks(all, CHUNK, |_, chunk| weighed(chunk)))?
    };
    let weights: Vec<f32> = chunks.iter().flatten().map(|w| w.0).collect();
    let inliers = weights.iter().map(|w| f64::from(*w)).sum::<f64>() / weights.len() as f64;
    if inliers < FEWEST {
        return Err(FitError::NoSurface { inliers });
    }
    run.check()?;
    let deviation = Deviation::of(chunks.iter().flatten().filter(|w| w.0 > 0.5).map(|w| w.1 * scaled.size));
    let share = cloud.len() as f64 / off.len() as f64;
    let units = std::array::from_fn(|i| if i + 3 >= N { scaled.size } else { 1.0 });
    let covariance = Covariance::from_normal(names, &sums.hessian, *noise, share, units);
    let criterion = mixture.criterion(off.iter().copied());
    let (rotation, center) = model.pose();
    let fit = Fit {
        shape,
        rotation: DQuat::from_mat3(&rotation).normalize(),
        translation: scaled.center + center * scaled.size,
        weights,
        inliers,
        noise: noise * scaled.size,
        deviation,
        covariance,
        criterion,
        search,
    };
    if fit.translation.abs().max_element() < 0.1 * LARGEST_LENGTH {
        // Parameters in their ranges are all that it needs near the origin; its box is long to
        // find. Deformations keep to theirs.
        let checked = |check: Result<(), ParamError>, name: &str| {
            check.map_err(|source| SolidError::Parameter { path: name.to_string(), source })
        };
        match &fit.shape {
            Shape::Superellipsoid(leaf) => checked(leaf.check(), leaf.name())?,
            Shape::Supershape(leaf) => checked(leaf.check(), leaf.name())?,
            Shape::Deformed(deformed) => checked(deformed.leaf.check(), deformed.leaf.name())?,
        }
    } else {
        fit.solid().bounds()?;
    }
    run.report(1.0);
    Ok(fit)
}
