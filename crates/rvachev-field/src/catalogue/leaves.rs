//! The leaves in space.

use glam::DVec3;

use super::built_in::built_in;
use super::slot::{Axis, Sheets};
use super::{Direction, Range};
use crate::check::{LARGEST_LENGTH, SMALLEST_LENGTH};
use crate::{
    AnyField, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, GeneralisedSuperquadric, Gielis, HalfSpace, MinimalSurface,
    NetworkLattice, Prism, Pyramid, Radius, RoundedCuboid, SheetLattice, Slab, Sphere, Superellipsoid,
    Superhyperboloid, Supershape, Supertoroid, Torus, Wedge,
};

/// Exponents of superquadrics.
const EXPONENT: Range = Range::new(0.01, 10.0);

/// A length that may be 0.
const LENGTH_OR_NONE: Range = Range::new(0.0, LARGEST_LENGTH);

/// How many sides prisms and pyramids have.
const SIDES: Range = Range::new(3.0, 1000.0);

/// A radius of a cone whose other radius is `other`: not both are 0.
fn cone_radius(other: f64) -> Range {
    if other < SMALLEST_LENGTH { Range::LENGTH } else { LENGTH_OR_NONE }
}

/// Lengths of a hyperboloid.
fn length(shape: &Superhyperboloid) -> Range {
    const LONGEST: f64 = 2000.0;
    let axes = shape.semi_axes();
    let axis = if shape.is_along_x() { axes.x } else { axes.z };
    let most = LARGEST_LENGTH.min(LONGEST * axis);
    if shape.has_two_sheets() { Range::above(2.0 * axis, most) } else { Range::new(SMALLEST_LENGTH, most) }
}

/// Shares of the volume at which network and void hold together.
fn fraction(surface: MinimalSurface) -> Range {
    if surface == MinimalSurface::SchwarzP { Range::new(0.25, 0.75) } else { Range::new(0.1, 0.9) }
}

