//! The nodes that are written, each once: equal parts are one.

use std::collections::HashMap;

use crate::Profile;
use crate::catalogue::{Call, Part};
use crate::form::Form;
use crate::solid::Numbering;

/// What a node is known by: equal parts of a sort have the same.
pub(super) type Key = (u64, bool);

/// A node that is written.
pub(super) struct Item {
    pub(super) key: Key,
    /// What makes it; `None` of what has no code.
    pub(super) call: Option<Call>,
    pub(super) operands: Vec<Key>,
    /// How often it stands in others.
    pub(super) uses: usize,
    /// The name that the user gave it.
    pub(super) name: Option<String>,
    /// What it is called without a name.
    pub(super) label: &'static str,
}

/// The nodes, operands first.
pub(super) fn items(root: &Part) -> Vec<Item> {
    let (Part::Solid(solid) | Part::Profile(Profile(solid))) = root else { return Vec::new() };
    let mut numbering = Numbering::default();
    numbering.number(solid);
    let key = |part: &Part| match part {
        Part::Solid(solid) => (numbering.of(solid), false),
        Part::Profile(Profile(solid)) => (numbering.of(solid), true),
        // There are no values among operands.
        Part::Value(_) => (u64::MAX, false),
    };
    let mut items: Vec<Item> = Vec::new();
    let mut at: HashMap<Key, Option<usize>> = HashMap::new();
    let mut pending = vec![(root.clone(), None)];
    while let Some((part, ready)) = pending.pop() {
        let own = key(&part);
        if let Some(item) = ready {
            at.insert(own, Some(items.len()));
            items.push(item);
            continue;
        }
        if at.contains_key(&own) {
            continue;
        }
        at.insert(own, None);
        let call = Call::of(&part);
        let (name, label) = described(&part);
        let parts = call.as_ref().map(|call| call.operands.clone()).unwrap_or_default();
        let operands = parts.iter().map(key).collect();
        pending.push((part, Some(Item { key: own, call, operands, uses: 0, name, label })));
        pending.extend(parts.into_iter().rev().map(|part| (part, None)));
    }
    let used: Vec<Key> = items.iter().flat_map(|item| item.operands.iter().copied()).collect();
    for operand in used {
        if let Some(Some(used)) = at.get(&operand) {
            items[*used].uses += 1;
        }
    }
    items
}

/// Several of the operand.
pub(super) const COPIES: &str = "s";

/// The name of a part that has one, and what it is.
fn described(part: &Part) -> (Option<String>, &'static str) {
    let form = match part {
        Part::Solid(solid) => solid.form(),
        Part::Profile(profile) => profile.form(),
        Part::Value(_) => return (None, ""),
    };
    match form {
        Form::Name { name, .. } => (Some(name.to_string()), "part"),
        Form::Leaf(leaf) | Form::Custom(leaf) => (None, leaf.name()),
        Form::Deformation { deformation, .. } => (None, deformation.name()),
        Form::Join { operation, .. } | Form::Blend { operation, .. } => (
            None,
            match operation.name() {
                "symmetric difference" => "either",
                name => name,
            },
        ),
        Form::Extrude { .. } => (None, "extrusion"),
        Form::Revolve { .. } => (None, "revolution"),
        Form::SweepHelix { .. } => (None, "helix"),
        Form::Column { .. } => (None, "column"),
        Form::Repetition { .. } => (None, COPIES),
        // As the operand.
        _ => (None, ""),
    }
}
