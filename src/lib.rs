//! Implicit-function (F-rep, signed distance) solid modelling and CSG: superquadrics, supershapes,
//! exact primitives, lattices, profiles and formulas, joined by R-functions and blends, deformed,
//! meshed and ray-marched.
//!
//! A solid is a function of space that is **positive inside**, zero on the surface and
//! negative outside, in length units. You write it as an expression; it is compiled to a
//! program that runs on SIMD lanes, over intervals and with gradients.
//!
//! # A guided tour
//!
//! Leaves are made with their sizes, moved by maps, and joined by operators: `|` union, `&`
//! intersection, `-` difference, `^` symmetric difference, `!` complement.
//!
//! ```
//! use glam::DVec3;
//! use rvachev::Solid;
//!
//! let body = Solid::superellipsoid(DVec3::new(20.0, 12.0, 8.0), 0.3, 0.5);
//! let hole = Solid::cylinder(4.0, 30.0).translate(DVec3::X * 6.0);
//! let part = body - hole;
//! assert!(part.contains(DVec3::new(-10.0, 0.0, 0.0))?);
//! assert!(!part.contains(DVec3::new(6.0, 0.0, 0.0))?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! A vector is a glam one, a tuple or an array: `[20.0, 12.0, 8.0]`. Building never fails. What is
//! wrong is said when the solid is first used, with the path to the node, the parameter, its value
//! and what is allowed.
//!
//! ```
//! use rvachev::Solid;
//!
//! let wrong = Solid::sphere(1.0) | Solid::cylinder(-2.0, 5.0);
//! let error = wrong.bounds().unwrap_err().to_string();
//! assert_eq!(error, "union[1] / cylinder: radius is -2, allowed: 0.000000001 to 1000000000");
//! ```
//!
//! The operators use the R-function R_p with p = 2, whose field is smooth away from the
//! corners; [`RFunction`] has the other rules. All rules give the same solid.
//!
//! ```
//! use glam::DVec3;
//! use rvachev::{RFunction, Solid};
//!
//! let (a, b) = (Solid::sphere(1.0), Solid::sphere(1.0).translate(DVec3::X));
//! let p = DVec3::new(0.5, 0.2, 0.0);
//! let sharp = a.union(&b, RFunction::MIN_MAX).value(p)?;
//! let smooth = a.union(&b, RFunction::P(2.0)).value(p)?;
//! assert!(sharp > 0.0 && smooth > sharp);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! A [`Blend`] shapes the transition: a fillet or a chamfer of a given size, a smooth one.
//! [`offset`](Solid::offset) and [`shell`](Solid::shell) are lengths too,
//! [`rounded`](Solid::rounded) rounds all convex edges, [`filleted`](Solid::filleted) fills all
//! concave ones. All go by the true distance to the surface, whatever the solid is made of: see
//! [`lengths`].
//!
//! ```
//! use rvachev::{Blend, Solid};
//!
//! let foot = Solid::cuboid([30.0, 20.0, 4.0]);
//! let post = Solid::cylinder(5.0, 20.0).translate([0.0, 0.0, 10.0]);
//! let stand = foot.union_with(post, Blend::Fillet { radius: 2.0 });
//! assert!(stand.contains([5.4, 0.0, 2.4])?);
//!
//! let hollow = Solid::superellipsoid([20.0, 12.0, 8.0], 0.3, 0.5).shell(1.5);
//! assert!(hollow.contains([19.0, 0.0, 0.0])? && !hollow.contains([18.0, 0.0, 0.0])?);
//! let smooth = stand.rounded(1.0);
//! assert!(stand.contains([14.9, 9.9, 0.0])? && !smooth.contains([14.9, 9.9, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! What is drawn in the plane is a [`Profile`]: extruded, revolved, swept along a helix.
//!
//! ```
//! use rvachev::Profile;
//!
//! let plate = Profile::rounded_rectangle([40.0, 20.0], 4.0) - Profile::circle(6.0);
//! assert!(!plate.extrude(3.0).contains([0.0, 5.0, 0.0])?);
//! // The right half of the section counts; it is drawn across the axis.
//! let bowl = Profile::polygon([[-4.0, 0.0], [4.0, 0.0], [9.0, 6.0], [8.0, 6.0], [3.5, 1.0], [-3.5, 1.0]]).revolve();
//! assert!(bowl.contains([0.0, 0.0, 0.5])? && !bowl.contains([0.0, 0.0, 3.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! Maps deform: any affine one, [taper](Solid::taper), [twist](Solid::twist),
//! [bend](Solid::bend); [`repeat_polar`](Solid::repeat_polar) and its like make a thousand
//! copies at the price of two.
//!
//! ```
//! use rvachev::{deg, Solid};
//!
//! let drill = Solid::cuboid([2.0, 1.0, 10.0]).twist(deg(30.0));
//! assert!(drill.bounds()?.max.x < 1.2);
//! let holes = Solid::cylinder(1.0, 9.0).translate([12.0, 0.0, 0.0]).repeat_polar(12);
//! assert!(holes.contains([0.0, 12.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! Questions are answered in double precision: [value](Solid::value), [gradient](Solid::gradient),
//! [range](Solid::range) over a box, [raycast](Solid::raycast),
//! [closest point](Solid::closest_surface_point), [clearance](Solid::clearance),
//! [owner](Solid::owner).
//!
//! ```
//! use glam::DVec3;
//! use rvachev::{Bounds, Solid};
//!
//! let ball = Solid::sphere(2.0);
//! assert_eq!(ball.gradient(DVec3::X)?, -DVec3::X);
//! let range = ball.range(&Bounds::new(DVec3::ZERO, DVec3::ONE))?;
//! assert!(range.lo() <= 0.268 && range.hi() >= 2.0);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! A solid is [meshed](Solid::mesh) to triangles, closed and manifold, and saved.
//!
//! ```
//! use rvachev::{CellSize, MeshSettings, Solid};
//!
//! let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
//! let mesh = Solid::sphere(1.0).mesh(&settings)?;
//! let report = mesh.check();
//! assert!(report.is_closed() && report.is_manifold());
//! let path = std::env::temp_dir().join("rvachev_tour.stl");
//! mesh.save(&path)?;
//! # std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! And it is [rendered](Solid::render) to a picture.
//!
//! ```
//! use rvachev::{Camera, RenderSettings, Solid};
//!
//! let ball = Solid::sphere(1.0);
//! let camera = Camera::framing(&ball.bounds()?);
//! let image = ball.render(&camera, &RenderSettings { width: 40, height: 30, ..RenderSettings::default() })?;
//! let path = std::env::temp_dir().join("rvachev_tour.png");
//! image.save(&path)?;
//! # std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Parts have [paint](Solid::paint), and pictures have [styles](Style). Pictures can be
//! [cut open](RenderSettings::cut). For turntables there are [drafts](Quality::Draft), drawn from a
//! mesh that the scene keeps. Behind a picture are its [layers](Solid::layers): depth, normals,
//! positions, leaves. A
//! [slice](Solid::slice) shows the field on a plane, and its [contours](Slice::contours), nested
//! and within a tolerance; a stack of planes is cut at once ([`Solid::slices`]).
//!
//! ```
//! use rvachev::range_image::Coordinates;
//! use rvachev::{Camera, Plane, RenderSettings, Solid, Style, deg};
//!
//! let part = Solid::cuboid([4.0, 3.0, 1.0]).paint([60, 100, 160]) - Solid::cylinder(1.0, 2.0).paint([220, 140, 40]);
//! let camera = Camera::framing(&part.bounds()?).orbit(deg(30.0), deg(10.0));
//! let settings = RenderSettings { width: 40, height: 30, style: Style::Technical, ..RenderSettings::default() };
//! let drawing = part.render(&camera, &settings)?;
//! let cloud = part.layers(&camera, 40, 30)?.range_image().points(Coordinates::World)?;
//! assert!(cloud.len() > 100);
//! let contours = part.slice(&Plane::xy(0.0))?.contours(1e-3)?;
//! assert_eq!(contours.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Points become solids: [`fit`] finds the superellipsoid or supershape that a scan is of, the tree
//! of boxes, cylinders and other leaves that a mesh ([`fit::part`]) or a scan
//! ([`fit::part_of_points`]) is of, where a known part is in a scan, and how far it is from it. Any
//! solid can be [written as Rust code](Solid::to_rust).
//!
//! ```
//! use rvachev::fit::{FitSettings, superellipsoid};
//! use rvachev::{CellSize, MeshSettings, PointCloud, Solid};
//!
//! let pill = Solid::superellipsoid([2.0, 1.0, 1.5], 0.5, 1.0).translate([5.0, 0.0, 0.0]);
//! let mesh = pill.mesh(&MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() })?;
//! let scan = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect())?;
//! let fit = superellipsoid(&scan, &FitSettings::default())?;
//! assert!((fit.translation().x - 5.0).abs() < 0.01 && fit.solid().contains([6.9, 0.0, 0.0])?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [Twelve idioms](idioms) show how things are commonly built: plates with holes, named parts,
//! rings of parts, leaves of one's own. Explained with pictures are [lengths],
//! [what is made and what is measured](measuring) (volumes, thickness, clearance), how
//! [points become solids](scans), and [whole parts](parts), from meshes and scans to code.
//!
//! # The catalogue
//!
#![cfg_attr(
    feature = "doc-images",
    doc = "![Everything in the catalogue][gallery]\n",
    doc = ::embed_doc_image::embed_image!("gallery", "docs/gallery.png")
)]
//!
//! Formula, parameters with their ranges, source and an example are with each item; formulas
//! without a source are elementary geometry, derived here. Most leaves have a constructor on
//! [`Solid`] ([`Solid::torus`]), all become solids by `Solid::from(leaf)`, and stand as they are
//! where a solid is taken. The words for values are those of [a
//! table](conventions#what-values-mean).
//!
//! ## Leaves
//!
//! | superquadrics | | value |
//! |---|---|---|
//! | [`Superellipsoid`] | boxes, cylinders, ellipsoids, octahedra, and everything between | gauge |
//! | [`GeneralisedSuperquadric`] | three exponents, one along each axis | gauge |
//! | [`Supertoroid`] | rings with round, square and bevelled sections | gauge of the tube |
//! | [`Superhyperboloid`] | one sheet or two, along z or x, clipped | scaled difference of norms |
//!
//! | supershapes | | value |
//! |---|---|---|
//! | [`Supershape`] | the product of two [`Gielis`] curves, of any real symmetry | gauge |
//! | [`Turns`] | the first turn, outer envelope or inner core of a curve of symmetry P/Q | |
//! | [`Radius`] | the standard radius, or the rational one for previews | |
//!
//! | primitives | | value |
//! |---|---|---|
//! | [`Sphere`] | by its radius | distance |
//! | [`Ellipsoid`] | by three semi-axes | bound |
//! | [`Cuboid`] | a box, by the lengths of its edges | distance |
//! | [`RoundedCuboid`] | a box with rounded edges and corners | distance |
//! | [`Cylinder`] | about the z axis | distance |
//! | [`Capsule`] | a cylinder with hemispherical ends | distance |
//! | [`Cone`] | pointed or truncated | distance |
//! | [`Torus`] | a ring of circular section | distance |
//! | [`Prism`] | on a regular polygon, by its corners or across its flats | distance |
//! | [`Pyramid`] | on a regular polygon | distance |
//! | [`Wedge`] | a ramp: half a box | distance |
//! | [`HalfSpace`] | all that is below a plane, unbounded | distance |
//! | [`Slab`] | all that is between two planes, unbounded | distance |
//!
//! | lattices | | value |
//! |---|---|---|
//! | [`SheetLattice`] | a wall along a gyroid, Schwarz P or D ([`MinimalSurface`]), unbounded | near the wall nearly the distance |
//! | [`NetworkLattice`] | one side of such a surface, by its share of the volume, unbounded | near the surface 0.6 to 1 of the distance |
//! | [`Grading`] | a thickness or share that varies in space: a number or your formula | |
//!
//! | formulas | | value |
//! |---|---|---|
//! | [`Formula`] | a fidget tree, or the text of a `.vm` file ([`Formula::from_vm`]) | what it gives |
//! | [`Field`] | a leaf of your own, in Rust; made a solid by [`Solid::new`] | what it gives |
//!
//! | meshes | | value |
//! |---|---|---|
//! | [`Solid::from_mesh`] | what triangles enclose, clean or not: imported parts, scans, solids that were meshed | distance; of open ones a bound |
//! | [`Solid::from_volume`] | voxels: where samples on a grid are above a level | distance |
//!
//! ## Profiles
//!
//! Shapes of the plane. [`Profile`] has the verbs of [`Solid`] by the same names: joins and their
//! operators, blends, maps, mirrors, repeats, offsets and shells, names.
//!
//! | profile | | value |
//! |---|---|---|
//! | [`Circle`] | by its radius | distance |
//! | [`Rectangle`] | its corners sharp or rounded | distance |
//! | [`RegularPolygon`] | of 3 to 1024 sides | distance |
//! | [`Polygon`] | any contours, with holes and islands, of thousands of edges | distance |
//! | [`Superellipse`] | the plane section of a superellipsoid | gauge |
//! | [`Superpolygon`] | what is within a [`Gielis`] curve | gauge |
//! | [`Profile::formula`] | a fidget tree of x and y | what it gives |
//!
//! | becomes a solid by | |
//! |---|---|
//! | [`extrude`](Profile::extrude), [`extrude_up`](Profile::extrude_up), [`extrude_with`](Profile::extrude_with) | along z, about z = 0 or from there up; with an [`Extrusion`] twisted, scaled, its edges sharp, chamfered or rounded ([`Caps`]) |
//! | [`revolve`](Profile::revolve), [`revolve_by`](Profile::revolve_by) | about z, all the way or by an angle |
//! | [`sweep_helix`](Profile::sweep_helix) | along a [`Helix`]: threads and springs |
//! | [`column`](Profile::column) | the unbounded column over it |
//!
//! ## Joins and blends
//!
//! | join | operator | many at once |
//! |---|---|---|
//! | [`union`](Solid::union) | `a \| b` | [`union_all`](Solid::union_all) |
//! | [`intersection`](Solid::intersection) | `a & b` | [`intersection_all`](Solid::intersection_all) |
//! | [`difference`](Solid::difference) | `a - b` | [`difference_all`](Solid::difference_all) |
//! | [`symmetric_difference`](Solid::symmetric_difference) | `a ^ b` | |
//! | [`complement`](Solid::complement) | `!a` | |
//!
//! The methods take an [`RFunction`]: `MIN_MAX`, `Alpha`, `Zero`, `P`, `Associative`, `Distance`.
//! [`union_with`](Solid::union_with), [`intersection_with`](Solid::intersection_with) and
//! [`difference_with`](Solid::difference_with) take a [`Blend`], and so do
//! [`union_all_with`](Solid::union_all_with) and its like, of many operands:
//!
//! | blend | |
//! |---|---|
//! | [`Blend::Fillet`] | a rounding of constant radius, a length |
//! | [`Blend::Chamfer`] | a flat face; its leg, how far from the edge it begins on either operand, is a length |
//! | [`Blend::Smooth`] | a smooth transition of compact support; also [`smooth_union`](Solid::smooth_union) and its like |
//! | [`Blend::Displacement`] | Pasko and Savchenko's blend, which reaches everywhere |
//! | [`Blend::Ricci`] | Ricci's blend of gauges |
//!
//! ## Levels, offsets and shells
//!
//! | length | |
//! |---|---|
//! | [`level`](Solid::level) | values moved by a number |
//! | [`offset`](Solid::offset) | the surface moved outwards or inwards by a distance |
//! | [`shell`](Solid::shell) | a wall of even thickness inside the surface |
//! | [`rounded`](Solid::rounded) | convex edges rounded by a ball |
//! | [`filleted`](Solid::filleted) | concave edges filled by a ball |
//!
//! What they are, how exact, and what becomes of a ball that does not fit: [`lengths`].
//!
//! ## Maps
//!
//! | map | |
//! |---|---|
//! | [`translate`](Solid::translate), [`rotate_z`](Solid::rotate_z) and its like by an [`Angle`], [`scale`](Solid::scale), [`affine`](Solid::affine) | affine ones |
//! | [`on_ground`](Solid::on_ground), [`centered`](Solid::centered), [`aligned`](Solid::aligned), [`rotate_around`](Solid::rotate_around) | placing by boxes and points |
//! | [`reflect`](Solid::reflect), [`mirrored`](Solid::mirrored) | the mirror image alone, and beside the solid |
//! | [`repeat`](Solid::repeat), [`repeat_linear`](Solid::repeat_linear), [`repeat_polar`](Solid::repeat_polar) | grids, rows and rings of copies; [`repeat_centered`](Solid::repeat_centered) about the solid's own place |
//! | [`elongate`](Solid::elongate) | straight pieces inserted |
//! | [`taper`](Solid::taper), [`twist`](Solid::twist), [`bend`](Solid::bend), [`bend_between`](Solid::bend_between) | Barr's deformations; the last with straight ends |
//! | [`taper_by`](Solid::taper_by), [`twist_by`](Solid::twist_by) | by any [`Law`] of z, of a factor and of what an angle is multiplied by: [`LinearLaw`], [`SmoothStep`], [`SineWave`], [`LawTable`], a number, your own |
//!
//! ## Explicit surfaces
//!
//! Without a field or a grid:
//!
//! | | |
//! |---|---|
//! | [`ParametricSurface::of`] | of a leaf: points, tangents, exact normals by two parameters |
//! | [`ParametricSurface::mesh`], [`quad_mesh`](surface::ParametricSurface::quad_mesh) | closed triangles and quadrilaterals, by angles, by lengths or within a tolerance ([`Spacing`]) |
//! | [`ParametricSurface::sample`] | points uniform by area |
//! | [`ParametricCurve`] | the same of plane curves |
//! | [`Superellipsoid::points`], [`Superellipse::points`] | points by Franklin and Barr's methods ([`PointMethod`]) |
//! | [`ControlPolygon`], [`SubdivisionRevolution`], [`ControlGrid`] | subdivision: conics, quadrics, free forms |
//!
//! A single primitive as a mesh is best made so: exact points and normals, texture coordinates, few
//! triangles. What is joined, blended or lacks a patch is meshed from its field ([`Solid::mesh`]).
//! Subdivision is for curves and surfaces that are shaped by points.
//!
//! ## Depth buffers
//!
//! Depths, pictures and range images of meshes joined by CSG, without any field:
//!
//! | | |
//! |---|---|
//! | [`ClosedMesh`] | a mesh that encloses a solid; [`Mesh::affine`], [`taper`](Mesh::taper), [`twist`](Mesh::twist) and [`bend`](Mesh::bend) move and deform it |
//! | [`RasterView`] | a camera and its picture; the [`layers`](raster::RasterView::layers) of a mesh in it |
//! | [`RasterView::csg`] | the depth buffer of a tree of operands ([`Csg`]) by one of three methods ([`CsgMethod`] says which, and when rays are better) |
//! | [`Buffers`] | depth, stencil and ids; passes to go step by step; [`picture`](raster::Buffers::picture), [`range_image`](raster::Buffers::range_image) |
//! | [`LayerSource`] | operands that are no meshes |
//!
//! ## Solids as values
//!
//! | | |
//! |---|---|
//! | [`named`](Solid::named) | the name that errors, [`owner`](Solid::owner) and the tree speak of |
//! | [`Display`](Solid#impl-Display-for-Solid) | the solid as an indented tree |
//! | [`paint`](Solid::paint) | its colour, in pictures and meshes |
//! | [`==`](Solid#impl-PartialEq-for-Solid), `Hash` | by structure: solids may be keys of a map |
//! | [`simplified`](Solid::simplified) | the same values from fewer nodes |
//! | [`form`](Solid::form) | what it is at its root, with parameters and operands ([`Form`]) |
//! | [`call`](Solid::call) | the same as an entry of the catalogue with values, which makes it again ([`Call`]) |
//! | [`to_rust`](Solid::to_rust) | the solid as Rust code that makes it again; several in a file: [`RustFile`] |
//! | [`catalogue`](catalogue()) | all that solids are made of, with parameters and their ranges ([`Entry`], [`Parameter`]) |
//!
//! # Conventions
//!
//! Lengths are in one unit, which is yours; angles have theirs in the type [`Angle`]; values are
//! positive inside. What is a full size and what a radius, which values are distances and how exact
//! they are on lanes is on a page of [conventions].
//!
//! # Below the verbs
//!
//! Under the verbs are the compiled [`Program`]s: narrowed to a region
//! ([`Program::narrow`]), run in bulk ([`Tape`], [`Evaluator`]). Your own leaf is a type that
//! implements [`Field`]; a solid can be handed to fidget with [`Solid::to_fidget`].
//!
//! [`Buffers`]: raster::Buffers
//! [`Call`]: catalogue::Call
//! [`ClosedMesh`]: raster::ClosedMesh
//! [`ControlGrid`]: subdivision::ControlGrid
//! [`ControlPolygon`]: subdivision::ControlPolygon
//! [`Csg`]: raster::Csg
//! [`CsgMethod`]: raster::CsgMethod
//! [`Entry`]: catalogue::Entry
//! [`Evaluator`]: program::Evaluator
//! [`Field`]: field::Field
//! [`Form`]: form::Form
//! [`Law`]: law::Law
//! [`LawTable`]: law::LawTable
//! [`LayerSource`]: raster::LayerSource
//! [`LinearLaw`]: law::LinearLaw
//! [`Parameter`]: catalogue::Parameter
//! [`ParametricCurve`]: surface::ParametricCurve
//! [`ParametricSurface::mesh`]: surface::ParametricSurface::mesh
//! [`ParametricSurface::of`]: surface::ParametricSurface::of
//! [`ParametricSurface::sample`]: surface::ParametricSurface::sample
//! [`PointMethod`]: points::PointMethod
//! [`Program`]: program::Program
//! [`Program::narrow`]: program::Program::narrow
//! [`RasterView`]: raster::RasterView
//! [`RasterView::csg`]: raster::RasterView::csg
//! [`RustFile`]: code::RustFile
//! [`SineWave`]: law::SineWave
//! [`SmoothStep`]: law::SmoothStep
//! [`Spacing`]: surface::Spacing
//! [`SubdivisionRevolution`]: subdivision::SubdivisionRevolution
//! [`Tape`]: program::Tape

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[macro_use]
mod picture;

