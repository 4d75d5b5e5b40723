//! One narrowing: down, what is asked of the nodes of a program; up, what is known of them over a
//! region, and the program of what stays open.

use std::f64::consts::SQRT_2;
use std::sync::Arc;

use super::partial::Given;
use super::program::{Edge, Kind, Node, Program};
use super::ranges::{hull_of, joined};
use super::scene::Instance;
use crate::{Bounds, Interval};
use rvachev_field::Op;
use rvachev_field::{Pieces, Rule, Zone};

/// What is known of a node over a region.
#[derive(Clone, Copy)]
pub(super) enum Sign {
    /// Not asked for.
    Unknown,
    Positive,
    Negative,
    /// Open; the edge is that of the narrowed program.
    Open(Edge),
}

impl Sign {
    pub(super) fn of(range: Interval, open: impl FnOnce() -> Edge) -> Sign {
        if range.lo() > 0.0 {
            Sign::Positive
        } else if range.hi() < 0.0 {
            Sign::Negative
        } else {
            Sign::Open(open())
        }
    }

    pub(super) fn flip_if(self, negate: bool) -> Sign {
        match (self, negate) {
            (Sign::Positive, true) => Sign::Negative,
            (Sign::Negative, true) => Sign::Positive,
            (Sign::Open(edge), _) => Sign::Open(edge.flip_if(negate)),
            (sign, _) => sign,
        }
    }
}

/// What is asked about a node: its sign, or, below what reads values, its value.
#[derive(Clone, Copy, Default)]
pub(super) struct Asked {
    pub(super) sign: bool,
    pub(super) value: bool,
}

/// What is kept of most programs: lists have room for as many from the start.
const FEW: usize = 32;

/// What is left of a join is scanned if it is shorter: its boxes would take three times the memory
/// of the rest.
const LONG: usize = 32;

/// One narrowing under way.
pub(super) struct Pass<'a> {
    pub(super) program: &'a Program,
    pub(super) zones: &'a [Pieces],
    pub(super) world: &'a Pieces,
    /// Whether of a leaf that is not far by its box no more than one value is asked.
    pub(super) by_boxes: bool,
    /// The leaves whose signs are known beforehand.
    pub(super) given: Given,
    asked: Vec<Asked>,
    /// The operands of long joins that are near.
    near: Vec<Option<Vec<u32>>>,
    pub(super) signs: Vec<Sign>,
    /// The range of a node whose value is asked for, and the narrowed program's node of the
    /// same value.
    values: Vec<Option<(Interval, Edge)>>,
    /// Ranges that were taken on the way down; none at first.
    pub(super) ranges: Vec<Option<Interval>>,
    pub(super) nodes: Vec<Node>,
    pub(super) list: Vec<Edge>,
    pub(super) simpler: Vec<Instance>,
}

