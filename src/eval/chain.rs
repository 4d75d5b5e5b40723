//! Which operands of a smooth join count over a region.
//!
//! ```text
//!     r_1 = x_1,   r_k = S(r_(k-1), x_k)         S(x, y) = max(x, y) where |x - y| >= w, and more by at most w/4
//! ```
//!
//! *Upwards.* A link x_k that is below r_(k-1) by the width changes nothing; one that is above it
//! by the width makes all before it of no account. Both are told by ranges.
//!
//! *Downwards.* Of the last r its sign is asked, so that it need be right only from n = 0 on. Where
//! r_k need be right from n on,
//!
//! ```text
//!     x_k <= n - w      does not count, and r_(k-1) need be right from n on too;
//!     x_k = n - s       from n - (sqrt w - sqrt s)^2 on, below which S(r_(k-1), x_k) is below n;
//!     x_k >= n          from x_k - w on.
//! ```
//!
//! Margins add up over those links that count. Both leave the sign as it is, to the bit, and
//! upwards every value.
//!
//! Of long joins the ranges of most operands are not even taken: those further than c are below -c.
//! They do not count where no r need be right below w - c; nor where a link that is near is above 2
//! w - c, and by the width above all before it, since, however many there are,
//!
//! ```text
//!     r_k <= max x_i + w                          as S(r, x) = r from r = x + w on
//! ```
//!
//! And where the greatest of all is below -w, the join is negative.

use std::sync::Arc;

use super::hierarchy::Hierarchy;
use super::pass::{Pass, Sign};
use super::program::{Edge, Kind};
use super::ranges::joined;
use crate::{Bounds, Interval};
use rvachev_field::{Op, Rule, VALUE_LIMIT};

/// The links of a chain that count so far, as operands of a disjunction.
struct Chain {
    width: f64,
    /// The range of what they make.
    all: Option<Interval>,
    kept: Vec<(u32, Interval)>,
    /// The greatest that any link may be, while links that are not given may be among them.
    most: Option<f64>,
}

impl Chain {
    /// Of links of which others, not given, are all below −c.
    fn new(width: f64, far: Option<f64>) -> Chain {
        let most = far.map(|c| -c);
        let all = most.map(|most| Interval::new(f64::NEG_INFINITY, most + rise(most, width)));
        Chain { width, all, kept: Vec::new(), most }
    }

    fn add(&mut self, link: u32, range: Interval) {
        let above = |a: Interval, b: Interval| a.lo() - b.hi() >= self.width;
        match self.all {
            Some(all) if above(all, range) => return,
            Some(all) if !above(range, all) => {
                let joined = Rule::Smooth(self.width).join(Op::Or, all, range);
                self.most = self.most.map(|most| most.max(range.hi()));
                let hi = self.most.map_or(joined.hi(), |most| joined.hi().max(most + rise(most, self.width)));
                self.all = Some(Interval::new(joined.lo(), hi));
            }
            _ => {
                self.kept.clear();
                self.all = Some(range);
                self.most = None;
            }
        }
        self.kept.push((link, range));
    }
}

/// Of links with their ranges, those that count where the whole need be right from `need` on, and
/// from where on what is before all of them would.
fn needed(width: f64, need: f64, links: Vec<(u32, Interval)>) -> (Vec<u32>, f64) {
    let mut from = need;
    let mut kept = Vec::with_capacity(links.len());
    for (link, range) in links.into_iter().rev() {
        let below = from - range.hi();
        if below < width {
            kept.push(link);
            let margin = if below > 0.0 { (width.sqrt() - below.sqrt()).powi(2) } else { width };
            from = from.max(range.lo()) - margin;
            from -= ROUNDING * (from.abs() + width);
        }
    }
    kept.reverse();
    (kept, from)
}

/// More than what is lost to rounding in a few operations.
const ROUNDING: f64 = 1e-14;

/// How far links of at most `most` rise together, however many: the width, and the rounding of a
/// link.
fn rise(most: f64, width: f64) -> f64 {
    width + ROUNDING * (most.abs() + width)
}

