//! The graph of a solid as others may read it.

use std::any::Any;
use std::fmt;

use glam::DAffine3;

use super::composed::{Repetition, Sweep};
use super::{Extrusion, Helix, Length, Node, Operation, Paint, Profile, Solid};
use crate::{Angle, Blend, Parameter, RFunction, Value};
use rvachev_field::catalogue::{BuiltIn, DEFORMATIONS, LAW_DEFORMATIONS, PLANE_LEAVES, leaves};
use rvachev_field::{AnyField, AnyWarp};

/// What a solid is, at its root: a leaf with its parameters, or an operation and its operands.
/// Made by [`Solid::form`].
///
/// Lengths are in length units.
///
/// ```
/// use rvachev::form::Form;
/// use rvachev::{Solid, Sphere};
///
/// /// The radii of all spheres of a solid.
/// fn radii(solid: &Solid) -> Vec<f64> {
///     match solid.form() {
///         Form::Leaf(leaf) => leaf.get::<Sphere>().iter().map(|ball| ball.radius).collect(),
///         form => form.operands().iter().flat_map(radii).collect(),
///     }
/// }
///
/// let pair = Solid::sphere(1.0) | Solid::sphere(2.0).translate([3.0, 0.0, 0.0]);
/// assert_eq!(radii(&pair), [1.0, 2.0]);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Form<'a> {
    /// A leaf that is built in.
    Leaf(LeafForm<'a>),
    /// A leaf of a user's own.
    Custom(LeafForm<'a>),
    /// The operand moved by an affine map.
    Affine {
        /// What is moved.
        operand: &'a Solid,
        /// From the operand to the solid.
        map: DAffine3,
        /// The method that made the map.
        verb: &'static str,
    },
    /// The operand deformed.
    Deformation {
        /// What is deformed.
        operand: &'a Solid,
        /// How.
        deformation: DeformationForm<'a>,
    },
    /// Copies of the operand.
    Repetition {
        /// The first copy.
        operand: &'a Solid,
        /// Where the others are.
        repetition: Repetition,
    },
    /// Operands joined by an R-function.
    Join {
        /// The set operation.
        operation: Operation,
        /// What combines the values.
        function: RFunction,
        /// What is joined: any number.
        operands: &'a [Solid],
    },
    /// Operands joined with the transitions between them shaped: any number for a fillet, else two.
    Blend {
        /// The set operation.
        operation: Operation,
        /// The transition.
        blend: Blend,
        /// What is joined.
        operands: &'a [Solid],
    },
    /// Everything outside the operand.
    Complement {
        /// What is left out.
        operand: &'a Solid,
    },
    /// The operand moved in or out.
    Length {
        /// What is moved.
        operand: &'a Solid,
        /// How, and how far.
        length: Length,
    },
    /// A length or a blend, measured to a tolerance.
    Tolerance {
        /// What is measured.
        operand: &'a Solid,
        /// How far it may be off.
        tolerance: f64,
    },
    /// The operand painted.
    Paint {
        /// What is painted.
        operand: &'a Solid,
        /// What it looks like.
        paint: Paint,
    },
    /// The operand named.
    Name {
        /// What is named.
        operand: &'a Solid,
        /// The name.
        name: &'a str,
    },
    /// A profile extruded.
    Extrude {
        /// The section at the lower end.
        profile: &'a Profile,
        /// Height, twist, scale and caps.
        extrusion: Extrusion,
    },
    /// A profile revolved about the z axis.
    Revolve {
        /// The section.
        profile: &'a Profile,
        /// By how much; [`Angle::FULL_TURN`] all the way round.
        angle: Angle,
    },
    /// A profile swept along a helix.
    SweepHelix {
        /// The section.
        profile: &'a Profile,
        /// The helix.
        helix: Helix,
    },
    /// The unbounded column over a profile.
    Column {
        /// The section.
        profile: &'a Profile,
    },
}

impl<'a> Form<'a> {
    /// The operands, in order; of what is made of a profile, the profile's
    /// [column](Profile::column).
    ///
    /// ```
    /// use rvachev::{Profile, Solid};
    ///
    /// let part = Solid::sphere(1.0) - Solid::cylinder(0.5, 3.0);
    /// assert_eq!(part.form().operands().len(), 2);
    /// assert_eq!(Profile::circle(1.0).extrude(2.0).form().operands().len(), 1);
    /// ```
    #[must_use]
    pub fn operands(&self) -> &'a [Solid] {
        match self {
            Form::Leaf(_) | Form::Custom(_) => &[],
            Form::Affine { operand, .. }
            | Form::Deformation { operand, .. }
            | Form::Repetition { operand, .. }
            | Form::Complement { operand }
            | Form::Length { operand, .. }
            | Form::Tolerance { operand, .. }
            | Form::Paint { operand, .. }
            | Form::Name { operand, .. } => std::slice::from_ref(*operand),
            Form::Join { operands, .. } | Form::Blend { operands, .. } => operands,
            Form::Extrude { profile, .. }
            | Form::Revolve { profile, .. }
            | Form::SweepHelix { profile, .. }
            | Form::Column { profile } => std::slice::from_ref(&profile.0),
        }
    }
}

