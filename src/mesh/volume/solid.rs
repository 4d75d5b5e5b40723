//! Voxels as solids.

use glam::DVec3;

use super::{Volume, VolumeError, VolumeSettings};
use crate::{MeshSolid, Run, Solid};

impl Solid {
    /// The solid where samples on a regular grid are above a level: voxels of a scan or a
    /// simulation, as a leaf like any other.
    ///
    /// The samples are given away: they are freed before the solid is returned, which holds their
    /// surface alone. They lie x fastest, then y, then z, `size` along each axis, the first at
    /// `origin`, `spacing` apart. Beyond the array all is outside. A sample that is NaN is outside.
    ///
    /// The surface is that of [`Volume::mesh`], marching cubes, closed at the border of the array;
    /// the value is the true distance to it, as for [`from_mesh`](Solid::from_mesh). Solids of the
    /// same surface are equal.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // The distance to a ball of radius 8 in a grid of 20³.
    /// let at = |n: usize| glam::DVec3::new((n % 20) as f64, (n / 20 % 20) as f64, (n / 400) as f64) - 9.5;
    /// let samples: Vec<f32> = (0..8000).map(|n| 8.0 - at(n).length() as f32).collect();
    /// let ball = Solid::from_volume(samples, [20; 3], [-9.5; 3], [1.0; 3], 0.0)?;
    /// let shell = ball.shell(1.0);
    /// assert!(shell.contains([7.5, 0.0, 0.0])? && !shell.contains([6.5, 0.0, 0.0])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`VolumeError`] names what does not fit. Using a solid of samples that are all outside is a
    /// [`SolidError`](crate::SolidError): it has no triangles.
    pub fn from_volume(
        samples: Vec<f32>,
        size: [usize; 3],
        origin: impl Into<DVec3>,
        spacing: impl Into<DVec3>,
        level: f32,
    ) -> Result<Solid, VolumeError> {
        Solid::from_volume_with(samples, size, [origin.into(), spacing.into()], level, &Run::default())
    }

    /// [`from_volume`](Solid::from_volume) with a choice of threads, a cancel token and a progress
    /// sink; origin and spacing come as a pair.
    ///
    /// # Errors
    /// As for [`from_volume`](Solid::from_volume), or that the work was cancelled.
    pub fn from_volume_with(
        samples: Vec<f32>,
        size: [usize; 3],
        [origin, spacing]: [DVec3; 2],
        level: f32,
        run: &Run,
    ) -> Result<Solid, VolumeError> {
        let run = run.stage(0.0, 1.0);
        let [to_mesh, to_build] = run.stages([0.3, 0.7]);
        let settings = VolumeSettings { level, normals: false, closed: true };
        let mesh = Volume::new(&samples, size, origin, spacing)?.mesh_with(&settings, &to_mesh)?;
        drop(samples);
        let solid = Solid::from_mesh_with(&mesh, MeshSolid::default(), &to_build)?;
        run.report(1.0);
        Ok(solid)
    }
}
