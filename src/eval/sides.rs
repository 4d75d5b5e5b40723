//! Boxes around what is inside and what is outside.

use super::program::{Kind, Program};
use crate::Bounds;
use rvachev_field::Op;
use rvachev_field::Rule;

/// A box that holds what is inside, and one that holds what is outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    pub(crate) inside: Bounds,
    pub(crate) outside: Bounds,
}

impl Default for Sides {
    fn default() -> Sides {
        Sides { inside: Bounds::ALL, outside: Bounds::ALL }
    }
}

impl Sides {
    /// Those of the complement, if `negate`.
    pub(crate) fn flip_if(self, negate: bool) -> Sides {
        if negate { Sides { inside: self.outside, outside: self.inside } } else { self }
    }

    /// Those of a join of two.
    pub(crate) fn join(self, op: Op, other: Sides) -> Sides {
        match op {
            Op::Or => {
                Sides { inside: self.inside.union(&other.inside), outside: self.outside.intersection(&other.outside) }
            }
            Op::And => {
                Sides { inside: self.inside.intersection(&other.inside), outside: self.outside.union(&other.outside) }
            }
        }
    }

    /// Where an operand of `op` decides anything: outside of it the operand is the neutral
    /// element of the operation.
    pub(crate) fn decisive(self, op: Op) -> Bounds {
        match op {
            Op::Or => self.inside,
            Op::And => self.outside,
        }
    }
}

impl Program {
    /// A box around what is inside, of the region that the program is narrowed to.
    pub(crate) fn reach(&self) -> Bounds {
        let mut sides: Vec<Sides> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes[..] {
            let operands = self.list(node).iter().map(|e| sides[e.node()].flip_if(e.negated()));
            let found = match &node.kind {
                Kind::Leaf(leaf) => {
                    let instance = self.instance(*leaf);
                    let is_placed = self.frames.binary_search(&instance.frame).is_err();
                    let inside = if is_placed { instance.bounds } else { Bounds::ALL };
                    Sides { inside, outside: Bounds::ALL }
                }
                Kind::Join { op, rule: Rule::MinMax, .. } => {
                    operands.reduce(|all, next| all.join(*op, next)).unwrap_or_default()
                }
                Kind::Join { .. } | Kind::Shift(_) => Sides::default(),
            };
            sides.push(found);
        }
        sides[self.root.node()].flip_if(self.root.negated()).inside
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::eval::Region;
    use crate::{Bounds, Solid};

    #[test]
    fn what_is_inside_is_within_reach() {
        let solid = (Solid::sphere(1.0) | Solid::sphere(0.5).translate(DVec3::new(2.0, 0.3, 0.0)))
            - Solid::cuboid([0.6, 4.0, 4.0])
            - Solid::half_space(DVec3::Z, -0.2);
        let program = solid.surface_program().expect("the solid is valid");
        let mut clipped = 0;
        for number in 0..512 {
            let at = |shift: u32| f64::from(number >> shift & 7) / 7.0;
            let min = DVec3::new(-1.2 + 3.4 * at(0), -1.2 + 2.0 * at(3), -1.2 + 2.0 * at(6));
            let region = Bounds::new(min, min + 0.6);
            let Region::Surface(narrowed) = program.narrow(&region) else { continue };
            let reach = narrowed.reach();
            clipped += u32::from(!region.min.cmpge(reach.min).all() || !region.max.cmple(reach.max).all());
            for point in 0..216 {
                let step = |by: u32| f64::from(point / by % 6) / 5.0;
                let p = region.min + region.size() * DVec3::new(step(1), step(6), step(36));
                assert!(program.value(p) <= 0.0 || reach.contains(p), "{p} of {region:?}, reach {reach:?}");
            }
        }
        assert!(clipped > 20, "{clipped}");
    }
}
