//! Types that parameters have, to and from [`Value`].

use glam::{DAffine3, DVec2, DVec3};

use super::{Kind, Value};
use crate::{Angle, Blend, Bounds, BuiltInLaw, Caps, Gielis, MinimalSurface, RFunction, Radius, Turns};

/// A type of a parameter.
pub trait Slot: Sized {
    /// What its values are.
    const KIND: Kind;

    /// As a value.
    fn into_value(self) -> Value;

    /// From a value, if it is of this kind.
    fn of_value(value: &Value) -> Option<Self>;
}

/// A vector whose length does not matter.
pub struct Direction(pub DVec3);

macro_rules! slot {
    ($type:ty, $kind:ident, |$this:pat_param| $into:expr, $($from:pat => $made:expr),+ $(,)?) => {
        impl Slot for $type {
            const KIND: Kind = Kind::$kind;

            fn into_value(self) -> Value {
                let $this = self;
                $into
            }

            fn of_value(value: &Value) -> Option<Self> {
                match value {
                    $($from => Some($made),)+
                    _ => None,
                }
            }
        }
    };
}

// A whole number is a number, and a number may be whole.
slot!(f64, Number, |v| Value::Number(v), Value::Number(v) => *v, Value::Count(n) => f64::from(*n));
slot!(Angle, Angle, |v| Value::Angle(v), Value::Angle(v) => *v);
slot!(bool, Switch, |v| Value::Switch(v), Value::Switch(v) => *v);
slot!(DVec3, Vector, |v| Value::Vector(v), Value::Vector(v) => *v);
slot!(Direction, Direction, |Direction(v)| Value::Vector(v), Value::Vector(v) => Direction(*v));
slot!(DVec2, PlaneVector, |v| Value::PlaneVector(v), Value::PlaneVector(v) => *v);
slot!([u32; 3], Counts, |v| Value::Counts(v), Value::Counts(v) => *v);
slot!(Gielis, Curve, |v| Value::Curve(v), Value::Curve(v) => *v);
slot!(BuiltInLaw, Law, |v| Value::Law(v), Value::Law(v) => v.clone(), Value::Number(v) => BuiltInLaw::Constant(*v));
slot!(RFunction, Function, |v| Value::Function(v), Value::Function(v) => *v);
slot!(Blend, Blend, |v| Value::Blend(v), Value::Blend(v) => *v);
slot!(Caps, Caps, |v| Value::Caps(v), Value::Caps(v) => *v);
slot!(Vec<Vec<DVec2>>, Contours, |v| Value::Contours(v), Value::Contours(v) => v.clone());
slot!(Vec<DVec2>, Points, |v| Value::Points(v), Value::Points(v) => v.clone());
slot!(String, Text, |v| Value::Text(v), Value::Text(v) => v.clone());
slot!(Bounds, Bounds, |v| Value::Bounds(v), Value::Bounds(v) => *v);
slot!(DAffine3, Map, |v| Value::Map(v), Value::Map(v) => *v);
slot!([u8; 3], Color, |v| Value::Color(v), Value::Color(v) => *v);

impl Slot for u32 {
    const KIND: Kind = Kind::Count;

    fn into_value(self) -> Value {
        Value::Count(self)
    }

    fn of_value(value: &Value) -> Option<u32> {
        match *value {
            Value::Count(n) => Some(n),
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range")]
            Value::Number(v) if v.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&v) => Some(v as u32),
            _ => None,
        }
    }
}

#[cfg(feature = "formula")]
/// The text of a formula.
pub(super) struct Vm(pub(super) String);

#[cfg(feature = "formula")]
slot!(Vm, Formula, |Vm(text)| Value::Text(text), Value::Text(text) => Vm(text.clone()));

/// One of some words.
macro_rules! choice {
    ($type:ty: $($word:literal => $variant:pat => $made:expr),+ $(,)?) => {
        impl Slot for $type {
            const KIND: Kind = Kind::Choice(&[$($word),+]);

            fn into_value(self) -> Value {
                Value::Choice(match self {
                    $($variant => $word,)+
                })
            }

            fn of_value(value: &Value) -> Option<Self> {
                let word = match value {
                    Value::Choice(word) => *word,
                    Value::Text(word) => word.as_str(),
                    _ => return None,
                };
                match word {
                    $($word => Some($made),)+
                    _ => None,
                }
            }
        }
    };
}

/// How the sheets of a hyperboloid lie.
pub(super) struct Sheets {
    pub(super) two: bool,
}

/// Which axis a hyperboloid is about.
pub(super) struct Axis {
    pub(super) is_x: bool,
}

choice!(MinimalSurface:
    "gyroid" => MinimalSurface::Gyroid => MinimalSurface::Gyroid,
    "schwarz_p" => MinimalSurface::SchwarzP => MinimalSurface::SchwarzP,
    "schwarz_d" => MinimalSurface::SchwarzD => MinimalSurface::SchwarzD,
);
choice!(Radius:
    "standard" => Radius::Standard => Radius::Standard,
    "rational" => Radius::Rational => Radius::Rational,
);
choice!(Turns:
    "principal" => Turns::Principal => Turns::Principal,
    "outer" => Turns::Outer => Turns::Outer,
    "inner" => Turns::Inner => Turns::Inner,
);
choice!(Sheets:
    "one" => Sheets { two: false } => Sheets { two: false },
    "two" => Sheets { two: true } => Sheets { two: true },
);
choice!(Axis:
    "z" => Axis { is_x: false } => Axis { is_x: false },
    "x" => Axis { is_x: true } => Axis { is_x: true },
);