built_in!(
    ($) dyn AnyField, LEAVES, solid_leaves;

    /// A sphere about the origin.
    sphere: Sphere as leaf {
        /// Distance of the surface from the centre.
        radius: f64 = leaf.radius, Length, Range::LENGTH, example 1.0;
    } => Sphere { radius };

    /// A box about the origin, edges along the axes.
    cuboid: Cuboid as leaf {
        /// Lengths of the edges along x, y and z.
        size: DVec3 = leaf.size, Length, Range::LENGTH, example DVec3::new(4.0, 2.0, 1.0);
    } => Cuboid { size };

    /// A box about the origin with rounded edges.
    rounded_cuboid: RoundedCuboid as leaf {
        /// Lengths along x, y and z, from face to face.
        size: DVec3 = leaf.size, Length, Range::LENGTH, example DVec3::new(4.0, 2.0, 2.0);
        /// Radius of the edges: at most half the smallest size.
        radius: f64 = leaf.radius, Length, LENGTH_OR_NONE,
            given Range::new(0.0, 0.5 * leaf.size.min_element()), example 0.5;
    } => RoundedCuboid { size, radius };

    /// A cylinder about the z axis, centred at the origin.
    cylinder: Cylinder as leaf {
        /// Distance of the side from the axis.
        radius: f64 = leaf.radius, Length, Range::LENGTH, example 1.0;
        /// Length along z.
        height: f64 = leaf.height, Length, Range::LENGTH, example 3.0;
    } => Cylinder { radius, height };

    /// A circular cone about the z axis, pointed or truncated, centred at the origin.
    cone: Cone as leaf {
        /// Radius at the lower end; not both radii are 0.
        bottom_radius: f64 = leaf.bottom_radius, Length, LENGTH_OR_NONE,
            given cone_radius(leaf.top_radius), example 3.0;
        /// Radius at the upper end; 0 for a point.
        top_radius: f64 = leaf.top_radius, Length, LENGTH_OR_NONE, example 0.0;
        /// Length along z.
        height: f64 = leaf.height, Length, Range::LENGTH, example 4.0;
    } => Cone { bottom_radius, top_radius, height };

    /// A cylinder with hemispherical ends along the z axis, centred at the origin.
    capsule: Capsule as leaf {
        /// Radius of the cylinder and of the ends.
        radius: f64 = leaf.radius, Length, Range::LENGTH, example 1.0;
        /// Length along z from end to end: at least twice the radius.
        height: f64 = leaf.height, Length, Range::LENGTH,
            given Range::new(2.0 * leaf.radius, LARGEST_LENGTH), example 6.0;
    } => Capsule { radius, height };

    /// A torus about the z axis, centred at the origin.
    torus: Torus as leaf {
        /// Distance from the axis to the middle of the tube.
        radius: f64 = leaf.radius, Length, Range::LENGTH, example 3.0;
        /// Radius of the tube: at most that of the ring.
        tube: f64 = leaf.tube, Length, Range::LENGTH, given Range::new(SMALLEST_LENGTH, leaf.radius), example 1.0;
    } => Torus { radius, tube };

    /// An ellipsoid about the origin, its axes along x, y and z.
    ellipsoid: Ellipsoid as leaf {
        /// Half the lengths along x, y and z.
        semi_axes: DVec3 = leaf.semi_axes, Length, Range::LENGTH, example DVec3::new(5.0, 2.0, 1.0);
    } => Ellipsoid { semi_axes };

    /// A regular prism along the z axis, centred at the origin.
    prism: Prism as leaf {
        /// Number of sides.
        sides: u32 = leaf.sides(), None, SIDES, example 6;
        /// Distance of the corners from the axis.
        radius: f64 = leaf.radius(), Length, Range::LENGTH, example 2.0;
        /// Length along z.
        height: f64 = leaf.height(), Length, Range::LENGTH, example 3.0;
    } => Prism::new(sides, radius, height);

    /// A regular pyramid along the z axis, centred at the origin.
    pyramid: Pyramid as leaf {
        /// Number of faces besides the base.
        sides: u32 = leaf.sides(), None, SIDES, example 4;
        /// Distance of the corners of the base from the axis.
        radius: f64 = leaf.radius(), Length, Range::LENGTH, example 3.0;
        /// Length along z.
        height: f64 = leaf.height(), Length, Range::LENGTH, example 2.0;
    } => Pyramid::new(sides, radius, height);

    /// A wedge about the origin: the lower half of a box.
    wedge: Wedge as leaf {
        /// Lengths of the box along x, y and z.
        size: DVec3 = leaf.size, Length, Range::LENGTH, example DVec3::new(8.0, 2.0, 6.0);
    } => Wedge { size };

    /// Everything on one side of a plane; unbounded.
    half_space: HalfSpace as leaf {
        /// Direction out of the solid.
        normal: Direction = Direction(leaf.normal), None, Range::ANY, example Direction(DVec3::Z);
        /// Distance of the plane from the origin, along the normal.
        offset: f64 = leaf.offset, Length, Range::FINITE, example 0.5;
    } => HalfSpace { normal: normal.0, offset };

    /// Everything between two parallel planes about the origin; unbounded.
    slab: Slab as leaf {
        /// Direction across the planes.
        normal: Direction = Direction(leaf.normal), None, Range::ANY, example Direction(DVec3::Z);
        /// Distance of the planes from one another.
        thickness: f64 = leaf.thickness, Length, Range::LENGTH, example 2.0;
    } => Slab { normal: normal.0, thickness };

    /// A superellipsoid about the origin.
    superellipsoid: Superellipsoid as leaf {
        /// Half the lengths along x, y and z.
        semi_axes: DVec3 = leaf.semi_axes(), Length, Range::LENGTH, example DVec3::new(1.0, 2.0, 3.0);
        /// Shapes the meridians: 0 square, 1 round, 2 bevelled.
        e1: f64 = leaf.exponents()[0], None, EXPONENT, example 0.5;
        /// Shapes the sections across z.
        e2: f64 = leaf.exponents()[1], None, EXPONENT, example 1.5;
    } => Superellipsoid::new(semi_axes, e1, e2);

    /// A supertoroid about the z axis, centred at the origin.
    supertoroid: Supertoroid as leaf {
        /// Half-widths of the tube along x, y and z.
        semi_axes: DVec3 = leaf.semi_axes(), Length, Range::LENGTH, example DVec3::new(1.2, 0.8, 0.6);
        /// Radius of the tube's core in terms of the semi-axes; 1 leaves no hole.
        ring: f64 = leaf.ring(), None, Range::new(1.0, 1000.0), example 1.5;
        /// Shapes the tube's section: 0 square, 1 round, 2 bevelled.
        e1: f64 = leaf.exponents()[0], None, EXPONENT, example 0.3;
        /// Shapes the ring.
        e2: f64 = leaf.exponents()[1], None, EXPONENT, example 0.7;
    } => Supertoroid::new(semi_axes, ring, e1, e2);

    /// A superhyperboloid about an axis, cut off at both ends.
    superhyperboloid: Superhyperboloid as leaf {
        /// The semi-axes along x, y and z.
        semi_axes: DVec3 = leaf.semi_axes(), Length, Range::LENGTH, example DVec3::new(2.0, 2.0, 3.0);
        /// Shapes the profile along the axis: 1 a hyperbola, 2 two cones.
        e1: f64 = leaf.exponents()[0], None, EXPONENT, example 1.0;
        /// Shapes the sections across the axis: 0 square, 1 round, 2 bevelled.
        e2: f64 = leaf.exponents()[1], None, EXPONENT, example 0.8;
        /// Length from end to end: at most 2000 semi-axes; for two sheets more than two of them.
        length: f64 = leaf.length(), Length, Range::LENGTH, given length(&leaf), example 8.0;
        /// Whether it is in one piece or in two.
        sheets: Sheets = Sheets { two: leaf.has_two_sheets() }, None, Range::ANY, example Sheets { two: false };
        /// The axis that it is about.
        axis: Axis = Axis { is_x: leaf.is_along_x() }, None, Range::ANY, example Axis { is_x: false };
    } => match (sheets.two, axis.is_x) {
        (false, false) => Superhyperboloid::one_sheet(semi_axes, e1, e2, length),
        (false, true) => Superhyperboloid::one_sheet_x(semi_axes, e1, e2, length),
        (true, false) => Superhyperboloid::two_sheets(semi_axes, e1, e2, length),
        (true, true) => Superhyperboloid::two_sheets_x(semi_axes, e1, e2, length),
    };

    /// A superquadric with an exponent along each axis, about the origin.
    generalised_superquadric: GeneralisedSuperquadric as leaf {
        /// Half the lengths along x, y and z.
        semi_axes: DVec3 = leaf.semi_axes(), Length, Range::LENGTH, example DVec3::new(1.0, 1.5, 2.0);
        /// Exponents along x, y and z: 2 round, 1 straight, large square.
        exponents: DVec3 = leaf.exponents().into(), None, Range::new(0.2, 60.0), example DVec3::new(5.0, 3.0, 1.5);
    } => GeneralisedSuperquadric::new(semi_axes, exponents.to_array());

    /// The spherical product of two Gielis curves, about the origin.
    supershape: Supershape as leaf {
        /// The curve of the sections across z.
        equator: Gielis = leaf.equator(), None, Range::ANY, example Gielis::new(6.0, 2.0, 7.0, 7.0);
        /// The curve of the meridians, its first turn.
        meridian: Gielis = leaf.meridian(), None, Range::ANY, example Gielis::new(4.0, 10.0, 10.0, 10.0);
        /// What the product is scaled by along x, y and z.
        scale: DVec3 = leaf.scale(), Length, Range::LENGTH, example DVec3::new(2.0, 2.0, 1.0);
        /// Which formula gives the radii of the curves.
        radius: Radius = leaf.radius(), None, Range::ANY, example Radius::Standard;
    } => Supershape::with(equator, meridian, scale, radius);

    /// A wall along a triply periodic minimal surface; unbounded.
    sheet_lattice: SheetLattice as leaf {
        /// The surface in the middle of the wall.
        surface: MinimalSurface = leaf.surface, None, Range::ANY, example MinimalSurface::Gyroid;
        /// Length of the period.
        cell: f64 = leaf.cell, Length, Range::LENGTH, example 8.0;
        /// Thickness of the wall: 10⁻⁶ to a quarter of the cell.
        thickness: f64 = leaf.thickness, Length, Range::new(1e-6 * SMALLEST_LENGTH, 0.25 * LARGEST_LENGTH),
            given Range::new(1e-6 * leaf.cell, 0.25 * leaf.cell), example 0.5;
    } => SheetLattice { surface, cell, thickness };

    /// One side of a triply periodic minimal surface; unbounded.
    network_lattice: NetworkLattice as leaf {
        /// The surface that bounds the network at a fraction of a half.
        surface: MinimalSurface = leaf.surface, None, Range::ANY, example MinimalSurface::SchwarzP;
        /// Length of the period.
        cell: f64 = leaf.cell, Length, Range::LENGTH, example 6.0;
        /// Share of the volume that is solid; for Schwarz P 0.25 to 0.75.
        fraction: f64 = leaf.fraction, None, Range::new(0.1, 0.9), given fraction(leaf.surface), example 0.3;
    } => NetworkLattice { surface, cell, fraction };
);
