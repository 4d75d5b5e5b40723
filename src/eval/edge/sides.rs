//! What the two operands of a fillet are joined from.
//!
//! ```text
//!     fillet(min(a, b), y) = min(fillet(a, y), fillet(b, y))         likewise with max
//! ```
//!
//! A fillet is smooth where its operands are. Those that are joins of others have edges of their own,
//! but the fillet of a join is the join of fillets: with E the points where a ball's centre may be, and
//! `dist(p, E) − r` the fillet, what is outside of an intersection is outside of either operand, and
//! the distance to the union of two sets is the lesser one. Of a union it is the mitre of two fillets.
//! So there is a fillet for each pair of parts, one of either operand, and both operands' joins are
//! made of these. What is seen through maps that jump, as the turns of a helix are, has no jumps
//! where it is joined to the others like it, and stays together.

use glam::DVec3;

use super::super::Evaluator;
use super::super::composite::{Locals, Slopes, Whole};
use super::super::program::{Edge, Kind, Node, Program};
use super::Sample;
use rvachev_field::Op;
use rvachev_field::{Rule, concave_faces};

/// Operands of more parts than these have together, in pairs, are taken as they are.
const MOST: usize = 1 << 12;

/// An operand, as joins of parts.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) parts: Vec<Part>,
    /// The parts and joins of them, operands first. The last is the operand.
    terms: Vec<Term>,
}

/// What is no join, and the sign that it is taken with.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) program: Whole,
    pub(super) sign: f64,
}

#[derive(Clone, Debug)]
enum Term {
    Part(usize),
    Join(Op, Vec<usize>),
}

/// Both operands, with their signs.
pub(super) fn sides(operands: [&Program; 2], signs: [f64; 2]) -> [Side; 2] {
    let sides = [0, 1].map(|i| Side::of(operands[i], signs[i]));
    if sides[0].parts.len() * sides[1].parts.len() <= MOST {
        sides
    } else {
        [0, 1].map(|i| Side::single(operands[i].clone(), signs[i]))
    }
}

impl Side {
    fn single(program: Program, sign: f64) -> Side {
        Side { parts: vec![Part { program: Whole::new(program), sign }], terms: vec![Term::Part(0)] }
    }

    /// The operand as it is reduced to: whether it is taken part by part does not depend on the place.
    pub(super) fn reduced(&self, program: &Program, sign: f64) -> Side {
        if let [_] = self.parts[..] { Side::single(program.clone(), sign) } else { Side::of(program, sign) }
    }

    fn of(program: &Program, sign: f64) -> Side {
        let negated = program.root.negated() != (sign < 0.0);
        let jumps = jumps(program);
        let jumps = |edge: &Edge| jumps[edge.node()];
        // By node, whether it is asked for as it is, and negated; then which term it is.
        let mut asked = vec![[false; 2]; program.nodes.len()];
        asked[program.root.node()][usize::from(negated)] = true;
        for (at, node) in program.nodes.iter().enumerate().rev() {
            let here = asked[at];
            for edge in program.list(node).iter().filter(|edge| is_join(node) && !jumps(edge)) {
                for turned in (0..2).filter(|&turned| here[turned]) {
                    asked[edge.node()][turned ^ usize::from(edge.negated())] = true;
                }
            }
        }
        let mut side = Side { parts: Vec::new(), terms: Vec::new() };
        let mut numbers = vec![[0; 2]; program.nodes.len()];
        for (at, node) in program.nodes.iter().enumerate() {
            for turned in [0, 1].into_iter().filter(|&turned| asked[at][turned]) {
                let sign = if turned == 1 { -1.0 } else { 1.0 };
                let number = |edge: &Edge| numbers[edge.node()][turned ^ usize::from(edge.negated())];
                let (apart, together): (Vec<Edge>, Vec<Edge>) =
                    program.list(node).iter().partition(|edge| !jumps(edge));
                numbers[at][turned] = match node.kind {
                    Kind::Join { op, .. } if is_join(node) && !apart.is_empty() => {
                        let mut terms: Vec<usize> = apart.iter().map(number).collect();
                        if !together.is_empty() {
                            terms.push(side.part(program.of_node(at, Some(&together)), sign));
                        }
                        side.terms.push(Term::Join(op.flip_if(turned == 1), terms));
                        side.terms.len() - 1
                    }
                    Kind::Leaf(leaf) => side.leaf(program, leaf, turned == 1),
                    _ => side.part(program.of_node(at, None), sign),
                };
            }
        }
        side
    }

