//! The search for the nearest patch: down the hierarchy, the nearer box first, leaving out boxes
//! that are farther than what is known.

use rvachev_num::Real;

use super::Patches;
use super::closest::on_face;
use super::curved::on_patch;
use super::hierarchy::{DEEPEST, Node};
use super::packet::Packet;

/// What is left of a lower bound after rounding: that of a box is off by a few units in the last
/// place, that of a patch by as much.
const SURE: f64 = 1.0 - 16.0 * f32::EPSILON as f64;

/// The nearest points that are known so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<R> {
    /// Squares of the distances.
    pub(super) square: R,
    /// From the points of the surface to those asked about.
    pub(super) from: [R; 3],
    /// Where the patches are, as the hierarchy sorts them.
    pub(super) which: R,
}

impl<R: Packet> Best<R> {
    /// Nothing is known.
    #[inline(always)]
    pub(super) fn none(like: R) -> Best<R> {
        let zero = like.lift(0.0);
        Best { square: like.lift(f64::from(f32::MAX)), from: [zero; 3], which: zero }
    }
}

/// Boxes that are still to be looked into, and how far they are at least.
pub(super) struct Stack<R>([(u32, R); DEEPEST]);

impl<R: Real> Stack<R> {
    pub(super) fn new(like: R) -> Stack<R> {
        Stack([(0, like.lift(0.0)); DEEPEST])
    }
}

impl Patches {
    /// Finds the nearest patches to points of the surface's frame. `seeds` are patches that are
    /// likely to be near.
    #[inline(always)]
    pub(super) fn search<R: Packet>(&self, p: [R; 3], seeds: &[u32], best: &mut Best<R>, stack: &mut Stack<R>) {
        if self.nodes.is_empty() {
            return;
        }
        for seed in seeds {
            self.try_patch(*seed as usize, p, best);
        }
        let middle = [p[0].one(), p[1].one(), p[2].one()];
        stack.0[0] = (0, p[0].lift(0.0));
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, least) = stack.0[height];
            if !least.any_below(best.square) {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                for patch in node.first..node.first + node.count {
                    self.try_patch(patch as usize, p, best);
                }
                continue;
            }
            let children = [node.first, node.first + 1];
            let [near, far] = self.sorted(children, middle);
            for child in [far, near] {
                let least = gap(&self.nodes[child as usize], p);
                if least.any_below(best.square) && height < DEEPEST {
                    stack.0[height] = (child, least);
                    height += 1;
                }
            }
        }
    }

    /// Two boxes, the one whose middle is nearer first.
    #[inline(always)]
    fn sorted(&self, [a, b]: [u32; 2], p: [f32; 3]) -> [u32; 2] {
        let far = |node: &Node| {
            let part = |i: usize| (node.low[i] + node.high[i] - 2.0 * p[i]).abs();
            part(0) + part(1) + part(2)
        };
        if far(&self.nodes[b as usize]) < far(&self.nodes[a as usize]) { [b, a] } else { [a, b] }
    }

    /// Takes a patch where it is nearer than what is known; of two that are equally near the one
    /// that comes first.
    #[inline(always)]
    fn try_patch<R: Packet>(&self, at: usize, p: [R; 3], best: &mut Best<R>) {
        let face = &self.faces[at];
        let flat = on_face(face, p);
        let mut found = flat.closest;
        if face.sag > 0.0 {
            let Some(bulge) = self.bulges.get(at) else { return };
            let least = (found.square.sqrt() * SURE - f64::from(face.sag)).max(found.square.lift(0.0));
            if !least.square().any_below(best.square) {
                return;
            }
            found = on_patch(face, bulge, &flat);
        }
        let which = best.which.lift(at as f64);
        let tie = (best.square - found.square).select(best.which - which, which.lift(-1.0));
        let wins = (found.square - best.square).select(tie, which.lift(1.0));
        best.square = wins.select(found.square, best.square);
        best.which = wins.select(which, best.which);
        for axis in 0..3 {
            best.from[axis] = wins.select(found.from[axis], best.from[axis]);
        }
    }
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
