//! What is compiled by itself: the operands of lengths and fillets that are measured.
//!
//! These come one after the other, operands first, so that neither the stack nor the work grows
//! with how deep they are nested.

use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec3;
use rvachev_num::order;

use super::accuracy::Accuracy;
use super::bend::Bend;
use super::compile::{Compiled, kept};
use super::composite::as_leaf;
use super::depth::is_deeper;
use super::exact::Exactness;
use super::fill::FARTHEST;
use super::nothing::Nothing;
use super::sided::{Found, Side, divided, sided};
use super::source::{CompileError, DistanceSource, Measured, Surface, Wanted, reach, surface};
use super::tiles::Tiles;
use crate::solid::{BALL_OF_LEGS, DEVIATION, Length, Node, Operation};
use crate::{Blend, Bounds, Cancelled, Run, Solid};
use rvachev_field::{AnyField, SurfaceDistance};

/// What is done for a solid, one after the other.
pub(super) enum Work<'a> {
    /// A part is compiled by itself.
    Compile(&'a Solid),
    /// The distance that a node is about is measured, from operands that have been compiled.
    Measure(&'a Solid),
}

impl Work<'_> {
    /// About how long it takes, in surfaces.
    pub(super) fn effort(&self) -> f64 {
        /// Compiling takes a small part of the time.
        const COMPILING: f64 = 0.02;
        match self {
            Work::Compile(_) => COMPILING,
            Work::Measure(solid) => match solid.node() {
                Node::Blend { blend: Blend::Fillet { .. }, operands, .. } => 1.0 + operands.len() as f64,
                _ => 1.0,
            },
        }
    }
}

/// What is to be done for solids, operands first, their own compilation last.
pub(super) fn works<'a>(roots: Vec<&'a Solid>, exact: &Exactness, run: &Run) -> Result<Vec<Work<'a>>, Cancelled> {
    let (mut works, mut met) = (Vec::new(), HashSet::new());
    let mut pending: Vec<_> = roots.iter().rev().map(|root| (*root, false)).collect();
    while let Some((solid, is_done)) = pending.pop() {
        run.check()?;
        if is_done {
            let alone = alone(solid, exact);
            let is_measured = is_blended(solid) || !alone.is_empty();
            works.extend(alone.into_iter().map(Work::Compile));
            works.extend(is_measured.then_some(Work::Measure(solid)));
        } else if met.insert(solid.address()) && kept(solid).is_none() {
            // What was compiled before has its parts.
            pending.push((solid, true));
            let ball = solid.node().ball().filter(|_| !is_blended(solid) && !exact.is_certain(solid));
            pending.extend(solid.node().parts().iter().chain(ball).map(|part| (part, false)));
        }
    }
    works.extend(roots.into_iter().map(Work::Compile));
    Ok(works)
}

/// Whether a ball rolls along the operands of a node: it is found by what of these is near the
/// joint, once they are known.
pub(super) fn is_blended(solid: &Solid) -> bool {
    matches!(solid.node(), Node::Blend { ball: Some(_), .. })
}

/// What of a node is compiled by itself.
fn alone<'a>(solid: &'a Solid, exact: &Exactness) -> Vec<&'a Solid> {
    match solid.node() {
        Node::Length { length: Length::Level(_), .. } => Vec::new(),
        Node::Length { .. } if exact.is_gone(solid) || exact.is_certain(solid) => Vec::new(),
        Node::Length { operand, length, ball, about, .. } if !exact.is_closed(solid) || length.inwards() > 0.0 => {
            // Where a blend is depends on how large its operands are.
            let blended = about.iter().flat_map(|_| operand.node().operands());
            blended.chain([operand]).chain(ball).collect()
        }
        Node::Swept { profile, ball: Some(_), .. } => vec![&profile.0],
        _ => Vec::new(),
    }
}

