//! The operations of formulas, on the numbers that they are evaluated on.
//!
//! A formula is data, not code: one walk over its operations serves points, ranges and gradients,
//! each of which says here what an operation does to it. The meaning is that of fidget, on IEEE
//! numbers: the root of −1 is NaN, a minimum of a number and NaN is NaN. What is undefined stays so
//! to the end, where it counts as outside.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::functions::{double, single};

/// A number that a formula's operations apply to.
pub(super) trait Arithmetic: Copy {
    fn constant(c: f64) -> Self;
    fn unary(op: UnaryOpcode, a: Self) -> Self;
    fn binary(op: BinaryOpcode, a: Self, b: Self) -> Self;
}

/// A number that derivatives can be made of.
pub(super) trait Scalar: Arithmetic {
    /// `nonneg` where `self ≥ 0`, else `neg`.
    fn select(self, nonneg: Self, neg: Self) -> Self;
    /// `zero` where `self = 0`, else `other`; undecided where both are possible.
    fn if_zero(self, zero: Self, other: Self) -> Self;
    /// The derivative of a step function that has the value `self`: 0, or anything where
    /// there is a step.
    fn flat(self) -> Self;
    /// `slope`, or anything where the angle of the vector `(x, y)` may jump.
    fn off_the_cut(slope: Self, y: Self, x: Self) -> Self;
    /// Whether it is 0 and nothing else.
    fn vanishes(self) -> bool;
}

/// A floating-point number as an element of a slice.
pub(super) trait Float: Copy + PartialOrd {
    fn narrow(c: f64) -> Self;
    fn apply1(op: UnaryOpcode, a: Self) -> Self;
    fn apply2(op: BinaryOpcode, a: Self, b: Self) -> Self;
    /// Whether [`apply_near`](Float::apply_near) takes all of these.
    fn are_near(op: UnaryOpcode, all: &[Self]) -> bool;
    /// What `apply1` gives, without a branch: for loops.
    fn apply_near(op: UnaryOpcode, a: Self) -> Self;
}

/// fidget's noise is made of the bits of single-precision numbers.
#[expect(clippy::cast_possible_truncation, reason = "noise takes single precision")]
fn rand(a: f64) -> f32 {
    UnaryOpcode::Rand.eval(a as f32)
}

#[expect(clippy::cast_possible_truncation, reason = "noise takes single precision")]
fn mix(a: f64, b: f64) -> f32 {
    BinaryOpcode::Mix.eval(a as f32, b as f32)
}

