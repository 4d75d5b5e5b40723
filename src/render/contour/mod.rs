//! Contours of slices: closed, oriented, on the surface, as complete as ranges can tell.
//!
//! A plane is divided into squares (`tree`), each with the program of what matters there, as far as
//! the contour is not told by the signs at their corners. From square to square the pieces of
//! contours are joined, and refined until chords deviate by less than the tolerance (`chain`).
//! Planes of a stack are divided together while squares are larger than what is between the planes.
//!
//! What lies beyond the region counts as outside, so that every contour is closed.

mod chain;
mod section;
mod spread;
mod square;
mod tree;

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec2, DVec3};
use rvachev_num::{Meter, jobs, order};

use self::chain::Chains;
pub use self::section::Side;
pub(super) use self::section::aside;
use self::section::{Filling, Section};
use self::square::Root;
use self::tree::Tree;
use super::settings::{RenderError, setting};
use super::slice::{Slice, seen};
use crate::distance::compiled_with;
use crate::eval::Program;
use crate::geom::Contours;
use crate::{COORDINATE_LIMIT, Cancelled, Plane, PlaneBounds, Run, Solid};

/// How far the first square goes beyond the region. Corners of squares keep off the round
/// coordinates that faces are fond of.
const MARGIN: f64 = 0.013;
const ASIDE: f64 = 0.4876;

/// The finest tolerance, in longer sides of the region.
const FINEST: f64 = 1e-8;

/// What contours shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct ContourSettings {
    /// How far contours may deviate from the surface, in length units, above 0. One below 10⁻⁸ of
    /// the longer side of the region counts as that. Default: 0.001.
    pub tolerance: f64,
    /// What counts where a face of the solid lies in the plane. Default: [`Side::Above`].
    pub side: Side,
}

impl Default for ContourSettings {
    fn default() -> ContourSettings {
        ContourSettings { tolerance: 1e-3, side: Side::default() }
    }
}

impl Slice {
    /// The contours of the solid on the plane: closed polylines with the inside to the left, so
    /// that outlines run anticlockwise and holes clockwise. Points are on the surface to within
    /// rounding; in between, and at corners, contours deviate by no more than about `tolerance`.
    ///
    /// Where the solid goes on beyond the region, its contour follows the region's border. Where a
    /// face lies in the plane, what is just above it counts (on the side that the plane's normal
    /// points to); [`contours_with`](Slice::contours_with) can choose. Parts that touch each other
    /// have one contour about them.
    ///
    /// Nothing that is wider than the tolerance is missed, and what is narrower is told
    /// ([`Contours::unresolved`]). Of lengths (offsets, shells, fillets) that is so as far as their
    /// [accuracy](Solid::accuracy) tells. Where ranges tell nothing (leaves at their pinched points,
    /// some users' fields, fillets where they run out into a face that lies along the plane, jumps of
    /// chamfers) squares of a 256th to a 4096th of the region are looked at by samples; each of them
    /// counts as unresolved.
    /// Of a solid with measured lengths the plane is a 2⁻¹⁸th of the region's size aside of where it
    /// is asked for, else a 2⁻³⁷th.
    ///
    /// # Errors
    /// If the tolerance is not above 0.
    pub fn contours(&self, tolerance: f64) -> Result<Contours, RenderError> {
        self.contours_with(&ContourSettings { tolerance, ..ContourSettings::default() }, &Run::default())
    }

    /// [`contours`](Slice::contours) with a choice of sides, threads, a cancel token and a progress
    /// sink.
    ///
    /// # Errors
    /// If a setting is out of its range, or the work was cancelled.
    pub fn contours_with(&self, settings: &ContourSettings, run: &Run) -> Result<Contours, RenderError> {
        let run = run.stage(0.0, 1.0);
        let mut stack = stack(&self.surface, &self.plane, &[0.0], self.region, settings, &run)?;
        run.report(1.0);
        Ok(stack.pop().unwrap_or_default())
    }
}

