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
//! use rvachev::{deg, Solid};
//!
//! let head = Solid::cylinder(8.0, 6.0).named("head");
//! let socket = Solid::cuboid([5.0, 5.0, 8.0]).rotate_z(deg(45.0)).named("socket");
//! let screw = head - socket;
//! assert_eq!(screw.owner([3.0, 0.0, 0.0])?.path, "difference[1] / socket: rotate_z / box");
//! assert_eq!(screw.to_string(), "\
//! difference by P(2.0)
//!   head: cylinder { radius: 8.0, height: 6.0 }
//!   socket: rotate_z 45° about (0, 0, 1)
//!     box { size: DVec3(5.0, 5.0, 8.0) }");
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 3. Mirrored pairs
//!
//! [`mirrored_x`](crate::Solid::mirrored_x) is the part with its image beside it,
//! [`reflect_x`](crate::Solid::reflect_x) the image alone; [`mirrored`](crate::Solid::mirrored)
//! and [`reflect`](crate::Solid::reflect) take any plane. The part is stored once.
//!
//! ```
//! use rvachev::Solid;
//!
//! let ear = Solid::cylinder(6.0, 4.0) - Solid::cylinder(3.0, 5.0);
//! let bracket = Solid::cuboid([32.0, 8.0, 4.0]) | ear.translate([20.0, 0.0, 0.0]).mirrored_x();
//! assert!(bracket.contains([25.0, 0.0, 0.0])? && bracket.contains([-25.0, 0.0, 0.0])?);
//! assert!(!bracket.contains([-20.0, 0.0, 0.0])?);
//!
//! let right_hand = Solid::torus(8.0, 2.0) & Solid::half_space([0.6, 0.8, 0.0], 0.0);
//! let left_hand = right_hand.reflect_x();
//! assert_eq!(right_hand.value([-8.0, 0.0, 0.0])?, left_hand.value([8.0, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 4. Rows and rings of parts
//!
//! Equal parts at equal distances are repeated: [`repeat_linear`](crate::Solid::repeat_linear)
//! makes a row, [`repeat`](crate::Solid::repeat) a grid,
//! [`repeat_polar`](crate::Solid::repeat_polar) a ring. Space is folded onto one part, so that a
//! thousand cost what two do. Parts that differ, or stand unevenly, come from a loop or an
//! iterator: [`union_all`](crate::Solid::union_all) and
//! [`difference_all`](crate::Solid::difference_all) join them at once, regions far from a part
//! never see it, and what the loop leaves behind, [`simplified`](crate::Solid::simplified)
//! tidies.
//!
//! ```
//! use rvachev::{deg, RFunction, Solid};
//!
//! let hole = Solid::cylinder(3.0, 20.0).translate([25.0, 0.0, 0.0]);
//! let flange = Solid::cylinder(35.0, 10.0) - hole.repeat_polar(8);
//! assert!(!flange.contains([0.0, -25.0, 0.0])?);
//! // Eight holes for the price of two.
//! assert_eq!(flange.surface_program()?.leaf_count(), 3);
//!
//! // Holes that grow from one to the next.
//! let holes = (0..8).map(|i| {
//!     let hole = Solid::cylinder(1.0 + 0.3 * f64::from(i), 20.0).translate([25.0, 0.0, 0.0]);
//!     hole.rotate_z(deg(45.0 * f64::from(i)))
//! });
//! let dial = Solid::cylinder(35.0, 10.0).difference_all(holes, RFunction::MIN_MAX);
//! assert!(dial.contains([25.0, 2.0, 0.0])? && !flange.contains([25.0, 2.0, 0.0])?);
//! assert!(dial.simplified().node_count() < dial.node_count());
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 5. Parts as functions of their parameters
//!
//! A family of parts is a function; its solids are compared and used as keys by what they
//! are made of.
//!
//! ```
//! use rvachev::{deg, Solid};
//!
//! /// A knob with `lobes` grips, for a shaft of the given radius.
//! fn knob(radius: f64, lobes: u32, shaft: f64) -> Solid {
//!     let mut knob = Solid::superellipsoid([radius, radius, 0.4 * radius], 0.3, 1.0);
//!     for i in 0..lobes {
//!         let grip = Solid::cylinder(0.25 * radius, radius).translate([1.1 * radius, 0.0, 0.0]);
//!         knob -= grip.rotate_z(deg(360.0 * f64::from(i) / f64::from(lobes)));
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
//! A [`Blend`](crate::Blend) shapes the transition between operands. `Fillet`, `Chamfer` and
//! `Smooth` take a length. A fillet and a chamfer are of that size whatever the operands are, and
//! stay below flush faces. A smooth blend reads the operands' own values, and rises above flush
//! faces. [`rounded`](crate::Solid::rounded) and [`filleted`](crate::Solid::filleted) treat all
//! edges of a solid at once: see [`lengths`](crate::lengths).
//!
//! ```
//! use rvachev::{deg, Blend, Solid};
//!
//! let plate = Solid::cuboid([60.0, 40.0, 6.0]);
//! let post = Solid::cylinder(8.0, 20.0).translate([0.0, 0.0, 10.0]);
//! let filleted = plate.union_with(&post, Blend::Fillet { radius: 3.0 });
//! let chamfered = plate.union_with(&post, Blend::Chamfer { leg: 3.0 });
//! // In the corner between post and plate:
//! let corner = [8.5, 0.0, 3.5];
//! assert!(filleted.contains(corner)? && chamfered.contains(corner)?);
//! assert!(!(&plate | &post).contains(corner)?);
//!
//! // A hole with rounded rims.
//! let hole = Solid::cylinder(4.0, 50.0);
//! let bored = filleted.difference_with(hole, Blend::Fillet { radius: 1.0 });
//! assert!(!bored.contains([4.2, 0.0, 19.9])? && bored.contains([4.2, 0.0, 15.0])?);
//!
//! // All edges: inner ones filled, outer ones rounded.
//! let cast = (&plate | &post).filleted(3.0).rounded(1.0);
//! assert!(cast.contains(corner)? && !cast.contains([29.9, 19.9, 0.0])?);
//!
//! // Two limbs that flow into one another.
//! let limb = Solid::capsule(5.0, 40.0);
//! let branch = limb.rotate_y(deg(50.0)).translate([15.3, 0.0, 12.9]);
//! let coral = limb.smooth_union(&branch, 4.0);
//! assert!(coral.contains([5.2, 0.0, 11.2])? && !(limb | branch).contains([5.2, 0.0, 11.2])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 7. Shells and offsets
//!
//! [`shell`](crate::Solid::shell) leaves a wall, [`offset`](crate::Solid::offset) moves the
//! surface; both are by the true distance to the surface, whatever the field is below. Where parts
//! are joined there is no surface, and no wall.
//!
//! ```
//! use rvachev::Solid;
//!
//! // A tray: a hollow superellipsoid without its top.
//! let body = Solid::superellipsoid([30.0, 20.0, 12.0], 0.3, 0.3);
//! let tray = body.shell(2.0) - Solid::cuboid([70.0, 50.0, 10.0]).translate([0.0, 0.0, 12.0]);
//! assert!(tray.contains([29.0, 0.0, 0.0])?);
//! assert!(!tray.contains([27.0, 0.0, 0.0])? && !tray.contains([29.0, 0.0, 8.0])?);
//!
//! // A block with a pocket for it, 0.2 larger on every side.
//! let block = Solid::cuboid([80.0, 60.0, 24.0]) - body.offset(0.2);
//! assert!(!block.contains([30.1, 0.0, 0.0])? && block.contains([30.3, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 8. Profiles
//!
//! What is drawn in the plane is a [`Profile`](crate::Profile): joined and moved like a solid,
//! then [extruded](crate::Profile::extrude_with), [revolved](crate::Profile::revolve) or
//! [swept along a helix](crate::Profile::sweep_helix).
//!
//! ```
//! use rvachev::{Caps, Extrusion, Helix, Polygon, Profile, Solid};
//!
//! // A frame, its edges broken.
//! let outline = [[-20.0, -15.0], [20.0, -15.0], [20.0, 10.0], [-20.0, 15.0]];
//! let window = [[-14.0, -9.0], [14.0, -9.0], [14.0, 5.0], [-14.0, 8.0]];
//! let frame = Profile::from(Polygon::new([outline, window]));
//! let frame = frame.extrude_with(&Extrusion { caps: Caps::Chamfered(1.0), ..Extrusion::new(6.0) });
//! assert!(frame.contains([17.0, 0.0, 2.9])? && !frame.contains([0.0, 0.0, 0.0])?);
//! assert!(!frame.contains([19.8, 0.0, 2.9])?);
//!
//! // A vase: x is the distance from the axis, y becomes z. The section reaches across the axis.
//! let section = Profile::polygon([[-6.0, -10.0], [6.0, -10.0], [4.0, 0.0], [7.0, 10.0], [-7.0, 10.0], [-4.0, 0.0]]);
//! let vase = section.revolve().shell(0.8) - Solid::cylinder(6.0, 4.0).translate([0.0, 0.0, 10.0]);
//! assert!(vase.contains([0.0, 3.7, 0.0])? && !vase.contains([0.0, 0.0, 0.0])?);
//!
//! // A thread: the section of its ridge, wound round a rod.
//! let ridge = Profile::polygon([[-0.5, -1.0], [0.8, -0.2], [0.8, 0.2], [-0.5, 1.0]]);
//! let screw = Solid::cylinder(5.0, 24.0) | ridge.sweep_helix(&Helix::new(5.0, 2.0, 10.0));
//! assert!(screw.contains([5.7, 0.0, 0.0])? && !screw.contains([-5.7, 0.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # 9. A leaf of one's own
//!
//! Any formula that is positive inside becomes a leaf: it prunes, meshes and runs on lanes as
//! the built-in ones. A `From` for it lets it stand where a solid is taken.
//!
//! ```
//! use glam::DVec3;
//! use rvachev::field::{Field, Real};
//! use rvachev::{Bounds, ParamError, Solid};
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
//! use rvachev::{deg, Background, Camera, RenderSettings, Solid};
//!
//! let ring = Solid::cylinder(5.0, 3.0) - Solid::cylinder(3.5, 4.0);
//! let settings = RenderSettings {
//!     width: 64,
//!     height: 48,
//!     paint: [200, 160, 60].into(),
//!     background: Background::Transparent,
//!     ground: false,
//!     ..RenderSettings::default()
//! };
//! let from_above = Camera::perspective([0.0, -12.0, 14.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], deg(35.0));
//! let image = ring.render(&from_above, &settings)?;
//! // One looks through the hole.
//! assert_eq!(image.pixel(32, 24).map(|p| p[3]), Some(0));
//! let path = std::env::temp_dir().join("rvachev_idiom.png");
//! image.save(&path)?;
//! # std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
