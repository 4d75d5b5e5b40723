//! The search for the nearest patch: down the hierarchy, the nearer box first, leaving out boxes
//! that are farther than what is known.
//!
//! A flat patch is as far as its triangle. A curved one is as far as that to within its sag, which
//! is enough to leave most of them out: the few that are left are kept until the boxes are done,
//! and then asked for their nearest points.

use rvachev_num::Real;

use super::Patches;
use super::closest::{Closest, on_face};
use super::curved::on_patch;
use super::face::{Face, Sides};
use super::hierarchy::{DEEPEST, LEAF, Node};
use super::packet::Packet;

/// What is left of a lower bound after rounding: that of a box is off by a few units in the last
/// place, that of a patch by as much.
const SURE: f64 = 1.0 - 16.0 * f32::EPSILON as f64;

/// How many curved patches are kept.
const KEPT: usize = 64;

/// The nearest points that are known so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<R> {
    /// Squares of the distances.
    pub(super) square: R,
    /// From the points of the surface to those asked about; not found on surfaces without curved
    /// patches.
    pub(super) from: [R; 3],
    /// Where the patches are, as the hierarchy sorts them.
    pub(super) which: R,
}

impl<R: Packet> Best<R> {
    /// Nothing is known.
    #[inline(always)]
    fn none(like: R) -> Best<R> {
        let zero = like.lift(0.0);
        Best { square: like.lift(f64::from(f32::MAX)), from: [zero; 3], which: zero }
    }

    /// Takes a patch where it is nearer than what is known; of two that are equally near the one
    /// that comes first. Not negative where it was taken.
    #[inline(always)]
    fn take(&mut self, square: R, at: u32) -> R {
        let which = square.lift(f64::from(at));
        let tie = (self.square - square).select(self.which - which, which.lift(-1.0));
        let loses = (square - self.square).select(-tie, which.lift(-1.0));
        self.square = loses.select(self.square, square);
        self.which = loses.select(self.which, which);
        loses
    }

    /// The same with the points.
    #[inline(always)]
    fn take_point(&mut self, found: &Closest<R>, at: u32) {
        let loses = self.take(found.square, at);
        self.from = [
            loses.select(self.from[0], found.from[0]),
            loses.select(self.from[1], found.from[1]),
            loses.select(self.from[2], found.from[2]),
        ];
    }
}

/// What a search has still to look into, and how far that is at least.
pub(super) struct Stack<R> {
    boxes: [(u32, R); DEEPEST],
    patches: [(u32, R); KEPT],
}

impl<R: Real> Stack<R> {
    #[inline(always)]
    pub(super) fn new(like: R) -> Stack<R> {
        let none = (0, like.lift(0.0));
        Stack { boxes: [none; DEEPEST], patches: [none; KEPT] }
    }
}

impl Patches {
    /// Finds the nearest patches to points of the surface's frame. `seeds` are patches that are
    /// likely to be near.
    #[inline(always)]
    pub(super) fn search<R: Packet>(&self, p: [R; 3], seeds: &[u32], stack: &mut Stack<R>) -> Best<R> {
        let mut best = Best::none(p[0]);
        if self.nodes.is_empty() {
            return best;
        }
        // No point is farther than this.
        let mut most = best.square;
        for seed in seeds {
            if let Some((face, sides)) = self.at(*seed as usize) {
                most = most.min(farthest(R::from_face(p, face, sides), face.sag));
            }
        }
        let middle = [p[0].one(), p[1].one(), p[2].one()];
        stack.boxes[0] = (0, p[0].lift(0.0));
        let mut height = 1;
        while height > 0 {
            let mut kept = 0;
            while height > 0 && kept + LEAF <= KEPT {
                height -= 1;
                let (at, least) = stack.boxes[height];
                if !least.any_below(most) {
                    continue;
                }
                let node = &self.nodes[at as usize];
                if node.count == 0 {
                    let [a, b] = [&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]];
                    // Without branches: which way they go is all but chance.
                    let b_first = u32::from(apart(b, middle) < apart(a, middle));
                    let [near, far] = [node.first + b_first, node.first + 1 - b_first];
                    let least = gap(&self.nodes[far as usize], p);
                    stack.boxes[height] = (far, least);
                    height += usize::from(least.any_below(most));
                    let least = gap(&self.nodes[near as usize], p);
                    stack.boxes[height] = (near, least);
                    height += usize::from(least.any_below(most));
                    continue;
                }
                for at in node.first..node.first + node.count {
                    let Some((face, sides)) = self.at(at as usize) else { continue };
                    let square = R::from_face(p, face, sides);
                    if self.bulges.is_empty() {
                        best.take(square, at);
                        most = most.min(best.square);
                        continue;
                    }
                    let least = (square.sqrt() * SURE - f64::from(face.sag)).max(square.lift(0.0));
                    let least = least.square() * SURE;
                    if least.any_below(most) {
                        most = most.min(farthest(square, face.sag));
                        stack.patches[kept] = (at, least);
                        kept += 1;
                    }
                }
            }
            for (at, least) in &stack.patches[..kept] {
                if !least.any_below(most) {
                    continue;
                }
                let Some((face, sides)) = self.at(*at as usize) else { continue };
                let flat = on_face(face, sides, p);
                let mut found = flat.closest;
                if face.sag > 0.0 {
                    let wanted = (*least - most).select(most.lift(-1.0), most.lift(1.0));
                    found = on_patch(sides, &self.bulges[*at as usize], &flat, wanted);
                }
                best.take_point(&found, *at);
                most = most.min(best.square);
            }
        }
        best
    }

    /// A patch's triangle.
    #[inline(always)]
    pub(super) fn at(&self, at: usize) -> Option<(&Face, &Sides)> {
        Some((self.faces.get(at)?, self.sides.get(at)?))
    }
}

/// Twice how far a point is from the middle of a box, along the axes.
#[inline(always)]
fn apart(node: &Node, p: [f32; 3]) -> f32 {
    let x = node.low[0] + node.high[0] - 2.0 * p[0];
    let y = node.low[1] + node.high[1] - 2.0 * p[1];
    let z = node.low[2] + node.high[2] - 2.0 * p[2];
    x.abs() + y.abs() + z.abs()
}

/// The square of how far a patch is at most, by that of its triangle and its sag; rounding is on
/// the far side.
#[inline(always)]
fn farthest<R: Real>(square: R, sag: f32) -> R {
    (square.sqrt() + f64::from(sag)).square() * (2.0 - SURE) + f64::from(f32::MIN_POSITIVE)
}

/// The square of how far points are from a box, at least.
#[inline(always)]
fn gap<R: Real>(node: &Node, p: [R; 3]) -> R {
    let x = beyond(p[0], node.low[0], node.high[0]);
    let y = beyond(p[1], node.low[1], node.high[1]);
    let z = beyond(p[2], node.low[2], node.high[2]);
    x.mul_add(x, y.mul_add(y, z * z)) * SURE
}

/// How far numbers are from a range.
#[inline(always)]
fn beyond<R: Real>(x: R, low: f32, high: f32) -> R {
    (-x + f64::from(low)).max(x - f64::from(high)).max(x.lift(0.0))
}
