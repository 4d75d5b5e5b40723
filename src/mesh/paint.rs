//! The colours of a mesh: each triangle that of the part that it belongs to.
//!
//! The owner of a triangle is the leaf that decides at its centroid. Its corners have the paint
//! of that leaf, so that two colours meet at an edge without running into each other; where a
//! blend mixes, each corner has the mixture at its own place.

use glam::DVec3;
use rayon::prelude::*;

use crate::eval::{Palette, compiled};
use crate::{Cancelled, Mesh, Paint, Run, Solid, SolidError};
use rvachev_num::Meter;

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
        let owner = |_, triangle| program.deciding_leaf(self.corners(triangle).into_iter().sum::<DVec3>() / 3.0);
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

/// The colours of the corners of the triangles, given their owners.
pub(super) fn corner_colors(
    mesh: &Mesh,
    palette: &Palette,
    owners: &[u32],
    unpainted: Paint,
    run: &Run,
) -> Result<Vec<[[u8; 4]; 3]>, Cancelled> {
    each_triangle(mesh, run, |nth, triangle| {
        mesh.corners(triangle).map(|p| {
            let [red, green, blue] = palette.mixture(owners[nth], p, unpainted).unwrap_or(unpainted).color;
            [red, green, blue, 255]
        })
    })
}

/// What is told of each triangle, by its place among all and its vertices.
pub(super) fn each_triangle<T: Clone + Default + Send>(
    mesh: &Mesh,
    run: &Run,
    tell: impl Fn(usize, [u32; 3]) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    /// Triangles that are looked at before it is asked whether to go on.
    const AT_ONCE: usize = 512;
    let triangles = mesh.triangles();
    let mut told = vec![T::default(); triangles.len()];
    let meter = Meter::new(run, triangles.len().div_ceil(AT_ONCE));
    told.par_chunks_mut(AT_ONCE).enumerate().try_for_each(|(chunk, told)| {
        meter.step()?;
        for (nth, told) in (chunk * AT_ONCE..).zip(told) {
            *told = tell(nth, triangles[nth]);
        }
        Ok(())
    })?;
    Ok(told)
}
