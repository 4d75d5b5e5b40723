//! The steps of the search for the nearest surface point, generic over the number.
//!
//! Vectors are relative to the point x that the distance is asked of: `u = y − x`. A *plane*
//! is an outward unit normal n and the height h of the surface's tangent plane over x along
//! n: the distance to it, positive if x is on the inner side. A concave field's tangent
//! planes all support the body, so the distance of a convex body is the least height.

use crate::Real;
use crate::kernel::Formula;

/// Planes known beforehand, in the frame of the points: `[n_x, n_y, n_z, o]`, the height at
/// p being `o − n·p`.
pub(super) type Plane = [f64; 4];

/// Of a normal within this cosine of another, the plane is that of the same side.
const SAME_SIDE: f64 = 0.8;

/// What puts a plane, or a point, behind all others.
pub(super) const BEHIND: f64 = 1e15;

/// The diagonal of the equations of two planes: above 1 by far more than rounding errors of
/// single precision, so that parallel planes share evenly.
const RIDGE: f64 = 1.0 + 2e-4;

/// Keeps denominators off 0.
const TINY: f64 = 1e-30;

/// A step that is shorter than this part of the distance is not made: what it would change
/// of the distance is the square of it.
const LET_BE: f64 = 1e-2;

#[inline(always)]
pub(super) fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// `a + b·k`.
#[inline(always)]
fn along<R: Real>(a: [R; 3], b: [R; 3], k: R) -> [R; 3] {
    [b[0].mul_add(k, a[0]), b[1].mul_add(k, a[1]), b[2].mul_add(k, a[2])]
}

#[inline(always)]
fn minus<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn times<R: Real>(a: [R; 3], k: R) -> [R; 3] {
    [a[0] * k, a[1] * k, a[2] * k]
}

/// `by ≥ 0 ? a : b`.
#[inline(always)]
fn choose<R: Real>(by: R, a: [R; 3], b: [R; 3]) -> [R; 3] {
    [by.select(a[0], b[0]), by.select(a[1], b[1]), by.select(a[2], b[2])]
}

/// The tangent plane of a field at u: normal, height over x, and value in lengths.
#[inline(always)]
fn tangent<R: Real>(u: [R; 3], f: R, g: [R; 3]) -> ([R; 3], R, R) {
    let length = dot(g, g).max(f.lift(TINY)).sqrt();
    let inverse = f.lift(-1.0) / length;
    let n = times(g, inverse);
    let lift = -(f * inverse);
    (n, dot(n, u) + lift, lift)
}

/// The best plane to start from: `x0` is that of the field at x, `taken` the normals of
/// earlier starts. Inputs: point (3), gradient and value at x (4), taken (3 + 3).
/// Outputs: normal, height.
pub(super) struct Start<'a> {
    /// Each with its unit normal: the points may be those of another frame.
    pub(super) planes: &'a [(Plane, [f64; 3])],
}

impl Formula<13, 4> for Start<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 13]) -> [R; 4] {
        let p = [i[0], i[1], i[2]];
        let (first, second) = ([i[7], i[8], i[9]], [i[10], i[11], i[12]]);
        let zero = i[0].lift(0.0);
        let (mut n, mut h, _) = tangent([zero; 3], i[6], [i[3], i[4], i[5]]);
        let mut score = penalised(n, h, first, second);
        let mut k = 0;
        while k < self.planes.len() {
            let ([a, b, c, o], [nx, ny, nz]) = self.planes[k];
            let normal = [zero.lift(nx), zero.lift(ny), zero.lift(nz)];
            let height = p[0].scale_add(-a, p[1].scale_add(-b, p[2].scale_add(-c, zero.lift(o))));
            let other = penalised(normal, height, first, second);
            let worse = other - score;
            n = choose(worse, n, normal);
            h = worse.select(h, height);
            score = score.min(other);
            k += 1;
        }
        [n[0], n[1], n[2], h]
    }
}

#[inline(always)]
fn penalised<R: Real>(n: [R; 3], h: R, first: [R; 3], second: [R; 3]) -> R {
    let same = dot(n, first).max(dot(n, second)) - SAME_SIDE;
    same.select(h + BEHIND, h)
}

/// One step inside: y moves along the tangent plane at y to below x, lengthened by the
/// secant curvature (two such planes meet beyond: 1/(1 − hκ)), and along the normal to the
/// surface. Inputs: u (3), value and gradient at y (4), u and normal before (6), best plane
/// (4). Outputs: next u (3), normal at y (3), best plane (4).
pub(super) struct Slide;

