//! Random solids of every entry of the catalogue, of about the size of 1.

use rvachev::{
    Profile, Solid, catalogue,
    catalogue::{Call, Entry, Group, Kind, Operands, Parameter, Part, Value},
    rad,
};

use crate::support::{Random, random_solid};
use crate::zoo::random_profile;

/// From this depth on a first operand is only one call less deep.
const DEEP: usize = 4;

/// What the lengths of a solid are of: offsets, shells, roundings, fillets, chamfers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lengths {
    /// Leaves whose value is the distance.
    Exact,
    /// One of them is of anything: its distances are measured, which takes a thousand times as long
    /// as all that is asked of other solids.
    Measured,
}

/// A solid for a seed, which may be one that is refused when it is used; `None` where there is
/// none. One of twenty has measured lengths.
pub fn solid(seed: u64) -> Option<Solid> {
    made(seed, 0.05)
}

/// The same for a million seeds: three of a thousand have measured lengths.
pub fn cheap(seed: u64) -> Option<Solid> {
    made(seed, 0.003)
}

/// The same with measured lengths in this part.
pub fn made(seed: u64, measured: f64) -> Option<Solid> {
    // Of a number that has nothing to do with that of the next seed: sources whose numbers differ
    // by the step from one to the next go through the same ones.
    let mut random = Random::new(Random::new(seed).bits());
    if random.chance(measured) {
        let depth = 1 + random.below(DEEP - 1);
        return any(&mut random, depth, Lengths::Measured);
    }
    // Some are a chain of many calls.
    let depth = if random.chance(0.1) { DEEP + random.below(6) } else { random.below(DEEP) };
    if random.chance(0.1) {
        let solid = random_solid(&mut random, depth.min(1));
        return Some(solid);
    }
    any(&mut random, depth, Lengths::Exact)
}

/// The solid, cut to a ball if it has no end; `None` if it is refused.
pub fn bounded(solid: &Solid) -> Option<Solid> {
    let bounds = solid.bounds().ok()?;
    let is_small = bounds.is_finite() && bounds.longest_side() < 100.0;
    let solid = if is_small { solid.clone() } else { solid & Solid::sphere(2.5) };
    solid.bounds().is_ok_and(|bounds| !bounds.is_empty()).then_some(solid)
}

/// A solid whose calls are up to `depth` + 1 deep, not counting moves.
fn any(random: &mut Random, depth: usize, lengths: Lengths) -> Option<Solid> {
    let is_last = lengths == Lengths::Measured && depth <= 1;
    let fits = |entry: &&Entry| {
        let has_depth = (entry.operands() == Operands::None) == (depth == 0);
        is_shape(entry) && if is_last { measures(entry) } else { has_depth && !is_filled(entry) }
    };
    let entries: Vec<&Entry> = catalogue().iter().filter(fits).collect();
    let entry = random.pick(&entries);
    let call = called(random, entry, depth, lengths)?;
    let solid = match call.make().ok()? {
        Part::Solid(solid) => solid,
        Part::Profile(profile) => profile.extrude(random.range(0.3, 2.0)),
        _ => return None,
    };
    Some(match random.below(3) {
        0 => solid.rotate(random.rotation()).translate(random.vector(-0.7, 0.7)),
        1 => solid.translate(random.vector(-4.0, 4.0).round() * 0.25),
        _ => solid,
    })
}

/// A leaf whose value is the distance, somewhere.
fn exact(random: &mut Random) -> Solid {
    let [a, b, c] = random.vector(0.3, 1.5).to_array();
    let solid = match random.below(6) {
        0 => Solid::sphere(a),
        1 => Solid::cuboid([a, b, c]),
        2 => Solid::cylinder(a, b),
        3 => Solid::torus(a, 0.8 * a.min(b)),
        4 => Solid::capsule(a, 2.0 * a + b),
        _ => Solid::cone(a, 0.5 * b, c),
    };
    solid.rotate(random.rotation()).translate(random.vector(-0.5, 0.5))
}

fn is_shape(entry: &Entry) -> bool {
    !matches!(entry.group(), Group::Curve | Group::Law | Group::Function | Group::Blend | Group::Caps)
}

