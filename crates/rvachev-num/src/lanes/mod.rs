//! SIMD lanes of `f32` and `f64`: many points at once.
//!
//! [`F32`] and [`F64`] are native vectors of whatever SIMD level the caller holds a token of;
//! [`Twice`] is two numbers side by side. All are [`Real`](crate::Real), so a formula that
//! is written for `f64` runs on them as it is. [`Lanes`] loads and stores them:
//!
//! ```text
//! fn kernel<S: Simd>(simd: S, x: &[f32], out: &mut [f32]) {      // called by dispatch!
//!     type T<S> = Twice<Twice<F32<S>>>;
//!     for (x, out) in x.chunks_exact(T::<S>::WIDTH).zip(out.chunks_exact_mut(T::<S>::WIDTH)) {
//!         formula(T::<S>::load(simd, x)).store(out);
//!     }
//! }
//! ```
//!
//! # Formulas
//!
//! | function | how |
//! |---|---|
//! | `log2` | exponent by integer arithmetic; a polynomial in m − 1 (`f32`) or in ((m − 1)/(m + 1))² (`f64`), the mantissa m in [√½, √2) |
//! | `exp2` | the nearest integer goes into the exponent field, a polynomial takes the rest |
//! | `pow` | `exp2(p · log2)` |
//! | `sin_cos` | π/2 subtracted in three pieces, polynomials on [−π/4, π/4] |
//! | `atan2` | an odd polynomial of the smaller over the larger coordinate |
//! | norms | logarithms, relative to the largest coordinate's power of two: `norms.rs` |
//!
//! # Errors
//!
//! Measured on AVX-512, AVX2, SSE4.2 and SSE2 by the sweeps of the unit tests, which hold these
//! bounds.
//!
//! | function | `f32` | `f64` | |
//! |---|---|---|---|
//! | `log2`, 1/2 ≤ x ≤ 2 | 1.4·10⁻⁷ | 3·10⁻¹⁶ | absolute; 0 at powers of 2 |
//! | `log2`, elsewhere, over 1 + its size | 1·10⁻⁷ | 2.5·10⁻¹⁶ | absolute |
//! | `exp2` | 1.2·10⁻⁷ | 3·10⁻¹⁶ | relative; 0 at integers |
//! | `pow`, over 1.5 + p(1 + its logarithm's size) | 1·10⁻⁷ | 3·10⁻¹⁶ | relative |
//! | `sin_cos`, up to 12 000 or 10⁶ | 1.2·10⁻⁷ | 2.5·10⁻¹⁶ | absolute |
//! | `atan2` | 3·10⁻⁷ | 5·10⁻¹⁶ | relative, also of small angles |
//! | `norm`, `nested`, p in [0.8, 40] | 5·10⁻⁷ | 1.5·10⁻¹⁵ | relative, coordinates 0 and 10⁻²⁰ to 10²⁰ |
//! | `norm_parts`, `nested_parts`, over 1 + p | 5·10⁻⁷ | 1.5·10⁻¹⁵ | absolute, of a slope (relative of one above 1) |
//!
//! A slope at a coordinate that is 2⁻ᵏ of the largest one has that error times 1 + k/16, and
//! one above 1 (they exist where p < 1) times 1 + its logarithm.
//!
//! # Limits
//!
//! * Subnormal numbers count as 0, as arguments and as results of `exp2` and of norms.
//! * Results are finite where arguments are. What is too large is the largest finite number; a
//!   slope is at most 2¹⁰⁰; angles beyond the range above give something in [−1, 1].
//! * Infinities and NaN as arguments give anything.
//! * Below AVX2 `mul_add` rounds twice, so lanes are bit-equal per SIMD level only.
//!
//! # Speed
//!
//! Everything is `#[inline(always)]`, and has to be in a caller too, down from the function that
//! `dispatch!` calls. A norm is one long chain of dependent operations: a processor with a small
//! scheduler keeps busy only if the chains of several vectors alternate. A nested p-norm on
//! AVX-512 (Zen 4, 3.65 GHz), in ns a point, value and value with gradient:
//!
//! | number | value | gradient |
//! |---|---|---|
//! | `F32` | 2.3 | 3.6 |
//! | `Twice<F32>` | 1.7 | 2.55 |
//! | `Twice<Twice<F32>>` | 1.5 | 2.3 |
//! | `F64` | 7.1 | 11.7 |
//!
//! The kind of a norm is best matched outside of the loop over a chunk: with all kinds in one
//! loop their constants do not fit into registers.

use fearless_simd::Simd;

mod angle;
mod double;
#[cfg(test)]
mod function_tests;
mod log_space;
#[cfg(test)]
mod norm_tests;
pub(crate) mod norms;
mod ops;
mod single;
#[cfg(test)]
mod sweep;
mod twice;

pub use double::F64;
pub use log_space::LogSpace;
pub use single::F32;
pub use twice::Twice;

/// A vector of numbers: made from a SIMD token, loaded from and stored to slices.
pub trait Lanes: LogSpace {
    /// What a slice holds.
    type Element: Copy + 'static;

    /// Proof of the SIMD level that the vector is of.
    type Token: Simd;

    /// Elements per vector.
    const WIDTH: usize;

    /// `c` in every lane.
    fn splat(simd: Self::Token, c: f64) -> Self;

    /// The elements of a slice of length [`WIDTH`](Lanes::WIDTH).
    ///
    /// # Panics
    ///
    /// If the slice has another length.
    fn load(simd: Self::Token, from: &[Self::Element]) -> Self;

    /// Writes the elements to a slice of length [`WIDTH`](Lanes::WIDTH).
    ///
    /// # Panics
    ///
    /// If the slice has another length.
    fn store(self, to: &mut [Self::Element]);
}
