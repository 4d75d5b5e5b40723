//! The nodes of the graph.

use std::any::Any;
use std::sync::{Arc, OnceLock};

use glam::DAffine3;

use super::composed::{Repetition, Sweep};
use super::shelf::Shelf;
use super::{Paint, Profile};
use crate::{Blend, Caps, ParamError, RFunction};
use rvachev_field::{AnyField, AnyWarp, check};

/// A solid: an immutable expression graph of leaves, maps and joins.
///
/// Cloning is cheap (a reference count) and a part that is used in several places is stored
/// and compiled once. Building never fails and never panics; parameters are checked when the
/// solid is first evaluated, meshed or rendered.
///
/// The value is positive inside, 0 on the surface, negative outside, in length units.
///
/// ```
/// use rvachev::Solid;
/// use glam::DVec3;
///
/// let plate = Solid::cuboid(DVec3::new(4.0, 4.0, 1.0)) - Solid::cylinder(1.0, 2.0);
/// assert!(!plate.contains(DVec3::ZERO)?);
/// assert!(plate.contains(DVec3::new(1.5, 0.0, 0.0))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Solid(pub(super) Arc<Inner>);

pub(super) struct Inner {
    pub(super) node: Node,
    /// What the evaluator keeps between queries; it knows its type.
    pub(super) compiled: OnceLock<Arc<dyn Any + Send + Sync>>,
    /// What it has measured of a length's operand.
    measured: OnceLock<Arc<dyn Any + Send + Sync>>,
    /// What is kept for it and for all solids that are equal.
    pub(super) shelf: OnceLock<Arc<Shelf>>,
}

/// A node of the graph.
#[derive(Clone)]
pub(crate) enum Node {
    Leaf(Arc<dyn AnyField>),
    /// The operand moved by `forward`; `label` is the verb that the user wrote.
    Affine {
        operand: Solid,
        forward: DAffine3,
        label: &'static str,
    },
    /// The operand deformed.
    Warp {
        operand: Solid,
        warp: Arc<dyn AnyWarp>,
    },
    Join {
        operation: Operation,
        rule: RFunction,
        operands: Vec<Solid>,
    },
    Complement(Solid),
    /// The operand, called `name` by the user.
    Named {
        operand: Solid,
        name: Arc<str>,
    },
    /// The operand, painted.
    Painted {
        operand: Solid,
        paint: Paint,
    },
    /// Operands joined with the transitions between them shaped: any number for a fillet, else two.
    Blend {
        operation: Operation,
        blend: Blend,
        operands: Vec<Solid>,
        /// How far it may be off where it is measured, if the user has said so.
        tolerance: Option<f64>,
        /// For a fillet or chamfer: where the centre of the ball that rolls along the operands may
        /// not be, or, for intersections and differences, where it may.
        ball: Option<Solid>,
    },
    Length {
        operand: Solid,
        length: Length,
        /// How far it may be off where it is measured, if the user has said so.
        tolerance: Option<f64>,
        /// The same for a length that is a ball's radius.
        ball: Option<Solid>,
        /// The blend of the operands of its operand whose ball it is: it is asked for where these
        /// are near each other, and nowhere else.
        about: Option<Blend>,
    },
    /// What a verb makes of a solid out of several nodes: `built`.
    Repeated {
        operand: Solid,
        repetition: Repetition,
        built: Solid,
    },
    /// A length or a blend, and the same measured to a tolerance: `built`.
    Toleranced {
        operand: Solid,
        tolerance: f64,
        built: Solid,
    },
    /// What a verb makes of a profile out of several nodes: `built`.
    Swept {
        profile: Profile,
        sweep: Sweep,
        built: Solid,
        /// Of rounded and chamfered edges: what is left of the profile further inside than they are
        /// wide, which must be something.
        ball: Option<Solid>,
    },
    /// The edge between an end face and the sides, rounded or chamfered: the slab and the column,
    /// both moved in by the size.
    Rim {
        caps: Caps,
        operands: Vec<Solid>,
    },
}

/// How a solid is moved in or out, or smoothed by a ball: [`Solid::level`],
/// [`offset`](Solid::offset), [`shell`](Solid::shell), [`rounded`](Solid::rounded),
/// [`filleted`](Solid::filleted). What a [`Form`](crate::form::Form) tells of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Length {
    /// Values are moved by this much.
    Level(f64),
    /// The surface is moved outwards by this much.
    Offset(f64),
    /// A wall of this thickness inside the surface.
    Shell(f64),
    /// Convex edges rounded to this radius.
    Rounded(f64),
    /// Concave edges filled to this radius.
    Filleted(f64),
}

impl Length {
    /// By how much, in length units.
    pub(crate) fn amount(self) -> f64 {
        match self {
            Length::Level(by) | Length::Offset(by) | Length::Shell(by) | Length::Rounded(by) | Length::Filleted(by) => {
                by
            }
        }
    }

    /// How deep inside points are that it takes away.
    pub(crate) fn inwards(self) -> f64 {
        match self {
            Length::Offset(by) => -by,
            Length::Shell(by) | Length::Rounded(by) => by,
            Length::Level(_) | Length::Filleted(_) => f64::NEG_INFINITY,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Length::Level(_) => "level",
            Length::Offset(_) => "offset",
            Length::Shell(_) => "shell",
            Length::Rounded(_) => "rounded",
            Length::Filleted(_) => "filleted",
        }
    }

