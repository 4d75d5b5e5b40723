//! Curves: values of parameters that have parameters themselves.

use super::{Parameter, Parameters, Range, Value, ValueError};
use crate::{Gielis, Turns};

/// The largest ratio of the inner exponents to the outer one.
const STEEPEST: f64 = 100.0;

crate::parameters!(
    "A Gielis curve in polar form, about the origin."
    gielis: Gielis as curve {
        /// Rotational symmetry: the number of corners.
        m: f64 = curve.m, None, Range::new(0.0, 64.0), example 5.0;
        /// Outer exponent: how sharp it is.
        n1: f64 = curve.n1, None, Range::new(0.05, 1000.0),
            given Range::new(0.05f64.max(curve.n2.max(curve.n3) / STEEPEST), 1000.0), example 2.0;
        /// Exponent of the cosine.
        n2: f64 = curve.n2, None, Range::new(0.1, 1000.0),
            given Range::new(0.1, 1000f64.min(STEEPEST * curve.n1)), example 2.0;
        /// Exponent of the sine.
        n3: f64 = curve.n3, None, Range::new(0.1, 1000.0),
            given Range::new(0.1, 1000f64.min(STEEPEST * curve.n1)), example 2.0;
        /// Scale of the cosine; 1 for the rational radius.
        a: f64 = curve.a, None, Range::new(0.01, 100.0), example 1.0;
        /// Scale of the sine; 1 for the rational radius.
        b: f64 = curve.b, None, Range::new(0.01, 100.0), example 1.0;
        /// Which turns count of a curve that runs about the origin several times.
        turns: Turns = curve.turns, None, Range::ANY, example Turns::Principal;
    } => Gielis { m, n1, n2, n3, a, b, turns }
);

/// Name, line of docs, parameters and making of the curves.
pub static CURVES: &[Curve] =
    &[Curve { name: Gielis::NAME, doc: Gielis::DOC, schema: Gielis::schema, make: Gielis::from_values }];

/// A curve, told by its parameters.
pub struct Curve {
    /// Its name, as scripts spell it.
    pub name: &'static str,
    /// What it is, in a line.
    pub doc: &'static str,
    /// Its parameters.
    pub schema: fn() -> &'static [Parameter],
    /// One with these values.
    pub make: fn(&[Value]) -> Result<Gielis, ValueError>,
}
