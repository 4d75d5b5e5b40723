//! Forms and the catalogue: whatever can be built can be read, and built again of what was read.

use std::collections::HashSet;

use glam::{DQuat, DVec2, DVec3};
use rvachev::{
    Angle, Blend, Bounds, Caps, Extrusion, Helix, ParamError, Polygon, Profile, RFunction, Solid, SolidError,
    catalogue,
    catalogue::{Call, Entry, Group, Kind, Part, Range, Value},
    deg,
    field::{Field, Real},
    form::{Form, Repetition},
    law::{BuiltInLaw, Law, LinearLaw},
    rad,
};

use crate::support::Random;
use crate::zoo::{blended, catalogue_leaf, catalogue_map, lengthened, random_profile};

/// A part made again of calls alone, down to what has none.
fn rebuilt(part: &Part) -> Part {
    let Some(mut call) = Call::of(part) else { return part.clone() };
    for operand in &mut call.operands {
        *operand = rebuilt(operand);
    }
    for value in &mut call.values {
        if let Part::Value(made) = rebuilt(&Part::Value(value.clone())) {
            *value = made;
        }
    }
    call.make().unwrap_or_else(|error| panic!("{part:?}: {error}"))
}

/// A solid by which a part shows.
pub(super) fn shown(part: Part) -> Solid {
    let ball = Solid::sphere(1.0);
    match part {
        Part::Solid(solid) => solid,
        Part::Profile(profile) => profile.column(),
        Part::Value(Value::Curve(curve)) => Profile::superpolygon(curve, 1.0).column(),
        Part::Value(Value::Law(law)) => ball.twist_by(rad(1.0), law),
        Part::Value(Value::Function(function)) => ball.union(Solid::cuboid([3.0, 1.0, 1.0]), function),
        Part::Value(Value::Blend(blend)) => ball.union_with(Solid::sphere(1.25).translate(DVec3::X), blend),
        Part::Value(Value::Caps(caps)) => {
            Profile::rectangle([2.0, 1.0]).extrude_with(&Extrusion { caps, ..Extrusion::new(3.0) })
        }
        part => panic!("{part:?}"),
    }
}

fn assert_same(a: &Solid, b: &Solid, name: &str) {
    assert_eq!(a, b, "{name}");
    for i in 0..60 {
        let t = |k: f64| 6.0 * ((f64::from(i) * k).fract() - 0.5);
        let p = DVec3::new(t(0.618), t(0.414), t(0.732));
        match (a.value(p), b.value(p)) {
            (Ok(one), Ok(other)) => assert_eq!(one.to_bits(), other.to_bits(), "{name} at {p}"),
            (Err(one), Err(other)) => assert_eq!(one.to_string(), other.to_string(), "{name}"),
            (one, other) => panic!("{name}: {one:?}, {other:?}"),
        }
    }
}

#[test]
fn every_entry_is_rebuilt_from_its_form() {
    let mut names = HashSet::new();
    for entry in catalogue() {
        let name = entry.name();
        assert!(names.insert(name), "{name} stands for two entries");
        assert!(!entry.doc().is_empty(), "{name}");
        let made = entry.example();
        let call = Call::of(&made).unwrap_or_else(|| panic!("{name} has no call"));
        // A solid beside its mirror image is a union; an axis is not read off a matrix.
        if !["mirrored", "rotate_about"].contains(&name) {
            assert_eq!((call.entry.name(), call.values.len()), (name, entry.parameters().len()));
        }
        assert_eq!(rebuilt(&made), made, "{name}");
        let (a, b) = (shown(made.clone()), shown(rebuilt(&made)));
        assert!(a.surface_program().is_ok(), "{name}: {:?}", a.surface_program().err());
        assert_same(&a, &b, name);
    }
}

