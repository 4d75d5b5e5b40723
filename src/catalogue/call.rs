//! A part as a call of a catalogue's entry.

use glam::{DAffine3, DVec2, DVec3};

use super::{Entry, Operands, Part, entry};
use crate::solid::Node;
use crate::{
    Angle, Blend, BuiltInLaw, Caps, Extrusion, Form, Operation, Profile, RFunction, Repetition, Solid, Value,
    ValueError, deg, rad,
};

/// An entry of the [catalogue](crate::catalogue()) with operands and values: what a part is made
/// by, at its root.
///
/// Whoever writes parts as text, or changes a parameter, works on calls and needs not know what
/// there is.
///
/// ```
/// use rvachev::catalogue::{Call, Value};
/// use rvachev::Solid;
///
/// let part = Solid::cylinder(1.0, 4.0).translate([0.0, 0.0, 2.0]);
/// let mut call = part.call().expect("all of it is built in");
/// assert_eq!((call.entry.name(), call.operands.len()), ("translate", 1));
/// assert_eq!(call.make()?.into_solid(), Some(part));
///
/// call.values = vec![Value::Vector([0.0, 0.0, 3.0].into())];
/// assert_eq!(call.make()?.into_solid(), Some(Solid::cylinder(1.0, 4.0).translate([0.0, 0.0, 3.0])));
/// # Ok::<(), rvachev::catalogue::ValueError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Call {
    /// What is called.
    pub entry: &'static Entry,
    /// Its operands, in order.
    pub operands: Vec<Part>,
    /// The values of its parameters, in order.
    pub values: Vec<Value>,
}

impl Call {
    /// The call that makes a part equal to this one; `None` of a user's own leaf, of what follows
    /// a user's own law, and of values that have no parameters.
    ///
    /// An affine map is told by the method that made it where that gives the same map to the last
    /// bit, else by its matrix.
    #[must_use]
    pub fn of(part: &Part) -> Option<Call> {
        match part {
            Part::Solid(solid) => of_graph(solid, |operand| operand.into()),
            Part::Profile(profile) => of_graph(&profile.0, |operand| Profile(operand.clone()).into()),
            Part::Value(value) => of_value(value),
        }
    }

    /// Makes the part.
    ///
    /// # Errors
    /// Operands or values that were changed to what the entry does not take.
    pub fn make(&self) -> Result<Part, ValueError> {
        self.entry.make(&self.operands, &self.values)
    }
}

impl Solid {
    /// The call that makes the solid, at its root; `None` of a user's own leaf and of what follows
    /// a user's own law. The operands have calls of their own.
    #[must_use]
    pub fn call(&self) -> Option<Call> {
        Call::of(&self.into())
    }
}

impl Profile {
    /// The call that makes the profile, at its root.
    ///
    /// ```
    /// use rvachev::catalogue::{Part, Value};
    /// use rvachev::Profile;
    ///
    /// let plate = Profile::circle(2.0).offset(0.5);
    /// let call = plate.call().expect("all of it is built in");
    /// assert_eq!((call.entry.name(), &call.values[..]), ("offset", &[Value::Number(0.5)][..]));
    /// assert_eq!(call.operands, [Part::Profile(Profile::circle(2.0))]);
    /// ```
    #[must_use]
    pub fn call(&self) -> Option<Call> {
        Call::of(&self.into())
    }
}

/// Operands that examples are made of.
pub(super) fn example_operands(operands: Operands) -> Vec<Part> {
    let solids = || [Solid::sphere(1.0), Solid::sphere(1.25).translate(DVec3::X)];
    match operands {
        Operands::None => Vec::new(),
        Operands::Solid | Operands::Either => vec![Solid::cuboid([1.0, 1.5, 2.0]).into()],
        Operands::Length => vec![Solid::cuboid([1.0, 1.5, 2.0]).offset(0.25).into()],
        Operands::Two | Operands::Many => solids().map(Part::from).to_vec(),
        Operands::Profile => vec![Profile::rectangle([2.0, 1.0]).translate([2.0, 0.0]).into()],
    }
}

