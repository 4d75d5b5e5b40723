//! Programs: a solid as a list of leaves and joins, operands before operators.

use std::sync::Arc;

use super::hierarchy::Hierarchy;
use super::scene::{Instance, Scene};
use crate::solid::Operation;
use rvachev_field::{Op, Rule};

/// A reference to a node's value, or to its negative.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Edge(u32);

impl Edge {
    pub(crate) fn new(node: usize) -> Edge {
        Edge((node as u32) << 1)
    }

    pub(crate) fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(crate) fn negated(self) -> bool {
        self.0 & 1 == 1
    }

    /// The complement, if `negate`.
    pub(crate) fn flip_if(self, negate: bool) -> Edge {
        Edge(self.0 ^ u32::from(negate))
    }

    /// The same sign, another node.
    pub(crate) fn to(self, node: usize) -> Edge {
        Edge((node as u32) << 1 | self.0 & 1)
    }
}

impl Operation {
    /// How its operands are joined; those of a difference after the first are complemented.
    pub(crate) fn op(self) -> Op {
        if self == Operation::Union { Op::Or } else { Op::And }
    }
}

/// A node: what it computes, and its operands `first .. first + len` in the program's list.
#[derive(Clone)]
pub(crate) struct Node {
    pub(crate) kind: Kind,
    pub(crate) first: u32,
    pub(crate) len: u32,
}

#[derive(Clone)]
pub(crate) enum Kind {
    /// A leaf.
    Leaf(u32),
    /// Its operands, joined from the left.
    Join {
        op: Op,
        rule: Rule,
        /// The frame that the operands are joined in.
        frame: u32,
        /// Where the operands are, if they are many.
        hierarchy: Option<Arc<Hierarchy>>,
    },
    /// Its operand plus a number.
    Shift(f64),
}

impl Node {
    /// A node without operands.
    pub(crate) fn leaf(leaf: u32) -> Node {
        Node { kind: Kind::Leaf(leaf), first: 0, len: 0 }
    }

    /// The node's operands among those of its program.
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.len) as usize
    }

    /// The leaf that gives its value, if one does.
    pub(crate) fn valued_by(&self) -> Option<u32> {
        match self.kind {
            Kind::Leaf(leaf) => Some(leaf),
            Kind::Join { .. } | Kind::Shift(_) => None,
        }
    }
}

/// A compiled solid: immutable, cheap to clone, shared between threads.
///
/// [`Solid::surface_program`](crate::Solid::surface_program) makes one whose joins are min
/// and max, for work that asks about the surface;
/// [`Solid::field_program`](crate::Solid::field_program) one of true values. Points go
/// through [`value`](Program::value) and [`gradient`](Program::gradient), many points
/// through a [`Tape`](crate::program::Tape).
///
/// ```
/// use rvachev::program::Region;
/// use rvachev::{Bounds, Solid};
/// use glam::DVec3;
///
/// let pair = Solid::sphere(1.0) | Solid::sphere(1.0).translate(DVec3::X * 5.0);
/// let program = pair.surface_program()?;
/// assert_eq!(program.leaf_count(), 2);
/// let near = Bounds::new(DVec3::new(0.5, -0.5, -0.5), DVec3::new(1.5, 0.5, 0.5));
/// match program.narrow(&near) {
///     Region::Surface(narrowed) => assert_eq!(narrowed.leaf_count(), 1),
///     _ => unreachable!("the first sphere's surface crosses the box"),
/// }
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Program {
    pub(crate) scene: Arc<Scene>,
    pub(crate) nodes: Arc<[Node]>,
    pub(crate) operands: Arc<[Edge]>,
    pub(crate) root: Edge,
    /// Leaves that narrowing has made simpler; their numbers go on from the scene's.
    pub(crate) simpler: Arc<[Instance]>,
    /// Frames that its leaves stand in and their ancestors, parents first, without the world.
    pub(crate) frames: Arc<[u32]>,
}

/// What a region holds of a solid.
#[derive(Clone, Debug)]
pub enum Region {
    /// Every point is inside.
    Inside,
    /// Every point is outside.
    Outside,
    /// The surface may cross the region; the program is equivalent to the full one there: of
    /// the same sign, the same zero set, and on it the same normal.
    Surface(Program),
}

impl Program {
    /// Assembles a program; `nodes` are sorted operands first, the root is among them.
    pub(crate) fn assemble(
        scene: Arc<Scene>,
        nodes: Vec<Node>,
        operands: Vec<Edge>,
        root: Edge,
        simpler: Vec<Instance>,
    ) -> Program {
        let mut live = vec![false; scene.frames.len() + 1];
        for leaf in nodes.iter().filter_map(Node::valued_by) {
            let mut frame = instance(&scene, &simpler, leaf).frame;
            while let Some(up) = scene.frame(frame) {
                if std::mem::replace(&mut live[frame as usize], true) {
                    break;
                }
                frame = up.parent;
            }
        }
        let frames = (1..live.len()).filter(|&f| live[f]).map(|f| f as u32).collect();
        let (nodes, operands, simpler) = (nodes.into(), operands.into(), simpler.into());
        Program { scene, nodes, operands, root, simpler, frames }
    }

