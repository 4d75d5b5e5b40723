//! From points to a supershape: the superellipsoid first, then the search, then the choice.

use glam::DVec3;

use super::check::check_depth;
use super::error::FitError;
use super::gielis::Supershaped;
use super::mixture::{Mixture, Polish};
use super::random::Random;
use super::recover::{Effort, Scene, fit};
use super::samples::Samples;
use super::settings::FitSettings;
use super::superquadric::{self, Superquadric};
use super::supershapes::ShapeSearch;
use crate::Run;

/// What explains the points best, each parameter at its price.
pub(super) enum Best {
    Quadric(Mixture<Superquadric>),
    Shape(Mixture<Supershaped>),
}

pub(super) struct ShapeRecovered {
    pub(super) best: Best,
    pub(super) effort: Effort,
    pub(super) one_sided: bool,
    /// No axis' harmonics explain half of the radii: symmetry numbers are a guess.
    pub(super) unclear: bool,
}

pub(super) fn recover_shape(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    settings: &FitSettings,
    run: &Run,
) -> Result<ShapeRecovered, FitError> {
    let mut random = Random::new(settings.seed);
    let scene = Scene::of(points, normals, &mut random);
    check_depth(&scene.surface)?;
    let [first, second, third] = run.stages([1.0, 6.0, 3.0]);
    let quadric = fit(points, &scene, settings.cost, &first)?;
    let mut search = ShapeSearch::new(&scene.surface, &scene.local, settings.cost, settings.start, &second);
    let shapes = search.search(&quadric.mixture.model)?;
    let samples = Samples::<f64>::new(points.iter().copied());
    let mut effort = quadric.effort;
    effort.evaluations += search.evaluations;
    effort.tried += search.tried;
    let area = quadric.mixture.log_area();
    let price = |parameters: usize| 0.5 * parameters as f64 * (points.len() as f64).ln();
    let mut score = quadric.mixture.log_likelihood(&samples) - price(superquadric::PARAMETERS);
    let mut best = Best::Quadric(quadric.mixture);
    let how = |rounds| Polish { rounds, steps: 3, area: 0.0, cost: settings.cost };
    let (noise, strewn) = (quadric.mixture.noise, quadric.mixture.strewn);
    let mut ranked = Vec::new();
    for model in shapes.best {
        third.check()?;
        let mut mixture = Mixture { model, noise, strewn, volume: scene.volume, log_area: Some(area) };
        effort.evaluations += mixture.polish(&samples, how(1));
        ranked.push((mixture.log_likelihood(&samples) - price(model.ties.parameters()), mixture));
    }
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, mut mixture) in ranked.into_iter().take(3) {
        third.check()?;
        effort.evaluations += mixture.polish(&samples, how(3));
        let found = mixture.log_likelihood(&samples) - price(mixture.model.ties.parameters());
        // NaN is no better.
        if found > score {
            score = found;
            best = Best::Shape(mixture);
        }
    }
    Ok(ShapeRecovered { best, effort, one_sided: quadric.one_sided, unclear: shapes.explained < 0.5 })
}
