//! Whole parts: from a closed mesh, or points of one, to an ordered tree of added and subtracted
//! leaves.

mod adjust;
mod arcs;
mod axes;
mod balls;
mod bases;
mod bays;
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
mod facing;
mod finish;
mod freedom;
mod guesses;
mod intent;
mod layouts;
mod leaf;
#[cfg(test)]
mod leaf_tests;
mod limits;
mod measures;
mod model;
mod offsets;
mod orient;
mod outline;
mod patches;
mod patterns;
mod places;
mod planes;
mod pool;
mod profiles;
mod queries;
mod recover;
mod refine;
mod regions;
#[cfg(test)]
mod regions_tests;
mod repeated;
mod residual;
mod result;
mod round;
mod samples;
mod sections;
mod seeds;
mod seen;
mod select;
#[cfg(test)]
mod select_tests;
mod settings;
mod settle;
mod smooth;
mod snap;
mod snapping;
mod sobol;
mod straighten;
mod superellipsoids;
mod supershapes;
mod through;
mod times;
mod topology;
mod words;

pub use patterns::{Layout, Pattern};
pub use result::{PartFit, PartLeaf, Snap, Topology, Unexplained};
pub use settings::{PartKinds, PartSettings};
pub use times::PartTimes;

use super::FitError;
use crate::Run;
use crate::geom::{Mesh, PointCloud};

