//! Questions about points of the plane.

use glam::{DVec2, DVec3};

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
        self.0.values(&in_space(points))
    }

    /// [`values`](Profile::values) on a [`Run`]: see
    /// [`Solid::values_with`](crate::Solid::values_with).
    ///
    /// # Errors
    /// What is wrong with the profile, or that the work was cancelled.
    pub fn values_with(&self, points: &[DVec2], run: &Run) -> Result<Vec<f64>, PrepareError> {
        self.0.values_with(&in_space(points), run)
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
        self.0.contains_all(&in_space(points))
    }

    /// [`contains_all`](Profile::contains_all) on a [`Run`]: see
    /// [`Solid::contains_all_with`](crate::Solid::contains_all_with).
    ///
    /// # Errors
    /// What is wrong with the profile, or that the work was cancelled.
    pub fn contains_all_with(&self, points: &[DVec2], run: &Run) -> Result<Vec<bool>, PrepareError> {
        self.0.contains_all_with(&in_space(points), run)
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
        Ok(in_plane(self.0.gradients(&in_space(points))?))
    }

    /// [`gradients`](Profile::gradients) on a [`Run`]: see
    /// [`Solid::gradients_with`](crate::Solid::gradients_with).
    ///
    /// # Errors
    /// What is wrong with the profile, or that the work was cancelled.
    pub fn gradients_with(&self, points: &[DVec2], run: &Run) -> Result<Vec<DVec2>, PrepareError> {
        Ok(in_plane(self.0.gradients_with(&in_space(points), run)?))
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

fn in_space(points: &[DVec2]) -> Vec<DVec3> {
    points.iter().map(|p| p.extend(0.0)).collect()
}

fn in_plane(vectors: Vec<DVec3>) -> Vec<DVec2> {
    vectors.into_iter().map(DVec3::truncate).collect()
}
