//! What numbers mean: lengths and angles that verbs take, values that solids have, and how exact
//! they are on lanes.
//!
//! # Lengths and angles
//!
//! Lengths are in one unit, which is yours. One rule holds for full and half lengths:
//!
//! * What has two ends has its **full size**: edges, heights, lengths, widths, thicknesses,
//!   spacings, the pieces that [`elongate`](crate::Solid::elongate) inserts, the height that
//!   [`taper`](crate::Solid::taper) works over.
//! * What is drawn about a centre has its **radii**: radius, tube, semi-axes, the reach of a conic
//!   from its axis, the half extents of [`Bounds::from_center`].
//!
//! A chamfer is given by its **leg**: how far from the edge it begins, along either face; a fillet
//! by its radius.
//!
//! Angles have their unit in the type [`Angle`]: [`deg(30.0)`](crate::deg()),
//! [`rad(0.5)`](crate::rad()), [`turns(0.25)`](crate::turns()). A bare number is no angle and does
//! not compile. Ranges are stated in degrees, and so are the values in errors.
//!
//! ```
//! use rvachev::{deg, Blend, Solid};
//!
//! // 10 wide, from x = −5 to 5; the bevel takes 1 off the top and 1 off the sides.
//! let block = Solid::cuboid([10.0, 10.0, 9.0]);
//! let bevelled = block.intersection_with(Solid::slab([0.0, 0.0, 1.0], 4.0), Blend::Chamfer { leg: 1.0 });
//! assert!(bevelled.value([4.0, 0.0, 2.0])?.abs() < 1e-9 && bevelled.value([5.0, 0.0, 1.0])?.abs() < 1e-9);
//! let rod = Solid::cylinder(1.0, 8.0).rotate_x(deg(90.0));
//! assert!(rod.contains([0.0, 3.9, 0.0])? && !rod.contains([0.0, 4.1, 0.0])?);
//! # Ok::<(), rvachev::SolidError>(())
//! ```
//!
//! # What values mean
//!
//! A value is a length, positive inside, and its sign is that of the solid. How far it is from the
//! distance to the surface depends on what the solid is made of:
//!
//! | made of | value | slope |
//! |---|---|---|
//! | leaves by **distance** | the true distance, everywhere | 1 |
//! | ellipsoid: a **bound** | never larger than the distance in absolute value | at most 1 |
//! | superquadrics: **gauges** `r·(1 − G)`, superhyperboloids | a bound for exponents `e` of at most 2 (`n` of at least 1); right to the first order where the surface is nearest to the middle, less steep elsewhere | at most 1; unbounded on the planes where it is pinched |
//! | supershapes and superpolygons: gauges | `r·(1 − G)` | not promised |
//! | sheet lattices | the distance to a few per cent near the wall | at most 1.08 to 1.63 |
//! | network lattices | 0.6 to 1 of the distance near the surface | at most 1.32 to 1.54 |
//! | formulas | whatever they give | not promised |
//! | joins by `MIN_MAX`, smooth blends | a bound if the operands have one | that of the operands |
//! | other R-functions | of unit slope at the surface (but `Zero`), smooth beyond | see [`RFunction`] |
//! | fillets, chamfers, offsets, shells | distances near the surface | about 1 |
//! | rigid motions, uniform scaling, reflections | what they are of the operand, to scale | that of the operand |
//! | other affine maps | a bound if the operand has one | at most that of the operand |
//! | repetition, elongation, revolution | distance and bound stay what they are outside | that of the operand |
//! | taper, twist, bends, sweep | the operand's at the pre-image | grows with the deformation |
//!
//! # Accuracy in single precision
//!
//! Lanes of `f32` against double precision, relative to the size of the leaf plus `|f|`, from
//! the centre to ten sizes away, axis planes and exact zeros included; sizes 10⁻³ to 10³. The
//! bounds hold in the tests, which print what they find.
//!
//! | leaf | bound | found |
//! |---|---|---|
//! | superellipsoid, exponents 0.05 to 2.5 | 4·10⁻⁶ | 3.5·10⁻⁷ |
//! | sphere, box, cylinder, half-space | 4·10⁻⁶ | 5.3·10⁻⁷ |
//! | supertoroid, exponents 0.05 to 2; superhyperboloid, 0.05 to 2.5; generalised superquadric, 0.5 to 60 | 4·10⁻⁶ | 3.5·10⁻⁷ |
//! | rounded box, capsule, cone, torus, ellipsoid, prism, pyramid, wedge, slab | 4·10⁻⁶ | 4.7·10⁻⁷ |
//! | sheet and network lattices, relative to the cell, within ten cells | 4·10⁻⁶ | 1.1·10⁻⁶ |
//! | supershape, m up to 12, n2 and n3 at least 1 | 4·10⁻⁶ times max(n2, n3)/n1, at least 4·10⁻⁶ | 7·10⁻⁷ |
//! | polygon | 4·10⁻⁶ | within |
//! | formula | a bound carried along its operations, for each region anew | within |
//!
//! Wherever a sign could be wrong by these, it is settled in double precision.
//!
//! [`Angle`]: crate::Angle
//! [`Bounds::from_center`]: crate::Bounds::from_center
//! [`RFunction`]: crate::RFunction
