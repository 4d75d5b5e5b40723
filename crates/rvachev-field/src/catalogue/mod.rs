//! The catalogue of what is built in: every leaf, plane shape and deformation, with its
//! parameters.
//!
//! ```text
//!     built_in!  ──►  Erase        behind a pointer, its kernels compiled in this crate
//!                ──►  Parameters   names, kinds, ranges, values; made of values
//!                ──►  a list       for whoever knows no types: text, tools, fitting
//!                ──►  a macro      the list of types, for crates above: conversions
//! ```
//!
//! A leaf that is added is declared once, in `leaves`, `profiles` or `deformations`.

mod built_in;
mod curves;
mod deformations;
#[cfg(feature = "formula")]
mod formulas;
mod kind;
mod leaves;
mod parameter;
mod parameters;
mod profiles;
mod range;
mod slot;
mod value;

use crate::AnyField;

pub use built_in::BuiltIn;
pub use curves::{CURVES, Curve};
pub use deformations::{DEFORMATIONS, LAW_DEFORMATIONS, taper_by, twist_by};
pub use kind::{Kind, Unit};
pub use parameter::Parameter;
pub use parameters::{Arguments, Parameters, ValueError};
pub use profiles::PLANE_LEAVES;
pub use range::Range;
pub use slot::{Direction, Slot};
pub use value::Value;

/// The leaves in space that are built in.
pub fn leaves() -> impl Iterator<Item = &'static BuiltIn<dyn AnyField>> {
    let lists = [
        leaves::LEAVES,
        #[cfg(feature = "formula")]
        formulas::FORMULAS,
    ];
    lists.into_iter().flatten()
}
