//! What the minima and maxima of a program are taken of.

use super::program::{Edge, Kind, Program};
use rvachev_field::{Op, Rule};

impl Program {
    /// Its parts that are no minima and maxima themselves, each once, by their nodes; nothing if
    /// they are more than this.
    pub(crate) fn atoms(&self, most: usize) -> Option<Vec<(usize, Program)>> {
        let mut is_met = vec![false; self.nodes.len()];
        is_met[self.root.node()] = true;
        let mut atoms = Vec::new();
        for (at, node) in self.nodes.iter().enumerate().rev() {
            match node.kind {
                _ if !is_met[at] => {}
                Kind::Join { rule: Rule::MinMax, .. } => {
                    self.list(node).iter().for_each(|edge| is_met[edge.node()] = true);
                }
                _ => atoms.push(at),
            }
        }
        let part = |at: usize| {
            let (nodes, operands, simpler) = (self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec());
            (at, self.trimmed(nodes, operands, simpler, Edge::new(at)))
        };
        (atoms.len() <= most).then(|| atoms.into_iter().map(part).collect())
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
            let inside = |at: usize| atoms.iter().find(|(own, _)| *own == at).map(|(_, atom)| atom.value(p) > 0.0);
            assert_eq!(program.is_inside_by(inside), Some(program.value(p) > 0.0), "{n}");
        }
        // The last one alone tells of what is in it.
        let last = atoms.iter().find(|(_, atom)| atom.value([3.4, 0.0, 0.0]) > 0.0).unwrap().0;
        assert_eq!(program.is_inside_by(|at| (at == last).then_some(true)), Some(false));
        assert_eq!(program.is_inside_by(|at| (at == last).then_some(false)), None);
        // A fillet's operands are read by more than their signs.
        let program = &compiled(&(a.union_with(&b, Blend::Smooth { radius: 0.3 }) - &c)).unwrap().surface;
        assert_eq!(program.atoms(9).unwrap().len(), 2);
    }
}
