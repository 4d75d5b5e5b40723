//! Blends: those that read values, and the fillets and chamfers that are filled in.

use std::sync::Arc;

use super::{Compiler, Site, kept};
use crate::eval::apart::{Near, measured};
use crate::eval::bevel::Bevel;
use crate::eval::chamfer::Chamfer;
use crate::eval::code::Built;
use crate::eval::fill::{Fill, Side};
use crate::eval::program::Program;
use crate::eval::signed::Signed;
use crate::eval::source::Measured;
use crate::solid::{self, Operation};
use crate::{Blend, Bounds, Solid, SolidError};
use rvachev_field::{AnyField, Op, Rule, Zone};

/// Fillets are this much smaller, in radii, so that flush faces stay as they are; and no smaller
/// than that for what measuring may be off.
const FLUSH: f64 = 1e-5;
const LARGEST_MARGIN: f64 = 1e-3;

/// A chamfer has a face for each two parts of its operands if these are not more.
const FACES: usize = 64;

/// What the faces of a chamfer have in common.
struct Faces {
    /// −1 for an operand whose complement is joined.
    signs: [f64; 2],
    chamfer: Chamfer,
    bounds: Bounds,
    near_joint: Zone,
    /// Whether leaves have a face for each of their walls.
    has_walls: bool,
}

