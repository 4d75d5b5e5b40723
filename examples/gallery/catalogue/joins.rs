//! Joins of two operands, and blends of them.

use rvachev::{Blend, RFunction, Solid};

use super::Entry;

/// The operands of all joins: a box, and a ball in its upper corner.
fn operands() -> [Solid; 2] {
    [Solid::cuboid([2.0, 2.0, 1.2]), Solid::sphere(0.85).translate([0.45, -0.45, 0.6])]
}

fn union() -> Solid {
    let [a, b] = operands();
    a | b
}

fn intersection() -> Solid {
    let [a, b] = operands();
    a & b
}

fn difference() -> Solid {
    let [a, b] = operands();
    a - b
}

/// Cut open to show the hollow where both are.
fn symmetric_difference() -> Solid {
    let [a, b] = operands();
    (a ^ b) - Solid::cuboid([2.0, 2.0, 3.0]).translate([1.45, -1.45, 0.0])
}

pub const JOINS: &[Entry] = &[
    ("union", union),
    ("intersection", intersection),
    ("difference", difference),
    ("symmetric_difference", symmetric_difference),
];

/// The solid is the same for every rule, the field about it is not: a level outside of it.
fn level_of(rule: RFunction, level: f64) -> Solid {
    let [a, b] = operands();
    a.union(b, rule).level(level)
}

/// A rule of no bounded slope, whose levels lie farther out and are not known to end.
fn rule_zero() -> Solid {
    level_of(RFunction::Zero { m: 1 }, 0.05) & Solid::cuboid([3.2, 3.2, 2.8]).translate([0.1, -0.1, 0.3])
}

pub const RULES: &[Entry] = &[
    ("rule_min_max", || level_of(RFunction::MIN_MAX, 0.25)),
    ("rule_alpha", || level_of(RFunction::Alpha(-0.5), 0.25)),
    ("rule_zero", rule_zero),
    ("rule_p", || level_of(RFunction::P(2.0), 0.25)),
    ("rule_associative", || level_of(RFunction::Associative(2.0), 0.25)),
    ("rule_distance", || level_of(RFunction::Distance, 0.25)),
];

/// The three operations with one blend.
fn united(blend: Blend) -> Solid {
    let [a, b] = operands();
    a.union_with(b, blend)
}

fn intersected(blend: Blend) -> Solid {
    let [a, b] = operands();
    a.intersection_with(b, blend)
}

fn subtracted(blend: Blend) -> Solid {
    let [a, b] = operands();
    a.difference_with(b, blend)
}

/// Three pins on a plate, joined at once.
fn many(blend: Blend) -> Solid {
    let pins = [(-0.65, 0.6), (0.1, 0.9), (0.75, 0.45)]
        .map(|(x, height)| Solid::cylinder(0.2, height).translate([x, 0.4 - 0.4 * height, 0.5 * height]));
    Solid::union_all_with([Solid::cuboid([2.2, 1.2, 0.4])].into_iter().chain(pins), blend)
}

/// A plate with three holes, cut at once.
fn many_cut(blend: Blend) -> Solid {
    let holes = [(-0.65, 0.24), (0.05, 0.18), (0.65, 0.24)];
    let holes = holes.map(|(x, radius)| Solid::cylinder(radius, 2.0).translate([x, 0.0, 0.0]));
    Solid::cuboid([2.4, 1.3, 0.5]).difference_all_with(holes, blend)
}

const SMOOTH: Blend = Blend::Smooth { radius: 0.5 };
const FILLET: Blend = Blend::Fillet { radius: 0.15 };
const CHAMFER: Blend = Blend::Chamfer { leg: 0.14 };
const ADDED: Blend = Blend::Displacement { height: 0.15, falloff: [0.3, 0.3] };
const TAKEN_OFF: Blend = Blend::Displacement { height: -0.15, falloff: [0.3, 0.3] };

/// Ricci's blend is one of gauges: a superellipsoid stands in for the box.
fn gauges() -> [Solid; 2] {
    let [_, ball] = operands();
    [Solid::superellipsoid([1.0, 1.0, 0.6], 0.1, 0.1), ball]
}

const RICCI: Blend = Blend::Ricci { p: 5.0 };

fn ricci_union() -> Solid {
    let [a, b] = gauges();
    a.union_with(b, RICCI)
}

fn ricci_intersection() -> Solid {
    let [a, b] = gauges();
    a.intersection_with(b, RICCI)
}

fn ricci_difference() -> Solid {
    let [a, b] = gauges();
    a.difference_with(b, RICCI)
}

pub const BLENDS: &[Entry] = &[
    ("smooth_union", || united(SMOOTH)),
    ("smooth_intersection", || intersected(SMOOTH)),
    ("smooth_difference", || subtracted(SMOOTH)),
    ("fillet_union", || united(FILLET)),
    ("fillet_intersection", || intersected(FILLET)),
    ("fillet_difference", || subtracted(FILLET)),
    ("fillet_union_all", || many(FILLET)),
    ("fillet_difference_all", || many_cut(Blend::Fillet { radius: 0.08 })),
    ("chamfer_union", || united(CHAMFER)),
    ("chamfer_intersection", || intersected(CHAMFER)),
    ("chamfer_difference", || subtracted(CHAMFER)),
    ("displacement_union", || united(ADDED)),
    ("displacement_intersection", || intersected(TAKEN_OFF)),
    ("displacement_difference", || subtracted(TAKEN_OFF)),
    ("ricci_union", ricci_union),
    ("ricci_intersection", ricci_intersection),
    ("ricci_difference", ricci_difference),
];
