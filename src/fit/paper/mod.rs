//! A union of truncated supershapes with holes, from a segmented surface: the pipeline of the
//! paper on rational supershapes.
//!
//! ```text
//!     segments → a supershape each → truncated by their boxes: fⱼ = F2ⱼ ∧ Bⱼ → united: F = ∨ fⱼ
//!       → points inside by more than the noise → clusters → a supershape each, subtracted
//!       → all parameters refined on  E = Σ (∨ⱼ √(a₁a₂a₃)ⱼ fⱼ(Pᵢ))²
//! ```
//!
//! What is added to the paper, since it does not come out otherwise: fits of single supershapes are
//! robust, so that the walls of holes do not draw the body in; where a segment ends at another one,
//! its supershape and its box are made longer, or bodies would touch only; holes are longer than
//! their points where these come to the skin, and truncated by a box as well; the joint refinement,
//! which the paper leaves for later.
//!
//! Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*.

mod holes;
mod lengthen;
mod neighbours;
mod oriented_box;
mod refine;
mod result;
mod sampling;
mod scene;
mod segment;
mod segments;
mod settings;
mod truncated;
mod watershed;
mod whole;

use self::holes::{Depth, drill, negative};
use self::refine::refined;
use self::scene::Scene;
use self::segment::{Found, supershape_of};
use self::truncated::Truncated;
pub(super) use self::truncated::{both, either};
use self::whole::{Part, Whole};
use super::deviations::Deviation;
use super::error::FitError;
use crate::Run;
use rvachev_num::jobs;

pub use self::result::{ErrorOfFit, TruncatedSupershape, UnionFit, UnionPart};
pub use self::segments::Segments;
pub use self::settings::UnionSettings;

/// How often points that face the inside are left out of a segment's fit.
const TURNS: usize = 2;

/// Unless they are nearly none or nearly all of it: this share.
const FACING: f64 = 0.02;

/// The union of truncated supershapes, with holes, that a segmented surface is of.
///
/// A supershape is fitted to each segment, with its symmetry numbers where the radii repeat about
/// an axis, and m = M = 4 where they do not. It is truncated by the oriented box of its points. A
/// segment whose points face inwards, or without normals are inside of another body, is a hole and
/// not a body. Points that are inside of a body by more than the noise are clustered; each cluster
/// is fitted as a segment is and subtracted, if that halves the error of its points. In the end all
/// parameters of all supershapes are refined together, but lengths that no point tells.
///
/// Strewn points should be taken off before: the [global error](ErrorOfFit) that is refined is a
/// sum of squares, as it was published. Each segment needs 60 points or so and wants some hundreds.
/// The same seed gives the same bits on any number of threads.
///
/// How good it is: [the module](crate::fit#unions-of-supershapes).
///
/// # Errors
///
/// [`FitError::Segment`] names a segment that has too few points or is flat; those of
/// [`supershape`](super::supershape()) of the whole; [`FitError::Setting`].
///
/// ```
/// use rvachev::fit::{Segments, UnionSettings, supershape_union};
/// use rvachev::{CellSize, MeshSettings, Solid, deg};
///
/// let pin = Solid::cylinder(0.5, 2.0).translate([0.0, 0.0, 1.0]);
/// let part = Solid::cuboid([3.0, 2.0, 1.0]) | pin;
/// let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() })?;
/// let segments = Segments::of_mesh_by_creases(&mesh, deg(40.0))?;
/// let fit = supershape_union(&segments, &UnionSettings::default())?;
/// assert_eq!((fit.parts().len(), fit.holes()), (2, 0));
/// assert!(fit.error().refined <= fit.error().bodies);
/// assert!(fit.solid().contains([0.0, 0.0, 1.9])? && !fit.solid().contains([0.6, 0.0, 1.0])?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn supershape_union(segments: &Segments, settings: &UnionSettings) -> Result<UnionFit, FitError> {
    supershape_union_with(segments, settings, &Run::default())
}

/// [`supershape_union`] with a [`Run`].
///
/// # Errors
///
/// Those of [`supershape_union`], and [`FitError::Cancelled`].
pub fn supershape_union_with(segments: &Segments, settings: &UnionSettings, run: &Run) -> Result<UnionFit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    settings.check()?;
    run.install(|| fitted(segments, settings, &run))
}

