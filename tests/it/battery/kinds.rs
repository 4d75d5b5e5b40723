//! What solids are made of, counted: of every kind there is its share.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use rvachev::{
    catalogue,
    catalogue::{Call, Group, Part},
};

/// So many solids have some of each kind.
const MANY: u32 = 100_000;

/// Of so many solids one has a kind, at least.
const SHARE: u32 = 20_000;

/// How many solids have a part of each entry, and how many have lengths that are measured, by the
/// entry.
#[derive(Default)]
pub struct Kinds {
    solids: u32,
    counts: BTreeMap<&'static str, u32>,
    measured: BTreeMap<&'static str, u32>,
}

impl Kinds {
    pub fn add(&mut self, part: &Part) {
        let (mut names, mut measured) = (BTreeSet::new(), BTreeSet::new());
        note(part, &mut names, &mut measured);
        self.solids += 1;
        for name in names {
            *self.counts.entry(name).or_default() += 1;
        }
        for name in measured {
            *self.measured.entry(name).or_default() += 1;
        }
    }

    /// What too few solids have, of many.
    pub fn lacking(&self) -> Vec<String> {
        if self.solids < MANY { Vec::new() } else { self.rarer(self.solids / SHARE) }
    }

    /// What fewer solids have than this.
    fn rarer(&self, least: u32) -> Vec<String> {
        // Some entries are made of others, and are told as these.
        let names = catalogue().iter().filter_map(|entry| Some(Call::of(&entry.example())?.entry.name()));
        let entries = names.map(|name| (name, &self.counts));
        let all = entries.chain(MEASURED.into_iter().map(|name| (name, &self.measured)));
        let counted = all.map(|(name, counts)| (name, counts.get(name).copied().unwrap_or_default()));
        counted.filter(|(_, count)| *count < least).map(|(name, count)| format!("{name} ({count})")).collect()
    }
}

impl fmt::Display for Kinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, least) = self.counts.iter().min_by_key(|(_, count)| **count).unwrap_or((&"none", &0));
        let measured = &self.measured;
        write!(f, "of {} the rarest is {name} ({least}); lengths of what is no distance: {measured:?}", self.solids)
    }
}

/// Lengths of solids and values of joins and sweeps, whose distances are measured.
const MEASURED: [&str; 8] =
    ["offset", "shell", "rounded", "filleted", "fillet", "chamfer", "chamfered_caps", "rounded_caps"];

/// Leaves whose value is the distance.
const EXACT: [&str; 18] = [
    "sphere",
    "cuboid",
    "cylinder",
    "torus",
    "capsule",
    "cone",
    "rounded_cuboid",
    "half_space",
    "slab",
    "prism",
    "pyramid",
    "wedge",
    "circle",
    "rectangle",
    "rounded_rectangle",
    "regular_polygon",
    "polygon",
    "ellipsoid",
];

/// Whether a part is an exact leaf that is only moved.
fn is_exact(part: &Part) -> bool {
    Call::of(part).is_some_and(|call| match call.entry.name() {
        // Rotations and moves; a map that stretches is not told from them by its name.
        "translate" | "rotate" | "affine" | "named" | "paint" => call.operands.iter().all(is_exact),
        name => EXACT.contains(&name),
    })
}

fn note(part: &Part, names: &mut BTreeSet<&'static str>, measured: &mut BTreeSet<&'static str>) {
    let Some(call) = Call::of(part) else { return };
    let name = call.entry.name();
    names.insert(name);
    let is_measured = call.operands.iter().any(|operand| !is_exact(operand));
    if call.entry.group() == Group::Length && is_measured && MEASURED.contains(&name) {
        measured.insert(name);
    }
    for operand in &call.operands {
        note(operand, names, measured);
    }
    for value in &call.values {
        let value = Part::Value(value.clone());
        if let Some(name) = Call::of(&value).map(|call| call.entry.name()) {
            if is_measured && MEASURED.contains(&name) {
                measured.insert(name);
            }
            note(&value, names, measured);
        }
    }
}

#[test]
fn of_every_kind_there_is_a_share() {
    let mut kinds = Kinds::default();
    for solid in (0..600).filter_map(|seed| super::make::made(seed, 0.3)) {
        kinds.add(&(&solid).into());
    }
    println!("{kinds}");
    assert_eq!(kinds.rarer(3), Vec::<String>::new());
}