impl Solid {
    /// The contours of the solid on planes of many heights z, in their order, as a printer or a
    /// laser wants them. Planes that are near each other share the work. Turn the solid first to
    /// cut it along another axis.
    ///
    /// ```
    /// use rvachev::{ContourSettings, Run, Solid};
    ///
    /// let cone = Solid::cone(2.0, 0.0, 4.0);
    /// let heights: Vec<f64> = (0..20).map(|layer| -1.9 + 0.2 * f64::from(layer)).collect();
    /// let layers = cone.slices(&heights, &ContourSettings::default(), &Run::default())?;
    /// assert_eq!(layers.len(), 20);
    /// let volume: f64 = layers.iter().map(|layer| 0.2 * layer.area()).sum();
    /// assert!((volume - 16.755).abs() < 0.05);
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, a setting or a height, or that the work was cancelled; an
    /// unbounded solid is to be cut to a box first.
    pub fn slices(&self, heights: &[f64], settings: &ContourSettings, run: &Run) -> Result<Vec<Contours>, RenderError> {
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_slice] = run.stages([0.1, 0.9]);
        if let Some(height) = heights.iter().find(|height| !height.is_finite()) {
            return Err(setting("heights", height, "finite"));
        }
        run.check()?;
        let programs = compiled_with(self, &to_compile)?;
        if heights.is_empty() {
            return Ok(Vec::new());
        }
        let bounds = self.finite_bounds()?;
        // Nothing is far from the solid, and rounding is in proportion to how far planes are.
        let near = bounds.inflate(bounds.longest_side());
        let is_near = |height: f64| (near.min.z..=near.max.z).contains(&height);
        let mut order: Vec<usize> = (0..heights.len()).filter(|number| is_near(heights[*number])).collect();
        order::rising(&mut order, |a| heights[*a]);
        let mut contours = vec![Contours::default(); heights.len()];
        let Some(low) = order.first().map(|first| heights[*first]) else {
            run.report(1.0);
            return Ok(contours);
        };
        let region = seen(&bounds, &Plane::xy(low));
        let sorted: Vec<f64> = order.iter().map(|number| heights[*number] - low).collect();
        let found = stack(&programs.surface, &Plane::xy(low), &sorted, region, settings, &to_slice)?;
        for (number, own) in order.into_iter().zip(found) {
            contours[number] = own;
        }
        run.report(1.0);
        Ok(contours)
    }
}

/// The contours on planes at heights, in order, above a plane.
fn stack(
    program: &Program,
    plane: &Plane,
    heights: &[f64],
    region: PlaneBounds,
    settings: &ContourSettings,
    run: &Run,
) -> Result<Vec<Contours>, RenderError> {
    let tolerance = settings.tolerance;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(setting("tolerance", tolerance, "finite and above 0"));
    }
    // Nothing is beyond the coordinate limit.
    let (middle, reach) = (plane.coordinates(DVec3::ZERO), 2.0 * COORDINATE_LIMIT);
    let region = PlaneBounds { min: region.min.max(middle - reach), max: region.max.min(middle + reach) };
    let is_near = plane.origin().dot(plane.normal()).abs() < reach;
    if !(is_near && region.min.cmplt(region.max).all()) {
        return Ok(vec![Contours::default(); heights.len()]);
    }
    let size = (region.max - region.min).max_element();
    let tolerance = tolerance.max(FINEST * size);
    let root = Root { low: region.min - DVec2::splat(MARGIN * ASIDE * size), side: (1.0 + MARGIN) * size };
    let sections = Section::stack(program, plane, heights, &ContourSettings { tolerance, ..*settings }, region);
    let [to_divide, to_join] = run.stages([0.7, 0.3]);
    let whole = Filling::Program(program.clone());
    let made: Result<Vec<Contours>, Cancelled> = run.install(|| {
        let found = Tree { sections: &sections, heights, root, finest: FRAC_1_SQRT_2 * tolerance, run: &to_divide }
            .found(program)?;
        let joined = Meter::new(&to_join, heights.len());
        let contours = |(section, found)| {
            let chains = Chains { section, root: &root, found, whole: &whole, tolerance };
            let (lines, unresolved) = chains.contours(&to_join)?;
            joined.add(1);
            Ok(Contours::new(lines, unresolved))
        };
        jobs::try_in_order(sections.len(), |n| contours((&sections[n], &found[n])))
    });
    Ok(made?)
}
