//! Tapered, twisted and bent superellipsoids from points.

use super::cloud::Scaled;
use super::deform_recover::{Straight, recover_deformed};
use super::deformable::{Deformable, PARAMETERS};
use super::error::FitError;
use super::finish::finish;
use super::result::{Fit, SearchReport, Shape};
use super::settings::FitSettings;
use super::superellipsoid::finish_quadric;
use crate::geom::PointCloud;
use crate::{Run, Superellipsoid};

/// What the rows of the covariance are.
const NAMES: [&str; PARAMETERS] = [
    "e1", "e2", "ln a1", "ln a2", "ln a3", "taper x", "taper y", "twist", "bend x", "bend y", "turn x", "turn y",
    "turn z", "shift x", "shift y", "shift z",
];

/// A superellipsoid that is tapered and twisted along its z axis, then bent, in this order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeformedSuperellipsoid {
    /// The superellipsoid before it is deformed.
    pub leaf: Superellipsoid,
    /// Tapers along x and y over its height: those of [`Solid::taper`](crate::Solid::taper); ±0.9.
    pub taper: [f64; 2],
    /// Radians a length unit: the rate of [`Solid::twist`](crate::Solid::twist), at most half a
    /// turn between the middle and an end.
    pub twist: f64,
    /// Curvature times the unit vector across the axis to its centre, per length unit: see
    /// [`Solid::bend`](crate::Solid::bend).
    pub bend: glam::DVec2,
}

/// The superellipsoid, tapered, twisted and bent, that points are of; one that is not deformed
/// where that explains the points as well, each parameter at its price (Schwarz's criterion).
///
/// Points should be of the whole surface. A twist of a round section, and a bend of a ball, leave
/// no trace: the covariance tells.
///
/// # Errors
///
/// Those of [`superellipsoid`](super::superellipsoid()).
///
/// ```
/// use rvachev::fit::{FitSettings, Shape, deformed};
/// use rvachev::{CellSize, MeshSettings, PointCloud, Solid};
///
/// let truth = Solid::superellipsoid([1.0, 0.7, 2.0], 0.5, 0.6).taper(0.4, 0.2, 4.0).bend(0.3, rvachev::deg(30.0));
/// let mesh = truth.mesh(&MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() })?;
/// let cloud = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect())?;
/// let fit = deformed(&cloud, &FitSettings::default())?;
/// let Shape::Deformed(found) = fit.shape() else { panic!("not deformed") };
/// assert!((found.bend.length() - 0.3).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn deformed(cloud: &PointCloud, settings: &FitSettings) -> Result<Fit, FitError> {
    deformed_with(cloud, settings, &Run::default())
}

/// [`deformed`] with a [`Run`].
///
/// # Errors
///
/// Those of [`deformed`], and [`FitError::Cancelled`].
pub fn deformed_with(cloud: &PointCloud, settings: &FitSettings, run: &Run) -> Result<Fit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    let scaled = Scaled::of(cloud, settings, "deformed superellipsoid", PARAMETERS)?;
    let found = recover_deformed(&scaled.points, scaled.normals.as_deref(), settings, &run.stage(0.0, 0.9))?;
    let search = SearchReport {
        starts: found.effort.tried,
        evaluations: found.effort.evaluations,
        one_sided: found.one_sided,
        ..SearchReport::default()
    };
    match found.best {
        Straight::Quadric(mixture) => finish_quadric(cloud, &scaled, &mixture, None, search, &run),
        Straight::Deformed(mixture) => {
            let shape = Shape::Deformed(leaf(&mixture.model, scaled.size));
            finish(cloud, &scaled, &mixture, found.weighed, (shape, NAMES), search, &run)
        }
    }
}

/// The deformed superellipsoid in the cloud's length units.
pub(super) fn leaf(model: &Deformable, size: f64) -> DeformedSuperellipsoid {
    let [e1, e2] = model.base.e;
    DeformedSuperellipsoid {
        leaf: Superellipsoid::new(model.base.semi_axes * size, e1, e2),
        taper: model.taper,
        twist: model.twist / size,
        bend: model.bend / size,
    }
}
