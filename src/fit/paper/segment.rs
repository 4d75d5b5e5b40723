//! One supershape a segment: the fit of a single shape, placed among the others.

use glam::DVec3;

use crate::Run;
use crate::fit::cloud::Scaled;
use crate::fit::error::FitError;
use crate::fit::gielis::{self, Curve, Supershaped, Ties};
use crate::fit::mixture::Mixture;
use crate::fit::random::Random;
use crate::fit::recover::{Scene, fit};
use crate::fit::samples::Samples;
use crate::fit::settings::FitSettings;
use crate::fit::shape_recover::{Best, recover_shape};
use crate::fit::solve::{Fitted, Problem, Robust};
use crate::fit::superquadric::Superquadric;
use crate::geom::PointCloud;

/// A supershape of a segment.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) shape: Supershaped,
    /// The standard deviation of the points that fit.
    pub(super) noise: f64,
    /// No axis was found that radii repeat about: m = M = 4.
    pub(super) is_unclear: bool,
    pub(super) evaluations: usize,
}

/// The supershape that points are of, most of them.
pub(super) fn supershape_of(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    settings: &FitSettings,
    run: &Run,
) -> Result<Found, FitError> {
    // Points are in the frame of the whole: finite, and of a size near 1.
    let cloud = PointCloud::new(points.to_vec()).unwrap_or_default();
    let cloud = match normals {
        Some(normals) => cloud.with_normals(normals.iter().map(|n| n.as_vec3()).collect()).unwrap_or_default(),
        None => cloud,
    };
    let scaled = Scaled::of(&cloud, settings, "supershape", gielis::PARAMETERS)?;
    let own = scaled.normals.as_deref();
    let found = recover_shape(&scaled.points, own, settings, run)?;
    let (shape, noise) = match found.best {
        Best::Shape(_) if found.unclear => {
            let mut random = Random::new(settings.seed);
            let scene = Scene::of(&scaled.points, own, &mut random);
            let quadric = fit(&scaled.points, &scene, settings.cost, run)?;
            (as_supershape(&quadric.mixture), quadric.mixture.noise)
        }
        Best::Shape(mixture) => (mixture.model, mixture.noise),
        Best::Quadric(mixture) => (as_supershape(&mixture), mixture.noise),
    };
    let shape = Supershaped {
        semi_axes: shape.semi_axes * scaled.size,
        center: scaled.center + shape.center * scaled.size,
        ..shape
    };
    let noise = noise * scaled.size;
    Ok(Found { shape, noise, is_unclear: found.unclear, evaluations: found.effort.evaluations })
}

/// A superellipsoid is a supershape of m = M = 4.
fn as_supershape(mixture: &Mixture<Superquadric>) -> Supershaped {
    let Superquadric { e: [e1, e2], semi_axes, rotation, center } = mixture.model;
    let curve = |e: f64| Curve { m: 4, n: [2.0 / e; 3] };
    let (equator, meridian) = (curve(e2), curve(e1));
    Supershaped { equator, meridian, semi_axes, rotation, center, ties: Ties::Stretched, rational: false }
}

/// Points that a shape is compared by with others.
pub(super) struct Judge {
    samples: Samples<f64>,
    /// Deviations are told apart in these units.
    width: f64,
}

impl Judge {
    /// Of points, with the deviation that is nothing.
    pub(super) fn new(points: &[DVec3], width: f64) -> Judge {
        Judge { samples: Samples::new(points.iter().copied()), width }
    }

    /// The mean of d²/(d² + width²): 0 where all points fit, 1 where none does.
    pub(super) fn residual(&self, shape: Supershaped) -> f64 {
        let fitted = Fitted::new(shape, &self.samples, crate::fit::Cost::Normal);
        let share = |d: &f64| {
            let square = (d / self.width).powi(2);
            if square.is_finite() { square / (1.0 + square) } else { 1.0 }
        };
        fitted.residuals[..self.samples.len()].iter().map(share).sum::<f64>() / self.samples.len().max(1) as f64
    }

    /// The shape after some steps of a robust descent.
    pub(super) fn settled(&self, shape: Supershaped) -> Supershaped {
        let problem = Problem { samples: &self.samples, cost: crate::fit::Cost::Normal };
        problem.robust(shape, Robust { rounds: 2, steps: 4, width: 2.5, area: 0.0, gain: 1e-3 }).model
    }
}
