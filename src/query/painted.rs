//! A mesh with the paint of its solid.

use glam::DVec3;

use super::many::never_cancelled;
use super::prepare::PrepareError;
use crate::distance::compiled_with;
use crate::mesh::{corner_colors, each_triangle};
use crate::{Mesh, Paint, Run, Solid, SolidError};

impl Mesh {
    /// The same mesh with the [paint](Solid::paint) of the solid that it was made from: an owner
    /// for each triangle, if it had none, and a colour for each corner. What has no paint gets
    /// the colour of `unpainted`.
    ///
    /// ```
    /// use rvachev::{CellSize, MeshSettings, Paint, Solid};
    ///
    /// let part = Solid::cuboid([4.0, 4.0, 1.0]) - Solid::cylinder(1.0, 3.0).paint([200, 0, 0]);
    /// let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(30), ..MeshSettings::default() })?;
    /// let mesh = mesh.painted(&part, Paint::from([250, 250, 250]))?;
    /// let colors = mesh.corner_colors().expect("just painted");
    /// let red = colors.iter().filter(|corners| **corners == [[200, 0, 0, 255]; 3]).count();
    /// let white = colors.iter().filter(|corners| **corners == [[250, 250, 250, 255]; 3]).count();
    /// assert!(red > 20 && red + white == colors.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn painted(self, solid: &Solid, unpainted: Paint) -> Result<Mesh, SolidError> {
        never_cancelled(self.painted_with(solid, unpainted, &Run::default()))
    }

    /// [`painted`](Mesh::painted) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn painted_with(self, solid: &Solid, unpainted: Paint, run: &Run) -> Result<Mesh, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_own, to_paint] = run.stages([0.1, 0.6, 0.3]);
        let (owners, colors) = run.install(|| {
            let programs = compiled_with(solid, &to_compile)?;
            let program = &programs.surface;
            let owner = |_, triangle| program.deciding_owner(self.corners(triangle).into_iter().sum::<DVec3>() / 3.0);
            let owners = match self.owners() {
                Some(owners) => owners.to_vec(),
                None => each_triangle(&self, &to_own, owner)?,
            };
            let colors = corner_colors(&self, &programs.palette, &owners, unpainted, &to_paint)?;
            Ok::<_, PrepareError>((owners, colors))
        })?;
        let painted = self.with_owners(owners).and_then(|mesh| mesh.with_corner_colors(colors));
        let Ok(painted) = painted else { unreachable!("one for each triangle") };
        run.report(1.0);
        Ok(painted)
    }
}
