//! Ranges and narrowing.
//!
//! Where an operand of an R-function has one sign throughout a region, the operation has the
//! sign and the zero set of the other operand there, or no surface at all (MATHEMATICS E,
//! sign-pruning lemma). Ranges are taken leaf by leaf over the region as it looks in the
//! leaf's frame.

use std::sync::Arc;

use super::program::{Edge, Node, Op, Program, Region};
use crate::field::{Pieces, Zone};
use crate::{Bounds, Interval};

/// What is known of a node over a region.
#[derive(Clone, Copy)]
enum Sign {
    /// Not asked for.
    Unknown,
    Positive,
    Negative,
    /// Open; the edge is that of the narrowed program.
    Open(Edge),
}

impl Sign {
    fn of(range: Interval, open: impl FnOnce() -> Edge) -> Sign {
        if range.lo() > 0.0 {
            Sign::Positive
        } else if range.hi() < 0.0 {
            Sign::Negative
        } else {
            Sign::Open(open())
        }
    }

    fn flip_if(self, negate: bool) -> Sign {
        match (self, negate) {
            (Sign::Positive, true) => Sign::Negative,
            (Sign::Negative, true) => Sign::Positive,
            (Sign::Open(edge), _) => Sign::Open(edge.flip_if(negate)),
            (sign, _) => sign,
        }
    }
}

impl Program {
    /// What `region` holds of the solid: nothing but inside, nothing but outside, or perhaps
    /// the surface, with a program of the leaves that matter there. The region must be
    /// finite; an infinite one is not narrowed.
    ///
    /// Sound: the answer holds at every point, and at every point the narrowed program has
    /// the sign of the full one.
    #[must_use]
    pub fn narrow(&self, region: &Bounds) -> Region {
        if !region.is_finite() || region.is_empty() {
            return Region::Surface(self.clone());
        }
        self.narrow_zone(&Zone::of_bounds(region))
    }

    /// A sound range of the value over a box; infinite where nothing is known.
    #[must_use]
    pub fn range(&self, region: &Bounds) -> Interval {
        if !region.is_finite() || region.is_empty() {
            return Interval::ALL;
        }
        self.range_zone(&Zone::of_bounds(region))
    }

    /// The world's zone seen from every live frame.
    fn zones(&self, world: &Pieces) -> Vec<Pieces> {
        let mut zones = Vec::with_capacity(self.frames.len());
        for &number in &self.frames[..] {
            if let Some(frame) = self.scene.frame(number) {
                let above = self.zone_in(&zones, frame.parent, world);
                zones.push(above.through(&frame.to_local, &*frame.warp));
            }
        }
        zones
    }

    /// The zone in a frame, given those of the live frames before it.
    fn zone_in<'a>(&self, zones: &'a [Pieces], frame: u32, world: &'a Pieces) -> &'a Pieces {
        self.frames.binary_search(&frame).map_or(world, |slot| &zones[slot])
    }

    fn leaf_range(&self, leaf: u32, zones: &[Pieces], world: &Pieces) -> Interval {
        let instance = &self.scene.leaves[leaf as usize];
        let zone = self.zone_in(zones, instance.frame, world);
        zone.range(&instance.to_local, |zone| instance.field.range(zone)) * Interval::point(instance.scale)
    }

    pub(crate) fn range_zone(&self, world: &Zone) -> Interval {
        let world = &Pieces::one(*world);
        let zones = self.zones(world);
        let mut ranges: Vec<Interval> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes[..] {
            let range = match node {
                Node::Leaf(leaf) => self.leaf_range(*leaf, &zones, world),
                Node::Join { op, rule, first, len, .. } => {
                    let operand = |edge: &Edge| {
                        let range = ranges[edge.node()];
                        if edge.negated() { -range } else { range }
                    };
                    let operands = self.list(*first, *len).iter().map(operand);
                    operands.reduce(|all, next| rule.join(*op, all, next)).unwrap_or(Interval::ALL)
                }
            };
            ranges.push(range);
        }
        let range = ranges[self.root.node()];
        if self.root.negated() { -range } else { range }
    }

