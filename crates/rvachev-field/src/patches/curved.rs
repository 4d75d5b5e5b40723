//! The nearest point of a curved patch, by Newton's method from the foot on its triangle.
//!
//! ```text
//!     minimise ½ |r − P(s, t)|²:   gradient −(R·Pₛ, R·Pₜ),   Hessian  Pᵢ·Pⱼ − R·Pᵢⱼ,   R = r − P
//! ```
//!
//! Where the Hessian is not positive (the point is beyond the centre of curvature) its second
//! term is left out, which leaves the Gauss-Newton method. If the steps end outside of the
//! triangle, the nearest point is on one of the sides that they crossed: Newton's method along
//! these. Whatever the steps do, what they end at is a point of the patch, and nothing is taken
//! that is farther than the point they start from.

use rvachev_num::Real;

use super::closest::{Closest, Flat, dot, dot_stored, minus, plus, within};
use super::face::{Bulge, Sides};
use super::packet::Packet;

/// Each step squares the error, which is some hundredths of the patch at the start: two or three
/// are enough but for patches that are bent by as much as their size.
const STEPS: usize = 10;

/// No step is longer than this, in coordinates.
const STRIDE: f64 = 0.5;

/// A patch about one point: its coefficients, and where the point is from corner 0.
struct Around<R> {
    e: [f64; 3],
    f: [f64; 3],
    c: [f64; 3],
    d: [f64; 3],
    mixed: [f64; 3],
    r: [R; 3],
    /// Negative where no better than a point of the patch is wanted.
    wanted: R,
}

/// The nearest point of a patch, given that of its triangle. Where `wanted` is negative it may be
/// any point of the patch.
#[inline(always)]
pub(super) fn on_patch<R: Packet>(sides: &Sides, bulge: &Bulge, flat: &Flat<R>, wanted: R) -> Closest<R> {
    let [e, f] = [sides.e.map(f64::from), sides.f.map(f64::from)];
    let [c, d, mixed] = [bulge.c.map(f64::from), bulge.d.map(f64::from), bulge.e.map(f64::from)];
    let around = Around { e, f, c, d, mixed, r: flat.from_corner, wanted };
    let start = flat.closest.coordinates;
    let mut best = around.at(start);
    let [s, t] = around.descend(start);
    let zero = s.lift(0.0);
    let one = s.lift(1.0);
    let lowest = s.min(t).min(-(s + t) + 1.0);
    let inner = around.at([lowest.select(s, start[0]), lowest.select(t, start[1])]);
    best = best.nearer(inner);
    let outside = [wanted.select(t, one), wanted.select(s, one), wanted.select(-(s + t) + 1.0, one)];
    if outside[0].any_below(zero) {
        let q = around.along(flat.sides[0], around.r, e, c, outside[0]);
        best = outside[0].choose_nearer(best, around.at([q, zero]));
    }
    if outside[1].any_below(zero) {
        let q = around.along(flat.sides[2], around.r, f, d, outside[1]);
        best = outside[1].choose_nearer(best, around.at([zero, q]));
    }
    if outside[2].any_below(zero) {
        let chord = sum(f, e, -1.0);
        let bend = sum(sum(c, d, 1.0), mixed, 1.0);
        let q = around.along(flat.sides[1], minus(around.r, one, e), chord, bend, outside[2]);
        best = outside[2].choose_nearer(best, around.at([-q + 1.0, q]));
    }
    best
}

/// Takes what lies on a side only where that side was crossed.
trait Crossed: Real {
    #[inline(always)]
    fn choose_nearer(self, best: Closest<Self>, side: Closest<Self>) -> Closest<Self> {
        best.select(self, best.nearer(side))
    }
}

impl<R: Real> Crossed for R {}

#[inline(always)]
fn sum(v: [f64; 3], w: [f64; 3], k: f64) -> [f64; 3] {
    [v[0] + k * w[0], v[1] + k * w[1], v[2] + k * w[2]]
}

impl<R: Packet> Around<R> {
    /// The point of the patch at coordinates.
    #[inline(always)]
    fn at(&self, [s, t]: [R; 2]) -> Closest<R> {
        Closest::new(self.remainder(s, t), [s, t])
    }

