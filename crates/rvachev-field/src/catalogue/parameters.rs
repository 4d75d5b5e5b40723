//! Parameters of a type that is built in: read and written without knowing the type.

use super::{Parameter, Slot, Value};

/// Values that are not those of the parameters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ValueError {
    /// Too few values, or too many.
    #[error("{entry} takes {expected} values, found {found}")]
    Count {
        /// What takes them.
        entry: &'static str,
        /// How many it takes.
        expected: usize,
        /// How many there were.
        found: usize,
    },
    /// A value of another kind.
    #[error("{entry}: {parameter} is {found}, allowed: {expected}")]
    Kind {
        /// What takes it.
        entry: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// What it takes.
        expected: String,
        /// What was given.
        found: String,
    },
    /// A text that is no formula.
    #[cfg(feature = "formula")]
    #[error("{entry}: {parameter}: {source}")]
    Formula {
        /// What takes it.
        entry: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// What is wrong with it.
        source: crate::FormulaError,
    },
    /// Too few operands, too many, or of another sort.
    #[error("{entry} takes {expected}, found {found}")]
    Operands {
        /// What takes them.
        entry: &'static str,
        /// What it takes, in words.
        expected: &'static str,
        /// What was given, in words.
        found: String,
    },
}

/// A type that is built in, and its parameters.
pub trait Parameters: Sized + 'static {
    /// Its name in the catalogue.
    const NAME: &'static str;
    /// What it is, in a line.
    const DOC: &'static str;

    /// The parameters, in order.
    fn schema() -> &'static [Parameter];

    /// Their values.
    fn values(&self) -> Vec<Value>;

    /// From values, in order. Ranges are not checked here.
    ///
    /// # Errors
    /// Not as many values as parameters, or one of another kind.
    fn from_values(values: &[Value]) -> Result<Self, ValueError>;
}

/// Values that are taken one by one.
pub struct Arguments<'a> {
    entry: &'static str,
    values: std::slice::Iter<'a, Value>,
}

impl<'a> Arguments<'a> {
    /// The values of `entry`, which takes `expected` of them.
    ///
    /// # Errors
    /// Another number of values.
    pub fn new(entry: &'static str, values: &'a [Value], expected: usize) -> Result<Arguments<'a>, ValueError> {
        let found = values.len();
        if found != expected {
            return Err(ValueError::Count { entry, expected, found });
        }
        Ok(Arguments { entry, values: values.iter() })
    }

    /// The next one.
    ///
    /// # Errors
    /// A value of another kind.
    pub fn take<T: Slot>(&mut self, parameter: &'static str) -> Result<T, ValueError> {
        let value = self.values.next();
        value.and_then(T::of_value).ok_or_else(|| ValueError::Kind {
            entry: self.entry,
            parameter,
            expected: format!("{:?}", T::KIND),
            found: value.map_or_else(|| "nothing".to_string(), |value| format!("{value:?}")),
        })
    }
}