/// A leaf: its name, its parameters, and itself to whoever knows its type.
#[derive(Clone, Copy)]
pub struct LeafForm<'a> {
    field: &'a dyn AnyField,
    built_in: Option<&'static BuiltIn<dyn AnyField>>,
    is_plane: bool,
}

impl<'a> LeafForm<'a> {
    fn new(field: &'a dyn AnyField) -> LeafForm<'a> {
        let any: &dyn Any = field;
        let is_this = |leaf: &&BuiltIn<dyn AnyField>| (leaf.values)(any).is_some();
        let in_space = leaves().find(is_this);
        let built_in = in_space.or_else(|| PLANE_LEAVES.iter().find(is_this));
        LeafForm { field, built_in, is_plane: in_space.is_none() && built_in.is_some() }
    }

    /// The name in the [catalogue](crate::catalogue()); of a user's own leaf what it calls
    /// itself.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.built_in.map_or_else(|| self.field.name(), |leaf| leaf.name)
    }

    /// The parameters; none of a user's own leaf.
    #[must_use]
    pub fn parameters(&self) -> &'static [Parameter] {
        self.built_in.map_or(&[], |leaf| (leaf.schema)())
    }

    /// The values of the parameters, in order; `None` of a user's own leaf.
    #[must_use]
    pub fn values(&self) -> Option<Vec<Value>> {
        self.built_in.and_then(|leaf| (leaf.values)(self.field))
    }

    /// Whether it is a shape of the plane, which profiles are made of.
    #[must_use]
    pub fn is_plane(&self) -> bool {
        self.is_plane
    }

    /// The leaf, if it is of this type.
    ///
    /// ```
    /// use rvachev::form::Form;
    /// use rvachev::{Cuboid, Solid, Sphere};
    ///
    /// let brick = Solid::cuboid([4.0, 2.0, 1.0]);
    /// let Form::Leaf(leaf) = brick.form() else { unreachable!("a box is a leaf") };
    /// assert_eq!(leaf.get::<Cuboid>().map(|cuboid| cuboid.size.x), Some(4.0));
    /// assert_eq!(leaf.get::<Sphere>(), None);
    /// ```
    #[must_use]
    pub fn get<T: 'static>(&self) -> Option<&'a T> {
        let any: &'a dyn Any = self.field;
        any.downcast_ref()
    }
}

impl fmt::Debug for LeafForm<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.field.fmt(f)
    }
}

/// A deformation: its name and its parameters.
#[derive(Clone, Copy)]
pub struct DeformationForm<'a> {
    warp: &'a dyn AnyWarp,
    built_in: Option<&'static BuiltIn<dyn AnyWarp>>,
}

impl<'a> DeformationForm<'a> {
    fn new(warp: &'a dyn AnyWarp) -> DeformationForm<'a> {
        let any: &dyn Any = warp;
        let built_in = DEFORMATIONS.iter().chain(LAW_DEFORMATIONS).find(|warp| (warp.values)(any).is_some());
        DeformationForm { warp, built_in }
    }

    /// The name in the [catalogue](crate::catalogue()): the method that makes it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.warp.name()
    }

