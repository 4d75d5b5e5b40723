//! Winding numbers as a field that tells sides: positive where they are above one half.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rvachev_num::lanes::{F32, F64, Lanes};

use super::super::block::BLOCK;
use super::super::packet::Packet;
use super::crossings::Crossings;
use super::winding::{Stack, Winding};
use crate::kernel::{Element, on_level};
use crate::{AnyField, Bounds, Chunk, Dual, Interval, ParamError, Placement, Zone};
use rvachev_num::symbol::Symbol;

/// Points farther out than this, in units of the patches' frame, are moved there.
pub(super) const FARTHEST: f64 = 1e9;

impl Winding {
    /// A placement into the frame of the patches.
    fn local(&self, placement: &Placement) -> Placement {
        let frame = &self.patches.frame;
        let map = placement.map();
        let mut local = DAffine3::from_mat3(map.matrix3 * (1.0 / frame.unit));
        local.translation = frame.into_local(map.translation);
        Placement::new(&local, 1.0, 0.0)
    }

    /// How far above one half the numbers of a chunk are.
    fn sides<E: Element>(&self, points: [&[E]; 3], local: &Placement, out: &mut [E]) {
        for at in 0..out.len() {
            let p = local.apply([points[0][at], points[1][at], points[2][at]].map(E::to_f64));
            out[at] = E::from_f64(self.number_at(p.map(|x| x.clamp(-FARTHEST, FARTHEST))) - 0.5);
        }
    }
}

/// The same by packets of points, none of them nearer to the triangles than what is told of
/// `apart`.
#[inline(always)]
fn sides_on<L: Lanes<Element: Element> + Packet>(
    simd: L::Token,
    winding: &Winding,
    points: [&[L::Element]; 3],
    apart: &[L::Element],
    local: &Placement,
    out: &mut [L::Element],
) {
    if winding.is_closed() {
        let mut crossings = Crossings::new();
        let mut from = 0;
        while from < out.len() {
            let here = from..out.len().min(from + BLOCK);
            let points = [&points[0][here.clone()], &points[1][here.clone()], &points[2][here.clone()]];
            let apart = apart.get(here.clone()).unwrap_or_default();
            winding.sides_by_crossings::<L>(simd, points, apart, local, &mut crossings, &mut out[here]);
            from += BLOCK;
        }
        return;
    }
    let mut stack = Stack::default();
    let mut at = 0;
    while at < out.len() {
        let here = at..at + L::WIDTH;
        let p = placed::<L>(simd, points, local, here.clone());
        (winding.roughly(p, &mut stack) - 0.5).store(&mut out[here]);
        at += L::WIDTH;
    }
}

/// Points in the frame of the patches.
#[inline(always)]
pub(super) fn placed<L: Lanes<Element: Element>>(
    simd: L::Token,
    [x, y, z]: [&[L::Element]; 3],
    local: &Placement,
    here: std::ops::Range<usize>,
) -> [L; 3] {
    let p = [L::load(simd, &x[here.clone()]), L::load(simd, &y[here.clone()]), L::load(simd, &z[here])];
    let [x, y, z] = local.apply(p);
    let (low, high) = (x.lift(-FARTHEST), x.lift(FARTHEST));
    [x.max(low).min(high), y.max(low).min(high), z.max(low).min(high)]
}

/// Asks again, one by one, where the numbers leave the side in doubt.
fn settle<E: Element>(winding: &Winding, points: [&[E]; 3], local: &Placement, out: &mut [E]) {
    for at in 0..out.len() {
        if Winding::is_doubtful(out[at].to_f64() + 0.5) {
            let [x, y, z] = points.map(|column| &column[at..=at]);
            winding.sides([x, y, z], local, &mut out[at..=at]);
        }
    }
}

impl AnyField for Winding {
    fn name(&self) -> &'static str {
        "winding number"
    }

    fn signature(&self) -> String {
        format!("{self:?}, {:016x}", self.patches.hash)
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.patches.bounds().transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, _reach: f64) -> f64 {
        0.0
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let local = self.patches.frame.into_local(DVec3::from_array(p));
        let local = local.to_array().map(|x| x.clamp(-FARTHEST, FARTHEST));
        self.whole_at(local, &mut Stack::default()).unwrap_or_else(|| self.number_at(local)) - 0.5
    }

    /// Constant but at the triangles, if these are closed.
    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        Dual::new(self.value(p.map(Dual::value)), [0.0; 3])
    }

    fn dual_range(&self, _p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Dual::new(Interval::ALL, [Interval::ALL; 3])
    }

    fn exact(&self) -> bool {
        false
    }

    fn convex(&self) -> bool {
        false
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn range(&self, _zone: &Zone) -> Interval {
        Interval::ALL
    }

    fn rises(&self, _zone: &Zone, _ways: &[crate::Way]) -> u8 {
        0
    }

    fn narrowed(&self, _zone: &Zone) -> Option<Arc<dyn AnyField>> {
        None
    }

    /// What is searched for fits no tree, and is not asked for one.
    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        p[0]
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let local = &self.local(placement);
        self.lanes32_roughly(points, &[], local, out);
        settle(self, points, local, out);
    }

    /// For who asks for sides where these make a difference only: 0 where they are in doubt.
    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, _band: f64) {
        self.sides32(chunk, &[]);
    }

    fn sides32(&self, chunk: Chunk<'_, f32, 1>, apart: &[f32]) {
        let Chunk { points, placement, out: [out] } = chunk;
        self.lanes32_roughly(points, apart, &self.local(placement), out);
        for above in out.iter_mut().filter(|above| Winding::is_doubtful(f64::from(**above) + 0.5)) {
            *above = 0.0;
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let local = &self.local(placement);
        self.lanes64_roughly(points, local, out);
        settle(self, points, local, out);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out: [value, rest @ ..] } = chunk;
        self.lanes32(Chunk { points, placement, out: [value] });
        rest.into_iter().for_each(|column| column.fill(0.0));
    }

    fn cost(&self) -> usize {
        8
    }
}

impl Winding {
    fn lanes32_roughly(&self, points: [&[f32]; 3], apart: &[f32], local: &Placement, out: &mut [f32]) {
        on_level!(
            simd => sides_on::<F32<_>>(simd, self, points, apart, local, out),
            else self.sides(points, local, out)
        );
    }

    fn lanes64_roughly(&self, points: [&[f64]; 3], local: &Placement, out: &mut [f64]) {
        on_level!(simd => sides_on::<F64<_>>(simd, self, points, &[], local, out), else self.sides(points, local, out))
    }
}

impl fmt::Debug for Winding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "winding number of {} triangles", self.patches.len())
    }
}