impl Formula<17, 10> for Slide {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 17]) -> [R; 10] {
        let u = [i[0], i[1], i[2]];
        let (n, h, lift) = tangent(u, i[3], [i[4], i[5], i[6]]);
        let best = choose(h - i[16], [i[13], i[14], i[15]], n);
        let height = h.min(i[16]);
        let turned = turning(u, n, [i[7], i[8], i[9]], [i[10], i[11], i[12]], h.lift(0.0));
        let next = slid(u, n, lift, height * turned);
        [next[0], next[1], next[2], n[0], n[1], n[2], best[0], best[1], best[2], height]
    }
}

/// The curvature by which the normal turned on the way from the y before; `unmoved` if there
/// is no such way.
#[inline(always)]
fn turning<R: Real>(u: [R; 3], n: [R; 3], u_old: [R; 3], n_old: [R; 3], unmoved: R) -> R {
    let moved = minus(u, u_old);
    let way = dot(moved, moved);
    let turned = dot(moved, minus(n, n_old)) / way.max(way.lift(TINY));
    (way - TINY).select(turned, unmoved)
}

/// Where y is to go; `turn` is height times curvature.
#[inline(always)]
fn slid<R: Real>(u: [R; 3], n: [R; 3], lift: R, turn: R) -> [R; 3] {
    let ratio = -turn + 1.0;
    let stretch = ratio.lift(1.0) / ratio.max(ratio.lift(0.125)).min(ratio.lift(64.0));
    // The tangential part of −u, and the way to the plane.
    along(times(u, -stretch + 1.0), n, stretch.mul_add(dot(n, u), lift))
}

/// The better of the surface point by y and the best so far, as the normal there, the way to
/// it from x, and the length of that. A y counts if it is on the surface but for an eighth of
/// its distance, or for `let_be`.
#[inline(always)]
fn nearer<R: Real>(u: [R; 3], n: [R; 3], lift: R, best: [R; 7], let_be: f64) -> [R; 7] {
    let off = lift.abs();
    let way = dot(u, u).sqrt() + off;
    let arrived = way.scale_add(0.125, way.lift(let_be)) - off;
    let taken = arrived.select(best[6] - way, -best[6] - TINY);
    let normal = choose(taken, n, [best[0], best[1], best[2]]);
    let foot = choose(taken, along(u, n, lift), [best[3], best[4], best[5]]);
    [normal[0], normal[1], normal[2], foot[0], foot[1], foot[2], taken.select(way, best[6])]
}

/// One step along any surface: as [`Slide`], but what counts is the way to a point of the
/// surface. A y that is where it should be stays there. Inputs: u (3), value and gradient at
/// y (4), u and normal before (6), best (7: normal, foot, way). Outputs: next u (3), normal
/// at y (3), best (7), how much there was left to move beyond what is let be.
pub(super) struct Follow {
    /// The curvature that is taken for granted outside, before there is a secant.
    pub(super) curvature: f64,
    /// A step shorter than this is not made either.
    pub(super) let_be: f64,
}

impl Follow {
    /// How much of the way to below x is gone at a height, before there is a secant.
    #[inline(always)]
    pub(super) fn stretch(&self, height: f64) -> f64 {
        1.0 / (1.0 - height.min(0.0) * self.curvature).min(64.0)
    }
}

impl Formula<20, 14> for Follow {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 20]) -> [R; 14] {
        let u = [i[0], i[1], i[2]];
        let (n, h, lift) = tangent(u, i[3], [i[4], i[5], i[6]]);
        let best = nearer(u, n, lift, [i[13], i[14], i[15], i[16], i[17], i[18], i[19]], self.let_be);
        let zero = h.lift(0.0);
        let unmoved = h.select(zero, h.lift(self.curvature));
        let turned = turning(u, n, [i[7], i[8], i[9]], [i[10], i[11], i[12]], unmoved);
        let next = slid(u, n, lift, h * turned);
        let step = minus(next, u);
        let way = dot(u, u).sqrt();
        let left = dot(step, step).sqrt().max(lift.abs()) - way.scale_add(LET_BE, h.lift(self.let_be));
        let next = choose(left, next, u);
        [
            next[0], next[1], next[2], n[0], n[1], n[2], best[0], best[1], best[2], best[3], best[4], best[5], best[6],
            left,
        ]
    }
}

/// One step of [`Cut`] about any surface, of which the best point is kept. Inputs: those of
/// [`Cut`] (19), best (7). Outputs: those of [`Cut`] (15), best (7).
pub(super) struct CutNear {
    /// By how much a point may miss the surface.
    pub(super) let_be: f64,
}