fn called(random: &mut Random, entry: &'static Entry, depth: usize, lengths: Lengths) -> Option<Call> {
    let mut call = Call::of(&entry.example())?;
    let is_measuring = lengths == Lengths::Measured && depth <= 1;
    for (i, value) in call.values.iter_mut().enumerate() {
        let range = call.entry.parameters().get(i).map(Parameter::range);
        let other = varied(random, value, is_measuring);
        let fits = |v: f64| range.is_none_or(|range| range.contains(v));
        if numbers(&other).into_iter().all(fits) {
            *value = other;
        }
    }
    // Lengths of what tells distances are not measured.
    let is_length = is_length(entry);
    for (nth, operand) in call.operands.iter_mut().enumerate() {
        match operand {
            Part::Solid(solid) if entry.operands() != Operands::Length => {
                let next = if nth == 0 && depth >= DEEP { depth - 1 } else { random.below(depth.clamp(1, DEEP)) };
                *solid = match (lengths, is_measuring) {
                    (Lengths::Measured, false) if nth == 0 => any(random, next.max(1), Lengths::Measured)?,
                    (_, true) if nth > 0 && random.chance(0.5) => exact(random),
                    (_, true) => any(random, 0, Lengths::Exact)?,
                    _ if is_length => exact(random),
                    _ => any(random, next, Lengths::Exact)?,
                };
            }
            Part::Profile(profile) if is_length => *profile = Profile::rectangle(random.vector(0.5, 2.0).truncate()),
            Part::Profile(profile) => *profile = random_profile(random, 1),
            _ => {}
        }
    }
    Some(call)
}

fn is_length(entry: &Entry) -> bool {
    entry.group() == Group::Length && entry.name() != "level"
}

/// What measures whatever its operand is.
fn is_filled(entry: &Entry) -> bool {
    ["rounded", "filleted"].contains(&entry.name())
}

/// Whether it may ask for distances that are measured.
fn measures(entry: &Entry) -> bool {
    is_length(entry) || entry.parameters().iter().any(|parameter| matches!(parameter.kind(), Kind::Blend | Kind::Caps))
}

/// Blends and caps that ask for distances.
const MEASURED: [&str; 4] = ["fillet", "chamfer", "chamfered_caps", "rounded_caps"];

/// A number of the same sign, now and then a round one.
fn near(random: &mut Random, v: f64) -> f64 {
    let factor = random.log_range(0.3, 2.0);
    match random.below(4) {
        0 => v,
        1 => (v * factor * 4.0).round() / 4.0,
        _ => v * factor,
    }
}

fn varied(random: &mut Random, value: &Value, is_measuring: bool) -> Value {
    let mut of_group = |group| of_group(random, group, is_measuring);
    match value {
        Value::Number(v) => Value::Number(near(random, *v)),
        Value::Angle(angle) => Value::Angle(rad(near(random, angle.radians()))),
        Value::Vector(v) => Value::Vector(v.to_array().map(|v| near(random, v)).into()),
        Value::PlaneVector(v) => Value::PlaneVector(v.to_array().map(|v| near(random, v)).into()),
        Value::Count(n) => Value::Count((*n + random.below(4) as u32).saturating_sub(1)),
        Value::Counts(counts) => Value::Counts(counts.map(|n| (n + random.below(2) as u32).min(4))),
        Value::Function(_) => Value::Function(random.rule()),
        Value::Map(_) => Value::Map(random.affine()),
        Value::Blend(_) => of_group(Group::Blend).unwrap_or_else(|| value.clone()),
        Value::Law(_) => of_group(Group::Law).unwrap_or_else(|| value.clone()),
        Value::Caps(_) => of_group(Group::Caps).unwrap_or_else(|| value.clone()),
        Value::Curve(_) => of_group(Group::Curve).unwrap_or_else(|| value.clone()),
        other => other.clone(),
    }
}

/// A value that an entry of this group makes; blends and caps that are measured, or none that is.
fn of_group(random: &mut Random, group: Group, is_measuring: bool) -> Option<Value> {
    let is_choice = matches!(group, Group::Blend | Group::Caps);
    let fits = |entry: &&'static Entry| {
        entry.group() == group && (!is_choice || MEASURED.contains(&entry.name()) == is_measuring)
    };
    let entries: Vec<&'static Entry> = catalogue().iter().filter(fits).collect();
    let entry = random.pick(&entries);
    called(random, entry, 0, Lengths::Exact)?.make().ok()?.into_value()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(v) => vec![*v],
        Value::Angle(angle) => vec![angle.degrees()],
        Value::Count(n) => vec![f64::from(*n)],
        Value::Counts(counts) => counts.map(f64::from).to_vec(),
        Value::Vector(v) => v.to_array().to_vec(),
        Value::PlaneVector(v) => v.to_array().to_vec(),
        _ => Vec::new(),
    }
}
