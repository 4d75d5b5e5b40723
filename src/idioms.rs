//! Twelve idioms: how things are commonly built, asked, meshed and drawn.
//!
//! A vector may be an array `[x, y, z]` or a tuple of `f64`, a [`DVec3`](glam::DVec3), a
//! [`Vec3`](glam::Vec3), [`IVec3`](glam::IVec3) or [`UVec3`](glam::UVec3): whatever glam
//! converts to `DVec3`. Numbers in arrays and tuples are written as floating-point ones,
//! `[1.0, 0.0, 0.0]`. A solid may be a [`Solid`](crate::Solid), a reference to one, or a leaf
//! such as [`Cylinder`](crate::Cylinder).
//!
//! # 1. A plate with holes
//!
//! Operators take a solid on the left and anything that becomes one on the right. On the left
//! a leaf is converted: `Solid::from(leaf)`.
//!
//! ```
//! use rvachev::{Cylinder, Solid};
//!
//! let mut plate = Solid::cuboid([80.0, 50.0, 6.0]) - Cylinder { radius: 12.0, height: 10.0 };
//! for x in [-32.0, 32.0] {
//!     for y in [-17.0, 17.0] {
//!         plate -= Solid::cylinder(2.7, 10.0).translate([x, y, 0.0]);
//!     }
//! }
//! assert!(plate.contains([25.0, 0.0, 0.0])?);
//! assert!(!plate.contains([32.0, -17.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 2. Parts with names
//!
//! [`named`](crate::Solid::named) parts are called so by errors, by
//! [`owner`](crate::Solid::owner), and where the solid is written out as a tree.
//!
//! ```
//! use rvachev::Solid;
//!
//! let head = Solid::cylinder(8.0, 6.0).named("head");
//! let socket = Solid::cuboid([5.0, 5.0, 8.0]).rotate_z_degrees(45.0).named("socket");
//! let screw = head - socket;
//! assert_eq!(screw.owner([3.0, 0.0, 0.0])?.path, "difference[1] / socket: rotate_z_degrees / box");
//! assert_eq!(screw.to_string(), "\
//! difference by P(2.0)
//!   head: cylinder { radius: 8.0, height: 6.0 }
//!   socket: rotate_z_degrees 45° about (0, 0, 1)
//!     box { size: DVec3(5.0, 5.0, 8.0) }");
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 3. Mirrored pairs
//!
//! A mirror is a scaling by −1 along one axis. The part is stored once.
//!
//! ```
//! use rvachev::Solid;
//!
//! let ear = Solid::cylinder(6.0, 4.0).translate([20.0, 0.0, 0.0]) - Solid::cylinder(3.0, 5.0).translate([20.0, 0.0, 0.0]);
//! let bracket = Solid::cuboid([40.0, 8.0, 4.0]) | &ear | ear.scale_axes([-1.0, 1.0, 1.0]);
//! assert_eq!(bracket.contains([25.0, 0.0, 0.0])?, bracket.contains([-25.0, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 4. Rows and rings of parts
//!
//! A loop or an iterator makes the parts, [`union_all`](crate::Solid::union_all) and
//! [`difference_all`](crate::Solid::difference_all) join them at once; thousands are no
//! burden. What a loop leaves behind, [`simplified`](crate::Solid::simplified) tidies.
//!
//! ```
//! use rvachev::{RFunction, Solid};
//!
//! let hole = Solid::cylinder(3.0, 20.0).translate([25.0, 0.0, 0.0]);
//! let ring = (0..8).map(|i| hole.rotate_z_degrees(45.0 * f64::from(i)));
//! let flange = Solid::cylinder(35.0, 10.0).difference_all(ring, RFunction::MIN_MAX);
//! assert!(!flange.contains([0.0, -25.0, 0.0])?);
//! assert!(flange.simplified().node_count() < flange.node_count());
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! <!-- TODO after the merge: the mirror of idiom 3 by the mirror method of solid/transform.rs;
//! rows and rings here by linear and polar repetition, with a word on when to repeat (one
//! operand, evaluated once or twice a point) and when to loop (parts that differ). -->
//!
//! # 5. Parts as functions of their parameters
//!
//! A family of parts is a function; its solids are compared and used as keys by what they
//! are made of.
//!
//! ```
//! use rvachev::Solid;
//!
//! /// A knob with `lobes` grips, for a shaft of the given radius.
//! fn knob(radius: f64, lobes: u32, shaft: f64) -> Solid {
//!     let mut knob = Solid::superellipsoid([radius, radius, 0.4 * radius], 0.3, 1.0);
//!     for i in 0..lobes {
//!         let grip = Solid::cylinder(0.25 * radius, radius).translate([1.1 * radius, 0.0, 0.0]);
//!         knob -= grip.rotate_z_degrees(360.0 * f64::from(i) / f64::from(lobes));
//!     }
//!     (knob - Solid::cylinder(shaft, radius)).named(format!("knob of {lobes} lobes"))
//! }
//!
//! assert_eq!(knob(20.0, 6, 3.0), knob(20.0, 6, 3.0));
//! assert_ne!(knob(20.0, 6, 3.0), knob(20.0, 5, 3.0));
//! assert!(knob(20.0, 6, 3.0).contains([12.0, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 6. Fillets, chamfers and smooth blends
//!
//! <!-- TODO after the merge: a post on a plate with a fillet of radius 3, the same with a
//! chamfer, and a smooth union of two limbs; assert a point in the fillet that the sharp union
//! does not contain. One sentence on which joins take a radius in length units. -->
//!
//! # 7. Shells and offsets
//!
//! <!-- TODO after the merge: a superellipsoid box with walls of 2 by `shell`, opened by
//! cutting off its top; a clearance by `offset`; assert a point in the wall and one in the
//! hollow. One sentence on joins below an offset acting as min and max. -->
//!
//! # 8. Profiles
//!
//! <!-- TODO after the merge: a polygon with a hole, extruded with chamfered caps; a section
//! revolved to a vase; a section swept along a helix. Assert one point of each. -->
//!
//! # 9. A leaf of one's own
//!
//! Any formula that is positive inside becomes a leaf: it prunes, meshes and runs on lanes as
//! the built-in ones. A `From` for it lets it stand where a solid is taken.
//!
//! ```
//! use glam::DVec3;
//! use rvachev::{Bounds, Field, ParamError, Real, Solid};
//!
//! /// What two balls have in common, their centres at ±`offset` along z.
//! #[derive(Debug)]
//! struct Lens {
//!     radius: f64,
//!     offset: f64,
//! }
//!
//! impl Field for Lens {
//!     fn name(&self) -> &'static str {
//!         "lens"
//!     }
//!     #[inline(always)]
//!     fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
//!         let z = z.abs() + self.offset;
//!         -(x.square() + y.square() + z.square()).sqrt() + self.radius
//!     }
//!     fn bounds(&self) -> Bounds {
//!         let rim = (self.radius.powi(2) - self.offset.powi(2)).sqrt();
//!         Bounds::from_center(DVec3::ZERO, [rim, rim, self.radius - self.offset])
//!     }
//!     fn check(&self) -> Result<(), ParamError> {
//!         if self.offset >= 0.0 && self.offset < self.radius && self.radius < 1e9 {
//!             return Ok(());
//!         }
//!         Err(ParamError::new("offset", self.offset, "from 0 to below the radius, which is below 1e9"))
//!     }
//!     fn convex(&self) -> bool {
//!         true
//!     }
//! }
//!
//! impl From<Lens> for Solid {
//!     fn from(lens: Lens) -> Solid {
//!         Solid::new(lens)
//!     }
//! }
//!
//! let frame = Solid::cylinder(9.0, 4.0) - Lens { radius: 10.0, offset: 6.0 };
//! assert!(!frame.contains([7.0, 0.0, 0.0])? && frame.contains([8.5, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 10. Questions to a solid
//!
//! Answers are in double precision, and refusals say what is wrong and where.
//!
//! ```
//! use rvachev::{Bounds, Solid};
//!
//! let pipe = Solid::cylinder(5.0, 40.0) - Solid::cylinder(4.0, 50.0);
//! assert!(pipe.value([4.5, 0.0, 0.0])? > 0.0);
//! assert!(pipe.bounds()?.max.z >= 20.0);
//! let hit = pipe.raycast([10.0, 0.0, 0.0], [-1.0, 0.0, 0.0])?.expect("it is in the way");
//! assert!((hit.distance - 5.0).abs() < 1e-9 && hit.normal.x > 0.999);
//! let near = pipe.closest_surface_point([0.5, 0.0, 0.0])?.expect("it has a surface");
//! assert!((near.x - 4.0).abs() < 1e-6);
//! // Sound over a whole box: nothing of the pipe is in it.
//! assert!(pipe.range(&Bounds::new([-2.0, -2.0, -9.0], [2.0, 2.0, 9.0]))?.hi() < 0.0);
//!
//! let error = (pipe | Solid::sphere(-1.0).named("knob")).value([0.0, 0.0, 0.0]).unwrap_err();
//! assert!(error.to_string().starts_with("union[1] / knob: sphere: radius is -1, allowed: "));
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 11. A mesh, checked and saved
//!
//! ```
//! use rvachev::{CellSize, MeshSettings, Solid};
//!
//! let part = Solid::superellipsoid([4.0, 3.0, 2.0], 0.4, 0.6) - Solid::cylinder(1.0, 6.0);
//! let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() })?;
//! let report = mesh.check();
//! assert!(report.is_closed() && report.is_manifold());
//! assert!(mesh.volume() > 100.0);
//! let path = std::env::temp_dir().join("rvachev_idiom.stl");
//! mesh.save(&path)?;
//! # std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 12. A picture
//!
//! ```
//! use rvachev::{Background, Camera, RenderSettings, Solid};
//!
//! let ring = Solid::cylinder(5.0, 3.0) - Solid::cylinder(3.5, 4.0);
//! let settings = RenderSettings {
//!     width: 64,
//!     height: 48,
//!     color: [200, 160, 60],
//!     background: Background::Transparent,
//!     ..RenderSettings::default()
//! };
//! let from_above = Camera::perspective([0.0, -12.0, 14.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 35.0);
//! let image = ring.render(&from_above, &settings)?;
//! // One looks through the hole.
//! assert_eq!(image.pixel(32, 24).map(|p| p[3]), Some(0));
//! let path = std::env::temp_dir().join("rvachev_idiom.png");
//! image.save(&path)?;
//! # std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
