//! Superellipsoids from points.

use super::cloud::Scaled;
use super::error::FitError;
use super::finish::finish;
use super::mixture::{Mixture, Weighed};
use super::recover::recover;
use super::result::{Fit, SearchReport, Shape};
use super::settings::FitSettings;
use super::superquadric::{PARAMETERS, Superquadric};
use crate::geom::PointCloud;
use crate::{Run, Superellipsoid};

/// What the rows of the covariance are.
const NAMES: [&str; PARAMETERS] =
    ["e1", "e2", "ln a1", "ln a2", "ln a3", "turn x", "turn y", "turn z", "shift x", "shift y", "shift z"];

/// The superellipsoid that points are of: some of them, of one side or all around, with noise.
///
/// Points that are not of its surface may be strewn over the box about it, up to 60 % of all,
/// without their share being told; or be of a table that it stands on. 24 points are needed and
/// some hundreds are wanted; of more than [`FitSettings::search_points`] a random part is searched.
/// Normals are used where the cloud has them. The same seed gives the same bits on any number of
/// threads. How it works, and how often it is right: [the module](super).
///
/// Several sets of parameters describe one solid, or nearly so: a box has any of its axes as the
/// polar one, and a square prism is its dual turned by 45°. Which one is found is not told by
/// points: compare surfaces, not parameters.
///
/// # Errors
///
/// [`FitError::TooFew`], [`FitError::Flat`], [`FitError::Extent`] and [`FitError::NoSurface`] of
/// the points, and [`FitError::Setting`].
///
/// ```
/// use rvachev::fit::{FitSettings, Shape, superellipsoid};
/// use rvachev::surface::ParametricSurface;
/// use rvachev::{PointCloud, Superellipsoid};
///
/// let truth = Superellipsoid::new([1.2, 0.8, 2.0], 0.4, 1.3);
/// let sampled = ParametricSurface::of(&truth)?.sample(800, 1)?;
/// let cloud = PointCloud::new(sampled.iter().map(|s| s.point).collect())?;
/// let fit = superellipsoid(&cloud, &FitSettings::default())?;
/// let Shape::Superellipsoid(leaf) = fit.shape() else { unreachable!() };
/// assert!((leaf.semi_axes().element_product() - 1.92).abs() < 0.01);
/// assert!(fit.noise() < 1e-4 && fit.inliers() > 0.99);
/// assert!(fit.solid().contains([0.0, 0.0, 1.9])?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn superellipsoid(cloud: &PointCloud, settings: &FitSettings) -> Result<Fit, FitError> {
    superellipsoid_with(cloud, settings, &Run::default())
}

/// [`superellipsoid`] with a [`Run`].
///
/// # Errors
///
/// Those of [`superellipsoid`], and [`FitError::Cancelled`].
pub fn superellipsoid_with(cloud: &PointCloud, settings: &FitSettings, run: &Run) -> Result<Fit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    let scaled = Scaled::of(cloud, settings, "superellipsoid", PARAMETERS)?;
    let recovered =
        recover(&scaled.points, scaled.normals.as_deref(), settings.cost, settings.seed, &run.stage(0.0, 0.9))?;
    let search = SearchReport {
        starts: recovered.effort.tried,
        evaluations: recovered.effort.evaluations,
        one_sided: recovered.one_sided,
        table: recovered.table.is_some(),
        ..SearchReport::default()
    };
    // The points of a table are not weighed yet.
    let known = recovered.table.is_none().then_some(recovered.weighed);
    finish_quadric(cloud, &scaled, &recovered.mixture, known, search, &run)
}

/// The fit of a superellipsoid.
pub(super) fn finish_quadric(
    cloud: &PointCloud,
    scaled: &Scaled,
    mixture: &Mixture<Superquadric>,
    known: Option<Weighed<PARAMETERS>>,
    search: SearchReport,
    run: &Run,
) -> Result<Fit, FitError> {
    let Superquadric { e: [e1, e2], semi_axes, .. } = mixture.model;
    let shape = Shape::Superellipsoid(Superellipsoid::new(semi_axes * scaled.size, e1, e2));
    finish(cloud, scaled, mixture, known, (shape, NAMES), search, run)
}
