//! Contexts: the maps, and the lengths asked for, above a node.
//!
//! A node that is reached twice in one context is compiled once. An offset or a shell reads
//! lengths: from there down joins act as min and max, and an offset of min and max is the min
//! and max of offsets, so the offset is carried down to the leaves as a number that is added
//! to each leaf's value, its sign turned by every complement on the way. What comes out is a
//! program like any other.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::{DAffine3, DMat3};

use super::scene::{Frame, Scene};
use crate::solid::{Length, Node, Operation};
use crate::{Blend, Solid};
use rvachev_field::{AnyField, AnyWarp, Distance, smallest_stretch};

/// What is above a node.
#[derive(Clone, Copy)]
pub(super) struct Context {
    pub(super) frame: u32,
    /// From the frame to the node's coordinates, and back.
    pub(super) to_local: DAffine3,
    pub(super) forward: DAffine3,
    /// Product of the smallest stretches.
    pub(super) scale: f64,
    /// The nearest context, upwards, in which a length can be asked for.
    pub(super) anchor: Option<u32>,
}

/// How a context differs from the one above it.
enum Step {
    World,
    Affine(DAffine3),
    Warp(Arc<dyn AnyWarp>),
    /// A length is asked for, this much larger.
    Length(f64),
    /// Below a length: the complement of what is above.
    Flip,
    /// Nothing differs but the paint.
    Paint,
}

pub(super) struct Contexts {
    contexts: Vec<Context>,
    /// The context above each, and the step from it.
    steps: Vec<(u32, Step)>,
    below: HashMap<(u32, usize), Vec<(usize, u32)>>,
    flips: HashMap<u32, u32>,
}

/// Where a leaf goes, and what stands for it.
pub(super) struct Place {
    pub(super) field: Arc<dyn AnyField>,
    pub(super) context: Context,
    /// What is added to its value.
    pub(super) shift: f64,
}

impl Default for Contexts {
    fn default() -> Contexts {
        let identity = DAffine3::IDENTITY;
        let world = Context { frame: 0, to_local: identity, forward: identity, scale: 1.0, anchor: None };
        Contexts { contexts: vec![world], steps: vec![(0, Step::World)], below: HashMap::new(), flips: HashMap::new() }
    }
}

impl Contexts {
    pub(super) fn get(&self, context: u32) -> &Context {
        &self.contexts[context as usize]
    }

    /// The operands that a node is compiled from, by position, each with its context.
    pub(super) fn below(&self, solid: &Solid, context: u32) -> &[(usize, u32)] {
        self.below.get(&(context, solid.address())).map_or(&[], |list| list)
    }

    fn push(&mut self, above: u32, step: Step, context: Context) -> u32 {
        self.contexts.push(context);
        self.steps.push((above, step));
        (self.contexts.len() - 1) as u32
    }

    /// Makes the contexts of a node's operands.
    pub(super) fn open(&mut self, solid: &Solid, context: u32, scene: &mut Scene) {
        let above = *self.get(context);
        let list = match solid.node() {
            Node::Leaf(_) => Vec::new(),
            Node::Named { .. } | Node::Repeated { .. } | Node::Swept { .. } => vec![(0, context)],
            // What is painted is apart from the same parts without paint.
            Node::Painted { .. } => {
                let inner = *self.get(context);
                vec![(0, self.push(context, Step::Paint, inner))]
            }
            Node::Affine { forward, .. } => {
                let inner = Context {
                    to_local: inverse(forward) * above.to_local,
                    forward: above.forward * *forward,
                    scale: above.scale * stretch(&forward.matrix3),
                    ..above
                };
                vec![(0, self.push(context, Step::Affine(*forward), inner))]
            }
            Node::Warp { warp, .. } => vec![(0, self.warped(context, warp, scene))],
            Node::Complement(_) => vec![(0, self.flip_if(context, true))],
            Node::Join { operation: Operation::SymmetricDifference, operands, .. } if above.anchor.is_some() => {
                // Each operand is asked for as it is, and then each complement.
                let flipped = self.flip_if(context, true);
                let as_is = (0..operands.len()).map(|i| (i, context));
                as_is.chain((0..operands.len()).map(|i| (i, flipped))).collect()
            }
            Node::Join { operation, operands, .. } => {
                let difference = *operation == Operation::Difference;
                (0..operands.len()).map(|i| (i, self.flip_if(context, difference && i > 0))).collect()
            }
            Node::Blend { operation, blend, operands, .. } => match blend {
                // Below a length these are leaves.
                Blend::Displacement { .. } | Blend::Ricci { .. } if above.anchor.is_some() => Vec::new(),
                _ => {
                    // A fillet rolls along the operands as lengths tell them: they are those everywhere.
                    let is_fillet = matches!(blend, Blend::Fillet { .. }) && above.anchor.is_none();
                    let [first, second] = operands.each_ref().map(|operand| {
                        if is_fillet && differs_in_lengths(operand) { self.length(context, 0.0) } else { context }
                    });
                    vec![(0, first), (1, self.flip_if(second, *operation == Operation::Difference))]
                }
            },
            Node::Length { length, .. } => match *length {
                Length::Level(_) if above.anchor.is_some() => Vec::new(),
                Length::Level(_) => vec![(0, context)],
                // Lengths add up, but not through a map that stretches unevenly.
                _ if !self.similar(context) => Vec::new(),
                Length::Offset(d) => vec![(0, self.length(context, d))],
                // The outer side of a wall is the surface itself, in whatever values.
                Length::Shell(t) => {
                    let outer = if above.anchor.is_some() { self.length(context, 0.0) } else { context };
                    vec![(0, outer), (0, self.length(context, -t))]
                }
            },
        };
        self.below.insert((context, solid.address()), list);
    }