#[test]
fn parameters_are_of_the_kinds_that_they_say() {
    for entry in catalogue() {
        let examples = entry.example_values();
        for (i, parameter) in entry.parameters().iter().enumerate() {
            let at = format!("{}.{}", entry.name(), parameter.name());
            assert!(!parameter.doc().is_empty() && !parameter.doc().contains('\n'), "{at}");
            let example = parameter.example();
            let numbers = numbers(&example);
            assert!(numbers.iter().all(|v| parameter.range_given(&examples).contains(*v)), "{at}");
            if let (Kind::Choice(words), Value::Choice(word)) = (parameter.kind(), &example) {
                assert!(words.contains(word), "{at}");
                for word in words {
                    let mut values = examples.clone();
                    values[i] = Value::Text((*word).to_string());
                    assert!(entry.make(&operands(entry), &values).is_ok(), "{at} {word}");
                }
            }
            // What is of another kind is refused.
            let mut values = examples.clone();
            values[i] = if matches!(example, Value::Map(_)) {
                Value::Switch(true)
            } else {
                Value::Map(glam::DAffine3::IDENTITY)
            };
            let error = entry.make(&operands(entry), &values).unwrap_err().to_string();
            assert!(error.contains(parameter.name()), "{at}: {error}");
        }
        assert!(entry.make(&operands(entry), &vec![Value::Switch(true); 9]).is_err(), "{}", entry.name());
    }
}

/// The operands of an example.
fn operands(entry: &Entry) -> Vec<Part> {
    // Of a union of it and its image.
    if entry.name() == "mirrored" {
        return vec![Solid::cuboid([1.0, 1.5, 2.0]).into()];
    }
    Call::of(&entry.example()).expect("examples have calls").operands
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

/// The value with another number in place `at`; `None` where it cannot have it.
fn with_number(value: &Value, at: usize, number: f64) -> Option<Value> {
    Some(match value {
        Value::Number(_) => Value::Number(number),
        Value::Angle(_) => Value::Angle(deg(number)),
        Value::Vector(v) => {
            let mut v = v.to_array();
            v[at] = number;
            Value::Vector(v.into())
        }
        Value::PlaneVector(v) => {
            let mut v = v.to_array();
            v[at] = number;
            Value::PlaneVector(v.into())
        }
        Value::Count(_) | Value::Counts(_) if !(number >= 0.0 && number <= f64::from(u32::MAX)) => return None,
        Value::Count(_) => Value::Count(number as u32),
        Value::Counts(counts) => {
            let mut counts = *counts;
            counts[at] = number as u32;
            Value::Counts(counts)
        }
        _ => return None,
    })
}

/// What is wrong with a part, where that is one of its parameters.
fn fault(part: Part) -> Option<ParamError> {
    match shown(part).surface_program() {
        Err(SolidError::Parameter { source, .. }) => Some(source),
        _ => None,
    }
}

/// Whether an error speaks of a parameter.
fn names(error: &ParamError, parameter: &str) -> bool {
    // What errors call it: a constant law has no name of its own, a row is a grid.
    let parameter = match (parameter, error.parameter.as_str()) {
        ("value", "law") => "law",
        ("count", "counts.x") => "counts",
        _ => parameter,
    };
    error.parameter.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == parameter)
}

/// The numbers just within a range, and just outside of it.
fn ends(range: Range, kind: Kind) -> ([f64; 2], [f64; 3]) {
    let Range { least, most, is_open, .. } = range;
    match kind {
        Kind::Count | Kind::Counts => return ([least, most], [least - 1.0, most + 1.0, f64::NAN]),
        // Degrees are not held to the last digit.
        Kind::Angle => return ([least, most], [least - 1e-9 * least.abs(), most * (1.0 + 1e-9), f64::NAN]),
        _ => {}
    }
    let within = if is_open { least.next_up() } else { least };
    let outside = if is_open { least } else { least.next_down() };
    ([within, most], [outside, most.next_up(), f64::NAN])
}

