//! Questions about points of the plane.

use glam::DVec2;

use super::{PlaneBounds, Profile};
use crate::error::PrepareError;
use crate::{Accuracy, Bounds, Owner, Paint, Run, SolidError};

/// Questions about points of the plane. What is wrong with the profile is told by all of them.
impl Profile {
    /// The value at a point: positive inside.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// assert_eq!(Profile::circle(2.0).value([3.0, 0.0])?, -1.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn value(&self, p: impl Into<DVec2>) -> Result<f64, SolidError> {
        self.0.value(p.into().extend(0.0))
    }

    /// [`value`](Profile::value) at many points.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn values(&self, points: &[DVec2]) -> Result<Vec<f64>, SolidError> {
        let points: Vec<_> = points.iter().map(|p| p.extend(0.0)).collect();
        self.0.values(&points)
    }

    /// Whether a point is inside: the value is positive, or, in a side that parts share, inside is
    /// all around.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn contains(&self, p: impl Into<DVec2>) -> Result<bool, SolidError> {
        self.0.contains(p.into().extend(0.0))
    }

    /// [`contains`](Profile::contains) at many points.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn contains_all(&self, points: &[DVec2]) -> Result<Vec<bool>, SolidError> {
        let points: Vec<_> = points.iter().map(|p| p.extend(0.0)).collect();
        self.0.contains_all(&points)
    }

    /// The field's gradient at a point; it points inward. At kinks, that of one side.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    ///
    /// ```
    /// use rvachev::Profile;
    /// use glam::DVec2;
    ///
    /// assert_eq!(Profile::circle(2.0).gradient([3.0, 0.0])?, -DVec2::X);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn gradient(&self, p: impl Into<DVec2>) -> Result<DVec2, SolidError> {
        Ok(self.0.gradient(p.into().extend(0.0))?.truncate())
    }

    /// [`gradient`](Profile::gradient) at many points.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn gradients(&self, points: &[DVec2]) -> Result<Vec<DVec2>, SolidError> {
        let points: Vec<_> = points.iter().map(|p| p.extend(0.0)).collect();
        Ok(self.0.gradients(&points)?.into_iter().map(|gradient| gradient.truncate()).collect())
    }

    /// The leaf that decides at a point, by the path to it and its [name](Profile::named).
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn owner(&self, p: impl Into<DVec2>) -> Result<Owner, SolidError> {
        self.0.owner(p.into().extend(0.0))
    }

    /// The [paint](Profile::paint) of the border at a point of it; `None` where there is none.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn paint_at(&self, p: impl Into<DVec2>) -> Result<Option<Paint>, SolidError> {
        self.0.paint_at(p.into().extend(0.0))
    }

    /// A rectangle that holds the profile; infinite where the profile is unbounded, `min` above
    /// `max` if it is empty.
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn bounds(&self) -> Result<PlaneBounds, SolidError> {
        let Bounds { min, max } = self.0.bounds()?;
        Ok(PlaneBounds { min: min.truncate(), max: max.truncate() })
    }

    /// How far the border may be off what offsets, shells, roundings, fillets and chamfers ask for,
    /// in length units: see [`Solid::accuracy`](crate::Solid::accuracy).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let egg = Profile::superellipse([3.0, 2.0], 0.8).offset(0.5);
    /// assert_eq!(egg.accuracy()?.tolerance, 2f64.powi(-11));
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the profile: see [`SolidError`].
    pub fn accuracy(&self) -> Result<Accuracy, SolidError> {
        self.0.accuracy()
    }

    /// Compiles the profile and measures the borders that it needs: see
    /// [`Solid::prepare`](crate::Solid::prepare). Solids that are made of it need not measure them
    /// again.
    ///
    /// # Errors
    /// What is wrong with the profile, or that the work was cancelled: see [`PrepareError`].
    pub fn prepare(&self, run: &Run) -> Result<Accuracy, PrepareError> {
        self.0.prepare(run)
    }
}
