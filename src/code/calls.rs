//! Entries of the catalogue as code.

use glam::{DAffine2, DAffine3, DVec2};

use super::function::Body;
use super::graph::Item;
use super::syntax::{Code, joined as line_of, number};
use super::values::value;
use crate::catalogue::{Call, Group};
use crate::form::Form;
use crate::{Profile, RFunction, Value};

/// Three arguments that are wider are given to a variable.
const LONG_ARGUMENTS: usize = 20;

/// The code of a node, whose operands have been written.
pub(super) fn expression(body: &mut Body, call: &Call, item: &Item) -> Code {
    let group = call.entry.group();
    if matches!(group, Group::Join | Group::BlendedJoin) && call.entry.name() != "complement" {
        return joined(body, call, item);
    }
    let is_profile = item.key.1;
    let mut arguments = arguments(body, call, is_profile);
    let name = call.entry.name();
    let Some(operand) = item.operands.first() else { return leaf(body, call, is_profile, arguments) };
    let operand = match line_of(&arguments).chars().count() {
        // Rustfmt has rules of its own for many long arguments at the end of a chain.
        width if arguments.len() > 2 && width > LONG_ARGUMENTS => body.variable(*operand),
        _ => body.receiver(*operand),
    };
    let of = |code: Code| vec![code];
    match name {
        "rotate_z" if is_profile => operand.then("rotate", arguments),
        "affine" => affine(body, call, operand, is_profile),
        "extrude_with" => {
            let fields = ["height", "twist", "scale", "caps"].into_iter().zip(arguments).collect();
            let extrusion = body.argument(Code::Record("Extrusion", fields), "extrusion");
            operand.then("extrude_with", of(Code::Reference(Box::new(extrusion))))
        }
        "sweep_helix" => {
            let helix = match call.values[..] {
                [.., Value::Switch(false), Value::Caps(crate::Caps::Flat)] => {
                    arguments.truncate(3);
                    Code::call("Helix::new", arguments)
                }
                _ => {
                    let names = ["radius", "pitch", "turns", "left_handed", "ends"];
                    Code::Record("Helix", names.into_iter().zip(arguments).collect())
                }
            };
            let helix = body.argument(helix, "helix");
            operand.then("sweep_helix", of(Code::Reference(Box::new(helix))))
        }
        "paint" => {
            let usual =
                matches!(call.values[..], [_, Value::Number(roughness)] if roughness.to_bits() == 0.5f64.to_bits());
            if usual {
                arguments.truncate(1);
                return operand.then("paint", arguments);
            }
            let paint = Code::Record("Paint", ["color", "roughness"].into_iter().zip(arguments).collect());
            let paint = body.argument(paint, "paint");
            operand.then("paint", of(paint))
        }
        // The method of the same name.
        name => operand.then(name, arguments),
    }
}

/// The values of a call, in order; those that are wide as variables.
fn arguments(body: &mut Body, call: &Call, is_profile: bool) -> Vec<Code> {
    let mut codes = Vec::new();
    for (parameter, given) in call.entry.parameters().iter().zip(&call.values) {
        if matches!(given, Value::Map(_)) {
            continue;
        }
        let planar = match given {
            Value::Vector(v) if is_profile => Some(Value::PlaneVector(v.truncate())),
            _ => None,
        };
        let mut code = value(parameter, planar.as_ref().unwrap_or(given), &body.lengths);
        if let (Code::List(_, counts), Value::Counts(_), true) = (&mut code, given, is_profile) {
            counts.truncate(2);
        }
        if let Code::List(_, contours) = &mut code
            && matches!(given, Value::Contours(_))
        {
            for contour in contours {
                *contour = body.argument(contour.clone(), "contour");
            }
        }
        codes.push(body.argument(code, parameter.name()));
    }
    codes
}

fn leaf(body: &mut Body, call: &Call, is_profile: bool, mut arguments: Vec<Code>) -> Code {
    let name = call.entry.name();
    let made = match name {
        "superhyperboloid" => {
            let verb = match call.values[..] {
                [.., Value::Choice(sheets), Value::Choice(axis)] => {
                    let sheets = if sheets == "two" { "two_sheets" } else { "one_sheet" };
                    if axis == "x" { format!("{sheets}_x") } else { sheets.to_string() }
                }
                _ => String::new(),
            };
            arguments.truncate(4);
            Code::call(format!("Superhyperboloid::{verb}"), arguments)
        }
        "generalised_superquadric" => Code::call("GeneralisedSuperquadric::new", arguments),
        "supershape" => Code::call("Supershape::with", arguments),
        "sheet_lattice" => record("SheetLattice", call, arguments),
        "network_lattice" => record("NetworkLattice", call, arguments),
        "formula" | "profile_formula" => {
            body.can_fail = true;
            Code::Try(Box::new(Code::call("Formula::from_vm", arguments)))
        }
        "rectangle" => {
            let is_sharp = matches!(call.values[..], [_, Value::Number(radius)] if radius.to_bits() == 0);
            if is_sharp {
                arguments.truncate(1);
            }
            let verb = if is_sharp { "rectangle" } else { "rounded_rectangle" };
            return Code::call(format!("Profile::{verb}"), arguments);
        }
        "polygon" => return polygon(body, call, arguments),
        name if is_profile => return Code::call(format!("Profile::{name}"), arguments),
        name => return Code::call(format!("Solid::{name}"), arguments),
    };
    let made = body.argument(made, name);
    Code::call(if is_profile { "Profile::from" } else { "Solid::from" }, vec![made])
}

