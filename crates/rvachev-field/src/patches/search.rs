//! The search for the nearest patch: down the hierarchy, the nearer box first, leaving out boxes
//! that are farther than what is known.
//!
//! A flat patch is as far as its triangle, which is all there is to know. A curved one is as far as
//! that to within its sag, which is enough to leave most of them out: the few that are left are
//! asked for their nearest points once the boxes are done.

use rvachev_num::Real;

use super::Patches;
use super::face::{Face, SLACK, Sides};
use super::hierarchy::{LEAF, Node, PARENT};
use super::packet::Packet;

/// What is left of a lower bound after rounding: that of a box is off by a few units in the last
/// place, that of a patch by as much.
pub(super) const SURE: f64 = 1.0 - 16.0 * f32::EPSILON as f64;

/// The same of an upper bound.
const SURELY: f64 = 2.0 - SURE;

/// What is known so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<R> {
    /// Squares of the distances, or what they are at most.
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

/// What a search finds.
pub(super) struct Nearest<R> {
    /// How far it is at most, and the patch that is likely to be nearest.
    pub(super) all: Best<R>,
    /// The nearest of the flat patches that may be nearest of all.
    pub(super) flat: Best<R>,
}

/// Boxes that are still to be looked into, and how far they are at least. The lists are as long as
/// they have ever been.
pub(super) struct Stack<R> {
    boxes: Vec<(u32, R)>,
    kept: Vec<(u32, R)>,
}

/// A search of a block begins with so many boxes at most.
pub(super) const ENTRIES: usize = 12;

impl<R> Stack<R> {
    #[inline(always)]
    pub(super) fn new() -> Stack<R> {
        Stack { boxes: Vec::with_capacity(KEPT), kept: Vec::with_capacity(KEPT) }
    }
}

/// Writes an item to a place of a list, or adds it right behind.
#[inline(always)]
fn put<T>(list: &mut Vec<T>, at: usize, item: T) {
    match list.get_mut(at) {
        Some(place) => *place = item,
        None => list.push(item),
    }
}

/// Takes the curved patches that may be nearest.
pub(super) trait Keep<R> {
    /// Takes a patch, the square of how far it is at least, and that of what is known.
    fn keep(&mut self, at: u32, least: R, most: R);
}

/// Boxes that a search begins with.
pub(super) struct Entries {
    nodes: [u32; ENTRIES],
    count: usize,
}

impl Entries {
    /// All patches, of which there are some.
    pub(super) const ALL: &[u32] = &[0];

    pub(super) fn all(&self) -> &[u32] {
        &self.nodes[..self.count]
    }
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
    /// Finds the nearest patches to points of the surface's frame: of flat ones the nearest, of
    /// curved ones all that may be. It begins with boxes that hold all that may be nearest, the
    /// last one first; `seeds` are patches that are likely to be near. What is found below the
    /// range is a bound of the distance, and what is beyond is held at its end.
    #[inline(always)]
    pub(super) fn search<R: Packet>(
        &self,
        p: [R; 3],
        entries: &[u32],
        seeds: &[u32],
        range: Range<R>,
        stack: &mut Stack<R>,
        curved: &mut impl Keep<R>,
    ) -> Nearest<R> {
        let mut best = Best::none(p[0]).within(range.high);
        let mut flat = Best::none(p[0]);
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
        let mut height = 0;
        for entry in entries {
            self.push(*entry, p, most, stack, &mut height);
        }
        while height > 0 {
            let mut count = 0;
            while height > 0 && count + LEAF <= KEPT {
                height -= 1;
                let (at, least) = stack.boxes[height];
                if !least.any_below(most) {
                    continue;
                }
                let node = &self.nodes[at as usize];
                if node.count >= PARENT {
                    for child in self.far_and_near(node, p, middle) {
                        let inner = &self.nodes[child as usize];
                        // To go down by two makes fewer steps that each wait for the last one.
                        if !R::ALONE && inner.count >= PARENT {
                            for child in self.far_and_near(inner, p, middle) {
                                self.push(child, p, most, stack, &mut height);
                            }
                        } else {
                            self.push(child, p, most, stack, &mut height);
                        }
                    }
                    continue;
                }
                for at in node.first..node.first + node.count {
                    let Some((face, sides)) = self.at(at as usize) else { continue };
                    if face.is_flat() {
                        if let Some(square) = R::from_near_face(p, face, sides, most) {
                            best.take(square, at);
                            flat.take(square, at);
                            most = open(most.min(best.square));
                        }
                        continue;
                    }
                    // A patch is nearer than its triangle by its sag at most.
                    let reach = (at_most(most) + f64::from(face.sag)).square();
                    let Some(square) = R::from_near_face(p, face, sides, reach) else { continue };
                    let distance = square.sqrt();
                    let least = (distance * SURE - f64::from(face.sag)).max(square.lift(0.0));
                    let least = least.square() * SURE;
                    put(&mut stack.kept, count, (at, least));
                    count += usize::from(least.any_below(most));
                    best.take((distance + f64::from(face.sag)).square() * SURELY + f64::from(f32::MIN_POSITIVE), at);
                    most = open(most.min(best.square));
                }
            }
            for (at, least) in &stack.kept[..count] {
                curved.keep(*at, *least, most);
            }
        }
        Nearest { all: best.within(known), flat }
    }

