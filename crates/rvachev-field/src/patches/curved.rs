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

use super::closest::{Closest, Flat, dot, dot_stored, minus, within};
use super::face::{Bulge, Face};
use super::packet::Packet;

/// Each step squares the error, which is some hundredths of the patch at the start.
const STEPS: usize = 3;

/// No step is longer than this, in coordinates.
const STRIDE: f64 = 0.5;

/// A patch about one point: its coefficients, and where the point is from corner 0.
struct Around<'a, R> {
    face: &'a Face,
    bulge: &'a Bulge,
    r: [R; 3],
}

/// The nearest point of a patch, given that of its triangle.
#[inline(always)]
pub(super) fn on_patch<R: Packet>(face: &Face, bulge: &Bulge, flat: &Flat<R>) -> Closest<R> {
    let around = Around { face, bulge, r: flat.from_corner };
    let start = flat.closest.coordinates;
    let mut best = around.at(start);
    let [s, t] = around.descend(start);
    let zero = s.lift(0.0);
    let lowest = s.min(t).min(-(s + t) + 1.0);
    let inner = around.at([lowest.select(s, start[0]), lowest.select(t, start[1])]);
    best = best.nearer(inner);
    if !lowest.any_below(zero) {
        return best;
    }
    let outside = [t, s, -(s + t) + 1.0];
    if outside[0].any_below(zero) {
        let q = around.along(flat.sides[0], around.r, face.e, bulge.c);
        best = outside[0].choose_nearer(best, around.at([q, zero]));
    }
    if outside[1].any_below(zero) {
        let q = around.along(flat.sides[2], around.r, face.f, bulge.d);
        best = outside[1].choose_nearer(best, around.at([zero, q]));
    }
    if outside[2].any_below(zero) {
        let chord = sum(face.f, face.e, -1.0);
        let bend = sum(sum(bulge.c, bulge.d, 1.0), bulge.e, 1.0);
        let q = around.along(flat.sides[1], minus(around.r, zero + 1.0, face.e), chord, bend);
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
fn sum(v: [f32; 3], w: [f32; 3], k: f32) -> [f32; 3] {
    [v[0] + k * w[0], v[1] + k * w[1], v[2] + k * w[2]]
}

impl<R: Real> Around<'_, R> {
    /// The point of the patch at coordinates.
    #[inline(always)]
    fn at(&self, [s, t]: [R; 2]) -> Closest<R> {
        Closest::new(self.remainder(s, t), [s, t])
    }

    /// From the point of the patch at coordinates to the one asked about.
    #[inline(always)]
    fn remainder(&self, s: R, t: R) -> [R; 3] {
        let flat = minus(minus(self.r, s, self.face.e), t, self.face.f);
        let bent = minus(minus(flat, s * (-s + 1.0), self.bulge.c), t * (-t + 1.0), self.bulge.d);
        minus(bent, s * t, self.bulge.e)
    }

    /// Newton's steps, which may end outside of the triangle.
    #[inline(always)]
    fn descend(&self, [mut s, mut t]: [R; 2]) -> [R; 2] {
        let mut step = 0;
        while step < STEPS {
            let from = self.remainder(s, t);
            let (ks, kt) = (-(s + s) + 1.0, -(t + t) + 1.0);
            let along_s = self.tangent(self.face.e, ks, self.bulge.c, t);
            let along_t = self.tangent(self.face.f, kt, self.bulge.d, s);
            let (gs, gt) = (dot(from, along_s), dot(from, along_t));
            let [ss, st, tt] = [dot(along_s, along_s), dot(along_s, along_t), dot(along_t, along_t)];
            let (bend_s, bend_t) = (dot_stored(from, self.bulge.c), dot_stored(from, self.bulge.d));
            let full = [ss + bend_s + bend_s, st - dot_stored(from, self.bulge.e), tt + bend_t + bend_t];
            let least = ss * tt * 1e-3;
            let det = full[0] * full[2] - full[1] * full[1];
            let key = (det - least).min(full[0]);
            let [hss, hst, htt] = [key.select(full[0], ss), key.select(full[1], st), key.select(full[2], tt)];
            let det = (hss * htt - hst * hst).max(least).max(least.lift(1e-30));
            let per_det = det.lift(1.0) / det;
            s = advance(s, (htt * gs - hst * gt) * per_det);
            t = advance(t, (hss * gt - hst * gs) * per_det);
            step += 1;
        }
        [s, t]
    }

    /// `side + k bulge + other E`.
    #[inline(always)]
    fn tangent(&self, side: [f32; 3], k: R, bulge: [f32; 3], other: R) -> [R; 3] {
        let mixed = self.bulge.e;
        let plain = plus(lifted(k, side), other, mixed);
        plus(plain, k, bulge)
    }

    /// The nearest point of the side `q chord + q (1 − q) bend`, from a start.
    #[inline(always)]
    fn along(&self, start: R, r: [R; 3], chord: [f32; 3], bend: [f32; 3]) -> R {
        let mut q = start;
        let mut step = 0;
        while step < STEPS {
            let from = minus(minus(r, q, chord), q * (-q + 1.0), bend);
            let k = -(q + q) + 1.0;
            let tangent = plus(lifted(k, chord), k, bend);
            let square = dot(tangent, tangent);
            let bent = dot_stored(from, bend);
            let full = square + bent + bent;
            let curvature = (full - square * 1e-2).select(full, square).max(square.lift(1e-30));
            q = within(advance(q, dot(from, tangent) / curvature));
            step += 1;
        }
        q
    }
}

/// A stored vector as a packet's, `like` any number of it.
#[inline(always)]
fn lifted<R: Real>(like: R, v: [f32; 3]) -> [R; 3] {
    [like.lift(f64::from(v[0])), like.lift(f64::from(v[1])), like.lift(f64::from(v[2]))]
}

/// `v + k w`.
#[inline(always)]
fn plus<R: Real>(v: [R; 3], k: R, w: [f32; 3]) -> [R; 3] {
    [k.scale_add(f64::from(w[0]), v[0]), k.scale_add(f64::from(w[1]), v[1]), k.scale_add(f64::from(w[2]), v[2])]
}

/// A step, cut to the longest.
#[inline(always)]
fn advance<R: Real>(x: R, by: R) -> R {
    x + by.max(by.lift(-STRIDE)).min(by.lift(STRIDE))
}
