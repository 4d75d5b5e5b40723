//! From points to a tapered, twisted and bent superellipsoid.

use glam::DVec3;

use super::check::check_depth;
use super::deformable::{Deformable, PARAMETERS};
use super::deformations::search;
use super::error::FitError;
use super::mixture::{Mixture, Polish};
use super::random::Random;
use super::recover::{Effort, Scene, fit};
use super::samples::Samples;
use super::settings::FitSettings;
use super::superquadric::{self, Superquadric};
use crate::Run;

/// What explains the points best, each parameter at its price.
pub(super) enum Straight {
    Quadric(Mixture<Superquadric>),
    Deformed(Mixture<Deformable>),
}

pub(super) struct DeformedRecovered {
    pub(super) best: Straight,
    pub(super) effort: Effort,
    pub(super) one_sided: bool,
}

pub(super) fn recover_deformed(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    settings: &FitSettings,
    run: &Run,
) -> Result<DeformedRecovered, FitError> {
    let mut random = Random::new(settings.seed);
    let scene = Scene::of(points, normals, &mut random);
    check_depth(&scene.surface)?;
    let [first, second] = run.stages([1.0, 2.0]);
    let quadric = fit(points, &scene, settings.cost, &first)?;
    let found = search(&scene.surface, scene.local.rough, &quadric.mixture.model, settings.cost, &second)?;
    let mut effort = quadric.effort;
    effort.evaluations += found.evaluations;
    effort.tried += found.tried;
    let samples = Samples::<f64>::new(points.iter().copied());
    let strewn = quadric.mixture.strewn.min(scene.strewn.max(1e-3)).min(0.9);
    let (noise, area) = (found.noise.max(1e-6), quadric.mixture.log_area());
    let mut mixture = Mixture { model: found.model, noise, strewn, volume: scene.volume, log_area: Some(area) };
    effort.evaluations += mixture.polish(&samples, Polish { rounds: 3, steps: 3, area: 0.0, cost: settings.cost });
    let price = |parameters: usize| 0.5 * parameters as f64 * (points.len() as f64).ln();
    let straight = quadric.mixture.log_likelihood(&samples) - price(superquadric::PARAMETERS);
    let deformed = mixture.log_likelihood(&samples) - price(PARAMETERS);
    let best = if deformed > straight { Straight::Deformed(mixture) } else { Straight::Quadric(quadric.mixture) };
    Ok(DeformedRecovered { best, effort, one_sided: quadric.one_sided })
}