    pub(crate) fn narrow_zone(&self, world: &Zone) -> Region {
        let world = &Pieces::one(*world);
        let zones = self.zones(world);
        let count = self.nodes.len();
        // Down: which nodes are asked for, and which operands of long joins are near.
        let mut asked = vec![false; count];
        let mut near: Vec<Option<Vec<u32>>> = Vec::new();
        asked[self.root.node()] = true;
        for at in (0..count).rev() {
            let mut close = None;
            if let (true, Node::Join { first, len, frame, hierarchy, .. }) = (asked[at], &self.nodes[at]) {
                let operands = self.list(*first, *len);
                if let Some(hierarchy) = hierarchy {
                    let mut region = Bounds::EMPTY;
                    self.zone_in(&zones, *frame, world).each(|zone| region = region.union(&hull_of(zone)));
                    let mut list = Vec::new();
                    hierarchy.visit(&region, |operand| list.push(operand as u32));
                    for &operand in &list {
                        asked[operands[operand as usize].node()] = true;
                    }
                    close = Some(list);
                } else {
                    for edge in operands {
                        asked[edge.node()] = true;
                    }
                }
            }
            near.push(close);
        }
        near.reverse();
        // Up: signs, and the program of what stays open.
        let mut signs = vec![Sign::Unknown; count];
        let mut nodes: Vec<Node> = Vec::new();
        let mut list: Vec<Edge> = Vec::new();
        for at in 0..count {
            if !asked[at] {
                continue;
            }
            signs[at] = match &self.nodes[at] {
                Node::Leaf(leaf) => {
                    let instance = &self.scene.leaves[*leaf as usize];
                    let zone = self.zone_in(&zones, instance.frame, world);
                    if !zone.any(|zone| instance.bounds.intersects(&hull_of(zone))) {
                        Sign::Negative
                    } else {
                        Sign::of(self.leaf_range(*leaf, &zones, world), || {
                            nodes.push(Node::Leaf(*leaf));
                            Edge::new(nodes.len() - 1)
                        })
                    }
                }
                Node::Join { .. } => self.narrow_join(at, near[at].as_deref(), &signs, &mut nodes, &mut list),
            };
        }
        match signs[self.root.node()].flip_if(self.root.negated()) {
            Sign::Positive => Region::Inside,
            Sign::Negative => Region::Outside,
            Sign::Unknown => Region::Surface(self.clone()),
            Sign::Open(root) => Region::Surface(self.trimmed(nodes, list, root)),
        }
    }

    fn narrow_join(
        &self,
        at: usize,
        near: Option<&[u32]>,
        signs: &[Sign],
        nodes: &mut Vec<Node>,
        list: &mut Vec<Edge>,
    ) -> Sign {
        let Node::Join { op, rule, first, len, frame, hierarchy } = &self.nodes[at] else {
            return Sign::Unknown;
        };
        let operands = self.list(*first, *len);
        let start = list.len();
        let mut kept: Vec<u32> = Vec::new();
        let everything: Vec<u32>;
        let candidates = match near {
            Some(near) => near,
            None => {
                everything = (0..*len).collect();
                &everything
            }
        };
        for &operand in candidates {
            let edge = operands[operand as usize];
            match (signs[edge.node()].flip_if(edge.negated()), op) {
                (Sign::Positive, Op::Or) => {
                    list.truncate(start);
                    return Sign::Positive;
                }
                (Sign::Negative, Op::And) => {
                    list.truncate(start);
                    return Sign::Negative;
                }
                (Sign::Open(edge), _) => {
                    list.push(edge);
                    kept.push(operand);
                }
                // The neutral element.
                _ => {}
            }
        }
        match list.len() - start {
            0 if *op == Op::Or => Sign::Negative,
            0 => Sign::Positive,
            1 => {
                let only = list[start];
                list.truncate(start);
                Sign::Open(only)
            }
            open => {
                let hierarchy = match hierarchy {
                    Some(all) if open == operands.len() => Some(all.clone()),
                    Some(all) => all.subset(&kept).map(Arc::new),
                    None => None,
                };
                nodes.push(Node::Join {
                    op: *op,
                    rule: *rule,
                    first: start as u32,
                    len: open as u32,
                    frame: *frame,
                    hierarchy,
                });
                Sign::Open(Edge::new(nodes.len() - 1))
            }
        }
    }

    /// A program of the nodes that `root` reaches.
    fn trimmed(&self, nodes: Vec<Node>, operands: Vec<Edge>, root: Edge) -> Program {
        if nodes.len() == 1 {
            return Program::assemble(self.scene.clone(), nodes, Vec::new(), root);
        }
        let mut reached = vec![false; nodes.len()];
        reached[root.node()] = true;
        for at in (0..nodes.len()).rev() {
            if let (true, Node::Join { first, len, .. }) = (reached[at], &nodes[at]) {
                for edge in &operands[*first as usize..(first + len) as usize] {
                    reached[edge.node()] = true;
                }
            }
        }
        let mut moved = vec![0; nodes.len()];
        let mut kept = Vec::new();
        let mut list = Vec::new();
        for (at, mut node) in nodes.into_iter().enumerate() {
            if !reached[at] {
                continue;
            }
            if let Node::Join { first, len, .. } = &mut node {
                let old = *first as usize..(*first + *len) as usize;
                *first = list.len() as u32;
                list.extend(operands[old].iter().map(|edge| edge.to(moved[edge.node()])));
            }
            moved[at] = kept.len();
            kept.push(node);
        }
        Program::assemble(self.scene.clone(), kept, list, root.to(moved[root.node()]))
    }
}

/// The zone's hull as a box, a hair larger, so that what only touches it counts as met.
fn hull_of(zone: &Zone) -> Bounds {
    let hull = zone.hull();
    let low = glam::DVec3::from_array(hull.map(Interval::lo));
    let high = glam::DVec3::from_array(hull.map(Interval::hi));
    let margin = 1e-9 * (high - low).length() + 1e-13 * (low.abs() + high.abs()).element_sum();
    let margin = if margin.is_finite() { margin } else { 0.0 };
    Bounds::new(low - margin, high + margin)
}
