//! Distances of whole chunks of points: packets on SIMD lanes.

use std::ops::Range;

use fearless_simd::{Level, Simd};
use rvachev_num::lanes::{F32, F64, Lanes};

use super::SurfaceDistance;
use super::block::{BLOCK, Block};
use super::closest::dot;
use super::packet::{Packet, WIDEST};
use super::packets::{Packets, Seeds};
use super::search::Stack;
use crate::kernel::{Element, on_level};
use crate::{Chunk, Placement};

impl SurfaceDistance {
    /// Values on lanes of `f32`.
    pub(super) fn values32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        self.sign.lanes32(Chunk { points, placement: &unscaled(placement), out: [&mut *out] });
        let packets = self.packets(placement);
        on_level!(simd => values_on::<F32<_>>(simd, &packets, points, out), else values_by_point(&packets, points, out))
    }

    /// The same on lanes of `f64`.
    pub(super) fn values64(&self, chunk: Chunk<'_, f64, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        self.sign.lanes64(Chunk { points, placement: &unscaled(placement), out: [&mut *out] });
        let packets = self.packets(placement);
        on_level!(simd => values_on::<F64<_>>(simd, &packets, points, out), else values_by_point(&packets, points, out))
    }

    /// Values and gradients.
    pub(super) fn slopes(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, mut out } = chunk;
        self.sign.lanes32(Chunk { points, placement: &unscaled(placement), out: [&mut *out[0]] });
        let packets = self.packets(placement);
        on_level!(
            simd => slopes_on::<F32<_>>(simd, &packets, points, &mut out),
            else slopes_by_point(&packets, points, &mut out)
        );
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
fn load<L: Lanes>(simd: L::Token, [x, y, z]: [&[L::Element]; 3], here: Range<usize>) -> [L; 3] {
    [L::load(simd, &x[here.clone()]), L::load(simd, &y[here.clone()]), L::load(simd, &z[here])]
}

/// Fills a block with points of the surface's frame, sorted.
#[inline(always)]
fn fill<L: Lanes<Element: Element>>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[L::Element]; 3],
    from: usize,
    len: usize,
    block: &mut Block<L::Element>,
) {
    let mut at = 0;
    while at < len {
        let [x, y, z] = packets.local(load::<L>(simd, points, from + at..from + at + L::WIDTH));
        x.store(&mut block.columns[0][at..at + L::WIDTH]);
        y.store(&mut block.columns[1][at..at + L::WIDTH]);
        z.store(&mut block.columns[2][at..at + L::WIDTH]);
        at += L::WIDTH;
    }
    block.sort(len);
}

/// Values, packet by packet; `out` holds the signs before.
#[inline(always)]
fn values_on<L: Lanes<Element: Element> + Packet>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[L::Element]; 3],
    out: &mut [L::Element],
) {
    let mut stack = Stack::new(L::splat(simd, 0.0));
    let mut seeds = Seeds::default();
    let mut block = Block::new();
    let mut squares = [L::Element::default(); BLOCK];
    let mut from = 0;
    while from < out.len() {
        let len = BLOCK.min(out.len() - from);
        fill::<L>(simd, packets, points, from, len, &mut block);
        let mut at = 0;
        while at < len {
            let here = at..at + L::WIDTH;
            let [x, y, z, _] = &block.columns;
            let best = packets.search(load::<L>(simd, [x, y, z], here.clone()), &mut seeds, &mut stack);
            best.square.store(&mut block.columns[0][here]);
            at += L::WIDTH;
        }
        block.unsorted(0, &mut squares[..len]);
        let mut at = 0;
        while at < len {
            let out = &mut out[from + at..from + at + L::WIDTH];
            let square = L::load(simd, &squares[at..at + L::WIDTH]);
            packets.value(square, L::load(simd, out)).store(out);
            at += L::WIDTH;
        }
        from += len;
    }
}

/// The same of machines without lanes.
#[cold]
#[inline(never)]
fn values_by_point<E: Element>(packets: &Packets<'_>, [x, y, z]: [&[E]; 3], out: &mut [E]) {
    let mut stack = Stack::new(0.0);
    let mut seeds = Seeds::default();
    for at in 0..out.len() {
        let local = packets.local([x[at], y[at], z[at]].map(E::to_f64));
        let best = packets.search(local, &mut seeds, &mut stack);
        out[at] = E::from_f64(packets.value(best.square, out[at].to_f64()));
    }
}

