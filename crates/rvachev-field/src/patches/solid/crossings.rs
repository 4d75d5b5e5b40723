//! Winding numbers of neighbouring points, by the triangles between them.
//!
//! ```text
//!           r  w = 0          From a point r, whose number is known, to a point p nearby the number
//!     -------\--------        changes where triangles are crossed: by −1 from behind to the front, by
//!      w = 1  \               +1 the other way. Only triangles in the box of both can be.
//!              p
//! ```
//!
//! That is so where triangles leave no opening: then numbers are whole. Of a packet of points that
//! are close to each other few triangles are looked at, where the sum over all triangles takes all
//! boxes of the hierarchy. Where a segment passes so close to an edge, or ends so close to a
//! triangle, that rounding may tell, the sum is asked.

use rvachev_num::Real;
use rvachev_num::lanes::Lanes;

use super::super::block::{BLOCK, Block};
use super::super::face::wide;
use super::super::hierarchy::PARENT;
use super::super::packet::Packet;
use super::winding::{Stack, Winding};
use super::winding_field::placed;
use crate::Placement;
use crate::kernel::Element;

/// Stored corners of neighbouring triangles differ by less, in units of the frame.
const CORNERS: f64 = 4.0 * f32::EPSILON as f64;

/// Products of three factors are off by less than so many units in the last place.
const PRODUCTS: f64 = 16.0;

/// Packets that more triangles may lie between are too wide.
const MANY: usize = 256;

/// No larger than this is what makes no difference.
const NOTHING: f64 = 1e-30;

/// Numbers are whole to this.
const WHOLE: f64 = 0.2;

/// A box of the frame.
#[derive(Clone, Copy)]
struct Hull {
    low: [f64; 3],
    high: [f64; 3],
}

impl Hull {
    #[inline(always)]
    fn of(p: [f64; 3]) -> Hull {
        Hull { low: p, high: p }
    }

    #[inline(always)]
    fn with(&mut self, p: [f64; 3]) {
        for (axis, x) in p.into_iter().enumerate() {
            self.low[axis] = if x < self.low[axis] { x } else { self.low[axis] };
            self.high[axis] = if x > self.high[axis] { x } else { self.high[axis] };
        }
    }

    #[inline(always)]
    fn meets(&self, low: [f64; 3], high: [f64; 3]) -> bool {
        let beyond = |axis: usize| low[axis] > self.high[axis] || high[axis] < self.low[axis];
        !(beyond(0) | beyond(1) | beyond(2))
    }

    fn diagonal(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        (x * x + y * y + z * z).sqrt()
    }
}

/// A point whose number is known.
#[derive(Clone, Copy)]
struct Known {
    p: [f64; 3],
    number: f64,
}

/// What the triangles between a point and a packet tell.
struct Crossed<R> {
    /// How much more the numbers of the packet are.
    more: R,
    /// Positive where rounding may have told.
    doubt: R,
}

/// What is kept from one chunk to the next of a call.
pub(super) struct Crossings<E> {
    block: Block<E>,
    found: [E; BLOCK],
    stack: Stack,
}

impl<E: Element> Crossings<E> {
    #[inline(always)]
    pub(super) fn new() -> Crossings<E> {
        Crossings { block: Block::new(), found: [E::default(); BLOCK], stack: Stack::default() }
    }
}

impl Winding {
    /// How far above one half the numbers at some points are, 0 where they are in doubt.
    #[inline(always)]
    pub(super) fn sides_by_crossings<L: Lanes<Element: Element> + Packet>(
        &self,
        simd: L::Token,
        points: [&[L::Element]; 3],
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
        work.block.sort(len);
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
            let from = if are_near { known.take().or_else(|| self.known(work.block.point(at))) } else { None };
            let crossed = match from {
                Some(from) => {
                    let mut hull = Hull::of(from.p);
                    let mut i = at;
                    while i < at + L::WIDTH {
                        hull.with(wide_of(work.block.point(i)));
                        i += 1;
                    }
                    self.crossed(p, &from, &hull, &mut work.stack)
                }
                None => None,
            };
            are_near &= crossed.is_some() || from.is_none();
            match (from, crossed) {
                (Some(from), Some(Crossed { more, doubt })) => {
                    let number = more + from.number;
                    // In doubt it is one half.
                    let half = number.lift(0.5);
                    ((-doubt).select(number, half) - 0.5).store(&mut work.found[here]);
                    let mut i = at;
                    while i < at + L::WIDTH && known.is_none() {
                        let above = work.found[i].to_f64();
                        if above != 0.0 {
                            known = Some(Known { p: wide_of(work.block.point(i)), number: above + 0.5 });
                        }
                        i += 1;
                    }
                }
                _ => (self.roughly(p, &mut work.stack) - 0.5).store(&mut work.found[here]),
            }
            at += L::WIDTH;
        }
        work.block.unsorted(&work.found, out);
    }

    /// The number at a point, if that is whole.
    fn known<E: Element>(&self, p: [E; 3]) -> Option<Known> {
        let p = wide_of(p);
        let number = self.number_at(p);
        let whole = number.round();
        ((number - whole).abs() < WHOLE).then_some(Known { p, number: whole })
    }

    /// What is crossed on the straight ways from a point to those of a packet; nothing if that is
    /// much. The hull holds all of them.
    #[inline(always)]
    fn crossed<R: Packet>(&self, p: [R; 3], from: &Known, hull: &Hull, stack: &mut Stack) -> Option<Crossed<R>> {
        let mut crossed = Crossed { more: p[0].lift(0.0), doubt: p[0].lift(-1.0) };
        let [x, y, z] = from.p;
        let d = [p[0] - x, p[1] - y, p[2] - z];
        let reach = hull.diagonal();
        let mut looked = 0;
        let mut height = usize::from(!self.patches.nodes.is_empty());
        stack.0[0] = 0;
        while height > 0 {
            height -= 1;
            let node = &self.patches.nodes[stack.0[height] as usize];
            if !hull.meets(wide(node.low), wide(node.high)) {
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
                let between = Between::new(from.p, wide(face.a), wide(sides.e), wide(sides.f));
                if !hull.meets(between.low, between.high) {
                    continue;
                }
                looked += 1;
                between.add(d, reach, &mut crossed);
            }
            if looked > MANY {
                return None;
            }
        }
        Some(crossed)
    }
}

