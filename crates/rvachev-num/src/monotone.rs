//! Functions of two and of three arguments that rise with each of them, and functions of one.

use super::{Interval, Real};

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

    /// Which of the arguments the value is throughout these ranges, if it is found to be one.
    fn only(&self, _of: [Interval; 2]) -> Option<usize> {
        None
    }
}

/// A function of three numbers that does not fall when any of them rises, such as a gauge that
/// has no closed form and is found by iteration.
///
/// [`Real::monotone3`] evaluates it in the way that suits the number: a range is two endpoint
/// evaluations, however often the formula names its arguments, and a gradient is three slopes.
pub trait Monotone3 {
    /// Whether the value is found by iteration: ranges of second derivatives of all its steps take
    /// long and tell nothing, so none are asked for.
    const ITERATES: bool = false;

    /// The function's value. In `f64` it must be within 10⁻¹³ of the true one, relative to the
    /// value and the largest argument.
    fn value<R: Real>(&self, x: R, y: R, z: R) -> R;

    /// The value and the slopes with respect to `x`, `y` and `z`.
    fn parts<R: Real>(&self, x: R, y: R, z: R) -> (R, [R; 3]);

    /// Which of the arguments the value is throughout these ranges, if it is found to be one.
    fn only(&self, _of: [Interval; 3]) -> Option<usize> {
        None
    }
}

/// A function of one number, of several operations: a gradient is its value and its slope, found
/// together on numbers with a single derivative, and the chain rule.
pub trait OfOne {
    /// The function's value.
    fn value<R: Real>(&self, x: R) -> R;
}