pub mod camera;
pub mod catalogue;
pub mod code;
pub mod conventions;
mod distance;
pub mod error;
mod eval;
pub mod field;
pub mod fit;
pub mod form;
mod geom;
pub mod idioms;
pub mod io;
pub mod law;
pub mod layers;
pub mod lengths;
mod measure;
pub mod measuring;
mod mesh;
pub mod parts;
pub mod points;
pub mod program;
mod query;
pub mod range_image;
pub mod raster;
mod render;
pub mod scans;
mod solid;
mod space;
pub mod subdivision;
pub mod surface;
pub mod volume;

#[cfg(feature = "formula")]
pub use fidget;
pub use glam;

pub use catalogue::catalogue;
pub use eval::{Accuracy, Hit, Owner};
pub use geom::{Camera, Contours, Image, Mesh, Outline, Plane, PointCloud, Polyline, ThinPlace, ThinReport, View};
#[cfg(feature = "import")]
pub use io::LoadSettings;
pub use io::save::SaveSettings;
pub use io::unit::LengthUnit;
pub use measure::{Clearance, MeasureReport, ThicknessBin, ThicknessReport};
pub use mesh::{AtBounds, CellSize, Component, Features, MeshReport, MeshSettings, OpenEdges, ThinFeatures};
pub use query::Face;
pub use render::{
    Background, ContourSettings, Lights, Quality, RenderSettings, Scene, Side, Slice, SliceSettings, Style,
};
#[cfg(feature = "formula")]
#[doc(inline)]
pub use rvachev_field::Formula;
#[doc(inline)]
pub use rvachev_field::{
    Blend, Caps, Capsule, Circle, Cone, Cuboid, Cylinder, Ellipsoid, GeneralisedSuperquadric, Gielis, Grading,
    HalfSpace, MinimalSurface, NetworkLattice, ParamError, Polygon, Prism, Pyramid, RFunction, Radius, Rectangle,
    RegularPolygon, RoundedCuboid, SheetLattice, Slab, Sphere, Superellipse, Superellipsoid, Superhyperboloid,
    Superpolygon, Supershape, Supertoroid, Torus, Turns, Wedge,
};
#[doc(inline)]
pub use rvachev_num::{Angle, Bounds, CancelToken, Cancelled, Interval, Progress, Run, deg, rad, turns};
pub use solid::{Extrusion, Helix, MeshSolid, Paint, PlaneBounds, Profile, Solid, SolidError};

// What the modules below call by its name alone.
use {
    catalogue::{Parameter, Range, Unit, Value, ValueError},
    error::{CameraError, ImageError, MeshError, SaveError},
    eval::Palette,
    field::{COORDINATE_LIMIT, Dual, Field, Jet, Norm, Real},
    form::{Form, Operation, Repetition},
    geom::{Projection, RangeImage, RangeImageError, Rays},
    law::{BuiltInLaw, Law, LawTable, LinearLaw, SineWave, SmoothStep},
};
