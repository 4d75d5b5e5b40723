//! What the norms need of a number in order to work on logarithms.

use crate::Real;

/// A number whose p-norms are computed from logarithms (see `norms.rs`).
///
/// Logarithms are taken relative to a power of two that is common to a point's coordinates,
/// its largest coordinate rounded down. They are then near 0 where they matter, and rounding
/// them costs as little at coordinates of 10⁷ as at 1.
pub trait LogSpace: Real {
    /// What stands for the logarithm of 0.
    const LOG2_OF_ZERO: f64;

    /// The largest power of two that is not above `self` ≥ 0; 0 for subnormal numbers.
    fn power_below(self) -> Self;

    /// `1 / self` for a power of two below half of the largest one; of 0 the largest.
    fn power_recip(self) -> Self;

    /// `log2(self / power)` without a division; of a subnormal number something finite that
    /// is not above that of the smallest normal one.
    fn log2_over(self, power: Self) -> Self;

    /// `2^self` for −126 ≤ self < 128 (−1022 and 1024 in `f64`).
    fn exp2_within(self) -> Self;

    /// `2^self` to less accuracy, for weights and slopes, from an exponent ≤ 100 of any size
    /// below: it stops falling near the smallest normal number.
    fn exp2_weight(self) -> Self;

    /// `self · 2^n`, n being in the low bits of `rounded`.
    fn times_power(self, rounded: Self) -> Self;

    /// The logarithm of the p-norm of two numbers that are given by their logarithms:
    /// `max(a, b) + log2(1 + 2^(−p·|a − b|)) / p`, `inv` being `1/p`.
    ///
    /// This is the long chain of dependent operations in a norm. It is written over `T`, this
    /// vector or several of its kind, so that the chains of several vectors are interleaved
    /// operation by operation (to 1.7 ns a point from 1.9 where whole calls alternate).
    fn join<T: LogSpace>(a: T, b: T, p: f64, inv: f64) -> T;

    /// `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;

    /// `self`, but 0 where `key` is 0 or subnormal.
    fn vanish_with(self, key: Self) -> Self;

    /// `self`, but [`LOG2_OF_ZERO`](LogSpace::LOG2_OF_ZERO) where `key` ≥ 0 is 0 or subnormal.
    fn log_vanish_with(self, key: Self) -> Self;

    /// 1 where `self > other`, ½ where they are equal, else 0.
    fn above(self, other: Self) -> Self;

    /// `self`, the largest finite number in place of +∞.
    fn finite(self) -> Self;
}
