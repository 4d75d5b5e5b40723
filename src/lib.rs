//! Implicit-function (F-rep) solid modelling: superquadrics, supershapes and exact primitives,
//! joined by R-functions, deformed, meshed and ray-marched.
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
//! Building never fails. What is wrong is said when the solid is first used, with the path to
//! the node, the parameter, its value and what is allowed.
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
//! Maps deform: any affine one, [taper](Solid::taper), [twist](Solid::twist),
//! [bend](Solid::bend).
//!
//! ```
//! use glam::DVec3;
//! use rvachev::Solid;
//!
//! let drill = Solid::cuboid(DVec3::new(2.0, 1.0, 10.0)).twist(0.5);
//! assert!(drill.bounds()?.max.x < 1.2);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! Questions are answered in double precision: [value](Solid::value),
//! [gradient](Solid::gradient), [range](Solid::range) over a box,
//! [raycast](Solid::raycast), [closest point](Solid::closest_surface_point),
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
//! [Twelve idioms](idioms) show how things are commonly built: plates with holes, named parts,
//! rings of parts, leaves of one's own.
//!
//! # Accuracy in single precision
//!
//! Lanes of `f32` against double precision, relative to the size of the leaf plus `|f|`, from
//! the centre to ten sizes away, axis planes and exact zeros included; sizes 10⁻³ to 10³. The
//! bounds hold in the tests, which print what they find.
//!
//! | leaf | bound | found |
//! |---|---|---|
//! | superellipsoid, exponents 0.05 to 2.5 | 4·10⁻⁶ | 3.2·10⁻⁷ |
//! | sphere, box, cylinder, half-space | 4·10⁻⁶ | 5.0·10⁻⁷ |
//! | supertoroid, exponents 0.05 to 2; superhyperboloid, 0.05 to 2.5; generalised superquadric, 0.5 to 60 | 4·10⁻⁶ | 3.5·10⁻⁷ |
//! | rounded box, capsule, cone, torus, ellipsoid, prism, pyramid, wedge, slab | 4·10⁻⁶ | within |
//! | supershape, m up to 12, n2 and n3 at least 1 | 4·10⁻⁶ times max(n2, n3)/n1, at least 4·10⁻⁶ | within |
//!
//! # Below the verbs
//!
//! Under the verbs are the compiled [`Program`]s: narrowed to a region
//! ([`Program::narrow`]), run in bulk ([`Tape`], [`Evaluator`]). Your own leaf is a type that
//! implements [`Field`]; a solid can be handed to fidget with [`Solid::to_fidget`].

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod bounds;
mod eval;
mod field;
mod geom;
pub mod idioms;
mod io;
mod mesh;
mod num;
mod render;
mod run;
mod solid;
mod space;

pub use bounds::Bounds;
pub use eval::{Evaluator, Gradients, Hit, Owner, Program, Region, Tape};
pub use field::{
    Blend, COORDINATE_LIMIT, Capsule, Circle, Cone, Cuboid, Cylinder, Ellipsoid, Field, Formula, FormulaError,
    GeneralisedSuperquadric, Gielis, Grading, HalfSpace, Kernel, Law, LawTable, LinearLaw, MinimalSurface,
    NetworkLattice, ParamError, Polygon, Prism, Pyramid, RFunction, Radius, Rectangle, RegularPolygon, RoundedCuboid,
    SheetLattice, SineWave, Slab, SmoothStep, Sphere, Superellipse, Superellipsoid, Superhyperboloid, Superpolygon,
    Supershape, Supertoroid, Torus, Turns, VALUE_LIMIT, Wedge,
};
pub use geom::{Camera, CameraError, Image, ImageError, Mesh, MeshError, Projection, Rays};
pub use io::{SaveError, write_png, write_stl};
pub use mesh::{CellSize, Lattice, LatticeError, MeshReport, MeshSettings, MeshingError};
pub use num::{Dual, Interval, Monotone, Monotone3, Norm, Real};
pub use render::{Background, RenderError, RenderSettings};
pub use run::{CancelToken, Cancelled, Progress, Run};
pub use solid::{Caps, Extrusion, Helix, PlaneBounds, Profile, Solid, SolidError};
