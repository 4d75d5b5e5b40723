//! Functions of two arguments that rise with each of them.

use super::Real;

/// A function of two numbers that does not fall when either of them rises, as all
/// R-functions but R_0^m are.
///
/// [`Real::monotone`] evaluates it in the way that suits the number: a range is then exact,
/// two endpoint evaluations, and a gradient is two slopes.
pub trait Monotone {
    /// The function's value.
    fn value<R: Real>(&self, x: R, y: R) -> R;

    /// The value and the slopes with respect to `x` and `y`.
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R);
}
