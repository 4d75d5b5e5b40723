//! How much each leaf has of a point's value.

use glam::DVec3;

use super::program::{Kind, Program};
use crate::Dual;
use rvachev_field::{Op, Rule};

/// Smaller shares cannot be seen.
pub(super) const LEAST: f64 = 1e-3;

impl Program {
    /// The leaves that a point's value is made of, with their shares.
    pub(super) fn shares(&self, p: DVec3) -> Vec<(u32, f64)> {
        let values = self.node_values(p);
        let mut shares = Vec::new();
        let mut pending = vec![(self.root.node(), 1.0)];
        while let Some((at, share)) = pending.pop() {
            if share < LEAST {
                continue;
            }
            let node = &self.nodes[at];
            let operands = self.list(node);
            let value = |i: usize| {
                let edge = operands[i];
                if edge.negated() { -values[edge.node()] } else { values[edge.node()] }
            };
            let weights: Vec<f64> = match &node.kind {
                Kind::Leaf(leaf) => {
                    shares.push((self.instance(*leaf).number, share));
                    continue;
                }
                Kind::Shift(_) => vec![1.0],
                Kind::Join { op, rule: Rule::MinMax, .. } => chosen(*op, operands.len(), value),
                Kind::Join { op, rule, .. } => slopes(*op, *rule, operands.len(), value),
            };
            let sum: f64 = weights.iter().sum();
            if sum > 0.0 && sum.is_finite() {
                pending.extend(operands.iter().zip(weights).map(|(edge, w)| (edge.node(), share * w / sum)));
            }
        }
        shares
    }
}

/// 1 for the operand that decides, 0 for the others.
fn chosen(op: Op, count: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut best = 0;
    for i in 1..count {
        let better = match op {
            Op::Or => value(i) > value(best),
            Op::And => value(i) < value(best),
        };
        if better {
            best = i;
        }
    }
    (0..count).map(|i| f64::from(u8::from(i == best))).collect()
}

/// How a join's value changes with those of its operands, as far as it rises with them.
fn slopes(op: Op, rule: Rule, count: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut weights = vec![1.0];
    let mut all = value(0);
    for i in 1..count {
        let joined = rule.join(op, Dual::new(all, [1.0, 0.0, 0.0]), Dual::new(value(i), [0.0, 1.0, 0.0]));
        let [of_all, of_next, _] = joined.d;
        for weight in &mut weights {
            *weight *= of_all.max(0.0);
        }
        weights.push(of_next.max(0.0));
        all = joined.v;
    }
    weights
}