/// Values and gradients, packet by packet; the first of `out` holds the signs before.
#[inline(always)]
fn slopes_on<L: Lanes<Element = f32> + Packet>(
    simd: L::Token,
    packets: &Packets<'_>,
    points: [&[f32]; 3],
    out: &mut [&mut [f32]; 4],
) {
    let mut stack = Stack::new(L::splat(simd, 0.0));
    let mut seeds = Seeds::default();
    let mut block = Block::new();
    let mut from = 0;
    while from < out[0].len() {
        let len = BLOCK.min(out[0].len() - from);
        fill::<L>(simd, packets, points, from, len, &mut block);
        let mut at = 0;
        while at < len {
            let here = at..at + L::WIDTH;
            let [x, y, z, _] = &block.columns;
            let p = load::<L>(simd, [x, y, z], here.clone());
            let best = packets.search(p, &mut seeds, &mut stack);
            let way = packets.ways(p, &best);
            way[0].store(&mut block.columns[0][here.clone()]);
            way[1].store(&mut block.columns[1][here.clone()]);
            way[2].store(&mut block.columns[2][here.clone()]);
            best.which.store(&mut block.columns[3][here]);
            at += L::WIDTH;
        }
        let mut found = [[0.0; BLOCK]; 4];
        block.unsorted(0, &mut found[0][..len]);
        block.unsorted(1, &mut found[1][..len]);
        block.unsorted(2, &mut found[2][..len]);
        block.unsorted(3, &mut found[3][..len]);
        let mut at = 0;
        while at < len {
            let to = from + at..from + at + L::WIDTH;
            let [x, y, z, which] = &found;
            let way = load::<L>(simd, [x, y, z], at..at + L::WIDTH);
            let square = dot(way, way);
            let sign = L::load(simd, &out[0][to.clone()]);
            packets.value(square, sign).store(&mut out[0][to.clone()]);
            let slope = packets.slope(way, square, sign);
            slope[0].store(&mut out[1][to.clone()]);
            slope[1].store(&mut out[2][to.clone()]);
            slope[2].store(&mut out[3][to.clone()]);
            if Packets::are_close(square) {
                let mut parts = [[0.0; WIDEST]; 2];
                square.store(&mut parts[0][..L::WIDTH]);
                sign.store(&mut parts[1][..L::WIDTH]);
                refine(packets, &parts, &which[at..at + L::WIDTH], points, out, to.start);
            }
            at += L::WIDTH;
        }
        from += len;
    }
}

/// Computes what is close to the surface again, in double precision: the squares of the distances,
/// the signs and the patches of a packet that starts at `at`.
#[inline(never)]
fn refine(
    packets: &Packets<'_>,
    [squares, signs]: &[[f32; WIDEST]; 2],
    patches: &[f32],
    [x, y, z]: [&[f32]; 3],
    out: &mut [&mut [f32]; 4],
    at: usize,
) {
    for (i, patch) in patches.iter().enumerate() {
        if Packets::is_close(squares[i]) {
            let jet = packets.one([x[at + i], y[at + i], z[at + i]], *patch, signs[i]);
            for (column, part) in out.iter_mut().zip(jet) {
                column[at + i] = part;
            }
        }
    }
}

/// The same of machines without lanes.
#[cold]
#[inline(never)]
fn slopes_by_point(packets: &Packets<'_>, [x, y, z]: [&[f32]; 3], out: &mut [&mut [f32]; 4]) {
    let mut stack = Stack::new(0.0);
    let mut seeds = Seeds::default();
    for at in 0..x.len() {
        let p = [x[at], y[at], z[at]];
        let best = packets.search(packets.local(p.map(f64::from)), &mut seeds, &mut stack);
        let jet = packets.one(p, best.which as f32, out[0][at]);
        for (column, part) in out.iter_mut().zip(jet) {
            column[at] = part;
        }
    }
}
