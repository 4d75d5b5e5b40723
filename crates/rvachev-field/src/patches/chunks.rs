//! Distances of whole chunks of points: packets on SIMD lanes.

use std::ops;

use rvachev_num::lanes::{F32, F64, Lanes, Twice};

use super::SurfaceDistance;
use super::block::{BLOCK, Block};
use super::closest::dot;
use super::packet::Packet;
use super::packets::{Close, Packets, Seeds};
use super::pairs::Pairs;
use super::room::{Room, Roomy};
use super::search::{Entries, Nearest, Stack};
use crate::kernel::{Element, distinct, on_level, repeat};
use crate::{Chunk, Placement};

/// What is left of a distance, in units of the frame, that points are certain to be apart.
const CLEARLY: f32 = 1.0 - 1e-4;
const CLEAR: f32 = 1e-5;

impl SurfaceDistance {
    /// Values on lanes of `f32`.
    pub(super) fn values32(&self, chunk: Chunk<'_, f32, 1>, band: f64) {
        let Chunk { points, placement, out: [out] } = chunk;
        let packets = self.packets(placement, band);
        // How far points are tells how far their signs hold, but where these tell what is searched
        // for.
        let are_last = band == f64::INFINITY && self.side.is_none();
        if !are_last {
            self.signs32(points, placement, out);
        }
        let tell = |here: ops::Range<usize>, squares: &[f32], signs: &mut [f32]| {
            if are_last {
                self.sides32(points.map(|column| &column[here.clone()]), placement, squares, signs);
            }
        };
        on_level!(
            simd => values_on::<Twice<F32<_>>>(simd, &packets, points, out, tell),
            else values_by_point(&packets, points, out, tell)
        );
    }

    /// Numbers with the signs of points, given the squares of their distances in units of the
    /// frame.
    fn sides32(&self, points: [&[f32]; 3], placement: &Placement, squares: &[f32], out: &mut [f32]) {
        // Half of it, as that of a surface at the end of what is finite is not finite itself.
        let (half_unit, error) = ((0.5 * self.patches.unit()) as f32, self.error() as f32);
        let mut apart = [0.0; BLOCK];
        for (to, square) in apart.iter_mut().zip(squares) {
            let half = half_unit * (square.sqrt() * CLEARLY - CLEAR);
            *to = (half + half).min(f32::MAX) - error;
        }
        let placement = &unscaled(placement);
        self.sign.sides32(Chunk { points, placement, out: [out] }, &apart[..squares.len()]);
    }

    /// The same on lanes of `f64`.
    pub(super) fn values64(&self, chunk: Chunk<'_, f64, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        match self.side {
            Some(side) => out.fill(side),
            None => self.sign.lanes64(Chunk { points, placement: &unscaled(placement), out: [&mut *out] }),
        }
        let packets = self.packets(placement, f64::INFINITY);
        on_level!(
            simd => values_on::<F64<_>>(simd, &packets, points, out, |_, _, _| {}),
            else values_by_point(&packets, points, out, |_, _, _| {})
        );
    }

    /// Values and gradients.
    pub(super) fn slopes(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, mut out } = chunk;
        self.signs32(points, placement, out[0]);
        let packets = self.packets(placement, f64::INFINITY);
        on_level!(
            simd => slopes_on::<Twice<F32<_>>>(simd, &packets, points, &mut out),
            else slopes_by_point(&packets, points, &mut out)
        );
    }

    /// Numbers with the signs.
    fn signs32(&self, points: [&[f32]; 3], placement: &Placement, out: &mut [f32]) {
        let unscaled = unscaled(placement);
        match self.side {
            Some(side) => out.fill(side as f32),
            None => self.sign.lanes32_within(Chunk { points, placement: &unscaled, out: [&mut *out] }, 0.0),
        }
    }
}

/// Signs where the sign field has none and they make a difference, given the squares of the
/// distances of points from `from` on.
#[inline(never)]
fn take_sides<E: Element>(packets: &Packets<'_>, [x, y, z]: [&[E]; 3], squares: &[E], signs: &mut [E], from: usize) {
    for (i, sign) in signs.iter_mut().enumerate() {
        if sign.to_f64() == 0.0 && packets.has_side(squares[i].to_f64()) {
            *sign = E::from_f64(packets.side([x, y, z].map(|axis| axis[from + i].to_f64())));
        }
    }
}

/// The same place, the value as it is.
fn unscaled(placement: &Placement) -> Placement {
    let mut unscaled = *placement;
    (unscaled.scale, unscaled.shift) = (1.0, 0.0);
    unscaled
}

/// Loads a vector of each column.
#[inline(always)]
fn load<L: Lanes>(simd: L::Token, [x, y, z]: [&[L::Element]; 3], here: ops::Range<usize>) -> [L; 3] {
    [L::load(simd, &x[here.clone()]), L::load(simd, &y[here.clone()]), L::load(simd, &z[here])]
}

