//! Verbs: entries that are made by a method rather than by a type; and the macro that declares
//! them.

use rvachev_field::catalogue::ValueError;

use super::{Group, Operands, Part};
use crate::{Parameter, Value};

/// A method, or a variant of a value, told by its parameters.
pub(super) struct Verb {
    pub(super) group: Group,
    pub(super) name: &'static str,
    pub(super) doc: &'static str,
    pub(super) operands: Operands,
    pub(super) parameters: &'static [Parameter],
    pub(super) make: fn(&[Part], &[Value]) -> Result<Part, ValueError>,
}

/// Declares verbs.
///
/// A parameter is `name: type = unit, range, given the values, example`; the last line says what
/// is made of the operands.
macro_rules! verbs {
    ($(
        #[doc = $doc:literal]
        $group:ident $name:ident {
            $(
                #[doc = $about:literal]
                $p:ident: $t:ty = $unit:ident, $range:expr, $(given |$values:pat_param| $given:expr,)? example $example:expr;
            )*
        } => |$operands:tt: $operand:ty| $make:expr;
    )*) => {
        /// What is declared in this file.
        pub(super) static VERBS: &[$crate::catalogue::verb::Verb] = &[$(
            $crate::catalogue::verb::Verb {
                group: $crate::catalogue::Group::$group,
                name: stringify!($name),
                doc: $doc,
                operands: <$operand as $crate::catalogue::part::Take>::OPERANDS,
                parameters: &[$(
                    $crate::Parameter::declare(
                        [stringify!($p), $about],
                        (
                            <$t as rvachev_field::catalogue::Slot>::KIND,
                            $crate::Unit::$unit,
                            $range,
                        ),
                        |_all| {
                            let _given: Option<$crate::Range> = None;
                            $(let _given: Option<$crate::Range> = (|$values: &[$crate::Value]| $given)(_all);)?
                            _given
                        },
                        || <$t as rvachev_field::catalogue::Slot>::into_value($example),
                    ),
                )*],
                make: |parts, values| {
                    const NAMES: &[&str] = &[$(stringify!($p)),*];
                    let mut _arguments =
                        rvachev_field::catalogue::Arguments::new(stringify!($name), values, NAMES.len())?;
                    $(let $p: $t = _arguments.take(stringify!($p))?;)*
                    let $operands = <$operand as $crate::catalogue::part::Take>::take(stringify!($name), parts)?;
                    Ok($crate::catalogue::Part::from($make))
                },
            },
        )*];
    };
}

pub(super) use verbs;
