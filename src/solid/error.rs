//! What can be wrong with a solid, and where.

use std::sync::Arc;

use super::{Node, Paint, Profile, Solid};
use crate::ParamError;

/// Why a solid cannot be evaluated. `path` leads from the root to the node:
/// `difference[1] / twist / superellipsoid` is a superellipsoid, twisted, the second operand
/// (they count from 0) of a difference. A part that has a [name](Solid::named) has it in front:
/// `difference[1] / socket: twist / superellipsoid`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolidError {
    /// A parameter is out of its range.
    #[error("{path}: {source}")]
    Parameter {
        /// Where the node is.
        path: String,
        /// Which parameter, its value and what is allowed.
        source: ParamError,
    },
    /// A number that a question to the solid came with.
    #[error(transparent)]
    Argument(ParamError),
    /// A join without operands.
    #[error("{path}: has 0 operands, allowed: 1 or more")]
    EmptyJoin {
        /// Where the node is.
        path: String,
    },
    /// An operand of Ricci's blend whose value is no gauge.
    #[error(
        "{path}: operand {operand} is no gauge, allowed: spheres, superellipsoids, generalised superquadrics, \
         supershapes and Ricci blends of them, moved and deformed"
    )]
    NoGauge {
        /// Where the node is.
        path: String,
        /// Which operand, from 0.
        operand: usize,
    },
    /// Fillets, chamfers and offsets of each other, too deep to be evaluated.
    #[error("{path}: fillets, chamfers and offsets nested more than {limit} deep, allowed: at most {limit}")]
    TooDeep {
        /// Where the node is.
        path: String,
        /// The largest number allowed.
        limit: u32,
    },
    /// A node that the other system has no counterpart for.
    #[error("{path}: cannot be lowered, allowed: solids without fillets, chamfers, offsets and shells")]
    NotLowered {
        /// Where the node is.
        path: String,
    },
    /// No surface was found that a length could be measured from.
    #[error("no surface to measure lengths from: {reason}")]
    Surface {
        /// Why not.
        reason: String,
    },
    /// The solid does not end, and no bounds were given to cut it.
    #[error("{path}: unbounded; give explicit bounds, or intersect it with something bounded")]
    Unbounded {
        /// The node that makes it so.
        path: String,
    },
    /// Bounds that are empty, infinite or NaN, too thin, or too large to cut a solid.
    #[error(
        "bounds are {bounds}, allowed: finite, with min below max by at least 1e-9 along every axis, by at most 1e9 \
         where a solid goes on to them"
    )]
    Bounds {
        /// What was given.
        bounds: String,
    },
    /// The graph, written out as a tree where parts under different maps differ, is too
    /// large to compile.
    #[error("{nodes} nodes after writing out shared parts, allowed: at most {limit}")]
    TooLarge {
        /// How many nodes were met before giving up.
        nodes: usize,
        /// The largest number allowed.
        limit: usize,
    },
}

/// Where a walk through the graph has been: nodes by their parents, so that a path is
/// written out only for an error.
#[derive(Default)]
pub(crate) struct Trail(Vec<Step>);

struct Step {
    parent: Option<u32>,
    label: Label,
    /// Position among the parent's operands, where it has several.
    position: Option<usize>,
    paint: Option<Paint>,
    /// Within what a verb is composed of: the address of the verb's operand.
    inside: Option<usize>,
}

/// What a step is called.
enum Label {
    /// By its kind.
    Kind(&'static str),
    /// By the user.
    Name(Arc<str>),
}

impl Trail {
    /// Notes `solid`, operand number `position` of the node noted as `parent`.
    pub(crate) fn push(&mut self, solid: &Solid, parent: Option<(u32, &Solid, usize)>) -> u32 {
        let position = parent.and_then(|(_, up, at)| match up.node() {
            Node::Join { .. } | Node::Blend { .. } => Some(at),
            _ => None,
        });
        let label = match solid.node() {
            Node::Named { name, .. } => Label::Name(name.clone()),
            node => Label::Kind(node.name()),
        };
        let paint = match solid.node() {
            Node::Painted { paint, .. } => Some(*paint),
            _ => None,
        };
        let inside = parent.and_then(|(step, up, _)| match up.node() {
            Node::Repeated { operand: own, .. } | Node::Swept { profile: Profile(own), .. } => Some(own.address()),
            _ => self.0[step as usize].inside,
        });
        let inside = inside.filter(|operand| *operand != solid.address());
        self.0.push(Step { parent: parent.map(|(step, ..)| step), label, position, paint, inside });
        (self.0.len() - 1) as u32
    }

    /// The outermost paint on each node, by steps.
    pub(crate) fn paints(&self) -> Vec<Option<Paint>> {
        let mut paints: Vec<Option<Paint>> = Vec::with_capacity(self.0.len());
        for step in &self.0 {
            // Steps lead down: what is above came before.
            let above = step.parent.and_then(|parent| paints[parent as usize]);
            paints.push(above.or(step.paint));
        }
        paints
    }

    /// The path to a node: at most eight steps, the middle of a longer one left out.
    pub(crate) fn path(&self, step: u32) -> String {
        const SHOWN: usize = 8;
        let mut names: Vec<String> = Vec::new();
        let mut position: Option<usize> = None;
        let mut next = Some(step);
        while let Some(step) = next {
            let Step { parent, label, position: own, inside, .. } = &self.0[step as usize];
            next = *parent;
            if inside.is_some() {
                // The verb says it all.
                position = None;
                continue;
            }
            match (label, position) {
                (Label::Kind(kind), Some(operand)) => names.push(format!("{kind}[{operand}]")),
                (Label::Kind(kind), None) => names.push((*kind).to_string()),
                // A name stands in front of what it names.
                (Label::Name(name), _) => match names.last_mut() {
                    Some(named) => *named = format!("{name}: {named}"),
                    None => names.push(name.to_string()),
                },
            }
            position = *own;
        }
        names.reverse();
        if names.len() > SHOWN {
            let left_out = names.len() - SHOWN;
            names.splice(SHOWN / 2..SHOWN / 2 + left_out, [format!("({left_out} more)")]);
        }
        names.join(" / ")
    }
}
