//! What can be said about a node by itself.

use glam::DAffine3;

use crate::eval::context::least_stretch;
use crate::{ParamError, solid};

/// What can be said about a node by itself.
pub(super) fn check_node(node: &solid::Node) -> Result<(), ParamError> {
    match node {
        solid::Node::Leaf(field) => field.check(),
        solid::Node::Affine { forward, label, .. } => check_affine(forward, label),
        solid::Node::Join { rule, .. } => rule.check(),
        solid::Node::Blend { blend, .. } => blend.check(),
        solid::Node::Length { length, .. } => length.check(),
        solid::Node::Painted { paint, .. } => paint.check(),
        solid::Node::Toleranced { operand, tolerance, .. } => solid::check_tolerance(operand, *tolerance),
        // A deformation is checked against what it deforms, a verb's parameters where it is built.
        solid::Node::Warp { .. }
        | solid::Node::Complement(_)
        | solid::Node::Named { .. }
        | solid::Node::Repeated { .. }
        | solid::Node::Swept { .. }
        | solid::Node::Rim { .. } => Ok(()),
    }
}

fn check_affine(map: &DAffine3, label: &str) -> Result<(), ParamError> {
    const LARGEST: f64 = 1e9;
    for (axis, offset) in ["x", "y", "z"].into_iter().zip(map.translation.to_array()) {
        if offset.is_nan() || offset.abs() > LARGEST {
            let allowed = match label {
                "on_ground" | "centered" => "-1e9 to 1e9, by a solid with a finite box",
                "aligned" => "-1e9 to 1e9, by faces across the same axis of two solids with finite boxes",
                _ => "-1e9 to 1e9",
            };
            return Err(ParamError::new(format_args!("translation.{axis}"), offset, allowed));
        }
    }
    let name = match label {
        "scale" => "factor",
        "scale_axes" => "factors",
        "rotate" => "rotation",
        "rotate_about" => "axis or angle",
        label if label.starts_with("rotate_") => "angle",
        _ => "matrix",
    };
    if let Some(bad) = map.matrix3.to_cols_array().into_iter().find(|v| v.is_nan() || v.abs() > LARGEST) {
        return Err(ParamError::new(format_args!("{name} (an entry of the matrix)"), bad, "-1e9 to 1e9"));
    }
    let least = if map.matrix3.determinant() == 0.0 { 0.0 } else { least_stretch(&map.matrix3) };
    let most = 1.0 / if least > 0.0 { least_stretch(&map.matrix3.inverse()) } else { 1.0 };
    if !(least >= 1e-9 && least >= 1e-9 * most) {
        return Err(ParamError::new(
            format_args!("{name} (smallest stretch)"),
            if least.is_nan() { 0.0 } else { least },
            "at least 1e-9, and at least 1e-9 of the largest (the map must be invertible)",
        ));
    }
    Ok(())
}
