//! Programs under construction: one list of nodes that the field and the surface program
//! share, with boxes put together from the leaves up.

use glam::DVec3;

use super::hierarchy::Reach;
use super::program::{Edge, Kind, Node};
use super::sides::Sides;
use super::swell::Swell;
use crate::Bounds;
use crate::solid::Operation;
use rvachev_field::Op;
use rvachev_field::{RicciSide, Rule};

/// What a node compiled to.
#[derive(Clone, Copy)]
pub(super) struct Built {
    /// The node of true values.
    pub(super) field: Edge,
    /// The node of the surface program: R-functions are min and max.
    pub(super) surface: Edge,
    /// In the frame of the node's context.
    pub(super) sides: Sides,
    /// Where the true value is above −c.
    pub(super) swell: Swell,
    /// The radius of a value `radius·(1 − G)`, where it is one.
    pub(super) gauge: Option<f64>,
}

impl Built {
    pub(super) fn complement(self) -> Built {
        Built {
            field: self.field.flip_if(true),
            surface: self.surface.flip_if(true),
            sides: self.sides.flip_if(true),
            swell: Swell::unknown(self.sides.outside),
            gauge: None,
        }
    }

    fn flip_if(self, flip: bool) -> Built {
        if flip { self.complement() } else { self }
    }
}

#[derive(Default)]
pub(super) struct Code {
    pub(super) nodes: Vec<Node>,
    pub(super) operands: Vec<Edge>,
    /// Where each operand matters to its join, in the frame of that.
    pub(super) reaches: Vec<Reach>,
}

/// An operand of a join, and where it is.
#[derive(Clone, Copy)]
struct Operand {
    edge: Edge,
    sides: Sides,
}

impl Operand {
    fn flip_if(self, negate: bool) -> Operand {
        Operand { edge: self.edge.flip_if(negate), sides: self.sides.flip_if(negate) }
    }
}

impl Code {
    pub(super) fn push(&mut self, kind: Kind, operands: &[(Edge, Reach)]) -> Edge {
        let first = self.operands.len() as u32;
        self.operands.extend(operands.iter().map(|(edge, _)| *edge));
        self.reaches.extend(operands.iter().map(|(_, reach)| *reach));
        self.nodes.push(Node { kind, first, len: operands.len() as u32 });
        Edge::new(self.nodes.len() - 1)
    }

    fn join(&mut self, op: Op, rule: Rule, frame: u32, operands: &[Operand]) -> Operand {
        if let [only] = operands {
            return *only;
        }
        let list: Vec<(Edge, Reach)> = operands.iter().map(|o| (o.edge, Reach::fixed(o.sides.decisive(op)))).collect();
        let sides = operands.iter().map(|o| o.sides).reduce(|a, b| a.join(op, b)).unwrap_or_default();
        Operand { edge: self.push(Kind::Join { op, rule, frame, hierarchy: None }, &list), sides }
    }

    /// Joins many operands: at once if the order does not matter, else as a balanced tree.
    fn join_all(&mut self, op: Op, rule: Rule, frame: u32, operands: &[Operand]) -> Operand {
        if matches!(rule, Rule::MinMax | Rule::Associative(_) | Rule::Distance) {
            return self.join(op, rule, frame, operands);
        }
        self.balanced(operands.to_vec(), |code, a, b| code.join(op, rule, frame, &[a, b]))
    }

    /// Exactly one of two; folded over more, an odd number of them.
    fn either_all(&mut self, rule: Rule, frame: u32, operands: Vec<Operand>) -> Operand {
        self.balanced(operands, |code, a, b| {
            let first = code.join(Op::And, rule, frame, &[a, b.flip_if(true)]);
            let second = code.join(Op::And, rule, frame, &[a.flip_if(true), b]);
            code.join(Op::Or, rule, frame, &[first, second])
        })
    }

