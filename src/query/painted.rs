//! A mesh with the paint of its solid.

use glam::DVec3;

use crate::distance::compiled;
use crate::mesh::{corner_colors, each_triangle};
use crate::{Cancelled, Mesh, Paint, Run, Solid, SolidError};

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
        let program = compiled(solid)?.surface.clone();
        let palette = solid.palette()?;
        let run = Run::default();
        let owner = |_, triangle| program.deciding_owner(self.corners(triangle).into_iter().sum::<DVec3>() / 3.0);
        let owners = match self.owners() {
            Some(owners) => Ok(owners.to_vec()),
            None => each_triangle(&self, &run, owner),
        };
        let painted = owners.and_then(|owners| {
            let colors = corner_colors(&self, &palette, &owners, unpainted, &run)?;
            Ok(self.with_owners(owners).and_then(|mesh| mesh.with_corner_colors(colors)))
        });
        match painted {
            Ok(Ok(mesh)) => Ok(mesh),
            Ok(Err(_)) => unreachable!("one for each triangle"),
            Err(Cancelled) => unreachable!("nobody has the token"),
        }
    }
}