/// Fills a block with points of the surface's frame, sorted, and says which patch its middle is
/// near, and where searches are to begin.
#[inline(always)]
fn fill<L: Lanes<Element: Element>>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[L::Element]; 3],
    signs: &[L::Element],
    here: ops::Range<usize>,
    block: &mut Block<L::Element>,
) -> (u32, Entries) {
    block.numbers[..here.len()].copy_from_slice(&signs[here.clone()]);
    let mut at = 0;
    while at < here.len() {
        let from = here.start + at;
        let [x, y, z] = packets.local(load::<L>(simd, points, from..from + L::WIDTH));
        x.store(&mut block.columns[0][at..at + L::WIDTH]);
        y.store(&mut block.columns[1][at..at + L::WIDTH]);
        z.store(&mut block.columns[2][at..at + L::WIDTH]);
        at += L::WIDTH;
    }
    let (low, high) = block.bounds(here.len());
    let near = packets.patches.near([0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis])));
    block.sort(here.len(), packets.patches.steepest(near.which as u32));
    (near.which as u32, packets.patches.entries(low, high, near.square.sqrt()))
}

/// What a loop over blocks needs besides points and results.
struct Work<L: Lanes> {
    stack: Stack<L>,
    seeds: Seeds,
    pairs: Pairs<L>,
    room: Box<Room<L::Element>>,
}

impl<L: Lanes<Element: Roomy> + Packet> Work<L> {
    #[inline(always)]
    fn new() -> Work<L> {
        Work { stack: Stack::new(), seeds: Seeds::default(), pairs: Pairs::new(), room: Room::take() }
    }

    /// Finds how far the points of a block are, where in the chunk `here` is; and if `ways` are
    /// wanted, from where.
    #[inline(always)]
    fn find(
        &mut self,
        simd: L::Token,
        packets: &Packets<'_>,
        points: [&[L::Element]; 3],
        signs: &[L::Element],
        here: ops::Range<usize>,
        ways: bool,
    ) {
        let patches = packets.patches;
        let is_flat = patches.quadratics.is_empty();
        let len = here.len();
        let Room { block, found } = &mut *self.room;
        let (near, entries) = fill::<L>(simd, packets, points, signs, here, block);
        self.seeds.start(near);
        let mut at = 0;
        while at < len {
            let here = at..at + L::WIDTH;
            let [x, y, z] = &block.columns;
            let p = load::<L>(simd, [x, y, z], here.clone());
            self.pairs.first = at as u32;
            let range = packets.range(L::load(simd, &block.numbers[here.clone()]));
            let Nearest { all: best, flat } =
                patches.search(p, entries.all(), self.seeds.known(), range, &mut self.stack, &mut self.pairs);
            self.seeds.take(best.which);
            for (to, which) in found.patches[here.clone()].iter_mut().zip(flat.which.all().0) {
                *to = which as u32;
            }
            // What is not told apart has a bound of its distance.
            let to_high = (best.square - range.high).select(best.square, flat.square);
            let square = (best.square - range.low).select(to_high, best.square);
            square.store(&mut found.squares[here.clone()]);
            if !is_flat {
                for (to, which) in found.likely[here.clone()].iter_mut().zip(best.which.all().0) {
                    *to = which as u32;
                }
                let (near, told) = (best.square.below(range.low), best.square.below(range.high));
                for lane in 0..L::WIDTH {
                    found.is_near[at + lane] = near >> lane & 1 == 1;
                    found.is_far[at + lane] = told >> lane & 1 == 0;
                }
            }
            if ways {
                let way = packets.ways(p, flat.which);
                way[0].store(&mut found.ways[0][here.clone()]);
                way[1].store(&mut found.ways[1][here.clone()]);
                way[2].store(&mut found.ways[2][here]);
            }
            at += L::WIDTH;
        }
        if !is_flat {
            self.pairs.settle(simd, patches, block, found, len);
        }
    }
}

/// Values, block by block; `out` holds the signs before, or `tell` puts them there: of points in a
/// place, given the squares of their distances.
#[inline(always)]
fn values_on<L: Lanes<Element: Roomy> + Packet>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[L::Element]; 3],
    out: &mut [L::Element],
    tell: impl Fn(ops::Range<usize>, &[L::Element], &mut [L::Element]),
) {
    let mut work = Work::<L>::new();
    let mut squares = [L::Element::default(); BLOCK];
    let mut from = 0;
    while from < out.len() {
        let len = BLOCK.min(out.len() - from);
        let own = L::WIDTH * distinct(points.map(|axis| &axis[from..from + len])).div_ceil(L::WIDTH);
        work.find(simd, packets, points, out, from..from + own, false);
        work.room.block.unsorted(&work.room.found.squares, &mut squares[..own]);
        repeat(&mut squares[..len], own);
        tell(from..from + len, &squares[..len], &mut out[from..from + len]);
        take_sides(packets, points, &squares, &mut out[from..from + len], from);
        let mut at = 0;
        while at < len {
            let out = &mut out[from + at..from + at + L::WIDTH];
            let square = L::load(simd, &squares[at..at + L::WIDTH]);
            packets.value(square, L::load(simd, out)).store(out);
            at += L::WIDTH;
        }
        from += len;
    }
    work.room.give();
}

