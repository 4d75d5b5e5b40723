//! Random solids of every entry of the catalogue, of about the size of 1.

use rvachev::{
    Profile, Solid, catalogue,
    catalogue::{Call, Entry, Group, Operands, Parameter, Part, Value},
    rad,
};

use crate::support::{Random, random_solid};
use crate::zoo::random_profile;

/// From this depth on a first operand is only one call less deep.
const DEEP: usize = 4;

/// A solid for a seed, which may be one that is refused when it is used; `None` where there is
/// none.
pub fn solid(seed: u64) -> Option<Solid> {
    let mut random = Random::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 11);
    // Some are a chain of many calls.
    let depth = if random.chance(0.1) { DEEP + random.below(6) } else { random.below(DEEP) };
    if random.chance(0.25) {
        let solid = random_solid(&mut random, depth.min(2));
        return Some(solid);
    }
    any(&mut random, depth)
}

/// The solid, cut to a ball if it has no end; `None` if it is refused.
pub fn bounded(solid: &Solid) -> Option<Solid> {
    let bounds = solid.bounds().ok()?;
    let is_small = bounds.is_finite() && bounds.longest_side() < 100.0;
    let solid = if is_small { solid.clone() } else { solid & Solid::sphere(2.5) };
    solid.bounds().is_ok_and(|bounds| !bounds.is_empty()).then_some(solid)
}

/// A solid whose calls are up to `depth` + 1 deep, not counting moves.
fn any(random: &mut Random, depth: usize) -> Option<Solid> {
    let entries = catalogue().iter().filter(|entry| (entry.operands() == Operands::None) == (depth == 0));
    let entries: Vec<&Entry> = entries.filter(|entry| is_shape(entry)).collect();
    let entry = random.pick(&entries);
    let call = called(random, entry, depth)?;
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

fn called(random: &mut Random, entry: &'static Entry, depth: usize) -> Option<Call> {
    let mut call = Call::of(&entry.example())?;
    for (i, value) in call.values.iter_mut().enumerate() {
        let range = call.entry.parameters().get(i).map(Parameter::range);
        let other = varied(random, value);
        let fits = |v: f64| range.is_none_or(|range| range.contains(v));
        if numbers(&other).into_iter().all(fits) {
            *value = other;
        }
    }
    // What is measured takes a while: there is little of it, and on leaves. Lengths of what tells
    // distances are not.
    let is_length = entry.group() == Group::Length && entry.name() != "level";
    let is_measured = call.values.iter().any(is_measured);
    let is_rare = random.chance(0.2);
    if is_measured && !is_rare {
        return None;
    }
    let is_slow = is_length || is_measured;
    for (nth, operand) in call.operands.iter_mut().enumerate() {
        match operand {
            Part::Solid(solid) if entry.operands() != Operands::Length => {
                let next = if nth == 0 && depth >= DEEP { depth - 1 } else { random.below(depth.clamp(1, DEEP)) };
                *solid = match is_slow {
                    false => any(random, next)?,
                    true if is_rare => any(random, 0)?,
                    true => exact(random),
                };
            }
            Part::Profile(profile) if is_slow => *profile = Profile::rectangle(random.vector(0.5, 2.0).truncate()),
            Part::Profile(profile) => *profile = random_profile(random, 1),
            _ => {}
        }
    }
    Some(call)
}

/// Whether it asks for distances that may have to be measured.
fn is_measured(value: &Value) -> bool {
    let is_such = matches!(value, Value::Blend(_) | Value::Caps(_));
    let call = is_such.then(|| Call::of(&Part::Value(value.clone()))).flatten();
    call.is_some_and(|call| ["fillet", "chamfer", "chamfered_caps", "rounded_caps"].contains(&call.entry.name()))
}

/// A number of the same sign, now and then a round one.
fn near(random: &mut Random, v: f64) -> f64 {
    let factor = random.log_range(0.3, 2.0);
    match random.below(4) {
        0 => v,
        1 => (v * factor * 4.0).round() / 4.0,
        _ => v * factor,
    }
}

fn varied(random: &mut Random, value: &Value) -> Value {
    match value {
        Value::Number(v) => Value::Number(near(random, *v)),
        Value::Angle(angle) => Value::Angle(rad(near(random, angle.radians()))),
        Value::Vector(v) => Value::Vector(v.to_array().map(|v| near(random, v)).into()),
        Value::PlaneVector(v) => Value::PlaneVector(v.to_array().map(|v| near(random, v)).into()),
        Value::Count(n) => Value::Count((*n + random.below(4) as u32).saturating_sub(1)),
        Value::Counts(counts) => Value::Counts(counts.map(|n| (n + random.below(2) as u32).min(4))),
        Value::Function(_) => Value::Function(random.rule()),
        Value::Map(_) => Value::Map(random.affine()),
        Value::Blend(_) => of_group(random, Group::Blend).unwrap_or_else(|| value.clone()),
        Value::Law(_) => of_group(random, Group::Law).unwrap_or_else(|| value.clone()),
        Value::Caps(_) => of_group(random, Group::Caps).unwrap_or_else(|| value.clone()),
        Value::Curve(_) => of_group(random, Group::Curve).unwrap_or_else(|| value.clone()),
        other => other.clone(),
    }
}

/// A value that an entry of this group makes.
fn of_group(random: &mut Random, group: Group) -> Option<Value> {
    let entries: Vec<&'static Entry> = catalogue().iter().filter(|entry| entry.group() == group).collect();
    let entry = random.pick(&entries);
    called(random, entry, 0)?.make().ok()?.into_value()
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
