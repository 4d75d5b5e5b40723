//! Values with their derivatives: what every operation of a formula does to a gradient.

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::arithmetic::{Arithmetic, Scalar};

/// A value and its derivatives along the three axes, or some of them.
#[derive(Clone, Copy)]
pub(super) struct Slope<S, const N: usize = 3> {
    pub(super) v: S,
    pub(super) d: [S; N],
}

impl<S: Scalar, const N: usize> Slope<S, N> {
    #[inline(always)]
    fn each(v: S, derivative: impl Fn(usize) -> S) -> Slope<S, N> {
        let mut d = [v; N];
        for (i, d) in d.iter_mut().enumerate() {
            *d = derivative(i);
        }
        Slope { v, d }
    }

    /// Value `v`, derivatives `k` times those of `self`.
    #[inline(always)]
    fn chain(self, v: S, k: S) -> Slope<S, N> {
        Slope::each(v, |i| times(self.d[i], k))
    }

    /// Value `v`, derivatives `a` times those of `self` plus `b` times those of `other`.
    #[inline(always)]
    fn chain2(self, other: Slope<S, N>, v: S, a: S, b: S) -> Slope<S, N> {
        Slope::each(v, |i| sum(times(self.d[i], a), times(other.d[i], b)))
    }

    /// Value `v`, the derivatives of one or the other as `choose` has it.
    #[inline(always)]
    fn either(self, other: Slope<S, N>, v: S, choose: impl Fn(S, S) -> S) -> Slope<S, N> {
        Slope::each(v, |i| choose(self.d[i], other.d[i]))
    }
}

#[inline(always)]
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
#[inline(always)]
fn times<S: Scalar>(d: S, k: S) -> S {
    if d.vanishes() { d } else { S::binary(BinaryOpcode::Mul, d, k) }
}

#[inline(always)]
fn negative<S: Scalar>(a: S) -> S {
    S::unary(UnaryOpcode::Neg, a)
}

/// `1 + k·a²`.
#[inline(always)]
fn one_and_square<S: Scalar>(a: S, k: f64) -> S {
    let square = S::unary(UnaryOpcode::Square, a);
    S::binary(BinaryOpcode::Add, S::constant(1.0), S::binary(BinaryOpcode::Mul, S::constant(k), square))
}

impl<S: Scalar, const N: usize> Arithmetic for Slope<S, N> {
    #[inline(always)]
    fn constant(c: f64) -> Slope<S, N> {
        Slope { v: S::constant(c), d: [S::constant(0.0); N] }
    }

    #[inline(always)]
    fn unary(op: UnaryOpcode, a: Slope<S, N>) -> Slope<S, N> {
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

    #[inline(always)]
    fn binary(op: BinaryOpcode, a: Slope<S, N>, b: Slope<S, N>) -> Slope<S, N> {
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
                Slope { v, d: [flat; N] }
            }
        }
    }
}
