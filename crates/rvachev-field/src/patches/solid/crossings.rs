//! Winding numbers of neighbouring points, by the triangles between them.
//!
//! ```text
//!           r  w = 0          From a point r, whose number is known, to a point p nearby the number
//!     -------\--------        changes where triangles are crossed: by −1 from behind to the front, by
//!      w = 1  \               +1 the other way. Only triangles in the box of both can be.
//!              p
//! ```
//!
//! That is so where triangles leave no opening: then numbers are whole. Of points that are close to
//! each other few triangles are looked at, those about a block once for all of it, where the sum
//! over all triangles takes all boxes of the hierarchy. Where a segment passes so close to an edge,
//! or ends so close to a triangle, that rounding may tell, the sum is asked. Where distances are
//! known, two points that are nearer to each other than either is to any triangle have the same
//! number.

use std::ops;

use rvachev_num::lanes::Lanes;

use super::super::block::{BLOCK, Block};
use super::super::face::{Face, Sides};
use super::super::hierarchy::PARENT;
use super::super::packet::{Packet, WIDEST};
use super::between::{Between, Crossed};
use super::near::{Hull, Near, box_of};
use super::winding::{Stack, Winding};
use super::winding_field::{FARTHEST, placed};
use crate::Placement;
use crate::kernel::Element;

/// Packets that more triangles may lie between are too wide.
const MANY: usize = 256;

/// Numbers are whole to this.
const WHOLE: f64 = 0.2;

/// A point whose number is known, and how far from it there is no triangle.
#[derive(Clone, Copy)]
struct Known {
    p: [f64; 3],
    number: f64,
    apart: f64,
}

/// What is kept from one chunk to the next of a call.
pub(super) struct Crossings<E> {
    block: Block<E>,
    found: [E; BLOCK],
    near: Near<E>,
    stack: Stack,
}

impl<E: Element> Crossings<E> {
    #[inline(always)]
    pub(super) fn new() -> Crossings<E> {
        Crossings { block: Block::new(), found: [E::default(); BLOCK], near: Near::new(), stack: Stack::default() }
    }
}

impl Winding {
    /// How far above one half the numbers at some points are, 0 where they are in doubt. No
    /// triangle is nearer to a point than `apart`, of which there may be none.
    #[inline(always)]
    pub(super) fn sides_by_crossings<L: Lanes<Element: Element> + Packet>(
        &self,
        simd: L::Token,
        points: [&[L::Element]; 3],
        apart: &[L::Element],
        local: &Placement,
        work: &mut Crossings<L::Element>,
        out: &mut [L::Element],
    ) {
        let len = out.len();
        let mut at = 0;
        while at < len {
            let [x, y, z] = placed::<L>(simd, points, local, at..at + L::WIDTH);
            x.store(&mut work.block.columns[0][at..at + L::WIDTH]);
            y.store(&mut work.block.columns[1][at..at + L::WIDTH]);
            z.store(&mut work.block.columns[2][at..at + L::WIDTH]);
            at += L::WIDTH;
        }
        let per_unit = 1.0 / self.patches.unit();
        for (to, apart) in work.block.numbers[..len].iter_mut().zip(apart) {
            // What is farther out has been moved nearer.
            *to = L::Element::from_f64((apart.to_f64() * per_unit).min(0.5 * FARTHEST));
        }
        work.block.sort(len, 0);
        let mut known: Option<Known> = None;
        let mut are_near = true;
        let mut at = 0;
        while at < len {
            let here = at..at + L::WIDTH;
            let p = [
                L::load(simd, &work.block.columns[0][here.clone()]),
                L::load(simd, &work.block.columns[1][here.clone()]),
                L::load(simd, &work.block.columns[2][here.clone()]),
            ];
            let known_before = known.take();
            let from = if !are_near {
                None
            } else if known_before.is_some() {
                known_before
            } else {
                self.known(&work.block, at, &mut work.stack)
            };
            let Some(mut from) = from else {
                are_near = false;
                (self.roughly(p, &mut work.stack) - 0.5).store(&mut work.found[here]);
                at += L::WIDTH;
                continue;
            };
            let mut free = [L::Element::from_f64(-1.0); WIDEST];
            if !apart.is_empty() {
                spread(simd, p, &work.block, at, &mut from, &mut free);
            }
            let is_free = L::load(simd, &free[..L::WIDTH]);
            let mut number = p[0].lift(from.number);
            if is_free.any_below(p[0].lift(0.0)) {
                let mut hull = Hull::of(from.p);
                let mut i = 0;
                while i < L::WIDTH {
                    if free[i].to_f64() < 0.0 {
                        hull.with(wide_of(work.block.point(at + i)));
                    }
                    i += 1;
                }
                if !work.near.hull.holds(&hull) {
                    are_near = self.gather(&work.block, at..len, L::WIDTH, &from, &mut work.near, &mut work.stack);
                }
                let crossed = if are_near { self.crossed(simd, p, &from, &hull, &work.near) } else { None };
                let Some(Crossed { more, doubt }) = crossed else {
                    are_near = false;
                    (self.roughly(p, &mut work.stack) - 0.5).store(&mut work.found[here]);
                    at += L::WIDTH;
                    continue;
                };
                // In doubt it is one half.
                number = is_free.select(number, (-doubt).select(number + more, number.lift(0.5)));
            }
            (number - 0.5).store(&mut work.found[here]);
            // The farthest from the triangles holds the farthest.
            let mut i = at;
            while i < at + L::WIDTH {
                let (above, apart) = (work.found[i].to_f64(), work.block.numbers[i].to_f64());
                if above != 0.0 && known.is_none_or(|known| apart > known.apart) {
                    known = Some(Known { p: wide_of(work.block.point(i)), number: above + 0.5, apart });
                }
                i += 1;
            }
            at += L::WIDTH;
        }
        work.block.unsorted(&work.found, out);
    }

