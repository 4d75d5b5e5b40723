//! Where a solid's own value is the true distance, so that lengths need nothing else.
//!
//! ```text
//!                              inside                outside
//!     leaf by distance         yes                   yes
//!     union                    no                    if it is outside of all operands
//!     intersection             if inside of all      no
//!     complement               as outside            as inside
//!     rigid map, uniform scale as the operand        as the operand
//!     offset outwards          of convex ones        always
//!     offset inwards           always                of leaves that stay of their kind
//! ```
//!
//! A box that is moved in is a smaller box, whose distance is known outside as well. Moved out
//! again it is rounded, and, as it is convex, its distance is known everywhere. A convex solid has
//! no concave edges to fill.
//!
//! How deep a solid can be at most is told the same way: half of a leaf's box, a wall's thickness.
//!
//! R-functions count as min and max, which is what lengths make of them. Of all else nothing is
//! known: deformations, blends, repetitions in a deformed space.

use glam::DAffine3;

use super::context::is_similarity;
use super::known::Known;
use crate::solid::{Length, Node, Operation, Sweep};
use crate::{Angle, Cancelled, Caps, Extrusion, RFunction, Run, Solid};

/// On which side a value is the true distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exact {
    pub(super) inside: bool,
    pub(super) outside: bool,
    /// Whether the solid is convex.
    convex: bool,
    /// No point is farther inside than this.
    deepest: f64,
}

impl Exact {
    const NEITHER: Exact = Exact { inside: false, outside: false, convex: false, deepest: f64::INFINITY };

    fn complement(self) -> Exact {
        Exact { inside: self.outside, outside: self.inside, ..Exact::NEITHER }
    }

    /// On both sides.
    fn both(self) -> bool {
        self.inside && self.outside
    }

    fn deep(self, deepest: f64) -> Exact {
        Exact { deepest, ..self }
    }
}

/// Where the values of the nodes of a graph are distances.
pub(super) type Exactness = Known<Exact>;

impl Exactness {
    /// Finds it out for a solid and all that it is made of. Leaves are prepared on the way.
    pub(super) fn add(&mut self, root: &Solid, run: &Run) -> Result<(), Cancelled> {
        let found = |known: &Exactness, solid: &Solid| {
            if let Node::Leaf(field) = solid.node() {
                field.prepare(run)?;
            }
            Ok(known.found(solid))
        };
        self.find(root, |solid| solid.node().parts().iter().chain(solid.node().ball()), found, run)
    }

    /// Where the value of a solid is a distance.
    pub(super) fn of(&self, solid: &Solid) -> Exact {
        self.get(solid).copied().unwrap_or(Exact::NEITHER)
    }

    /// Whether a length is a matter of its operand's own value.
    pub(super) fn is_closed(&self, solid: &Solid) -> bool {
        let Node::Length { operand, length, .. } = solid.node() else { return false };
        let exact = self.of(operand);
        match *length {
            Length::Level(_) => true,
            Length::Offset(d) => d == 0.0 || if d > 0.0 { exact.outside } else { exact.inside },
            Length::Shell(_) => exact.inside,
            Length::Rounded(radius) => erodes(operand, radius),
            Length::Filleted(_) => exact.convex,
        }
    }

    /// Whether a length is closed, and it is known that something is left of its operand.
    pub(super) fn is_certain(&self, solid: &Solid) -> bool {
        let Node::Length { operand, length, .. } = solid.node() else { return false };
        self.is_closed(solid) && (length.inwards() <= 0.0 || erodes(operand, length.inwards()))
    }

    /// Whether it is known before anything is measured that nothing is left of a length's operand
    /// where the length is taken away.
    pub(super) fn is_gone(&self, solid: &Solid) -> bool {
        let Node::Length { operand, length, ball, .. } = solid.node() else { return false };
        match ball {
            Some(ball) => self.is_gone(ball),
            None => self.of(operand).deepest <= length.inwards(),
        }
    }