#[test]
fn ranges_are_those_that_are_checked() {
    // What the operand limits further, or another coordinate of the same vector.
    let limited = [
        ("bend", "curvature"),
        ("bend_between", "from"),
        ("bend_between", "to"),
        ("bend_between", "turn"),
        ("twist_by", "angle"),
        ("sweep_helix", "radius"),
        ("sweep_helix", "pitch"),
        ("smooth_step", "from"),
        ("smooth_step", "to"),
        ("chamfered_caps", "leg"),
        ("rounded_caps", "radius"),
        ("repeat_linear", "step"),
        ("scale_axes", "factors"),
    ];
    let mut probed = 0;
    for entry in catalogue() {
        let examples = entry.example_values();
        for (i, parameter) in entry.parameters().iter().enumerate() {
            let (kind, range) = (parameter.kind(), parameter.range_given(&examples));
            let any = parameter.range();
            assert!(
                range == any || range.least >= any.least && range.most <= any.most,
                "{}.{}: {range} of {any}",
                entry.name(),
                parameter.name()
            );
            // A direction has no range, a map's numbers hang together.
            if matches!(kind, Kind::Direction) {
                continue;
            }
            let (within, outside) = ends(range, kind);
            for at in 0..numbers(&examples[i]).len() {
                let with = |number: f64| {
                    let mut values = examples.clone();
                    values[i] = with_number(&examples[i], at, number)?;
                    Some(fault(entry.make(&operands(entry), &values).expect("of the right kind")))
                };
                let at = format!("{}.{}[{at}]", entry.name(), parameter.name());
                if !limited.contains(&(entry.name(), parameter.name())) {
                    for number in within {
                        let error = with(number).flatten();
                        let clear = error.as_ref().is_none_or(|error| !names(error, parameter.name()));
                        assert!(clear, "{at} = {number} is in {range}: {error:?}");
                    }
                }
                for number in outside {
                    let Some(error) = with(number) else { continue };
                    // A map, or a row that is made of maps, is judged as a whole.
                    let of_matrix = matches!(entry.group(), Group::Affine) || parameter.name() == "step";
                    let told = error.as_ref().is_some_and(|error| of_matrix || names(error, parameter.name()));
                    assert!(told, "{at} = {number} is not in {range}: {error:?}");
                    probed += 1;
                }
            }
        }
    }
    assert!(probed > 200, "{probed}");
}

#[test]
fn ranges_follow_the_other_parameters() {
    let entry = |name: &str| catalogue().iter().find(|entry| entry.name() == name).expect("it is there");
    let range = |name: &str, at: usize, values: &[Value]| entry(name).parameters()[at].range_given(values);
    let number = Value::Number;
    let hyperboloid = |sheets: &'static str| {
        let axes = Value::Vector(DVec3::new(2.0, 2.0, 3.0));
        [axes, number(1.0), number(1.0), number(8.0), Value::Choice(sheets), Value::Choice("z")]
    };
    assert_eq!(range("superhyperboloid", 3, &hyperboloid("two")), Range::above(6.0, 6000.0));
    assert_eq!(range("superhyperboloid", 3, &hyperboloid("one")), Range::new(1e-9, 6000.0));
    assert_eq!(range("capsule", 1, &[number(2.0), number(9.0)]), Range::new(4.0, 1e9));
    let lattice = |surface: &'static str| [Value::Choice(surface), number(4.0), number(0.5)];
    assert_eq!(range("network_lattice", 2, &lattice("schwarz_p")), Range::new(0.25, 0.75));
    assert_eq!(range("network_lattice", 2, &lattice("gyroid")), Range::new(0.1, 0.9));
    assert_eq!(range("sheet_lattice", 2, &lattice("gyroid")), Range::new(4e-6, 1.0));
    assert_eq!(range("cone", 0, &[number(1.0), number(0.0), number(1.0)]), Range::LENGTH);
    // Values that are none of it say nothing.
    assert_eq!(range("torus", 1, &[]), Range::LENGTH);
}

#[test]
fn random_solids_are_rebuilt() {
    let mut random = Random::new(20_261);
    for case in 0..30 {
        let leaf = catalogue_leaf(&mut random);
        let moved = catalogue_map(&mut random, &leaf);
        let swept = random_profile(&mut random, 2).extrude(2.0);
        let joined = blended(&mut random, &moved, &swept);
        let solid =
            lengthened(&mut random, &joined).paint([10, 20, 30]).named("part").repeat([2, 1, 3], DVec3::splat(9.0));
        let part = Part::Solid(solid);
        assert_eq!(rebuilt(&part), part, "{case}");
    }
}

/// A leaf of a user's own.
#[derive(Debug)]
struct Half {
    below: f64,
}

