//! Whole parts, or reverse engineering: from a mesh or a scan to a CSG tree that one can edit.
//!
//! [`fit::part`](crate::fit::part()) takes the mesh of a part,
//! [`fit::part_of_points`](crate::fit::part_of_points()) the points of a scan. Both give a
//! [`PartFit`](crate::fit::PartFit): leaves such as boxes, cylinders and profiles, added and cut
//! one after the other, holes included; and code that makes it.
//!
//! | question | answer |
//! |---|---|
//! | what is it made of? | [`leaves`](crate::fit::PartFit::leaves), each with a name, a [text](crate::fit::PartLeaf::text) and its share of the surface; equal ones by a rule are [`patterns`](crate::fit::PartFit::patterns) |
//! | how good is it? | [`iou`](crate::fit::PartFit::iou), [`deviation`](crate::fit::PartFit::deviation), [`topology`](crate::fit::PartFit::topology) beside that of the input; [`times`](crate::fit::PartFit::times) |
//! | what is missing? | [`unexplained`](crate::fit::PartFit::unexplained): places and volumes |
//! | what was it meant to be? | [`snaps`](crate::fit::PartFit::snaps): numbers that were made round; [`without_snaps`](crate::fit::PartFit::without_snaps) refuses some |
//! | may I have it as code? | [`to_rust`](crate::fit::PartFit::to_rust) |
//!
//! The example `reverse_engineer` prints the leaves, IoU, topology, what is missing and the code
//! for a file; the example `parts` makes the pictures of this page.
//!
//! # A mesh in millimetres
//!
#![doc = picture!("parts_flange" = "docs/parts/flange.png")]
//!
//! *Left: the mesh. Right: the tree that was found, a colour a leaf.*
//!
//! A flange with a pipe, bored through, and six holes. The mesh is of chords that are within 0.02
//! of the surface, and that is all that is given. What comes out are the numbers that went in: they
//! are round, so they are meant.
//!
//! ```
//! use rvachev::fit::{PartSettings, part};
//! use rvachev::{CellSize, MeshSettings, Solid};
//!
//! let disc = Solid::cylinder(30.0, 8.0) | Solid::cylinder(12.0, 30.0).translate([0.0, 0.0, 15.0]);
//! let holes = Solid::cylinder(3.5, 20.0).translate([22.0, 0.0, 0.0]).repeat_polar(6);
//! let flange = disc - Solid::cylinder(8.0, 80.0) - holes;
//! let mesh = flange.mesh(&MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() })?;
//!
//! let found = part(&mesh, &PartSettings::default())?;
//! assert!(found.iou() > 0.998 && found.topology() == found.topology_of_input());
//! assert_eq!(
//!     found.to_rust("flange"),
//!     r#"use rvachev::{RFunction, Solid};
//!
//! pub fn flange() -> Solid {
//!     let length = 8.0;
//!     let z = 13.0;
//!     // cylinder, ⌀ 60, 8 high; 54.8 % of the surface
//!     let cylinder_1 = Solid::cylinder(30.0, length).named("cylinder 1");
//!     // cylinder, ⌀ 24, 34 high; 20.1 % of the surface
//!     let cylinder_2 = Solid::cylinder(12.0, 34.0)
//!         .translate([0.0, 0.0, z])
//!         .named("cylinder 2");
//!     // hole, ⌀ 16, through; 15.5 % of the surface
//!     let cut_cylinder_1 = Solid::cylinder(length, 36.0)
//!         .translate([0.0, 0.0, z])
//!         .named("cut cylinder 1");
//!     // hole, ⌀ 7, through, 6 of them on a circle, ⌀ 44; 9.6 % of the surface
//!     let cut_cylinder_2 = Solid::cylinder(3.5, 10.0)
//!         .translate([22.0, 0.0, 0.0])
//!         .named("cut cylinder 2");
//!     let union = cylinder_1.union(cylinder_2, RFunction::MIN_MAX);
//!     let parts = [cut_cylinder_1, cut_cylinder_2.repeat_polar(6)];
//!     union.difference_all(parts, RFunction::MIN_MAX)
//! }
//! "#
//! );
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A mesh in inches
//!
#![doc = picture!("parts_bracket" = "docs/parts/bracket.png")]
//!
//! *Left: the mesh of a bracket. Right: its tree.*
//!
//! The lengths are binary fractions of an inch, though the unit is a millimetre: the scale is
//! chosen on which the part's numbers are shortest. The six counterbored holes are two patterns.
//!
//! ```
//! # use rvachev::fit::{PartSettings, part};
//! # use rvachev::{CellSize, MeshSettings, Solid, deg};
//! # let inch = 25.4;
//! # let foot = Solid::cuboid([4.0 * inch, 2.5 * inch, 0.5 * inch]);
//! # let back = Solid::cuboid([4.0 * inch, 0.5 * inch, 2.0 * inch]).translate([0.0, 1.0 * inch, 1.0 * inch]);
//! # let bore = |radius: f64, height: f64, z: f64| {
//! #     let one = Solid::cylinder(radius * inch, height * inch).translate([-1.5 * inch, -0.875 * inch, z * inch]);
//! #     one.repeat_linear(3, [1.5 * inch, 0.0, 0.0]).repeat_linear(2, [0.0, 1.0 * inch, 0.0])
//! # };
//! # let window = Solid::cylinder(0.5 * inch, 2.0 * inch).rotate_x(deg(90.0)).translate([0.0, inch, 1.25 * inch]);
//! # let bracket = (foot | back) - bore(0.125, 2.0, 0.0) - bore(0.25, 0.5, 0.375) - window;
//! # let mesh = bracket.mesh(&MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() })?;
//! let found = part(&mesh, &PartSettings::default())?;
//! assert_eq!(
//!     found.to_rust("bracket"),
//!     r#"use rvachev::{RFunction, Solid, deg};
//!
//! pub fn bracket() -> Solid {
//!     let offset = 22.225;
//!     let length = 12.7;
//!     let cut_cylinder_1_length = 25.4;
//!     let cut_cylinder_2_length = 38.1;
//!     // block, 101.6 × 63.5 × 57.15; 58.7 % of the surface
//!     let box_1 = Solid::cuboid([101.6, 63.5, 57.15])
//!         .translate([0.0, 0.0, offset])
//!         .named("box 1");
//!     // corner cut off, 50.8 deep, 44.45 deep, through; 29.2 % of the surface
//!     let cut_box_1 = Solid::cuboid([104.775, 52.3875, 46.0375])
//!         .translate([0.0, -7.14375, 29.36875])
//!         .named("cut box 1");
//!     // hole, ⌀ 25.4, through; 3.5 % of the surface
//!     let cut_cylinder_1 = Solid::cylinder(length, 15.875)
//!         .rotate_x(deg(-90.0))
//!         .translate([0.0, cut_cylinder_1_length, 31.75])
//!         .named("cut cylinder 1");
//!     let offset_2 = [-cut_cylinder_2_length, -offset, 5.55625];
//!     // hole, ⌀ 12.7, 3.175 deep, 3 × 2 of them in a grid, 38.1 × 25.4 apart; 4.6 % of the surface
//!     let cut_cylinder_2 = Solid::cylinder(6.35, 4.7625)
//!         .translate(offset_2)
//!         .named("cut cylinder 2");
//!     let offset_3 = [-cut_cylinder_2_length, -offset, -1.5875];
//!     // hole, ⌀ 6.35, through, 3 × 2 of them in a grid, 38.1 × 25.4 apart; 4.0 % of the surface
//!     let cut_cylinder_5 = Solid::cylinder(3.175, length)
//!         .translate(offset_3)
//!         .named("cut cylinder 5");
//!     let cut_cylinder_2s = cut_cylinder_2
//!         .repeat_linear(3, [cut_cylinder_2_length, 0.0, 0.0])
//!         .repeat_linear(2, [0.0, cut_cylinder_1_length, 0.0]);
//!     let cut_cylinder_5s = cut_cylinder_5
//!         .repeat_linear(3, [cut_cylinder_2_length, 0.0, 0.0])
//!         .repeat_linear(2, [0.0, cut_cylinder_1_length, 0.0]);
//!     let parts = [cut_box_1, cut_cylinder_1, cut_cylinder_2s, cut_cylinder_5s];
//!     box_1.difference_all(parts, RFunction::MIN_MAX)
//! }
//! "#
//! );
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A scan
//!
#![doc = picture!("parts_housing" = "docs/parts/housing.png")]
//!
//! *Left: points of a housing with noise. Right: the tree.*
//!
//! The points are off the surface by 0.15 on the average of squares, 0.2 % of the diagonal. No
//! vertex tells a length exactly here, so no number is made round: they are what fits the points
//! best.
//!
//! ```
//! use rvachev::PointCloud;
//! use rvachev::fit::{PartSettings, part_of_points};
//! # use rvachev::{CellSize, MeshSettings, Solid};
//!
//! # let block = Solid::cuboid([60.0, 44.0, 24.0]);
//! # let pocket = Solid::cuboid([48.0, 32.0, 24.0]).translate([0.0, 0.0, 8.0]);
//! # let boss = Solid::cylinder(9.0, 16.0).translate([8.0, 0.0, -2.0]);
//! # let housing = ((block - pocket) | boss) - Solid::cylinder(5.0, 60.0).translate([8.0, 0.0, 0.0]);
//! # let mesh = housing.mesh(&MeshSettings { cell: CellSize::LongestSide(48), ..MeshSettings::default() })?;
//! # let normals = mesh.normals().expect("a mesh of a solid has normals");
//! # let points = (0_u32..).zip(mesh.positions()).map(|(i, p)| {
//! #     let t = |k: f64| (f64::from(i) * k).fract() - 0.5;
//! #     let off = 2.0 * 0.15 * (t(0.754_877_666) + t(0.569_840_291) + t(0.381_966_011));
//! #     p.as_dvec3() + off * normals[i as usize].as_dvec3()
//! # });
//! # let (points, normals) = (points.collect(), normals.to_vec());
//! let cloud = PointCloud::new(points)?.with_normals(normals)?;
//! let found = part_of_points(&cloud, &PartSettings::default())?;
//! assert!(found.iou() > 0.96, "{}", found.iou());
//! let texts: Vec<&str> = found.leaves().iter().map(|leaf| leaf.text()).collect();
//! // 60 × 44 × 24 within the noise, and the bore goes through block and boss.
//! assert!(texts[0].starts_with("block, 60.0") && texts[3].ends_with("through"), "{texts:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Beside published methods
//!
//! | method | input | IoU | leaves | holes | code | time |
//! |---|---|---|---|---|---|---|
//! | [`part`](crate::fit::part()) | meshes of 14 CAD parts, of as few as 12 facets | 0.96 to 1.00 | 1 to 8, and some 34 of one | cut leaves | yes | 0.1 to 2 s |
//! | [`part_of_points`](crate::fit::part_of_points()) | clouds of 4000 points, 0.2 % noise, with normals or without | 0.99 in the middle | some 10 | cut leaves | yes | 1 to 2 s |
//! | Marching-Primitives (W. Liu et al., 2023) | grids of signed distances | 0.93 to 0.98 | 7 to 77 superquadrics | none | no | 1 to 21 s |
//! | SuperFit (2026) | meshes | 0.90 | 24 superquadrics | none: "purely additive" | no | minutes |
//! | [`supershape_union`](crate::fit::supershape_union()), the pipeline of rational supershapes | points by segments | 0.96 to 1.00 of simple CAD parts, 0.15 to 0.95 of those with many small holes | one a segment | by the error's clusters | yes | seconds |
//!
//! What others have is from their own papers, on parts of their own: organic bodies among them,
//! which trees of few exact leaves do not suit. The table of the CAD parts one by one is at
//! [`part`](crate::fit::part()).
//!
//! # What not to expect
//!
//! * **Fillets, sweeps, threads, lattices** are not found: a fillet becomes a sharp edge, or a
//!   small cylinder where it is worth its numbers. Outlines have up to 32 corners, with straight
//!   sides or arcs between them: no splines.
//! * **Few facets:** the radius of a cylinder of facets is that of its corners, so a solid that is
//!   right has more volume than the mesh: an IoU of 0.96 with a thin tube of 36 facets.
//! * **Intent** is told from round numbers, equal lengths and patterns only. That a hole is so far
//!   from an edge, or two planes in the middle between others, is not.
//! * **Order:** a tree is one of many that make the same solid. The one with the fewest numbers
//!   that was found need not be the one that the part was drawn by.
//! * **Small holes** count more than their volume, down to some 0.5 % of the diagonal. What is
//!   smaller may be left out; [`unexplained`](crate::fit::PartFit::unexplained) tells of places
//!   with more than a thousandth of the volume.
//! * **Scans** need not show all sides. Space that no point tells of costs nothing, and leaves go
//!   on there. [`seen`](crate::fit::PartLeaf::seen) says how much of a leaf there are points of;
//!   [`is_guess`](crate::fit::PartLeaf::is_guess) marks leaves of which most is not seen.
