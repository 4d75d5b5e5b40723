//! Supershapes from points.

use super::cloud::Scaled;
use super::error::FitError;
use super::finish::finish;
use super::gielis::{Curve, PARAMETERS, Supershaped};
use super::result::{Fit, SearchReport, Shape};
use super::settings::FitSettings;
use super::shape_recover::{Best, recover_shape};
use super::superellipsoid::finish_quadric;
use crate::geom::PointCloud;
use crate::{Gielis, Radius, Run, Supershape};

/// What the rows of the covariance are.
const NAMES: [&str; PARAMETERS] = [
    "ln n1", "ln n2", "ln n3", "ln N1", "ln N2", "ln N3", "ln a1", "ln a2", "ln a3", "turn x", "turn y", "turn z",
    "shift x", "shift y", "shift z",
];

/// The supershape that points are of, its symmetry numbers found; a superellipsoid where that
/// explains the points as well, each parameter at its price (Schwarz's criterion).
///
/// Points should be of the whole surface: where a half is seen symmetry numbers are right for some
/// 94 of 100, the surface for fewer ([`scans`](crate::scans) has the figures), and
/// [`SearchReport::symmetry_unclear`] tells where no repetition explains the radii and the numbers
/// are a guess. Points that are strewn about the solid may be some 20 %
/// of all. 32 points are needed and 1000 wanted.
///
/// m is found from 2 to 16 (and twice as many where lobes lean), the meridian's m among 2, 3, 4, 5
/// and 6. All six exponents together, and exponents with sizes, trade off: compare surfaces, not
/// parameters.
///
/// # Errors
///
/// Those of [`superellipsoid`](super::superellipsoid()).
///
/// ```
/// use rvachev::fit::{FitSettings, Shape, supershape};
/// use rvachev::surface::ParametricSurface;
/// use rvachev::{Gielis, PointCloud, Supershape};
///
/// let truth = Supershape::new(Gielis::new(5.0, 2.0, 4.0, 4.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
/// let sampled = ParametricSurface::of(&truth)?.sample(800, 1)?;
/// let cloud = PointCloud::new(sampled.iter().map(|s| s.point).collect())?;
/// let fit = supershape(&cloud, &FitSettings::default())?;
/// let Shape::Supershape(leaf) = fit.shape() else { panic!("a superellipsoid") };
/// assert_eq!(leaf.equator().m, 5.0);
/// assert!(fit.deviation().rms < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn supershape(cloud: &PointCloud, settings: &FitSettings) -> Result<Fit, FitError> {
    supershape_with(cloud, settings, &Run::default())
}

/// [`supershape`] with a [`Run`].
///
/// # Errors
///
/// Those of [`supershape`], and [`FitError::Cancelled`].
pub fn supershape_with(cloud: &PointCloud, settings: &FitSettings, run: &Run) -> Result<Fit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    let scaled = Scaled::of(cloud, settings, "supershape", PARAMETERS)?;
    let found = recover_shape(&scaled.points, scaled.normals.as_deref(), settings, &run.stage(0.0, 0.9))?;
    let search = SearchReport {
        starts: found.effort.tried,
        evaluations: found.effort.evaluations,
        one_sided: found.one_sided,
        table: false,
        symmetry_unclear: found.unclear,
    };
    match found.best {
        Best::Quadric(mixture) => finish_quadric(cloud, &scaled, &mixture, None, search, &run),
        Best::Shape(mixture) => {
            let shape = Shape::Supershape(leaf(&mixture.model, scaled.size));
            finish(cloud, &scaled, &mixture, found.weighed, (shape, NAMES), search, &run)
        }
    }
}

/// The leaf in the cloud's length units.
pub(super) fn leaf(model: &Supershaped, size: f64) -> Supershape {
    let curve = |Curve { m, n: [n1, n2, n3] }| Gielis::new(f64::from(m), n1, n2, n3);
    let Supershaped { equator, meridian, semi_axes, .. } = *model;
    Supershape::with(curve(equator), curve(meridian), semi_axes * size, Radius::Standard)
}
