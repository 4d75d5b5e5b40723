//! The distance to a surface that is given as triangles with curved sides.
//!
//! ```text
//!     |d|(x) = min over patches of |x − P(b)|,     P(b) = Σ bᵢ pᵢ + 4 Σ bᵢ bⱼ uₖ
//! ```
//!
//! A quadratic patch follows a smooth surface to the fourth power of its size, where a flat
//! triangle follows it to the second: a sphere takes a few hundred patches where it would take a
//! hundred thousand triangles. A hierarchy of boxes (a BVH split by the surface area heuristic),
//! the small ones of them beside discs along the surface, finds the few patches that may be
//! nearest; the nearest point of a patch is found by Newton's method from the foot on its flat
//! triangle.
//!
//! What is found of a patch is a function of the point and the patch alone, and the distance is
//! the least of all, so neither the order of the search nor where it starts shows in the result.
//!
//! Chunks of points are sorted into compact packets, longest across the surface, and all points of
//! a packet go through the hierarchy at once, on SIMD lanes, from the boxes on that may hold what
//! is nearest to any point of the chunk. What is left to do of curved patches is done in vectors of
//! pairs of a point and a patch.
//!
//! The geometry is kept in single precision, as lengths of a frame about the surface's middle
//! whose unit is a power of two near half the surface's size. Searches in `f32` and in `f64` run
//! over the same numbers and differ by rounding only.
//!
//! Sources: C. Ericson, *Real-Time Collision Detection* (2005), for the nearest point of a
//! triangle; I. Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies* (2007).

mod apart;
mod between;
mod block;
mod chunks;
mod closest;
mod curved;
mod cut;
mod disc;
mod double;
mod face;
mod feet;
mod hierarchy;
mod hull;
mod inscribed;
mod layers;
#[cfg(test)]
mod leaf_tests;
mod moved_apart;
mod narrow;
mod normals;
mod packet;
mod packets;
mod pairs;
mod patch;
mod plane;
mod room;
mod search;
mod solid;
mod subpatch;
mod support;
mod surface_distance;
#[cfg(test)]
mod tests;
mod triangles;

use std::fmt;

use glam::DVec3;
use rvachev_num::{Cancelled, Run};

use self::closest::Closest;
use self::curved::Around;
use self::disc::Disc;
use self::face::{Face, Frame, Quadratic, Sides, wide};
use self::hierarchy::{Node, Tree};
use self::search::{Best, Entries, Keep, Nearest, Range, SURE, Stack};
use crate::Bounds;

pub use self::between::{Between, Loss};
pub use self::inscribed::Walls;
pub use self::moved_apart::{MovedApart, Moves, Place};
pub use self::patch::Patch;
pub use self::solid::{MeshLeaf, OpenEdges};
pub use self::subpatch::Subpatch;
pub use self::surface_distance::SurfaceDistance;

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// How far it is, not negative.
    pub distance: f64,
    /// The point.
    pub point: DVec3,
    /// The unit normal of the patch there: it points to where the corners are seen to turn
    /// counter-clockwise from.
    pub normal: DVec3,
    /// The number of the patch.
    pub patch: u32,
}

/// Patches in a hierarchy of boxes, ready to be asked for the nearest point.
pub struct Patches {
    frame: Frame,
    bounds: Bounds,
    nodes: Vec<Node>,
    /// What is closer to the patches of boxes than these are, box by box.
    discs: Vec<Disc>,
    /// The flat triangles, in the order of the hierarchy.
    faces: Vec<Face>,
    sides: Vec<Sides>,
    /// What makes them curved; empty if none is.
    quadratics: Vec<Quadratic>,
    /// The numbers of the patches, as they were given.
    numbers: Vec<u32>,
    /// Stands for the content in texts that tell leaves apart.
    hash: u64,
}

/// So many items are gone through between two looks at whether the run is cancelled.
const AT_ONCE: usize = 1 << 14;