    fn balanced<T: Copy>(&mut self, operands: Vec<T>, mut join: impl FnMut(&mut Code, T, T) -> T) -> T {
        let mut level = operands;
        while level.len() > 1 {
            let pairs = level.chunks(2);
            level = pairs.map(|pair| if let [a, b] = *pair { join(self, a, b) } else { pair[0] }).collect();
        }
        level[0]
    }

    /// What is in exactly one of the operands.
    pub(super) fn either(&mut self, rule: Rule, frame: u32, built: &[Built]) -> Built {
        let pick = |edge: fn(&Built) -> Edge| -> Vec<Operand> {
            built.iter().map(|b| Operand { edge: edge(b), sides: b.sides }).collect()
        };
        let (field, surface) = (pick(|b| b.field), pick(|b| b.surface));
        let (field, surface) = (self.either_all(rule, frame, field), self.either_all(Rule::MinMax, frame, surface));
        let (sides, swell) = (surface.sides, Swell::unknown(surface.sides.inside));
        Built { field: field.edge, surface: surface.edge, sides, swell, gauge: None }
    }

    /// A union, an intersection or a difference by an R-function.
    pub(super) fn operation(&mut self, operation: Operation, rule: Rule, frame: u32, built: &[Built]) -> Built {
        // A difference is the conjunction of the first with the complements of the others.
        let negated = |i: usize| operation == Operation::Difference && i > 0;
        let pick = |edge: fn(&Built) -> Edge| -> Vec<Operand> {
            let operand = |(i, b): (usize, &Built)| Operand { edge: edge(b), sides: b.sides }.flip_if(negated(i));
            built.iter().enumerate().map(operand).collect()
        };
        let (field, surface) = (pick(|b| b.field), pick(|b| b.surface));
        let op = operation.op();
        let (field, surface) = (self.join_all(op, rule, frame, &field), self.join(op, Rule::MinMax, frame, &surface));
        let swells = built.iter().enumerate().map(|(i, b)| b.flip_if(negated(i)).swell).collect();
        let swell = Swell::joined(op, rule, swells);
        Built { field: field.edge, surface: surface.edge, sides: surface.sides, swell, gauge: None }
    }

    /// Values moved by `by`.
    pub(super) fn level(&mut self, by: f64, operand: Built) -> Built {
        let edge = self.push(Kind::Shift(by), &[(operand.field, Reach::fixed(Bounds::ALL))]);
        let mut sides = operand.sides;
        if by > 0.0 {
            sides.inside = operand.swell.above(by).unwrap_or(Bounds::ALL);
        } else if by < 0.0 {
            sides.outside = Bounds::ALL;
        }
        Built { field: edge, surface: edge, sides, swell: operand.swell.level(by), gauge: None }
    }

    /// The end face and the sides of an extrusion, both moved in by `size`, joined by a rule that
    /// moves them back.
    pub(super) fn rim(&mut self, rule: Rule, size: f64, frame: u32, pair: [Built; 2]) -> Built {
        let edge = self.pair(Operation::Intersection, rule, frame, pair);
        let whole = pair.map(|b| b.swell.above(size).map_or(Bounds::ALL, snug));
        let sides = Sides { inside: whole[0].intersection(&whole[1]), outside: Bounds::ALL };
        let swell = Swell::rim(sides.inside, pair.map(|b| b.swell));
        Built { field: edge, surface: edge, sides, swell, gauge: None }
    }

    /// A node that joins two values, the second complemented for a difference.
    fn pair(&mut self, operation: Operation, rule: Rule, frame: u32, pair: [Built; 2]) -> Edge {
        let negate = operation == Operation::Difference && !matches!(rule, Rule::Ricci { .. });
        let op = if matches!(rule, Rule::Ricci { .. }) { Op::And } else { operation.op() };
        // What x ∧ ¬y reads of its operands is what ¬x ∨ y does.
        let operand = |built: Built, negate: bool| {
            let swell = if negate == (op == Op::And) { built.swell } else { built.complement().swell };
            (built.field.flip_if(negate), swell.reaching())
        };
        self.push(Kind::Join { op, rule, frame, hierarchy: None }, &[operand(pair[0], false), operand(pair[1], negate)])
    }