    pub(crate) fn check(self) -> Result<(), ParamError> {
        match self {
            Length::Level(c) => check::finite("value", c),
            Length::Offset(d) => check::finite("distance", d),
            Length::Shell(t) => check::length("thickness", t),
            Length::Rounded(r) | Length::Filleted(r) => check::length("radius", r),
        }
    }
}

/// A set operation on one or more operands: what a [`Form`](crate::form::Form) tells of a join.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Operation {
    /// What is in any operand.
    Union,
    /// What is in all operands.
    Intersection,
    /// The first operand without the others.
    Difference,
    /// Of two operands, what is in exactly one.
    SymmetricDifference,
}

impl Operation {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
            Operation::SymmetricDifference => "symmetric difference",
        }
    }
}

impl Node {
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Node::Leaf(field) => field.name(),
            Node::Affine { label, .. } => label,
            Node::Warp { warp, .. } => warp.name(),
            Node::Join { operation, .. } => operation.name(),
            Node::Complement(_) => "complement",
            Node::Blend { operation, blend, .. } => super::blend::name(blend, *operation),
            Node::Length { length, .. } => length.name(),
            Node::Named { .. } => "named",
            Node::Painted { .. } => "paint",
            Node::Repeated { repetition, .. } => repetition.name(),
            Node::Toleranced { .. } => "with_tolerance",
            Node::Swept { sweep, .. } => sweep.name(),
            Node::Rim { .. } => "rim",
        }
    }

    /// The operands that the user gave, in order.
    pub(crate) fn operands(&self) -> &[Solid] {
        match self {
            Node::Leaf(_) => &[],
            Node::Affine { operand, .. }
            | Node::Warp { operand, .. }
            | Node::Length { operand, .. }
            | Node::Named { operand, .. }
            | Node::Painted { operand, .. }
            | Node::Repeated { operand, .. }
            | Node::Toleranced { operand, .. }
            | Node::Complement(operand) => std::slice::from_ref(operand),
            Node::Swept { profile, .. } => std::slice::from_ref(&profile.0),
            Node::Blend { operands, .. } | Node::Join { operands, .. } | Node::Rim { operands, .. } => operands,
        }
    }

    /// What a ball that rolls along the node's operands is told by, or an edge of a profile.
    pub(crate) fn ball(&self) -> Option<&Solid> {
        match self {
            Node::Blend { ball, .. } | Node::Length { ball, .. } | Node::Swept { ball, .. } => ball.as_ref(),
            _ => None,
        }
    }

    /// How far what is measured for the node may be off, if the user has said so.
    pub(crate) fn tolerance(&self) -> Option<f64> {
        match self {
            Node::Blend { tolerance, .. } | Node::Length { tolerance, .. } => *tolerance,
            _ => None,
        }
    }

    /// What the node is compiled from, in order: its operands, or what its verb made of them.
    pub(crate) fn parts(&self) -> &[Solid] {
        match self {
            Node::Repeated { built, .. } | Node::Toleranced { built, .. } | Node::Swept { built, .. } => {
                std::slice::from_ref(built)
            }
            node => node.operands(),
        }
    }
}

impl Solid {
    pub(crate) fn from_node(node: Node) -> Solid {
        Solid(Arc::new(Inner { node, compiled: OnceLock::new(), measured: OnceLock::new(), shelf: OnceLock::new() }))
    }

    pub(crate) fn node(&self) -> &Node {
        &self.0.node
    }

    /// The evaluator's cache of this node.
    pub(crate) fn compiled(&self) -> &OnceLock<Arc<dyn Any + Send + Sync>> {
        &self.0.compiled
    }

    /// What was measured of a length's operand, or of a fillet's.
    pub(crate) fn measured(&self) -> &OnceLock<Arc<dyn Any + Send + Sync>> {
        &self.0.measured
    }

    /// What tells this node from others.
    pub(crate) fn address(&self) -> usize {
        Arc::as_ptr(&self.0).addr()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        // A chain may be a hundred thousand operations deep: take it down without recursion.
        let mut pending = Vec::new();
        take_operands(&mut self.node, &mut pending);
        while let Some(solid) = pending.pop() {
            if let Some(mut inner) = Arc::into_inner(solid.0) {
                take_operands(&mut inner.node, &mut pending);
            }
        }
    }
}

fn take_operands(node: &mut Node, pending: &mut Vec<Solid>) {
    if node.operands().is_empty() {
        return;
    }
    let nothing = Node::Join { operation: Operation::Union, rule: RFunction::MIN_MAX, operands: Vec::new() };
    match std::mem::replace(node, nothing) {
        Node::Leaf(_) => {}
        Node::Affine { operand, .. }
        | Node::Warp { operand, .. }
        | Node::Named { operand, .. }
        | Node::Painted { operand, .. }
        | Node::Complement(operand) => pending.push(operand),
        Node::Length { operand, ball, .. } => {
            pending.push(operand);
            pending.extend(ball);
        }
        Node::Repeated { operand: solid, built, .. } | Node::Toleranced { operand: solid, built, .. } => {
            pending.extend([solid, built]);
        }
        Node::Swept { profile: Profile(solid), built, ball, .. } => {
            pending.extend([solid, built]);
            pending.extend(ball);
        }
        Node::Blend { operands, ball, .. } => {
            pending.extend(operands);
            pending.extend(ball);
        }
        Node::Join { operands, .. } | Node::Rim { operands, .. } => pending.extend(operands),
    }
}