/// The call that makes a solid, or a profile, whose operands `part` makes parts of.
fn of_graph(solid: &Solid, part: impl Fn(&Solid) -> Part) -> Option<Call> {
    let form = solid.form();
    let call = |name: &str, values: Vec<Value>| {
        let operands = match form {
            Form::Extrude { profile, .. }
            | Form::Revolve { profile, .. }
            | Form::SweepHelix { profile, .. }
            | Form::Column { profile } => vec![profile.into()],
            _ => form.operands().iter().map(&part).collect(),
        };
        entry(name).map(|entry| Call { entry, operands, values })
    };
    match form {
        Form::Custom(_) => None,
        Form::Leaf(leaf) => {
            let is_profile = matches!(part(solid), Part::Profile(_));
            let name = if is_profile && !leaf.is_plane() { "profile_formula" } else { leaf.name() };
            call(name, leaf.values()?)
        }
        Form::Affine { map, verb, .. } => {
            let same =
                |call: &Call| matches!(call.make(), Ok(made) if map_of(&made).is_some_and(|m| is_same(&m, &map)));
            let guesses = guesses(verb, &map).into_iter();
            let found = guesses.filter_map(|(name, values)| call(name, values)).find(same);
            found.or_else(|| call("affine", vec![Value::Map(map)]))
        }
        Form::Deformation { deformation, .. } => call(deformation.name(), deformation.values()?),
        Form::Repetition { repetition, .. } => call(
            repetition.name(),
            match repetition {
                Repetition::Grid { counts, spacing } => vec![Value::Counts(counts), Value::Vector(spacing)],
                Repetition::Row { count, step } => vec![Value::Count(count), Value::Vector(step)],
                Repetition::Ring { count } => vec![Value::Count(count)],
            },
        ),
        Form::Join { operation, function, .. } => {
            let name = match operation {
                Operation::Union => "union",
                Operation::Intersection => "intersection",
                Operation::Difference => "difference",
                Operation::SymmetricDifference => "symmetric_difference",
            };
            call(name, vec![Value::Function(function)])
        }
        Form::Blend { operation, blend, .. } => {
            let name = match operation {
                Operation::Union => "union_with",
                Operation::Intersection => "intersection_with",
                Operation::Difference => "difference_with",
                // There is no such blend.
                Operation::SymmetricDifference => return None,
            };
            call(name, vec![Value::Blend(blend)])
        }
        Form::Complement { .. } => call("complement", Vec::new()),
        Form::Length { length, .. } => call(length.name(), vec![Value::Number(length.amount())]),
        Form::Tolerance { tolerance, .. } => call("with_tolerance", vec![Value::Number(tolerance)]),
        Form::Paint { paint, .. } => call("paint", vec![Value::Color(paint.color), Value::Number(paint.roughness)]),
        Form::Name { name, .. } => call("named", vec![Value::Text(name.to_string())]),
        // Equal is what is written alike: a twist of −0 is none of 0.
        Form::Extrude { extrusion: e, .. } if format!("{e:?}") == format!("{:?}", Extrusion::new(e.height)) => {
            call("extrude", vec![Value::Number(e.height)])
        }
        Form::Extrude { extrusion: e, .. } => call(
            "extrude_with",
            vec![Value::Number(e.height), Value::Angle(e.twist), Value::Number(e.scale), Value::Caps(e.caps)],
        ),
        Form::Revolve { angle: Angle::FULL_TURN, .. } => call("revolve", Vec::new()),
        Form::Revolve { angle, .. } => call("revolve_by", vec![Value::Angle(angle)]),
        Form::SweepHelix { helix: h, .. } => call(
            "sweep_helix",
            vec![
                Value::Number(h.radius),
                Value::Number(h.pitch),
                Value::Number(h.turns),
                Value::Switch(h.left_handed),
                Value::Caps(h.ends),
            ],
        ),
        Form::Column { .. } => call("column", Vec::new()),
    }
}

