//! What was recovered of a part.

use glam::{DAffine3, DVec3};

use super::super::deviations::Deviation;
use super::intent::{Change, Changed};
use super::leaf::Leaf;
use super::patterns::Pattern;
use super::repeated::repeated;
use super::times::PartTimes;
use super::words::{describe, laid_out};
use crate::code::{RustFile, RustSettings};
use crate::{Bounds, Solid};

/// Leaves less of which is seen are guesses.
const GUESS: f64 = 0.5;

/// A part as an ordered tree of leaves, and how well it is the part.
///
/// The leaves are applied one after the other: each is added to what those before it are, or cut
/// from it.
#[derive(Clone, Debug)]
pub struct PartFit {
    pub(super) leaves: Vec<PartLeaf>,
    pub(super) solid: Solid,
    /// Those that are repeated in the solid.
    pub(super) patterns: Vec<Pattern>,
    pub(super) snaps: Vec<Snap>,
    pub(super) iou: f64,
    pub(super) deviation: Deviation,
    pub(super) topology: Topology,
    pub(super) topology_of_input: Topology,
    pub(super) unexplained: Vec<Unexplained>,
    pub(super) times: PartTimes,
}

/// A leaf of a part.
#[derive(Clone, Debug)]
pub struct PartLeaf {
    pub(super) adds: bool,
    pub(super) leaf: Leaf,
    pub(super) name: String,
    /// What turns it from the part's axes, if that it was turned to these was refused.
    pub(super) tilt: DAffine3,
    /// In words.
    pub(super) text: String,
    pub(super) surface: f64,
    pub(super) seen: f64,
}

/// What a surface is in the large.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Topology {
    /// Handles, over all shells; none where the surface is not closed and manifold.
    pub genus: Option<i64>,
    /// Pieces that do not hang together.
    pub shells: usize,
}

/// A place where the tree is not the part.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Unexplained {
    /// A box about the wrong points, in length units.
    pub bounds: Bounds,
    /// The volume that is wrong, as a share of the part's.
    pub share: f64,
    /// Whether the part is there and the tree is not; else it is the other way round.
    pub missing: bool,
}

/// A number of a leaf, or its turn, that was changed to what it is likely to be meant to be.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Snap {
    /// Which of the [leaves](PartFit::leaves).
    pub leaf: usize,
    /// What the number is: "diameter", "radius" or "size"; "x", "y" or "z": where the leaf is, or
    /// ends, along its own axes; or "turn": the angle by which it was off the axes that it was
    /// settled along.
    pub measure: &'static str,
    /// What was found, in length units; of a turn in degrees.
    pub found: f64,
    /// What it is instead.
    pub meant: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    of: Changed,
}

impl Snap {
    pub(super) fn of(leaf: usize, change: &Change) -> Snap {
        let Change { of, measure, from, to, .. } = *change;
        Snap { leaf, measure: measure.name(), found: from, meant: to, of }
    }
}

impl PartFit {
    /// The numbers that were changed: to round ones, in millimetres or in binary fractions of an
    /// inch, whichever makes more of the part's numbers short, by no more than the vertices leave
    /// open; cuts that ended in the open, or in the face that they go through, or of a part from
    /// points but for a skin, which were lengthened; and axes, of leaves that were a little off the
    /// part's axes, each other's, or square to these, by less than vertices or samples leave open.
    /// Numbers are not changed, and leaves that they leave nothing to do for not left out, where
    /// that would take genus or shells farther from the input's, as far as these are known: of
    /// points, or an open mesh, they are not, and what is smaller than a 128th of the part's
    /// longest side may be missed.
    #[must_use]
    pub fn snaps(&self) -> &[Snap] {
        &self.snaps
    }