    /// How many leaves it evaluates; a leaf that is used in several places counts once.
    #[must_use]
    pub fn leaf_count(&self) -> usize {
        self.nodes.iter().filter(|node| matches!(node.kind, Kind::Leaf(_))).count()
    }

    /// What a value takes, in those of ordinary leaves.
    pub(crate) fn cost(&self) -> usize {
        let leaf = |node: &Node| if let Kind::Leaf(leaf) = node.kind { self.instance(leaf).field.cost() } else { 0 };
        self.nodes.iter().map(leaf).sum()
    }

    /// Whether it evaluates the same leaves in the same way as another program of its solid.
    /// Long programs that were narrowed apart count as different.
    pub(crate) fn is_same(&self, other: &Program) -> bool {
        const LONG: usize = 16;
        if !Arc::ptr_eq(&self.scene, &other.scene) || self.root != other.root {
            return false;
        }
        let shared = Arc::ptr_eq(&self.nodes, &other.nodes)
            && Arc::ptr_eq(&self.operands, &other.operands)
            && Arc::ptr_eq(&self.simpler, &other.simpler);
        let same = |a: &Node, b: &Node| {
            a.range() == b.range()
                && match (&a.kind, &b.kind) {
                    (Kind::Leaf(a), Kind::Leaf(b)) => a == b,
                    (Kind::Join { op: a, rule: r, .. }, Kind::Join { op: b, rule: s, .. }) => a == b && r == s,
                    (Kind::Shift(a), Kind::Shift(b)) => a == b,
                    _ => false,
                }
        };
        shared
            || self.nodes.len() <= LONG
                && self.nodes.len() == other.nodes.len()
                && self.simpler.is_empty()
                && other.simpler.is_empty()
                && self.operands == other.operands
                && self.nodes.iter().zip(&other.nodes[..]).all(|(a, b)| same(a, b))
    }

    /// The operands of a node.
    pub(crate) fn list(&self, node: &Node) -> &[Edge] {
        &self.operands[node.range()]
    }

    /// Whether its values change as its slopes say.
    pub(crate) fn is_steady(&self) -> bool {
        self.nodes.iter().filter_map(Node::valued_by).all(|leaf| self.instance(leaf).field.is_steady())
    }

    /// Whether what takes long of it is searched for.
    pub(crate) fn is_searched(&self) -> bool {
        let dear = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| &self.instance(leaf).field);
        let mut dear = dear.filter(|field| field.cost() > 1).peekable();
        dear.peek().is_some() && dear.all(|field| !field.is_steady())
    }

    /// Whether each of its leaves takes long.
    pub(crate) fn is_dear(&self) -> bool {
        self.nodes.iter().filter_map(Node::valued_by).all(|leaf| self.instance(leaf).field.cost() > 1)
    }

    /// Whether it is what a chamfer adds.
    pub(crate) fn is_chamfer(&self) -> bool {
        let mut leaves = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| self.instance(leaf));
        self.is_dear() && leaves.any(|leaf| leaf.field.name() == "chamfer")
    }

    /// Whether any of its leaves goes on in another one, or is seen through what may tear it.
    pub(crate) fn jumps(&self) -> bool {
        let is_torn = |mut frame: u32| {
            while let Some(own) = self.scene.frame(frame) {
                if !own.warp.is_continuous() {
                    return true;
                }
                frame = own.parent;
            }
            false
        };
        let mut leaves = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| self.instance(leaf));
        leaves.any(|leaf| leaf.field.jumps() || is_torn(leaf.frame))
    }

    /// Those of its leaves that are neither deformed nor offset.
    pub(crate) fn plain_leaves(&self) -> impl Iterator<Item = &Instance> {
        let leaves = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| self.instance(leaf));
        leaves.filter(|leaf| leaf.frame == 0 && leaf.placement.shift == 0.0)
    }

    /// The one leaf that it is, neither deformed nor offset, and whether it is its complement.
    pub(crate) fn only_plain_leaf(&self) -> Option<(&Instance, bool)> {
        let leaf = self.plain_leaves().next().filter(|_| self.nodes.len() == 1)?;
        Some((leaf, self.root.negated()))
    }

    /// The first leaf that is no formula, if there is one.
    pub(crate) fn unlowered(&self) -> Option<&Instance> {
        let leaves = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| self.instance(leaf));
        leaves.into_iter().find(|leaf| !leaf.field.is_formula())
    }

    /// The leaf with this number.
    pub(crate) fn instance(&self, leaf: u32) -> &Instance {
        instance(&self.scene, &self.simpler, leaf)
    }
}

fn instance<'a>(scene: &'a Scene, simpler: &'a [Instance], leaf: u32) -> &'a Instance {
    let leaf = leaf as usize;
    scene.leaves.get(leaf).unwrap_or_else(|| &simpler[leaf - scene.leaves.len()])
}

impl std::fmt::Debug for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Program({} leaves, {} nodes)", self.leaf_count(), self.nodes.len())
    }
}
