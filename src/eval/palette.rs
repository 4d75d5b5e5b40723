//! From leaves to their paint.
//!
//! Where min and max decide, a point has the paint of the leaf that decides. A blend mixes: its
//! value changes with those of its operands, h = f(a, b), and ∂f/∂a and ∂f/∂b are the shares of
//! their gradients in its normal. They are the shares of their colours as well, in linear
//! light. On a fillet, which is a surface of its own, the shares go by the distances to the two
//! operands.

use glam::{DVec3, Vec3};

use super::program::{Kind, Program};
use crate::geom::{to_byte, to_linear};
use crate::{Dual, Paint};
use rvachev_field::Op;
use rvachev_field::Rule;

/// The paint of a solid's parts.
///
/// ```
/// use rvachev::{Paint, Solid};
///
/// let part = Solid::sphere(1.0).paint([200, 0, 0]) - Solid::cylinder(0.5, 3.0);
/// let palette = part.palette()?;
/// let owner = part.owner([1.0, 0.0, 0.0])?;
/// assert_eq!(palette.of(owner.index), Some(Paint::from([200, 0, 0])));
/// assert_eq!(palette.of(part.owner([0.5, 0.0, 0.0])?.index), None);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Palette {
    pub(crate) program: Program,
    /// By leaf.
    paints: Vec<Option<Paint>>,
    /// The leaves that a blend mixes with others of another paint.
    mixed: Vec<bool>,
}

/// The paint of all that is below a node.
#[derive(Clone, Copy, PartialEq)]
enum Below {
    Nothing,
    One(Option<Paint>),
    Various,
}

impl Below {
    fn with(self, other: Below) -> Below {
        match (self, other) {
            (Below::Nothing, one) | (one, Below::Nothing) => one,
            (a, b) if a == b => a,
            _ => Below::Various,
        }
    }
}

impl Palette {
    pub(crate) fn new(program: Program) -> Palette {
        let scene = program.scene.clone();
        let paints: Vec<Option<Paint>> = scene.leaves.iter().map(|leaf| scene.trail.paint(leaf.step)).collect();
        let mut mixed = vec![false; paints.len()];
        let mut below: Vec<Below> = Vec::with_capacity(program.nodes.len());
        for node in &program.nodes[..] {
            let operands = program.list(node).iter().fold(Below::Nothing, |all, edge| all.with(below[edge.node()]));
            let all = match &node.kind {
                Kind::Leaf(leaf) => Below::One(paints[program.instance(*leaf).number as usize]),
                Kind::Join { .. } | Kind::Shift(_) => operands,
            };
            below.push(all);
        }
        // From the root down, what a blend of various paints is made of.
        let mut blended = vec![false; program.nodes.len()];
        for (at, node) in program.nodes.iter().enumerate().rev() {
            let blends = match &node.kind {
                Kind::Join { rule, .. } => *rule != Rule::MinMax,
                Kind::Leaf(_) | Kind::Shift(_) => false,
            };
            blended[at] |= blends && below[at] == Below::Various;
            if blended[at] {
                for edge in program.list(node) {
                    blended[edge.node()] = true;
                }
                if let Some(leaf) = node.valued_by() {
                    mixed[program.instance(leaf).number as usize] = true;
                }
            }
        }
        Palette { program, paints, mixed }
    }

    /// Whether any part is painted.
    #[must_use]
    pub fn is_painted(&self) -> bool {
        self.paints.iter().any(Option::is_some)
    }

    /// The paint of a leaf, by its number; `None` if it has none.
    #[must_use]
    pub fn of(&self, owner: u32) -> Option<Paint> {
        self.paints.get(owner as usize).copied().flatten()
    }

    /// How many leaves the solid has.
    pub(crate) fn leaves(&self) -> u32 {
        self.paints.len() as u32
    }

    /// Whether the paint of a leaf changes along its surface.
    pub(crate) fn is_mixed(&self, owner: u32) -> bool {
        self.mixed.get(owner as usize).is_some_and(|mixed| *mixed)
    }

    /// The paint at a point of the surface that the leaf `owner` decides: a mixture where a
    /// blend is made of parts of different paint, those without paint counted as
    /// [`Paint::default`].
    #[must_use]
    pub fn at(&self, owner: u32, p: impl Into<DVec3>) -> Option<Paint> {
        self.mixture(owner, p.into(), Paint::default())
    }

    /// The same, with the paint that parts without any are counted as.
    pub(crate) fn mixture(&self, owner: u32, p: DVec3, unpainted: Paint) -> Option<Paint> {
        if !self.is_mixed(owner) {
            return self.of(owner);
        }
        let (mut color, mut roughness, mut sum) = (Vec3::ZERO, 0.0, 0.0);
        let mut any = false;
        for (leaf, share) in self.program.shares(p) {
            let own = self.of(leaf);
            any |= own.is_some();
            let paint = own.unwrap_or(unpainted);
            color += share as f32 * Vec3::from_array(paint.color.map(|c| to_linear(f32::from(c) / 255.0)));
            roughness += share * paint.roughness;
            sum += share;
        }
        if !any || sum <= 0.0 {
            return self.of(owner);
        }
        Some(Paint { color: (color / sum as f32).to_array().map(to_byte), roughness: roughness / sum })
    }
}

impl Program {
    /// The leaves that a point's value is made of, with their shares.
    fn shares(&self, p: DVec3) -> Vec<(u32, f64)> {
        /// Smaller shares cannot be seen.
        const LEAST: f64 = 1e-3;
        let values = self.node_values(p);
        let mut shares = Vec::new();
        let mut pending = vec![(self.root.node(), 1.0)];
        while let Some((at, share)) = pending.pop() {
            if share < LEAST {
                continue;
            }
            let node = &self.nodes[at];
            let operands = self.list(node);
            let value = |i: usize| {
                let edge = operands[i];
                if edge.negated() { -values[edge.node()] } else { values[edge.node()] }
            };
            let weights: Vec<f64> = match &node.kind {
                Kind::Leaf(leaf) => {
                    shares.push((self.instance(*leaf).number, share));
                    continue;
                }
                Kind::Shift(_) => vec![1.0],
                Kind::Join { op, rule: Rule::MinMax, .. } => chosen(*op, operands.len(), value),
                Kind::Join { op, rule, .. } => slopes(*op, *rule, operands.len(), value),
            };
            let sum: f64 = weights.iter().sum();
            if sum > 0.0 && sum.is_finite() {
                pending.extend(operands.iter().zip(weights).map(|(edge, w)| (edge.node(), share * w / sum)));
            }
        }
        shares
    }
}

/// 1 for the operand that decides, 0 for the others.
fn chosen(op: Op, count: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut best = 0;
    for i in 1..count {
        let better = match op {
            Op::Or => value(i) > value(best),
            Op::And => value(i) < value(best),
        };
        if better {
            best = i;
        }
    }
    (0..count).map(|i| f64::from(u8::from(i == best))).collect()
}

/// How a join's value changes with those of its operands, as far as it rises with them.
fn slopes(op: Op, rule: Rule, count: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut weights = vec![1.0];
    let mut all = value(0);
    for i in 1..count {
        let joined = rule.join(op, Dual::new(all, [1.0, 0.0, 0.0]), Dual::new(value(i), [0.0, 1.0, 0.0]));
        let [of_all, of_next, _] = joined.d;
        for weight in &mut weights {
            *weight *= of_all.max(0.0);
        }
        weights.push(of_next.max(0.0));
        all = joined.v;
    }
    weights
}
