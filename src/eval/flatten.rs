//! Flattening: nested joins of one kind become one, its operands ordered in space.

use std::sync::Arc;

use super::compile::Code;
use super::hierarchy::Hierarchy;
use super::program::{Edge, Node};
use crate::Bounds;

/// The same program with every join that is used once and by a join of its own kind (after
/// De Morgan) merged into that one, and without nodes that the root does not reach.
pub(super) fn flatten(code: Code, root: Edge) -> (Code, Edge) {
    let count = code.nodes.len();
    let mut uses = vec![0u32; count];
    let mut merged = vec![false; count];
    uses[root.node()] = 1;
    // Operands come before operators: walking down, every use is counted before it matters.
    for at in (0..count).rev() {
        if uses[at] == 0 {
            continue;
        }
        if let Node::Join { first, len, .. } = &code.nodes[at] {
            for edge in &code.operands[*first as usize..(first + len) as usize] {
                uses[edge.node()] += 1;
            }
        }
    }
    for at in 0..count {
        let Node::Join { op, first, len, frame, .. } = &code.nodes[at] else { continue };
        for edge in &code.operands[*first as usize..(first + len) as usize] {
            if let Node::Join { op: below, frame: inner, .. } = &code.nodes[edge.node()] {
                merged[edge.node()] =
                    uses[at] > 0 && uses[edge.node()] == 1 && inner == frame && below.flip_if(edge.negated()) == *op;
            }
        }
    }
    let mut flat = Code::default();
    let mut moved = vec![0usize; count];
    for at in 0..count {
        if uses[at] == 0 || merged[at] {
            continue;
        }
        let node = match &code.nodes[at] {
            Node::Leaf(leaf) => Node::Leaf(*leaf),
            Node::Join { op, rule, frame, .. } => {
                let mut operands = gather(&code, &merged, at);
                Hierarchy::sort(&mut operands);
                let first = flat.operands.len() as u32;
                flat.operands.extend(operands.iter().map(|(edge, _)| edge.to(moved[edge.node()])));
                let boxes: Vec<Bounds> = operands.iter().map(|(_, bounds)| *bounds).collect();
                Node::Join {
                    op: *op,
                    rule: *rule,
                    first,
                    len: operands.len() as u32,
                    frame: *frame,
                    hierarchy: Hierarchy::new(boxes).map(Arc::new),
                }
            }
        };
        moved[at] = flat.nodes.len();
        flat.nodes.push(node);
    }
    let root = root.to(moved[root.node()]);
    (flat, root)
}

/// The operands of a join and of all that is merged into it, from left to right.
fn gather(code: &Code, merged: &[bool], join: usize) -> Vec<(Edge, Bounds)> {
    let mut operands = Vec::new();
    let mut pending = vec![(Edge::new(join), Bounds::ALL)];
    while let Some((edge, bounds)) = pending.pop() {
        match &code.nodes[edge.node()] {
            Node::Join { first, len, .. } if edge.node() == join || merged[edge.node()] => {
                for i in (*first as usize..(first + len) as usize).rev() {
                    // A merged join is of the kind that its parent is, so where its operands
                    // decide is told for that kind.
                    pending.push((code.operands[i].flip_if(edge.negated()), code.decisive[i]));
                }
            }
            _ => operands.push((edge, bounds)),
        }
    }
    operands
}