    /// The parameters; none of what follows a user's own law.
    #[must_use]
    pub fn parameters(&self) -> &'static [Parameter] {
        self.built_in.map_or(&[], |warp| (warp.schema)())
    }

    /// The values of the parameters, in order; `None` of what follows a user's own law.
    ///
    /// ```
    /// use rvachev::catalogue::Value;
    /// use rvachev::form::Form;
    /// use rvachev::{Solid, rad};
    ///
    /// let bar = Solid::cuboid([2.0, 2.0, 8.0]).twist(rad(0.25));
    /// let Form::Deformation { deformation, .. } = bar.form() else { unreachable!("it is twisted") };
    /// assert_eq!(deformation.values(), Some(vec![Value::Angle(rad(0.25))]));
    /// ```
    #[must_use]
    pub fn values(&self) -> Option<Vec<Value>> {
        self.built_in.and_then(|warp| (warp.values)(self.warp))
    }
}

impl fmt::Debug for DeformationForm<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.warp.fmt(f)
    }
}

impl Solid {
    /// What the solid is, at its root. Operands have forms of their own; a chain of operations
    /// may be deep, so walk long ones by a loop.
    ///
    /// ```
    /// use rvachev::form::Form;
    /// use rvachev::{Profile, RFunction, Solid};
    ///
    /// let beam = Profile::rectangle([4.0, 2.0]).extrude(10.0);
    /// assert!(matches!(beam.form(), Form::Extrude { extrusion, .. } if extrusion.height == 10.0));
    /// let cut = beam - Solid::sphere(1.0);
    /// assert!(matches!(cut.form(), Form::Join { function: RFunction::P(2.0), .. }));
    /// ```
    #[must_use]
    pub fn form(&self) -> Form<'_> {
        match self.node() {
            Node::Leaf(field) => {
                let leaf = LeafForm::new(&**field);
                if leaf.built_in.is_some() { Form::Leaf(leaf) } else { Form::Custom(leaf) }
            }
            Node::Affine { operand, forward, label } => Form::Affine { operand, map: *forward, verb: label },
            Node::Warp { operand, warp } => Form::Deformation { operand, deformation: DeformationForm::new(&**warp) },
            Node::Join { operation, rule, operands } => Form::Join { operation: *operation, function: *rule, operands },
            Node::Complement(operand) => Form::Complement { operand },
            Node::Named { operand, name } => Form::Name { operand, name },
            Node::Painted { operand, paint } => Form::Paint { operand, paint: *paint },
            Node::Blend { operation, blend, operands, .. } => {
                Form::Blend { operation: *operation, blend: *blend, operands }
            }
            // Within what a sweep makes of a profile.
            Node::Rim { operands, .. } => {
                Form::Join { operation: Operation::Intersection, function: RFunction::Distance, operands }
            }
            Node::Length { operand, length, .. } => Form::Length { operand, length: *length },
            Node::Toleranced { operand, tolerance, .. } => Form::Tolerance { operand, tolerance: *tolerance },
            Node::Repeated { operand, repetition, .. } => Form::Repetition { operand, repetition: *repetition },
            Node::Swept { profile, sweep, .. } => match *sweep {
                Sweep::Extrude(extrusion) => Form::Extrude { profile, extrusion },
                Sweep::Revolve(angle) => Form::Revolve { profile, angle },
                Sweep::Helix(helix) => Form::SweepHelix { profile, helix },
                Sweep::Column => Form::Column { profile },
            },
        }
    }
}

impl Profile {
    /// What the profile is, at its root: a plane leaf, a formula, an affine map, a join, a
    /// complement or an offset. Operands of the form are [columns](Profile::column) over
    /// profiles, without saying so.
    ///
    /// ```
    /// use rvachev::catalogue::Value;
    /// use rvachev::form::Form;
    /// use rvachev::Profile;
    ///
    /// let disc = Profile::circle(2.0);
    /// let Form::Leaf(leaf) = disc.form() else { unreachable!("a circle is a leaf") };
    /// assert_eq!((leaf.name(), leaf.values()), ("circle", Some(vec![Value::Number(2.0)])));
    /// ```
    #[must_use]
    pub fn form(&self) -> Form<'_> {
        self.0.form()
    }
}
