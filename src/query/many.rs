//! Questions about many rays and points on the threads of a run, which tells how far they are and
//! may be cancelled.

use glam::DVec3;
use rayon::prelude::*;
use rvachev_num::Meter;

use super::prepare::PrepareError;
use crate::distance::{compiled_with, surface_with};
use crate::eval::Hit;
use crate::{Cancelled, Run, Solid};

/// So many are asked between looks at the cancel token.
const CHUNK: usize = 16;

impl Solid {
    /// [`raycast`](Solid::raycast) along many rays, each an origin and a direction: the answers in
    /// their order.
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
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_ask] = run.stages([0.3, 0.7]);
        compiled_with(self, &to_compile)?;
        let hits = asked(rays, &to_ask, |(origin, direction)| self.raycast(*origin, *direction))?;
        let hits = hits.into_iter().collect::<Result<_, _>>()?;
        run.report(1.0);
        Ok(hits)
    }

    /// [`closest_surface_point`](Solid::closest_surface_point) to many points: the answers in their
    /// order. The surface that they are looked for on is measured by this run as well, where it is
    /// needed, and kept.
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
    /// What is wrong with the solid, with [`SolidError::Unbounded`](crate::SolidError::Unbounded)
    /// if it has no finite box, or that the work was cancelled.
    pub fn closest_surface_points_with(&self, points: &[DVec3], run: &Run) -> Result<Vec<Option<DVec3>>, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let [to_measure, to_ask] = run.stages([0.6, 0.4]);
        let programs = compiled_with(self, &to_measure)?;
        let is_empty = self.finite_bounds()?.is_empty();
        let is_told = |p: &DVec3| is_empty || !p.is_finite() || programs.foot(*p).is_some();
        if !points.iter().all(is_told) {
            surface_with(self, &to_measure)?;
        }
        let near = asked(points, &to_ask, |p| self.closest_surface_point(*p))?;
        let near = near.into_iter().collect::<Result<_, _>>()?;
        run.report(1.0);
        Ok(near)
    }
}

/// What is said of each, in their order.
fn asked<T: Sync, R: Send>(of: &[T], run: &Run, ask: impl Fn(&T) -> R + Sync) -> Result<Vec<R>, Cancelled> {
    let meter = Meter::new(run, of.len());
    let chunk = |chunk: &[T]| {
        run.check()?;
        let answers: Vec<R> = chunk.iter().map(&ask).collect();
        meter.add(chunk.len() as u64);
        Ok(answers)
    };
    let all = run.install(|| of.par_chunks(CHUNK).map(chunk).collect::<Result<Vec<Vec<R>>, Cancelled>>())?;
    Ok(all.into_iter().flatten().collect())
}