/// The items, unless the run is stopped meanwhile.
fn gathered<T>(items: impl Iterator<Item = T>, run: &Run) -> Result<Vec<T>, Cancelled> {
    let mut all = Vec::with_capacity(items.size_hint().0);
    for (i, item) in items.enumerate() {
        if i.is_multiple_of(AT_ONCE) {
            run.check()?;
        }
        all.push(item);
    }
    Ok(all)
}

impl Patches {
    /// Builds the hierarchy over patches. Those with a coordinate that is not a number, or is
    /// infinite, are left out.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn new(patches: &[Patch], run: &Run) -> Result<Patches, Cancelled> {
        let kept: Vec<u32> = (0..).zip(patches).filter(|(_, patch)| patch.is_finite()).map(|(i, _)| i).collect();
        let chosen = || kept.iter().map(|i| &patches[*i as usize]);
        let bounds = chosen().fold(Bounds::EMPTY, |all, patch| all.union(&patch.bounds()));
        let frame = Frame::new(&bounds);
        let boxes = gathered(chosen().map(|patch| frame.boxed(patch)), run)?;
        let Tree { nodes, order } = Tree::new(&boxes, run)?;
        let numbers = gathered(order.iter().map(|i| kept[*i as usize]), run)?;
        let sorted = || numbers.iter().map(|i| &patches[*i as usize]);
        let faces = gathered(sorted().map(|patch| Face::new(patch, &frame)), run)?;
        let sides = gathered(sorted().map(|patch| Sides::new(patch, &frame)), run)?;
        let discs = disc::discs(&nodes, &faces, &sides, run)?;
        let is_flat = chosen().all(Patch::is_flat);
        let quadratics =
            if is_flat { Vec::new() } else { gathered(sorted().map(|patch| Quadratic::new(patch, &frame)), run)? };
        run.check()?;
        let hash = face::hash(&frame, &faces, &sides, &quadratics);
        Ok(Patches { frame, bounds, nodes, discs, faces, sides, quadratics, numbers, hash })
    }

    /// The nearest point; nothing if there are no patches.
    pub fn nearest(&self, p: DVec3) -> Option<Foot> {
        let best = self.search_one(self.frame.into_local(p).to_array());
        self.foot_on(best.which as usize, p)
    }

    /// The nearest point to one, and how far its patch is from the farthest of other points;
    /// nothing if there are no patches.
    pub fn nearest_with(&self, p: DVec3, others: &[DVec3]) -> Option<(Foot, f64)> {
        let at = self.search_one(self.frame.into_local(p).to_array()).which as usize;
        let foot = self.foot_on(at, p)?;
        let square = |p: &DVec3| self.closest(at, self.frame.into_local(*p).to_array()).square;
        Some((foot, others.iter().map(square).fold(0.0, f64::max).sqrt() * self.frame.unit))
    }

    /// The nearest point of one patch, counted as the hierarchy sorts them.
    fn foot_on(&self, at: usize, p: DVec3) -> Option<Foot> {
        let number = *self.numbers.get(at)?;
        let closest = self.closest(at, self.frame.into_local(p).to_array());
        let [s, t] = closest.coordinates;
        let (point, normal) = self.point_and_normal(at, s, t);
        Some(Foot {
            distance: closest.square.sqrt() * self.frame.unit,
            point: self.frame.outward(point),
            normal,
            patch: number,
        })
    }

    /// How far the nearest point is; nothing if there are no patches.
    fn distance(&self, p: DVec3) -> Option<f64> {
        let local = self.frame.into_local(p).to_array();
        if self.is_empty() { None } else { Some(self.search_one(local).square.sqrt() * self.frame.unit) }
    }

    /// The unit of the stored numbers: half the surface's size or up to twice that.
    fn unit(&self) -> f64 {
        self.frame.unit
    }

    /// Whether a point of a patch is nearer than this, to within rounding in single precision: what
    /// is farther is not looked at.
    pub fn is_within(&self, p: DVec3, distance: f64) -> bool {
        let local = self.frame.into_local(p).to_array();
        let most = (distance / self.frame.unit).powi(2).min(f64::from(f32::MAX));
        let mut curved = One { patches: self, local, best: Best::none(0.0) };
        let range = Range { low: most * SURE, high: most };
        let Nearest { all, .. } = self.search(local, self.all(), &[], range, &mut Stack::new(), &mut curved);
        all.square.min(curved.best.square) < most
    }

    /// The nearest patch to one point of the surface's frame.
    fn search_one(&self, local: [f64; 3]) -> Best<f64> {
        let mut curved = One { patches: self, local, best: Best::none(0.0) };
        let Nearest { flat, .. } = self.search(local, self.all(), &[], Range::all(0.0), &mut Stack::new(), &mut curved);
        curved.best.take(flat.square, flat.which as u32);
        curved.best
    }

    /// The boxes that a search begins with which knows nothing.
    fn all(&self) -> &'static [u32] {
        if self.nodes.is_empty() { &[] } else { Entries::ALL }
    }

    /// The axis that is steepest upon a patch.
    fn steepest(&self, patch: u32) -> usize {
        let [x, y, z] = self.faces.get(patch as usize).map_or([0.0; 3], |face| face.n.map(f32::abs));
        if x >= y && x >= z { 0 } else { 1 + usize::from(z > y) }
    }

    /// The nearest point of one patch.
    fn closest(&self, at: usize, local: [f64; 3]) -> Closest<f64> {
        let r = self.faces[at].seen_from(local);
        let [e, f] = self.sides[at].wide();
        match self.quadratics.get(at) {
            Some(quadratic) => {
                let (c, d, mixed) = (wide(quadratic.c), wide(quadratic.d), wide(quadratic.e));
                Around { r, e, f, c, d, mixed }.closest()
            }
            None => closest::on_face([e, f], r).closest,
        }
    }

    /// A point of a patch, in the surface's frame, and the unit normal there.
    fn point_and_normal(&self, at: usize, s: f64, t: f64) -> (DVec3, DVec3) {
        let flat @ [_, e, f] = self.sides[at].jet(&self.faces[at], s, t);
        let [point, along_s, along_t] = self.quadratics.get(at).map_or(flat, |quadratic| quadratic.jet(flat, s, t));
        let normal = along_s.cross(along_t);
        let normal = normal.try_normalize().or_else(|| e.cross(f).try_normalize()).unwrap_or(DVec3::Z);
        (point, normal)
    }

    /// A point of a patch, counted as the hierarchy sorts them, by its coordinates: (0, 0), (1, 0)
    /// and (0, 1) are the corners.
    pub fn point(&self, at: usize, [s, t]: [f64; 2]) -> DVec3 {
        self.frame.outward(self.point_and_normal(at, s, t).0)
    }

    /// Whether they are flat triangles, all of them.
    pub fn is_flat(&self) -> bool {
        self.quadratics.is_empty()
    }

    /// How many patches there are.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// A box that holds them all.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The memory that they take.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.discs)
            + size_of_val(&*self.faces)
            + size_of_val(&*self.sides)
            + size_of_val(&*self.quadratics)
            + size_of_val(&*self.numbers)
    }

    /// How far a stored patch may be off the one that was given.
    fn rounding(&self) -> f64 {
        // A corner is a sum of two stored numbers of at most 2 units.
        4.0 * f64::from(f32::EPSILON) * self.frame.unit
    }
}

/// The curved patches of a search for one point, asked at once.
struct One<'a> {
    patches: &'a Patches,
    local: [f64; 3],
    best: Best<f64>,
}

impl Keep<f64> for One<'_> {
    #[inline(always)]
    fn keep(&mut self, at: u32, least: f64, most: f64) {
        if least < most.min(self.best.square) {
            self.best.take(self.patches.closest(at as usize, self.local).square, at);
        }
    }
}

impl fmt::Debug for Patches {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Patches").field("len", &self.len()).field("nodes", &self.nodes.len()).finish_non_exhaustive()
    }
}
