//! Contexts: the maps, and the length asked for, above a node.
//!
//! A node that is reached twice in one context is compiled once. Where the leaves' values are
//! the distances that an offset or a shell reads ([`Exact`](super::exact::Exact)), an offset
//! of min and max is the min and max of offsets: it is carried down to the leaves as a [`Move`],
//! its sign turned by every complement on the way. What comes out is a program like any other.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3};

use super::exact::{Exactness, erodes};
use super::scene::{Frame, Scene};
use crate::solid::{Length, Node, Operation};
use crate::{RFunction, Solid};
use rvachev_field::{AnyWarp, smallest_stretch};

/// What is above a node.
#[derive(Clone, Copy)]
pub(super) struct Context {
    pub(super) frame: u32,
    /// From the frame to the node's coordinates, and back.
    pub(super) to_local: DAffine3,
    pub(super) forward: DAffine3,
    /// Product of the smallest stretches.
    pub(super) scale: f64,
    /// Below a length: how the leaves' surfaces are moved, in the frame's unit.
    pub(super) moved: Option<Move>,
    /// Whether an offset is read by its values, which are its operand's and a number, and not by
    /// its surface.
    pub(super) by_value: bool,
    /// That number, in the frame's unit.
    pub(super) level: f64,
}

/// The points at least `depth` inside, and then all that are within `shift` of these. Moves add up
/// to such a one: of a solid of which both are known, what is moved out and then in again is as it
/// was.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Move {
    pub(super) depth: f64,
    pub(super) shift: f64,
}

impl Move {
    /// What of a solid that is moved by `by` is to be taken for this to be made of it, in terms of
    /// the solid.
    fn of_moved(self, by: f64) -> Move {
        let Move { depth, shift } = self;
        if by < 0.0 {
            Move { depth: depth - by, shift }
        } else {
            Move { depth: (depth - by).max(0.0), shift: shift + (by - depth).max(0.0) }
        }
    }

    /// That of the complement, where only one of the two is done.
    fn flipped(self) -> Move {
        Move { depth: self.shift, shift: self.depth }
    }

    /// What is added to a value that is a distance on both sides, for the sake of the sign.
    pub(super) fn level(self) -> f64 {
        self.shift - self.depth
    }
}

#[derive(Default)]
pub(super) struct Contexts {
    contexts: Vec<Context>,
    below: HashMap<(u32, usize), Vec<(usize, u32)>>,
    flips: HashMap<u32, u32>,
}

impl Contexts {
    pub(super) fn new() -> Contexts {
        let identity = DAffine3::IDENTITY;
        let world = Context {
            frame: 0,
            to_local: identity,
            forward: identity,
            scale: 1.0,
            moved: None,
            by_value: false,
            level: 0.0,
        };
        Contexts { contexts: vec![world], ..Contexts::default() }
    }

    pub(super) fn get(&self, context: u32) -> &Context {
        &self.contexts[context as usize]
    }

    /// The operands that a node is compiled from, by position, each with its context.
    pub(super) fn below(&self, solid: &Solid, context: u32) -> &[(usize, u32)] {
        self.below.get(&(context, solid.address())).map_or(&[], |list| list)
    }

    fn push(&mut self, context: Context) -> u32 {
        self.contexts.push(context);
        (self.contexts.len() - 1) as u32
    }

