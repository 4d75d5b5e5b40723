//! Ranges and narrowing.
//!
//! Where an operand of an R-function has one sign throughout a region, the operation has the sign
//! and the zero set of the other operand there, or no surface at all (MATHEMATICS E, sign-pruning
//! lemma). Below a blend, which reads values, an operand goes only where its value cannot be the
//! one that counts. Ranges are taken leaf by leaf over the region as it looks in the leaf's frame.

use std::sync::Arc;

use super::even::either;
use super::pass::{Asked, Pass, Sign};
use super::program::{Edge, Kind, Node, Program, Region};
use super::ranges::{hull_of, joined};
use super::scene::Instance;
use crate::{Bounds, Interval};
use rvachev_field::{AnyField, Op, Pieces, Rule, Zone};

/// What a region holds of a solid, and the program for it if that is another.
pub(crate) enum Narrowed {
    /// Every point is inside.
    Inside,
    /// Every point is outside.
    Outside,
    /// The surface may cross the region, and every leaf may matter there.
    Same,
    /// The surface may cross the region, which a simpler program tells as much of.
    Simpler(Program),
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
        self.region(self.narrowed(region))
    }

    /// The same without a copy of the program: many threads that count the users of one are in each
    /// other's way.
    pub(crate) fn narrowed(&self, region: &Bounds) -> Narrowed {
        if !region.is_finite() || region.is_empty() {
            return Narrowed::Same;
        }
        self.narrow_pass(&Zone::of_bounds(region), false)
    }

    pub(super) fn region(&self, narrowed: Narrowed) -> Region {
        match narrowed {
            Narrowed::Inside => Region::Inside,
            Narrowed::Outside => Region::Outside,
            Narrowed::Same => Region::Surface(self.clone()),
            Narrowed::Simpler(program) => Region::Surface(program),
        }
    }

    /// As [`narrow`](Program::narrow), by the boxes of leaves and one value of each: of a region
    /// that many leaves lie in their ranges tell little more.
    pub(crate) fn narrow_by_boxes(&self, region: &Bounds) -> Region {
        self.region(self.narrow_pass(&Zone::of_bounds(region), true))
    }

    /// Tells the leaves that take long which regions the program will be narrowed to next: some
    /// answer for many of them at once as quickly as for one.
    pub(crate) fn prefetch(&self, regions: &[Bounds]) {
        for leaf in self.nodes.iter().filter_map(Node::valued_by) {
            let instance = self.instance(leaf);
            if instance.frame == 0 && instance.field.cost() > 1 {
                let zone = |region: &Bounds| Zone::of_bounds(region).mapped(&instance.to_local);
                instance.field.prefetch(&regions.iter().map(zone).collect::<Vec<_>>());
            }
        }
    }

    /// The axes of the world that leaves of more than `dear` ordinary ones depend on, if there are
    /// such leaves.
    pub(crate) fn dear_axes(&self, dear: usize) -> Option<[bool; 3]> {
        let leaves = self.nodes.iter().filter_map(Node::valued_by);
        let dear = leaves.filter(|&leaf| self.instance(leaf).field.cost() > dear);
        dear.map(|leaf| self.axes_of(leaf)).reduce(either)
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
    pub(super) fn zones(&self, world: &Pieces) -> Vec<Pieces> {
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
    pub(super) fn zone_in<'a>(&self, zones: &'a [Pieces], frame: u32, world: &'a Pieces) -> &'a Pieces {
        self.frames.binary_search(&frame).map_or(world, |slot| &zones[slot])
    }

    pub(super) fn leaf_range(&self, leaf: u32, zones: &[Pieces], world: &Pieces) -> Interval {
        let instance = self.instance(leaf);
        let zone = self.zone_in(zones, instance.frame, world);
        zone.range(&instance.to_local, |zone| instance.placed_range(zone))
    }

    pub(crate) fn range_zone(&self, world: &Zone) -> Interval {
        let world = &Pieces::one(*world);
        let zones = self.zones(world);
        self.range_of_leaves(|leaf| self.leaf_range(leaf, &zones, world))
    }

    /// The range that ranges of the leaves make.
    pub(super) fn range_of_leaves(&self, of_leaf: impl Fn(u32) -> Interval) -> Interval {
        let mut ranges: Vec<Interval> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes[..] {
            let range = match &node.kind {
                Kind::Leaf(leaf) => of_leaf(*leaf),
                kind => {
                    let operand = |edge: &Edge| {
                        let range = ranges[edge.node()];
                        if edge.negated() { -range } else { range }
                    };
                    joined(kind, self.list(node).iter().map(operand))
                }
            };
            ranges.push(range);
        }
        let range = ranges[self.root.node()];
        if self.root.negated() { -range } else { range }
    }

    pub(crate) fn narrow_zone(&self, world: &Zone) -> Region {
        self.region(self.narrow_pass(world, false))
    }

    /// A program of one leaf with a simpler one in its place, where there is one; nothing is asked
    /// about signs.
    pub(super) fn simplified(&self, world: &Zone) -> Region {
        let [Node { kind: Kind::Leaf(leaf), .. }] = self.nodes[..] else { return Region::Surface(self.clone()) };
        let world = &Pieces::one(*world);
        let simpler = self.simpler_leaf(leaf, &self.zones(world), world);
        Region::Surface(simpler.unwrap_or_else(|| self.clone()))
    }

    fn simpler_leaf(&self, leaf: u32, zones: &[Pieces], world: &Pieces) -> Option<Program> {
        let instance = self.instance(leaf);
        let zone = self.zone_in(zones, instance.frame, world).only()?;
        let field = instance.field.narrowed(&zone.mapped(&instance.to_local))?;
        Some(self.of_simpler(leaf, field))
    }

    fn narrow_pass(&self, world: &Zone, by_boxes: bool) -> Narrowed {
        let world = &Pieces::one(*world);
        let zones = self.zones(world);
        if let Some(narrowed) = self.narrow_leaf(&zones, world) {
            return narrowed;
        }
        let mut pass = Pass::new(self, &zones, world);
        pass.by_boxes = by_boxes;
        pass.run(Asked { sign: true, ..Asked::default() });
        self.found(pass)
    }

    /// What a pass over a region that asked for signs has found.
    pub(super) fn found(&self, pass: Pass<'_>) -> Narrowed {
        let Pass { signs, nodes, list, simpler, .. } = pass;
        match signs[self.root.node()].flip_if(self.root.negated()) {
            Sign::Positive => Narrowed::Inside,
            Sign::Negative => Narrowed::Outside,
            Sign::Unknown => Narrowed::Same,
            Sign::Open(_) if simpler.is_empty() && self.has_all(&nodes, &list) => Narrowed::Same,
            Sign::Open(root) => Narrowed::Simpler(self.trimmed(nodes, list, simpler, root)),
        }
    }

    /// Whether nothing was left out on the way to these nodes, each of which came of one of
    /// the program's.
    fn has_all(&self, nodes: &[Node], list: &[Edge]) -> bool {
        nodes.len() == self.nodes.len() && list.len() == self.operands.len()
    }

    /// The answer for a program of one leaf, what most regions come down to: it needs no tables,
    /// and what stays open shares its program, or all of it but a simpler leaf.
    fn narrow_leaf(&self, zones: &[Pieces], world: &Pieces) -> Option<Narrowed> {
        let [Node { kind: Kind::Leaf(leaf), .. }] = self.nodes[..] else { return None };
        let instance = self.instance(leaf);
        let zone = self.zone_in(zones, instance.frame, world);
        let open = || Some(self.simpler_leaf(leaf, zones, world).map_or(Narrowed::Same, Narrowed::Simpler));
        if zone.only().is_some_and(|zone| instance.is_crossed(zone)) {
            return open();
        }
        let range = if zone.any(|zone| instance.bounds.intersects(&hull_of(zone))) {
            zone.range(&instance.to_local, |zone| instance.placed_range(zone))
        } else {
            Interval::new(f64::NEG_INFINITY, -f64::MIN_POSITIVE)
        };
        let range = if self.root.negated() { -range } else { range };
        if range.lo() > 0.0 {
            return Some(Narrowed::Inside);
        }
        if range.hi() < 0.0 {
            return Some(Narrowed::Outside);
        }
        open()
    }

    /// The program, which is of one leaf, with a simpler one in its place.
    fn of_simpler(&self, leaf: u32, field: Arc<dyn AnyField>) -> Program {
        let simpler: Arc<[Instance]> = [Instance { field, ..self.instance(leaf).clone() }].into();
        let number = self.scene.leaves.len() as u32;
        let nodes = if leaf == number { self.nodes.clone() } else { [Node::leaf(number)].into() };
        Program { nodes, simpler, ..self.clone() }
    }

    /// A program of the same values over a zone, from what may decide them there.
    pub(crate) fn reduced(&self, world: &Zone) -> Program {
        let world = &Pieces::one(*world);
        let zones = self.zones(world);
        let mut pass = Pass::new(self, &zones, world);
        pass.run(Asked { value: true, ..Asked::default() });
        let root = pass.value(self.root);
        let Pass { nodes, list, simpler, .. } = pass;
        match root {
            Some((_, root)) => self.trimmed(nodes, list, simpler, root),
            None => self.clone(),
        }
    }

    /// What it is a union or an intersection of by min and max, and which; nothing if it is none.
    pub(super) fn choices(&self) -> Option<(Op, Vec<Program>)> {
        let node = &self.nodes[self.root.node()];
        let Kind::Join { op, rule: Rule::MinMax, .. } = node.kind else { return None };
        let negated = self.root.negated();
        let op = op.flip_if(negated);
        let part = |edge: &Edge| {
            let (nodes, operands, simpler) = (self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec());
            self.trimmed(nodes, operands, simpler, edge.flip_if(negated))
        };
        Some((op, self.list(node).iter().map(part).collect()))
    }

    /// The same of a leaf that has edges of its own: what it is an intersection of.
    pub(super) fn walls(&self) -> Option<(Op, Vec<Program>)> {
        let [Node { kind: Kind::Leaf(leaf), .. }] = self.nodes[..] else { return None };
        let walls = self.instance(leaf).field.walls();
        let op = Op::And.flip_if(self.root.negated());
        (!walls.is_empty()).then(|| (op, walls.into_iter().map(|wall| self.of_simpler(leaf, wall)).collect()))
    }

    /// How many there are of all leaves, those that have none counted as one.
    pub(super) fn wall_count(&self) -> usize {
        let leaves = self.nodes.iter().filter_map(Node::valued_by);
        leaves.map(|leaf| self.instance(leaf).field.walls().len().max(1)).sum()
    }

    /// A program of the nodes that `root` reaches.
    pub(super) fn trimmed(&self, nodes: Vec<Node>, operands: Vec<Edge>, simpler: Vec<Instance>, root: Edge) -> Program {
        if nodes.len() == 1 {
            return Program::assemble(self.scene.clone(), nodes, Vec::new(), root, simpler);
        }
        // Of those that are reached, the number among them.
        let mut numbers = vec![None; nodes.len()];
        numbers[root.node()] = Some(0);
        for at in (0..nodes.len()).rev() {
            if numbers[at].is_some() {
                for edge in &operands[nodes[at].range()] {
                    numbers[edge.node()] = Some(0);
                }
            }
        }
        let (mut kept, mut list) = (Vec::with_capacity(nodes.len()), Vec::with_capacity(operands.len()));
        let moved = |numbers: &[Option<usize>], edge: Edge| edge.to(numbers[edge.node()].unwrap_or_default());
        for (at, mut node) in nodes.into_iter().enumerate() {
            if numbers[at].is_none() {
                continue;
            }
            let old = node.range();
            node.first = list.len() as u32;
            list.extend(operands[old].iter().map(|&edge| moved(&numbers, edge)));
            numbers[at] = Some(kept.len());
            kept.push(node);
        }
        Program::assemble(self.scene.clone(), kept, list, moved(&numbers, root), simpler)
    }
}