    /// The number of a leaf, or its complement, that is added: as the join of its faces where it has
    /// concave edges.
    fn leaf(&mut self, program: &Program, leaf: u32, turned: bool) -> usize {
        let sign = if turned { -1.0 } else { 1.0 };
        let Some(faces) = concave_faces(&*program.instance(leaf).field, turned) else {
            return self.part(program.of_leaf(leaf, None), sign);
        };
        let terms = faces.leaves.into_iter().map(|face| self.part(program.of_leaf(leaf, Some(face)), sign)).collect();
        self.terms.push(Term::Join(if faces.is_union { Op::Or } else { Op::And }.flip_if(turned), terms));
        self.terms.len() - 1
    }

    /// The number of a part that is added.
    fn part(&mut self, program: Program, sign: f64) -> usize {
        self.parts.push(Part { program: Whole::new(program), sign });
        self.terms.push(Term::Part(self.parts.len() - 1));
        self.terms.len() - 1
    }

    /// The parts at a point where the operand is `whole`.
    pub(super) fn samples(&self, whole: Sample, p: DVec3) -> Vec<Sample> {
        match &self.parts[..] {
            [_] => vec![whole],
            parts => parts.iter().map(|part| part.sample(p)).collect(),
        }
    }

    /// The parts at the points of a chunk where the operand is `whole`.
    pub(super) fn lanes(&self, whole: &Slopes, local: &Locals, evaluator: &mut Evaluator) -> Vec<Slopes> {
        match &self.parts[..] {
            [_] => vec![whole.clone()],
            parts => parts.iter().map(|part| part.lanes(local, evaluator)).collect(),
        }
    }

    /// The operand, given its parts.
    fn join(&self, mut part: impl FnMut(usize) -> Sample) -> Sample {
        if let [_] = self.terms[..] {
            return part(0);
        }
        let mut samples: Vec<Sample> = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            samples.push(match term {
                Term::Part(number) => part(*number),
                Term::Join(op, terms) => {
                    let better = |a: Sample, b: Sample| if (a.0 >= b.0) == (*op == Op::Or) { a } else { b };
                    terms.iter().map(|&term| samples[term]).reduce(better).unwrap_or_default()
                }
            });
        }
        samples.pop().unwrap_or_default()
    }
}

impl Part {
    pub(super) fn sample(&self, p: DVec3) -> Sample {
        let (value, gradient) = self.program.gradient(p);
        (self.sign * value, self.sign * gradient)
    }

    pub(super) fn lanes(&self, local: &Locals, evaluator: &mut Evaluator) -> Slopes {
        local.gradients(evaluator, self.program.tape()).times(self.sign)
    }
}

/// What is made of the blends of all pairs of parts.
pub(super) fn join([x, y]: &[Side; 2], mut pair: impl FnMut(usize, usize) -> Sample) -> Sample {
    x.join(|i| y.join(|j| pair(i, j)))
}

/// By node, whether there is anything in it that goes on elsewhere, as the turns of a helix do: by
/// itself it jumps.
fn jumps(program: &Program) -> Vec<bool> {
    let mut jumps: Vec<bool> = Vec::with_capacity(program.nodes.len());
    for node in &program.nodes[..] {
        let here = node.valued_by().is_some_and(|leaf| program.leaf_jumps(leaf));
        jumps.push(here || program.list(node).iter().any(|edge| jumps[edge.node()]));
    }
    jumps
}

/// Whether a node is the least or the greatest of its operands.
fn is_join(node: &Node) -> bool {
    matches!(node.kind, Kind::Join { rule: Rule::MinMax, .. })
}
