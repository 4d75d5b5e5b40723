//! Numbers that erased leaves, deformations and joins take.
//!
//! What evaluates a graph is generic over these; the formulas behind them are compiled here, once
//! for each number.

use rvachev_num::symbol::Symbol;

use crate::{AnyField, AnyWarp, Dual, Interval, Jet, Op, Real, Rule};

/// A number that joins take.
pub trait Joined: Real {
    /// One step of a join by a rule other than min and max.
    fn joined(rule: Rule, op: Op, x: Self, y: Self) -> Self;
}

#[inline(never)]
fn and<R: Real>(rule: Rule, x: R, y: R) -> R {
    rule.and(x, y)
}

macro_rules! joined {
    ($($number:ty),*) => {$(
        impl Joined for $number {
            #[inline(never)]
            fn joined(rule: Rule, op: Op, x: Self, y: Self) -> Self {
                // By De Morgan, so that conjunctions are compiled once.
                match (rule, op) {
                    (Rule::MinMax, Op::Or) => x.max(y),
                    (_, Op::Or) => -and(rule, -x, -y),
                    (_, Op::And) => and(rule, x, y),
                }
            }
        }
    )*};
}

joined!(f64, Interval, Dual<f64>, Dual<Interval>, Jet);
joined!(Symbol<'_>);

impl Rule {
    /// One step of a join.
    #[inline(always)]
    pub fn join<N: Joined>(self, op: Op, x: N, y: N) -> N {
        match (self, op) {
            (Rule::MinMax, Op::And) => x.min(y),
            (Rule::MinMax, Op::Or) => x.max(y),
            _ => N::joined(self, op, x, y),
        }
    }
}

/// A number that erased leaves and deformations take.
pub trait Number: Joined {
    /// The value of a leaf at a point of its frame.
    fn leaf(field: &dyn AnyField, p: [Self; 3]) -> Self;
    /// A point before a deformation.
    fn warp(warp: &dyn AnyWarp, p: [Self; 3]) -> [Self; 3];
}

impl Number for f64 {
    fn leaf(field: &dyn AnyField, p: [f64; 3]) -> f64 {
        field.value(p)
    }
    fn warp(warp: &dyn AnyWarp, p: [f64; 3]) -> [f64; 3] {
        warp.point(p)
    }
}

impl Number for Dual<f64> {
    fn leaf(field: &dyn AnyField, p: [Self; 3]) -> Self {
        field.dual(p)
    }
    fn warp(warp: &dyn AnyWarp, p: [Self; 3]) -> [Self; 3] {
        warp.duals(p)
    }
}

impl Number for Dual<Interval> {
    fn leaf(field: &dyn AnyField, p: [Self; 3]) -> Self {
        field.dual_range(p)
    }
    fn warp(warp: &dyn AnyWarp, p: [Self; 3]) -> [Self; 3] {
        warp.dual_ranges(p)
    }
}

impl Number for Jet {
    fn leaf(field: &dyn AnyField, p: [Self; 3]) -> Self {
        field.jet(p)
    }
    fn warp(warp: &dyn AnyWarp, p: [Self; 3]) -> [Self; 3] {
        warp.jets(p)
    }
}

impl Number for Symbol<'_> {
    fn leaf(field: &dyn AnyField, p: [Self; 3]) -> Self {
        field.symbol(p)
    }
    fn warp(warp: &dyn AnyWarp, p: [Self; 3]) -> [Self; 3] {
        warp.symbols(p)
    }
}
