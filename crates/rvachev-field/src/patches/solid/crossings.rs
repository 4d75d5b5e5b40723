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
use super::super::packet::Packet;
use super::between::{Between, Crossed};
use super::flood::Flood;
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
    flood: Flood<E>,
    near: Near<E>,
    stack: Stack,
}

impl<E: Element> Crossings<E> {
    #[inline(always)]
    pub(super) fn new() -> Crossings<E> {
        let (block, found, flood) = (Block::new(), [E::default(); BLOCK], Flood::new());
        Crossings { block, found, flood, near: Near::new(), stack: Stack::default() }
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
        work.flood.start();
        let do_spread = !apart.is_empty();
        let mut known: Option<Known> = None;
        let mut are_near = true;
        let mut at = 0;
        while at < len {
            let here = at..at + L::WIDTH;
            let mut open = work.flood.packet::<L>(simd, at);
            if do_spread && are_near && known.is_none() {
                known = self.known(&work.block, at, &mut work.stack);
                if let Some(known) = known {
                    work.found[at] = L::Element::from_f64(known.number - 0.5);
                    work.flood.fill(at, work.block.numbers[at]);
                    work.flood.spread::<L>(simd, &work.block, len, &mut work.found);
                    open = work.flood.packet::<L>(simd, at);
                }
            }
            if !open.lift(0.0).any_below(open) {
                at += L::WIDTH;
                continue;
            }
            let p = [
                L::load(simd, &work.block.columns[0][here.clone()]),
                L::load(simd, &work.block.columns[1][here.clone()]),
                L::load(simd, &work.block.columns[2][here.clone()]),
            ];
            let before = L::load(simd, &work.found[here.clone()]);
            // The farthest from the triangles holds the farthest.
            let mut from = None;
            let mut i = at;
            while i < at + L::WIDTH {
                let (above, apart) = (work.found[i].to_f64(), work.block.numbers[i].to_f64());
                let is_told = !work.flood.is_open(i) && above != 0.0;
                if is_told && from.is_none_or(|known: Known| apart > known.apart) {
                    from = Some(Known { p: wide_of(work.block.point(i)), number: above + 0.5, apart });
                }
                i += 1;
            }
            let from = if !are_near {
                None
            } else if from.is_some() {
                from
            } else if known.is_some() {
                known
            } else {
                self.known(&work.block, at, &mut work.stack)
            };
            let mut crossed = None;
            if let Some(from) = &from {
                let mut hull = Hull::of(from.p);
                let mut i = at;
                while i < at + L::WIDTH {
                    if work.flood.is_open(i) {
                        hull.with(wide_of(work.block.point(i)));
                    }
                    i += 1;
                }
                if !work.near.hull.holds(&hull) {
                    let Crossings { block, flood, near, stack, .. } = &mut *work;
                    are_near = self.gather(block, flood, at..len, L::WIDTH, from, near, stack);
                }
                if are_near {
                    crossed = self.crossed(simd, p, from, &hull, &work.near);
                }
            }
            let told = match (from, crossed) {
                // In doubt it is one half.
                (Some(from), Some(Crossed { more, doubt })) => {
                    (-doubt).select(more + (from.number - 0.5), more.lift(0.0))
                }
                _ => {
                    are_near = false;
                    self.roughly(p, &mut work.stack) - 0.5
                }
            };
            (-open).select(before, told).store(&mut work.found[here]);
            known = None;
            let mut i = at;
            while i < at + L::WIDTH {
                let (above, apart) = (work.found[i].to_f64(), work.block.numbers[i].to_f64());
                if above != 0.0 && known.is_none_or(|known| apart > known.apart) {
                    known = Some(Known { p: wide_of(work.block.point(i)), number: above + 0.5, apart });
                }
                if work.flood.is_open(i) {
                    work.flood.know(i);
                    if are_near && above != 0.0 {
                        work.flood.fill(i, work.block.numbers[i]);
                    }
                }
                i += 1;
            }
            if do_spread && are_near {
                work.flood.spread::<L>(simd, &work.block, len, &mut work.found);
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

    /// Finds the triangles about the points of a block whose sides are not known yet, as far as
    /// they are not many, and a point that is known.
    #[expect(clippy::too_many_arguments)]
    #[inline(never)]
    fn gather<E: Element>(
        &self,
        block: &Block<E>,
        flood: &Flood<E>,
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
            for at in (points.start..to).filter(|at| flood.is_open(*at)) {
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

#[inline(always)]
fn wide_of<E: Element>(p: [E; 3]) -> [f64; 3] {
    [p[0].to_f64(), p[1].to_f64(), p[2].to_f64()]
}
