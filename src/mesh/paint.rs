//! The colours of a mesh: each triangle that of the part that it belongs to.
//!
//! The owner of a triangle is the leaf that decides at its centroid. Its corners have the paint
//! of that leaf, so that two colours meet at an edge without running into each other; where the
//! paint of a leaf changes, each corner has the mixture at its own place.

use glam::DVec3;

use crate::eval::Palette;
use crate::{Cancelled, Mesh, Paint, Run};
use rvachev_num::{Meter, jobs};

/// The colours of the corners of the triangles, given their owners.
pub(crate) fn corner_colors(
    mesh: &Mesh,
    palette: &Palette,
    owners: &[u32],
    unpainted: Paint,
    run: &Run,
) -> Result<Vec<[[u8; 4]; 3]>, Cancelled> {
    /// A corner is looked at by this part of the way to the middle of its triangle: on its own side
    /// of an edge where the paint changes.
    const INTO: f64 = 0.01;
    each_triangle(mesh, run, |nth, triangle| {
        let corners = mesh.corners(triangle);
        let middle = corners.into_iter().sum::<DVec3>() / 3.0;
        corners.map(|p| {
            let at = p.lerp(middle, INTO);
            let [red, green, blue] = palette.mixture(owners[nth], at, unpainted).unwrap_or(unpainted).color;
            [red, green, blue, 255]
        })
    })
}

/// What is told of each triangle, by its place among all and its vertices.
pub(crate) fn each_triangle<T: Clone + Default + Send>(
    mesh: &Mesh,
    run: &Run,
    tell: impl Fn(usize, [u32; 3]) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    /// Triangles that are looked at before it is asked whether to go on.
    const AT_ONCE: usize = 512;
    let triangles = mesh.triangles();
    let mut told = vec![T::default(); triangles.len()];
    let meter = Meter::new(run, triangles.len().div_ceil(AT_ONCE));
    jobs::try_chunks_mut(&mut told, AT_ONCE, |chunk, told| {
        meter.step()?;
        for (nth, told) in (chunk * AT_ONCE..).zip(told) {
            *told = tell(nth, triangles[nth]);
        }
        Ok(())
    })?;
    Ok(told)
}