    fn found(&self, solid: &Solid) -> Exact {
        let node = solid.node();
        let mut operands = node.parts().iter().map(|part| self.of(part));
        let first = node.parts().first().map_or(Exact::NEITHER, |part| self.of(part));
        match node {
            Node::Leaf(field) => {
                let is_exact = field.exact() && !field.jumps();
                let deepest = 0.5 * field.bounds_under(&DAffine3::IDENTITY).size().min_element().max(0.0);
                Exact { inside: is_exact, outside: is_exact, convex: field.convex(), deepest }
            }
            Node::Affine { forward, .. } if !is_similarity(&forward.matrix3) => {
                Exact { convex: first.convex, ..Exact::NEITHER }
            }
            Node::Affine { forward, .. } => first.deep(first.deepest * forward.matrix3.x_axis.length()),
            Node::Named { .. } | Node::Painted { .. } => first,
            Node::Swept { .. } if let Some(parts) = upright(node) => {
                let [slab, column] = [&parts[0], &parts[1]].map(|part| self.of(part));
                let (is_exact, convex) = (slab.both() && column.both(), slab.convex && column.convex);
                Exact { inside: is_exact, outside: is_exact, convex, ..first }
            }
            Node::Repeated { .. } | Node::Toleranced { .. } | Node::Swept { .. } => first,
            Node::Complement(_) => first.complement(),
            Node::Join { operation: Operation::Union, .. } => {
                Exact { outside: operands.all(|exact| exact.outside), ..Exact::NEITHER }
            }
            Node::Join { operation: Operation::Intersection, .. } => {
                let deepest = operands.clone().map(|exact| exact.deepest).fold(f64::INFINITY, f64::min);
                let convex = operands.clone().all(|exact| exact.convex);
                Exact { inside: operands.all(|exact| exact.inside), outside: false, convex, deepest }
            }
            Node::Join { operation: Operation::Difference, .. } => {
                let is_exact = first.inside && operands.skip(1).all(|exact| exact.outside);
                Exact { inside: is_exact, outside: false, convex: false, deepest: first.deepest }
            }
            Node::Length { length, .. } => match *length {
                Length::Offset(d) if d > 0.0 => {
                    let inside = first.both() && first.convex;
                    Exact { inside, outside: true, convex: first.convex, ..Exact::NEITHER }
                }
                Length::Offset(d) if d < 0.0 => {
                    let outside = node.operands().iter().all(|operand| erodes(operand, -d));
                    Exact { inside: true, outside, convex: first.convex, deepest: (first.deepest + d).max(0.0) }
                }
                Length::Offset(_) => first,
                Length::Shell(t) => Exact::NEITHER.deep(first.deepest.min(t)),
                Length::Rounded(_) if self.is_closed(solid) => Exact { inside: first.convex, ..first },
                Length::Rounded(_) => Exact { convex: first.convex, ..Exact::NEITHER }.deep(first.deepest),
                Length::Filleted(_) if first.convex => first,
                Length::Level(_) | Length::Filleted(_) => Exact::NEITHER,
            },
            Node::Blend { operation: Operation::Intersection | Operation::Difference, .. } => {
                Exact::NEITHER.deep(first.deepest)
            }
            Node::Warp { .. } | Node::Join { .. } | Node::Blend { .. } | Node::Rim { .. } => Exact::NEITHER,
        }
    }
}

/// Whether leaves are known of all points that are at least `depth` inside, in length units of a
/// solid, whose value is the distance on both sides.
pub(super) fn erodes(solid: &Solid, depth: f64) -> bool {
    /// Depths are rounded on the way to the leaf.
    const MORE: f64 = 1.0 + 1e-12;
    let mut pending = vec![(solid, depth)];
    while let Some((solid, depth)) = pending.pop() {
        let node = solid.node();
        match node {
            Node::Leaf(field) if field.exact() && !field.jumps() && field.eroded(MORE * depth).is_some() => {}
            Node::Affine { operand, forward, .. } if is_similarity(&forward.matrix3) => {
                pending.push((operand, depth / forward.matrix3.x_axis.length()));
            }
            Node::Named { operand, .. } | Node::Painted { operand, .. } => pending.push((operand, depth)),
            Node::Swept { .. } if let Some(parts) = upright(node) => {
                pending.extend(parts.iter().map(|part| (part, depth)));
            }
            _ => return false,
        }
    }
    true
}

/// The slab and the column of an extrusion that stand at right angles to each other throughout.
fn upright(node: &Node) -> Option<&[Solid]> {
    let Node::Swept { sweep: Sweep::Extrude(extrusion), built, .. } = node else { return None };
    let Extrusion { twist, scale, caps, .. } = *extrusion;
    let is_plain = twist == Angle::ZERO && scale == 1.0 && caps == Caps::Flat;
    match built.node() {
        Node::Join { rule: RFunction::Distance, operands, .. } if is_plain && operands.len() == 2 => Some(operands),
        _ => None,
    }
}
