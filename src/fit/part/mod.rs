//! Whole parts: from a closed mesh to an ordered tree of added and subtracted leaves.

mod adjust;
mod axes;
mod balls;
mod bases;
mod bits;
mod body;
mod boxes;
mod candidates;
mod columns;
mod contours;
mod corners;
mod coverage;
mod detector;
mod dipoles;
mod directions;
mod finish;
mod freedom;
mod guesses;
mod leaf;
mod limits;
mod model;
mod offsets;
mod orient;
mod outline;
mod patches;
mod patterns;
mod pool;
mod profiles;
mod queries;
mod recover;
mod refine;
mod regions;
#[cfg(test)]
mod regions_tests;
mod result;
mod samples;
mod sections;
mod seeds;
mod select;
#[cfg(test)]
mod select_tests;
mod settings;
mod settle;
mod snap;
mod sobol;
mod straighten;
mod superellipsoids;
mod topology;

pub use patterns::{Layout, Pattern};
pub use result::{PartFit, PartLeaf, Topology, Unexplained};
pub use settings::{PartKinds, PartSettings};

use super::FitError;
use crate::Run;
use crate::geom::{Mesh, PointCloud};

/// The tree of leaves that a closed mesh is of: what is added and what is cut, in order.
///
/// ```text
///      .-----------------.         + box 1               60 × 40 × 8
///     /   ()         () /|         − cut cylinder 1      ⌀ 6, through
///    /                 / /    →    − cut cylinder 2      ⌀ 6, through
///   '-----------------' /          IoU 1.000, 23 parameters, genus 2
///   '-----------------''
/// ```
///
/// The result is a [`PartFit`]: a solid whose leaves have names, how much of the volume it has in common with the mesh,
/// how far its surface is from the mesh's, genus and shells beside those of the mesh, and the places that are not
/// explained. Leaves are boxes, half-spaces (cut only), cylinders, cones, spheres, tori, superellipsoids, and what is
/// extruded: polygons, rounded rectangles, regular prisms and supershapes. What is of other shapes comes
/// out as several of these, or is told of by [`unexplained`](PartFit::unexplained).
///
/// Samples of the surface are grouped to regions of planes, cylinders, cones, spheres and tori; leaves in question are
/// made of these with all ends and all boxes between parallel planes; a search over ordered trees takes those that mend
/// more than their parameters [cost](PartSettings::parameter_cost); they are fitted to the samples, and laid through the
/// vertices of the mesh where these tell their lengths exactly: the radius of a faceted cylinder is that of its corners.
///
/// The mesh may be in pieces and its triangles may overlap; inside is where the winding number is above ½. The result
/// depends on mesh and settings only, not on the number of threads.
///
/// # Errors
///
/// [`FitError::Setting`], [`FitError::TooFew`] of fewer than 4 triangles, [`FitError::Flat`] of vertices in a plane,
/// [`FitError::Extent`] of sizes beyond 10⁻⁶ to 10⁸, [`FitError::Hollow`] of an open surface that encloses nothing or
/// that faces inwards, [`FitError::NoSurface`] if no leaf is worth its parameters.
///
/// ```
/// use rvachev::fit::{PartSettings, part};
/// use rvachev::{MeshSettings, Solid};
///
/// let plate = Solid::cuboid([60.0, 40.0, 8.0]) - Solid::cylinder(6.0, 20.0).translate([15.0, 5.0, 0.0]);
/// let mesh = plate.mesh(&MeshSettings::default())?;
///
/// let found = part(&mesh, &PartSettings::default())?;
/// let [block, hole] = found.leaves() else { panic!("two leaves") };
/// assert_eq!((block.name(), hole.name()), ("box 1", "cut cylinder 1"));
/// assert!((hole.centre().x - 15.0).abs() < 0.01 && hole.is_cut());
/// assert!(found.iou() > 0.995 && found.topology().genus == Some(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn part(mesh: &Mesh, settings: &PartSettings) -> Result<PartFit, FitError> {
    part_with(mesh, settings, &Run::default())
}

/// [`part`] with a [`Run`].
///
/// # Errors
///
/// Those of [`part`], and [`FitError::Cancelled`].
pub fn part_with(mesh: &Mesh, settings: &PartSettings, run: &Run) -> Result<PartFit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    settings.check()?;
    run.install(|| recover::recover(mesh, settings, &run))
}

/// The tree of leaves that points of a surface are of: [`part`] of a scan.
///
/// The points are to be of the whole surface, spread about evenly, 200 or more; some thousands are wanted, and of more
/// than 4000 a random part is searched. Normals that the cloud has are to point outwards. Where it has none, the points'
/// neighbours tell them, which is less sure at sharp edges and in thin walls. What is inside is told by winding numbers
/// of the points with the areas that they stand for. Noise is estimated, and [`PartSettings::noise`] is a lower bound of it.
///
/// [Genus and shells](PartFit::topology_of_input) of the input are not known, and lengths are what fits the points best.
///
/// # Errors
///
/// Those of [`part`], with [`FitError::TooFew`] of fewer than 200 points.
///
/// ```
/// use rvachev::fit::{PartSettings, part_of_points};
/// use rvachev::{MeshSettings, PointCloud, Solid};
///
/// let block = Solid::cuboid([60.0, 40.0, 20.0]) - Solid::cylinder(8.0, 30.0);
/// let mesh = block.mesh(&MeshSettings::default())?;
/// let points = mesh.positions().iter().map(|p| p.as_dvec3()).collect();
///
/// let found = part_of_points(&PointCloud::new(points)?, &PartSettings::default())?;
/// assert!(found.iou() > 0.97 && found.leaves().len() == 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn part_of_points(cloud: &PointCloud, settings: &PartSettings) -> Result<PartFit, FitError> {
    part_of_points_with(cloud, settings, &Run::default())
}

/// [`part_of_points`] with a [`Run`].
///
/// # Errors
///
/// Those of [`part_of_points`], and [`FitError::Cancelled`].
pub fn part_of_points_with(cloud: &PointCloud, settings: &PartSettings, run: &Run) -> Result<PartFit, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    settings.check()?;
    run.install(|| recover::recover_points(cloud, settings, &run))
}