    /// A patch that is hardly farther from a point than others: one of the box that going down to
    /// the nearer of two boxes leads to; and the square of how far it is at most.
    #[inline(never)]
    pub(super) fn near(&self, p: [f64; 3]) -> Best<f64> {
        let mut best = Best::none(0.0);
        let Some(mut node) = self.nodes.first() else { return best };
        let middle = p.map(|x| x as f32);
        while node.count >= PARENT {
            let [_, nearer] = self.far_and_near(node, p, middle);
            node = &self.nodes[nearer as usize];
        }
        for at in node.first..node.first + node.count {
            let Some((face, sides)) = self.at(at as usize) else { continue };
            best.take(farthest(f64::from_face(p, face, sides), face.sag), at);
        }
        best
    }

    /// The children of a box, the nearer one last.
    #[inline(always)]
    fn far_and_near<R: Packet>(&self, node: &Node, p: [R; 3], middle: [f32; 3]) -> [u32; 2] {
        let [a, b] = [&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]];
        let axis = (node.count - PARENT) as usize % 3;
        let mut b_first = 2.0 * middle[axis] > a.high[axis] + b.low[axis];
        if R::ALONE {
            let (gap_a, gap_b) = (self.gap(node.first, p).one(), self.gap(node.first + 1, p).one());
            b_first = (gap_b < gap_a) | ((gap_b == gap_a) & b_first);
        }
        let b_first = u32::from(b_first);
        [node.first + 1 - b_first, node.first + b_first]
    }

    /// Puts a box on the stack, if it may hold what is nearer than what is known.
    #[inline(always)]
    fn push<R: Packet>(&self, at: u32, p: [R; 3], most: R, stack: &mut Stack<R>, height: &mut usize) {
        let least = self.gap(at, p);
        // Without branches: which way they go is all but chance.
        put(&mut stack.boxes, *height, (at, least));
        *height += usize::from(least.any_below(most));
    }

    /// The square of how far points are from the patches of a box, at least.
    #[inline(always)]
    fn gap<R: Real>(&self, at: u32, p: [R; 3]) -> R {
        let disc = &self.discs[at as usize];
        if disc.is_none() { gap(&self.nodes[at as usize], p) } else { disc.gap(p) }
    }

    /// Boxes that hold all that may be nearest to points of a box, whose middle is that far from
    /// some patch at most: the nearest to the middle comes last.
    pub(super) fn entries(&self, low: [f64; 3], high: [f64; 3], far: f64) -> Entries {
        let mut entries = Entries { nodes: [0; ENTRIES], count: usize::from(!self.nodes.is_empty()) };
        let half = [0, 1, 2].map(|axis| 0.5 * (high[axis] - low[axis]));
        let within = (far + half.iter().map(|x| x * x).sum::<f64>().sqrt()) * (1.0 + 1e-6) + SLACK;
        let gaps = |node: &Node, axis: usize| {
            let (a, b) = (f64::from(node.low[axis]) - high[axis], low[axis] - f64::from(node.high[axis]));
            a.max(b).max(0.0)
        };
        // Numbers that are none leave nothing out.
        let is_far = |at: u32| {
            let node = &self.nodes[at as usize];
            (0..3).map(|axis| gaps(node, axis).powi(2)).sum::<f64>() > within * within
        };
        loop {
            let all = &entries.nodes[..entries.count];
            // The largest have the least numbers.
            let is_parent = |at: &u32| self.nodes[*at as usize].count >= PARENT && self.discs[*at as usize].is_none();
            let Some(place) = (0..all.len()).filter(|i| is_parent(&all[*i])).min_by_key(|i| all[*i]) else { break };
            let first = self.nodes[all[place] as usize].first;
            let (a, b) = (is_far(first), is_far(first + 1));
            if !a && !b && entries.count == ENTRIES {
                break;
            }
            if a && b {
                entries.count -= 1;
                entries.nodes[place] = entries.nodes[entries.count];
            } else {
                entries.nodes[place] = first + u32::from(a);
                if !a && !b {
                    entries.nodes[entries.count] = first + 1;
                    entries.count += 1;
                }
            }
        }
        let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
        let mut sorted = entries.nodes.map(|at| (0.0, at));
        let sorted = &mut sorted[..entries.count];
        sorted.iter_mut().for_each(|(gap, at)| *gap = self.gap(*at, middle));
        sorted.sort_unstable_by(|(a, _), (b, _)| b.total_cmp(a));
        entries.nodes.iter_mut().zip(sorted).for_each(|(to, (_, at))| *to = *at);
        entries
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

/// How far points are at most, by the square; rounding is on the far side.
#[inline(always)]
fn at_most<R: Real>(square: R) -> R {
    square.sqrt() * SURELY + f64::from(f32::MIN_POSITIVE)
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
