//! What of the operands of a blend is near the joint.
//!
//! ```text
//!     +--+      |B |      |C |     C is joined to what A and B are together, with a fillet: A is
//!     |  |   __/|  |\__   |  |     near it, B and the fillet between A and B are not
//!     +----------------------------+
//!     |             A              |
//!     +----------------------------+
//! ```
//!
//! A ball of radius r that holds a point and is empty but for something farther than 2r from the
//! point is empty there. What is between convex operands is within 2r of both: what is farther than
//! 4r from one of them has nothing to do with it, nor does a fillet between others fade away as
//! far as that.

use glam::DAffine3;

use super::apart::{Near, far, is_blended, measured};
use super::known::Known;
use super::support::box_under;
use crate::solid::{Length, Node, Operation, blended};
use crate::{Bounds, Cancelled, RFunction, Run, Solid};

/// Boxes of nodes in their own coordinates, infinite where their parts do not tell.
pub(super) type Boxes = Known<Bounds>;

impl Boxes {
    /// A blend with what of its operands is near the joint, itself if that is all; nothing where
    /// there is no joint. Blends of its operands have been measured.
    pub(super) fn local(&mut self, solid: &Solid, run: &Run) -> Result<Option<Solid>, Cancelled> {
        let Node::Blend { operation, blend, operands, tolerance, ball: Some(_) } = solid.node() else {
            return Ok(None);
        };
        self.find(solid, |solid| solid.node().parts(), |known, solid| Ok(known.found(solid)), run)?;
        let boxes: Vec<Bounds> = operands.iter().map(|operand| self.of(operand).inflate(far(*blend))).collect();
        let sums = |boxes: &mut dyn Iterator<Item = &Bounds>| -> Vec<Bounds> {
            let add = |all: &mut Bounds, own: &Bounds| Some(std::mem::replace(all, all.union(own)));
            boxes.scan(Bounds::EMPTY, add).collect()
        };
        let (before, after) = (sums(&mut boxes.iter()), sums(&mut boxes.iter().rev()));
        let mut near = Vec::with_capacity(operands.len());
        for (number, operand) in operands.iter().enumerate() {
            let others = before[number].union(&after[operands.len() - 1 - number]);
            near.push(self.within(operand, others.intersection(&boxes[number]), run)?);
        }
        if are_same(operands, &near) {
            return Ok(Some(solid.clone()));
        }
        let left = left(*operation, near).filter(|left| left.len() > 1);
        Ok(left.map(|left| blended(*operation, left, *blend, *tolerance)))
    }

    fn of(&self, solid: &Solid) -> Bounds {
        self.get(solid).copied().unwrap_or(Bounds::ALL)
    }

    fn found(&self, solid: &Solid) -> Bounds {
        /// More than what is measured may be off.
        const MORE: f64 = 1.01;
        let node = solid.node();
        let inner = node.parts().iter().map(|part| self.of(part));
        let first = inner.clone().next().unwrap_or(Bounds::EMPTY);
        match node {
            Node::Leaf(field) => field.bounds_under(&DAffine3::IDENTITY),
            Node::Affine { operand, forward, .. } => match operand.node() {
                Node::Leaf(field) => field.bounds_under(forward),
                _ => first.transformed(forward),
            },
            Node::Named { .. } | Node::Painted { .. } | Node::Toleranced { .. } | Node::Repeated { .. } => first,
            Node::Length { length: Length::Offset(by), .. } => first.inflate(MORE * by.max(0.0)),
            Node::Length { length: Length::Shell(_) | Length::Rounded(_) | Length::Filleted(_), .. } => first,
            Node::Join { operation, .. } | Node::Blend { operation, ball: Some(_), .. } => match operation {
                Operation::Intersection => inner.fold(box_under(solid, &DAffine3::IDENTITY), |a, b| a.intersection(&b)),
                Operation::Difference => first,
                _ => inner.fold(Bounds::EMPTY, |all, own| all.union(&own)),
            },
            _ => box_under(solid, &DAffine3::IDENTITY),
        }
    }

    /// A solid that is as this one within a zone, without what of it is elsewhere; nothing if
    /// nothing of it is there.
    fn within(&self, root: &Solid, zone: Bounds, run: &Run) -> Result<Option<Solid>, Cancelled> {
        let mut pending = vec![(root, zone, false)];
        let mut done: Vec<Option<Solid>> = Vec::new();
        while let Some((solid, zone, is_open)) = pending.pop() {
            run.check()?;
            let node = solid.node();
            if is_open {
                let below = done.split_off(done.len() - node.parts().len());
                done.push(put_together(solid, below));
            } else if !self.of(solid).intersects(&zone) {
                done.push(None);
            } else if !zone.is_finite() || !is_taken_apart(solid, &zone) {
                done.push(Some(solid.clone()));
            } else {
                let inner = match node {
                    Node::Affine { forward, .. } => zone.transformed(&forward.inverse()),
                    _ => zone,
                };
                pending.push((solid, zone, true));
                pending.extend(node.parts().iter().rev().map(|part| (part, inner, false)));
            }
        }
        Ok(done.pop().flatten())
    }
}

/// Whether a solid is what its parts are within a zone.
fn is_taken_apart(solid: &Solid, zone: &Bounds) -> bool {
    match solid.node() {
        Node::Affine { .. } | Node::Named { .. } | Node::Painted { .. } | Node::Toleranced { .. } => true,
        Node::Join { .. } => true,
        Node::Blend { operation, blend, .. } if is_blended(solid) => !measured(solid)
            .is_some_and(|found| Near::of(*operation, *blend, found.operands(solid)).region().intersects(zone)),
        _ => false,
    }
}

/// A node of what is left of its parts, itself if that is all; without its joint, if it is a blend.
fn put_together(solid: &Solid, below: Vec<Option<Solid>>) -> Option<Solid> {
    let node = solid.node();
    if !is_blended(solid) && are_same(node.parts(), &below) {
        return Some(solid.clone());
    }
    let (operation, rule) = match node {
        Node::Join { operation, rule, .. } => (*operation, *rule),
        Node::Blend { operation, .. } => (*operation, RFunction::MIN_MAX),
        _ => {
            let operand = below.into_iter().next()??;
            return Some(match node {
                Node::Affine { forward, label, .. } => {
                    Solid::from_node(Node::Affine { operand, forward: *forward, label })
                }
                Node::Named { name, .. } => Solid::from_node(Node::Named { operand, name: name.clone() }),
                Node::Painted { paint, .. } => Solid::from_node(Node::Painted { operand, paint: *paint }),
                _ => operand,
            });
        }
    };
    let mut left = left(operation, below)?;
    match left.len() {
        0 | 1 => left.pop(),
        _ => Some(Solid::from_node(Node::Join { operation, rule, operands: left })),
    }
}

fn are_same(operands: &[Solid], left: &[Option<Solid>]) -> bool {
    let is_same = |(own, left): (&Solid, &Option<Solid>)| left.as_ref().is_some_and(|l| l.address() == own.address());
    operands.iter().zip(left).all(is_same)
}

/// The operands of an operation without those of which nothing is left; nothing if there is nothing
/// of the operation.
fn left(operation: Operation, all: Vec<Option<Solid>>) -> Option<Vec<Solid>> {
    match operation {
        Operation::Intersection => all.into_iter().collect(),
        Operation::Difference if all.first().is_some_and(Option::is_none) => None,
        _ => Some(all.into_iter().flatten().collect()),
    }
}
