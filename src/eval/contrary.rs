//! Something and its complement.

use std::collections::HashSet;

use rvachev_field::{Op, Rule};

use super::program::{Edge, Kind, Program};

impl Program {
    /// Whether no point is inside, whatever the leaves are: something and its complement have
    /// nothing in common. No range tells on the surface of that.
    pub(crate) fn is_contrary(&self) -> bool {
        // Of each node, whether nothing is inside, and whether nothing is outside.
        let mut never = vec![[false; 2]; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate() {
            let Kind::Join { op, rule: Rule::MinMax, .. } = &node.kind else { continue };
            let list = self.list(node);
            let of = |edge: &Edge, side: usize| never[edge.node()][side ^ usize::from(edge.negated())];
            let (narrow, wide) = if *op == Op::And { (0, 1) } else { (1, 0) };
            // What cannot hold beside the other operands: the complement of one of them, or what is
            // made of nothing else.
            let all: HashSet<Edge> = list.iter().copied().collect();
            let has = |edge: Edge| all.contains(&edge);
            let is_against = |edge: &Edge| has(edge.flip_if(true)) || self.parts_against(*edge, *op, has);
            let mut own = [false; 2];
            own[narrow] = list.iter().any(|edge| of(edge, narrow) || is_against(edge));
            own[wide] = !list.is_empty() && list.iter().all(|edge| of(edge, wide));
            never[at] = own;
        }
        never[self.root.node()][usize::from(self.root.negated())]
    }

    /// Whether an operand of a join is one of the other kind, and of each of its own operands the
    /// complement is there.
    fn parts_against(&self, edge: Edge, joined: Op, has: impl Fn(Edge) -> bool) -> bool {
        let node = &self.nodes[edge.node()];
        let Kind::Join { op, rule: Rule::MinMax, .. } = node.kind else { return false };
        let list = self.list(node);
        op.flip_if(edge.negated()) != joined
            && !list.is_empty()
            && list.iter().all(|part| has(part.flip_if(!edge.negated())))
    }
}

#[cfg(test)]
mod tests {
    use crate::Solid;
    use crate::distance::compiled;

    #[test]
    fn a_solid_without_itself_has_no_point() {
        let [a, b, c] = [0.0, 0.5, 1.0].map(|x| Solid::cuboid([1.0, 2.0, 3.0]).translate([x, 0.0, 0.0]));
        let is_contrary = |solid: Solid| compiled(&solid).unwrap().surface.is_contrary();
        let none = &a - &a;
        for solid in [none.clone(), &none & &b, &none | (&b - &b), !(!&none), (&a | &b) - (&a | &b), &c - (&a | !&a)] {
            assert!(is_contrary(solid.clone()), "{solid}");
        }
        for solid in [&a - &b, &none | &b, !&none, &a ^ &b, &a & (&b | !&a)] {
            assert!(!is_contrary(solid.clone()), "{solid}");
        }
    }
}
