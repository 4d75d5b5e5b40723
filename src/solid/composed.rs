//! Verbs that are composed of several nodes: what the user said beside what it is built of.
//!
//! An extruded profile is a column cut off by a slab, a ring of copies a union of folds. The node
//! keeps the verb and its operand, for equality, names and text, and what was built of them, which
//! is what is compiled.

use std::collections::HashMap;
use std::fmt;

use glam::DVec3;

use super::{Extrusion, Helix, Node, Profile, Solid};
use crate::{Angle, Caps};

/// How copies of a solid are arranged: what a [`Form`](crate::form::Form) tells of
/// [`Solid::repeat`], [`repeat_linear`](Solid::repeat_linear) and
/// [`repeat_polar`](Solid::repeat_polar).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Repetition {
    /// A grid along the axes.
    Grid {
        /// How many copies there are along x, y and z.
        counts: [u32; 3],
        /// How far neighbours are apart, a length along each axis.
        spacing: DVec3,
    },
    /// A row.
    Row {
        /// How many copies there are.
        count: u32,
        /// From each copy to the next, lengths.
        step: DVec3,
    },
    /// A ring about the z axis.
    Ring {
        /// How many copies there are.
        count: u32,
    },
}

impl Repetition {
    /// The verb.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Repetition::Grid { .. } => "repeat",
            Repetition::Row { .. } => "repeat_linear",
            Repetition::Ring { .. } => "repeat_polar",
        }
    }

    /// The repeated operand, which `built` is.
    pub(crate) fn of(self, operand: &Solid, built: Solid) -> Solid {
        Solid::from_node(Node::Repeated { operand: operand.clone(), repetition: self, built })
    }
}

impl fmt::Display for Repetition {
    /// The numbers, to the last digit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Repetition::Grid { counts, spacing } => write!(f, "{counts:?} by {spacing:?}"),
            Repetition::Row { count, step } => write!(f, "{count} by {step:?}"),
            Repetition::Ring { count } => write!(f, "{count}"),
        }
    }
}

/// How a profile becomes a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sweep {
    Extrude(Extrusion),
    /// By this angle.
    Revolve(Angle),
    Helix(Helix),
    Column,
}

impl Sweep {
    /// The verb.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Sweep::Extrude(_) => "extrude",
            Sweep::Revolve(Angle::FULL_TURN) => "revolve",
            Sweep::Revolve(_) => "revolve_by",
            Sweep::Helix(_) => "sweep_helix",
            Sweep::Column => "column",
        }
    }

    /// The swept profile, which `built` is; `ball` is what rounded and chamfered edges leave of it.
    pub(super) fn of(self, profile: &Profile, built: Solid, ball: Option<Solid>) -> Solid {
        Solid::from_node(Node::Swept { profile: profile.clone(), sweep: self, built, ball })
    }

    /// What the verb calls the edges of its end faces, how they are, and the size of the smallest
    /// section relative to the profile.
    pub(crate) fn rim(self) -> (&'static str, Caps, f64) {
        match self {
            Sweep::Extrude(extrusion) => ("caps", extrusion.caps, extrusion.scale.min(1.0)),
            Sweep::Helix(helix) => ("ends", helix.ends, 1.0),
            Sweep::Revolve(_) | Sweep::Column => ("", Caps::Flat, 1.0),
        }
    }
}

impl fmt::Display for Sweep {
    /// The numbers, to the last digit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The verb has said which type it is.
        let tail = |text: String, name: &str| text.trim_start_matches(name).trim_start().to_string();
        match self {
            Sweep::Extrude(extrusion) => f.write_str(&tail(format!("{extrusion:?}"), "Extrusion")),
            Sweep::Revolve(Angle::FULL_TURN) | Sweep::Column => Ok(()),
            Sweep::Revolve(angle) => write!(f, "by {angle:?}"),
            Sweep::Helix(helix) => f.write_str(&tail(format!("{helix:?}"), "Helix")),
        }
    }
}

/// What was built of `old`, built of `new`, which has the same values; parts that they share stay
/// shared.
pub(super) fn replace<'a>(built: impl IntoIterator<Item = &'a mut Solid>, old: &Solid, new: &Solid) {
    let mut made: HashMap<usize, Solid> = HashMap::from([(old.address(), new.clone())]);
    for solid in built {
        *solid = replaced(solid, &mut made);
    }
}

fn replaced(built: &Solid, made: &mut HashMap<usize, Solid>) -> Solid {
    let mut pending = vec![(built, false)];
    while let Some((solid, is_ready)) = pending.pop() {
        if made.contains_key(&solid.address()) {
            continue;
        }
        // Among what a verb makes there is no verb of this kind: parts are operands.
        let operands = solid.node().operands();
        if !is_ready {
            pending.push((solid, true));
            pending.extend(operands.iter().map(|operand| (operand, false)));
            continue;
        }
        let changed = operands.iter().any(|operand| made[&operand.address()].address() != operand.address());
        let now = if changed {
            let operands = operands.iter().map(|operand| made[&operand.address()].clone()).collect();
            Solid::from_node(solid.node().with_operands(operands))
        } else {
            solid.clone()
        };
        made.insert(solid.address(), now);
    }
    made[&built.address()].clone()
}
