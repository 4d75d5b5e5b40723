//! Values with their derivatives: what every operation of a formula does to a gradient.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::{Arithmetic, Scalar};

/// A value and its derivatives along the three axes.
#[derive(Clone, Copy)]
pub(super) struct Slope<S> {
    pub(super) v: S,
    pub(super) d: [S; 3],
}

impl<S: Scalar> Slope<S> {
    /// Value `v`, derivatives `k` times those of `self`.
    fn chain(self, v: S, k: S) -> Slope<S> {
        Slope { v, d: self.d.map(|d| times(d, k)) }
    }

    /// Value `v`, derivatives `a` times those of `self` plus `b` times those of `other`.
    fn chain2(self, other: Slope<S>, v: S, a: S, b: S) -> Slope<S> {
        Slope { v, d: std::array::from_fn(|i| sum(times(self.d[i], a), times(other.d[i], b))) }
    }

    /// Value `v`, the derivatives of one or the other as `choose` has it.
    fn either(self, other: Slope<S>, v: S, choose: impl Fn(S, S) -> S) -> Slope<S> {
        Slope { v, d: std::array::from_fn(|i| choose(self.d[i], other.d[i])) }
    }
}

fn sum<S: Scalar>(a: S, b: S) -> S {
    if a.vanishes() {
        b
    } else if b.vanishes() {
        a
    } else {
        S::binary(BinaryOpcode::Add, a, b)
    }
}

/// What does not move a value does not move its function, however steep that is.
fn times<S: Scalar>(d: S, k: S) -> S {
    if d.vanishes() { d } else { S::binary(BinaryOpcode::Mul, d, k) }
}

fn negative<S: Scalar>(a: S) -> S {
    S::unary(UnaryOpcode::Neg, a)
}

/// `1 + k·a²`.
fn one_and_square<S: Scalar>(a: S, k: f64) -> S {
    let square = S::unary(UnaryOpcode::Square, a);
    S::binary(BinaryOpcode::Add, S::constant(1.0), S::binary(BinaryOpcode::Mul, S::constant(k), square))
}

impl<S: Scalar> Arithmetic for Slope<S> {
    fn constant(c: f64) -> Slope<S> {
        Slope { v: S::constant(c), d: [S::constant(0.0); 3] }
    }

    fn unary(op: UnaryOpcode, a: Slope<S>) -> Slope<S> {
        use UnaryOpcode as U;
        let v = S::unary(op, a.v);
        let one = S::constant(1.0);
        let inverse_root = |s: S| S::unary(U::Recip, S::unary(U::Sqrt, s));
        let k = match op {
            U::Neg => S::constant(-1.0),
            U::Abs => a.v.select(one, S::constant(-1.0)),
            U::Recip => negative(S::unary(U::Square, v)),
            U::Sqrt => S::binary(BinaryOpcode::Div, S::constant(0.5), v),
            U::Square => S::binary(BinaryOpcode::Mul, S::constant(2.0), a.v),
            U::Floor | U::Ceil | U::Round | U::Not | U::Rand => v.flat(),
            U::Sin => S::unary(U::Cos, a.v),
            U::Cos => negative(S::unary(U::Sin, a.v)),
            U::Tan => one_and_square(v, 1.0),
            U::Asin => inverse_root(one_and_square(a.v, -1.0)),
            U::Acos => negative(inverse_root(one_and_square(a.v, -1.0))),
            U::Atan => S::unary(U::Recip, one_and_square(a.v, 1.0)),
            U::Exp => v,
            U::Ln => S::unary(U::Recip, a.v),
        };
        a.chain(v, k)
    }

    fn binary(op: BinaryOpcode, a: Slope<S>, b: Slope<S>) -> Slope<S> {
        use BinaryOpcode as B;
        let v = S::binary(op, a.v, b.v);
        let one = S::constant(1.0);
        match op {
            B::Add => a.chain2(b, v, one, one),
            B::Sub => a.chain2(b, v, one, S::constant(-1.0)),
            B::Mul => a.chain2(b, v, b.v, a.v),
            B::Div => {
                let inverse = S::unary(UnaryOpcode::Recip, b.v);
                a.chain2(b, v, inverse, negative(S::binary(B::Mul, v, inverse)))
            }
            B::Atan => {
                let square = |s: S| S::unary(UnaryOpcode::Square, s);
                let squared = S::binary(B::Add, square(a.v), square(b.v));
                let ka = S::off_the_cut(S::binary(B::Div, b.v, squared), a.v, b.v);
                let kb = S::off_the_cut(negative(S::binary(B::Div, a.v, squared)), a.v, b.v);
                a.chain2(b, v, ka, kb)
            }
            B::Min => {
                let by = S::binary(B::Sub, b.v, a.v);
                a.either(b, v, |x, y| by.select(x, y))
            }
            B::Max => {
                let by = S::binary(B::Sub, a.v, b.v);
                a.either(b, v, |x, y| by.select(x, y))
            }
            B::Mod => {
                // The remainder is a − |b|·steps.
                let size = S::unary(UnaryOpcode::Abs, b.v);
                let steps = S::unary(UnaryOpcode::Floor, S::binary(B::Div, a.v, size));
                let jump = steps.flat();
                let slope = a.chain2(b, v, one, b.v.select(negative(steps), steps));
                // `flat` is 0 where nothing jumps.
                slope.either(a, v, |d, _| sum(d, jump))
            }
            B::And => a.either(b, v, |x, y| a.v.if_zero(x, y)),
            B::Or => a.either(b, v, |x, y| a.v.if_zero(y, x)),
            B::Compare | B::Mix => {
                let flat = v.flat();
                Slope { v, d: [flat; 3] }
            }
        }
    }
}
