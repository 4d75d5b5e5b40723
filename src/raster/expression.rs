//! Which operands are joined, and how.
//!
//! A tree is kept as the list of its operations in postfix order, so that no depth of it can
//! exhaust the stack. Two lowered forms are made from it: [`Circuit`], which follows one
//! operand's change to the root, and a union of products (sum of products).
//!
//! Source of the union of products: J. Goldfeather, S. Molnar, G. Turk and H. Fuchs, *Near
//! real-time CSG rendering using tree normalization and geometric pruning* (1989).

use std::fmt;
use std::ops::{BitAnd, BitOr, BitXor, Not, Sub};

use super::error::RasterError;

/// A tree of set operations over operands that are given by number.
///
/// ```
/// use rvachev::raster::Csg;
///
/// let [a, b, c] = [0, 1, 2].map(Csg::operand);
/// let tree = (a | b) - c;
/// assert_eq!(tree.to_string(), "((0 | 1) - 2)");
/// assert!(tree.holds(&[true, false, false]) && !tree.holds(&[true, false, true]));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Csg {
    postfix: Vec<Op>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Op {
    Operand(u32),
    Union,
    Intersection,
    Difference,
    SymmetricDifference,
    Complement,
}

impl Csg {
    /// An operand, by its place in the list of operands, counted from 0.
    #[must_use]
    pub fn operand(index: u32) -> Csg {
        Csg { postfix: vec![Op::Operand(index)] }
    }

    /// What any of these trees holds; `None` if there are none.
    #[must_use]
    pub fn union_all(trees: impl IntoIterator<Item = Csg>) -> Option<Csg> {
        trees.into_iter().reduce(|a, b| a | b)
    }

    /// What all of these trees hold; `None` if there are none.
    #[must_use]
    pub fn intersection_all(trees: impl IntoIterator<Item = Csg>) -> Option<Csg> {
        trees.into_iter().reduce(|a, b| a & b)
    }

    /// Whether the tree holds a point, given which operands hold it. Operands that are not
    /// given do not.
    #[must_use]
    pub fn holds(&self, inside: &[bool]) -> bool {
        let mut stack = Vec::new();
        for op in &self.postfix {
            let value = match op {
                Op::Operand(i) => inside.get(*i as usize).copied().unwrap_or(false),
                Op::Complement => !pop(&mut stack),
                binary => {
                    let (b, a) = (pop(&mut stack), pop(&mut stack));
                    match binary {
                        Op::Union => a | b,
                        Op::Intersection => a & b,
                        Op::Difference => a & !b,
                        _ => a ^ b,
                    }
                }
            };
            stack.push(value);
        }
        pop(&mut stack)
    }

    /// One more than the highest operand that the tree names.
    #[must_use]
    pub fn operands(&self) -> usize {
        let number = |op: &Op| if let Op::Operand(i) = op { *i as usize + 1 } else { 0 };
        self.postfix.iter().map(number).max().unwrap_or(0)
    }

    /// The operations, operands first.
    pub(super) fn postfix(&self) -> &[Op] {
        &self.postfix
    }

    fn join(mut self, other: Csg, op: Op) -> Csg {
        self.postfix.extend(other.postfix);
        self.postfix.push(op);
        self
    }
}

/// The top of a stack of truth values. Postfix lists are made by joins only, so it is there.
fn pop(stack: &mut Vec<bool>) -> bool {
    stack.pop().unwrap_or(false)
}

macro_rules! operators {
    ($($trait:ident $method:ident $op:ident $what:literal;)*) => {$(
        impl $trait for Csg {
            type Output = Csg;
            #[doc = $what]
            fn $method(self, other: Csg) -> Csg {
                self.join(other, Op::$op)
            }
        }
    )*};
}

operators! {
    BitOr bitor Union "What either tree holds.";
    BitAnd bitand Intersection "What both trees hold.";
    Sub sub Difference "What the first tree holds and the second does not.";
    BitXor bitxor SymmetricDifference "What one of the trees holds and the other does not.";
}

impl Not for Csg {
    type Output = Csg;
    /// What the tree does not hold.
    fn not(mut self) -> Csg {
        self.postfix.push(Op::Complement);
        self
    }
}

impl fmt::Display for Csg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // From the root down; what is still to be written lies on the stack.
        enum Part {
            Tree(usize),
            Text(&'static str),
        }
        let starts = starts(&self.postfix);
        let mut stack = vec![Part::Tree(self.postfix.len() - 1)];
        while let Some(part) = stack.pop() {
            let at = match part {
                Part::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Part::Tree(at) => at,
            };
            let sign = match self.postfix[at] {
                Op::Operand(i) => {
                    write!(f, "{i}")?;
                    continue;
                }
                Op::Complement => {
                    f.write_str("!")?;
                    stack.push(Part::Tree(at - 1));
                    continue;
                }
                Op::Union => " | ",
                Op::Intersection => " & ",
                Op::Difference => " - ",
                Op::SymmetricDifference => " ^ ",
            };
            f.write_str("(")?;
            stack.push(Part::Text(")"));
            stack.push(Part::Tree(at - 1));
            stack.push(Part::Text(sign));
            stack.push(Part::Tree(starts[at - 1] - 1));
        }
        Ok(())
    }
}