/// A triangle as seen from a point.
struct Between {
    /// From the point to the corners.
    a: [f64; 3],
    b: [f64; 3],
    c: [f64; 3],
    /// Twice the area vector.
    n: [f64; 3],
    /// Its box.
    low: [f64; 3],
    high: [f64; 3],
}

impl Between {
    #[inline(always)]
    fn new(from: [f64; 3], a: [f64; 3], e: [f64; 3], f: [f64; 3]) -> Between {
        let mut triangle =
            Between { a: [0.0; 3], b: [0.0; 3], c: [0.0; 3], n: cross(e, f), low: [0.0; 3], high: [0.0; 3] };
        for axis in 0..3 {
            let (least, most) = (e[axis].min(f[axis]).min(0.0), e[axis].max(f[axis]).max(0.0));
            triangle.low[axis] = a[axis] + least - CORNERS;
            triangle.high[axis] = a[axis] + most + CORNERS;
            triangle.a[axis] = a[axis] - from[axis];
            triangle.b[axis] = triangle.a[axis] + e[axis];
            triangle.c[axis] = triangle.a[axis] + f[axis];
        }
        triangle
    }

    /// Adds whether it is crossed on the ways `d`, none of them longer than `reach`.
    ///
    /// The way from the point along d passes the triangle if d·(A × B), d·(B × C) and d·(C × A)
    /// have the sign of d·N, and ends beyond its plane. Each of them is divided by what rounding
    /// may do to it.
    #[inline(always)]
    fn add<R: Packet>(&self, d: [R; 3], reach: f64, to: &mut Crossed<R>) {
        let Between { a, b, c, n, .. } = *self;
        let area = length(n);
        if area <= 0.0 {
            return;
        }
        let start = -dot(n, a);
        // The plane is that of the triangle as it is stored.
        let per_height = 1.0 / (area * reach * PRODUCTS * R::EPSILON + NOTHING);
        let [la, lb, lc] = [length(a), length(b), length(c)];
        // To the front it is crossed from behind only.
        let side = if start < 0.0 { 1.0 } else { -1.0 };
        let u = along(d, edge::<R>(a, b, la + lb, reach, side));
        let v = along(d, edge::<R>(b, c, lb + lc, reach, side));
        let w = along(d, edge::<R>(c, a, lc + la, reach, side));
        let within = u.min(v).min(w);
        if start.abs() * per_height <= 1.0 {
            // It begins in the plane: nothing is certain but that it passes aside.
            let other = -u.max(v).max(w);
            to.doubt = to.doubt.max(within.max(other) + 1.0);
            return;
        }
        let k = side * per_height;
        let beyond = along(d, [k * n[0], k * n[1], k * n[2]]) + k * start;
        let passed = within.min(beyond);
        to.doubt = to.doubt.max(-passed.abs() + 1.0);
        to.more = to.more + passed.select(passed.lift(-side), passed.lift(0.0));
    }
}

/// Across the plane of a point and a side, as long as it takes for ways up to `reach` to have
/// products of 1 where rounding may tell; `far` is how far both ends are.
#[inline(always)]
fn edge<R: Packet>(v: [f64; 3], w: [f64; 3], far: f64, reach: f64, side: f64) -> [f64; 3] {
    let across = cross(v, w);
    let k = side / (reach * (far * CORNERS + length(across) * PRODUCTS * R::EPSILON) + NOTHING);
    [k * across[0], k * across[1], k * across[2]]
}

#[inline(always)]
fn along<R: Real>(d: [R; 3], v: [f64; 3]) -> R {
    d[0].scale_add(v[0], d[1].scale_add(v[1], d[2] * v[2]))
}

#[inline(always)]
fn cross(v: [f64; 3], w: [f64; 3]) -> [f64; 3] {
    [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]]
}

#[inline(always)]
fn dot(v: [f64; 3], w: [f64; 3]) -> f64 {
    v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
}

#[inline(always)]
fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

#[inline(always)]
fn wide_of<E: Element>(p: [E; 3]) -> [f64; 3] {
    [p[0].to_f64(), p[1].to_f64(), p[2].to_f64()]
}