/// The call that makes a value.
fn of_value(value: &Value) -> Option<Call> {
    let number = |v: f64| vec![Value::Number(v)];
    let plane = |point: (f64, f64)| Value::PlaneVector(point.into());
    let (name, values) = match value {
        Value::Curve(curve) => {
            let values = rvachev_field::catalogue::Parameters::values(curve);
            ("gielis", values)
        }
        Value::Function(function) => match *function {
            RFunction::MIN_MAX => ("min_max", Vec::new()),
            RFunction::Alpha(alpha) => ("alpha", number(alpha)),
            RFunction::Zero { m } => ("zero", vec![Value::Count(m)]),
            RFunction::P(p) => ("p", number(p)),
            RFunction::Associative(p) => ("associative", number(p)),
            RFunction::Distance => ("distance", Vec::new()),
            _ => return None,
        },
        Value::Blend(blend) => match *blend {
            Blend::Smooth { radius } => ("smooth", number(radius)),
            Blend::Fillet { radius } => ("fillet", number(radius)),
            Blend::Chamfer { leg } => ("chamfer", number(leg)),
            Blend::Displacement { height, falloff } => {
                ("displacement", vec![Value::Number(height), Value::PlaneVector(falloff.into())])
            }
            Blend::Ricci { p } => ("ricci", number(p)),
            _ => return None,
        },
        Value::Law(law) => match law {
            BuiltInLaw::Constant(value) => ("constant", number(*value)),
            BuiltInLaw::Linear(law) => ("linear", vec![Value::Number(law.at_zero), Value::Number(law.slope)]),
            BuiltInLaw::SmoothStep(law) => ("smooth_step", vec![plane(law.from), plane(law.to)]),
            BuiltInLaw::Wave(law) => {
                let [mean, amplitude, wavelength] = [law.mean, law.amplitude, law.wavelength].map(Value::Number);
                ("wave", vec![mean, amplitude, wavelength, Value::Angle(law.phase)])
            }
            BuiltInLaw::Table(law) => {
                ("table", vec![Value::Points(law.points().iter().copied().map(DVec2::from).collect())])
            }
            _ => return None,
        },
        Value::Caps(caps) => match *caps {
            Caps::Flat => ("flat_caps", Vec::new()),
            Caps::Chamfered(leg) => ("chamfered_caps", number(leg)),
            Caps::Rounded(radius) => ("rounded_caps", number(radius)),
            _ => return None,
        },
        _ => return None,
    };
    entry(name).map(|entry| Call { entry, operands: Vec::new(), values })
}

/// The map at the root of a part.
fn map_of(part: &Part) -> Option<DAffine3> {
    let (Part::Solid(solid) | Part::Profile(Profile(solid))) = part else { return None };
    match solid.node() {
        Node::Affine { forward, .. } => Some(*forward),
        _ => None,
    }
}

/// Whether two maps are the same to the last bit.
fn is_same(a: &DAffine3, b: &DAffine3) -> bool {
    a.to_cols_array().map(f64::to_bits) == b.to_cols_array().map(f64::to_bits)
}

/// What the method of this name may have been given.
fn guesses(verb: &str, map: &DAffine3) -> Vec<(&'static str, Vec<Value>)> {
    let m = &map.matrix3;
    let diagonal = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
    let turned = |name, sin: f64, cos: f64| -> Vec<(&'static str, Vec<Value>)> {
        angles(sin, cos).into_iter().map(|angle| (name, vec![Value::Angle(angle)])).collect()
    };
    match verb {
        "translate" => vec![("translate", vec![Value::Vector(map.translation)])],
        "rotate_x" => turned("rotate_x", m.y_axis.z, m.y_axis.y),
        "rotate_y" => turned("rotate_y", m.z_axis.x, m.z_axis.z),
        "rotate_z" => turned("rotate_z", m.x_axis.y, m.x_axis.x),
        // Of the plane, or about any axis.
        "rotate" | "rotate_about" => {
            let mut all = turned("rotate_z", m.x_axis.y, m.x_axis.x);
            let twice = DVec3::new(m.y_axis.z - m.z_axis.y, m.z_axis.x - m.x_axis.z, m.x_axis.y - m.y_axis.x);
            let axis = twice / twice.abs().max_element();
            let angles = angles(twice.length(), diagonal.element_sum() - 1.0);
            for axis in [(axis * 1e9).round() * 1e-9, axis, axis.normalize()] {
                let about = |angle: &Angle| ("rotate_about", vec![Value::Vector(axis), Value::Angle(*angle)]);
                all.extend(angles.iter().map(about));
            }
            all
        }
        "scale" => vec![("scale", vec![Value::Number(diagonal.x)])],
        "scale_axes" => vec![("scale_axes", vec![Value::Vector(diagonal)])],
        "reflect" => {
            let across = (0..3).filter(|&axis| diagonal[axis] < 0.0);
            let planes = across.map(|axis| {
                let offset = 0.5 * map.translation[axis];
                ("reflect", vec![Value::Vector(DVec3::AXES[axis]), Value::Number(offset)])
            });
            planes.collect()
        }
        _ => Vec::new(),
    }
}

/// What an angle of this sine and cosine may have been: as it is, as many degrees as it was meant
/// to be, and its neighbours.
fn angles(sin: f64, cos: f64) -> Vec<Angle> {
    let angle = sin.atan2(cos);
    let degrees = deg((angle.to_degrees() * 1e9).round() / 1e9);
    let quarters = deg((angle.to_degrees() / 90.0).round() * 90.0);
    let near = [angle, angle.next_up(), angle.next_down(), angle.next_up().next_up(), angle.next_down().next_down()];
    [quarters, degrees].into_iter().chain(near.map(rad)).collect()
}
