//! Boxes of what is inside a node, and of where its value is above −c.

use std::sync::Arc;

use super::{Compiler, Site, kept, measured};
use crate::eval::code::{Built, snug};
use crate::eval::support::box_under;
use crate::eval::swell::Swell;
use crate::solid::{self, Length, Operation};
use crate::{Blend, Bounds, Solid};
use rvachev_field::{AnyWarp, Op, Rule};

/// Boxes of nested nodes about which little is known are looked for no deeper than this.
const DEEPEST: u32 = 64;

impl Compiler<'_> {
    /// A box, in the frame of `context`, of where a solid's true value is above −c < 0.
    fn above(&self, solid: &Solid, context: u32, c: f64) -> Bounds {
        self.members(solid, context, self.of(solid, context).swell.reach(c), DEEPEST)
    }

    /// The same of where the value of some member is above `-reach`.
    fn members(&self, solid: &Solid, context: u32, reach: f64, depth: u32) -> Bounds {
        if let Some(bounds) = self.of(solid, context).swell.members(reach) {
            return bounds;
        }
        if depth == 0 || !reach.is_finite() {
            return Bounds::ALL;
        }
        let node = solid.node();
        let below = self.contexts.below(solid, context);
        let mut inner = below.iter().map(|&(at, inner)| self.members(&node.parts()[at], inner, reach, depth - 1));
        let is = |operation| match node {
            solid::Node::Join { operation: own, .. }
            | solid::Node::Blend { operation: own, blend: Blend::Smooth { .. }, .. } => *own == operation,
            // What is taken off makes values smaller.
            solid::Node::Blend { operation: own, ball: Some(_), .. } => {
                *own == operation && operation != Operation::Union
            }
            _ => false,
        };
        match node {
            solid::Node::Affine { .. }
            | solid::Node::Named { .. }
            | solid::Node::Repeated { .. }
            | solid::Node::Toleranced { .. }
            | solid::Node::Swept { .. }
            | solid::Node::Length { length: Length::Level(_), .. }
            | solid::Node::Painted { .. } => inner.next().unwrap_or(Bounds::ALL),
            solid::Node::Warp { warp, .. } => {
                let inside = inner.next().unwrap_or(Bounds::ALL);
                self.image(warp, context, &inside)
            }
            solid::Node::Blend { operation: Operation::Union, ball: Some(_), .. } => {
                inner.fold(self.filling(solid, context, reach), |all, own| all.union(&own))
            }
            _ if is(Operation::Difference) => inner.next().unwrap_or(Bounds::ALL),
            _ if is(Operation::Intersection) => inner.fold(Bounds::ALL, |all, own| all.intersection(&own)),
            _ if is(Operation::Union) => inner.fold(Bounds::EMPTY, |all, own| all.union(&own)),
            _ => Bounds::ALL,
        }
    }

    /// A box, in the frame of `context`, of where the value of what a fillet or chamfer adds between
    /// operands is above `-reach`: it is held to their hull, and falls as lengths do beyond it.
    fn filling(&self, solid: &Solid, context: u32, reach: f64) -> Bounds {
        let context = self.contexts.get(context);
        let Some(measured) = measured(solid) else { return Bounds::EMPTY };
        if context.moved.is_some() {
            return Bounds::ALL;
        }
        let of_operand = |operand: &Solid| kept(operand).map_or(Bounds::ALL, |programs| programs.bounds());
        let operands = measured.operands(solid);
        let hull = operands.iter().map(of_operand).fold(Bounds::EMPTY, |all, own| all.union(&own));
        if hull.is_empty() { hull } else { snug(hull.inflate(reach / context.scale).transformed(&context.forward)) }
    }

    /// What of a box is no farther than the node at `site` reaches along the axes of its frame.
    pub(super) fn cut_to_support(&self, site: Site<'_>, bounds: Bounds) -> Bounds {
        let context = self.contexts.get(site.context);
        if bounds.is_empty() || context.moved.is_some() {
            return bounds;
        }
        bounds.intersection(&snug(box_under(site.solid, &context.forward)))
    }

    /// The box, in the frame of `context`, of what a deformation makes of what a box holds.
    pub(super) fn image(&self, warp: &Arc<dyn AnyWarp>, context: u32, bounds: &Bounds) -> Bounds {
        if bounds.is_empty() {
            return *bounds;
        }
        snug(warp.bounds(bounds).transformed(&self.contexts.get(context).forward))
    }

    /// The boxes of a blend's operands where they are above −c, each with its own c.
    pub(super) fn risen(&self, site: Site<'_>, c: [f64; 2]) -> [Bounds; 2] {
        self.each(site, |operand, inner, i| self.above(operand, inner, c[i].max(0.0)))
    }

    /// A box of each of two operands, told by the operand, its context and its number.
    fn each(&self, site: Site<'_>, bounds: impl Fn(&Solid, u32, usize) -> Bounds) -> [Bounds; 2] {
        let mut boxes = [Bounds::ALL; 2];
        for (i, &(at, inner)) in self.contexts.below(site.solid, site.context).iter().take(2).enumerate() {
            boxes[i] = bounds(&site.solid.node().operands()[at], inner, i);
        }
        boxes
    }

    /// A box of the smooth union of two operands: no farther from its members than it rises.
    pub(super) fn smooth_union(&self, site: Site<'_>, width: f64, pair: [Built; 2]) -> Bounds {
        let swell = Swell::joined(Op::Or, Rule::Smooth(width), pair.map(|b| b.swell).to_vec());
        let risen = self.each(site, |operand, inner, _| self.members(operand, inner, swell.reach(0.0), DEEPEST));
        risen[0].union(&risen[1])
    }
}
