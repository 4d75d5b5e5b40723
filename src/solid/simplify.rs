//! Simplification: the same values from fewer nodes.
//!
//! Two passes take turns until neither changes anything. One goes from the leaves up and
//! rewrites node by node; the other merges joins by min and max that are nested. Equal parts
//! become one part on the way.
//!
//! R_p and most other rules do not associate, so joins by them stay as they are. Values below
//! an affine map are multiplied by its smallest stretch: two maps in a row become one only if
//! the stretch of their product is the product of their stretches, as it is where one of the
//! two is a rigid motion or a uniform scaling.

use std::collections::{HashMap, HashSet};

use glam::DAffine3;

use super::signature::{Numbering, in_order};
use super::{Node, Operation, Solid};
use crate::RFunction;
use rvachev_field::smallest_stretch;

impl Solid {
    /// An equal solid, with the same values everywhere but for rounding, made of at most as
    /// many nodes:
    ///
    /// * equal parts are stored, and so compiled, once;
    /// * affine maps in a row are multiplied out where that keeps the values, and maps that
    ///   move nothing are dropped;
    /// * the complement of a complement is the solid itself;
    /// * joins of a single operand are that operand;
    /// * nested unions, intersections and differences by [`RFunction::MIN_MAX`] become one
    ///   join without duplicates (a part that is used elsewhere too stays a part).
    ///
    /// [Names](Solid::named) stay, and no map is moved across one. What is wrong with a solid
    /// stays wrong. The solid itself is called equal here by its values: it is `==` to
    /// its simplified form only if there was nothing to simplify.
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    ///
    /// let ball = Solid::sphere(1.0);
    /// let moved = ball.translate([1.0, 0.0, 0.0]).translate([0.0, 2.0, 0.0]);
    /// let part = !!&moved | Solid::union_all([&ball], RFunction::MIN_MAX);
    /// assert_eq!(part.simplified(), ball.translate([1.0, 2.0, 0.0]) | &ball);
    /// ```
    #[must_use]
    pub fn simplified(&self) -> Solid {
        let mut numbering = Numbering::default();
        let mut solid = self.clone();
        loop {
            let reduced = reduce(&solid, &mut numbering);
            let merged = merge(&reduced, &mut numbering);
            if merged.address() == solid.address() {
                return merged;
            }
            solid = merged;
        }
    }
}

/// Rewrites every node from the leaves up, equal nodes being one.
fn reduce(root: &Solid, numbering: &mut Numbering) -> Solid {
    rebuild(root, |solid, made| {
        let operands = solid.node().operands().iter().map(|operand| made[&operand.address()].clone()).collect();
        let mut solid = numbering.shared(&with_operands(solid, operands));
        while let Some(simpler) = simpler(&solid) {
            solid = numbering.shared(&simpler);
        }
        Some(solid)
    })
}

/// Makes every node anew, operands before operators.
fn rebuild(root: &Solid, mut make: impl FnMut(&Solid, &HashMap<usize, Solid>) -> Option<Solid>) -> Solid {
    let mut made: HashMap<usize, Solid> = HashMap::new();
    let mut last = root.clone();
    for solid in in_order(root) {
        if let Some(new) = make(solid, &made) {
            last = new.clone();
            made.insert(solid.address(), new);
        }
    }
    // The root comes last.
    last
}

/// The node with other operands; itself if they are its own.
fn with_operands(solid: &Solid, operands: Vec<Solid>) -> Solid {
    let own = solid.node().operands();
    if own.len() == operands.len() && own.iter().zip(&operands).all(|(a, b)| a.address() == b.address()) {
        return solid.clone();
    }
    match solid.node() {
        Node::Join { operation, rule, .. } => {
            Solid::from_node(Node::Join { operation: *operation, rule: *rule, operands })
        }
        node => Solid::from_node(node.with_operands(operands)),
    }
}