    /// From the point of the patch at coordinates to the one asked about.
    #[inline(always)]
    fn remainder(&self, s: R, t: R) -> [R; 3] {
        let flat = minus(minus(self.r, s, self.e), t, self.f);
        let bent = minus(minus(flat, s * (-s + 1.0), self.c), t * (-t + 1.0), self.d);
        minus(bent, s * t, self.mixed)
    }

    /// Newton's steps, which may end outside of the triangle.
    #[inline(always)]
    fn descend(&self, [mut s, mut t]: [R; 2]) -> [R; 2] {
        let still = s.lift(-R::STILL);
        let mut moving = self.wanted;
        let mut step = 0;
        while step < STEPS {
            let from = self.remainder(s, t);
            let (ks, kt) = (-(s + s) + 1.0, -(t + t) + 1.0);
            let along_s = self.tangent(self.e, ks, self.c, t);
            let along_t = self.tangent(self.f, kt, self.d, s);
            let (gs, gt) = (dot(from, along_s), dot(from, along_t));
            let [ss, st, tt] = [dot(along_s, along_s), dot(along_s, along_t), dot(along_t, along_t)];
            let (bend_s, bend_t) = (dot_stored(from, self.c), dot_stored(from, self.d));
            let full = [ss + bend_s + bend_s, st - dot_stored(from, self.mixed), tt + bend_t + bend_t];
            let least = ss * tt * 1e-3;
            let det = full[0] * full[2] - full[1] * full[1];
            let key = (det - least).min(full[0]);
            let [hss, hst, htt] = [key.select(full[0], ss), key.select(full[1], st), key.select(full[2], tt)];
            let det = (hss * htt - hst * hst).max(least).max(least.lift(1e-30));
            let per_det = det.lift(1.0) / det;
            let by_s = cut((htt * gs - hst * gt) * per_det);
            let by_t = cut((hss * gt - hst * gs) * per_det);
            s = moving.select(s + by_s, s);
            t = moving.select(t + by_t, t);
            moving = moving.min(by_s.abs().max(by_t.abs()) + still);
            step += 1;
            if !s.lift(0.0).any_below(moving) {
                break;
            }
        }
        [s, t]
    }

    /// `side + k bulge + other E`.
    #[inline(always)]
    fn tangent(&self, side: [f64; 3], k: R, bulge: [f64; 3], other: R) -> [R; 3] {
        let plain = plus(lifted(k, side), other, self.mixed);
        plus(plain, k, bulge)
    }

    /// The nearest point of the side `q chord + q (1 − q) bend`, from a start, where `outside` is
    /// negative.
    #[inline(always)]
    fn along(&self, start: R, r: [R; 3], chord: [f64; 3], bend: [f64; 3], outside: R) -> R {
        let mut q = start;
        let still = q.lift(-R::STILL);
        let mut moving = outside.select(q.lift(-1.0), q.lift(1.0));
        let mut step = 0;
        while step < STEPS {
            let from = minus(minus(r, q, chord), q * (-q + 1.0), bend);
            let k = -(q + q) + 1.0;
            let tangent = plus(lifted(k, chord), k, bend);
            let square = dot(tangent, tangent);
            let bent = dot_stored(from, bend);
            let full = square + bent + bent;
            let curvature = (full - square * 1e-2).select(full, square).max(square.lift(1e-30));
            let next = within(q + cut(dot(from, tangent) / curvature));
            let by = (next - q).abs();
            q = moving.select(next, q);
            moving = moving.min(by + still);
            step += 1;
            if !q.lift(0.0).any_below(moving) {
                break;
            }
        }
        q
    }
}

/// A stored vector as a packet's, `like` any number of it.
#[inline(always)]
fn lifted<R: Real>(like: R, v: [f64; 3]) -> [R; 3] {
    [like.lift(v[0]), like.lift(v[1]), like.lift(v[2])]
}

/// A step, cut to the longest.
#[inline(always)]
fn cut<R: Real>(by: R) -> R {
    by.max(by.lift(-STRIDE)).min(by.lift(STRIDE))
}