/// The same of machines without lanes.
#[cold]
#[inline(never)]
fn values_by_point<E: Element>(
    packets: &Packets<'_>,
    [x, y, z]: [&[E]; 3],
    out: &mut [E],
    tell: impl Fn(ops::Range<usize>, &[E], &mut [E]),
) {
    let mut squares = [E::default(); BLOCK];
    let mut from = 0;
    while from < out.len() {
        let here = from..out.len().min(from + BLOCK);
        let squares = &mut squares[..here.len()];
        for (at, square) in here.clone().zip(&mut *squares) {
            let local = packets.local([x[at], y[at], z[at]].map(E::to_f64));
            *square = E::from_f64(packets.patches.search_one(local).square);
        }
        tell(here.clone(), squares, &mut out[here.clone()]);
        take_sides(packets, [x, y, z], squares, &mut out[here.clone()], from);
        for (out, square) in out[here].iter_mut().zip(squares) {
            *out = E::from_f64(packets.value(square.to_f64(), out.to_f64()));
        }
        from += BLOCK;
    }
}

/// Values and gradients, block by block; the first of `out` holds the signs before.
#[inline(always)]
fn slopes_on<L: Lanes<Element = f32> + Packet>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[f32]; 3],
    out: &mut [&mut [f32]; 4],
) {
    let mut work = Work::<L>::new();
    let mut ways = [[0.0; BLOCK]; 3];
    let mut squares = [0.0; BLOCK];
    let mut patches = [0; BLOCK];
    let mut close = Vec::new();
    let mut from = 0;
    while from < out[0].len() {
        let len = BLOCK.min(out[0].len() - from);
        let own = L::WIDTH * distinct(points.map(|axis| &axis[from..from + len])).div_ceil(L::WIDTH);
        work.find(simd, packets, points, &*out[0], from..from + own, true);
        for (way, sorted) in ways.iter_mut().zip(&work.room.found.ways) {
            work.room.block.unsorted(sorted, &mut way[..own]);
            repeat(&mut way[..len], own);
        }
        work.room.block.unsorted(&work.room.found.patches, &mut patches[..own]);
        repeat(&mut patches[..len], own);
        for (i, square) in squares[..len].iter_mut().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|axis| ways[axis][i]);
            *square = x * x + y * y + z * z;
        }
        take_sides(packets, points, &squares, &mut out[0][from..from + len], from);
        let mut at = 0;
        while at < len {
            let to = from + at..from + at + L::WIDTH;
            let way = load::<L>(simd, ways.each_ref().map(|way| &way[..]), at..at + L::WIDTH);
            let square = dot(way, way);
            let sign = L::load(simd, &out[0][to.clone()]);
            packets.value(square, sign).store(&mut out[0][to.clone()]);
            let slope = packets.slope(way, square, sign);
            slope[0].store(&mut out[1][to.clone()]);
            slope[1].store(&mut out[2][to.clone()]);
            slope[2].store(&mut out[3][to.clone()]);
            if packets.are_close(square) {
                let (squares, signs) = (square.all().0, sign.all().0);
                let here = (0..L::WIDTH).filter(|i| packets.is_close(squares[*i]));
                close.extend(here.map(|i| (to.start + i, patches[at + i], signs[i])));
            }
            at += L::WIDTH;
        }
        if !close.is_empty() {
            refine(packets, &close, points, out);
            close.clear();
        }
        from += len;
    }
    work.room.give();
}

/// Computes what is close to the surface again, in double precision: places in the chunk, nearest
/// patches and signs.
#[inline(never)]
fn refine(packets: &Packets<'_>, close: &[(usize, u32, f32)], points: [&[f32]; 3], out: &mut [&mut [f32]; 4]) {
    let asked = |&(at, patch, sign): &(usize, u32, f32)| Close { p: points.map(|axis| axis[at]), patch, sign };
    let jets = packets.close(&close.iter().map(asked).collect::<Vec<Close>>());
    for ((at, ..), jet) in close.iter().zip(jets) {
        for (column, part) in out.iter_mut().zip(jet) {
            column[*at] = part;
        }
    }
}

/// The same of machines without lanes.
#[cold]
#[inline(never)]
fn slopes_by_point(packets: &Packets<'_>, [x, y, z]: [&[f32]; 3], out: &mut [&mut [f32]; 4]) {
    for at in 0..x.len() {
        let p = [x[at], y[at], z[at]];
        let best = packets.patches.search_one(packets.local(p.map(f64::from)));
        take_sides(packets, [x, y, z], &[best.square as f32], &mut out[0][at..=at], at);
        let close = (at, best.which as u32, out[0][at]);
        refine(packets, &[close], [x, y, z], out);
    }
}