macro_rules! float {
    ($float:ident, $functions:ident) => {
        impl Float for $float {
            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "constants in the precision of the lanes")]
            fn narrow(c: f64) -> $float {
                c as $float
            }

            #[inline(always)]
            fn apply1(op: UnaryOpcode, a: $float) -> $float {
                match op {
                    UnaryOpcode::Neg => -a,
                    UnaryOpcode::Abs => a.abs(),
                    UnaryOpcode::Recip => 1.0 / a,
                    UnaryOpcode::Sqrt => a.sqrt(),
                    UnaryOpcode::Square => a * a,
                    UnaryOpcode::Floor => a.floor(),
                    UnaryOpcode::Ceil => a.ceil(),
                    UnaryOpcode::Round => a.round(),
                    UnaryOpcode::Sin => $functions::sin(a),
                    UnaryOpcode::Cos => $functions::cos(a),
                    UnaryOpcode::Tan => a.tan(),
                    UnaryOpcode::Asin => a.asin(),
                    UnaryOpcode::Acos => a.acos(),
                    UnaryOpcode::Atan => a.atan(),
                    UnaryOpcode::Exp => $functions::exp(a),
                    UnaryOpcode::Ln => $functions::ln(a),
                    UnaryOpcode::Not => {
                        if a == 0.0 {
                            1.0
                        } else {
                            0.0
                        }
                    }
                    UnaryOpcode::Rand => rand(a.into()).into(),
                }
            }

            #[inline(always)]
            fn apply2(op: BinaryOpcode, a: $float, b: $float) -> $float {
                match op {
                    BinaryOpcode::Add => a + b,
                    BinaryOpcode::Sub => a - b,
                    BinaryOpcode::Mul => a * b,
                    BinaryOpcode::Div => a / b,
                    BinaryOpcode::Atan => a.atan2(b),
                    BinaryOpcode::Min => {
                        let least = if a < b { a } else { b };
                        if a.is_nan() { a } else { least }
                    }
                    BinaryOpcode::Max => {
                        let most = if a > b { a } else { b };
                        if a.is_nan() { a } else { most }
                    }
                    BinaryOpcode::Compare => {
                        let sign = if a < b {
                            -1.0
                        } else if a > b {
                            1.0
                        } else {
                            0.0
                        };
                        if a.is_nan() || b.is_nan() { $float::NAN } else { sign }
                    }
                    BinaryOpcode::Mod => a.rem_euclid(b),
                    BinaryOpcode::And => {
                        if a == 0.0 {
                            a
                        } else {
                            b
                        }
                    }
                    BinaryOpcode::Or => {
                        if a == 0.0 {
                            b
                        } else {
                            a
                        }
                    }
                    BinaryOpcode::Mix => mix(a.into(), b.into()).into(),
                }
            }

            #[inline(always)]
            fn are_near(op: UnaryOpcode, all: &[$float]) -> bool {
                match op {
                    UnaryOpcode::Sin | UnaryOpcode::Cos => $functions::are_near(all),
                    _ => true,
                }
            }

            #[inline(always)]
            fn apply_near(op: UnaryOpcode, a: $float) -> $float {
                match op {
                    UnaryOpcode::Sin => $functions::sin_near(a),
                    UnaryOpcode::Cos => $functions::cos_near(a),
                    _ => <$float as Float>::apply1(op, a),
                }
            }
        }

        impl Arithmetic for $float {
            #[inline(always)]
            fn constant(c: f64) -> $float {
                $float::narrow(c)
            }

            #[inline(always)]
            fn unary(op: UnaryOpcode, a: $float) -> $float {
                $float::apply1(op, a)
            }

            #[inline(always)]
            fn binary(op: BinaryOpcode, a: $float, b: $float) -> $float {
                $float::apply2(op, a, b)
            }
        }

        impl Scalar for $float {
            #[inline(always)]
            fn select(self, nonneg: $float, neg: $float) -> $float {
                if self >= 0.0 { nonneg } else { neg }
            }

            #[inline(always)]
            fn if_zero(self, zero: $float, other: $float) -> $float {
                if self == 0.0 { zero } else { other }
            }

            #[inline(always)]
            fn flat(self) -> $float {
                0.0
            }

            #[inline(always)]
            fn off_the_cut(slope: $float, _y: $float, _x: $float) -> $float {
                slope
            }

            #[inline(always)]
            fn vanishes(self) -> bool {
                self == 0.0
            }
        }
    };
}

float!(f32, single);
float!(f64, double);

/// Calls `$body` with `$op` bound to the operation as a constant, so that each gets a loop of
/// its own.
macro_rules! each_unary {
    ($value:expr, $op:ident => $body:expr) => {
        each_unary!(@ $value, $op => $body; Neg Abs Recip Sqrt Square Floor Ceil Round Sin Cos Tan Asin Acos Atan Exp Ln Not Rand)
    };
    (@ $value:expr, $op:ident => $body:expr; $($name:ident)*) => {
        match $value {
            $(UnaryOpcode::$name => {
                const $op: UnaryOpcode = UnaryOpcode::$name;
                $body
            })*
        }
    };
}

/// The same for operations on two numbers.
macro_rules! each_binary {
    ($value:expr, $op:ident => $body:expr) => {
        each_binary!(@ $value, $op => $body; Add Sub Mul Div Atan Min Max Compare Mod And Or Mix)
    };
    (@ $value:expr, $op:ident => $body:expr; $($name:ident)*) => {
        match $value {
            $(BinaryOpcode::$name => {
                const $op: BinaryOpcode = BinaryOpcode::$name;
                $body
            })*
        }
    };
}

pub(super) use {each_binary, each_unary};