/// Measures the distances that a node is about, if it is about any that its operands do not tell.
/// What was measured before is kept.
pub(super) fn measure(
    solid: &Solid,
    exact: &Exactness,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<(), CompileError> {
    if measured(solid).is_some() {
        return Ok(());
    }
    let tolerance = solid.node().tolerance();
    let found = match solid.node() {
        Node::Length { ball: Some(ball), length, .. } => {
            let wanted = Wanted::of(length.amount(), tolerance, &Bounds::ALL);
            let (field, accuracy) = distance(ball, &wanted, source, run)?;
            // Of an opening nothing is left if there is no room for the ball, of a closing if
            // there was nothing to close.
            let is_gone = kept(ball).is_none_or(|programs| programs.bounds().is_empty());
            Measured { field, parts: None, accuracy, is_gone, sides: Vec::new(), local: None }
        }
        Node::Length { operand, length, about, .. } => {
            let inwards = length.inwards();
            let Some(programs) = kept(operand) else { return Ok(()) };
            let (field, parts, accuracy) = match exact.is_closed(solid) {
                true => (sign(&programs), None, Accuracy::default()),
                false => {
                    let region = about.map_or(Bounds::ALL, |blend| region_of_ball(operand, blend, &programs.bounds()));
                    let asked = about.map_or(inwards.abs(), asked);
                    let wanted = Wanted { asked, ..Wanted::of(inwards.abs(), tolerance, &region) };
                    let side = if inwards > 0.0 { Side::Inside } else { Side::Outside };
                    let Found { field, parts, accuracy } = sided((operand, side), &wanted, exact, source, run)?;
                    (field, parts, accuracy)
                }
            };
            let mut bounds = programs.bounds();
            // Of a column a section does.
            if let Some(axis) = programs.flat_axis() {
                (bounds.min[axis], bounds.max[axis]) = (0.0, 0.0);
            }
            let is_thin = inwards > 0.0 && bounds.is_finite();
            // What is hardly known is not gone for that.
            let noise = accuracy.tolerance.min(tolerance.unwrap_or(DEVIATION * inwards));
            let is_gone = bounds.is_empty() || is_thin && !is_deeper(&*field, &bounds, inwards + noise, run)?;
            Measured { field, parts, accuracy, is_gone, sides: Vec::new(), local: None }
        }
        Node::Blend { operation, blend, operands, ball: Some(ball), .. } => {
            let near = Near::of(*operation, *blend, operands);
            let region = near.region();
            let wanted = Wanted { asked: asked(*blend), ..Wanted::of(near.radius, tolerance, &region) };
            // The ball's distance, and those of the operands.
            let count = if near.fades { 1 + operands.len() } else { 1 };
            let stage = |number: usize| run.stage(number as f64 / count as f64, (number + 1) as f64 / count as f64);
            let (field, accuracy) = distance(ball, &wanted, source, &stage(0))?;
            let mut sides = Vec::new();
            // An operand that the ball's own distance is measured from has one surface for both.
            let shared = match ball.node() {
                Node::Length { operand: joined, .. } => kept(joined).and_then(|programs| {
                    let side = if *operation == Operation::Union { Side::Outside } else { Side::Inside };
                    let (.., rest) = divided(joined, side, exact)?;
                    let region = region_of_ball(joined, *blend, &programs.bounds());
                    Some((rest.address(), side.region(&region, &programs.bounds())))
                }),
                _ => None,
            };
            if near.fades {
                for (number, operand) in operands.iter().enumerate() {
                    let is_outside =
                        *operation == Operation::Union || *operation == Operation::Difference && number > 0;
                    let own = exact.of(operand);
                    let known = if is_outside { own.outside } else { own.inside };
                    let shared = shared.as_ref().filter(|(rest, _)| *rest == operand.address());
                    let wanted = Wanted { region: shared.map_or(&region, |(_, region)| region), ..wanted };
                    sides.push(match kept(operand).filter(|_| known) {
                        Some(programs) => sign(&programs),
                        None => distance(operand, &wanted, source, &stage(1 + number))?.0,
                    });
                }
            }
            Measured { field, parts: None, accuracy, is_gone: false, sides, local: None }
        }
        _ => return Ok(()),
    };
    let _ = solid.measured().set(Arc::new(found));
    Ok(())
}

/// A solid's programs as a leaf.
pub(super) fn sign(programs: &Compiled) -> Arc<dyn AnyField> {
    as_leaf(programs.surface.clone(), programs.bounds())
}

/// The distance to the surface of a solid, and how far it may be off.
pub(super) fn distance(
    solid: &Solid,
    wanted: &Wanted<'_>,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<(Arc<dyn AnyField>, Accuracy), CompileError> {
    let Some(programs) = kept(solid) else { return Ok((Arc::new(Nothing), Accuracy::default())) };
    if !programs.bounds().intersection(wanted.region).is_finite()
        && programs.flat_axis().is_none()
        && !programs.bounds().is_empty()
    {
        let tiles = Tiles::new(solid.clone(), &programs, wanted, source);
        let accuracy = tiles.accuracy(&programs).plus(programs.accuracy);
        return Ok((Arc::new(tiles), accuracy));
    }
    let surface = surface(solid, &programs, wanted, source, run)?;
    let Surface { patches, accuracy, flat, .. } = &*surface;
    let field = SurfaceDistance::new(patches.clone(), sign(&programs), accuracy.error, *flat, programs.bounds());
    let field = field.within(wanted.near());
    Ok((Arc::new(field), accuracy.plus(programs.accuracy)))
}

/// Chamfers are right to a thousandth of so many legs: on round operands legs are no more exact.
const ASKED_LEGS: f64 = 4.0;

/// The length that a blend asks for.
fn asked(blend: Blend) -> f64 {
    match blend {
        Blend::Fillet { radius } => radius,
        Blend::Chamfer { leg } => ASKED_LEGS * leg,
        _ => 0.0,
    }
}

/// What was measured of a node.
pub(super) fn measured(solid: &Solid) -> Option<Measured> {
    let kept = solid.measured().get()?;
    kept.downcast_ref::<Measured>().cloned()
}

/// Faces of chamfers are no farther from an operand than so many legs.
const NEAR_LEGS: f64 = 4.0;

/// Farther than this from an operand nothing counts for what is between it and others.
pub(super) fn far(blend: Blend) -> f64 {
    match blend {
        Blend::Fillet { radius } => FARTHEST * radius,
        Blend::Chamfer { leg } => (2.0 * BALL_OF_LEGS + NEAR_LEGS) * leg,
        _ => f64::INFINITY,
    }
}

/// A box of what a ball leaves out between two convex operands: straight away from either of them,
/// by no more than a radius there and back, is a point that is a radius from it and less from the
/// other.
fn between_convex(pair: [(&Solid, Bounds); 2], radius: f64) -> Bounds {
    let middles = pair.iter().fold(Bounds::ALL, |all, (_, own)| all.intersection(&own.inflate(radius)));
    pair.iter().fold(Bounds::ALL, |all, (operand, _)| {
        let way = radius * kept(operand).map_or(DVec3::ONE, |programs| programs.outwards(&middles));
        all.intersection(&Bounds::new(middles.min - way, middles.max + way))
    })
}

/// Where the operands of a fillet or chamfer are so near to each other that there may be something
/// between them.
pub(super) struct Near {
    /// That of the ball.
    pub(super) radius: f64,
    /// Whether what is between operands fades away from them: between convex ones it need not.
    pub(super) fades: bool,
    /// Boxes of what may be between two operands.
    pub(super) boxes: Vec<Bounds>,
    /// What is between operands is not beyond this box.
    pub(super) hull: Bounds,
    /// By operand, a box beyond which it is far.
    pub(super) around: Vec<Bounds>,
}

/// Where the ball of a blend is asked for: its own surface is found in a box that reaches a little
/// beyond the joints of what is blended, which is within the bounds.
fn region_of_ball(joined: &Solid, blend: Blend, bounds: &Bounds) -> Bounds {
    let Node::Join { operation, operands, .. } = joined.node() else { return Bounds::ALL };
    let near = Near::of(*operation, blend, operands);
    let size = bounds.longest_side() + 2.0 * near.radius;
    near.region().inflate(reach(near.radius, size))
}

impl Near {
    /// A box about all joints.
    pub(super) fn region(&self) -> Bounds {
        self.boxes.iter().fold(Bounds::EMPTY, |all, own| all.union(own))
    }

    pub(super) fn of(operation: Operation, blend: Blend, operands: &[Solid]) -> Near {
        let is_convex =
            |operand: &Solid| kept(operand).is_some_and(|programs| programs.surface.bend() == Some(Bend::Concave));
        let fades =
            matches!(blend, Blend::Fillet { .. }) && !(operation == Operation::Union && operands.iter().all(is_convex));
        let (radius, reach) = match blend {
            Blend::Chamfer { leg } => (BALL_OF_LEGS * leg, NEAR_LEGS * leg),
            Blend::Fillet { radius } if fades => (radius, FARTHEST * radius),
            // The sum of the distances is below twice the radius.
            Blend::Fillet { radius } => (radius, 2.0 * radius),
            _ => (0.0, 0.0),
        };
        let boxes: Vec<Bounds> =
            operands.iter().map(|operand| kept(operand).map_or(Bounds::EMPTY, |programs| programs.bounds())).collect();
        let inside = match operation {
            Operation::Union => boxes.iter().fold(Bounds::EMPTY, |all, own| all.union(own)),
            Operation::Difference => boxes.first().copied().unwrap_or(Bounds::EMPTY),
            _ => boxes.iter().fold(Bounds::ALL, |all, own| all.intersection(own)),
        };
        // Of complements nothing is known but that they are near what is inside.
        let around: Vec<Bounds> = boxes
            .iter()
            .enumerate()
            .map(|(number, own)| match operation {
                Operation::Difference if number == 0 => Bounds::ALL,
                Operation::Union | Operation::Difference => own.inflate(reach),
                _ => Bounds::ALL,
            })
            .collect();
        let mut between = Vec::new();
        // From left to right, each with those that begin before it ends.
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order::rising(&mut order, |a| around[*a].min.x);
        for (at, &first) in order.iter().enumerate() {
            for &second in order[at + 1..].iter().take_while(|other| around[**other].min.x <= around[first].max.x) {
                let mut bounds = around[first].intersection(&around[second]).intersection(&inside);
                if matches!(blend, Blend::Fillet { .. }) && !fades {
                    bounds =
                        bounds.intersection(&between_convex([first, second].map(|i| (&operands[i], boxes[i])), radius));
                }
                if !bounds.is_empty() {
                    between.push(bounds);
                }
            }
        }
        let hull = if operation == Operation::Union { inside } else { Bounds::ALL };
        Near { radius, fades, boxes: between, hull, around }
    }
}
