//! From a model of the scaled cloud to a fit of all its points.

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use super::cloud::Scaled;
use super::cost::Cost;
use super::covariance::Covariance;
use super::deviations::Deviation;
use super::error::FitError;
use super::kernel::{Model, residuals};
use super::mixture::Mixture;
use super::result::{Fit, SearchReport, Shape};
use super::samples::Samples;
use crate::geom::PointCloud;
use crate::{Cancelled, Run};

/// If a smaller share of the points is of the solid, it is not what they are of.
const FEWEST: f64 = 0.05;

/// Points that one thread weighs at a time.
const CHUNK: usize = 4096;

/// Weighs all points of a cloud by a model of it, whose shape is given in the cloud's length units.
pub(super) fn finish<M: Model<N>, const N: usize>(
    cloud: &PointCloud,
    scaled: &Scaled,
    mixture: &Mixture<M>,
    shape: Shape,
    names: [&'static str; N],
    search: SearchReport,
    run: &Run,
) -> Result<Fit, FitError> {
    let Mixture { model, noise, .. } = mixture;
    let log_area = mixture.log_area.unwrap_or_else(|| model.log_area().0);
    let weighed = |points: &[DVec3]| -> Result<Vec<(f32, f64)>, Cancelled> {
        run.check()?;
        let samples = Samples::<f64>::new(points.iter().map(|p| (*p - scaled.center) / scaled.size));
        let mut off = vec![0.0; samples.padded()];
        residuals(model, &samples, Cost::Normal, &mut off);
        Ok(off[..points.len()].iter().map(|d| (mixture.chance(log_area, *d) as f32, d * scaled.size)).collect())
    };
    let chunks: Vec<_> = cloud.positions().par_chunks(CHUNK).map(weighed).collect::<Result<_, _>>()?;
    let weights: Vec<f32> = chunks.iter().flatten().map(|w| w.0).collect();
    let inliers = weights.iter().map(|w| f64::from(*w)).sum::<f64>() / weights.len() as f64;
    if inliers < FEWEST {
        return Err(FitError::NoSurface { inliers });
    }
    let deviation = Deviation::of(chunks.iter().flatten().filter(|w| w.0 > 0.5).map(|w| w.1));
    let samples = Samples::<f64>::new(scaled.points.iter().copied());
    let mut off = vec![0.0; samples.padded()];
    residuals(model, &samples, Cost::Normal, &mut off);
    let mut chances = vec![0.0; samples.padded()];
    for (chance, d) in chances[..samples.len()].iter_mut().zip(&off) {
        *chance = mixture.chance(log_area, *d);
    }
    let share = cloud.len() as f64 / samples.len() as f64;
    let covariance = Covariance::of(model, names, &samples, &chances, *noise, share, scaled.size);
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
        search,
    };
    fit.solid().bounds()?;
    run.report(1.0);
    Ok(fit)
}
