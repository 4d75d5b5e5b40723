//! The surface of what is at a distance from another surface, put together from that one's faces.

use std::sync::Arc;

use super::compiled_with;
use super::offset_faces::Offset;
use super::quilt::{GROSS, Quilt};
use super::surface::{FEW, FromMeshes};
use crate::eval::{Accuracy, CompileError, Compiled, Surface, Wanted, surface};
use crate::mesh::Slopes;
use crate::solid::{Length, Node};
use crate::{Bounds, Run, Solid};
use rvachev_field::Patches;

/// The surface of a solid that is at a distance from another one, to within a tolerance; nothing if
/// it is not, or if it is not found so. What is larger than a cell is divided where faces end.
pub(super) fn by_faces(
    (solid, programs): (&Solid, &Compiled),
    wanted: &Wanted<'_>,
    (tolerance, cell): (f64, f64),
    run: &Run,
) -> Result<Option<Surface>, CompileError> {
    let Some((operand, by)) = at_distance(solid) else { return Ok(None) };
    let [to_compile, to_find, to_move, to_join] = &run.stages([0.05, 0.5, 0.4, 0.05]);
    let own = compiled_with(operand, to_compile)?;
    if !own.bounds().is_finite() {
        return Ok(None);
    }
    let near = wanted.near();
    let region = if wanted.region.is_finite() { near.inflate(by.abs()) } else { Bounds::ALL };
    let of_operand = Wanted { length: by.abs(), region: &region, by_patches: false, ..*wanted };
    let surface = surface(operand, &own, &of_operand, &FromMeshes, to_find)?;
    if surface.flat.is_some() || surface.accuracy.error > GROSS * surface.tolerance {
        return Ok(None);
    }
    let offset = Offset {
        patches: &surface.patches,
        of: &Slopes { program: &own.surface, precision: tolerance, reach: by.abs() },
        by,
        level: &Slopes { program: &programs.surface, precision: tolerance, reach: by.abs() },
        near: &near,
        tolerance,
        grain: programs.accuracy.grain(),
        slack: surface.accuracy.error,
        cell,
    };
    let Some(faces) = offset.faces(to_move)? else { return Ok(None) };
    let mut quilt = Quilt::of(Vec::new(), tolerance);
    quilt.add_all(faces.into_iter());
    if quilt.error > GROSS * tolerance + offset.slack {
        return Ok(None);
    }
    let patches = Patches::new(&quilt.patches, to_join)?;
    let accuracy = Accuracy::of_surface(quilt.reached(FEW), quilt.error);
    Ok(Some(Surface::new(Arc::new(patches), accuracy, None).in_doubt(tolerance, quilt.doubts(tolerance))))
}

/// What a solid is at a distance from, and how far outwards, if it is.
fn at_distance(solid: &Solid) -> Option<(&Solid, f64)> {
    let mut solid = solid;
    loop {
        solid = match solid.node() {
            Node::Named { operand, .. } | Node::Painted { operand, .. } => operand,
            Node::Toleranced { built, .. } => built,
            Node::Length { operand, length: Length::Offset(by), .. } => return Some((operand, *by)),
            _ => return None,
        };
    }
}
