//! Where a solid's true value is above −c: boxes around more than what is inside.
//!
//! ```text
//!     f > −c   ⇒   M > −(s c + r)         M the greatest of the members' values
//! ```
//!
//! Members are what a tree of joins is made of: at last its leaves. The spread s is 1 for min, max
//! and smooth joins, and what an R-function makes of equal values. The rise r is what smooth joins
//! add. It is no sum along a chain: where no member is above −r, operands that rise by r_a and r_b
//! are below −(r − r_a)/s and −(r − r_b)/s, and their smooth union of width k is below 0 if
//!
//! ```text
//!     r ≥ S(r_a, r_b)     S the smooth maximum of width s k
//! ```
//!
//! A chain of any length rises by less than its width, since S(r, 0) = r from r = k on.

use glam::DVec3;

use super::code::{grow, snug};
use super::hierarchy::Reach;
use crate::Bounds;
use rvachev_field::{Op, Rule};

/// How a box of what is inside swells with c.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swell {
    /// A box around what is inside some member (or, of an intersection, inside each).
    pub(super) core: Bounds,
    /// How much the core grows along each axis, per unit of the members' values; infinite where
    /// nothing is known.
    growth: DVec3,
    spread: f64,
    rise: f64,
}

impl Swell {
    /// Of a node that is its own only member, its box growing by `growth` per unit of its value.
    pub(super) fn of(core: Bounds, growth: DVec3) -> Swell {
        Swell { core, growth, spread: 1.0, rise: 0.0 }
    }

    /// Of a node about which nothing more is known.
    pub(super) fn unknown(core: Bounds) -> Swell {
        Swell::of(core, DVec3::INFINITY)
    }

    /// Of an operation by a rule, on operands that have been complemented where it is a difference.
    pub(super) fn joined(op: Op, rule: Rule, operands: Vec<Swell>) -> Swell {
        let boxes = operands.iter().map(|operand| operand.core);
        let core = match op {
            Op::Or => boxes.fold(Bounds::EMPTY, |all, own| all.union(&own)),
            Op::And => boxes.fold(Bounds::ALL, |all, own| all.intersection(&own)),
        };
        let growth = operands.iter().fold(DVec3::ZERO, |most, operand| most.max(operand.bounded()));
        // Boxes that grow until they meet have more in common than what they had grows to.
        let growth = if core.is_empty() { DVec3::INFINITY } else { growth };
        let laws = operands.iter().map(|operand| (operand.spread, operand.rise)).collect();
        let (spread, rise) = match op {
            Op::Or => balanced(laws, |a, b| either(rule, a, b)),
            Op::And => balanced(laws, |a, b| both(rule, a, b)),
        };
        Swell { core, growth, spread, rise }
    }

    /// Of an end face and sides, moved in and back: `inside` is the box of what they have in
    /// common.
    pub(super) fn rim(inside: Bounds, pair: [Swell; 2]) -> Swell {
        let growth = |own: Swell| own.grown(own.spread);
        let growth = if inside.is_empty() { DVec3::INFINITY } else { growth(pair[0]).max(growth(pair[1])) };
        Swell::of(inside, growth)
    }

    /// Of the values moved by `by`.
    pub(super) fn level(self, by: f64) -> Swell {
        if by > 0.0 { Swell { rise: self.reach(by), ..self } } else { self }
    }

    /// Of what it becomes by a deformation that maps boxes by `image`.
    pub(super) fn mapped(self, image: impl FnOnce(&Bounds) -> Bounds) -> Swell {
        Swell { core: image(&self.core), growth: DVec3::INFINITY, ..self }
    }

    /// Where the value is above −c ≤ 0, some member's is above this with the other sign.
    pub(super) fn reach(&self, c: f64) -> f64 {
        if c > 0.0 { self.spread * c + self.rise } else { self.rise }
    }

    /// The box of where some member's value is above `-reach`, if it is known.
    pub(super) fn members(&self, reach: f64) -> Option<Bounds> {
        let by = self.grown(reach);
        by.is_finite().then(|| grow(&self.core, by))
    }

    /// The box of where the value is above −c < 0, if it is known.
    pub(super) fn above(&self, c: f64) -> Option<Bounds> {
        self.members(self.reach(c))
    }

    /// Where the value is above −c, for every c.
    pub(super) fn reaching(&self) -> Reach {
        let (bounds, growth) = (self.members(self.rise).map(snug), self.grown(self.spread));
        match bounds {
            Some(bounds) if growth.is_finite() => Reach { bounds, growth },
            _ => Reach::fixed(Bounds::ALL),
        }
    }

    fn grown(&self, reach: f64) -> DVec3 {
        // A node without an end along an axis needs none there, however flat the rule.
        DVec3::from_array(self.bounded().to_array().map(|growth| if growth == 0.0 { 0.0 } else { growth * reach }))
    }

    /// The growth along the axes where there is an end.
    fn bounded(&self) -> DVec3 {
        let is_open = self.core.min.cmpeq(DVec3::NEG_INFINITY) & self.core.max.cmpeq(DVec3::INFINITY);
        DVec3::select(is_open, DVec3::ZERO, self.growth)
    }
}

/// What operands' spreads and rises make together, joined as many operands are.
fn balanced(mut laws: Vec<(f64, f64)>, join: impl Fn((f64, f64), (f64, f64)) -> (f64, f64)) -> (f64, f64) {
    while laws.len() > 1 {
        laws = laws.chunks(2).map(|pair| if let [a, b] = *pair { join(a, b) } else { pair[0] }).collect();
    }
    laws.pop().unwrap_or((1.0, 0.0))
}

/// Spread and rise of a disjunction.
fn either(rule: Rule, a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (spread, rise) = (a.0.max(b.0), a.1.max(b.1));
    match rule {
        Rule::MinMax | Rule::Distance => (spread, rise),
        Rule::Smooth(width) => {
            let width = spread * width;
            let overlap = (width - (a.1 - b.1).abs()).max(0.0);
            (spread, if width.is_finite() { rise + 0.25 * overlap * overlap / width } else { f64::INFINITY })
        }
        // Homogeneous of degree 1.
        Rule::Alpha(_) | Rule::P(_) | Rule::Associative(_) => (1.0 / rule.and(1.0 / a.0, 1.0 / b.0), rise),
        _ => (f64::INFINITY, rise),
    }
}

/// Spread and rise of a conjunction: none exceeds its least operand, but those that are flattened
/// near 0.
fn both(rule: Rule, a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let spread = if matches!(rule, Rule::Zero(_)) { f64::INFINITY } else { a.0.max(b.0) };
    (spread, a.1.max(b.1))
}