    /// The number at a point, if that is whole.
    fn known<E: Element>(&self, block: &Block<E>, at: usize, stack: &mut Stack) -> Option<Known> {
        let (p, apart) = (wide_of(block.point(at)), block.numbers[at].to_f64());
        let number = self.whole_at(p, stack).or_else(|| {
            let number = self.number_at(p);
            let whole = number.round();
            ((number - whole).abs() < WHOLE).then_some(whole)
        });
        number.map(|number| Known { p, number, apart })
    }

    /// The number at a point by the way there from outside, where triangles leave no opening and
    /// that is certain.
    #[inline(never)]
    pub(super) fn whole_at(&self, p: [f64; 3], stack: &mut Stack) -> Option<f64> {
        let is_told = self.is_closed() && p.iter().all(|x| x.is_finite());
        let from = Known { p: self.outside(p).filter(|_| is_told)?, number: 0.0, apart: 0.0 };
        self.more(p, &from, stack)
    }

    /// A point outside that is near along an axis.
    fn outside(&self, p: [f64; 3]) -> Option<[f64; 3]> {
        let root = self.patches.nodes.first()?;
        let (mut out, mut least) = (p, f64::INFINITY);
        for axis in 0..3 {
            for end in [f64::from(root.low[axis]) - 1.0, f64::from(root.high[axis]) + 1.0] {
                let far = (end - p[axis]).abs();
                if far < least {
                    (out, least) = (p, far);
                    out[axis] = end;
                }
            }
        }
        Some(out)
    }

    /// Looks at all triangles that may meet a hull.
    #[inline(always)]
    fn each_within(&self, hull: &Hull, stack: &mut Stack, mut look: impl FnMut(u32, &Face, &Sides) -> bool) -> bool {
        let mut height = usize::from(!self.patches.nodes.is_empty());
        stack.0[0] = 0;
        while height > 0 {
            height -= 1;
            let node = &self.patches.nodes[stack.0[height] as usize];
            if !hull.meets(node.low, node.high) {
                continue;
            }
            if node.count >= PARENT {
                stack.0[height] = node.first;
                stack.0[height + 1] = node.first + 1;
                height += 2;
                continue;
            }
            for at in node.first..node.first + node.count {
                let Some((face, sides)) = self.patches.at(at as usize) else { continue };
                if !look(at, face, sides) {
                    return false;
                }
            }
        }
        true
    }

    /// How the number at a point differs from that at another, if that is certain.
    fn more(&self, p: [f64; 3], from: &Known, stack: &mut Stack) -> Option<f64> {
        let mut crossed = Crossed { more: 0.0, doubt: -1.0 };
        let mut hull = Hull::of(from.p);
        hull.with(p);
        let (d, reach) = ([p[0] - from.p[0], p[1] - from.p[1], p[2] - from.p[2]], hull.diagonal());
        self.each_within(&hull, stack, |_, face, sides| {
            let [low, high] = box_of(face, sides);
            if hull.meets(low, high) {
                Between::new(from.p, face, sides).add(d, reach, &mut crossed);
            }
            true
        });
        (crossed.doubt <= 0.0).then_some(crossed.more)
    }

