//! How far a solid reaches along a direction: boxes of what its parts' boxes do not tell.
//!
//! A column and a slab that are turned have no end along any axis, but what they have in common
//! has. It is asked for in its own coordinates, along each axis of the frame.

use std::cell::Cell;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::solid::{Node, Operation, Sweep};
use crate::{Angle, Bounds, Extrusion, Solid};
use rvachev_field::AnyField;

/// So many nodes are asked for a solid's reach; what has more is not told.
const MOST: usize = 2000;

/// Nor what is nested deeper.
const DEEPEST: u32 = 32;

/// A box around what is inside a solid, after a map; infinite along the axes where nothing is
/// known.
pub(super) fn box_under(solid: &Solid, map: &DAffine3) -> Bounds {
    let left = Cell::new(MOST);
    let rows = map.matrix3.transpose();
    let reach = |direction: DVec3| support(solid, direction, DEEPEST, &left);
    let side = |axis: usize| [reach(-rows.col(axis)), reach(rows.col(axis))];
    let sides = [side(0), side(1), side(2)];
    let (low, high) = (DVec3::from_array(sides.map(|side| -side[0])), DVec3::from_array(sides.map(|side| side[1])));
    Bounds::new(map.translation + low, map.translation + high)
}

/// The most that the scalar product with a direction, of any length, is over what is inside, at
/// least.
fn support(solid: &Solid, direction: DVec3, depth: u32, left: &Cell<usize>) -> f64 {
    if direction == DVec3::ZERO {
        return 0.0;
    }
    left.set(left.get().saturating_sub(1));
    if depth == 0 || left.get() == 0 {
        return f64::INFINITY;
    }
    let below = |solid: &Solid, direction: DVec3| support(solid, direction, depth - 1, left);
    let node = solid.node();
    let first = |direction: DVec3| node.parts().first().map_or(f64::INFINITY, |part| below(part, direction));
    let found = match node {
        Node::Leaf(field) => reach(&**field, direction),
        Node::Affine { operand, forward, .. } => {
            below(operand, forward.matrix3.transpose() * direction) + direction.dot(forward.translation)
        }
        Node::Warp { operand, warp } => warp.support(&|direction| below(operand, direction), direction),
        // What a ball leaves out is within the hull of the operands.
        Node::Join { operation, operands, .. } | Node::Blend { operation, operands, ball: Some(_), .. } => {
            let all = operands.iter().map(|operand| below(operand, direction));
            match operation {
                Operation::Union | Operation::SymmetricDifference => all.fold(f64::NEG_INFINITY, f64::max),
                Operation::Intersection => {
                    let least = all.fold(f64::INFINITY, f64::min);
                    // A column and a slab bound it in directions that neither of them does.
                    let parts = [direction.truncate().extend(0.0), DVec3::Z * direction.z];
                    match parts.contains(&DVec3::ZERO) {
                        true => least,
                        false => least.min(parts.into_iter().map(|part| below(solid, part)).sum()),
                    }
                }
                Operation::Difference => first(direction),
            }
        }
        Node::Swept { profile, sweep: Sweep::Extrude(extrusion), .. } if extrusion.twist == Angle::ZERO => {
            let Extrusion { height, scale, .. } = *extrusion;
            let section = below(&profile.0, direction.truncate().extend(0.0));
            let up = 0.5 * height * direction.z;
            (section - up).max(scale * section + up)
        }
        Node::Named { .. }
        | Node::Painted { .. }
        | Node::Repeated { .. }
        | Node::Toleranced { .. }
        | Node::Swept { .. } => first(direction),
        _ => f64::INFINITY,
    };
    if found.is_nan() { f64::INFINITY } else { found }
}

/// How far a leaf reaches along a direction.
fn reach(field: &dyn AnyField, direction: DVec3) -> f64 {
    let length = direction.length();
    let along = direction / length;
    // Columns have no end along z.
    let across = DVec2::new(along.x, along.y).perp().try_normalize().unwrap_or(DVec2::Y).extend(0.0);
    let rows = DMat3::from_cols(along, across, along.cross(across));
    length * field.bounds_under(&DAffine3::from_mat3(rows.transpose())).max.x
}