    /// The part with some of the [snaps](PartFit::snaps), told by their places, taken back. What is
    /// measured of the part is left as it was.
    ///
    /// ```
    /// use rvachev::fit::{PartSettings, part};
    /// use rvachev::{Mesh, MeshSettings, Solid};
    ///
    /// let peg = Solid::cylinder(3.0001, 20.0).mesh(&MeshSettings::default())?;
    /// let found = part(&peg, &PartSettings::default())?;
    /// let diameter = found.snaps().iter().position(|snap| snap.measure == "diameter").expect("it is nearly 6");
    /// assert_eq!(found.snaps()[diameter].meant, 6.0);
    /// let kept = found.without_snaps(&[diameter]);
    /// assert!(kept.solid().contains([3.00005, 0.0, 0.0])? && !found.solid().contains([3.00005, 0.0, 0.0])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn without_snaps(&self, snaps: &[usize]) -> PartFit {
        let mut fit = self.clone();
        for snap in snaps.iter().filter_map(|n| self.snaps.get(*n)) {
            fit.leaves[snap.leaf].refuse(snap);
        }
        let mut place = 0..;
        fit.snaps.retain(|_| place.next().is_none_or(|n| !snaps.contains(&n)));
        let size = fit.solid.bounds().map_or(1.0, |bounds| bounds.size().length());
        fit.build(size);
        fit
    }

    /// Makes the tree of the leaves again, in a part of such a size; `None` leaves it as it was.
    fn build(&mut self, size: f64) -> Option<()> {
        (self.solid, self.patterns) = repeated(&self.leaves, size)?;
        describe(&mut self.leaves, size);
        Some(())
    }

    /// The part, in the mesh's coordinates. Its leaves have [names](PartLeaf::name); those of a
    /// [pattern](PartFit::patterns) are the first one, repeated.
    #[must_use]
    pub fn solid(&self) -> Solid {
        self.solid.clone()
    }

    /// The leaves, in the order in which they are added and cut.
    #[must_use]
    pub fn leaves(&self) -> &[PartLeaf] {
        &self.leaves
    }

    /// How many leaves the tree has, those of a [pattern](PartFit::patterns) counted once: a plate
    /// with a grid of holes is two.
    #[must_use]
    pub fn leaf_count(&self) -> usize {
        self.leaves.len() - self.patterns.iter().map(|pattern| pattern.leaves.len() - 1).sum::<usize>()
    }

    /// How many numbers the tree has: 3 of a half-space, 4 of a sphere, 7 of a cylinder or a torus,
    /// 8 of a cone, 9 of a box or a prism, 10 of a rounded rectangle, 11 of a superellipsoid, 12 of
    /// a supershape, 17 of a solid one, 7 and 2 a corner and 1 an arc of a profile. Of a
    /// [pattern](PartFit::patterns) it is those of one leaf and of the
    /// [layout](super::Layout::parameters).
    #[must_use]
    pub fn parameters(&self) -> usize {
        let all: usize = self.leaves.iter().map(PartLeaf::parameters).sum();
        let saved = |pattern: &Pattern| {
            let others = pattern.leaves[1..].iter().map(|i| self.leaves[*i].parameters()).sum::<usize>();
            others - pattern.layout.parameters()
        };
        all - self.patterns.iter().map(saved).sum::<usize>()
    }

    /// The part as Rust code: a function of this name that makes [the solid](PartFit::solid) again,
    /// with a comment at each leaf that tells what it is.
    ///
    /// ```
    /// use rvachev::fit::{PartSettings, part};
    /// use rvachev::{MeshSettings, Solid};
    ///
    /// let plate = Solid::cuboid([60.0, 20.0, 8.0]) - Solid::cylinder(3.0, 20.0);
    /// let found = part(&plate.mesh(&MeshSettings::default())?, &PartSettings::default())?;
    /// let code = found.to_rust("plate");
    /// assert!(code.contains("// block, 60 × 20 × 8; ") && code.contains("// hole, ⌀ 6, through; "), "{code}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_rust(&self, name: &str) -> String {
        let mut settings = RustSettings::default();
        let share = |leaf: &PartLeaf| 100.0 * leaf.surface;
        for leaf in &self.leaves {
            let text = format!("{}; {:.1} % of the surface", leaf.text, share(leaf));
            settings.comments.insert(leaf.name.clone(), text);
        }
        for pattern in &self.patterns {
            let first = &self.leaves[pattern.leaves[0]];
            let all: f64 = pattern.leaves.iter().map(|i| share(&self.leaves[*i])).sum();
            let text = format!("{}, {}; {all:.1} % of the surface", first.text, laid_out(pattern));
            settings.comments.insert(pattern.name(&self.leaves).to_owned(), text);
        }
        let mut file = RustFile::new(settings);
        file.add(name, &self.solid);
        file.to_string()
    }

    /// The volume of what tree and mesh have in common, over that of what either has: 1 is all
    /// right. It is estimated from 16384 points in the mesh's box and 1.5 % about it, which are
    /// inside of the mesh where its winding number is above ½.
    ///
    /// Points have a winding number too, but it blurs about as far as they are apart: of a plate
    /// of 6000 points the right tree is told .96 or .97. So of points it serves to compare trees.
    /// It does not tell how near one is to the truth.
    #[must_use]
    pub fn iou(&self) -> f64 {
        self.iou
    }

    /// How far points of the mesh are from the tree's surface, in length units, to first order.
    #[must_use]
    pub fn deviation(&self) -> Deviation {
        self.deviation
    }

    /// Genus and shells of the tree's surface, meshed with 128 cells along its longest side, or 384
    /// where these have not those of the input.
    #[must_use]
    pub fn topology(&self) -> Topology {
        self.topology
    }

    /// Those of the mesh; of points they are not known, and the genus is `None`.
    #[must_use]
    pub fn topology_of_input(&self) -> Topology {
        self.topology_of_input
    }

    /// Where tree and mesh differ by more than a thousandth of the volume in one place, the worst
    /// place first. Of points there are such places at thin walls and along edges, as their winding
    /// numbers [blur](PartFit::iou) there.
    #[must_use]
    pub fn unexplained(&self) -> &[Unexplained] {
        &self.unexplained
    }

    /// How long the stages of the recovery took. Unlike the rest of the result, it differs from run
    /// to run.
    #[must_use]
    pub fn times(&self) -> PartTimes {
        self.times
    }
}

