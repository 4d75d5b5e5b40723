//! Values as code.

use glam::{DAffine3, DVec2};

use super::lengths::Lengths;
use super::syntax::{Code, number};
use crate::catalogue::{Call, Part};
use crate::{Angle, Bounds, Gielis, Parameter, Turns, Unit, Value, deg};

/// The code of a value.
pub(super) fn value(parameter: &Parameter, value: &Value, lengths: &Lengths) -> Code {
    let coordinate = |v: f64| if parameter.unit() == Unit::Length { lengths.code(v) } else { number(v) };
    let vector = |numbers: &[f64]| Code::list(numbers.iter().map(|v| coordinate(*v)).collect());
    let contour = |points: &Vec<DVec2>| match points[..] {
        [] => Code::word("Vec::<[f64; 2]>::new()"),
        _ => Code::List("vec!", points.iter().map(|point| vector(&point.to_array())).collect()),
    };
    match value {
        Value::Number(v) => coordinate(*v),
        Value::Angle(v) => angle(*v),
        Value::Count(n) => Code::word(n.to_string()),
        Value::Switch(on) => Code::word(on.to_string()),
        Value::Choice(word) => choice(parameter, word),
        Value::Vector(v) => vector(&v.to_array()),
        Value::PlaneVector(v) => vector(&v.to_array()),
        Value::Counts(counts) => Code::list(counts.iter().map(|n| Code::word(n.to_string())).collect()),
        Value::Color(color) => Code::list(color.iter().map(|n| Code::word(n.to_string())).collect()),
        Value::Contours(contours) => Code::list(contours.iter().map(contour).collect()),
        Value::Points(points) => Code::list(points.iter().map(pair).collect()),
        Value::Text(text) => Code::word(quoted(text)),
        Value::Bounds(bounds) => bounds_of(bounds),
        Value::Map(map) => columns(map),
        Value::Curve(curve) => curve_of(curve),
        Value::Law(_) | Value::Function(_) | Value::Blend(_) | Value::Caps(_) => composed(value, lengths),
        // Whatever else there is to come.
        other => Code::word(format!("{other:?}")),
    }
}

/// A value that is itself a call of an entry.
fn composed(value: &Value, lengths: &Lengths) -> Code {
    let Some(call) = Call::of(&Part::Value(value.clone())) else { return Code::word(format!("{value:?}")) };
    let names = call.entry.parameters().iter();
    let codes = names.clone().zip(&call.values).map(|(parameter, value)| self::value(parameter, value, lengths));
    let mut codes: Vec<Code> = codes.collect();
    let variant = |of: &str, name: &str| format!("{of}::{name}");
    let record = |path: &'static str, codes: Vec<Code>| {
        Code::Record(path, names.clone().map(Parameter::name).zip(codes).collect())
    };
    match call.entry.name() {
        "min_max" => Code::word("RFunction::MIN_MAX"),
        "distance" => Code::word("RFunction::Distance"),
        "alpha" => Code::call(variant("RFunction", "Alpha"), codes),
        "zero" => record("RFunction::Zero", codes),
        "p" => Code::call(variant("RFunction", "P"), codes),
        "associative" => Code::call(variant("RFunction", "Associative"), codes),
        "smooth" => record("Blend::Smooth", codes),
        "fillet" => record("Blend::Fillet", codes),
        "chamfer" => record("Blend::Chamfer", codes),
        "displacement" => record("Blend::Displacement", codes),
        "ricci" => record("Blend::Ricci", codes),
        "flat_caps" => Code::word("Caps::Flat"),
        "chamfered_caps" => Code::call(variant("Caps", "Chamfered"), codes),
        "rounded_caps" => Code::call(variant("Caps", "Rounded"), codes),
        // A number is a law.
        "constant" => codes.remove(0),
        "linear" => record("LinearLaw", codes),
        "smooth_step" => {
            let ends = call.values.iter().map(|end| match end {
                Value::PlaneVector(end) => pair(end),
                other => Code::word(format!("{other:?}")),
            });
            record("SmoothStep", ends.collect())
        }
        "wave" => record("SineWave", codes),
        "table" => Code::call("LawTable::new", codes),
        _ => Code::word(format!("{value:?}")),
    }
}

/// An angle in degrees, where these are exact and short.
pub(super) fn angle(angle: Angle) -> Code {
    let degrees = angle.degrees();
    let short = [degrees.round(), (degrees * 1e6).round() / 1e6, (degrees * 1e9).round() / 1e9];
    let exact = short.into_iter().find(|short| deg(*short).radians().to_bits() == angle.radians().to_bits());
    let exact = exact.filter(|_| are_radians_long(angle));
    match exact {
        Some(degrees) => Code::call("deg", vec![number(degrees)]),
        None => Code::call("rad", vec![number(angle.radians())]),
    }
}

/// Whether degrees are shorter.
fn are_radians_long(angle: Angle) -> bool {
    format!("{:?}", angle.radians()).len() > 6 || angle == Angle::ZERO
}

fn pair(point: &DVec2) -> Code {
    Code::Tuple(vec![number(point.x), number(point.y)])
}

fn choice(parameter: &Parameter, word: &str) -> Code {
    let of = match parameter.name() {
        "surface" => "MinimalSurface",
        "radius" => "Radius",
        "turns" => "Turns",
        // Part of a method's name.
        _ => return Code::word(word),
    };
    let upper = |word: &str| {
        let mut letters = word.chars();
        letters.next().map(|first| first.to_ascii_uppercase().to_string() + letters.as_str()).unwrap_or_default()
    };
    Code::word(format!("{of}::{}", word.split('_').map(upper).collect::<String>()))
}

fn curve_of(curve: &Gielis) -> Code {
    let Gielis { m, n1, n2, n3, a, b, turns } = *curve;
    if (a, b, turns) == (1.0, 1.0, Turns::Principal) {
        return Code::call("Gielis::new", [m, n1, n2, n3].map(number).to_vec());
    }
    let numbers = [("m", m), ("n1", n1), ("n2", n2), ("n3", n3), ("a", a), ("b", b)];
    let fields = numbers.into_iter().map(|(name, v)| (name, number(v)));
    let turns = ("turns", Code::word(format!("Turns::{turns:?}")));
    Code::Record("Gielis", fields.chain([turns]).collect())
}

fn bounds_of(bounds: &Bounds) -> Code {
    let corner = |corner: glam::DVec3| Code::list(corner.to_array().map(number).to_vec());
    Code::call("Bounds::new", vec![corner(bounds.min), corner(bounds.max)])
}

/// A map by its columns, the translation last.
fn columns(map: &DAffine3) -> Code {
    let column = |column: &[f64; 3]| Code::list(column.map(number).to_vec());
    Code::list(map.to_cols_array_2d().iter().map(column).collect())
}

/// A text in quotes; one of several lines as it stands.
pub(super) fn quoted(text: &str) -> String {
    if text.contains('\n') {
        let lines: Vec<String> = text.split('\n').map(escaped).collect();
        return format!("\"\\\n{}\"", lines.join("\n"));
    }
    format!("\"{}\"", escaped(text))
}

fn escaped(text: &str) -> String {
    let debug = format!("{text:?}");
    debug[1..debug.len() - 1].to_string()
}