fn fitted(segments: &Segments, settings: &UnionSettings, run: &Run) -> Result<UnionFit, FitError> {
    let [before, first, second, third] = run.stages([0.2, 5.0, 2.0, 3.0]);
    let scene = Scene::of(segments, &settings.fit, &before)?;
    let names = segments.names();
    let of = |name: &u32| (0..scene.points.len()).filter(|i| scene.labels[*i] == *name).collect();
    let mut members: Vec<Vec<usize>> = names.iter().map(of).collect();
    let mut found = single_fits(&scene, &names, &members, settings, &first)?;
    let body = |(k, (of, found)): (usize, (&Vec<usize>, &Found))| Part {
        label: names[k],
        body: scene.body(of, found),
        holes: Vec::new(),
    };
    let mut parts: Vec<Part> = members.iter().zip(&found).enumerate().map(body).collect();
    let depth = |(part, found): (&Part, &Found)| Depth::of(&part.body, found.noise, settings.depth);
    let depths: Vec<Depth> = parts.iter().zip(&found).map(depth).collect();
    let is_hole = negative(&scene, &parts, &members, &depths, &first)?;
    let mut evaluations = found.iter().map(|found| found.evaluations).sum();
    keep(&mut parts, &is_hole);
    keep(&mut found, &is_hole);
    keep(&mut members, &is_hole);
    let mut whole = Whole { parts };
    let mut error = ErrorOfFit { bodies: whole.error(&scene.points, &second)?, ..ErrorOfFit::default() };
    for at in 0..whole.parts.len() {
        if settings.holes {
            let depth = Depth::of(&whole.parts[at].body, found[at].noise, settings.depth);
            evaluations += drill(&scene, &mut whole, at, &depth, &settings.fit, &second)?;
        }
        second.report((at + 1) as f64 / whole.parts.len() as f64);
    }
    error.holes = whole.error(&scene.points, &third)?;
    let refined = refined(whole, &scene.points, settings.refinement, &third)?;
    error.refined = refined.error;
    let fit = told(&scene, &found, refined.whole, error, [evaluations, refined.steps]);
    fit.solid().bounds()?;
    run.report(1.0);
    Ok(fit)
}

/// Those that are no holes.
fn keep<T>(all: &mut Vec<T>, is_hole: &[bool]) {
    let mut at = 0;
    all.retain(|_| {
        at += 1;
        !is_hole[at - 1]
    });
}

fn single_fits(
    scene: &Scene,
    names: &[u32],
    members: &[Vec<usize>],
    settings: &UnionSettings,
    run: &Run,
) -> Result<Vec<Found>, FitError> {
    // Single fits report for themselves, several at a time.
    let quiet = Run { progress: None, ..run.clone() };
    let fit = |(name, of): (&u32, &Vec<usize>)| {
        quiet.check()?;
        body_of(scene, of, settings, &quiet).map_err(|error| match error {
            FitError::Cancelled(_) => error,
            error => FitError::Segment { label: *name, source: Box::new(error) },
        })
    };
    let found = jobs::in_order(names.len(), |n| fit((&names[n], &members[n])));
    run.report(1.0);
    // The first error by the order of labels, not of threads.
    found.into_iter().collect()
}

/// The supershape of a segment. Where normals tell that some of its points are of walls of holes,
/// as they face the inside, it is that of the others.
fn body_of(scene: &Scene, of: &[usize], settings: &UnionSettings, run: &Run) -> Result<Found, FitError> {
    let fit = |of: &[usize]| supershape_of(&scene.points_of(of), scene.normals_of(of).as_deref(), &settings.fit, run);
    let mut found = fit(of)?;
    let Some(normals) = &scene.normals else { return Ok(found) };
    for _ in 0..TURNS {
        let is_outside = |i: &usize| found.shape.outwards(scene.points[*i]).dot(normals[*i]) > 0.0;
        let outside: Vec<usize> = of.iter().copied().filter(is_outside).collect();
        let share = outside.len() as f64 / of.len() as f64;
        if !(FACING..1.0 - FACING).contains(&share) {
            break;
        }
        let Ok(again) = fit(&outside) else { break };
        let evaluations = found.evaluations + again.evaluations;
        found = Found { evaluations, ..again };
    }
    Ok(found)
}

/// In the points' length units.
fn told(scene: &Scene, found: &[Found], whole: Whole, error: ErrorOfFit, [evaluations, steps]: [usize; 2]) -> UnionFit {
    let (center, size) = (scene.center, scene.size);
    let placed = |member: &Truncated| TruncatedSupershape::of(member, center, size);
    let part = |(part, found): (&Part, &Found)| UnionPart {
        label: part.label,
        body: placed(&part.body),
        holes: part.holes.iter().map(placed).collect(),
        noise: found.noise * size,
        symmetry_unclear: found.is_unclear,
    };
    let cubed = |error: f64| error * size.powi(3);
    let depths = scene.points.iter().map(|p| whole.depth(*p) * size);
    UnionFit {
        parts: whole.parts.iter().zip(found).map(part).collect(),
        error: ErrorOfFit { bodies: cubed(error.bodies), holes: cubed(error.holes), refined: cubed(error.refined) },
        deviation: Deviation::of(depths),
        parameters: whole.members().map(Truncated::parameters).sum(),
        evaluations,
        refinement: steps,
        whole,
        center,
        size,
    }
}
