//! What the minima and maxima of a program are taken of.

use super::program::{Edge, Kind, Node, Program};
use crate::{Bounds, Dual, Interval};
use rvachev_field::{Op, Rule, Zone};

/// A part that is no minimum or maximum itself.
pub(crate) struct Atom {
    /// Its node.
    pub(crate) node: usize,
    pub(crate) program: Program,
    /// Whether its complement counts; nothing if it counts both ways.
    pub(crate) is_complement: Option<bool>,
}

/// A number in a region: in the middle, and ranges of it and of its slopes throughout.
pub(crate) struct Number {
    pub(crate) value: f64,
    pub(crate) range: Interval,
    pub(crate) slopes: [Interval; 3],
}

impl Program {
    /// Its parts that are no minima and maxima themselves, each once; nothing if they are more than
    /// this.
    pub(crate) fn atoms(&self, most: usize) -> Option<Vec<Atom>> {
        // As they are, and as complements.
        let mut is_met = vec![[false; 2]; self.nodes.len()];
        is_met[self.root.node()][usize::from(self.root.negated())] = true;
        let mut atoms = Vec::new();
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let [plain, negated] = is_met[at];
            match node.kind {
                _ if !(plain || negated) => {}
                Kind::Join { rule: Rule::MinMax, .. } => {
                    for edge in self.list(node) {
                        let met = &mut is_met[edge.node()];
                        met[usize::from(edge.negated())] |= plain;
                        met[usize::from(!edge.negated())] |= negated;
                    }
                }
                _ => atoms.push((at, (plain != negated).then_some(negated))),
            }
        }
        let part = |(node, is_complement): (usize, Option<bool>)| {
            let (nodes, operands, simpler) = (self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec());
            Atom { node, program: self.trimmed(nodes, operands, simpler, Edge::new(node)), is_complement }
        };
        (atoms.len() <= most).then(|| atoms.into_iter().map(part).collect())
    }

    /// Numbers of which the least has the sign of the value, in a region; nothing of values that
    /// jump or come of a search.
    pub(crate) fn numbers(&self, region: &Bounds) -> Option<Vec<Number>> {
        if !self.is_steady() || self.jumps() {
            return None;
        }
        let centre = region.center();
        let [middle, all] = [Bounds::new(centre, centre), *region].map(|part| {
            let p = Dual::point(Zone::of_bounds(&part).hull());
            match &self.nodes[..] {
                [Node { kind: Kind::Leaf(leaf), .. }] if !self.root.negated() => {
                    self.leaf_faces(*leaf, (p, &self.frame_points(p)))
                }
                _ => vec![self.evaluate(p, &mut Vec::new())],
            }
        });
        let number = |(middle, all): (Dual<Interval>, Dual<Interval>)| Number {
            value: middle.v.mid(),
            range: all.v,
            slopes: all.d,
        };
        Some(middle.into_iter().zip(all).map(number).collect())
    }

    /// Whether a point is inside, by what is known of the parts, if that tells it.
    pub(crate) fn is_inside_by(&self, known: impl Fn(usize) -> Option<bool>) -> Option<bool> {
        let mut signs: Vec<Option<bool>> = Vec::with_capacity(self.nodes.len());
        for (at, node) in self.nodes.iter().enumerate() {
            let sign = match node.kind {
                Kind::Join { op, rule: Rule::MinMax, .. } => {
                    // What one operand tells alone.
                    let all = op == Op::Or;
                    let mut sign = Some(!all);
                    for edge in self.list(node) {
                        match signs[edge.node()].map(|sign| sign != edge.negated()) {
                            Some(own) if own == all => {
                                sign = Some(all);
                                break;
                            }
                            Some(_) => {}
                            None => sign = None,
                        }
                    }
                    sign
                }
                _ => known(at),
            };
            signs.push(sign);
        }
        signs[self.root.node()].map(|sign| sign != self.root.negated())
    }
}

#[cfg(test)]
mod tests {
    use crate::distance::compiled;
    use crate::{Blend, Solid};

    #[test]
    fn parts_tell_the_whole() {
        let [a, b, c] = [0.0, 1.0, 2.0].map(|x| Solid::sphere(1.5).translate([x, 0.0, 0.0]));
        let program = &compiled(&((&a | &b) - &c)).unwrap().surface;
        let atoms = program.atoms(3).unwrap();
        assert!(atoms.len() == 3 && program.atoms(2).is_none());
        for n in 0..200 {
            let p = [f64::from(n) * 0.03 - 2.0, 0.3, 0.1];
            let inside = |at: usize| atoms.iter().find(|atom| atom.node == at).map(|atom| atom.program.value(p) > 0.0);
            assert_eq!(program.is_inside_by(inside), Some(program.value(p) > 0.0), "{n}");
        }
        // The last one alone tells of what is in it.
        let last = atoms.iter().find(|atom| atom.program.value([3.4, 0.0, 0.0]) > 0.0).unwrap();
        assert_eq!(atoms.iter().filter(|atom| atom.is_complement == Some(true)).count(), 1);
        assert_eq!(last.is_complement, Some(true));
        let last = last.node;
        assert_eq!(program.is_inside_by(|at| (at == last).then_some(true)), Some(false));
        assert_eq!(program.is_inside_by(|at| (at == last).then_some(false)), None);
        // A fillet's operands are read by more than their signs.
        let program = &compiled(&(a.union_with(&b, Blend::Smooth { radius: 0.3 }) - &c)).unwrap().surface;
        assert_eq!(program.atoms(9).unwrap().len(), 2);
    }
}
