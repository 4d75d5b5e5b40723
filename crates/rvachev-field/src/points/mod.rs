//! Points of superquadrics, fast: the six methods of Franklin and Barr.
//!
//! | # | method | a point | error |
//! |---|---|---|---|
//! | 1 | [`RawParametric`] | 4 sines and cosines, 4 powers | rounding |
//! | 2 | [`ExactExplicit`] | 3 powers | rounding |
//! | 3 | [`SeriesExplicit`] | 2 powers, a polynomial | [tail of the series](BinomialSeries::error_bound) |
//! | 4 | [`LogTable`] | 2 look-ups, 2 `exp2`, a polynomial | the same |
//! | 5 | [`ProductTables`] | 3 loads, 2 multiplications | single precision |
//! | 6 | [`PowerTables`] | 3 look-ups, 2 subtractions | [half a step of the table](PowerTables::error_bound) |
//!
//! Methods 2, 3, 4 and 6 give the height z over (x, y) of `xⁿ + yⁿ + zⁿ = 1`, n = 2/e, in the wedge
//! where z is the largest coordinate; 1 and 5 give whole points of nested superellipsoids.
//!
//! Source: W. R. Franklin, A. H. Barr, *Faster calculation of superquadric shapes* (1981).

mod curve_points;
mod explicit;
mod product;
mod raw;
mod series;
mod solid_points;
mod tables;
mod wedge;

pub use curve_points::CurveSpread;
pub use explicit::{ExactExplicit, SeriesExplicit};
pub use product::ProductTables;
pub use raw::RawParametric;
pub use series::BinomialSeries;
pub use solid_points::{PointMethod, PointSettings};
pub use tables::{LogTable, PowerTables};
pub use wedge::{PlaneSymmetry, Symmetry, reflect, reflect_plane};

use crate::ParamError;

/// Why points cannot be computed as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PointError {
    /// A parameter of the shape is out of its range.
    #[error(transparent)]
    Shape(#[from] ParamError),
    /// A parameter of the method is out of its range.
    #[error("{parameter} is {value}, allowed: {allowed}")]
    Parameter {
        /// Which parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The method is for superellipsoids of equal exponents.
    #[error("exponents are {e1} and {e2}, allowed for this method: equal ones")]
    Exponents {
        /// The first.
        e1: f64,
        /// The second.
        e2: f64,
    },
}

fn check_exponent(n: f64) -> Result<(), PointError> {
    if (0.2..=1e4).contains(&n) {
        return Ok(());
    }
    Err(PointError::Parameter { parameter: "n = 2/e", value: n, allowed: "0.2 to 10000" })
}
