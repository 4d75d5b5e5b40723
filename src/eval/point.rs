//! Programs at points, on any number that a leaf can be called with.

use glam::DVec3;

use super::program::{Edge, Kind, Node, Program};
use rvachev_field::Op;
use rvachev_field::{COORDINATE_LIMIT, Number, Placement, VALUE_LIMIT, saturate};

use crate::Dual;

impl Program {
    /// The value at a point given in any number; `frames` and `values` are scratch.
    pub(crate) fn evaluate<N: Number>(&self, p: [N; 3], values: &mut Vec<N>) -> N {
        // A single leaf in the world, what most regions narrow to, needs no tables.
        if let ([Node { kind: Kind::Leaf(leaf), .. }], []) = (&self.nodes[..], &self.frames[..]) {
            let value = self.leaf(*leaf, p);
            return if self.root.negated() { -value } else { value };
        }
        self.evaluate_all(p, values)
    }

    /// The same, with the values of all nodes.
    fn evaluate_all<N: Number>(&self, p: [N; 3], values: &mut Vec<N>) -> N {
        let frames = self.frame_points(p);
        self.evaluate_leaves(|leaf| self.leaf(leaf, self.in_frame(&frames, self.instance(leaf).frame, p)), values)
    }

    /// The value, by those of the leaves.
    pub(super) fn evaluate_leaves<N: Number>(&self, leaf: impl Fn(u32) -> N, values: &mut Vec<N>) -> N {
        values.clear();
        for node in &self.nodes[..] {
            let signed = |edge: &Edge| {
                let value = values[edge.node()];
                if edge.negated() { -value } else { value }
            };
            let mut operands = self.list(node).iter().map(signed);
            let value = match &node.kind {
                Kind::Leaf(number) => leaf(*number),
                Kind::Join { op, rule, .. } => {
                    let Some(start) = operands.next() else { continue };
                    operands.fold(start, |all, next| rule.join(*op, all, next))
                }
                Kind::Shift(by) => {
                    let Some(operand) = operands.next() else { continue };
                    saturate(operand + *by)
                }
            };
            values.push(value);
        }
        let value = values[self.root.node()];
        if self.root.negated() { -value } else { value }
    }

    /// The point in each live frame.
    pub(super) fn frame_points<N: Number>(&self, p: [N; 3]) -> Vec<[N; 3]> {
        let mut frames: Vec<[N; 3]> = Vec::with_capacity(self.frames.len());
        for &number in &self.frames[..] {
            let Some(frame) = self.scene.frame(number) else { continue };
            let above = self.in_frame(&frames, frame.parent, p);
            let local = Placement::new(&frame.to_local, 1.0, 0.0).apply(above);
            frames.push(N::warp(&*frame.warp, local));
        }
        frames
    }

    pub(super) fn leaf<N: Number>(&self, leaf: u32, p: [N; 3]) -> N {
        let instance = self.instance(leaf);
        instance.placement.finish(N::leaf(&*instance.field, instance.placement.apply(p)))
    }

    /// The point in a frame, given those of the live frames before it.
    pub(crate) fn in_frame<T: Copy>(&self, frames: &[T], frame: u32, world: T) -> T {
        match self.frames.binary_search(&frame) {
            Ok(slot) => frames[slot],
            Err(_) => world,
        }
    }

    /// The value at a point: positive inside. Coordinates beyond
    /// [`COORDINATE_LIMIT`] are evaluated as if they lay there; NaN
    /// counts as outside.
    #[must_use]
    pub fn value(&self, p: impl Into<DVec3>) -> f64 {
        self.value_at(p.into())
    }

    fn value_at(&self, p: DVec3) -> f64 {
        if p.is_nan() {
            return -VALUE_LIMIT;
        }
        saturate(self.evaluate(limited(p), &mut Vec::new()))
    }

    /// Value and gradient at a point. At kinks, the gradient of one side.
    #[must_use]
    pub fn gradient(&self, p: impl Into<DVec3>) -> (f64, DVec3) {
        self.gradient_at(p.into())
    }

    fn gradient_at(&self, p: DVec3) -> (f64, DVec3) {
        let dual = self.evaluate(Dual::point(limited(p)), &mut Vec::new());
        // Where there is no point there is no slope.
        let slopes = if p.is_nan() { [0.0; 3] } else { dual.d };
        (saturate(dual.v), DVec3::from_array(slopes))
    }

    /// The values of all nodes at a point.
    pub(super) fn node_values(&self, p: DVec3) -> Vec<f64> {
        let mut values = Vec::new();
        self.evaluate_all(limited(p), &mut values);
        values
    }

    /// A point in a leaf's own coordinates.
    pub(super) fn local(&self, leaf: u32, p: DVec3) -> DVec3 {
        let (instance, p) = (self.instance(leaf), limited(p));
        let in_frame = self.in_frame(&self.frame_points(p), instance.frame, p);
        DVec3::from_array(instance.placement.apply(in_frame))
    }

    /// The number of the leaf whose value decides at a point.
    pub(crate) fn deciding_leaf(&self, p: DVec3) -> u32 {
        self.leaf_at(p, |_, _| true)
    }

