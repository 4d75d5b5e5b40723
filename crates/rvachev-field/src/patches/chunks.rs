//! Distances of whole chunks of points: packets on SIMD lanes.

use fearless_simd::{Level, Simd};
use rvachev_num::lanes::{F32, F64, Lanes};

use super::SurfaceDistance;
use super::packet::Packet;
use super::packets::{Packets, Seeds};
use super::search::Stack;
use crate::kernel::{Element, on_level};
use crate::{Chunk, Placement};

/// The most points of a packet of `f32`.
const WIDEST: usize = 16;

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

/// Values, packet by packet; `out` holds the signs before.
#[inline(always)]
fn values_on<L: Lanes + Packet>(
    simd: L::Token,
    packets: &Packets<'_>,
    [x, y, z]: [&[L::Element]; 3],
    out: &mut [L::Element],
) {
    let mut stack = Stack::new(L::splat(simd, 0.0));
    let mut seeds = Seeds::default();
    let mut at = 0;
    while at + L::WIDTH <= out.len() {
        let here = at..at + L::WIDTH;
        let p = [L::load(simd, &x[here.clone()]), L::load(simd, &y[here.clone()]), L::load(simd, &z[here.clone()])];
        let best = packets.search(p, &mut seeds, &mut stack);
        let sign = L::load(simd, &out[here.clone()]);
        packets.value(&best, sign).store(&mut out[here]);
        at += L::WIDTH;
    }
}

/// The same of machines without lanes.
#[cold]
#[inline(never)]
fn values_by_point<E: Element>(packets: &Packets<'_>, [x, y, z]: [&[E]; 3], out: &mut [E]) {
    let mut stack = Stack::new(0.0);
    let mut seeds = Seeds::default();
    for at in 0..out.len() {
        let best = packets.search([x[at], y[at], z[at]].map(E::to_f64), &mut seeds, &mut stack);
        out[at] = E::from_f64(packets.value(&best, out[at].to_f64()));
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
    let [x, y, z] = points;
    let mut stack = Stack::new(L::splat(simd, 0.0));
    let mut seeds = Seeds::default();
    let mut at = 0;
    while at + L::WIDTH <= out[0].len() {
        let here = at..at + L::WIDTH;
        let p = [L::load(simd, &x[here.clone()]), L::load(simd, &y[here.clone()]), L::load(simd, &z[here.clone()])];
        let best = packets.search(p, &mut seeds, &mut stack);
        let sign = L::load(simd, &out[0][here.clone()]);
        let slope = packets.slope(&best, sign);
        packets.value(&best, sign).store(&mut out[0][here.clone()]);
        slope[0].store(&mut out[1][here.clone()]);
        slope[1].store(&mut out[2][here.clone()]);
        slope[2].store(&mut out[3][here]);
        if packets.are_close(&best) {
            let mut parts = [[0.0; WIDEST]; 3];
            best.square.store(&mut parts[0][..L::WIDTH]);
            best.which.store(&mut parts[1][..L::WIDTH]);
            sign.store(&mut parts[2][..L::WIDTH]);
            refine(packets, &parts, points.map(|column| &column[at..at + L::WIDTH]), out, at);
        }
        at += L::WIDTH;
    }
}

/// Computes what is close to the surface again, in double precision. `parts` are the squares of
/// the distances, the patches and the signs of a packet.
#[inline(never)]
fn refine(
    packets: &Packets<'_>,
    [squares, patches, signs]: &[[f32; WIDEST]; 3],
    [x, y, z]: [&[f32]; 3],
    out: &mut [&mut [f32]; 4],
    at: usize,
) {
    for i in 0..x.len() {
        if Packets::is_close(squares[i]) {
            let jet = packets.one([x[i], y[i], z[i]], patches[i], signs[i]);
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
        let best = packets.search(p.map(f64::from), &mut seeds, &mut stack);
        let jet = packets.one(p, best.which as f32, out[0][at]);
        for (column, part) in out.iter_mut().zip(jet) {
            column[at] = part;
        }
    }
}
