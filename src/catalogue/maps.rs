//! Affine maps and repetition.

use glam::{DAffine3, DMat3, DVec3};
use rvachev_field::catalogue::Direction;

use super::part::Either;
use super::verb::verbs;
use crate::{Angle, Range, Solid, Value, rad};

/// Factors of maps: of either sign, not zero.
const FACTOR: Range = Range::signed(1e-9, 1e9);

/// Spacings that the largest of the counts leaves.
fn spacing(values: &[Value]) -> Option<Range> {
    let [Value::Counts(counts), _] = values else { return None };
    let most = counts.iter().copied().max().unwrap_or(1).max(1);
    Some(Range::new(Range::LENGTH.least, Range::LENGTH.most / f64::from(most)))
}

verbs! {
    /// Moved.
    Affine translate {
        /// By how much along x, y and z; of a profile, along x and y.
        offset: DVec3 = Length, Range::FINITE, example DVec3::new(1.0, -2.0, 0.0);
    } => |operand: Either| {
        operand.map(|solid| solid.translate(offset), |profile| profile.translate(offset.truncate()))
    };

    /// Turned about the x axis, from y towards z.
    Affine rotate_x {
        /// By how much.
        angle: Angle = Angle, Range::ANY, example rad(0.5);
    } => |solid: Solid| solid.rotate_x(angle);

    /// Turned about the y axis, from z towards x.
    Affine rotate_y {
        /// By how much.
        angle: Angle = Angle, Range::ANY, example rad(-0.75);
    } => |solid: Solid| solid.rotate_y(angle);

    /// Turned about the z axis, from x towards y.
    Affine rotate_z {
        /// By how much.
        angle: Angle = Angle, Range::ANY, example rad(1.0);
    } => |operand: Either| operand.map(|solid| solid.rotate_z(angle), |profile| profile.rotate(angle));

    /// Turned about an axis through the origin.
    Affine rotate_about {
        /// The axis.
        axis: Direction = None, Range::ANY, example Direction(DVec3::ONE);
        /// By how much, as a right-handed screw turns.
        angle: Angle = Angle, Range::ANY, example rad(0.25);
    } => |solid: Solid| solid.rotate_about(axis.0, angle);

    /// Scaled about the origin.
    Affine scale {
        /// The factor: of either sign.
        factor: f64 = None, FACTOR, example 2.0;
    } => |operand: Either| operand.map(|solid| solid.scale(factor), |profile| profile.scale(factor));

    /// Scaled about the origin by a factor along each axis.
    Affine scale_axes {
        /// The factors: of either sign, none less than 10⁻⁹ of another; of a profile, along x and y.
        factors: DVec3 = None, FACTOR, example DVec3::new(2.0, 0.5, 1.0);
    } => |operand: Either| {
        operand.map(|solid| solid.scale_axes(factors), |profile| profile.scale_axes(factors.truncate()))
    };

    /// The mirror image in a plane.
    Affine reflect {
        /// Across the plane; of a profile, along x and y.
        normal: Direction = None, Range::ANY, example Direction(DVec3::X);
        /// Distance of the plane from the origin, along the normal.
        offset: f64 = Length, Range::new(-0.5e9, 0.5e9), example 1.0;
    } => |operand: Either| operand.map(
        |solid| solid.reflect(normal.0, offset),
        |profile| profile.reflect(normal.0.truncate(), offset),
    );

    /// The solid together with its mirror image in a plane.
    Affine mirrored {
        /// Across the plane; of a profile, along x and y.
        normal: Direction = None, Range::ANY, example Direction(DVec3::Y);
        /// Distance of the plane from the origin, along the normal.
        offset: f64 = Length, Range::new(-0.5e9, 0.5e9), example -1.0;
    } => |operand: Either| operand.map(
        |solid| solid.mirrored(normal.0, offset),
        |profile| profile.mirrored(normal.0.truncate(), offset),
    );

    /// Mapped by any invertible affine map; of a profile, one that keeps to the plane.
    Affine affine {
        /// The map.
        map: DAffine3 = Length, Range::FINITE, example DAffine3::from_mat3_translation(
            DMat3::from_cols(DVec3::new(1.0, 0.25, 0.0), DVec3::Y, DVec3::Z),
            DVec3::new(0.5, 0.0, 0.0),
        );
    } => |operand: Either| operand.map(|solid| solid.affine(map), |profile| profile.affine_in_space(map));

    /// A grid of copies along the axes.
    Repetition repeat {
        /// How many along x, y and z; of a profile, along x and y.
        counts: [u32; 3] = None, Range::new(1.0, 1e6), example [4, 4, 4];
        /// How far neighbours are apart along x, y and z; 10⁹ divided by how many there are at most.
        spacing: DVec3 = Length, Range::LENGTH, given |values| spacing(values), example DVec3::new(3.0, 4.0, 5.0);
    } => |operand: Either| {
        let [x, y, _] = counts;
        operand.map(
            |solid| solid.repeat(counts, spacing),
            |profile| profile.repeat([x, y], spacing.truncate()),
        )
    };

    /// A row of copies.
    Repetition repeat_linear {
        /// How many.
        count: u32 = None, Range::new(1.0, 1e6), example 4;
        /// From each to the next; no longer than 10⁹ divided by how many there are.
        step: DVec3 = Length, Range::FINITE, example DVec3::new(3.0, 0.0, 4.0);
    } => |operand: Either| operand.map(
        |solid| solid.repeat_linear(count, step),
        |profile| profile.repeat_linear(count, step.truncate()),
    );

    /// A ring of copies about the z axis.
    Repetition repeat_polar {
        /// How many.
        count: u32 = None, Range::new(1.0, 1000.0), example 5;
    } => |operand: Either| operand.map(
        |solid| solid.repeat_polar(count),
        |profile| profile.repeat_polar(count),
    );
}
