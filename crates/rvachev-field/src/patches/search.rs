//! The search for the nearest patch: down the hierarchy, the nearer box first, leaving out boxes
//! that are farther than what is known.
//!
//! A flat patch is as far as its triangle. A curved one is as far as that to within its sag, which
//! is enough to leave most of them out: the few that are left are asked for their nearest points
//! once the boxes are done.

use rvachev_num::Real;

use super::Patches;
use super::face::{Face, Sides};
use super::hierarchy::{DEEPEST, LEAF, Node, PARENT};
use super::packet::Packet;

/// What is left of a lower bound after rounding: that of a box is off by a few units in the last
/// place, that of a patch by as much.
const SURE: f64 = 1.0 - 16.0 * f32::EPSILON as f64;

/// The same of an upper bound.
const SURELY: f64 = 2.0 - SURE;

/// What is known so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<R> {
    /// Squares of the distances, of a surface with curved patches: what they are at most.
    pub(super) square: R,
    /// Where the patches are, as the hierarchy sorts them.
    pub(super) which: R,
}

impl<R: Packet> Best<R> {
    /// Nothing is known.
    #[inline(always)]
    pub(super) fn none(like: R) -> Best<R> {
        Best { square: like.lift(f64::from(f32::MAX)), which: like.lift(0.0) }
    }

    /// It is no farther than this.
    #[inline(always)]
    fn within(self, farthest: R) -> Best<R> {
        Best { square: self.square.min(farthest), ..self }
    }

    /// Takes a patch where it is nearer than what is known; of two that are equally near the one
    /// that comes first.
    #[inline(always)]
    pub(super) fn take(&mut self, square: R, at: u32) {
        let which = square.lift(f64::from(at));
        let tie = (self.square - square).select(self.which - which, which.lift(-1.0));
        let loses = (square - self.square).select(-tie, which.lift(-1.0));
        self.square = loses.select(self.square, square);
        self.which = loses.select(self.which, which);
    }
}

/// Boxes that are still to be looked into, and how far they are at least.
pub(super) struct Stack<R>([(u32, R); DEEPEST]);

impl<R: Real> Stack<R> {
    #[inline(always)]
    pub(super) fn new(like: R) -> Stack<R> {
        Stack([(0, like.lift(0.0)); DEEPEST])
    }
}

/// Takes the curved patches that may be nearest.
pub(super) trait Keep<R> {
    /// Takes a patch, the square of how far it is at least, and that of what is known.
    fn keep(&mut self, at: u32, least: R, most: R);
}

/// Which distances a search is to find: squares of those that are near enough to be told apart, and
/// far enough.
#[derive(Clone, Copy)]
pub(super) struct Range<R> {
    pub(super) low: R,
    pub(super) high: R,
}

impl<R: Packet> Range<R> {
    /// All of them.
    #[inline(always)]
    pub(super) fn all(like: R) -> Range<R> {
        Range { low: like.lift(-1.0), high: like.lift(f64::from(f32::MAX)) }
    }
}

/// Curved patches of a search that is not at its end.
const KEPT: usize = 32;

impl Patches {
    /// Finds the nearest patches to points of the surface's frame, of curved patches all that may
    /// be. `seeds` are patches that are likely to be near. What is found below the range is a bound
    /// of the distance, and what is beyond is held at its end.
    #[inline(always)]
    pub(super) fn search<R: Packet>(
        &self,
        p: [R; 3],
        seeds: &[u32],
        range: Range<R>,
        stack: &mut Stack<R>,
        curved: &mut impl Keep<R>,
    ) -> Best<R> {
        let mut best = Best::none(p[0]).within(range.high);
        if self.nodes.is_empty() {
            return best;
        }
        let is_flat = self.quadratics.is_empty();
        // No point is farther than this.
        let mut most = best.square;
        for seed in seeds {
            if let Some((face, sides)) = self.at(*seed as usize) {
                let square = farthest(R::from_face(p, face, sides), face.sag);
                best.which = (square - most).select(best.which, square.lift(f64::from(*seed)));
                most = most.min(square);
            }
        }
        let known = most;
        // Of what is below the range no more is asked.
        let open = |most: R| (range.low - most).select(most.lift(0.0), most);
        most = open(most);
        let middle = [p[0].one(), p[1].one(), p[2].one()];
        let mut kept = [(0, most); KEPT];
        stack.0[0] = (0, p[0].lift(0.0));
        let mut height = 1;
        while height > 0 {
            let mut count = 0;
            while height > 0 && count + LEAF <= KEPT {
                height -= 1;
                let (at, least) = stack.0[height];
                if !least.any_below(most) {
                    continue;
                }
                let node = &self.nodes[at as usize];
                if node.count >= PARENT {
                    let [a, b] = [&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]];
                    let axis = (node.count - PARENT) as usize % 3;
                    let mut b_first = 2.0 * middle[axis] > a.high[axis] + b.low[axis];
                    if R::ALONE {
                        let (gap_a, gap_b) = (gap(a, p).one(), gap(b, p).one());
                        b_first = (gap_b < gap_a) | ((gap_b == gap_a) & b_first);
                    }
                    // Without branches: which way they go is all but chance.
                    let b_first = u32::from(b_first);
                    let [near, far] = [node.first + b_first, node.first + 1 - b_first];
                    let least = gap(&self.nodes[far as usize], p);
                    stack.0[height] = (far, least);
                    height += usize::from(least.any_below(most));
                    let least = gap(&self.nodes[near as usize], p);
                    stack.0[height] = (near, least);
                    height += usize::from(least.any_below(most));
                    continue;
                }
                for at in node.first..node.first + node.count {
                    let Some((face, sides)) = self.at(at as usize) else { continue };
                    let square = R::from_face(p, face, sides);
                    if is_flat {
                        best.take(square, at);
                        most = open(most.min(best.square));
                        continue;
                    }
                    let distance = square.sqrt();
                    let least = (distance * SURE - f64::from(face.sag)).max(square.lift(0.0));
                    let least = least.square() * SURE;
                    kept[count] = (at, least);
                    count += usize::from(least.any_below(most));
                    best.take((distance + f64::from(face.sag)).square() * SURELY + f64::from(f32::MIN_POSITIVE), at);
                    most = open(most.min(best.square));
                }
            }
            for (at, least) in &kept[..count] {
                curved.keep(*at, *least, most);
            }
        }
        best.within(known)
    }

    /// A patch's triangle.
    #[inline(always)]
    pub(super) fn at(&self, at: usize) -> Option<(&Face, &Sides)> {
        Some((self.faces.get(at)?, self.sides.get(at)?))
    }
}

/// The square of how far a patch is at most, by that of its triangle and its sag; rounding is on
/// the far side.
#[inline(always)]
fn farthest<R: Real>(square: R, sag: f32) -> R {
    (square.sqrt() + f64::from(sag)).square() * SURELY + f64::from(f32::MIN_POSITIVE)
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
    x - x.max(x.lift(f64::from(low))).min(x.lift(f64::from(high)))
}
