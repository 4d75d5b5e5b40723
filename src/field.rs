//! For writers of leaves: the trait of leaves, and the numbers that a formula is written over.
//!
//! [`Field`] has an example. `examples/custom_field.rs` is a longer one: a torus knot that prunes
//! and runs like a built-in leaf.

#[doc(inline)]
pub use rvachev_field::{Along, COORDINATE_LIMIT, Field, Kernel, Segment, VALUE_LIMIT, chained};
#[doc(inline)]
pub use rvachev_num::{Dual, Jet, Monotone, Monotone3, Norm, Real};