/// The tree of leaves that a closed mesh is of: what is added and what is cut, in order.
///
/// ```text
///      .-----------------.         + box 1               60 × 40 × 8
///     /   ()         () /|         − cut cylinder 1      ⌀ 6, through
///    /                 / /    →    − cut cylinder 2      ⌀ 6, through
///   '-----------------' /          IoU 1.000, 20 parameters, genus 2
///   '-----------------''
/// ```
///
/// The result is a [`PartFit`]: a solid whose leaves have names, how much of the volume it has in
/// common with the mesh, how far its surface is from the mesh's, genus and shells beside those of
/// the mesh, and the places that are not explained.
///
/// Samples of the surface are grouped to regions of planes, cylinders, cones, spheres and tori.
/// Leaves in question are made of these, with all ends that they may have; boxes between parallel
/// planes; extruded sections as outlines of straight sides and arcs, rounded rectangles, regular
/// prisms and supershapes, and their bays, which are cut; and superellipsoids and supershapes of
/// what hangs together without a crease. Directions that are off an axis of coordinates by less
/// than 0.01° are along it; where facets are small, or of points, so are those that are off by no
/// more than samples leave open, and by 0.8° or 1° at the most. Vertices that tell a direction
/// exactly have the last word. A search over ordered trees takes those leaves that mend more than
/// their parameters [cost](PartSettings::parameter_cost), of equal leaves all but the first at a
/// lower price. Where that takes 4 to 16 leaves it is done again with leaves that are dearer, so
/// that few and large ones come first, and the better tree is taken. Leaves are fitted to the
/// samples. While more than half a hundredth of the volume is wrong, leaves are looked for where it
/// is, twice at the most. Then leaves are laid through the vertices of the mesh where these tell
/// their lengths exactly: the radius of a cylinder of facets is that of its corners. Numbers that
/// are round within what the vertices leave open, in millimetres or in binary fractions of an inch,
/// become so, and cuts that end in the open go through: see [`snaps`](PartFit::snaps). What of this
/// would take genus or shells farther from the mesh's is not done, as far as these are known.
/// Leaves are left out that mend little and spoil genus or shells. Equal leaves on a line, a ring
/// or a grid are [patterns](PartFit::patterns). Pictures, code and limits are on
/// [a page of their own](crate::parts).
///
/// The mesh may be in pieces and its triangles may overlap; inside is where the winding number is
/// above ½. The result depends on mesh and settings only, not on the number of threads.
///
/// # How well it works
///
/// Meshes of parts that are used for tests elsewhere, on one thread, IoU on 2²⁰ points;
/// that of a mesh of few facets cannot be 1 if radii are those of the corners:
///
/// | mesh | IoU | leaves (parameters) | genus, mesh's |
/// |---|---|---|---|
/// | unit_cube | 1.0000 | 1 (9) | 0, 0 |
/// | 7_8ths_cube | 1.0000 | 2 (18) | 0, 0 |
/// | shaft | 0.9934 | 1 (7) | 0, 0 |
/// | round | 0.9589 | 2 (14) | 1, 1 |
/// | bushing_roller | 0.9934 | 2 (14) | 1, 1 |
/// | xtion_bracket | 0.9978 | 3 (55) | 2, 2 |
/// | camshaft, not snapped | 0.9971 | 5 (42) | 0, 0 |
/// | camshaft | 0.9933 | 5 (42) | 0, 0 |
/// | angle_block | 0.9993 | 8 (78) | 1, 1 |
/// | satellite_mount | 0.9916 | 5 (59) | 8, 8 |
/// | lasercut_interface | 0.9995 | 3 (40) | 8, 8 |
/// | holder | 0.9914 | 4 (34) | 5, 5 |
/// | plate_holes | 0.9884 | 5 (55) | 5, 5 |
/// | machinist | 0.9947 | 7 (72) | 36, 36 |
/// | octagonal_pocket | 0.9805 | 34 (454) | 1, 1 |
///
/// Of 50 random parts (2 to 6 boxes, cylinders, cones, spheres, prisms, superellipsoids and
/// supershapes, 0 to 4 holes, as meshes of marching cubes) all come out with an IoU of .97 or more
/// (median .996), 48 with the genus of the mesh, 45 with 12 leaves or fewer. It takes some .3 to
/// 7 s a part, 1.3 in the middle, on one thread.
///
/// What is not recovered: fillets, sweeps, threads and lattices. Lengths that were meant to be
/// round are, and those that are equal within what the vertices leave open are one; what was meant
/// to hang together otherwise, as a hole by its distance from an edge, is not told.
///
/// # Errors
///
/// [`FitError::Setting`], [`FitError::TooFew`] of fewer than 4 triangles, [`FitError::Flat`] of
/// vertices in a plane, [`FitError::Extent`] of sizes beyond 10⁻⁵ to 10⁷, [`FitError::Hollow`] of
/// an open surface that encloses nothing or that faces inwards, [`FitError::NoSurface`] if no leaf
/// is worth its parameters.
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
/// The points are to be spread about evenly, 200 or more; some thousands are wanted, and of more
/// than 4000 a random part is searched. Normals that the cloud has are to point outwards. Where it
/// has none, those of planes through neighbours are taken, on the sides to which winding numbers
/// fall that are ½ all over the surface. Noise is estimated, and
/// [`PartSettings::noise`] is a lower bound of it; points are brought nearer to the surface by the
/// mean of their neighbours, along the normals.
///
/// What is inside is told by winding numbers of the points with the areas that they stand for.
/// Where these tell nothing, as a side is not seen, space costs nothing: leaves go on there as what
/// is seen of them tells. How much of a leaf there are points of is [`PartLeaf::seen`], and those
/// of which most is not seen [are guesses](PartLeaf::is_guess).
///
/// [Genus and shells](PartFit::topology_of_input) of the input are not known, and lengths are what
/// fits the points best. Of 50 random parts of two to six added leaves and up to four cut ones, of
/// 4000 points, noise as a share of the box's diagonal, so many have an IoU of 0.97 with the part;
/// a part takes some 1 to 2 s:
///
/// | noise | IoU ≥ .97 | median IoU |
/// |---|---|---|
/// | none | 49 | 0.995 |
/// | 0.2 % | 50 | 0.993 |
/// | 0.4 % | 49 | 0.991 |
/// | none, from above | 46 | 0.991 |
/// | none, without normals | 49 | 0.991 |
/// | 0.2 %, without normals | 46 | 0.988 |
///
/// "From above" are parts that stand on a table, of which no direction from below sees anything.
/// The normals are exact where there are some; those of a scanner are not quite.
/// What fails at 0.4 % is mostly a leaf that is half buried in others: fitted from the truth on,
/// the points tell it.
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
/// assert!(found.iou() > 0.97 && found.leaves().iter().any(|leaf| leaf.is_cut()));
/// assert!(found.leaves().iter().all(|leaf| leaf.seen() > 0.9 && !leaf.is_guess()));
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
