//! An entry of the catalogue.

use std::fmt;
use std::sync::Arc;

use rvachev_field::catalogue::{BuiltIn, Curve, ValueError};
use rvachev_field::{AnyField, AnyWarp};

use super::part::{Either, Take};
use super::verb::Verb;
use super::{Part, call};
use crate::solid::Node;
use crate::{Parameter, Profile, Solid, Value};

/// What sort of thing an entry makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Group {
    /// A leaf in space.
    Leaf,
    /// A shape of the plane.
    Profile,
    /// A solid made of a profile.
    Sweep,
    /// A set operation by an R-function, or a complement.
    Join,
    /// A set operation with the transition shaped.
    BlendedJoin,
    /// A level, an offset, a shell, a rounding.
    Length,
    /// An affine map.
    Affine,
    /// A map that is not affine.
    Deformation,
    /// Copies.
    Repetition,
    /// A name or a paint.
    Attribute,
    /// A value: a plane curve.
    Curve,
    /// A value: a law of z.
    Law,
    /// A value: an R-function.
    Function,
    /// A value: a blend.
    Blend,
    /// A value: how the edges of end faces are.
    Caps,
}

/// Which operands an entry takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Operands {
    /// None.
    None,
    /// A solid.
    Solid,
    /// A profile.
    Profile,
    /// A solid or a profile.
    Either,
    /// A solid or a profile that is a length or a blend by fillet or chamfer.
    Length,
    /// Two solids, or two profiles.
    Two,
    /// Any number of solids, or of profiles.
    Many,
}

impl Operands {
    /// In words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Operands::None => "no operands",
            Operands::Solid => "a solid",
            Operands::Profile => "a profile",
            Operands::Either => "a solid or a profile",
            Operands::Length => "a length or a blend, a solid or a profile",
            Operands::Two => "two solids or two profiles",
            Operands::Many => "solids or profiles",
        }
    }
}

/// What makes the part.
#[derive(Clone, Copy)]
enum Maker {
    Leaf(&'static BuiltIn<dyn AnyField>),
    Plane(&'static BuiltIn<dyn AnyField>),
    Deformation(&'static BuiltIn<dyn AnyWarp>),
    Curve(&'static Curve),
    Verb(&'static Verb),
}

/// An entry of the [catalogue](crate::catalogue()): its name, parameters and docs, and how it is
/// made.
///
/// ```
/// use rvachev::catalogue::Group;
/// use rvachev::catalogue;
///
/// for entry in catalogue().iter().filter(|entry| entry.group() == Group::Leaf) {
///     let solid = entry.example().into_solid().expect("leaves are solids");
///     assert!(solid.surface_program().is_ok(), "{}", entry.name());
/// }
/// ```
#[derive(Clone, Copy)]
pub struct Entry {
    group: Group,
    operands: Operands,
    maker: Maker,
}

impl Entry {
    pub(super) fn leaf(leaf: &'static BuiltIn<dyn AnyField>) -> Entry {
        Entry { group: Group::Leaf, operands: Operands::None, maker: Maker::Leaf(leaf) }
    }

    pub(super) fn plane_leaf(leaf: &'static BuiltIn<dyn AnyField>) -> Entry {
        Entry { group: Group::Profile, operands: Operands::None, maker: Maker::Plane(leaf) }
    }

    pub(super) fn deformation(warp: &'static BuiltIn<dyn AnyWarp>) -> Entry {
        // The only one that leaves a column a column.
        let operands = if warp.name == "elongate" { Operands::Either } else { Operands::Solid };
        Entry { group: Group::Deformation, operands, maker: Maker::Deformation(warp) }
    }

    pub(super) fn curve(curve: &'static Curve) -> Entry {
        Entry { group: Group::Curve, operands: Operands::None, maker: Maker::Curve(curve) }
    }

    pub(super) fn verb(verb: &'static Verb) -> Entry {
        Entry { group: verb.group, operands: verb.operands, maker: Maker::Verb(verb) }
    }

    /// What sort of thing it makes.
    #[must_use]
    pub fn group(&self) -> Group {
        self.group
    }

    /// The name, as Rust's methods spell it; of values that of the variant or type, in lower
    /// case.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.maker {
            Maker::Leaf(leaf) | Maker::Plane(leaf) => leaf.name,
            Maker::Deformation(warp) => warp.name,
            Maker::Curve(curve) => curve.name,
            Maker::Verb(verb) => verb.name,
        }
    }

    /// What it makes, in a line.
    #[must_use]
    pub fn doc(&self) -> &'static str {
        let doc = match self.maker {
            Maker::Leaf(leaf) | Maker::Plane(leaf) => leaf.doc,
            Maker::Deformation(warp) => warp.doc,
            Maker::Curve(curve) => curve.doc,
            Maker::Verb(verb) => verb.doc,
        };
        doc.trim()
    }

    /// Which operands it takes.
    #[must_use]
    pub fn operands(&self) -> Operands {
        self.operands
    }

    /// Its parameters, in order.
    #[must_use]
    pub fn parameters(&self) -> &'static [Parameter] {
        match self.maker {
            Maker::Leaf(leaf) | Maker::Plane(leaf) => (leaf.schema)(),
            Maker::Deformation(warp) => (warp.schema)(),
            Maker::Curve(curve) => (curve.schema)(),
            Maker::Verb(verb) => verb.parameters,
        }
    }

    /// Makes it of operands and values, each in order. Ranges are not checked here: as ever, they
    /// are when the solid is first used.
    ///
    /// # Errors
    /// Too few operands or values, too many, or some of another sort; a text that is no formula.
    pub fn make(&self, operands: &[Part], values: &[Value]) -> Result<Part, ValueError> {
        if self.operands == Operands::None && !operands.is_empty() {
            let (entry, expected) = (self.name(), self.operands.words());
            return Err(ValueError::Operands { entry, expected, found: format!("{} operands", operands.len()) });
        }
        Ok(match self.maker {
            Maker::Leaf(leaf) => Solid::from_node(Node::Leaf((leaf.make)(values)?)).into(),
            Maker::Plane(leaf) => Profile(Solid::from_node(Node::Leaf((leaf.make)(values)?))).into(),
            Maker::Deformation(warp) => {
                let operand = match self.operands {
                    Operands::Either => Either::take(warp.name, operands)?,
                    _ => Either::Solid(Solid::take(warp.name, operands)?),
                };
                let warp = (warp.make)(values)?;
                let profile = Arc::clone(&warp);
                operand.map(|solid| solid.warped(warp), |Profile(column)| Profile(column.warped(profile)))
            }
            Maker::Curve(curve) => Value::Curve((curve.make)(values)?).into(),
            Maker::Verb(verb) => (verb.make)(operands, values)?,
        })
    }

    /// The examples of its parameters.
    #[must_use]
    pub fn example_values(&self) -> Vec<Value> {
        self.parameters().iter().map(Parameter::example).collect()
    }

    /// An example, of examples of its parameters and, where it takes operands, of simple ones.
    #[must_use]
    pub fn example(&self) -> Part {
        let made = self.make(&call::example_operands(self.operands), &self.example_values());
        made.unwrap_or_else(|error| unreachable!("examples are of the kinds that are asked for: {error}"))
    }
}

impl fmt::Debug for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Entry({})", self.name())
    }
}
