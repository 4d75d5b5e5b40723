//! Joins in bulk: registers folded into registers, one loop per rule.

use crate::kernel::{Element, Fold, fold};

use crate::blend;
use crate::rfunction::{AlphaAnd, AssociativeAnd, ChamferedAnd, DistanceAnd, PAnd, RoundedAnd, SmoothAnd, zero_and};
use crate::{Dual, Euclid, Monotone, Norm, NormKind, Powers, Real, RicciSide, Rule, saturate};

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
    fn and<R: Real>(&self, x: R, y: R) -> R;
}

/// By a rule that rises with both operands.
struct Rising<M>(M);
struct Zero(u32);
struct Displacement {
    height: f64,
    /// `1/a₁` and `1/a₂`.
    inverse: [f64; 2],
}
struct Ricci<N> {
    norm: N,
    side: RicciSide,
    radii: [f64; 2],
    radius: f64,
}

impl<M: Monotone> Conjunction for Rising<M> {
    #[inline(always)]
    fn and<R: Real>(&self, x: R, y: R) -> R {
        saturate(x.monotone(y, &self.0))
    }
}

impl Conjunction for Zero {
    #[inline(always)]
    fn and<R: Real>(&self, x: R, y: R) -> R {
        saturate(zero_and(x, y, self.0))
    }
}

impl Conjunction for Displacement {
    #[inline(always)]
    fn and<R: Real>(&self, x: R, y: R) -> R {
        saturate(blend::displacement(x, y, self.height, self.inverse))
    }
}

impl<N: NormKind> Conjunction for Ricci<N> {
    #[inline(always)]
    fn and<R: Real>(&self, x: R, y: R) -> R {
        saturate(blend::ricci(x, y, self.norm, self.side, self.radii, self.radius))
    }
}

impl<C: Conjunction> Fold<1> for Join<C> {
    #[inline(always)]
    fn fold<R: Real>(&self, [all]: [R; 1], [next]: [R; 1]) -> [R; 1] {
        [self.conjunction.and(all * self.sign, next * self.sign_next) * self.sign]
    }
}

impl<C: Conjunction> Fold<4> for Join<C> {
    #[inline(always)]
    fn fold<R: Real>(&self, all: [R; 4], next: [R; 4]) -> [R; 4] {
        let all = Dual::new(all[0], [all[1], all[2], all[3]]) * self.sign;
        let next = Dual::new(next[0], [next[1], next[2], next[3]]) * self.sign_next;
        let joined = self.conjunction.and(all, next) * self.sign;
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
    Join<Rising<AlphaAnd>>: Fold<N>,
    Join<Rising<DistanceAnd>>: Fold<N>,
    Join<Rising<RoundedAnd>>: Fold<N>,
    Join<Rising<ChamferedAnd>>: Fold<N>,
    Join<Rising<PAnd<Euclid>>>: Fold<N>,
    Join<Rising<PAnd<Powers<false>>>>: Fold<N>,
    Join<Rising<AssociativeAnd<Powers<false>>>>: Fold<N>,
    Join<Rising<SmoothAnd>>: Fold<N>,
    Join<Zero>: Fold<N>,
    Join<Displacement>: Fold<N>,
    Join<Ricci<Euclid>>: Fold<N>,
    Join<Ricci<Powers<false>>>: Fold<N>,
{
    let sign = if op == Op::And { 1.0 } else { -1.0 };
    let sign_next = if negate { -sign } else { sign };
    let powers = |norm: Norm| Powers::<false> { p: norm.p(), inv: 1.0 / norm.p() };
    macro_rules! by {
        ($conjunction:expr) => {
            fold(&Join { conjunction: $conjunction, sign, sign_next }, all, next)
        };
    }
    match rule {
        Rule::MinMax => fold(&Least { sign, sign_next }, all, next),
        Rule::Alpha(alpha) => by!(Rising(AlphaAnd(alpha))),
        Rule::Distance => by!(Rising(DistanceAnd)),
        Rule::Rounded(radius) => by!(Rising(RoundedAnd(radius))),
        Rule::Chamfered(leg) => by!(Rising(ChamferedAnd(leg))),
        Rule::P(Norm::Euclid) => by!(Rising(PAnd(Euclid))),
        Rule::P(norm) => by!(Rising(PAnd(powers(norm)))),
        Rule::Associative(norm) => by!(Rising(AssociativeAnd(powers(norm)))),
        Rule::Smooth(width) => by!(Rising(SmoothAnd(width))),
        Rule::Zero(m) => by!(Zero(m)),
        Rule::Displacement { height, inverse } => by!(Displacement { height, inverse }),
        Rule::Ricci { p: 2.0, side, radii, radius } => by!(Ricci { norm: Euclid, side, radii, radius }),
        Rule::Ricci { p, side, radii, radius } => by!(Ricci { norm: powers(Norm::new(p)), side, radii, radius }),
    }
}