impl Formula<26, 22> for CutNear {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 26]) -> [R; 22] {
        let u = [i[0], i[1], i[2]];
        let (n, _, lift) = tangent(u, i[3], [i[4], i[5], i[6]]);
        let b = nearer(u, n, lift, [i[19], i[20], i[21], i[22], i[23], i[24], i[25]], self.let_be);
        let o = Cut.run([
            i[0], i[1], i[2], i[3], i[4], i[5], i[6], i[7], i[8], i[9], i[10], i[11], i[12], i[13], i[14], i[15],
            i[16], i[17], i[18],
        ]);
        [
            o[0], o[1], o[2], o[3], o[4], o[5], o[6], o[7], o[8], o[9], o[10], o[11], o[12], o[13], o[14], b[0], b[1],
            b[2], b[3], b[4], b[5], b[6],
        ]
    }
}

/// One step outside: y is the point nearest to x of the half-spaces below the tangent plane
/// at y, the two before it, and the one that stands for all the others. Inputs: u (3), value
/// and gradient at y (4), planes (4 + 4 + 4). Outputs: next u (3), the plane at the nearest
/// point, which stands for all (4), the newest two planes (8).
pub(super) struct Cut;

impl Formula<19, 15> for Cut {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 19]) -> [R; 15] {
        let zero = i[0].lift(0.0);
        let (n, h, _) = tangent([i[0], i[1], i[2]], i[3], [i[4], i[5], i[6]]);
        let depth = -h;
        // x is `height` above each plane; the nearest point is x − Σ λ n, λ ≥ 0.
        let planes = [[i[11], i[12], i[13]], [i[15], i[16], i[17]], [i[7], i[8], i[9]]];
        let depths = [-i[14], -i[18], -i[10]];
        let mut weights = [zero, zero, depths[2].max(zero)];
        let mut weight = zero;
        let mut sum = times(planes[2], weights[2]);
        let mut round = 0;
        while round < 6 {
            // The newest plane and one of the others, exactly, the rest being held.
            let k = round % 3;
            let (a, b) = (n, planes[k]);
            let rest = along(along(sum, a, -weight), b, -weights[k]);
            let (r, s) = (depth - dot(a, rest), depths[k] - dot(b, rest));
            let cosine = dot(a, b);
            let inverse = zero.lift(1.0) / (-(cosine * cosine) + RIDGE * RIDGE);
            let one = (r * RIDGE - cosine * s) * inverse;
            let two = (s * RIDGE - cosine * r) * inverse;
            let only_r = r.max(zero);
            let only_s = s.max(zero);
            weight = two.select(one.select(one, zero), only_r);
            weights[k] = two.select(one.select(two, only_s), zero);
            sum = along(along(rest, a, weight), b, weights[k]);
            round += 1;
        }
        let length = dot(sum, sum).max(zero.lift(TINY)).sqrt();
        let inverse = zero.lift(1.0) / length;
        let weighed =
            weight.mul_add(depth, weights[0].mul_add(depths[0], weights[1].mul_add(depths[1], weights[2] * depths[2])));
        let all = times(sum, inverse);
        let out = -(weighed * inverse);
        let next = times(sum, zero.lift(-1.0));
        let newest = planes[0];
        [
            next[0], next[1], next[2], all[0], all[1], all[2], out, n[0], n[1], n[2], h, newest[0], newest[1],
            newest[2], -depths[0],
        ]
    }
}

/// `p + B·u`: from a displacement to a point of the frame of the points.
pub(super) struct Shift {
    pub(super) back: [[f64; 3]; 3],
}

impl Formula<6, 3> for Shift {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y, z, u, v, w]: [R; 6]) -> [R; 3] {
        let b = &self.back;
        [
            u.scale_add(b[0][0], v.scale_add(b[0][1], w.scale_add(b[0][2], x))),
            u.scale_add(b[1][0], v.scale_add(b[1][1], w.scale_add(b[1][2], y))),
            u.scale_add(b[2][0], v.scale_add(b[2][1], w.scale_add(b[2][2], z))),
        ]
    }
}

/// `Mᵀ g`: a gradient with respect to the image of a linear map, before it.
pub(super) struct Back {
    pub(super) map: [[f64; 3]; 3],
}

impl Formula<3, 3> for Back {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let m = &self.map;
        [
            x.scale_add(m[0][0], y.scale_add(m[1][0], z * m[2][0])),
            x.scale_add(m[0][1], y.scale_add(m[1][1], z * m[2][1])),
            x.scale_add(m[0][2], y.scale_add(m[1][2], z * m[2][2])),
        ]
    }
}