    /// Finds the triangles about the points of a block from `at` on, as far as they are not many,
    /// and a point that is known.
    #[inline(never)]
    fn gather<E: Element>(
        &self,
        block: &Block<E>,
        points: ops::Range<usize>,
        width: usize,
        from: &Known,
        near: &mut Near<E>,
        stack: &mut Stack,
    ) -> bool {
        let mut to = points.end;
        while to > points.start {
            near.count = 0;
            near.hull = Hull::of(from.p);
            for at in points.start..to {
                near.hull.with(wide_of(block.point(at)));
            }
            let hull = near.hull;
            if self.each_within(&hull, stack, |at, face, sides| near.push(at, box_of(face, sides))) {
                near.end(width);
                return true;
            }
            // Half of the packets.
            to = points.start + (to - points.start) / width / 2 * width;
        }
        // Nothing is known of the hull that was tried last.
        (near.count, near.hull) = (0, Hull::NONE);
        false
    }

    /// What is crossed on the straight ways from a point to those of a packet; nothing if that is
    /// much. The hull holds all of them.
    #[inline(always)]
    fn crossed<L: Lanes<Element: Element> + Packet>(
        &self,
        simd: L::Token,
        p: [L; 3],
        from: &Known,
        hull: &Hull,
        near: &Near<L::Element>,
    ) -> Option<Crossed<L>> {
        let mut crossed = Crossed { more: p[0].lift(0.0), doubt: p[0].lift(-1.0) };
        let [x, y, z] = from.p;
        let d = [p[0] - x, p[1] - y, p[2] - z];
        let reach = hull.diagonal();
        let mut looked = 0;
        let mut at = 0;
        while at < near.count {
            let mut beyond = p[0].lift(-1.0);
            let mut axis = 0;
            while axis < 3 {
                let low = L::load(simd, &near.low[axis][at..at + L::WIDTH]);
                let high = L::load(simd, &near.high[axis][at..at + L::WIDTH]);
                beyond = beyond.max(low - f64::from(hull.high[axis])).max(-high + f64::from(hull.low[axis]));
                axis += 1;
            }
            let mut met = !beyond.lift(0.0).below(beyond) & ((1 << L::WIDTH) - 1);
            while met != 0 {
                let which = near.which[at + met.trailing_zeros() as usize];
                met &= met - 1;
                if let Some((face, sides)) = self.patches.at(which as usize) {
                    Between::new(from.p, face, sides).add(d, reach, &mut crossed);
                    looked += 1;
                }
            }
            at += L::WIDTH;
        }
        if looked > MANY { None } else { Some(crossed) }
    }
}

/// So often points of a packet are found by others of it.
const ROUNDS: usize = 4;

/// Finds points of a packet that are on the side of one that is known, which becomes one of them:
/// two points are if they are nearer to each other than either is to any triangle. Of those `free`
/// is not below 0.
#[inline(always)]
fn spread<L: Lanes<Element: Element> + Packet>(
    simd: L::Token,
    p: [L; 3],
    block: &Block<L::Element>,
    at: usize,
    from: &mut Known,
    free: &mut [L::Element; WIDEST],
) {
    let apart = L::load(simd, &block.numbers[at..at + L::WIDTH]);
    let mut is_used = [false; WIDEST];
    let mut round = 0;
    while round < ROUNDS {
        let [x, y, z] = from.p;
        let d = [p[0] - x, p[1] - y, p[2] - z];
        let square = d[0].mul_add(d[0], d[1].mul_add(d[1], d[2] * d[2]));
        let ball = apart.max(apart.lift(from.apart.max(0.0)));
        let all = L::load(simd, &free[..L::WIDTH]).max(ball * ball - square);
        all.store(&mut free[..L::WIDTH]);
        if !all.any_below(square.lift(0.0)) {
            return;
        }
        let mut next = None;
        let mut i = 0;
        while i < L::WIDTH {
            let apart = block.numbers[at + i].to_f64();
            if free[i].to_f64() >= 0.0 && !is_used[i] && next.is_none_or(|(_, most)| apart > most) {
                next = Some((i, apart));
            }
            i += 1;
        }
        let Some((i, apart)) = next else { return };
        is_used[i] = true;
        *from = Known { p: wide_of(block.point(at + i)), apart, ..*from };
        round += 1;
    }
}

#[inline(always)]
fn wide_of<E: Element>(p: [E; 3]) -> [f64; 3] {
    [p[0].to_f64(), p[1].to_f64(), p[2].to_f64()]
}
