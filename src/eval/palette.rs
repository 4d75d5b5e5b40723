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
use super::program::{Edge, Kind, Program};
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
    /// By leaf, what mixes it with others of another paint, if a blend does.
    blends: Arc<[Option<Program>]>,
    /// All of it.
    below: Below,
}

/// By leaf, the blend of various paints that it is an operand of, as a program: where the leaf
/// decides, what is joined to that blend by min and max has no share. Of leaves with more than one
/// such blend it is the whole program.
fn mixed(program: &Program, below: &[Below], leaves: usize) -> Vec<Option<Program>> {
    let whole = program.root.node();
    let is_blend = |at: usize| matches!(&program.nodes[at].kind, Kind::Join { rule, .. } if *rule != Rule::MinMax);
    // From the root down: the blend that mixes a node, and whether all ways to it lead through
    // that.
    let mut tops: Vec<Option<usize>> = vec![None; program.nodes.len()];
    let mut is_reached = vec![false; program.nodes.len()];
    let mut of_leaf = vec![None; leaves];
    for (at, node) in program.nodes.iter().enumerate().rev() {
        let starts = is_blend(at) && below[at] == Below::Various;
        let top = tops[at].or(starts.then_some(at));
        for edge in program.list(node) {
            let (own, reached) = (&mut tops[edge.node()], &mut is_reached[edge.node()]);
            *own = if *reached && *own != top { Some(whole) } else { top };
            *reached = true;
        }
        if let (Some(top), Some(leaf)) = (top, node.valued_by()) {
            let own: &mut Option<usize> = &mut of_leaf[program.instance(leaf).number as usize];
            *own = Some(if own.is_some_and(|own| own != top) { whole } else { top });
        }
    }
    let mut made: HashMap<usize, Program> = HashMap::new();
    let part = |top: usize| {
        let (nodes, operands) = (program.nodes.to_vec(), program.operands.to_vec());
        program.trimmed(nodes, operands, program.simpler.to_vec(), Edge::new(top))
    };
    let mut blend = |top: usize| made.entry(top).or_insert_with(|| part(top)).clone();
    of_leaf.into_iter().map(|top| top.map(&mut blend)).collect()
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
        let mut below: Vec<Below> = Vec::with_capacity(program.nodes.len());
        for node in &program.nodes[..] {
            let operands = program.list(node).iter().fold(Below::Nothing, |all, edge| all.with(below[edge.node()]));
            let all = match &node.kind {
                Kind::Leaf(leaf) => coats[program.instance(*leaf).number as usize].below(),
                Kind::Join { .. } | Kind::Shift(_) => operands,
            };
            below.push(all);
        }
        let blends = mixed(&program, &below, coats.len());
        let below = below.get(program.root.node()).copied().unwrap_or(Below::Nothing);
        Palette { program, coats: coats.into(), blends: blends.into(), below }
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
        self.blend_of(owner).is_some()
    }

    /// What mixes the paint of a leaf with that of others, if a blend does.
    fn blend_of(&self, owner: u32) -> Option<&Program> {
        self.blends.get(self.program.leaf_of(owner) as usize)?.as_ref()
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
            let leaves = match palette.blend_of(owner) {
                Some(blend) => blend.shares(p),
                None => vec![(palette.program.leaf_of(owner), 1.0)],
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

#[cfg(test)]
mod tests {
    use crate::{Blend, Solid};

    #[test]
    fn mixtures_ask_their_blend_alone() {
        let [iron, brass, red] = [[60, 90, 120], [210, 160, 70], [180, 40, 40]];
        let ball = |x: f64, color: [u8; 3]| Solid::sphere(1.0).translate([x, 0.0, 0.0]).paint(color);
        let smooth = Blend::Smooth { radius: 0.5 };
        let pair = ball(0.0, iron).union_with(ball(1.5, brass), smooth);
        // Of the whole, and in a row of many where nothing else is painted alike.
        let all = &pair | ball(6.0, red) | ball(9.0, iron);
        let (alone, palette) = (pair.palette().unwrap(), all.palette().unwrap());
        for x in [0.0, 0.6, 0.75, 0.9, 1.5] {
            let p = [x, 0.0, 0.8];
            let owner = all.owner(p).unwrap().index;
            assert_eq!(palette.blend_of(owner).unwrap().leaf_count(), 2);
            assert_eq!(palette.at(owner, p), alone.at(pair.owner(p).unwrap().index, p));
        }
        assert!(palette.blend_of(all.owner([6.0, 0.0, 0.9]).unwrap().index).is_none());
        // What is in two blends is asked of the whole.
        let twice = pair.union_with(ball(3.0, red), smooth) | pair.union_with(ball(-1.5, red), smooth);
        let owner = twice.owner([0.0, 0.0, 0.9]).unwrap().index;
        let palette = twice.palette().unwrap();
        assert!(palette.blend_of(owner).is_some() && palette.at(owner, [0.75, 0.0, 0.8]).is_some());
    }
}
