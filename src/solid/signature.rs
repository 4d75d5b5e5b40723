//! What a node is, without its operands: the ground of equality, hashing, sharing and of what
//! is written out. A new kind of node says here what its parameters are.

use std::any::{Any, TypeId};
use std::collections::{HashMap, HashSet};
use std::mem::{Discriminant, discriminant};

use super::composed::replace;
use super::{Node, Solid};

impl Node {
    /// The parameters as text, without the operands. Nodes of one kind, name and type with
    /// the same text are the same: `Debug` of a number gives it exactly.
    pub(super) fn parameters(&self) -> String {
        match self {
            Node::Leaf(field) => format!("{field:?}"),
            Node::Affine { forward, .. } => format!("{:?}", forward.to_cols_array()),
            Node::Warp { warp, .. } => format!("{warp:?}"),
            Node::Join { rule, .. } => format!("by {rule:?}"),
            Node::Complement(_) => String::new(),
            Node::Named { name, .. } => name.to_string(),
            Node::Painted { paint, .. } => {
                let [r, g, b] = paint.color;
                format!("#{r:02x}{g:02x}{b:02x}, roughness {:?}", paint.roughness)
            }
            Node::Blend { blend, .. } => format!("by {blend:?}"),
            Node::Length { length, .. } => format!("by {:?}", length.amount()),
            Node::Repeated { repetition, .. } => repetition.to_string(),
            Node::Toleranced { tolerance, .. } => format!("{tolerance:?}"),
            Node::Swept { sweep, .. } => sweep.to_string(),
            Node::Rim { caps, .. } => format!("{caps:?}"),
        }
    }

    /// The type behind the pointer of a leaf or a deformation.
    fn kind(&self) -> Option<TypeId> {
        let any: &dyn Any = match self {
            Node::Leaf(field) => &**field,
            Node::Warp { warp, .. } => &**warp,
            Node::Affine { .. }
            | Node::Join { .. }
            | Node::Complement(_)
            | Node::Named { .. }
            | Node::Painted { .. }
            | Node::Blend { .. }
            | Node::Repeated { .. }
            | Node::Toleranced { .. }
            | Node::Swept { .. }
            | Node::Rim { .. }
            | Node::Length { .. } => return None,
        };
        Some(any.type_id())
    }

    /// This node with other operands, as many as it has.
    pub(super) fn with_operands(&self, operands: Vec<Solid>) -> Node {
        match self {
            Node::Blend { operation, blend, tolerance, .. } => {
                return super::blend::node(*operation, operands, *blend, *tolerance);
            }
            Node::Length { length, tolerance, .. } => {
                if let [operand] = &operands[..] {
                    return super::length::node(operand, *length, *tolerance);
                }
            }
            Node::Toleranced { tolerance, .. } => {
                if let [operand] = &operands[..] {
                    return super::tolerance::node(operand, *tolerance);
                }
            }
            _ => {}
        }
        let mut node = self.clone();
        match (&mut node, &operands[..]) {
            (Node::Repeated { built, .. }, [new]) => replace([built], &self.operands()[0], new),
            (Node::Swept { built, ball, .. }, [new]) => {
                replace([built].into_iter().chain(ball), &self.operands()[0], new)
            }
            _ => {}
        }
        let places = match &mut node {
            Node::Leaf(_) => &mut [],
            Node::Affine { operand, .. }
            | Node::Warp { operand, .. }
            | Node::Complement(operand)
            | Node::Length { operand, .. }
            | Node::Named { operand, .. }
            | Node::Repeated { operand, .. }
            | Node::Toleranced { operand, .. }
            | Node::Painted { operand, .. } => std::slice::from_mut(operand),
            Node::Swept { profile, .. } => std::slice::from_mut(&mut profile.0),
            Node::Blend { operands, .. } | Node::Join { operands, .. } | Node::Rim { operands, .. } => {
                &mut operands[..]
            }
        };
        for (place, operand) in places.iter_mut().zip(operands) {
            *place = operand;
        }
        node
    }
}

/// A node: equal to that of another if the nodes are the same, given numbers that stand for
/// the operands. How an affine map was spelt is no part of it.
#[derive(PartialEq, Eq, Hash)]
pub(super) struct Signature {
    variant: Discriminant<Node>,
    kind: Option<TypeId>,
    name: &'static str,
    parameters: String,
    operands: Vec<u64>,
}

impl Signature {
    pub(super) fn new(node: &Node, operands: Vec<u64>) -> Signature {
        let name = if matches!(node, Node::Affine { .. }) { "" } else { node.name() };
        let parameters = match node {
            // What is written out may leave out what is long.
            Node::Leaf(field) => field.signature(),
            // What is built within a tolerance has it in its nodes, which are not written out.
            Node::Length { tolerance: Some(tolerance), .. } | Node::Blend { tolerance: Some(tolerance), .. } => {
                format!("{} within {tolerance:?}", node.parameters())
            }
            _ => node.parameters(),
        };
        // What is told in some places is not what is told all over.
        let parameters = match node {
            Node::Length { about: Some(blend), .. } => format!("{parameters} about {blend:?}"),
            _ => parameters,
        };
        Signature { variant: discriminant(node), kind: node.kind(), name, parameters, operands }
    }
}

/// Every node of a graph once, operands before operators.
pub(super) fn in_order(root: &Solid) -> Vec<&Solid> {
    let mut met = HashSet::new();
    let mut order = Vec::new();
    let mut pending = vec![(root, false)];
    while let Some((solid, finished)) = pending.pop() {
        if finished {
            order.push(solid);
        } else if met.insert(solid.address()) {
            pending.push((solid, true));
            pending.extend(solid.node().operands().iter().map(|operand| (operand, false)));
        }
    }
    order
}

/// Numbers for solids: two have the same number if and only if they are equal.
#[derive(Default)]
pub(crate) struct Numbering {
    of_signature: HashMap<Signature, u64>,
    of_address: HashMap<usize, u64>,
    /// The first solid with each number.
    first: Vec<Solid>,
    /// What has been numbered is kept, so that no address is used again.
    kept: Vec<Solid>,
}

impl Numbering {
    /// The number of a solid whose operands have been numbered.
    fn add(&mut self, solid: &Solid) -> u64 {
        if let Some(&number) = self.of_address.get(&solid.address()) {
            return number;
        }
        let operands = solid.node().operands().iter().map(|operand| self.of_address[&operand.address()]).collect();
        let next = self.first.len() as u64;
        let number = *self.of_signature.entry(Signature::new(solid.node(), operands)).or_insert(next);
        if number == next {
            self.first.push(solid.clone());
        }
        self.of_address.insert(solid.address(), number);
        self.kept.push(solid.clone());
        number
    }

    /// The number of a solid.
    pub(crate) fn number(&mut self, root: &Solid) -> u64 {
        for solid in in_order(root) {
            self.add(solid);
        }
        self.of_address[&root.address()]
    }

    /// The number of a solid that is part of one that has a number.
    pub(crate) fn of(&self, solid: &Solid) -> u64 {
        self.of_address[&solid.address()]
    }

    /// The first solid that was equal to this one, whose operands have been through here.
    pub(super) fn shared(&mut self, solid: &Solid) -> Solid {
        let number = self.add(solid);
        self.first[number as usize].clone()
    }
}
