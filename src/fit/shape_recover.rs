//! From points to a supershape: the superellipsoid first, then the search, then the choice.

use glam::DVec3;
use rvachev_num::order;

use super::check::check_depth;
use super::error::FitError;
use super::gielis::{PARAMETERS, Supershaped};
use super::mixture::{Mixture, Polish, Weighed};
use super::random::Random;
use super::recover::{Effort, Scene, fit};
use super::samples::Samples;
use super::settings::FitSettings;
use super::superquadric::Superquadric;
use super::supershapes::ShapeSearch;
use crate::Run;

/// What explains the points best, each parameter at its price.
pub(super) enum Best {
    Quadric(Mixture<Superquadric>),
    Shape(Mixture<Supershaped>),
}

pub(super) struct ShapeRecovered {
    pub(super) best: Best,
    /// What a supershape says of the points.
    pub(super) weighed: Option<Weighed<PARAMETERS>>,
    pub(super) effort: Effort,
    pub(super) one_sided: bool,
    /// Nothing tells the symmetry numbers: they are a guess.
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
    let mut search = ShapeSearch::new(&scene.surface, &scene.local, settings, &second);
    let shapes = search.search(&quadric.mixture.model)?;
    let mut effort = quadric.effort;
    effort.evaluations += search.evaluations;
    effort.tried += search.tried;
    let how = |rounds| Polish { rounds, steps: 3, area: 0.0, all: points.len(), cost: settings.cost };
    let (noise, strewn) = (quadric.mixture.noise, quadric.mixture.strewn);
    let log_area = Some(quadric.mixture.log_area());
    let start = |model| Mixture { model, noise, strewn, volume: scene.volume, log_area };
    let mut ranked: Vec<(f64, Mixture<Supershaped>)> = shapes.best.into_iter().map(|m| (0.0, start(m))).collect();
    // All of them are told apart in single precision, again and again.
    let rough = Samples::<f32>::new(points.iter().copied());
    for (rounds, kept) in [(1, 3), (2, 1)] {
        for (criterion, mixture) in &mut ranked {
            third.check()?;
            let polished = mixture.polish(&rough, how(rounds));
            effort.evaluations += polished.evaluations;
            let found = mixture.criterion_of(&rough, &polished, settings.cost);
            *criterion = if found.is_nan() { f64::NEG_INFINITY } else { found };
        }
        order::falling(&mut ranked, |a| a.0);
        ranked.truncate(kept);
    }
    let samples = Samples::<f64>::new(points.iter().copied());
    let (mut best, mut weighed) = (Best::Quadric(quadric.mixture), None);
    if let Some((_, mut mixture)) = ranked.into_iter().next() {
        third.check()?;
        let (found, last) = mixture.settle(&samples, Polish { steps: 1, ..how(1) });
        effort.evaluations += last;
        // NaN is no better.
        if mixture.criterion(found.residuals.iter().copied()) > quadric.criterion() {
            (best, weighed) = (Best::Shape(mixture), Some(found));
        }
    }
    Ok(ShapeRecovered { best, weighed, effort, one_sided: quadric.one_sided, unclear: shapes.unclear })
}
