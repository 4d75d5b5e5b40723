//! Flattening: nested joins of one kind become one, its operands ordered in space.

use std::sync::Arc;

use super::code::Code;
use super::hierarchy::Hierarchy;
use super::program::{Edge, Kind, Node};
use crate::{Bounds, Cancelled, Run};
use rvachev_field::Rule;

/// The program that `root` reaches, with every min or max that is used once and by one of its
/// own kind (after De Morgan) merged into that one.
pub(super) fn flatten(code: &Code, root: Edge, run: &Run) -> Result<(Vec<Node>, Vec<Edge>, Edge), Cancelled> {
    let count = code.nodes.len();
    let mut uses = vec![0u32; count];
    let mut merged = vec![false; count];
    uses[root.node()] = 1;
    // Operands come before operators: walking down, every use is counted before it matters.
    for at in (0..count).rev() {
        if uses[at] > 0 {
            for edge in &code.operands[code.nodes[at].range()] {
                uses[edge.node()] += 1;
            }
        }
    }
    for at in 0..count {
        let Kind::Join { op, rule: Rule::MinMax, frame, .. } = &code.nodes[at].kind else { continue };
        if uses[at] == 0 {
            continue;
        }
        for edge in &code.operands[code.nodes[at].range()] {
            if let Kind::Join { op: below, rule: Rule::MinMax, frame: inner, .. } = &code.nodes[edge.node()].kind {
                merged[edge.node()] = uses[edge.node()] == 1 && inner == frame && below.flip_if(edge.negated()) == *op;
            }
        }
    }
    let mut nodes: Vec<Node> = Vec::new();
    let mut list: Vec<Edge> = Vec::new();
    let mut moved = vec![0usize; count];
    for at in 0..count {
        run.check()?;
        if uses[at] == 0 || merged[at] {
            continue;
        }
        let mut node = code.nodes[at].clone();
        let first = list.len() as u32;
        if let Kind::Join { rule: Rule::MinMax, hierarchy, .. } = &mut node.kind {
            let mut operands = gather(code, &merged, at);
            run.check()?;
            Hierarchy::sort(&mut operands);
            run.check()?;
            list.extend(operands.iter().map(|(edge, _)| edge.to(moved[edge.node()])));
            let boxes: Vec<Bounds> = operands.iter().map(|(_, bounds)| *bounds).collect();
            *hierarchy = Hierarchy::new(boxes).map(Arc::new);
        } else {
            list.extend(code.operands[node.range()].iter().map(|edge| edge.to(moved[edge.node()])));
        }
        (node.first, node.len) = (first, list.len() as u32 - first);
        moved[at] = nodes.len();
        nodes.push(node);
    }
    let root = root.to(moved[root.node()]);
    Ok((nodes, list, root))
}

/// The operands of a join and of all that is merged into it, from left to right.
fn gather(code: &Code, merged: &[bool], join: usize) -> Vec<(Edge, Bounds)> {
    let mut operands = Vec::new();
    let mut pending = vec![(Edge::new(join), Bounds::ALL)];
    while let Some((edge, bounds)) = pending.pop() {
        if edge.node() == join || merged[edge.node()] {
            for i in code.nodes[edge.node()].range().rev() {
                // A merged join is of the kind that its parent is, so where its operands
                // decide is told for that kind.
                pending.push((code.operands[i].flip_if(edge.negated()), code.decisive[i]));
            }
        } else {
            operands.push((edge, bounds));
        }
    }
    operands
}
