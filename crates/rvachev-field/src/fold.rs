//! Joins in bulk: registers folded into registers, one loop per rule.

use rvachev_num::kernel::{Element, Fold, fold};

use crate::{Dual, Norm, Real, RicciSide, Rule};

/// Conjunction or disjunction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// What is within both operands.
    And,
    /// What is within one of them.
    Or,
}

impl Op {
    /// What this is to operands and result that are all negated (De Morgan).
    #[must_use]
    pub fn flip_if(self, negate: bool) -> Op {
        match (self, negate) {
            (Op::And, false) | (Op::Or, true) => Op::And,
            (Op::Or, false) | (Op::And, true) => Op::Or,
        }
    }
}

/// One step of a join, on numbers or on values with their derivatives: a conjunction, with
/// signs before and after that make it any of union, intersection and difference.
struct Join<C> {
    conjunction: C,
    /// −1 for a disjunction.
    sign: f64,
    /// The same for the operand that is joined; turned once more if it is negated.
    sign_next: f64,
}

/// A conjunction whose rule is known when the kernel is compiled.
trait Conjunction {
    fn rule(&self) -> Rule;
}

struct Alpha(f64);
struct Zero(u32);
struct Distance;
struct Euclid;
struct P {
    p: f64,
    inv: f64,
}
struct Associative {
    p: f64,
    inv: f64,
}

struct Smooth(f64);
struct Displacement {
    height: f64,
    inverse: [f64; 2],
}
struct Ricci {
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
struct Least {
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

/// Elements that are joined in bulk, `N` numbers a point: values, or values with their derivatives.
pub trait Joinable<const N: usize>: Element {
    /// Joins `next`, or its negative, to `all`.
    fn join(op: Op, rule: Rule, negate: bool, all: [&mut [Self]; N], next: [&[Self]; N]);
}

macro_rules! joinable {
    ($($element:ty, $n:literal;)*) => {$(
        impl Joinable<$n> for $element {
            #[inline(never)]
            fn join(op: Op, rule: Rule, negate: bool, all: [&mut [Self]; $n], next: [&[Self]; $n]) {
                fold_by_rule(op, rule, negate, all, next);
            }
        }
    )*};
}

joinable! {
    f32, 1;
    f64, 1;
    f32, 4;
}

#[inline(always)]
fn fold_by_rule<E: Element, const N: usize>(op: Op, rule: Rule, negate: bool, all: [&mut [E]; N], next: [&[E]; N])
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
