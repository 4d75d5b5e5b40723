//! What is compiled by itself: the operands of lengths and fillets that are measured.
//!
//! These come one after the other, operands first, so that neither the stack nor the work grows
//! with how deep they are nested.

use std::collections::HashSet;
use std::sync::Arc;

use super::compile::{Compiled, kept};
use super::composite::{Composite, Whole};
use super::depth::is_deeper;
use super::exact::Exactness;
use super::source::{CompileError, DistanceSource, Measured, Surface};
use crate::solid::{Length, Node};
use crate::{Blend, Run, Solid};
use rvachev_field::SurfaceDistance;

/// What is done for a solid, one after the other.
pub(super) enum Work<'a> {
    /// A part is compiled by itself.
    Compile(&'a Solid),
    /// The distance that a node is about is measured, from operands that have been compiled.
    Measure(&'a Solid),
}

/// What is to be done for a solid, operands first, its own compilation last.
pub(super) fn works<'a>(root: &'a Solid, exact: &Exactness) -> Vec<Work<'a>> {
    let (mut works, mut met) = (Vec::new(), HashSet::new());
    let mut pending = vec![(root, false)];
    while let Some((solid, is_done)) = pending.pop() {
        if is_done {
            let alone = alone(solid, exact);
            works.extend(alone.iter().map(Work::Compile));
            works.extend((!alone.is_empty()).then_some(Work::Measure(solid)));
        } else if met.insert(solid.address()) && kept(solid).is_none() {
            // What was compiled before has its parts.
            pending.push((solid, true));
            pending.extend(solid.node().parts().iter().map(|part| (part, false)));
        }
    }
    works.push(Work::Compile(root));
    works
}

/// The operands of a node that are compiled by themselves.
fn alone<'a>(solid: &'a Solid, exact: &Exactness) -> &'a [Solid] {
    match solid.node() {
        Node::Length { length: Length::Level(_), .. } => &[],
        Node::Length { operand, .. } if !exact.is_closed(solid) => std::slice::from_ref(operand),
        Node::Blend { blend: Blend::Fillet { .. } | Blend::Chamfer { .. }, operands, .. } => operands,
        _ => &[],
    }
}

/// Measures the distance that a solid's length is about, if it has one that its operand does not
/// tell. What was measured before is kept.
pub(super) fn measure(
    solid: &Solid,
    exact: &Exactness,
    source: &dyn DistanceSource,
    run: &Run,
) -> Result<(), CompileError> {
    let Node::Length { operand, length } = solid.node() else { return Ok(()) };
    if matches!(length, Length::Level(_)) || exact.is_closed(solid) || measured(solid).is_some() {
        return Ok(());
    }
    let by = match *length {
        Length::Shell(t) => -t,
        other => other.amount(),
    };
    let Some(programs) = kept(operand) else { return Ok(()) };
    let distance = distance(operand, &programs, by.abs(), source, run)?;
    let is_gone = by < 0.0 && !is_deeper(&*distance.field, &programs.bounds, distance.error - by, run)?;
    let _ = solid.measured().set(Arc::new(Measured { is_gone, ..distance }));
    Ok(())
}

/// The distance to the surface of a solid.
fn distance(
    solid: &Solid,
    programs: &Arc<Compiled>,
    length: f64,
    source: &dyn DistanceSource,
    run: &Run,
) -> Result<Measured, CompileError> {
    let Surface { patches, error, flat } = source.surface(solid, programs, length, run)?;
    let sign = Composite { program: Whole::new(programs.surface.clone()), bounds: programs.bounds };
    let field = SurfaceDistance::new(patches, Arc::new(sign), error, flat, programs.bounds);
    Ok(Measured { field: Arc::new(field), error, is_gone: false })
}

/// What was measured of a solid.
pub(super) fn measured(solid: &Solid) -> Option<Measured> {
    let kept = solid.measured().get()?;
    kept.downcast_ref::<Measured>().cloned()
}