impl Pass<'_> {
    /// Which operands of a long smooth join its value, or, unless `value`, its sign is made of over
    /// a region. `None` where the sign is known.
    pub(super) fn links(&mut self, at: usize, hierarchy: &Hierarchy, region: &Bounds, value: bool) -> Option<Vec<u32>> {
        let node = &self.program.nodes[at];
        let Kind::Join { op, rule: Rule::Smooth(width), .. } = node.kind else { return Some(Vec::new()) };
        let operands = self.program.list(node);
        // Within 2 w, all that is below −w is known to be.
        let mut c = 2.0 * width;
        loop {
            let is_all = c >= VALUE_LIMIT;
            let near = if is_all { (0..node.len).collect() } else { hierarchy.near(region, c) };
            let far = (near.len() < operands.len()).then_some(c);
            let links: Vec<(u32, Interval)> = near
                .into_iter()
                .map(|link| (link, self.range_below(operands[link as usize].flip_if(op == Op::And))))
                .collect();
            if !value {
                let most =
                    links.iter().map(|(_, range)| range.hi()).fold(far.map_or(f64::NEG_INFINITY, |c| -c), f64::max);
                let sign = if most + rise(most, width) < 0.0 {
                    Sign::Negative
                } else if links.iter().any(|(_, range)| range.lo() > 0.0) {
                    Sign::Positive
                } else {
                    Sign::Unknown
                };
                if !matches!(sign, Sign::Unknown) {
                    self.signs[at] = sign.flip_if(op == Op::And);
                    return None;
                }
            }
            let mut chain = Chain::new(width, far);
            links.iter().for_each(|&(link, range)| chain.add(link, range));
            let first = chain.kept.first().map_or(f64::NEG_INFINITY, |(_, range)| range.lo());
            let (kept, from) = needed(width, if value { f64::NEG_INFINITY } else { 0.0 }, chain.kept);
            if chain.most.is_none() || from + c >= width * (1.0 + ROUNDING) {
                return Some(kept);
            }
            c = (2.0 * c).max((3.0 * width - first).min(width - from));
        }
    }

    /// A smooth join over the region: of the operands that count.
    pub(super) fn chain(&mut self, at: usize, near: Option<&[u32]>, value: bool) {
        let node = &self.program.nodes[at];
        let Kind::Join { op, rule: Rule::Smooth(width), frame, hierarchy } = &node.kind else { return };
        let operands = self.program.list(node);
        let flip = *op == Op::And;
        let mut chain = Chain::new(*width, None);
        let mut add = |link: u32| {
            if let Some((range, _)) = self.value(operands[link as usize].flip_if(flip)) {
                chain.add(link, range);
            }
        };
        match near {
            Some(near) => near.iter().for_each(|&link| add(link)),
            None => (0..node.len).for_each(add),
        }
        let Chain { all, kept, .. } = chain;
        let (kept, _) = needed(*width, if value { f64::NEG_INFINITY } else { 0.0 }, kept);
        let edges: Vec<Edge> = kept.iter().filter_map(|&link| Some(self.value(operands[link as usize])?.1)).collect();
        let hierarchy = match hierarchy {
            Some(all) if kept.len() == operands.len() => Some(all.clone()),
            Some(all) => all.subset(&kept).map(Arc::new),
            None => None,
        };
        if edges.is_empty() {
            self.signs[at] = Sign::Negative.flip_if(flip);
            return;
        }
        let edge = self.push(&Kind::Join { op: *op, rule: Rule::Smooth(*width), frame: *frame, hierarchy }, edges);
        let range = all.unwrap_or(Interval::ALL);
        self.know(at, if flip { -range } else { range }, edge);
    }

    /// The range of what an edge leads to, whatever else is asked.
    fn range_below(&mut self, edge: Edge) -> Interval {
        self.ranges.resize(self.program.nodes.len(), None);
        if let (Kind::Leaf(leaf), None) = (&self.program.nodes[edge.node()].kind, self.ranges[edge.node()]) {
            self.ranges[edge.node()] = Some(self.program.leaf_range(*leaf, self.zones, self.world));
        }
        let mut pending = if self.ranges[edge.node()].is_none() { vec![edge.node()] } else { Vec::new() };
        while let Some(&at) = pending.last() {
            let node = &self.program.nodes[at];
            let before = pending.len();
            if self.ranges[at].is_none() {
                let operands = self.program.list(node);
                pending.extend(operands.iter().map(|edge| edge.node()).filter(|&below| self.ranges[below].is_none()));
                if pending.len() == before {
                    let of = |edge: &Edge| {
                        let range = self.ranges[edge.node()].unwrap_or(Interval::ALL);
                        if edge.negated() { -range } else { range }
                    };
                    self.ranges[at] = Some(match &node.kind {
                        Kind::Leaf(leaf) => self.program.leaf_range(*leaf, self.zones, self.world),
                        kind => joined(kind, operands.iter().map(of)),
                    });
                }
            }
            if pending.len() == before {
                pending.pop();
            }
        }
        let range = self.ranges[edge.node()].unwrap_or(Interval::ALL);
        if edge.negated() { -range } else { range }
    }
}
