//! What is made, and what is measured: solids, meshes and numbers, and how far each may be off.
//!
//! A [`Solid`] is exact: a formula says of every point whether it is inside. All else is made of
//! it, or measured of it, with an error. This page says what there is, what the error is, and
//! whether it is certain.
//!
//! # What is made
//!
#![doc = picture!("measuring_made" = "docs/measuring/made.png")]
//!
//! *A solid; its mesh of cells of a tenth of its size, a millimetre and within a hundredth of one;
//! the mesh read back as a solid, hollowed and cut open.*
//!
//! | made of a solid | by | how far off the solid |
//! |---|---|---|
//! | a mesh | [`mesh`](Solid::mesh) with [`CellSize::Length`] | vertices by a thousandth of a cell, facets by about h²/8R: h the cell, R the radius of curvature; features thinner than a cell may be lost: [`Mesh::possibly_lost`] |
//! | a mesh within a tolerance | [`CellSize::Tolerance`] | what [`Mesh::deviation`] says |
//! | an offset, shell, fillet | [`lengths`](crate::lengths) | what [`accuracy`](Solid::accuracy) says; exact where the value is the distance |
//! | a slice, its contours | [`slice`](Solid::slice) | contours within the tolerance that they are asked for |
//! | a picture, a range image | [`render`](Solid::render) | the first point on a ray to 10⁻⁵ of the size; [drafts](crate::Quality::Draft) are as far off as their mesh |
//!
//! | becomes a solid | by | how far off |
//! |---|---|---|
//! | a mesh, of a file or of ours | [`Solid::from_mesh`] | its triangles, rounded to single precision; where it is open, a film across the opening |
//! | points of a scan | [`fit`](crate::fit) | what the fit reports |
//! | voxels | [`Solid::from_volume`] | marching cubes between the samples |
//!
//! ```
//! use rvachev::{CellSize, MeshSettings, MeshSolid, Solid};
//!
//! let part = Solid::cuboid([20.0, 12.0, 8.0]) - Solid::cylinder(3.0, 10.0);
//! let mesh = part.mesh(&MeshSettings { cell: CellSize::Tolerance(0.01), ..MeshSettings::default() })?;
//! // The other way round: what others have made is a solid like any other.
//! let read = Solid::from_mesh(&mesh, MeshSolid::default());
//! let hollow = read.shell(1.0);
//! assert!(hollow.contains([9.5, 0.0, 0.0])? && !hollow.contains([8.5, 0.0, 0.0])?);
//! # Ok::<(), rvachev::error::MeshingError>(())
//! ```
//!
//! # What is measured
//!
//! | measured | of | by | error |
//! |---|---|---|---|
//! | volume, centroid, inertia | a solid | [`Solid::measure`] | a bound that is certain |
//! | area | a solid | [`Solid::measure`] | of flat faces rounding, of others a bound, or an estimate: the report tells |
//! | the same, genus, shells, faults | a mesh | [`Mesh::check`] | those of its triangles, by rounding |
//! | connected components, by size | a mesh | [`Mesh::components`], [`keep_components`](Mesh::keep_components) | none |
//! | openings | a mesh | [`Mesh::open_edges`] | none |
//! | thickness | a solid | [`Solid::thickness`] | that of a facet; of closed meshes .2 % |
//! | thin walls and gaps that a mesh may lose | a solid | [`Solid::thin_features`] | conservative |
//! | clearance | two solids | [`Solid::clearance`] | the tolerance that it tells |
//! | overlap | two solids | [`Solid::clearance`] | depth and volume to errors that it tells |
//! | distance, nearest point | a solid | [`closest_surface_point`](Solid::closest_surface_point) | 10⁻⁹ of the size |
//! | deviations | a scan and a solid | [`fit::inspect`](crate::fit::inspect()) | that of the nearest points |
//!
//! ## Volume, centroid, inertia and area
//!
//! The volume of a mesh is that of its triangles: it is as wrong as the mesh is. Of a solid it is
//! found to the tolerance that is asked for, or as near as a million blocks come. How far it may be
//! off is certain. Superellipsoids, supertoroids, generalised superquadrics, ellipsoids and bounded
//! exact primitives have closed forms, and what has flat faces is summed up exactly: see
//! [`Solid::measure`].
//!
//! ```
//! use rvachev::{CellSize, MeshSettings, Solid};
//!
//! let ring = Solid::torus(10.0, 3.0) - Solid::cuboid([40.0, 2.0, 2.0]);
//! let report = ring.measure(2e-3)?;
//! let mesh = ring.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() })?;
//! // The mesh is smaller than the solid: it cuts off what is round.
//! assert!(report.volume_error <= 2e-3 * report.volume);
//! assert!(mesh.volume() < report.volume - report.volume_error);
//! # Ok::<(), rvachev::error::MeshingError>(())
//! ```
//!
//! ## Thickness
//!
#![doc = picture!("measuring_thickness" = "docs/measuring/thickness.png")]
//!
//! *A tray with a drafted rib and a boss, in the colours of its thickness; millimetres.*
//!
//! The thickness at a point of the surface is the diameter of the largest ball that touches there
//! from inside, and holds nothing that faces the point. Edges are not thin, joints of parts are no
//! walls. [`ThicknessReport`] has the least and where, the share of the area below a limit, a
//! histogram, and the mesh and [pictures](ThicknessReport::picture) in colours. Of closed meshes
//! the triangles themselves are measured, and no wall is lost; of other solids those that are
//! thinner than a cell may be.
//!
//! ```
//! use rvachev::{MeshSettings, Run, Solid};
//!
//! let cup = Solid::cylinder(8.0, 20.0) - Solid::cylinder(7.2, 20.0).translate([0.0, 0.0, 2.0]);
//! let report = cup.thickness(&MeshSettings::default(), &Run::default())?;
//! assert!((report.least - 0.8).abs() < 0.02);
//! println!("{report}, {:.0} % below 1 mm", 100.0 * report.share_below(1.0)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Clearance and overlap
//!
#![doc = picture!("measuring_clearance" = "docs/measuring/clearance.png")]
//!
//! *A pin in a bore, cut open: with a clearance of .4, and .3 too far to one side, the overlap in
//! red.*
//!
//! How far two solids are apart, with the two nearest points; or how deep they go into each other,
//! and what volume they have in common. What only touches does not overlap. Of meshes that were
//! read, and of extruded polygons such as gears, it is told from their triangles, those of flat
//! faces taken together: in milliseconds if they are flat or apart at most places, and in some
//! hundredths or tenths of a second where a gap is even all over, as between a bolt and its nut, where
//! round ones touch over thousands of triangles, or where they overlap.
//!
//! ```
//! use rvachev::{Run, Solid};
//!
//! let bore = Solid::cuboid([12.0, 12.0, 8.0]) - Solid::cylinder(3.4, 10.0);
//! let pin = Solid::cylinder(3.0, 12.0);
//! let gap = pin.clearance(&bore, &Run::default())?.expect("neither is empty");
//! assert!((gap.distance - 0.4).abs() < 2e-3 && !gap.overlaps);
//! let tight = pin.translate([0.7, 0.0, 0.0]).clearance(&bore, &Run::default())?.expect("neither is empty");
//! assert!(tight.overlaps && (tight.depth - 0.3).abs() < 0.01 && tight.volume > 0.0);
//! # Ok::<(), rvachev::error::PrepareError>(())
//! ```
//!
//! # A part that somebody else has made
//!
//! The example `measure_part` reads a file and tells its volume, area, components, open edges and
//! thickness, in words or as a line of JSON.
//! Files say where they are wrong and what was expected: [`Mesh::load`](crate::Mesh::load). A mesh
//! need not be clean to be measured: what is inside is told by winding numbers, and
//! [`open_edges`](Mesh::open_edges) says how open it is.

#[cfg(doc)]
use crate::{CellSize, Mesh, Solid, ThicknessReport};