impl PartLeaf {
    /// Takes a change back; the numbers are along the axes that it was turned to.
    fn refuse(&mut self, snap: &Snap) {
        let upright = self.leaf.turned_by(&self.tilt.inverse());
        let mut numbers: Vec<f64> = upright.measures().into_iter().map(|(_, v)| v).collect();
        match snap.of {
            Changed::Number(nth) => numbers[nth] = snap.found,
            Changed::Turn(tilt) => self.tilt = tilt,
        }
        self.leaf = upright.made_of(&numbers).unwrap_or(upright).turned_by(&self.tilt);
    }

    /// Whether it is cut from what is before it; else it is added.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        !self.adds
    }

    /// What it is called in the tree, as "box 1" or "cut cylinder 2".
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it is: "half-space", "box", "cylinder", "cone", "sphere", "torus", "prism", "rounded
    /// rectangle", "profile" (an extruded outline, of straight sides and arcs), "supershape" (an
    /// extruded one), "solid supershape" (a three-dimensional one) or "superellipsoid".
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.leaf.kind()
    }

    /// What it is in an engineer's words, in length units: "hole, ⌀ 6.35, through", or "block, 60 ×
    /// 40 × 8".
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The leaf alone, where it is, in the mesh's coordinates.
    #[must_use]
    pub fn solid(&self) -> Solid {
        self.leaf.solid()
    }

    /// Where it is: its centre; of a half-space the point of its plane that is nearest to the
    /// origin.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.leaf.centre
    }

    /// How many numbers it has.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.leaf.parameters()
    }

    /// The share of the mesh's surface that it makes, 0 to 1.
    #[must_use]
    pub fn surface(&self) -> f64 {
        self.surface
    }

    /// The share of the surface that it makes in the tree that there are points of, 0 to 1: 1 in
    /// a part that was recovered from a mesh. A box that stands on what was not scanned has some
    /// 0.8: where it ends below is a guess.
    #[must_use]
    pub fn seen(&self) -> f64 {
        self.seen
    }

    /// Whether less than half of it is [seen](PartLeaf::seen): nothing but what is about it tells
    /// that it is there.
    #[must_use]
    pub fn is_guess(&self) -> bool {
        self.seen < GUESS
    }
}
