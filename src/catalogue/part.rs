//! What the catalogue makes, and makes it of.

use rvachev_field::catalogue::ValueError;

use super::Operands;
use crate::{Profile, Solid, Value};

/// A solid, a profile, or a value that parameters take.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Part {
    /// A solid.
    Solid(Solid),
    /// A profile.
    Profile(Profile),
    /// A curve, law, R-function, blend or caps.
    Value(Value),
}

impl Part {
    /// The solid, if it is one.
    #[must_use]
    pub fn into_solid(self) -> Option<Solid> {
        match self {
            Part::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// The profile, if it is one.
    #[must_use]
    pub fn into_profile(self) -> Option<Profile> {
        match self {
            Part::Profile(profile) => Some(profile),
            _ => None,
        }
    }

    /// The value, if it is one.
    #[must_use]
    pub fn into_value(self) -> Option<Value> {
        match self {
            Part::Value(value) => Some(value),
            _ => None,
        }
    }

    /// What sort of part it is.
    fn sort(&self) -> &'static str {
        match self {
            Part::Solid(_) => "a solid",
            Part::Profile(_) => "a profile",
            Part::Value(_) => "a value",
        }
    }
}

impl From<Solid> for Part {
    fn from(solid: Solid) -> Part {
        Part::Solid(solid)
    }
}

impl From<&Solid> for Part {
    fn from(solid: &Solid) -> Part {
        Part::Solid(solid.clone())
    }
}

impl From<Profile> for Part {
    fn from(profile: Profile) -> Part {
        Part::Profile(profile)
    }
}

impl From<&Profile> for Part {
    fn from(profile: &Profile) -> Part {
        Part::Profile(profile.clone())
    }
}

impl From<Value> for Part {
    fn from(value: Value) -> Part {
        Part::Value(value)
    }
}

/// Operands of a verb, taken from parts.
pub(super) trait Take: Sized {
    /// What is taken.
    const OPERANDS: Operands;

    /// The operands, if the parts are such.
    fn of(parts: &[Part]) -> Option<Self>;

    /// The operands of `entry`.
    fn take(entry: &'static str, parts: &[Part]) -> Result<Self, ValueError> {
        Self::of(parts).ok_or_else(|| {
            let found: Vec<&str> = parts.iter().map(Part::sort).collect();
            let found = if found.is_empty() { "nothing".to_string() } else { found.join(", ") };
            ValueError::Operands { entry, expected: Self::OPERANDS.words(), found }
        })
    }
}

/// A solid or a profile.
pub(super) enum Either {
    Solid(Solid),
    Profile(Profile),
}

impl Either {
    /// What becomes of the one or the other.
    pub(super) fn map(self, solid: impl FnOnce(Solid) -> Solid, profile: impl FnOnce(Profile) -> Profile) -> Part {
        match self {
            Either::Solid(operand) => solid(operand).into(),
            Either::Profile(operand) => profile(operand).into(),
        }
    }
}

/// A solid or a profile that is a length or a blend: what it is made of is seen when it is first
/// used.
pub(super) struct Toleranced(pub(super) Either);

/// Solids or profiles, any number.
pub(super) enum Many {
    Solids(Vec<Solid>),
    Profiles(Vec<Profile>),
}

impl Take for () {
    const OPERANDS: Operands = Operands::None;

    fn of(parts: &[Part]) -> Option<()> {
        parts.is_empty().then_some(())
    }
}

impl Take for Solid {
    const OPERANDS: Operands = Operands::Solid;

    fn of(parts: &[Part]) -> Option<Solid> {
        match parts {
            [Part::Solid(solid)] => Some(solid.clone()),
            _ => None,
        }
    }
}

impl Take for Profile {
    const OPERANDS: Operands = Operands::Profile;

    fn of(parts: &[Part]) -> Option<Profile> {
        match parts {
            [Part::Profile(profile)] => Some(profile.clone()),
            _ => None,
        }
    }
}

impl Take for Either {
    const OPERANDS: Operands = Operands::Either;

    fn of(parts: &[Part]) -> Option<Either> {
        match parts {
            [Part::Solid(solid)] => Some(Either::Solid(solid.clone())),
            [Part::Profile(profile)] => Some(Either::Profile(profile.clone())),
            _ => None,
        }
    }
}

impl Take for Toleranced {
    const OPERANDS: Operands = Operands::Length;

    fn of(parts: &[Part]) -> Option<Toleranced> {
        Either::of(parts).map(Toleranced)
    }
}

impl Take for [Either; 2] {
    const OPERANDS: Operands = Operands::Two;

    fn of(parts: &[Part]) -> Option<[Either; 2]> {
        match parts {
            [Part::Solid(a), Part::Solid(b)] => Some([a, b].map(|solid| Either::Solid(solid.clone()))),
            [Part::Profile(a), Part::Profile(b)] => Some([a, b].map(|profile| Either::Profile(profile.clone()))),
            _ => None,
        }
    }
}

impl Take for Many {
    const OPERANDS: Operands = Operands::Many;

    fn of(parts: &[Part]) -> Option<Many> {
        if let [Part::Profile(_), ..] = parts {
            return parts.iter().cloned().map(Part::into_profile).collect::<Option<_>>().map(Many::Profiles);
        }
        parts.iter().cloned().map(Part::into_solid).collect::<Option<_>>().map(Many::Solids)
    }
}