    /// A smooth join; `inside` holds a union.
    pub(super) fn smooth(
        &mut self,
        operation: Operation,
        width: f64,
        frame: u32,
        pair: [Built; 2],
        inside: Bounds,
    ) -> Built {
        let edge = self.pair(operation, Rule::Smooth(width), frame, pair);
        let [a, b] = [pair[0], pair[1].flip_if(operation == Operation::Difference)];
        let mut sides = a.sides.join(operation.op(), b.sides);
        match operation.op() {
            Op::Or => sides.inside = inside,
            Op::And => sides.outside = Bounds::ALL,
        }
        let swell = Swell::joined(operation.op(), Rule::Smooth(width), vec![a.swell, b.swell]);
        Built { field: edge, surface: edge, sides, swell, gauge: None }
    }

    pub(super) fn displacement(
        &mut self,
        operation: Operation,
        height: f64,
        inverse: [f64; 2],
        frame: u32,
        pair: [Built; 2],
        risen: [Bounds; 2],
    ) -> Built {
        // The rule is told as a conjunction; a disjunction turns its result round.
        let turned = if operation.op() == Op::Or { -height } else { height };
        let edge = self.pair(operation, Rule::Displacement { height: turned, inverse }, frame, pair);
        let [a, b] = [pair[0], pair[1].flip_if(operation == Operation::Difference)];
        let inside = match operation {
            _ if height <= 0.0 => a.sides.join(operation.op(), b.sides).inside,
            Operation::Union => risen[0].union(&risen[1]),
            Operation::Difference => risen[0],
            _ => risen[0].intersection(&risen[1]),
        };
        let sides = Sides { inside, outside: Bounds::ALL };
        Built { field: edge, surface: edge, sides, swell: Swell::unknown(inside), gauge: None }
    }

    pub(super) fn ricci(
        &mut self,
        operation: Operation,
        p: f64,
        radii: [f64; 2],
        frame: u32,
        pair: [Built; 2],
        risen: [Bounds; 2],
    ) -> Built {
        let radius = radii[0].min(radii[1]);
        let side = match operation {
            Operation::Union => RicciSide::Union,
            Operation::Difference => RicciSide::Difference,
            _ => RicciSide::Intersection,
        };
        let edge = self.pair(operation, Rule::Ricci { p, side, radii, radius }, frame, pair);
        let inside = match side {
            RicciSide::Union => risen[0].union(&risen[1]),
            RicciSide::Intersection => pair[0].sides.inside.intersection(&pair[1].sides.inside),
            RicciSide::Difference => pair[0].sides.inside,
        };
        let sides = Sides { inside, outside: Bounds::ALL };
        Built { field: edge, surface: edge, sides, swell: Swell::unknown(inside), gauge: Some(radius) }
    }
}

/// A box grown by a length along each axis; where that is infinite the box ends nowhere.
pub(super) fn grow(bounds: &Bounds, by: DVec3) -> Bounds {
    if bounds.is_empty() {
        return if by.is_finite() { *bounds } else { Bounds::ALL };
    }
    Bounds::new(bounds.min - by, bounds.max + by)
}

/// A box grown by what rounding may have taken from it.
pub(super) fn snug(bounds: Bounds) -> Bounds {
    if bounds.is_empty() {
        return Bounds::EMPTY;
    }
    let grow = |v: f64| if v.is_finite() { 1e-14 * v.abs() } else { 0.0 };
    let mut grown = bounds;
    for axis in 0..3 {
        let margin = grow(bounds.min[axis]).max(grow(bounds.max[axis]));
        grown.min[axis] -= margin;
        grown.max[axis] += margin;
    }
    grown
}
