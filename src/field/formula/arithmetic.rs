//! The operations of formulas, on the numbers that they are evaluated on.
//!
//! A formula is data, not code: one walk over its operations serves points (`f64`), blocks of
//! points, ranges and gradients, each of which says here what an operation does to it. The
//! meaning is that of fidget, on IEEE numbers: the root of −1 is NaN, a minimum of a number and NaN
//! is NaN. What is undefined stays so to the end, where it counts as outside.

use fidget::context::{BinaryOpcode, UnaryOpcode};

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
    ($float:ident) => {
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
                    UnaryOpcode::Sin => a.sin(),
                    UnaryOpcode::Cos => a.cos(),
                    UnaryOpcode::Tan => a.tan(),
                    UnaryOpcode::Asin => a.asin(),
                    UnaryOpcode::Acos => a.acos(),
                    UnaryOpcode::Atan => a.atan(),
                    UnaryOpcode::Exp => a.exp(),
                    UnaryOpcode::Ln => a.ln(),
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
        }
    };
}

float!(f32);
float!(f64);

impl Arithmetic for f64 {
    fn constant(c: f64) -> f64 {
        c
    }

    fn unary(op: UnaryOpcode, a: f64) -> f64 {
        f64::apply1(op, a)
    }

    fn binary(op: BinaryOpcode, a: f64, b: f64) -> f64 {
        f64::apply2(op, a, b)
    }
}

impl Scalar for f64 {
    fn select(self, nonneg: f64, neg: f64) -> f64 {
        if self >= 0.0 { nonneg } else { neg }
    }

    fn if_zero(self, zero: f64, other: f64) -> f64 {
        if self == 0.0 { zero } else { other }
    }

    fn flat(self) -> f64 {
        0.0
    }

    fn off_the_cut(slope: f64, _y: f64, _x: f64) -> f64 {
        slope
    }

    fn vanishes(self) -> bool {
        self == 0.0
    }
}

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

/// Several points at once: what a walk costs beside the arithmetic is shared by them.
#[derive(Clone, Copy)]
pub(super) struct Block(pub(super) [f32; Block::WIDTH]);

impl Block {
    pub(super) const WIDTH: usize = 16;

    #[inline(always)]
    fn zip(self, other: Block, f: impl Fn(f32, f32) -> f32) -> Block {
        Block(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Arithmetic for Block {
    fn constant(c: f64) -> Block {
        Block([f32::narrow(c); Block::WIDTH])
    }

    fn unary(op: UnaryOpcode, a: Block) -> Block {
        each_unary!(op, OP => Block(a.0.map(|v| f32::apply1(OP, v))))
    }

    fn binary(op: BinaryOpcode, a: Block, b: Block) -> Block {
        each_binary!(op, OP => a.zip(b, |v, w| f32::apply2(OP, v, w)))
    }
}

impl Scalar for Block {
    fn select(self, nonneg: Block, neg: Block) -> Block {
        Block(std::array::from_fn(|i| if self.0[i] >= 0.0 { nonneg.0[i] } else { neg.0[i] }))
    }

    fn if_zero(self, zero: Block, other: Block) -> Block {
        Block(std::array::from_fn(|i| if self.0[i] == 0.0 { zero.0[i] } else { other.0[i] }))
    }

    fn flat(self) -> Block {
        Block([0.0; Block::WIDTH])
    }

    fn off_the_cut(slope: Block, _y: Block, _x: Block) -> Block {
        slope
    }

    fn vanishes(self) -> bool {
        self.0.iter().all(|v| *v == 0.0)
    }
}
