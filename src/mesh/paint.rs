//! The colours of a mesh: each triangle that of the part that it belongs to.
//!
//! The owner of a triangle is the leaf that decides at its centroid. Its corners have the paint
//! of that leaf, so that two colours meet at an edge without running into each other; where a
//! blend mixes, each corner has the mixture at its own place.

use glam::DVec3;
use rayon::prelude::*;

use crate::eval::compiled;
use crate::{Mesh, Paint, Solid, SolidError};

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
        let owners: Vec<u32> = match self.owners() {
            Some(owners) => owners.to_vec(),
            None => {
                let owner = |triangle: &[u32; 3]| {
                    program.deciding_leaf(self.corners(*triangle).into_iter().sum::<DVec3>() / 3.0)
                };
                self.triangles().par_iter().map(owner).collect()
            }
        };
        let color = |(triangle, owner): (&[u32; 3], &u32)| {
            self.corners(*triangle).map(|p| {
                let paint = palette.mixture(*owner, p, unpainted).unwrap_or(unpainted);
                let [red, green, blue] = paint.color;
                [red, green, blue, 255]
            })
        };
        let colors: Vec<[[u8; 4]; 3]> = self.triangles().par_iter().zip(&owners).map(color).collect();
        match self.with_owners(owners).and_then(|mesh| mesh.with_corner_colors(colors)) {
            Ok(mesh) => Ok(mesh),
            Err(_) => unreachable!("one for each triangle"),
        }
    }
}
