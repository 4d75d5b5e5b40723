//! Joins in bulk: registers folded into registers, one loop per rule.

use super::program::Op;
use crate::field::{RicciSide, Rule};
use crate::num::kernel::{Element, Fold, fold};
use crate::{Dual, Norm, Real};

/// One step of a join, on numbers or on values with their derivatives: a conjunction, with
/// signs before and after that make it any of union, intersection and difference.
pub(super) struct Join<C> {
    conjunction: C,
    /// −1 for a disjunction.
    sign: f64,
    /// The same for the operand that is joined; turned once more if it is negated.
    sign_next: f64,
}

/// A conjunction whose rule is known when the kernel is compiled.
pub(super) trait Conjunction {
    fn rule(&self) -> Rule;
}

pub(super) struct Alpha(f64);
pub(super) struct Zero(u32);
pub(super) struct Distance;
pub(super) struct Euclid;
pub(super) struct P {
    p: f64,
    inv: f64,
}
pub(super) struct Associative {
    p: f64,
    inv: f64,
}

pub(super) struct Smooth(f64);
pub(super) struct Displacement {
    height: f64,
    inverse: [f64; 2],
}
pub(super) struct Ricci {
    p: f64,
    side: RicciSide,
    radii: [f64; 2],
    radius: f64,
}

/// Says which rule a conjunction is.
macro_rules! conjunction {
    ($($name:ty: $self:ident => $rule:expr;)*) => {$(
        impl Conjunction for $name {
            #[inline(always)]
            fn rule(&$self) -> Rule {
                $rule
            }
        }
    )*};
}

conjunction! {
    Alpha: self => Rule::Alpha(self.0);
    Zero: self => Rule::Zero(self.0);
    Distance: self => Rule::Distance;
    Euclid: self => Rule::P(Norm::Euclid);
    P: self => Rule::P(Norm::P { p: self.p, inv: self.inv });
    Associative: self => Rule::Associative(Norm::P { p: self.p, inv: self.inv });
    Smooth: self => Rule::Smooth(self.0);
    Displacement: self => Rule::Displacement { height: self.height, inverse: self.inverse };
    Ricci: self => Rule::Ricci { p: self.p, side: self.side, radii: self.radii, radius: self.radius };
}

impl<C: Conjunction> Fold<1> for Join<C> {
    #[inline(always)]
    fn fold<R: Real>(&self, [all]: [R; 1], [next]: [R; 1]) -> [R; 1] {
        [self.conjunction.rule().and(all * self.sign, next * self.sign_next) * self.sign]
    }
}

impl<C: Conjunction> Fold<4> for Join<C> {
    #[inline(always)]
    fn fold<R: Real>(&self, all: [R; 4], next: [R; 4]) -> [R; 4] {
        let all = Dual::new(all[0], [all[1], all[2], all[3]]) * self.sign;
        let next = Dual::new(next[0], [next[1], next[2], next[3]]) * self.sign_next;
        let joined = self.conjunction.rule().and(all, next) * self.sign;
        [joined.v, joined.d[0], joined.d[1], joined.d[2]]
    }
}

/// Min, with signs before and after: what most joins of a surface program are.
pub(super) struct Least {
    sign: f64,
    sign_next: f64,
}

impl Fold<1> for Least {
    #[inline(always)]
    fn fold<R: Real>(&self, [all]: [R; 1], [next]: [R; 1]) -> [R; 1] {
        [(all * self.sign).min(next * self.sign_next) * self.sign]
    }
}

impl Fold<4> for Least {
    #[inline(always)]
    fn fold<R: Real>(&self, all: [R; 4], next: [R; 4]) -> [R; 4] {
        // What is taken over keeps its own sign, or that of the joined operand.
        let turn = self.sign * self.sign_next;
        let stays = next[0] * self.sign_next - all[0] * self.sign;
        [
            stays.select(all[0], next[0] * turn),
            stays.select(all[1], next[1] * turn),
            stays.select(all[2], next[2] * turn),
            stays.select(all[3], next[3] * turn),
        ]
    }
}

/// Joins `next`, or its negative, to `all`.
pub(super) fn join<E: Element, const N: usize>(op: Op, rule: Rule, negate: bool, all: [&mut [E]; N], next: [&[E]; N])
where
    Least: Fold<N>,
    Join<Alpha>: Fold<N>,
    Join<Zero>: Fold<N>,
    Join<Distance>: Fold<N>,
    Join<Euclid>: Fold<N>,
    Join<P>: Fold<N>,
    Join<Associative>: Fold<N>,
    Join<Smooth>: Fold<N>,
    Join<Displacement>: Fold<N>,
    Join<Ricci>: Fold<N>,
{
    let sign = if op == Op::And { 1.0 } else { -1.0 };
    let sign_next = if negate { -sign } else { sign };
    match rule {
        Rule::MinMax => fold(&Least { sign, sign_next }, all, next),
        Rule::Alpha(alpha) => fold(&Join { conjunction: Alpha(alpha), sign, sign_next }, all, next),
        Rule::Zero(m) => fold(&Join { conjunction: Zero(m), sign, sign_next }, all, next),
        Rule::Distance => fold(&Join { conjunction: Distance, sign, sign_next }, all, next),
        Rule::P(Norm::Euclid) => fold(&Join { conjunction: Euclid, sign, sign_next }, all, next),
        Rule::P(norm) => {
            fold(&Join { conjunction: P { p: norm.p(), inv: 1.0 / norm.p() }, sign, sign_next }, all, next)
        }
        Rule::Associative(norm) => {
            fold(&Join { conjunction: Associative { p: norm.p(), inv: 1.0 / norm.p() }, sign, sign_next }, all, next)
        }
        Rule::Smooth(width) => fold(&Join { conjunction: Smooth(width), sign, sign_next }, all, next),
        Rule::Displacement { height, inverse } => {
            fold(&Join { conjunction: Displacement { height, inverse }, sign, sign_next }, all, next)
        }
        Rule::Ricci { p, side, radii, radius } => {
            fold(&Join { conjunction: Ricci { p, side, radii, radius }, sign, sign_next }, all, next)
        }
    }
}