/// A leaf that is a record of its parameters.
fn record(path: &'static str, call: &Call, arguments: Vec<Code>) -> Code {
    let names = call.entry.parameters().iter().map(crate::Parameter::name);
    Code::Record(path, names.zip(arguments).collect())
}

fn polygon(body: &mut Body, call: &Call, mut arguments: Vec<Code>) -> Code {
    match &call.values[..] {
        [Value::Contours(contours)] if contours.is_empty() => {
            let none = Code::word("Vec::<Vec<[f64; 2]>>::new()");
            Code::call("Profile::from", vec![Code::call("Polygon::new", vec![none])])
        }
        [Value::Contours(contours)] if contours.len() == 1 && !contours[0].is_empty() => {
            // An only contour is the list in the list.
            let contour = match arguments.pop() {
                Some(Code::List(_, mut contours)) => contours.pop(),
                other => other,
            };
            let contour = match contour {
                Some(Code::List(_, points)) => Code::list(points),
                Some(other) => other,
                None => Code::word(""),
            };
            Code::call("Profile::polygon", vec![contour])
        }
        _ => {
            let polygon = body.argument(Code::call("Polygon::new", arguments), "polygon");
            Code::call("Profile::from", vec![polygon])
        }
    }
}

fn affine(body: &mut Body, call: &Call, operand: Code, is_profile: bool) -> Code {
    let [Value::Map(map)] = call.values[..] else { return operand };
    let columns = |body: &mut Body, columns: Vec<Vec<f64>>| {
        let column = |column: Vec<f64>| Code::list(column.into_iter().map(number).collect());
        let list = Code::list(columns.into_iter().map(column).collect());
        vec![Code::Reference(Box::new(body.argument(list, "columns")))]
    };
    if let Some(flat) = is_profile.then(|| planar(&map)).flatten() {
        let columns = columns(body, flat.to_cols_array_2d().map(|column| column.to_vec()).to_vec());
        let map = body.argument(Code::call("DAffine2::from_cols_array_2d", columns), "map");
        return operand.then("affine", vec![map]);
    }
    let columns = columns(body, map.to_cols_array_2d().map(|column| column.to_vec()).to_vec());
    let verb = if is_profile { "affine_in_space" } else { "affine" };
    let map = body.argument(Code::call("DAffine3::from_cols_array_2d", columns), "map");
    operand.then(verb, vec![map])
}

/// The map of the plane that [`Profile::affine`] makes this map of, if there is one.
fn planar(map: &DAffine3) -> Option<DAffine2> {
    let m = &map.matrix3;
    let flat = DAffine2::from_cols(m.x_axis.truncate(), m.y_axis.truncate(), map.translation.truncate());
    let profile = Profile::rectangle(DVec2::ONE).affine(flat);
    let Form::Affine { map: made, .. } = profile.form() else { return None };
    (made.to_cols_array().map(f64::to_bits) == map.to_cols_array().map(f64::to_bits)).then_some(flat)
}

fn joined(body: &mut Body, call: &Call, item: &Item) -> Code {
    let kind = if item.key.1 { "Profile" } else { "Solid" };
    let name = call.entry.name();
    let (verb, of_all) = match name {
        "union" => ("union", "union_all"),
        "intersection" => ("intersection", "intersection_all"),
        "difference" => ("difference", "difference_all"),
        "union_with" => ("union_with", "union_all_with"),
        "intersection_with" => ("intersection_with", "intersection_all_with"),
        "difference_with" => ("difference_with", "difference_all_with"),
        _ => ("symmetric_difference", "symmetric_difference"),
    };
    let keys = &item.operands;
    if let [a, b] = keys[..] {
        let operator = match (name, &call.values[..]) {
            ("union", [Value::Function(RFunction::P(2.0))]) => Some('|'),
            ("intersection", [Value::Function(RFunction::P(2.0))]) => Some('&'),
            ("difference", [Value::Function(RFunction::P(2.0))]) => Some('-'),
            ("symmetric_difference", [Value::Function(RFunction::P(2.0))]) => Some('^'),
            _ => None,
        };
        // The same on both sides of an operator looks like a slip, to clippy too.
        if let Some(operator) = operator.filter(|_| a != b) {
            let [a, b] = [a, b].map(|key| body.other(key));
            return Code::Binary(Box::new(a), operator, Box::new(b));
        }
        let first = body.first(a);
        let mut all = vec![body.other(b)];
        all.extend(arguments(body, call, false));
        return first.then(verb, all);
    }
    if let (true, Some((first, others))) = (verb.starts_with("difference"), keys.split_first()) {
        let first = body.first(*first);
        let mut all = vec![body.list(others, kind)];
        all.extend(arguments(body, call, false));
        return first.then(of_all, all);
    }
    let mut all = vec![body.list(keys, kind)];
    all.extend(arguments(body, call, false));
    Code::call(format!("{kind}::{of_all}"), all)
}