/// For each operation the place where its operands begin.
fn starts(postfix: &[Op]) -> Vec<usize> {
    let mut starts: Vec<usize> = Vec::with_capacity(postfix.len());
    for (at, op) in postfix.iter().enumerate() {
        starts.push(match op {
            Op::Operand(_) => at,
            Op::Complement => starts[at - 1],
            _ => starts[starts[at - 1] - 1],
        });
    }
    starts
}

/// How a node's children decide its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// All must hold.
    And,
    /// Any must hold.
    Or,
    /// An odd number must hold; turned if the flag is set.
    Odd(bool),
}

/// The tree with complements moved to the leaves and like joins merged: nodes of many children.
/// A change of one operand goes up only as far as it changes something.
pub(super) struct Circuit {
    nodes: Vec<Node>,
    /// For each operand the nodes that it is a child of, and whether as its complement.
    uses: Vec<Vec<(u32, bool)>>,
    /// How many children hold, node by node, with every operand outside.
    start: Vec<u32>,
}

struct Node {
    rule: Rule,
    parent: Option<u32>,
    children: u32,
}

impl Node {
    #[inline]
    fn holds(&self, count: u32) -> bool {
        match self.rule {
            Rule::And => count == self.children,
            Rule::Or => count > 0,
            Rule::Odd(turned) => (count % 2 == 1) != turned,
        }
    }
}

/// Which children hold, at one place on a ray.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    counts: Vec<u32>,
    inside: bool,
}

/// A literal of a product: an operand, or its complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Literal {
    pub(super) operand: u32,
    pub(super) complement: bool,
}

/// An intersection of operands and complements.
pub(super) type Product = Vec<Literal>;

/// A tree that is a union of more products than this takes longer by products than by
/// intervals whatever they are.
pub(super) const MOST_PRODUCTS: usize = 4096;

/// The lists that a walk from the root down makes.
struct Lowered {
    nodes: Vec<Node>,
    leaves: Vec<(u32, Literal)>,
}

/// Walks from the root down. With `expand`, symmetric differences become unions of two
/// differences, which may double the tree; `None` if it grows beyond all use.
fn lower(tree: &Csg, expand: bool) -> Option<Lowered> {
    let postfix = tree.postfix();
    let starts = starts(postfix);
    // The root is the only child of a node, so that every operation has one above it.
    let mut lowered = Lowered { nodes: vec![Node { rule: Rule::Or, parent: None, children: 0 }], leaves: Vec::new() };
    let mut stack = vec![(postfix.len() - 1, false, 0u32)];
    while let Some((at, complement, above)) = stack.pop() {
        if expand && lowered.nodes.len() + lowered.leaves.len() > 16 * MOST_PRODUCTS {
            return None;
        }
        let second = at.saturating_sub(1);
        let first = if starts[at] == at { at } else { starts[second].saturating_sub(1) };
        let (rule, turn_second) = match (postfix[at], complement) {
            (Op::Operand(operand), complement) => {
                lowered.nodes[above as usize].children += 1;
                lowered.leaves.push((above, Literal { operand, complement }));
                continue;
            }
            (Op::Complement, complement) => {
                stack.push((second, !complement, above));
                continue;
            }
            (Op::Union, false) | (Op::Intersection, true) => (Rule::Or, false),
            (Op::Union, true) | (Op::Intersection, false) => (Rule::And, false),
            (Op::Difference, false) => (Rule::And, true),
            (Op::Difference, true) => (Rule::Or, true),
            (Op::SymmetricDifference, turned) if expand => {
                // (a and not b) or (not a and b), the last turned for the complement.
                let or = lowered.under(Rule::Or, above);
                for side in [false, true] {
                    let and = lowered.under(Rule::And, or);
                    stack.push((second, !side ^ turned, and));
                    stack.push((first, side, and));
                }
                continue;
            }
            (Op::SymmetricDifference, turned) => (Rule::Odd(turned), false),
        };
        if let Rule::Odd(turned) = rule {
            let node = match lowered.nodes[above as usize].rule {
                Rule::Odd(before) => {
                    lowered.nodes[above as usize].rule = Rule::Odd(before ^ turned);
                    above
                }
                _ => lowered.under(rule, above),
            };
            stack.extend([(second, false, node), (first, false, node)]);
        } else {
            let node = lowered.under(rule, above);
            stack.extend([(second, complement ^ turn_second, node), (first, complement, node)]);
        }
    }
    Some(lowered)
}