impl Compiler<'_> {
    pub(super) fn blended(
        &mut self,
        site: Site<'_>,
        operation: Operation,
        blend: Blend,
        below: &[Built],
    ) -> Result<Built, SolidError> {
        let context = *self.contexts.get(site.context);
        let (scale, frame) = (context.scale, context.frame);
        let op = operation.op();
        if let Blend::Fillet { radius } = blend {
            let fills = self.fills(site, operation, radius);
            return Ok(self.filled(site, operation, below, &fills));
        }
        let &[first, second] = below else {
            return Err(SolidError::EmptyJoin { path: self.scene.trail.path(site.step) });
        };
        let pair = [first, second];
        match blend {
            Blend::Smooth { radius } => {
                let width = radius * scale;
                let inside = if op == Op::Or { self.smooth_union(site, width, pair) } else { Bounds::ALL };
                Ok(self.code.smooth(operation, width, frame, pair, inside))
            }
            Blend::Displacement { height, falloff } => {
                let inverse = falloff.map(|f| 1.0 / (f * scale));
                let height = height * scale;
                // The disjunction of equal values −c is −(2 − √2) c.
                let rise = if op == Op::Or { height / (2.0 - std::f64::consts::SQRT_2) } else { height };
                let risen = self.risen(site, [rise; 2]);
                Ok(self.code.displacement(operation, height, inverse, frame, pair, risen))
            }
            Blend::Ricci { p } => {
                let [Some(first), Some(second)] = pair.map(|b| b.gauge) else {
                    let position = usize::from(pair[0].gauge.is_some());
                    return Err(SolidError::NoGauge { path: self.scene.trail.path(site.step), operand: position });
                };
                // Two gauges of 2^(1/p) make one of 1.
                let beyond = (1.0 / p).exp2() - 1.0;
                let risen = self.risen(site, [first * beyond, second * beyond]);
                Ok(self.code.ricci(operation, p, [first, second], frame, pair, risen))
            }
            Blend::Chamfer { leg } => {
                let face = self.chamfered(site, operation, leg)?;
                Ok(self.filled(site, operation, below, &face))
            }
            _ => Ok(self.code.operation(operation, Rule::MinMax, frame, below)),
        }
    }

    /// What a fillet adds between the operands of a node, or of a complement's.
    pub(super) fn fills(&mut self, site: Site<'_>, operation: Operation, radius: f64) -> Vec<Built> {
        let Some(measured) = measured(site.solid) else { return Vec::new() };
        let is_union = operation == Operation::Union;
        let margin = margin(site.solid, &measured, radius);
        let ball = Signed { field: measured.field.clone(), sign: if is_union { 1.0 } else { -1.0 } };
        let solid::Node::Blend { blend, .. } = site.solid.node() else {
            let radius = rolling(site.solid).unwrap_or(radius);
            let whole = kept(&site.solid.node().operands()[0]).map_or(Bounds::EMPTY, |programs| programs.bounds());
            // What is taken away goes on beyond the surface: values are 0 where the new one is, and
            // nowhere else.
            let (bounds, hull) = if is_union { (whole, whole) } else { (whole.inflate(radius), Bounds::ALL) };
            let fill = Fill::new(radius, ball, Vec::new(), margin).within(vec![bounds], hull);
            return vec![self.made(&(Arc::new(fill) as Arc<dyn AnyField>), site, 0.0)];
        };
        let near = Near::of(operation, *blend, measured.operands(site.solid));
        if near.boxes.is_empty() {
            return Vec::new();
        }
        let Near { boxes, hull, around, .. } = near;
        let side = |(number, field): (usize, &Arc<dyn AnyField>)| {
            let is_outside = is_union || operation == Operation::Difference && number > 0;
            let sign = if is_outside { -1.0 } else { 1.0 };
            Side { distance: Signed { field: field.clone(), sign }, bounds: around[number] }
        };
        let sides = measured.sides.iter().enumerate().map(side).collect();
        let fill = Fill::new(radius, ball, sides, margin).within(boxes, hull);
        vec![self.made(&(Arc::new(fill) as Arc<dyn AnyField>), site, 0.0)]
    }

    /// The face of a chamfer, cut off where a ball reaches that rolls along the operands.
    pub(super) fn chamfered(
        &mut self,
        site: Site<'_>,
        operation: Operation,
        leg: f64,
    ) -> Result<Vec<Built>, SolidError> {
        let solid::Node::Blend { blend, .. } = site.solid.node() else { return Ok(Vec::new()) };
        let Some(measured) = measured(site.solid) else { return Ok(Vec::new()) };
        let operands = measured.operands(site.solid);
        let [a, b] = [self.alone(site, &operands[0])?, self.alone(site, &operands[1])?];
        let signs = match operation {
            Operation::Union => [1.0, 1.0],
            Operation::Difference => [-1.0, 1.0],
            _ => [-1.0, -1.0],
        };
        let steepest = [&a.surface, &b.surface].map(steepest);
        let chamfer = Chamfer { leg, steepest: steepest[0].max(steepest[1]) };
        let frame = self.contexts.get(site.context).frame;
        let near = Near::of(operation, *blend, operands);
        let Some(bounds) = near.boxes.first().copied() else { return Ok(Vec::new()) };
        // Of many operands' parts only those that count near the joint have faces.
        let near_joint = Zone::of_bounds(&bounds.inflate(leg));
        let pair = [&a.surface, &b.surface].map(|operand| operand.reduced(&near_joint));
        let are_few = |count: fn(&Program) -> usize| count(&pair[0]) * count(&pair[1]) <= FACES;
        let has_walls = are_few(Program::wall_count);
        let faces = Faces { signs, chamfer, bounds, near_joint, has_walls };
        let is_few = are_few(Program::leaf_count);
        let bevel = if is_few { self.faces(site, &faces, pair) } else { self.face(site, &faces, pair) };
        let ball =
            Signed { field: measured.field.clone(), sign: if operation == Operation::Union { 1.0 } else { -1.0 } };
        let margin = margin(site.solid, &measured, near.radius);
        let fill: Arc<dyn AnyField> =
            Arc::new(Fill::new(near.radius, ball, Vec::new(), margin).within(near.boxes, near.hull));
        let both = [bevel, self.made(&fill, site, 0.0)];
        Ok(vec![self.code.operation(Operation::Intersection, Rule::MinMax, frame, &both)])
    }

    /// The faces between all parts of two operands, joined as these are. That of a union by itself
    /// goes by the part that is nearest, and jumps where another one is. Fillets and chamfers of
    /// operands have none: beyond their joints their values are no distances.
    fn faces(&mut self, site: Site<'_>, of: &Faces, pair: [Program; 2]) -> Built {
        let choices = |side: usize| {
            let walls = || pair[side].walls().filter(|_| of.has_walls);
            pair[side].choices().or_else(walls).map(|(op, parts)| (side, op, parts))
        };
        let Some((side, op, mut parts)) = choices(0).or_else(|| choices(1)) else {
            return self.face(site, of, pair);
        };
        let is_union = op.flip_if(of.signs[side] < 0.0) == Op::Or;
        // Walls that all of the joint is within bound no face.
        if parts.len() > 1 && op == Op::And {
            let is_near = |part: &Program| part.range_zone(&of.near_joint).lo() <= of.chamfer.reach();
            let near: Vec<Program> = parts.iter().filter(|part| is_near(part)).cloned().collect();
            if !near.is_empty() {
                parts = near;
            }
        }
        let is_blend = |part: &Program| part.is_rolled_leaf() || part.is_chamfer();
        let has_others = parts.iter().any(|part| !is_blend(part));
        let faces: Vec<Built> = (parts.into_iter())
            .filter(|part| !has_others || !is_blend(part))
            .map(|part| {
                let mut pair = pair.clone();
                pair[side] = part;
                self.faces(site, of, pair)
            })
            .collect();
        let operation = if is_union { Operation::Union } else { Operation::Intersection };
        let frame = self.contexts.get(site.context).frame;
        self.code.operation(operation, Rule::MinMax, frame, &faces)
    }

    /// The face between two operands.
    fn face(&mut self, site: Site<'_>, of: &Faces, pair: [Program; 2]) -> Built {
        let bevel = Bevel::new(pair, of.signs, of.chamfer, of.bounds);
        self.made(&(Arc::new(bevel) as Arc<dyn AnyField>), site, 0.0)
    }

    /// A join of operands with what is added to it, or, for intersections and differences, taken
    /// away.
    pub(super) fn filled(&mut self, site: Site<'_>, operation: Operation, below: &[Built], fills: &[Built]) -> Built {
        let frame = self.contexts.get(site.context).frame;
        let join = self.code.operation(operation, Rule::MinMax, frame, below);
        let all: Vec<Built> = [join].into_iter().chain(fills.iter().copied()).collect();
        let operation = if operation == Operation::Union { operation } else { Operation::Difference };
        self.code.operation(operation, Rule::MinMax, frame, &all)
    }
}

/// The radius of the ball that rolls along a solid.
fn rolling(solid: &Solid) -> Option<f64> {
    match solid.node().ball()?.node() {
        solid::Node::Length { length, .. } => Some(length.amount().abs()),
        _ => None,
    }
}

/// How much smaller a fillet of a radius is.
fn margin(solid: &Solid, measured: &Measured, radius: f64) -> f64 {
    let largest = solid.node().tolerance().unwrap_or(0.0).max(LARGEST_MARGIN * radius);
    (measured.accuracy.error + FLUSH * radius).min(largest)
}

/// How steep the values of a solid are taken to be.
fn steepest(program: &Program) -> f64 {
    program.steepest_leaf().map_or(4.0, |slope| slope.max(1.0))
}
