//! From leaves to their paint.
//!
//! Where min and max decide, a point has the paint of the leaf that decides. A blend mixes: its
//! value changes with those of its operands, h = f(a, b), and ∂f/∂a and ∂f/∂b are the shares of
//! their gradients in its normal. They are the shares of their colours as well, in linear
//! light. What leaves have that are made of painted parts themselves: [`Coat`].

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::coat::{Below, Coat, feet};
use super::program::{Kind, Program};
use super::scene::Instance;
use super::shares::LEAST;
use crate::Paint;
use crate::geom::{to_byte, to_linear};
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
#[derive(Clone)]
pub struct Palette {
    pub(crate) program: Program,
    /// By leaf.
    coats: Arc<[Coat]>,
    /// The leaves that a blend mixes with others of another paint.
    blended: Arc<[bool]>,
    /// All of it.
    below: Below,
}

impl Palette {
    /// That of a program; `coats` are those of leaves that are made of other parts.
    pub(super) fn new(program: Program, mut coats: HashMap<u32, Coat>) -> Palette {
        let scene = program.scene.clone();
        let paints = scene.trail.paints();
        let coat = |leaf: &Instance| match paints.get(leaf.step as usize).copied().flatten() {
            Some(paint) => Coat::One(Some(paint)),
            None if leaf.field.is_colored() => Coat::Own(leaf.field.clone()),
            None => coats.remove(&leaf.number).unwrap_or(Coat::One(None)),
        };
        let coats: Vec<Coat> = scene.leaves.iter().map(coat).collect();
        let mut mixed = vec![false; coats.len()];
        let mut below: Vec<Below> = Vec::with_capacity(program.nodes.len());
        for node in &program.nodes[..] {
            let operands = program.list(node).iter().fold(Below::Nothing, |all, edge| all.with(below[edge.node()]));
            let all = match &node.kind {
                Kind::Leaf(leaf) => coats[program.instance(*leaf).number as usize].below(),
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
        let below = below.get(program.root.node()).copied().unwrap_or(Below::Nothing);
        Palette { program, coats: coats.into(), blended: mixed.into(), below }
    }

    /// The paint of all parts.
    pub(super) fn below(&self) -> Below {
        self.below
    }

    /// Whether any part is painted.
    #[must_use]
    pub fn is_painted(&self) -> bool {
        self.coats.iter().any(|coat| !matches!(coat, Coat::One(None)))
    }

    /// The paint of a leaf, by its number; `None` if it has none, or more than one: an
    /// [offset](crate::Solid::offset) or a fillet of parts of various paint, whose paint
    /// changes [along its surface](Palette::at).
    #[must_use]
    pub fn of(&self, owner: u32) -> Option<Paint> {
        match self.coats.get(self.program.leaf_of(owner) as usize) {
            Some(Coat::One(paint)) => *paint,
            Some(Coat::Operands(_) | Coat::Own(_)) | None => None,
        }
    }

    /// How many leaves the solid has.
    pub(crate) fn leaves(&self) -> u32 {
        self.coats.len() as u32
    }

    /// Whether the paint of a leaf changes along its surface.
    pub(crate) fn is_mixed(&self, owner: u32) -> bool {
        self.is_blended(owner)
            || matches!(self.coats.get(self.program.leaf_of(owner) as usize), Some(Coat::Operands(_) | Coat::Own(_)))
    }

    /// Whether a blend mixes the paint of a leaf with that of others.
    fn is_blended(&self, owner: u32) -> bool {
        self.blended.get(self.program.leaf_of(owner) as usize).is_some_and(|blended| *blended)
    }

    /// The paint at a point of the surface that the leaf `owner` decides: a mixture where a
    /// blend or a fillet is made of parts of different paint, those without paint counted as
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
        for (own, share) in self.pigments(owner, p) {
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

    /// The paints at a point of the surface that a leaf decides, with their shares: down through
    /// what the leaf is made of, however deep it is.
    fn pigments(&self, owner: u32, p: DVec3) -> Vec<(Option<Paint>, f64)> {
        let mut found = Vec::new();
        let mut pending = vec![(self, owner, p, 1.0)];
        while let Some((palette, owner, p, share)) = pending.pop() {
            let leaves = if palette.is_blended(owner) {
                palette.program.shares(p)
            } else {
                vec![(palette.program.leaf_of(owner), 1.0)]
            };
            for (leaf, part) in leaves {
                match palette.coats.get(leaf as usize) {
                    _ if share * part < LEAST => {}
                    None => {}
                    Some(Coat::One(paint)) => found.push((*paint, share * part)),
                    Some(Coat::Own(field)) => {
                        let color = field.color(palette.program.local(leaf, p));
                        found.push((color.map(Paint::from), share * part));
                    }
                    Some(Coat::Operands(operands)) => {
                        for foot in feet(operands, palette.program.local(leaf, p)) {
                            let below = foot.palette.program.deciding_leaf(foot.point);
                            pending.push((foot.palette, below, foot.point, share * part * foot.share));
                        }
                    }
                }
            }
        }
        found
    }
}

impl fmt::Debug for Palette {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let painted = self.coats.iter().filter(|coat| !matches!(coat, Coat::One(None))).count();
        write!(f, "Palette({painted} of {} leaves painted)", self.coats.len())
    }
}