impl Lowered {
    /// The node to which children by `rule` below `above` belong: `above` itself if it has that
    /// rule.
    fn under(&mut self, rule: Rule, above: u32) -> u32 {
        if self.nodes[above as usize].rule == rule && !matches!(rule, Rule::Odd(_)) {
            return above;
        }
        self.nodes[above as usize].children += 1;
        self.nodes.push(Node { rule, parent: Some(above), children: 0 });
        self.nodes.len() as u32 - 1
    }
}

impl Circuit {
    /// The circuit of a tree, of which every operand is below `operands`.
    ///
    /// # Errors
    ///
    /// [`RasterError::Unbounded`] if it holds with every operand outside.
    pub(super) fn new(tree: &Csg, operands: usize) -> Result<Circuit, RasterError> {
        // Without expansion the walk always ends.
        let Some(Lowered { nodes, leaves }) = lower(tree, false) else { return Err(RasterError::Unbounded) };
        let mut start = vec![0; nodes.len()];
        let mut uses = vec![Vec::new(); operands];
        for (node, literal) in leaves {
            uses[literal.operand as usize].push((node, literal.complement));
            start[node as usize] += u32::from(literal.complement);
        }
        // Children come after their parents.
        for node in (1..nodes.len()).rev() {
            if nodes[node].holds(start[node])
                && let Some(parent) = nodes[node].parent
            {
                start[parent as usize] += 1;
            }
        }
        if nodes[0].holds(start[0]) {
            return Err(RasterError::Unbounded);
        }
        Ok(Circuit { nodes, uses, start })
    }

    /// Puts every operand outside.
    pub(super) fn reset(&self, state: &mut State) {
        state.counts.clone_from(&self.start);
        state.inside = false;
    }

    /// Tells that an operand now holds the place, or no longer.
    #[inline]
    pub(super) fn set(&self, state: &mut State, operand: u32, inside: bool) {
        for &(node, complement) in &self.uses[operand as usize] {
            let (mut at, mut holds) = (node as usize, inside != complement);
            loop {
                let node = &self.nodes[at];
                let count = &mut state.counts[at];
                let before = node.holds(*count);
                *count = if holds { *count + 1 } else { *count - 1 };
                let now = node.holds(*count);
                if now == before {
                    break;
                }
                match node.parent {
                    Some(parent) => (at, holds) = (parent as usize, now),
                    None => {
                        state.inside = now;
                        break;
                    }
                }
            }
        }
    }
}

impl State {
    /// Whether the tree holds the place.
    #[inline]
    pub(super) fn is_inside(&self) -> bool {
        self.inside
    }
}

/// The tree as a union of products, without those that hold nothing.
///
/// # Errors
///
/// [`RasterError::Products`] if there are more than [`MOST_PRODUCTS`].
pub(super) fn products(tree: &Csg) -> Result<Vec<Product>, RasterError> {
    let too_many = RasterError::Products { most: MOST_PRODUCTS };
    let Some(Lowered { nodes, leaves }) = lower(tree, true) else { return Err(too_many) };
    let mut own: Vec<Vec<Product>> =
        nodes.iter().map(|node| if node.rule == Rule::And { vec![Product::new()] } else { Vec::new() }).collect();
    let add = |node: usize, child: Vec<Product>, own: &mut Vec<Vec<Product>>| {
        let sum = std::mem::take(&mut own[node]);
        own[node] = combine(nodes[node].rule, sum, child)?;
        Some(())
    };
    for (node, literal) in leaves {
        add(node as usize, vec![vec![literal]], &mut own).ok_or(too_many.clone())?;
    }
    // Children come after their parents.
    for node in (1..nodes.len()).rev() {
        let Some(parent) = nodes[node].parent else { continue };
        let child = std::mem::take(&mut own[node]);
        add(parent as usize, child, &mut own).ok_or(too_many.clone())?;
    }
    let mut all = std::mem::take(&mut own[0]);
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// A node's products joined with those of one more child; `None` if there are too many.
fn combine(rule: Rule, mut own: Vec<Product>, child: Vec<Product>) -> Option<Vec<Product>> {
    if rule == Rule::And {
        if own.len() * child.len() > MOST_PRODUCTS {
            return None;
        }
        return Some(own.iter().flat_map(|a| child.iter().filter_map(|b| product(a, b))).collect());
    }
    own.extend(child);
    if own.len() > MOST_PRODUCTS {
        own.sort_unstable();
        own.dedup();
    }
    (own.len() <= MOST_PRODUCTS).then_some(own)
}

/// The intersection of two products; `None` if it holds an operand and its complement.
fn product(a: &Product, b: &Product) -> Option<Product> {
    let mut both = [a.as_slice(), b].concat();
    both.sort_unstable();
    both.dedup();
    let is_possible = both.windows(2).all(|w| w[0].operand != w[1].operand);
    is_possible.then_some(both)
}