    /// Makes the contexts of a node's operands.
    pub(super) fn open(&mut self, solid: &Solid, context: u32, exact: &Exactness, scene: &mut Scene) {
        let above = *self.get(context);
        let list = match solid.node() {
            Node::Leaf(_) => Vec::new(),
            Node::Named { .. } | Node::Repeated { .. } | Node::Toleranced { .. } | Node::Swept { .. } => {
                vec![(0, context)]
            }
            // What is painted is apart from the same parts without paint.
            Node::Painted { .. } => vec![(0, self.push(above))],
            Node::Affine { forward, .. } => {
                let inner = Context {
                    to_local: inverse(forward) * above.to_local,
                    forward: above.forward * *forward,
                    scale: above.scale * stretch(&forward.matrix3),
                    ..above
                };
                vec![(0, self.push(inner))]
            }
            Node::Warp { warp, .. } => vec![(0, self.warped(context, warp, scene))],
            Node::Complement(_) => vec![(0, self.flip_if(context, true))],
            // Its operands' values are read, not their signs alone.
            Node::Join { rule: RFunction::Distance, operation, operands } if let Some(moved) = above.moved => {
                let is_left = *operation == Operation::Intersection
                    && operands.iter().all(|operand| erodes(operand, moved.depth / above.scale));
                let depth = if is_left { moved.depth } else { 0.0 };
                let inner = self.push(Context { moved: Some(Move { depth, shift: 0.0 }), level: 0.0, ..above });
                (0..operands.len()).map(|i| (i, inner)).collect()
            }
            Node::Join { operation, operands, .. } => {
                let difference = *operation == Operation::Difference;
                (0..operands.len()).map(|i| (i, self.flip_if(context, difference && i > 0))).collect()
            }
            // Never below a length that is closed.
            Node::Blend { operands, .. } => (0..operands.len()).map(|i| (i, context)).collect(),
            Node::Rim { operands, .. } => {
                let inner = self.push(Context { by_value: true, ..above });
                (0..operands.len()).map(|i| (i, inner)).collect()
            }
            Node::Length { length, .. } => match *length {
                Length::Rounded(radius) if exact.is_closed(solid) => {
                    let opened = self.moved(context, radius);
                    vec![(0, self.moved(opened, -radius))]
                }
                Length::Level(_) | Length::Rounded(_) | Length::Filleted(_) => vec![(0, context)],
                _ if !exact.is_closed(solid) => match length {
                    // The outer side of a wall is the surface itself.
                    Length::Shell(_) => vec![(0, context)],
                    _ => Vec::new(),
                },
                Length::Offset(d) if above.by_value => {
                    let (moved, level) = (Some(above.moved.unwrap_or_default()), above.level + d * above.scale);
                    vec![(0, self.push(Context { moved, by_value: false, level, ..above }))]
                }
                Length::Offset(d) => vec![(0, self.moved(context, d))],
                Length::Shell(t) => vec![(0, context), (0, self.moved(context, -t))],
            },
        };
        self.below.insert((context, solid.address()), list);
    }

    fn warped(&mut self, context: u32, warp: &Arc<dyn AnyWarp>, scene: &mut Scene) -> u32 {
        let above = *self.get(context);
        let identity = DAffine3::IDENTITY;
        scene.frames.push(Frame { parent: above.frame, to_local: above.to_local, warp: warp.clone() });
        self.push(Context { to_local: identity, forward: identity, frame: scene.frames.len() as u32, ..above })
    }

    /// The context in which surfaces are moved out by a length of the node's own coordinates.
    fn moved(&mut self, context: u32, by: f64) -> u32 {
        let above = *self.get(context);
        self.push(Context { moved: Some(above.moved.unwrap_or_default().of_moved(by * above.scale)), ..above })
    }

    /// The context of a complement: its own below a length.
    fn flip_if(&mut self, context: u32, flip: bool) -> u32 {
        let above = *self.get(context);
        let Some(moved) = above.moved.filter(|_| flip) else { return context };
        if let Some(&flipped) = self.flips.get(&context) {
            return flipped;
        }
        let flipped = self.push(Context { moved: Some(moved.flipped()), level: -above.level, ..above });
        self.flips.insert(context, flipped);
        self.flips.insert(flipped, context);
        flipped
    }
}

/// Whether a map stretches all directions alike.
pub(super) fn is_similarity(m: &DMat3) -> bool {
    let gram = m.transpose() * *m;
    let scale = gram.x_axis.x;
    let off = gram - DMat3::from_diagonal(glam::DVec3::splat(scale));
    off.to_cols_array().into_iter().all(|entry| entry.abs() <= 1e-12 * scale)
}

/// The smallest stretch, exactly 1 where nothing is stretched.
fn stretch(m: &DMat3) -> f64 {
    let stretch = least_stretch(m);
    if (stretch - 1.0).abs() < 1e-14 { 1.0 } else { stretch }
}

/// The smallest stretch. Most maps stretch all directions alike, and one direction tells.
pub(super) fn least_stretch(m: &DMat3) -> f64 {
    if is_similarity(m) { m.x_axis.length() } else { smallest_stretch(m) }
}

/// The inverse; a translation's is exact.
fn inverse(map: &DAffine3) -> DAffine3 {
    if map.matrix3 == DMat3::IDENTITY { DAffine3::from_translation(-map.translation) } else { map.inverse() }
}