impl<'a> Pass<'a> {
    pub(super) fn new(program: &'a Program, zones: &'a [Pieces], world: &'a Pieces) -> Pass<'a> {
        let count = program.nodes.len();
        Pass {
            program,
            zones,
            world,
            by_boxes: false,
            given: Vec::new(),
            asked: vec![Asked::default(); count],
            near: vec![None; count],
            signs: vec![Sign::Unknown; count],
            values: vec![None; count],
            ranges: Vec::new(),
            nodes: Vec::with_capacity(count.min(FEW)),
            list: Vec::with_capacity(program.operands.len().min(FEW)),
            simpler: Vec::new(),
        }
    }

    pub(super) fn run(&mut self, asked: Asked) {
        self.ask(asked);
        let program = self.program;
        for (at, node) in program.nodes.iter().enumerate() {
            // A leaf whose sign is asked for waits until a join asks: another may have decided.
            let waits = matches!(node.kind, Kind::Leaf(_)) && !self.asked[at].value && at != program.root.node();
            if !waits {
                self.answer(at);
            }
        }
    }

    /// Whether the value of a node is asked for.
    pub(super) fn is_value(&self, node: usize) -> bool {
        self.asked[node].value
    }

    /// Down: what is asked about each node.
    fn ask(&mut self, root: Asked) {
        let program = self.program;
        self.asked[program.root.node()] = root;
        for (at, node) in program.nodes.iter().enumerate().rev() {
            let Asked { sign, value } = self.asked[at];
            let operands = program.list(node);
            if !sign && !value {
                continue;
            }
            let values = match &node.kind {
                Kind::Leaf(_) => continue,
                Kind::Shift(_) => true,
                Kind::Join { rule, .. } => value || rule.reads_values(),
            };
            let asked = Asked { sign: !values, value: values };
            let Kind::Join { rule, frame, hierarchy: Some(hierarchy), .. } = &node.kind else {
                operands.iter().for_each(|edge| self.ask_for(*edge, asked));
                continue;
            };
            let mut region = Bounds::EMPTY;
            program.zone_in(self.zones, *frame, self.world).each(|zone| region = region.union(&hull_of(zone)));
            let near = match rule {
                Rule::MinMax if values => {
                    operands.iter().for_each(|edge| self.ask_for(*edge, asked));
                    continue;
                }
                Rule::MinMax => {
                    let mut near = Vec::with_capacity(operands.len().min(FEW));
                    hierarchy.visit(&region, 0.0, |operand| near.push(operand as u32));
                    near
                }
                _ => match self.links(at, hierarchy, &region, value) {
                    Some(links) => links,
                    None => continue,
                },
            };
            near.iter().for_each(|&operand| self.ask_for(operands[operand as usize], asked));
            self.near[at] = Some(near);
        }
    }

    fn ask_for(&mut self, edge: Edge, asked: Asked) {
        let all = &mut self.asked[edge.node()];
        *all = Asked { sign: all.sign || asked.sign, value: all.value || asked.value };
    }

    /// Up: what is known of a node, and the narrowed program of what stays open.
    fn answer(&mut self, at: usize) {
        let Asked { sign, value } = self.asked[at];
        if (sign || value) && matches!(self.signs[at], Sign::Unknown) {
            self.find(at, value);
        }
    }

    fn find(&mut self, at: usize, value: bool) {
        let program = self.program;
        let node = &program.nodes[at];
        match &node.kind {
            Kind::Leaf(leaf) => match self.given.iter().find(|(given, _)| *given == at) {
                Some((_, inside)) => self.signs[at] = if *inside { Sign::Positive } else { Sign::Negative },
                None => self.leaf(at, *leaf),
            },
            Kind::Join { rule, .. } if !value && !rule.reads_values() => {
                let near = self.near[at].take();
                self.signs[at] = self.sign_of_join(node, near.as_deref());
            }
            Kind::Join { rule: Rule::Smooth(_), .. } => {
                let near = self.near[at].take();
                self.chain(at, near.as_deref(), value);
            }
            kind => {
                let operands: Vec<(Interval, Edge)> =
                    program.list(node).iter().filter_map(|e| self.value(*e)).collect();
                let range = joined(kind, operands.iter().map(|(range, _)| *range));
                let edge = match kind {
                    Kind::Join { rule: Rule::Rounded(size), .. } if let Some(face) = alone(&operands, |_| 0.0) => {
                        self.push(&Kind::Shift(*size), vec![face])
                    }
                    Kind::Join { rule: Rule::Chamfered(leg), .. }
                        if let Some(face) = alone(&operands, |x| (SQRT_2 - 1.0) * (x + leg)) =>
                    {
                        self.push(&Kind::Shift(*leg), vec![face])
                    }
                    Kind::Join { op, rule: Rule::MinMax, .. } => {
                        let contenders = contenders(*op, &operands);
                        self.push(kind, contenders)
                    }
                    _ => self.push(kind, operands.iter().map(|(_, edge)| *edge).collect()),
                };
                self.know(at, range, edge);
            }
        }
    }

    /// The range of an operand, and its node.
    pub(super) fn value(&self, edge: Edge) -> Option<(Interval, Edge)> {
        let (range, node) = self.values[edge.node()]?;
        Some((if edge.negated() { -range } else { range }, node.flip_if(edge.negated())))
    }

    /// A node of the narrowed program that joins all of its operands.
    pub(super) fn push(&mut self, kind: &Kind, operands: Vec<Edge>) -> Edge {
        if let ([only], Kind::Join { .. }) = (&operands[..], kind) {
            return *only;
        }
        let mut kind = kind.clone();
        if let Kind::Join { rule: Rule::MinMax, hierarchy, .. } = &mut kind {
            // Its boxes tell signs, and their order is that of all the operands.
            *hierarchy = None;
        }
        let first = self.list.len() as u32;
        let len = operands.len() as u32;
        self.list.extend(operands);
        self.nodes.push(Node { kind, first, len });
        Edge::new(self.nodes.len() - 1)
    }

    pub(super) fn know(&mut self, at: usize, range: Interval, edge: Edge) {
        self.values[at] = Some((range, edge));
        self.signs[at] = Sign::of(range, || edge);
    }

    fn leaf(&mut self, at: usize, leaf: u32) {
        let program = self.program;
        let instance = program.instance(leaf);
        let zone = program.zone_in(self.zones, instance.frame, self.world);
        let value = self.asked[at].value;
        if !value && !zone.any(|zone| instance.bounds.intersects(&hull_of(zone))) {
            self.signs[at] = Sign::Negative;
            return;
        }
        if !value && self.by_boxes && (leaf as usize) < program.scene.leaves.len() {
            // One leaf that holds all of the zone, or all but it, may decide the whole crowd.
            let range = zone.only().map_or(Interval::ALL, |zone| instance.range_about(zone));
            self.signs[at] = Sign::of(range, || Edge::new(self.nodes.len()));
            if let Sign::Open(_) = self.signs[at] {
                self.nodes.push(Node::leaf(leaf));
            }
            return;
        }
        if value || !zone.only().is_some_and(|zone| instance.is_crossed(zone)) {
            let known = self.ranges.get(at).copied().flatten();
            let range = known.unwrap_or_else(|| program.leaf_range(leaf, self.zones, self.world));
            if !value && (range.lo() > 0.0 || range.hi() < 0.0) {
                self.signs[at] = Sign::of(range, || Edge::new(0));
                return;
            }
            self.values[at] = Some((range, Edge::new(self.nodes.len())));
        }
        let leaf = self.simplest(leaf, zone.only().map(|zone| zone.mapped(&instance.to_local)));
        self.signs[at] = match self.values[at] {
            Some((range, edge)) => Sign::of(range, || edge),
            None => Sign::Open(Edge::new(self.nodes.len())),
        };
        self.nodes.push(Node::leaf(leaf));
    }

    /// The number, in the narrowed program, of a leaf made as simple as it is over `zone`.
    fn simplest(&mut self, leaf: u32, zone: Option<Zone>) -> u32 {
        let instance = self.program.instance(leaf);
        let field = zone.and_then(|zone| instance.field.narrowed(&zone));
        if field.is_none() && (leaf as usize) < self.program.scene.leaves.len() {
            return leaf;
        }
        let mut simpler = instance.clone();
        if let Some(field) = field {
            simpler.field = field;
        }
        self.keep(simpler)
    }

    /// The number, in the narrowed program, of a leaf made simpler.
    fn keep(&mut self, simpler: Instance) -> u32 {
        self.simpler.push(simpler);
        (self.program.scene.leaves.len() + self.simpler.len() - 1) as u32
    }

    fn sign_of_join(&mut self, node: &Node, near: Option<&[u32]>) -> Sign {
        let Kind::Join { op, rule, frame, hierarchy } = &node.kind else { return Sign::Unknown };
        let operands = self.program.list(node);
        let start = self.list.len();
        let everything: Vec<u32>;
        let candidates = match near {
            Some(near) => near,
            None => {
                everything = (0..node.len).collect();
                &everything
            }
        };
        let mut kept: Vec<u32> = Vec::with_capacity(if hierarchy.is_some() { candidates.len() } else { 0 });
        for &operand in candidates {
            let edge = operands[operand as usize];
            self.answer(edge.node());
            match (self.signs[edge.node()].flip_if(edge.negated()), op) {
                (Sign::Positive, Op::Or) => {
                    self.list.truncate(start);
                    return Sign::Positive;
                }
                (Sign::Negative, Op::And) => {
                    self.list.truncate(start);
                    return Sign::Negative;
                }
                (Sign::Open(edge), _) => {
                    self.list.push(edge);
                    if hierarchy.is_some() {
                        kept.push(operand);
                    }
                }
                // The neutral element.
                _ => {}
            }
        }
        match self.list.len() - start {
            0 if *op == Op::Or => Sign::Negative,
            0 => Sign::Positive,
            1 => {
                let only = self.list[start];
                self.list.truncate(start);
                Sign::Open(only)
            }
            open => {
                let hierarchy = match hierarchy {
                    Some(all) if open == operands.len() => Some(all.clone()),
                    Some(all) if open >= LONG => all.subset(&kept).map(Arc::new),
                    _ => None,
                };
                self.nodes.push(Node {
                    kind: Kind::Join { op: *op, rule: *rule, frame: *frame, hierarchy },
                    first: start as u32,
                    len: open as u32,
                });
                Sign::Open(Edge::new(self.nodes.len() - 1))
            }
        }
    }
}

/// The face of a rim's two that decides alone over the region: the other is further than it, than
/// the rim, and than what `reach` makes of the first.
fn alone(operands: &[(Interval, Edge)], reach: impl Fn(f64) -> f64) -> Option<Edge> {
    let &[(x, first), (y, second)] = operands else { return None };
    let is_far = |other: Interval, face: Interval| other.lo() >= face.hi().max(0.0).max(reach(face.hi()));
    if is_far(y, x) {
        Some(first)
    } else if is_far(x, y) {
        Some(second)
    } else {
        None
    }
}

/// The operands of a min or max that may decide its value over the region.
fn contenders(op: Op, operands: &[(Interval, Edge)]) -> Vec<Edge> {
    let best = match op {
        Op::Or => operands.iter().map(|(range, _)| range.lo()).fold(f64::NEG_INFINITY, f64::max),
        Op::And => operands.iter().map(|(range, _)| range.hi()).fold(f64::INFINITY, f64::min),
    };
    let contends = |range: &Interval| match op {
        Op::Or => range.hi() >= best,
        Op::And => range.lo() <= best,
    };
    operands.iter().filter(|(range, _)| contends(range)).map(|(_, edge)| *edge).collect()
}
