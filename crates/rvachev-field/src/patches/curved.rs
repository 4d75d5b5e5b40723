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

use super::closest::{Closest, dot, on_face, plus, within};
use super::packet::Packet;

/// Each step squares the error, which is some hundredths of the patch at the start: two or three
/// are enough but for patches that are bent by as much as their size.
const STEPS: usize = 10;

/// No step is longer than this, in coordinates.
const STRIDE: f64 = 0.5;

/// A patch as a polynomial, seen from a point.
pub(super) struct Around<R> {
    /// From corner 0 to the point.
    pub(super) r: [R; 3],
    pub(super) e: [R; 3],
    pub(super) f: [R; 3],
    pub(super) c: [R; 3],
    pub(super) d: [R; 3],
    pub(super) mixed: [R; 3],
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
fn sum<R: Real>(v: [R; 3], w: [R; 3]) -> [R; 3] {
    [v[0] + w[0], v[1] + w[1], v[2] + w[2]]
}

impl<R: Packet> Around<R> {
    /// The nearest point of the patch.
    #[inline(always)]
    pub(super) fn closest(&self) -> Closest<R> {
        let flat = on_face([self.e, self.f], self.r);
        let start = flat.closest.coordinates;
        let mut best = self.at(start);
        let [s, t] = self.descend(start);
        let zero = s.lift(0.0);
        let lowest = s.min(t).min(-(s + t) + 1.0);
        let inner = self.at([lowest.select(s, start[0]), lowest.select(t, start[1])]);
        best = best.nearer(inner);
        let outside = [t, s, -(s + t) + 1.0];
        if outside[0].any_below(zero) {
            let q = self.along(flat.sides[0], self.r, self.e, self.c, outside[0]);
            best = outside[0].choose_nearer(best, self.at([q, zero]));
        }
        if outside[1].any_below(zero) {
            let q = self.along(flat.sides[2], self.r, self.f, self.d, outside[1]);
            best = outside[1].choose_nearer(best, self.at([zero, q]));
        }
        if outside[2].any_below(zero) {
            let chord = plus(self.f, s.lift(-1.0), self.e);
            let bend = sum(sum(self.c, self.d), self.mixed);
            let q = self.along(flat.sides[1], plus(self.r, s.lift(-1.0), self.e), chord, bend, outside[2]);
            best = outside[2].choose_nearer(best, self.at([-q + 1.0, q]));
        }
        best
    }

    /// The point of the patch at coordinates.
    #[inline(always)]
    fn at(&self, [s, t]: [R; 2]) -> Closest<R> {
        Closest::new(self.remainder(s, t), [s, t])
    }

    /// From the point of the patch at coordinates to the one asked about.
    #[inline(always)]
    fn remainder(&self, s: R, t: R) -> [R; 3] {
        let flat = plus(plus(self.r, -s, self.e), -t, self.f);
        let bent = plus(plus(flat, s * (s - 1.0), self.c), t * (t - 1.0), self.d);
        plus(bent, -(s * t), self.mixed)
    }

    /// Newton's steps, which may end outside of the triangle.
    #[inline(always)]
    fn descend(&self, [mut s, mut t]: [R; 2]) -> [R; 2] {
        let still = s.lift(-R::STILL);
        let mut moving = s.lift(1.0);
        let mut step = 0;
        while step < STEPS {
            let from = self.remainder(s, t);
            let (ks, kt) = (-(s + s) + 1.0, -(t + t) + 1.0);
            let along_s = self.tangent(self.e, ks, self.c, t);
            let along_t = self.tangent(self.f, kt, self.d, s);
            let (gs, gt) = (dot(from, along_s), dot(from, along_t));
            let [ss, st, tt] = [dot(along_s, along_s), dot(along_s, along_t), dot(along_t, along_t)];
            let (bend_s, bend_t) = (dot(from, self.c), dot(from, self.d));
            let full = [ss + bend_s + bend_s, st - dot(from, self.mixed), tt + bend_t + bend_t];
            let least = ss * tt * 1e-3;
            let det = full[0] * full[2] - full[1] * full[1];
            let key = (det - least).min(full[0]);
            let [hss, hst, htt] = [key.select(full[0], ss), key.select(full[1], st), key.select(full[2], tt)];
            // A little more keeps the steps along patches that are curves.
            let more = (ss + tt) * 1e-7;
            let (hss, htt) = (hss + more, htt + more);
            let det = (hss * htt - hst * hst).max(least).max(least.lift(1e-36));
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

    /// `side + k coefficient + other E`.
    #[inline(always)]
    fn tangent(&self, side: [R; 3], k: R, coefficient: [R; 3], other: R) -> [R; 3] {
        plus(plus(side, other, self.mixed), k, coefficient)
    }

    /// The nearest point of the side `q chord + q (1 − q) bend`, from a start, where `outside` is
    /// negative.
    #[inline(always)]
    fn along(&self, start: R, r: [R; 3], chord: [R; 3], bend: [R; 3], outside: R) -> R {
        let mut q = start;
        let still = q.lift(-R::STILL);
        let mut moving = outside.select(q.lift(-1.0), q.lift(1.0));
        let mut step = 0;
        while step < STEPS {
            let from = plus(plus(r, -q, chord), q * (q - 1.0), bend);
            let k = -(q + q) + 1.0;
            let tangent = plus(chord, k, bend);
            let square = dot(tangent, tangent);
            let bent = dot(from, bend);
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

/// A step, cut to the longest.
#[inline(always)]
fn cut<R: Real>(by: R) -> R {
    by.max(by.lift(-STRIDE)).min(by.lift(STRIDE))
}
