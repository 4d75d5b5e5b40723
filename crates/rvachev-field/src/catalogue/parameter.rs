//! A parameter, as the catalogue tells it.

use super::{Kind, Range, Unit, Value};

/// One parameter of what the catalogue lists: its name, kind, unit and range, and what it is.
///
/// ```
/// use rvachev::catalogue::{Kind, Unit, Value};
/// use rvachev::catalogue;
///
/// let ring = catalogue().iter().find(|entry| entry.name() == "torus").expect("a torus");
/// let [radius, tube] = ring.parameters() else { unreachable!("two parameters") };
/// assert_eq!((radius.name(), radius.kind(), radius.unit()), ("radius", Kind::Number, Unit::Length));
/// // No tube is fatter than its ring.
/// let values = [Value::Number(3.0), Value::Number(1.0)];
/// assert_eq!(tube.range_given(&values).most, 3.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    name: &'static str,
    doc: &'static str,
    kind: Kind,
    unit: Unit,
    range: Range,
    given: fn(&[Value]) -> Option<Range>,
    example: fn() -> Value,
}

impl Parameter {
    /// A parameter: what the macros declare.
    #[doc(hidden)]
    #[must_use]
    pub const fn declare(
        [name, doc]: [&'static str; 2],
        (kind, unit, range): (Kind, Unit, Range),
        given: fn(&[Value]) -> Option<Range>,
        example: fn() -> Value,
    ) -> Parameter {
        Parameter { name, doc, kind, unit, range, given, example }
    }

    /// The name, as constructors spell it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// What it is, in a line.
    #[must_use]
    pub fn doc(&self) -> &'static str {
        self.doc.trim()
    }

    /// What sort of value it takes.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The unit of its numbers.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.unit
    }

    /// The numbers that it may have, whatever the other parameters are; of a vector each of its
    /// coordinates. [`Range::ANY`] of what has no numbers.
    #[must_use]
    pub fn range(&self) -> Range {
        self.range
    }

    /// The numbers that it may have beside the other ones of `values` (all parameters in order):
    /// no more than [`range`](Parameter::range).
    #[must_use]
    pub fn range_given(&self, values: &[Value]) -> Range {
        (self.given)(values).unwrap_or(self.range)
    }

    /// A value that will do, beside the examples of the other parameters.
    #[must_use]
    pub fn example(&self) -> Value {
        (self.example)()
    }
}
