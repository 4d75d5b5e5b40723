//! Distances that count on one side of a surface: what operands know of them is not measured.
//!
//! ```text
//!     outside of a union           the least of the distances outside of its operands
//!     inside of an intersection    the least of those inside of them
//!     inside of a difference       the least of that inside of the first, and outside of the others
//! ```

use std::sync::Arc;

use super::accuracy::Accuracy;
use super::apart::distance;
use super::compile::{compile, compile_and_bound, kept};
use super::composite::as_distance;
use super::exact::Exactness;
use super::source::{CompileError, DistanceSource, Parts, Wanted};
use crate::solid::{Node, Operation};
use crate::{Bounds, RFunction, Run, Solid};
use rvachev_field::AnyField;

/// A side of a surface.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Side {
    Inside,
    Outside,
}

impl Side {
    /// Where an operand of a solid that is within bounds is asked for: from inside the solid, what
    /// is beyond them is farther than what cuts it off there.
    pub(super) fn region(self, region: &Bounds, bounds: &Bounds) -> Bounds {
        match self {
            Side::Inside if region.intersects(bounds) => region.intersection(bounds),
            _ => *region,
        }
    }
}

/// A distance that counts on one side.
pub(super) struct Found {
    pub(super) field: Arc<dyn AnyField>,
    /// The join that it is of distances, if it is one.
    pub(super) parts: Option<Parts>,
    pub(super) accuracy: Accuracy,
}

/// The distance on one side of the surface of a solid, and how far it may be off. What operands
/// tell themselves is not measured: the others are, together.
pub(super) fn sided(
    (solid, side): (&Solid, Side),
    wanted: &Wanted<'_>,
    exact: &Exactness,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<Found, CompileError> {
    let Some((operation, known, rest)) = divided(solid, side, exact) else {
        compile_and_bound(solid, source, run)?;
        let (field, accuracy) = distance(solid, wanted, source, run)?;
        return Ok(Found { field, parts: None, accuracy });
    };
    let whole = kept(solid).map(|programs| programs.bounds_with(run)).transpose()?;
    let region = whole.map_or(*wanted.region, |bounds| side.region(wanted.region, &bounds));
    let rest = sided((&rest, side), &Wanted { region: &region, ..*wanted }, exact, source, run)?;
    let (mut fields, mut accuracy) = (vec![rest.field], rest.accuracy);
    for operand in &known {
        let programs = compile_and_bound(operand, source, run)?;
        accuracy = accuracy.max(programs.accuracy);
        fields.push(as_distance(programs.surface.clone(), programs.bounds()));
    }
    let leaves = fields.iter().map(|field| Solid::from_node(Node::Leaf(field.clone()))).collect();
    let joined = Solid::from_node(Node::Join { operation, rule: RFunction::MIN_MAX, operands: leaves });
    let programs = compile(&joined, source, run)?;
    // That of the distances is not searched for where the solid's own is known.
    let bounds = whole.map_or_else(|| programs.bounds_with(run), Ok)?;
    let field = as_distance(programs.surface.clone(), bounds);
    Ok(Found { field, parts: Some(Parts { operation, fields: fields.into() }), accuracy })
}

/// A join in which some operands know their distances, and what is left without them, which comes
/// first; nothing where none does.
pub(super) fn divided(solid: &Solid, side: Side, exact: &Exactness) -> Option<(Operation, Vec<Solid>, Solid)> {
    let mut node = solid.node();
    while let Node::Named { operand, .. } | Node::Painted { operand, .. } = node {
        node = operand.node();
    }
    let Node::Join { operation, rule, operands } = node else { return None };
    let of_side = match operation {
        Operation::Union => Side::Outside,
        Operation::Intersection | Operation::Difference => Side::Inside,
        _ => return None,
    };
    if side != of_side || *rule == RFunction::Distance {
        return None;
    }
    let is_taken_away = |number: usize| *operation == Operation::Difference && number > 0;
    let is_known = |number: usize| {
        let own = exact.of(&operands[number]);
        if (side == Side::Inside) != is_taken_away(number) { own.inside } else { own.outside }
    };
    // A difference begins with what something is taken from.
    let is_kept = |number: usize| !is_known(number) || *operation == Operation::Difference && number == 0;
    let (rest, known): (Vec<usize>, Vec<usize>) = (0..operands.len()).partition(|number| is_kept(*number));
    let solids = |numbers: Vec<usize>| numbers.into_iter().map(|number| operands[number].clone()).collect::<Vec<_>>();
    let (rest, known) = (solids(rest), solids(known));
    if known.is_empty() || rest.is_empty() {
        return None;
    }
    let rest = match &rest[..] {
        [one] => one.clone(),
        _ => Solid::from_node(Node::Join { operation: *operation, rule: *rule, operands: rest }),
    };
    Some((*operation, known, rest))
}
