//! Questions about many points, rays and boxes, on the threads of a run, which tells how far they
//! are and may be cancelled.

use glam::DVec3;

use super::inside::is_inside;
use super::nearest::nearest;
use super::prepare::PrepareError;
use crate::distance::{compiled_with, surface_with};
use crate::eval::{Compiled, Hit, Owner};
use crate::geom::each;
use crate::{Bounds, Cancelled, Interval, Run, Solid, SolidError};
use rvachev_field::check;

/// So many are asked by a thread before it tells how far it is.
const CHUNK: usize = 16;

/// The questions about one place asked about many: the answers in their order.
///
/// They are asked on all cores. Those that end in `_with` take a [`Run`]: a choice of threads, a
/// cancel token and a progress sink, of compiling the solid too, if it has not been; answers do
/// not depend on it.
impl Solid {
    /// The field at many points, on lanes of `f64`: those of [`value`](Solid::value) to within
    /// rounding.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn values(&self, points: &[DVec3]) -> Result<Vec<f64>, SolidError> {
        never_cancelled(self.values_with(points, &Run::default()))
    }

    /// [`values`](Solid::values) on a [`Run`].
    ///
    /// ```
    /// use rvachev::{Run, Solid};
    /// use glam::DVec3;
    ///
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::X * 3.0];
    /// let values = Solid::sphere(1.0).values_with(&points, &Run { threads: 2, ..Run::default() })?;
    /// assert_eq!(values, [1.0, 0.0, -2.0]);
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn values_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<f64>, PrepareError> {
        self.compiled_and(run, |programs, run| Ok(programs.field.sampled(points.len(), |i| points[i], run)?))
    }

    /// [`contains`](Solid::contains) at many points.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn contains_all(&self, points: &[DVec3]) -> Result<Vec<bool>, SolidError> {
        never_cancelled(self.contains_all_with(points, &Run::default()))
    }

    /// [`contains_all`](Solid::contains_all) on a [`Run`].
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn contains_all_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<bool>, PrepareError> {
        self.compiled_and(run, |programs, run| Ok(asked(points, run, |p| is_inside(programs, *p))?))
    }

    /// [`gradient`](Solid::gradient) at many points.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn gradients(&self, points: &[DVec3]) -> Result<Vec<DVec3>, SolidError> {
        never_cancelled(self.gradients_with(points, &Run::default()))
    }

    /// [`gradients`](Solid::gradients) on a [`Run`].
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn gradients_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<DVec3>, PrepareError> {
        self.compiled_and(run, |programs, run| Ok(asked(points, run, |p| programs.field.gradient(*p).1)?))
    }

    /// [`range`](Solid::range) over many boxes.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn ranges(&self, regions: &[Bounds]) -> Result<Vec<Interval>, SolidError> {
        never_cancelled(self.ranges_with(regions, &Run::default()))
    }

    /// [`ranges`](Solid::ranges) on a [`Run`].
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn ranges_with(&self, regions: &[Bounds], run: &Run) -> Result<Vec<Interval>, PrepareError> {
        self.compiled_and(run, |programs, run| Ok(asked(regions, run, |region| programs.field.range(region))?))
    }

    /// [`owner`](Solid::owner) at many points.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn owners(&self, points: &[DVec3]) -> Result<Vec<Owner>, SolidError> {
        never_cancelled(self.owners_with(points, &Run::default()))
    }

    /// [`owners`](Solid::owners) on a [`Run`].
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn owners_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<Owner>, PrepareError> {
        self.compiled_and(run, |programs, run| Ok(asked(points, run, |p| programs.surface.owner(*p))?))
    }

    /// [`raycast`](Solid::raycast) along many rays, each an origin and a direction.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn raycast_all(&self, rays: &[(DVec3, DVec3)]) -> Result<Vec<Option<Hit>>, SolidError> {
        never_cancelled(self.raycast_all_with(rays, &Run::default()))
    }

    /// [`raycast_all`](Solid::raycast_all) on a [`Run`].
    ///
    /// ```
    /// use rvachev::{Run, Solid};
    /// use glam::DVec3;
    ///
    /// let ball = Solid::sphere(1.0);
    /// let rays: Vec<_> = (0..9).map(|i| (DVec3::new(-5.0, 0.2 * f64::from(i), 0.0), DVec3::X)).collect();
    /// let hits = ball.raycast_all_with(&rays, &Run::default())?;
    /// assert_eq!(hits.iter().flatten().count(), 5);
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn raycast_all_with(&self, rays: &[(DVec3, DVec3)], run: &Run) -> Result<Vec<Option<Hit>>, PrepareError> {
        self.compiled_and(run, |_, run| {
            let is_ray = |(origin, way): &(DVec3, DVec3)| origin.is_finite() && way.is_finite() && *way != DVec3::ZERO;
            for (number, (origin, direction)) in rays.iter().enumerate().filter(|(_, ray)| !is_ray(ray)) {
                let (origin_of, direction_of) = (format!("ray {number}: origin"), format!("ray {number}: direction"));
                check::point(&origin_of, *origin).map_err(SolidError::Argument)?;
                check::direction(&direction_of, *direction).map_err(SolidError::Argument)?;
            }
            let hits = asked(rays, run, |(origin, direction)| self.raycast(*origin, *direction))?;
            Ok(hits.into_iter().collect::<Result<_, _>>()?)
        })
    }

    /// [`closest_surface_point`](Solid::closest_surface_point) to many points.
    ///
    /// # Errors
    /// What is wrong with the solid; [`SolidError::Unbounded`] if it has no finite box.
    pub fn closest_surface_points(&self, points: &[DVec3]) -> Result<Vec<Option<DVec3>>, SolidError> {
        never_cancelled(self.closest_surface_points_with(points, &Run::default()))
    }

    /// [`closest_surface_points`](Solid::closest_surface_points) on a [`Run`]. The surface that
    /// they are looked for on is measured by this run as well, where it is needed, and kept.
    ///
    /// ```
    /// use rvachev::{Run, Solid, rad};
    /// use glam::DVec3;
    ///
    /// let bar = Solid::cuboid([1.0, 1.0, 4.0]).twist(rad(0.3));
    /// let points = [DVec3::new(3.0, 0.0, 0.0), DVec3::ZERO];
    /// let near = bar.closest_surface_points_with(&points, &Run::default())?;
    /// let distance = near[1].expect("it has a surface").length();
    /// assert!((distance - 0.5).abs() < 1e-3, "{distance}");
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, with [`SolidError::Unbounded`] if it has no finite box, or
    /// that the work was cancelled.
    pub fn closest_surface_points_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<Option<DVec3>>, PrepareError> {
        self.compiled_and(run, |programs, run| {
            let is_empty = self.finite_bounds()?.is_empty();
            for (number, p) in points.iter().enumerate().filter(|(_, p)| !p.is_finite()) {
                check::point(&format!("point {number}: p"), *p).map_err(SolidError::Argument)?;
            }
            if is_empty {
                return Ok(vec![None; points.len()]);
            }
            // Where the value is the distance the point is told at once.
            let [to_tell, to_measure, to_ask] = run.stages(match programs.exact_sides() {
                2 => [0.9, 0.05, 0.05],
                1 => [0.3, 0.4, 0.3],
                _ => [0.02, 0.58, 0.4],
            });
            let mut near = asked(points, &to_tell, |p| programs.foot(*p))?;
            let is_left = |(_, found): &(&DVec3, &mut Option<DVec3>)| found.is_none();
            let mut left: Vec<_> = points.iter().zip(&mut near).filter(is_left).collect();
            if !left.is_empty() {
                let surface = surface_with(self, &to_measure)?;
                let of: Vec<DVec3> = left.iter().map(|(p, _)| **p).collect();
                let found = asked(&of, &to_ask, |p| nearest(&programs.surface, &surface.patches, *p))?;
                for ((_, near), found) in left.iter_mut().zip(found) {
                    **near = found;
                }
            }
            Ok(near)
        })
    }

    /// What `ask` answers on the threads of a run, once the solid is compiled.
    fn compiled_and<T: Send>(
        &self,
        run: &Run,
        ask: impl FnOnce(&Compiled, &Run) -> Result<T, PrepareError> + Send,
    ) -> Result<T, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_ask] = run.stages([0.1, 0.9]);
        let answers = run.install(|| {
            let programs = compiled_with(self, &to_compile)?;
            ask(&programs, &to_ask)
        })?;
        run.report(1.0);
        Ok(answers)
    }
}

/// What a run that nobody cancels has found.
pub(super) fn never_cancelled<T>(found: Result<T, PrepareError>) -> Result<T, SolidError> {
    found.map_err(|error| match error {
        PrepareError::Solid(error) => error,
        PrepareError::Cancelled(_) => unreachable!("nobody has the token"),
    })
}

/// What is said of each, in their order.
fn asked<T: Sync, R: Send>(of: &[T], run: &Run, ask: impl Fn(&T) -> R + Sync) -> Result<Vec<R>, Cancelled> {
    each(of.len(), CHUNK, run, |i| ask(&of[i]))
}
