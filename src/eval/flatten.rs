//! Flattening: nested joins of one kind become one, its operands ordered in space.
//!
//! Those of min and max have no order; a chain of smooth joins is one join whose operands stay in
//! the order of the chain.

use std::sync::Arc;

use super::code::Code;
use super::hierarchy::{Hierarchy, Reach};
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
        let Kind::Join { op, rule, frame, .. } = &code.nodes[at].kind else { continue };
        if uses[at] == 0 || !matches!(rule, Rule::MinMax | Rule::Smooth(_)) {
            continue;
        }
        for edge in &code.operands[code.nodes[at].range()] {
            if let Kind::Join { op: below, rule: own, frame: inner, .. } = &code.nodes[edge.node()].kind {
                let is_like = (rule, frame) == (own, inner) && below.flip_if(edge.negated()) == *op;
                merged[edge.node()] = is_like && uses[edge.node()] == 1;
            }
            if merged[edge.node()] && *rule != Rule::MinMax {
                // A chain goes on in one operand.
                break;
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
        match &mut node.kind {
            Kind::Join { rule: Rule::MinMax, hierarchy, .. } => {
                let mut operands = gather(code, &merged, at);
                run.check()?;
                Hierarchy::sort(&mut operands);
                run.check()?;
                list.extend(operands.iter().map(|(edge, _)| edge.to(moved[edge.node()])));
                let reaches = operands.iter().map(|(_, reach)| *reach).collect();
                *hierarchy = Hierarchy::new(reaches, Vec::new()).map(Arc::new);
            }
            Kind::Join { rule: Rule::Smooth(_), hierarchy, .. } => {
                let operands = gather(code, &merged, at);
                list.extend(operands.iter().map(|(edge, _)| edge.to(moved[edge.node()])));
                run.check()?;
                let mut numbered: Vec<(u32, Reach)> = (0..).zip(operands.iter().map(|(_, reach)| *reach)).collect();
                Hierarchy::sort(&mut numbered);
                run.check()?;
                let (numbers, reaches) = numbered.into_iter().unzip();
                *hierarchy = Hierarchy::new(reaches, numbers).map(Arc::new);
            }
            _ => list.extend(code.operands[node.range()].iter().map(|edge| edge.to(moved[edge.node()]))),
        }
        (node.first, node.len) = (first, list.len() as u32 - first);
        moved[at] = nodes.len();
        nodes.push(node);
    }
    let root = root.to(moved[root.node()]);
    Ok((nodes, list, root))
}

/// The operands of a join and of all that is merged into it, from left to right; of a chain from
/// its first link on.
fn gather(code: &Code, merged: &[bool], join: usize) -> Vec<(Edge, Reach)> {
    let mut operands = Vec::new();
    let mut pending = vec![(Edge::new(join), Reach::fixed(Bounds::ALL))];
    while let Some((edge, reach)) = pending.pop() {
        if edge.node() == join || merged[edge.node()] {
            // A merged join is of the kind that its parent is, so where its operands
            // matter is told for that kind.
            let below =
                code.nodes[edge.node()].range().map(|i| (code.operands[i].flip_if(edge.negated()), code.reaches[i]));
            let (on, own): (Vec<_>, Vec<_>) = below.partition(|(edge, _)| merged[edge.node()]);
            pending.extend(own.into_iter().rev());
            pending.extend(on.into_iter().rev());
        } else {
            operands.push((edge, reach));
        }
    }
    operands
}