    fn warped(&mut self, context: u32, warp: &Arc<dyn AnyWarp>, scene: &mut Scene) -> u32 {
        let above = *self.get(context);
        let identity = DAffine3::IDENTITY;
        let mut inner = Context { to_local: identity, forward: identity, ..above };
        let keeps_lengths = warp.keeps_lengths() && self.similar(context);
        if above.anchor.is_none() || keeps_lengths {
            scene.frames.push(Frame { parent: above.frame, to_local: above.to_local, warp: warp.clone() });
            inner.frame = scene.frames.len() as u32;
            // Lengths can as well be asked for here.
            inner.anchor = above.anchor.map(|_| self.contexts.len() as u32);
        }
        self.push(context, Step::Warp(warp.clone()), inner)
    }

    fn length(&mut self, context: u32, by: f64) -> u32 {
        let number = self.contexts.len() as u32;
        let inner = Context { anchor: Some(number), ..*self.get(context) };
        self.push(context, Step::Length(by), inner)
    }

    /// The context of a complement: its own below a length.
    fn flip_if(&mut self, context: u32, flip: bool) -> u32 {
        if !flip || self.get(context).anchor.is_none() {
            return context;
        }
        if let Some(&flipped) = self.flips.get(&context) {
            return flipped;
        }
        let inner = *self.get(context);
        let flipped = self.push(context, Step::Flip, inner);
        self.flips.insert(context, flipped);
        self.flips.insert(flipped, context);
        flipped
    }

    /// The steps from a context up to its anchor, exclusive.
    fn chain(&self, context: u32) -> impl Iterator<Item = &Step> {
        let anchor = self.get(context).anchor.unwrap_or(0);
        let mut at = context;
        std::iter::from_fn(move || {
            if at == anchor {
                return None;
            }
            let (above, step) = &self.steps[at as usize];
            at = *above;
            Some(step)
        })
    }

    /// Whether lengths are the same, up to a factor, here and where they are asked for.
    fn similar(&self, context: u32) -> bool {
        self.get(context).anchor.is_none()
            || self.chain(context).all(|step| match step {
                Step::Affine(map) => is_similarity(&map.matrix3),
                Step::Warp(_) => false,
                _ => true,
            })
    }

    /// Where a leaf goes. Below a length it is the true distance that counts.
    pub(super) fn place(&self, field: &Arc<dyn AnyField>, context: u32) -> Place {
        let here = *self.get(context);
        let Some(anchor) = here.anchor else { return Place { field: field.clone(), context: here, shift: 0.0 } };
        let shift = self.shift(context);
        if field.exact() && self.similar(context) {
            return Place { field: field.clone(), context: here, shift };
        }
        // From the anchor down: affine maps up to each deformation, and on to the leaf.
        let mut chain: Vec<(DAffine3, Arc<dyn AnyWarp>)> = Vec::new();
        let mut to_local = DAffine3::IDENTITY;
        let steps: Vec<&Step> = self.chain(context).collect();
        for step in steps.into_iter().rev() {
            match step {
                Step::Affine(forward) => to_local = inverse(forward) * to_local,
                Step::Warp(warp) => {
                    chain.push((to_local, warp.clone()));
                    to_local = DAffine3::IDENTITY;
                }
                Step::World | Step::Length(_) | Step::Flip | Step::Paint => {}
            }
        }
        let distance = Distance::new(chain, to_local, field.clone(), shift / self.get(anchor).scale);
        Place { field: Arc::new(distance), context: *self.get(anchor), shift }
    }

    /// The sum of the lengths above a leaf, in the units of its value.
    fn shift(&self, context: u32) -> f64 {
        let (mut shift, mut sign, mut at) = (0.0, 1.0, context);
        while self.get(at).anchor.is_some() {
            let (above, step) = &self.steps[at as usize];
            match step {
                Step::Flip => sign = -sign,
                Step::Length(by) => shift += sign * by * self.get(at).scale,
                _ => {}
            }
            at = *above;
        }
        shift
    }
}

/// Whether a solid's surface is another where its leaves are told by lengths: where these, and not only their signs, are
/// joined.
fn differs_in_lengths(solid: &Solid) -> bool {
    let (mut pending, mut met) = (vec![solid], HashSet::new());
    while let Some(solid) = pending.pop() {
        if !met.insert(solid.address()) {
            continue;
        }
        match solid.node() {
            Node::Blend { blend: Blend::Smooth { .. } | Blend::Chamfer { .. }, .. } => return true,
            // These have their lengths in any case, or are leaves.
            Node::Blend { .. } | Node::Length { length: Length::Offset(_) | Length::Level(_), .. } => {}
            node => pending.extend(node.parts()),
        }
    }
    false
}

/// Whether a map stretches all directions alike.
fn is_similarity(m: &DMat3) -> bool {
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
