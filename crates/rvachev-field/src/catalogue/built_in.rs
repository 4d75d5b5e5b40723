//! What is built in, without its type; and the macro that declares it.

use std::any::Any;
use std::sync::Arc;

use super::{Parameter, Parameters, Value, ValueError};
use crate::Erase;

/// A built-in leaf or deformation, told by its parameters.
pub struct BuiltIn<Erased: ?Sized> {
    /// Its name, as constructors spell it.
    pub name: &'static str,
    /// What it is, in a line.
    pub doc: &'static str,
    /// Its parameters.
    pub schema: fn() -> &'static [Parameter],
    /// The values of one, if that is what it is.
    pub values: fn(&dyn Any) -> Option<Vec<Value>>,
    /// One with these values.
    pub make: fn(&[Value]) -> Result<Arc<Erased>, ValueError>,
}

impl<Erased: ?Sized> BuiltIn<Erased> {
    /// That of a type.
    pub(super) const fn of<T: Parameters + Erase<Erased>>() -> BuiltIn<Erased> {
        BuiltIn {
            name: T::NAME,
            doc: T::DOC,
            schema: T::schema,
            values: |any| any.downcast_ref::<T>().map(T::values),
            make: |values| Ok(T::from_values(values)?.erase()),
        }
    }
}

/// Declares the parameters of a type.
///
/// A parameter is `name: type = how it is read, unit, range, given the others, example`.
#[doc(hidden)]
#[macro_export]
macro_rules! parameters {
    (
        $doc:literal $name:ident: $type:ty as $this:ident {
            $(
                #[doc = $about:literal]
                $p:ident: $t:ty = $read:expr, $unit:ident, $range:expr, $(given $given:expr,)? example $example:expr;
            )*
        } => $make:expr
    ) => {
        impl $crate::catalogue::Parameters for $type {
            const NAME: &'static str = stringify!($name);
            const DOC: &'static str = $doc;

            fn schema() -> &'static [$crate::catalogue::Parameter] {
                const SCHEMA: &[$crate::catalogue::Parameter] = &[$(
                    $crate::catalogue::Parameter::declare(
                        [stringify!($p), $about],
                        (
                            <$t as $crate::catalogue::Slot>::KIND,
                            $crate::catalogue::Unit::$unit,
                            $range,
                        ),
                        |_values| {
                            let _given: Option<$crate::catalogue::Range> = None;
                            $(
                                let $this = <$type as $crate::catalogue::Parameters>::from_values(_values).ok()?;
                                let _given = Some($given);
                            )?
                            _given
                        },
                        || <$t as $crate::catalogue::Slot>::into_value($example),
                    ),
                )*];
                SCHEMA
            }

            fn values(&self) -> Vec<$crate::catalogue::Value> {
                let $this = self;
                vec![$(<$t as $crate::catalogue::Slot>::into_value($read)),*]
            }

            fn from_values(
                values: &[$crate::catalogue::Value],
            ) -> Result<Self, $crate::catalogue::ValueError> {
                let expected = <Self as $crate::catalogue::Parameters>::schema().len();
                let mut arguments = $crate::catalogue::Arguments::new(stringify!($name), values, expected)?;
                $(let $p: $t = arguments.take(stringify!($p))?;)*
                Ok($make)
            }
        }
    };
}

/// Declares what is built in: erases it, tells its parameters, lists it.
///
/// `$types!(callback)` calls `callback!` with the list of types. (`$d` is a dollar sign.)
macro_rules! built_in {
    (
        ($d:tt) $any:ty, $list:ident, $types:ident;
        $(
            #[doc = $doc:literal]
            $name:ident: $type:ident as $this:ident $parameters:tt => $make:expr;
        )*
    ) => {
        $(
            $crate::parameters!($doc $name: $type as $this $parameters => $make);

            impl $crate::Erase<$any> for $type {
                #[inline(never)]
                fn erase(self) -> std::sync::Arc<$any> {
                    std::sync::Arc::new(self)
                }
            }
        )*

        #[doc = concat!("All of them, by name: ", stringify!($($name),*), ".")]
        pub static $list: &[$crate::catalogue::BuiltIn<$any>] = &[$($crate::catalogue::BuiltIn::of::<$type>()),*];

        /// Calls a macro with the list of types.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! $types {
            ($d callback:ident) => {
                $d callback!($($crate::$type),*);
            };
        }
    };
}

pub(super) use built_in;