/// One step of rewriting at a node whose operands are simplified and shared.
fn simpler(solid: &Solid) -> Option<Solid> {
    match solid.node() {
        Node::Affine { operand, forward, label } => {
            if *forward == DAffine3::IDENTITY {
                return Some(operand.clone());
            }
            let Node::Affine { operand: inner, forward: first, label: other } = operand.node() else { return None };
            let forward = product(forward, first)?;
            let label = if label == other { label } else { "affine" };
            Some(Solid::from_node(Node::Affine { operand: inner.clone(), forward, label }))
        }
        Node::Complement(operand) => match operand.node() {
            Node::Complement(inner) => Some(inner.clone()),
            _ => None,
        },
        // A rule out of its range stays for the error that it is.
        Node::Join { operands, rule, .. } if operands.len() == 1 && rule.check().is_ok() => Some(operands[0].clone()),
        Node::Join { operation, rule: RFunction::MIN_MAX, operands } => without_duplicates(*operation, operands),
        _ => None,
    }
}

/// The join by min and max without operands that it has twice, if there are any.
fn without_duplicates(operation: Operation, operands: &[Solid]) -> Option<Solid> {
    // The first operand of a difference stands apart.
    let apart = match operation {
        Operation::Union | Operation::Intersection => 0,
        Operation::Difference => 1.min(operands.len()),
        Operation::SymmetricDifference => return None,
    };
    let mut met = HashSet::new();
    let mut kept = operands[..apart].to_vec();
    kept.extend(operands[apart..].iter().filter(|operand| met.insert(operand.address())).cloned());
    let fewer = kept.len() < operands.len();
    fewer.then(|| Solid::from_node(Node::Join { operation, rule: RFunction::MIN_MAX, operands: kept }))
}

/// Two maps in one, if values below keep their scale.
fn product(outer: &DAffine3, inner: &DAffine3) -> Option<DAffine3> {
    let map = *outer * *inner;
    let (separate, together) = (ordinary_stretch(outer)? * ordinary_stretch(inner)?, ordinary_stretch(&map)?);
    ((together - separate).abs() <= 1e-13 * separate).then_some(map)
}

/// The smallest stretch of a map that is far from the limits of what is allowed, so that
/// neither an error nor precision is lost by multiplying it out.
fn ordinary_stretch(map: &DAffine3) -> Option<f64> {
    const LIMIT: f64 = 1e6;
    let within = |v: f64| v.abs() <= LIMIT;
    if !map.to_cols_array().into_iter().all(within) || map.matrix3.determinant() == 0.0 {
        return None;
    }
    let least = smallest_stretch(&map.matrix3);
    let most = 1.0 / smallest_stretch(&map.matrix3.inverse());
    (least >= 1.0 / LIMIT && least * LIMIT >= most).then_some(least)
}

/// Merges joins by min and max into joins that they are operands of.
fn merge(root: &Solid, numbering: &mut Numbering) -> Solid {
    let order = in_order(root);
    let mut uses: HashMap<usize, usize> = HashMap::new();
    for solid in &order {
        for operand in solid.node().operands() {
            *uses.entry(operand.address()).or_default() += 1;
        }
    }
    let mut merged = HashSet::new();
    for solid in &order {
        let Node::Join { operation, rule: RFunction::MIN_MAX, operands } = solid.node() else { continue };
        for (position, operand) in operands.iter().enumerate() {
            if uses[&operand.address()] == 1 && merges(*operation, position, operand.node()) {
                merged.insert(operand.address());
            }
        }
    }
    rebuild(root, |solid, made| {
        if merged.contains(&solid.address()) {
            return None;
        }
        let mut operands = Vec::new();
        let mut pending: Vec<&Solid> = solid.node().operands().iter().rev().collect();
        while let Some(operand) = pending.pop() {
            match made.get(&operand.address()) {
                Some(new) => operands.push(new.clone()),
                None => pending.extend(operand.node().operands().iter().rev()),
            }
        }
        Some(numbering.shared(&with_operands(solid, operands)))
    })
}

/// Whether a join by min and max takes over the operands of `node`, its operand number
/// `position`: a ∪ (b ∪ c), a ∩ (b ∩ c), (a − b) − c, a − (b ∪ c).
fn merges(operation: Operation, position: usize, node: &Node) -> bool {
    let Node::Join { operation: below, rule: RFunction::MIN_MAX, operands } = node else { return false };
    let wanted = match (operation, position) {
        (Operation::Union, _) => Operation::Union,
        (Operation::Intersection, _) => Operation::Intersection,
        (Operation::Difference, 0) => Operation::Difference,
        (Operation::Difference, _) => Operation::Union,
        (Operation::SymmetricDifference, _) => return false,
    };
    // A join without operands stays for the error that it is.
    *below == wanted && !operands.is_empty()
}
