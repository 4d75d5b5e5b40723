//! Lengths: offsets, shells, rounded and filleted solids, fillets and chamfers, by true distance.
//!
//! The distance of a point is that to the nearest point of the surface, positive inside. All
//! lengths are in terms of it, whatever a solid is made of and whatever its
//! [values](crate::conventions#what-values-mean) are. With `r` a length and `d` the distance to the
//! surface of `s`:
//!
//! | verb | what is in it | what becomes of the surface |
//! |---|---|---|
//! | [`s.offset(r)`](Solid::offset) | where d > −r | moved outwards by r; inwards if r is negative |
//! | [`s.shell(t)`](Solid::shell) | where 0 < d < t | a wall of thickness t below it |
//! | [`s.rounded(r)`](Solid::rounded) | all balls of radius r that fit inside: the *opening* | convex edges are rounded |
//! | [`s.filleted(r)`](Solid::filleted) | all that balls of radius r do not reach from outside: the *closing* | concave edges are filled |
//! | [`a.union_with(b, Blend::Fillet { .. })`](Solid::union_with) | a, b, and what is filled between them | the concave edges where a meets b are filled |
//! | [`a.union_with(b, Blend::Chamfer { .. })`](Solid::union_with) | a, b, and a flat face between them | the same edges have a face across them |
//!
//! [`Profile`] has the same verbs: its edges are corners of the plane, its balls are discs.
//! [`level`](Solid::level) is none of them: it moves values, which need not be distances.
//!
//! # Offsets
//!
#![doc = picture!("lengths_offset" = "docs/lengths/offset.png")]
//!
//! *Grey: a step of two boxes with a hole. Green: `offset(-1.0)`. Blue: `offset(1.0)`.*
//!
//! Outwards, convex edges become round and concave ones stay sharp. Inwards, convex edges stay
//! sharp and concave ones become round. What is thinner than twice the distance is gone, and holes
//! and gaps narrower than that are closed when a solid grows. Where two parts of a solid meet there
//! is no surface, and nothing is measured from there.
//!
//! ```
//! use rvachev::Solid;
//!
//! // Two cubes side by side are one block, and stay one.
//! let cube = Solid::cuboid([10.0, 10.0, 10.0]);
//! let block = cube.translate([-5.0, 0.0, 0.0]) | cube.translate([5.0, 0.0, 0.0]);
//! let smaller = block.offset(-1.0);
//! assert!(smaller.contains([0.0, 0.0, 0.0])? && smaller.contains([8.99, 3.99, 3.99])?);
//! assert!(!smaller.contains([9.01, 0.0, 0.0])?);
//! let larger = block.offset(1.0);
//! assert!(larger.contains([10.99, 0.0, 0.0])? && !larger.contains([10.8, 5.8, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Shells
//!
#![doc = picture!("lengths_shell" = "docs/lengths/shell.png")]
//!
//! *Grey: a wide and a narrow cylinder. Blue: `shell(0.9)`, cut open.*
//!
//! A shell is the solid less its offset inwards. Its outer face is the solid's own, exactly. Inside
//! it has one cavity, or none where there is no room for one.
//!
//! ```
//! use rvachev::Solid;
//!
//! let body = Solid::cylinder(5.5, 9.0) | Solid::cylinder(2.5, 6.0).translate([0.0, 0.0, 6.0]);
//! let bottle = body.shell(0.9);
//! assert!(bottle.contains([5.0, 0.0, 0.0])? && !bottle.contains([4.5, 0.0, 0.0])?);
//! // The passage from body to neck is open.
//! assert!(!bottle.contains([0.0, 0.0, 4.5])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Rounded: the opening
//!
#![doc = picture!("lengths_opening" = "docs/lengths/opening.png")]
//!
//! *Grey: the step. Blue: `rounded(1.1)`.*
//!
//! `s.rounded(r)` is what a ball of radius r sweeps when its centre goes wherever the whole ball is
//! inside `s`: the same as `s.offset(-r).offset(r)`, but that faces which the ball touches stay the
//! solid's own, exactly. Convex edges and corners are round. Concave edges stay as they are.
//!
//! ```
//! use rvachev::Solid;
//!
//! let cube = Solid::cuboid([10.0, 10.0, 10.0]);
//! let die = cube.rounded(2.0);
//! // Along an edge the ball's centre is at 3, 3, and its surface 2 from there.
//! assert!(die.contains([4.41, 4.41, 0.0])? && !die.contains([4.42, 4.42, 0.0])?);
//! // The faces have not moved.
//! assert!(die.contains([4.999999, 0.0, 0.0])?);
//!
//! // No ball of this size fits inside: nothing is left.
//! assert!(cube.rounded(5.5).bounds()?.is_empty());
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Filleted: the closing
//!
#![doc = picture!("lengths_closing" = "docs/lengths/closing.png")]
//!
//! *Grey: the step. Blue: `filleted(1.6)`; the hole's radius is 1.4.*
//!
//! `s.filleted(r)` is the same from outside: what is left when a ball of radius r has taken all
//! that it reaches, `s.offset(r).offset(-r)` but for faces, which stay. Concave edges are filled.
//! Convex edges stay as they are. `s.filleted(a).rounded(b)` does both, as the example `bracket`
//! shows.
//!
//! ```
//! use rvachev::Profile;
//!
//! let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]];
//! let bracket = Profile::polygon(corner).filleted(2.0);
//! // The disc that touches both sides has its centre at 6, 6.
//! assert!(bracket.contains([4.58, 4.58])? && !bracket.contains([4.59, 4.59])?);
//! assert!(bracket.contains([9.999999, 3.999999])? && !bracket.contains([7.0, 4.000001])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # When a ball does not fit
//!
#![doc = picture!("lengths_no_fit" = "docs/lengths/no_fit.png")]
//!
//! *Grey: a comb, its gaps 3.5, 1.2 and 2.7 wide, its last tooth 1.1 wide. Blue: `filleted(1.0)`.
//! Green: `rounded(1.0)`.*
//!
//! * A fillet fills what the ball does not get into: gaps narrower than its diameter, holes of a
//!   smaller radius. The ball rests on the rim of the gap, and a shallow groove is left there.
//! * An opening takes off what the ball does not get into: walls thinner than its diameter, pins of
//!   a smaller radius, and parts that hang on these.
//! * What the ball just fits into it gets into: a wall of 1 is left by `rounded(0.5)`, a slot of 1 is
//!   by `filleted(0.5)`. Where that is measured, the ball is 1.5 thousandths smaller than asked for,
//!   or three quarters of the tolerance if that is less. Sheets and lines for its centre are put
//!   together from the faces of the solid, in tenths of a second; beside joints of
//!   [fillets](crate::Blend::Fillet) what it fits into by less than a thirtieth of its radius may
//!   count as what it does not fit into.
//! * Where nothing is left, the solid is empty. That is no error: its [`bounds`](Solid::bounds) are
//!   [empty](crate::Bounds::is_empty), nothing is in it, its mesh has no triangles.
//!
//! ```
//! use rvachev::{Profile, RFunction};
//!
//! // Three teeth on a back, the gaps 3.5 and 1.2 wide.
//! let teeth = [(0.0, 3.5), (7.0, 2.5), (10.7, 3.0)];
//! let teeth = teeth.map(|(left, width)| Profile::rectangle([width, 8.0]).translate([left + 0.5 * width, 4.0]));
//! let comb = Profile::union_all(teeth, RFunction::MIN_MAX) | Profile::rectangle([13.7, 3.0]).translate([6.85, 1.5]);
//! let filled = comb.filleted(1.0);
//! assert!(!filled.contains([5.25, 4.0])? && filled.contains([10.1, 4.0])?);
//! // The disc comes down between the teeth until it touches both their edges.
//! assert!(filled.contains([10.1, 7.7])? && !filled.contains([10.1, 7.9])?);
//! // No disc of this size fits in anywhere.
//! assert!(comb.extrude(5.0).rounded(3.0).bounds()?.is_empty());
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Fillets between operands
//!
#![doc = picture!("lengths_flush" = "docs/lengths/flush.png")]
//!
//! *A block and a post that are flush at the top. Grey: the union. Blue: a fillet. Green: a
//! chamfer. Red: a smooth blend, which rises above the top.*
//!
//! `filleted` fills all concave edges of a solid. [`Blend::Fillet`] fills those between its
//! operands. For a union of A and B and the radius r:
//!
//! * A ∪ B ⊆ result ⊆ closing of A ∪ B by r: nothing is filled that the ball reaches.
//! * If A and B are convex the result is that closing.
//! * An operand's own concave edges stay as they are away from the joint. Close to it, where the
//!   ball touches the other operand as well, they are filled; the filling fades out along them.
//! * What an operand has farther than 4 r from the others does not count. So blends one after the
//!   other that are so far apart, of whatever radii, are each measured by themselves.
//! * Faces that are flush stay flush, exactly: there is no edge between them, and nothing is added.
//! * At the end of a notch between two blocks the ball comes over the edge from above as well, so
//!   the end of the fillet dips a little below the flush faces. So does the closing.
//!
//! Fillets of intersections and differences are the same of complements: they round the convex
//! edges where the operands meet, and the result is between the opening and the plain join.
//!
//! ```
//! use rvachev::{Blend, Profile, Solid};
//!
//! let fillet = Blend::Fillet { radius: 2.0 };
//! // A cube and a cylinder of the same height about one of its edges: the top stays flat.
//! let (cube, post) = (Solid::cuboid([10.0, 10.0, 10.0]).translate([5.0, 5.0, 0.0]), Solid::cylinder(5.0, 10.0));
//! let flush = cube.union_with(&post, fillet);
//! assert!(flush.contains([2.0, 2.0, 4.999999])? && !flush.contains([2.0, 2.0, 5.000001])?);
//! assert!(flush.bounds()?.max.z < 5.0 + 1e-9);
//!
//! // An operand's own edge, away from the joint, is filled by `filleted` only.
//! let corner = [[0.0, 0.0], [30.0, 0.0], [30.0, 4.0], [4.0, 4.0], [4.0, 30.0], [0.0, 30.0]];
//! let corner = Profile::polygon(corner);
//! let knob = Profile::rectangle([4.0, 10.0]).translate([26.0, 5.0]);
//! let (own, joint) = ([4.4, 4.4], [23.6, 4.4]);
//! let joined = corner.union_with(&knob, fillet);
//! assert!(!joined.contains(own)? && joined.contains(joint)?);
//! let closed = (&corner | &knob).filleted(2.0);
//! assert!(closed.contains(own)? && closed.contains(joint)?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Chamfers
//!
//! [`Blend::Chamfer`] has a flat face in place of the round one. It begins at the leg from the edge
//! along either operand. It stays within the closing by a ball of 16 legs, so that it does not rise
//! above flush faces either. Where an edge of an operand ends in the joint, as those of a rib do,
//! the faces of its two sides meet in a mitre. How exact its legs are on round operands is said at
//! [`Blend`]. Along a fillet or chamfer that an operand has itself the face is narrower: its legs are
//! taken from what that is between.
//!
//! ```
//! use rvachev::{Blend, Solid};
//!
//! let (plate, post) = (Solid::cuboid([20.0, 20.0, 2.0]), Solid::cylinder(3.0, 12.0));
//! let stand = plate.union_with(&post, Blend::Chamfer { leg: 1.0 });
//! assert!(stand.contains([3.45, 0.0, 1.45])? && !stand.contains([3.55, 0.0, 1.55])?);
//! assert!(!stand.contains([4.1, 0.0, 1.001])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! [`Blend::Smooth`] is no length: it reads the operands' values and adds wherever these differ by
//! less than its radius. On flush faces both values are the same, and the face rises by a quarter
//! of the radius.
//!
//! ```
//! use rvachev::Solid;
//!
//! let (cube, post) = (Solid::cuboid([10.0, 10.0, 10.0]).translate([5.0, 5.0, 0.0]), Solid::cylinder(5.0, 10.0));
//! let smooth = cube.smooth_union(&post, 2.0);
//! assert!(smooth.contains([2.0, 2.0, 5.49])? && !smooth.contains([2.0, 2.0, 5.51])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Many operands
//!
//! [`union_all_with`](Solid::union_all_with),
//! [`intersection_all_with`](Solid::intersection_all_with) and
//! [`difference_all_with`](Solid::difference_all_with) join any number of operands by one blend.
//! Fillets are between any two of them, and it does not matter in which order they stand;
//! `a.union_with(b, fillet)` joined to further operands by the same fillet is the same. There is no
//! limit to how many, and each is looked at only near it. Other blends join one operand after the
//! other.
//!
//! ```
//! use rvachev::{Blend, Solid};
//!
//! let plate = Solid::cuboid([60.0, 12.0, 4.0]);
//! let pins = (0..5).map(|n| Solid::cylinder(2.0, 12.0).translate([f64::from(n) * 12.0 - 24.0, 0.0, 4.0]));
//! let comb = Solid::union_all_with([plate].into_iter().chain(pins), Blend::Fillet { radius: 1.5 });
//! for pin in [-24.0, 0.0, 24.0] {
//!     assert!(comb.contains([pin + 2.2, 0.0, 2.2])? && !comb.contains([pin + 3.2, 0.0, 3.2])?);
//! }
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # Exact or measured
//!
//! Where a solid's own value is the distance, a length is **exact**: nothing is prepared, and the
//! value is right to rounding. A value is the distance
//!
//! | of | inside | outside |
//! |---|---|---|
//! | leaves by [distance](crate::conventions#what-values-mean) | yes | yes |
//! | a union | no | if it is of all operands |
//! | an intersection | if it is of all operands | no |
//! | a difference `a - b` | if it is of `a` inside and of `b` outside | no |
//! | a solid moved, turned, mirrored, scaled evenly | as it is of the solid | as it is of the solid |
//! | a profile extruded straight, its edges sharp | if it is of the profile on both sides | the same |
//! | an offset outwards | if the solid is convex, and it is of it on both sides | yes |
//! | an offset inwards | yes | of leaves that stay of their kind |
//! | a rounding | if it is exact, and the solid is convex | if it is exact |
//!
//! Offsets inwards and shells ask for the distance inside, offsets outwards for that outside.
//! R-functions count as min and max here. So `cuboid.shell(1.0)`, the shell of a cube with drilled
//! holes and the offset outwards of a union of cylinders are exact.
//!
//! Of their kind stay, where they are moved in, spheres, boxes, rounded boxes, cylinders, capsules,
//! tori, prisms, slabs and half-spaces, cones as long as they are truncated, and circles,
//! rectangles and regular polygons that are extruded straight. Their roundings are exact. So are
//! the shells and offsets of these, but for those inwards of a torus, which is not convex: an
//! enclosure is `cuboid.rounded(4.0).shell(2.0)`. Of what is convex a filleting is the solid
//! itself.
//!
//! ```
//! use rvachev::{Accuracy, Solid};
//!
//! // The sides of a plate, round all over.
//! let plate = Solid::cuboid([20.0, 20.0, 2.0]).rounded(0.99);
//! assert_eq!(plate.accuracy()?, Accuracy::default());
//! assert!((plate.value([10.01, 0.0, 0.01])? + 0.01).abs() < 1e-12);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! Of everything else (superquadrics, what is deformed or blended, a union from inside) the surface
//! is **measured**: it is meshed once, its cells are halved until their curved patches are on the
//! surface, all but a few spots, which are meshed by themselves, and the distance is that to the
//! nearest patch. Blades, fins, ribs and gaps that pass between the nodes of the mesh are followed
//! by lines across its cells, along which ranges tell where the other side is, down to what
//! rounding errors leave. Whether a point is inside is still told by the solid's own value.
//! Openings and closings measure twice: the solid, and where the centre of the ball may be.
//! A flat face is few patches, however many cells it takes.
//!
//! Of a join that is measured on the side that this table names, only those operands are whose own
//! values are no distances there: for the shell of `(a | b) - c` no patch follows the hole, if `c`
//! knows its distances outside.
//!
//! Of profiles that are polygons, or joined of polygons by R-functions, of up to 2000 edges, the
//! border and the curve at a distance from it are known: lines and arcs, in single precision.
//!
//! # Accuracy
//!
//! A measured surface is right to the power of two at or below a thousandth of the length that is
//! asked for, of chamfers of four legs, so that lengths of about one size share one surface. By
//! itself it is never measured more finely than to a millionth of the solid's size, or of how far the solid reaches from the
//! origin. Equal solids share their surfaces. Along creases that are curved,
//! where curvature jumps, and where ribs come to be as thin as cells, single points may be farther
//! off. [`Solid::accuracy`](crate::Solid::accuracy) says what was reached, and
//! [`Solid::with_tolerance`](crate::Solid::with_tolerance) asks for more or less. Rods, holes and
//! ribs that are convex leaves are found however thin they are, or told of by it; of other leaves,
//! as a thin torus or a swept profile, what is thinner than a quarter of a cell may be missed. The
//! tolerances of lengths of lengths, as of fillets of several radii that are near each other, add up.
//!
//! Faces that a length leaves where they are are not measured: the outer face of a shell, the faces
//! that the ball of an opening or closing touches, flush faces of a blend. They are the solid's
//! own, exactly.
//!
//! ```
//! use rvachev::Solid;
//!
//! // The length is measured: a superellipsoid's value is no distance.
//! let round = Solid::superellipsoid([10.0, 10.0, 10.0], 1.0, 1.0);
//! let larger = round.offset(2.0);
//! let direction = glam::DVec3::new(0.6, 0.48, 0.64);
//! assert!(larger.contains(direction * 11.998)? && !larger.contains(direction * 12.002)?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # What it costs
//!
//! Exact lengths cost what the solid costs. A measured one takes about the time of a mesh of the
//! operand when it is first asked for. It is then kept for all solids that are equal to the
//! operand, until the last of them is dropped; [`Solid::prepare`](crate::Solid::prepare) does it
//! ahead of time. Of solids without bounds those parts are measured that are asked for, and of
//! lattices one cell. A wall that a length just eats up takes a little longer: two plates of 1,
//! rounded by .5, .2 seconds; what is twisted, of supershapes or joined smoothly, 5 to 20. Lengths
//! of fillets and chamfers are measured one after the other: a body with two, all of its edges
//! filled and rounded, takes 2 to 20 seconds.
//!
//! Values of what is measured are searches: a picture takes five to thirty times as long as that of
//! the plain solid, close up on a fillet up to forty times.
//!
//! ```
//! use rvachev::Solid;
//!
//! let vase = Solid::superellipsoid([3.0, 3.0, 5.0], 0.5, 1.0).taper(0.4, 0.4, 10.0).shell(0.4);
//! // The first question measures the surface; the next ones, also of the cut vase, do not.
//! assert!(vase.contains([0.0, 0.0, 4.8])? && !vase.contains([0.0, 0.0, 4.5])?);
//! let cut = &vase - Solid::half_space([0.0, 1.0, 0.0], 0.0);
//! assert!(!cut.contains([0.0, 1.0, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```

#[cfg(doc)]
use crate::{Blend, Profile, Solid};