    /// The same where the values of the leaves are known, by their places among those of the scene.
    pub(crate) fn leaf_by_values(&self, leaf: impl Fn(u32) -> f64, values: &mut Vec<f64>) -> u32 {
        values.clear();
        self.leaf_among(
            |_, _| true,
            values,
            |values| {
                self.evaluate_leaves(&leaf, values);
            },
        )
    }

    /// The number of the leaf that a point inside is in: what it was cut out of, and not what was
    /// taken away nearby.
    pub(crate) fn holding_leaf(&self, p: DVec3) -> u32 {
        self.leaf_at(p, |op, edge| op == Op::Or || !edge.negated())
    }

    /// The leaf whose value decides at a point, among those operands of each join that count, if
    /// any do. Values are found where there is a choice.
    fn leaf_at(&self, p: DVec3, counts: impl Fn(Op, &Edge) -> bool) -> u32 {
        self.leaf_among(counts, &mut Vec::new(), |values| {
            self.evaluate_all(limited(p), values);
        })
    }

    /// The same where `fill` finds the values of all nodes, of which there are none yet.
    fn leaf_among(
        &self,
        counts: impl Fn(Op, &Edge) -> bool,
        values: &mut Vec<f64>,
        fill: impl Fn(&mut Vec<f64>),
    ) -> u32 {
        let mut at = self.root.node();
        loop {
            let node = &self.nodes[at];
            let op = match &node.kind {
                Kind::Leaf(leaf) => return self.instance(*leaf).number,
                Kind::Join { op, .. } => *op,
                Kind::Shift(_) => Op::Or,
            };
            let operands = self.list(node);
            let mut counted = operands.iter().filter(|edge| counts(op, edge));
            let mut chosen = *counted.next().unwrap_or(&operands[0]);
            for edge in counted {
                if values.is_empty() {
                    fill(values);
                }
                let signed = |edge: &Edge| {
                    let value: f64 = values[edge.node()];
                    if edge.negated() { -value } else { value }
                };
                let better = match op {
                    Op::Or => signed(edge) > signed(&chosen),
                    Op::And => signed(edge) < signed(&chosen),
                };
                if better {
                    chosen = *edge;
                }
            }
            at = chosen.node();
        }
    }
}

/// A point held within the coordinate limit.
pub(crate) fn limited(p: DVec3) -> [f64; 3] {
    p.to_array().map(|c| c.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::catalogue::{Part, catalogue};
    use crate::{Interval, Jet};

    /// A number from 0 to 1.
    fn random(n: u32) -> f64 {
        f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
    }

    fn vector(n: u32) -> DVec3 {
        DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0
    }

    /// Between any two points of a box the gradient changes by no more than second derivatives say,
    /// of everything in the catalogue.
    #[test]
    fn gradients_turn_within_what_jets_tell() {
        let (mut told, mut asked) = (0, 0);
        for (number, entry) in (0u32..).zip(catalogue()) {
            let solid = match entry.example() {
                Part::Solid(solid) => solid,
                Part::Profile(profile) => profile.extrude(0.5),
                _ => continue,
            };
            let size = solid.bounds().ok().filter(|bounds| bounds.is_finite());
            let size = size.map_or(2.0, |bounds| bounds.longest_side());
            let program = solid.field_program().expect("the example is valid");
            let mut known = 0;
            for n in 0..120 {
                let at = |m: u32| vector(m + 1000 * number + 40 * n);
                let (centre, half) = (0.6 * size * at(0), (0.01 + random(n)) * 0.05 * size);
                let sides = [0, 1, 2].map(|axis| Interval::around(centre[axis], half));
                let jet = program.evaluate(Jet::point(sides), &mut Vec::new());
                let turns = |way: DVec3| jet.turn(way.to_array().map(Interval::point));
                known += u32::from(turns(DVec3::ONE).iter().all(|turn| turn.width().is_finite()));
                for pair in 0..6 {
                    let [p, q] = [1, 2].map(|k| centre + half * at(2 * pair + k));
                    let (from, to) = (program.gradient(p), program.gradient(q));
                    let bounds = turns(q - p);
                    for (axis, turn) in bounds.into_iter().enumerate() {
                        let change = to.1[axis] - from.1[axis];
                        let slack = 1e-7 * (1.0 + from.1[axis].abs() + to.1[axis].abs());
                        assert!(
                            change >= turn.lo() - slack && change <= turn.hi() + slack,
                            "{}: {change} along {axis} from {p} to {q}, {turn:?}",
                            entry.name()
                        );
                        let slope = jet.d[axis];
                        let is_slope = slope.lo() - slack <= to.1[axis] && to.1[axis] <= slope.hi() + slack;
                        assert!(is_slope, "{}: {} along {axis} at {q}, {slope:?}", entry.name(), to.1[axis]);
                    }
                }
            }
            asked += 1;
            told += u32::from(known > 30);
        }
        assert!(told * 3 > asked * 2, "{told} of {asked}");
    }
}
