//! Lengths that occur more than once: each becomes a variable.

use std::collections::HashMap;

use super::graph::{Item, Key};
use super::names::{Names, identifier};
use super::syntax::{Code, number};
use crate::catalogue::{Call, Part};
use crate::{Parameter, Unit, Value};

/// Outlines of more points than these are data, which nobody edits by hand.
const MOST_POINTS: usize = 32;

/// The names of lengths.
#[derive(Default)]
pub(super) struct Lengths {
    names: HashMap<u64, String>,
    /// The variables, in order, with their values.
    pub(super) variables: Vec<(String, f64)>,
}

/// Where a length stands: the parameter, which of its coordinates, and within what.
struct Use {
    value: f64,
    parameter: &'static str,
    axis: Option<usize>,
    within: String,
}

impl Lengths {
    /// Those of all nodes.
    pub(super) fn of(items: &[Item], names: &mut Names) -> Lengths {
        let mut uses: Vec<Use> = Vec::new();
        let mut within: HashMap<Key, String> = HashMap::new();
        // Operators come after their operands.
        for item in items.iter().rev() {
            let name = item.name.as_ref().map(|name| identifier(name, "part"));
            let within = match name.or_else(|| within.get(&item.key).cloned()) {
                Some(name) => {
                    for operand in &item.operands {
                        within.entry(*operand).or_insert_with(|| name.clone());
                    }
                    name
                }
                None => String::new(),
            };
            let Some(call) = &item.call else { continue };
            let mut here = Vec::new();
            collect(call, &within, &mut here);
            uses.extend(here.into_iter().rev());
        }
        uses.reverse();
        let mut of_value: HashMap<u64, Vec<&Use>> = HashMap::new();
        for it in &uses {
            of_value.entry(it.value.abs().to_bits()).or_default().push(it);
        }
        let mut lengths = Lengths::default();
        for it in &uses {
            let bits = it.value.abs().to_bits();
            let all = &of_value[&bits];
            if all.len() < 2 || lengths.names.contains_key(&bits) {
                continue;
            }
            let name = named(all);
            let longer = format!("{}_{name}", all[0].within);
            let is_better = !names.is_free(&name) && !all[0].within.is_empty() && names.is_free(&longer);
            let name = names.take(if is_better { &longer } else { &name });
            lengths.names.insert(bits, name.clone());
            lengths.variables.push((name, it.value.abs()));
        }
        lengths
    }

    /// A length: a variable, if it is one.
    pub(super) fn code(&self, value: f64) -> Code {
        match self.names.get(&value.abs().to_bits()) {
            Some(name) if value.is_sign_negative() => Code::word(format!("-{name}")),
            Some(name) => Code::word(name),
            None => number(value),
        }
    }
}

/// What a length is called after the places where it stands.
fn named(uses: &[&Use]) -> String {
    let same = |name: &dyn Fn(&Use) -> String| {
        let first = name(uses[0]);
        uses.iter().all(|it| name(it) == first).then_some(first)
    };
    let full = |it: &Use| match (it.parameter, it.axis) {
        ("size", Some(axis)) => ["width", "depth", "height"][axis].to_string(),
        ("offset" | "contours", Some(axis)) => ["x", "y", "z"][axis].to_string(),
        (parameter, Some(axis)) => format!("{parameter}_{}", ["x", "y", "z"][axis]),
        (parameter, None) => parameter.to_string(),
    };
    let plain = |it: &Use| it.parameter.to_string();
    same(&full).or_else(|| same(&plain)).filter(|name| name != "contours").unwrap_or_else(|| "length".to_string())
}

fn collect(call: &Call, within: &str, uses: &mut Vec<Use>) {
    for (parameter, value) in call.entry.parameters().iter().zip(&call.values) {
        if let Some(inner) = Call::of(&Part::Value(value.clone())) {
            collect(&inner, within, uses);
        }
        let here = numbers(parameter, value).into_iter().filter(|(value, _)| value.is_finite() && *value != 0.0);
        let use_of = |(value, axis)| Use { value, parameter: parameter.name(), axis, within: within.to_string() };
        uses.extend(here.map(use_of));
    }
}

/// The lengths among the numbers of a value, each with its axis.
fn numbers(parameter: &Parameter, value: &Value) -> Vec<(f64, Option<usize>)> {
    if parameter.unit() != Unit::Length {
        return Vec::new();
    }
    let axes = |numbers: &[f64]| numbers.iter().enumerate().map(|(axis, v)| (*v, Some(axis))).collect::<Vec<_>>();
    match value {
        Value::Number(v) => vec![(*v, None)],
        Value::Vector(v) => axes(&v.to_array()),
        Value::PlaneVector(v) => axes(&v.to_array()),
        Value::Contours(contours) if contours.iter().map(Vec::len).sum::<usize>() <= MOST_POINTS => {
            contours.iter().flatten().flat_map(|point| axes(&point.to_array())).collect()
        }
        _ => Vec::new(),
    }
}