impl Field for Half {
    fn name(&self) -> &'static str {
        "half"
    }

    fn eval<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
        -z + self.below
    }

    fn bounds(&self) -> Bounds {
        Bounds::ALL
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

/// A law of a user's own.
#[derive(Clone, Debug)]
struct Turning;

impl Law for Turning {
    fn at<R: Real>(&self, z: R) -> R {
        z * 0.5
    }
}

#[test]
fn what_is_a_users_own_is_told_apart() {
    let half = Solid::new(Half { below: 0.5 });
    let Form::Custom(leaf) = half.form() else { panic!("{:?}", half.form()) };
    assert_eq!((leaf.name(), leaf.values(), leaf.parameters().len()), ("half", None, 0));
    assert_eq!(leaf.get::<Half>().map(|half| half.below), Some(0.5));
    assert!(half.call().is_none());
    // A built-in leaf is one however it was made into a solid.
    assert!(matches!(Solid::new(rvachev::Sphere { radius: 1.0 }).form(), Form::Leaf(_)));

    let bar = Solid::cuboid([1.0, 1.0, 4.0]);
    let turned = bar.twist_by(rad(1.0), Turning);
    let Form::Deformation { deformation, .. } = turned.form() else { panic!() };
    assert_eq!((deformation.name(), deformation.values()), ("twist_by", None));
    // The same law, built in.
    let line = LinearLaw { at_zero: 0.0, slope: 0.5 };
    let twisted = bar.twist_by(rad(1.0), line);
    assert_eq!(twisted, bar.twist_by(rad(1.0), BuiltInLaw::Linear(line)));
    let Form::Deformation { deformation, .. } = twisted.form() else { panic!() };
    assert_eq!(deformation.values(), Some(vec![Value::Angle(rad(1.0)), Value::Law(BuiltInLaw::Linear(line))]));
    for i in 0..50 {
        let t = |k: f64| 3.0 * ((f64::from(i) * k).fract() - 0.5);
        let p = DVec3::new(t(0.618), t(0.414), t(0.732));
        assert_eq!(bar.twist_by(rad(1.0), Turning).value(p).unwrap(), twisted.value(p).unwrap());
    }
}

#[test]
fn verbs_show_what_was_said() {
    let outline = Profile::regular_polygon(5, 2.0);
    let extrusion = Extrusion { twist: rad(0.5), scale: 0.5, caps: Caps::Rounded(0.1), ..Extrusion::new(3.0) };
    let solid = outline.extrude_with(&extrusion);
    let Form::Extrude { profile, extrusion: told } = solid.form() else { panic!("{:?}", solid.form()) };
    assert_eq!((profile, told), (&outline, extrusion));
    let helix = Helix::new(5.0, 2.0, 3.0);
    let thread = outline.scale(0.1).sweep_helix(&helix);
    assert!(matches!(thread.form(), Form::SweepHelix { helix: told, .. } if told == helix));
    let ring = outline.translate([4.0, 0.0]).revolve();
    assert!(matches!(ring.form(), Form::Revolve { angle, .. } if angle == Angle::FULL_TURN));
    assert_eq!(ring, outline.translate([4.0, 0.0]).revolve_by(Angle::FULL_TURN));
    // A polygon's edges on the axis are no border, whatever is built for it.
    let cup = Profile::from(Polygon::new([[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]]));
    let whole = cup.revolve();
    let Form::Revolve { profile, .. } = whole.form() else { panic!() };
    assert_eq!(*profile, cup);
    assert!(matches!(outline.column().form(), Form::Column { .. }));
    assert_eq!(outline.column(), Profile::regular_polygon(5, 2.0).column());
    assert_ne!(outline.extrude(1.0), outline.extrude(2.0));

    let row = Solid::sphere(0.5).repeat_linear(7, [1.0, 2.0, 0.0]);
    let told = Repetition::Row { count: 7, step: DVec3::new(1.0, 2.0, 0.0) };
    assert!(matches!(row.form(), Form::Repetition { repetition, .. } if repetition == told));
    assert_eq!(row.to_string(), "repeat_linear 7 by DVec3(1.0, 2.0, 0.0)\n  sphere { radius: 0.5 }");
}

#[test]
fn affine_maps_are_told_by_their_verb_where_that_is_exact() {
    let bar = Solid::cuboid([1.0, 2.0, 3.0]);
    let told = |solid: Solid| {
        let call = solid.call().expect("all of it is built in");
        assert_eq!(call.make().unwrap(), Part::Solid(solid));
        call.entry.name()
    };
    assert_eq!(told(bar.translate([1.0, 2.0, 3.0])), "translate");
    assert_eq!(told(bar.scale(-2.0)), "scale");
    assert_eq!(told(bar.scale_axes([1.0, 2.0, 3.0])), "scale_axes");
    assert_eq!(told(bar.rotate_z(rad(0.25))), "rotate_z");
    assert_eq!(told(bar.reflect(DVec3::Y, 2.0)), "reflect");
    assert_eq!(told(bar.rotate(DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(0.1))), "affine");
    let profile = Profile::circle(1.0);
    for moved in [
        profile.rotate(rad(0.7)),
        profile.scale_axes([2.0, 0.1]),
        profile.reflect([0.6, 0.8], 0.5),
        profile.scale(-0.3),
    ] {
        let part = Part::Profile(moved);
        assert_eq!(rebuilt(&part), part);
    }
    assert_eq!(profile.translate(DVec2::X).call().expect("built in").entry.name(), "translate");
}

#[test]
fn simplified_verbs_keep_what_was_said_and_what_it_is() {
    let section = Profile::circle(1.0).translate([1.0, 0.0]).translate([3.0, 0.0]);
    let ball = Solid::sphere(0.5).translate([1.0, 0.0, 0.0]).translate([1.0, 0.0, 0.0]);
    let verbs = [
        section.extrude_with(&Extrusion { scale: 0.5, twist: rad(0.2), ..Extrusion::new(4.0) }),
        section.revolve(),
        section.revolve_by(rad(1.0)),
        section.sweep_helix(&Helix::new(6.0, 3.0, 1.5)),
        section.column() & Solid::sphere(6.0),
        ball.repeat([3, 2, 1], [2.0, 3.0, 0.0]),
        ball.repeat_linear(4, [1.0, 1.0, 0.5]),
        ball.repeat_polar(7),
    ];
    for solid in verbs {
        let simpler = solid.simplified();
        assert!(simpler.node_count() < solid.node_count(), "{solid}");
        let (Some(a), Some(b)) = (solid.call(), simpler.call()) else { panic!("{solid}") };
        assert_eq!((a.entry.name(), a.values), (b.entry.name(), b.values));
        for i in 0..100 {
            let t = |k: f64| 12.0 * ((f64::from(i) * k).fract() - 0.5);
            let p = DVec3::new(t(0.618), t(0.414), t(0.732));
            let (a, b) = (solid.value(p).unwrap(), simpler.value(p).unwrap());
            assert!((a - b).abs() < 1e-12, "{solid} at {p}: {a}, {b}");
        }
    }
}

#[test]
fn errors_name_the_verb_not_what_it_is_composed_of() {
    let text = |solid: Solid| solid.bounds().unwrap_err().to_string();
    assert!(text(Profile::circle(-1.0).extrude(2.0)).starts_with("extrude / circle: radius is -1"));
    assert!(text(Profile::circle(1.0).extrude(0.0)).starts_with("extrude: height is 0"));
    assert!(text(Profile::circle(2.0).sweep_helix(&Helix::new(1.0, 9.0, 1.0))).starts_with("sweep_helix: radius is 1"));
    let row = Solid::sphere(-1.0).named("ball").repeat([3, 1, 1], DVec3::X);
    assert!(text(row | Solid::sphere(1.0)).starts_with("union[0] / repeat / ball: sphere: radius is -1"));
    let blend =
        Solid::sphere(1.0).union_with(Profile::circle(1.0).revolve_by(deg(900.0)), Blend::Smooth { radius: 1.0 });
    assert!(text(blend).starts_with("smooth union[1] / revolve_by: angle is 900"));
    assert_eq!(RFunction::default(), RFunction::P(2.0));
}
