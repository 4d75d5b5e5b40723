//! SIMD lanes of `f32` and `f64`.

use fearless_simd::Simd;

use super::Real;

mod angle;
mod double;
mod log_space;
mod norms;
mod ops;
mod single;
#[cfg(test)]
mod sweep;
#[cfg(test)]
mod tests;
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
    fn load(simd: Self::Token, from: &[Self::Element]) -> Self;

    /// Writes the elements to a slice of length [`WIDTH`](Lanes::WIDTH).
    fn store(self, to: &mut [Self::Element]);
}
