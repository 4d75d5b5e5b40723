//! Numbers: the trait [`Real`] that every formula is written over, and its implementations.
//!
//! A leaf, an R-function or a deformation is written once, generic over [`Real`], and run on
//!
//! | number | gives |
//! |---|---|
//! | `f64` | the reference value |
//! | [`Interval`] | a sound range over a box |
//! | [`Dual`] over any of them | value and gradient |
//! | [`Jet`] | ranges of a value and of its first and second derivatives |
//! | SIMD lanes of `f32` and `f64` | values and gradients in bulk |
//! | [`Symbol`](symbol::Symbol) | an expression tree for fidget |

mod along;
mod angle;
mod bounds;
mod dual;
mod figures;
mod float;
mod interval;
mod jet;
pub mod jobs;
pub mod lanes;
mod level;
mod monotone;
mod norm;
pub mod order;
mod real;
mod run;
pub mod signs;
pub mod symbol;
#[cfg(feature = "formula")]
mod trees;

pub use angle::{Angle, deg, rad, turns};
pub use bounds::{Bounds, column_times};
pub use dual::Dual;
pub use figures::{figures, figures_beside};
pub use interval::{Interval, least, most};
pub use jet::Jet;
pub use monotone::{Monotone, Monotone3, OfOne};
pub use norm::{Euclid, Norm, NormKind, Powers};
pub use real::Real;
pub use run::{CancelToken, Cancelled, Meter, Progress, Run};
