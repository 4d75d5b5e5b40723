//! Measuring before the first question: `solid.prepare(..)`, and how exact it was.

use crate::distance::{compiled, compiled_with};
use crate::eval::CompileError;
use crate::{Accuracy, Cancelled, Run, Solid, SolidError};

/// Why a solid is not prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// The solid is at fault.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<CompileError> for PrepareError {
    fn from(error: CompileError) -> PrepareError {
        match error {
            CompileError::Solid(error) => error.into(),
            CompileError::Cancelled(cancelled) => cancelled.into(),
        }
    }
}

impl Solid {
    /// How far the solid's surface may be off what its offsets, shells, roundings, fillets and
    /// chamfers ask for, in length units. Both numbers are 0 if nothing had to be measured: if all
    /// of it is closed form.
    ///
    /// It is that of the least exact part. [`with_tolerance`](Solid::with_tolerance) sets the
    /// tolerance of an operation. The solid is compiled on first use, which may take long where
    /// there is much to measure: see [`prepare`](Solid::prepare).
    ///
    /// ```
    /// use rvachev::{Accuracy, Solid, rad};
    ///
    /// let closed = Solid::cuboid([2.0, 2.0, 4.0]).offset(0.5);
    /// assert_eq!(closed.accuracy()?, Accuracy::default());
    ///
    /// // No closed form is known of the distance to a twisted bar.
    /// let measured = Solid::cuboid([2.0, 2.0, 4.0]).twist(rad(0.25)).offset(0.5);
    /// assert_eq!(measured.accuracy()?.tolerance, 2f64.powi(-11));
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    ///
    /// # Details
    ///
    /// Affine maps above an operation are counted by their largest stretch. Deformations above it
    /// are not: the numbers are then in the units of the solid before it was deformed. Operands
    /// without end, such as lattices, are measured piece by piece where they are asked for: their
    /// tolerance is known before, their error is not, and is told as 0.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn accuracy(&self) -> Result<Accuracy, SolidError> {
        Ok(compiled(self)?.accuracy)
    }

    /// Compiles the solid and measures the surfaces that its offsets, shells, roundings, fillets
    /// and chamfers need, and tells how exact they are: [`accuracy`](Solid::accuracy). Everything
    /// is kept with the solid and its clones: queries, meshes and pictures find it there, and a
    /// second call costs nothing. A surface that was measured serves all lengths of about its size,
    /// of equal operands too, as long as one of these operands is there.
    ///
    /// Whoever does not call this pays when the solid is first used. What is called here is the
    /// threads, the cancel token and the progress sink of that work. If it is cancelled, what was
    /// measured so far is kept, and the solid may be used, or prepared, again.
    ///
    /// Two things are still made on first use: the pieces of operands without end, and the surface
    /// that [`closest_surface_point`](Solid::closest_surface_point) looks on, which
    /// [`closest_surface_points_with`](Solid::closest_surface_points_with) measures on a run.
    ///
    /// ```
    /// use rvachev::{Progress, Run, Solid, rad};
    ///
    /// let part = Solid::cuboid([2.0, 2.0, 4.0]).twist(rad(0.25)).shell(0.25);
    /// let progress = Progress::new(|fraction| println!("{:.0} %", 100.0 * fraction));
    /// let accuracy = part.prepare(&Run { progress: Some(progress), ..Run::default() })?;
    /// assert_eq!(accuracy.tolerance, 2f64.powi(-12));
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled: see [`PrepareError`].
    pub fn prepare(&self, run: &Run) -> Result<Accuracy, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let programs = compiled_with(self, &run)?;
        run.report(1.0);
        Ok(programs.accuracy)
    }
}
