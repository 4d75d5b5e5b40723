//! From points to a tapered, twisted and bent superellipsoid.

use glam::DVec3;

use super::check::check_depth;
use super::deformable::{Deformable, PARAMETERS};
use super::deformations::search;
use super::error::FitError;
use super::mixture::{Mixture, Polish, Weighed};
use super::random::Random;
use super::recover::{Effort, Scene, fit, fit_by};
use super::samples::Samples;
use super::settings::FitSettings;
use super::superquadric::Superquadric;
use crate::Run;

/// What explains the points best, each parameter at its price.
pub(super) enum Straight {
    Quadric(Mixture<Superquadric>),
    Deformed(Mixture<Deformable>),
}

pub(super) struct DeformedRecovered {
    pub(super) best: Straight,
    /// What a deformed one says of the points.
    pub(super) weighed: Option<Weighed<PARAMETERS>>,
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
    // What is deformed is no superellipsoid: there is no use in a long search for one.
    let mut quadric = fit_by(points, &scene, settings.cost, false, &first)?;
    let found = search(&scene.surface, scene.local.rough, &quadric.mixture.model, settings.cost, &second)?;
    let mut effort = quadric.effort;
    effort.evaluations += found.evaluations;
    effort.tried += found.tried;
    let samples = Samples::<f64>::new(points.iter().copied());
    let strewn = quadric.mixture.strewn.min(scene.strewn.max(1e-3)).min(0.9);
    let (noise, area) = (found.noise.max(1e-6), quadric.mixture.log_area());
    let mut mixture = Mixture { model: found.model, noise, strewn, volume: scene.volume, log_area: Some(area) };
    let how = |rounds| Polish { rounds, steps: 3, area: 0.0, all: points.len(), cost: settings.cost };
    effort.evaluations += mixture.polish(&Samples::<f32>::new(points.iter().copied()), how(1)).evaluations;
    let (weighed, last) = mixture.settle(&samples, Polish { steps: 1, ..how(1) });
    effort.evaluations += last;
    let found = mixture.criterion(weighed.residuals.iter().copied());
    let mut is_better = found > quadric.criterion();
    if is_better && mixture.model.is_slight() {
        quadric = fit(points, &scene, settings.cost, &second)?;
        effort.evaluations += quadric.effort.evaluations;
        effort.tried += quadric.effort.tried;
        is_better = found > quadric.criterion();
    }
    let (best, weighed) = if is_better {
        (Straight::Deformed(mixture), Some(weighed))
    } else {
        (Straight::Quadric(quadric.mixture), None)
    };
    Ok(DeformedRecovered { best, weighed, effort, one_sided: quadric.one_sided })
}
