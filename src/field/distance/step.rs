//! The steps of the search for the nearest surface point, generic over the number.
//!
//! Vectors are relative to the point x that the distance is asked of: `u = y − x`. A *plane*
//! is an outward unit normal n and the height h of the surface's tangent plane over x along
//! n: the distance to it, positive if x is on the inner side. A concave field's tangent
//! planes all support the body, so the distance of a convex body is the least height.

use crate::Real;
use crate::num::kernel::Formula;

/// Planes known beforehand, in the frame of the points: `[n_x, n_y, n_z, o]`, the height at
/// p being `o − n·p`.
pub(super) type Plane = [f64; 4];

/// Of a normal within this cosine of another, the plane is that of the same side.
const SAME_SIDE: f64 = 0.8;

/// What puts a plane behind all others.
const BEHIND: f64 = 1e15;

/// The diagonal of the equations of two planes: above 1, so that parallel ones share evenly.
const RIDGE: f64 = 1.0 + 1e-5;

/// Keeps denominators off 0.
const TINY: f64 = 1e-30;

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

/// The same behind a deformation: the planes are those of the leaf's frame, measured by the
/// map's derivative at x. Inputs: point in the leaf's frame (3), derivatives of it, row by
/// row (9), gradient and value at x (4), taken (6).
pub(super) struct StartBent<'a> {
    pub(super) planes: &'a [(Plane, [f64; 3])],
    /// From displacements to the points that the derivatives are with respect to.
    pub(super) back: [[f64; 3]; 3],
}

impl Formula<22, 4> for StartBent<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 22]) -> [R; 4] {
        let p = [i[0], i[1], i[2]];
        let (first, second) = ([i[16], i[17], i[18]], [i[19], i[20], i[21]]);
        let zero = i[0].lift(0.0);
        let (mut n, mut h, _) = tangent([zero; 3], i[15], [i[12], i[13], i[14]]);
        let back = Back { map: self.back };
        let rows = [back.run([i[3], i[4], i[5]]), back.run([i[6], i[7], i[8]]), back.run([i[9], i[10], i[11]])];
        let mut score = penalised(n, h, first, second);
        let mut k = 0;
        while k < self.planes.len() {
            let ([a, b, c, o], _) = self.planes[k];
            let pulled = [
                rows[0][0].scale_add(a, rows[1][0].scale_add(b, rows[2][0] * c)),
                rows[0][1].scale_add(a, rows[1][1].scale_add(b, rows[2][1] * c)),
                rows[0][2].scale_add(a, rows[1][2].scale_add(b, rows[2][2] * c)),
            ];
            let inverse = zero.lift(1.0) / dot(pulled, pulled).max(zero.lift(TINY)).sqrt();
            let normal = times(pulled, inverse);
            let height = p[0].scale_add(-a, p[1].scale_add(-b, p[2].scale_add(-c, zero.lift(o)))) * inverse;
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
pub(super) struct Slide {
    /// Whether every tangent plane bounds the distance from above; else the way to a point
    /// of the surface does.
    pub(super) least: bool,
}

impl Formula<17, 10> for Slide {
    #[inline(always)]
    fn run<R: Real>(&self, i: [R; 17]) -> [R; 10] {
        let u = [i[0], i[1], i[2]];
        let (u_old, n_old) = ([i[7], i[8], i[9]], [i[10], i[11], i[12]]);
        let (n, h, lift) = tangent(u, i[3], [i[4], i[5], i[6]]);
        let (best, height, measure);
        if self.least {
            let worse = h - i[16];
            best = choose(worse, [i[13], i[14], i[15]], n);
            height = h.min(i[16]);
            measure = height;
        } else {
            height = h;
            // The way to y, if y is on the surface: it is never too short. The least of these;
            // until y has been there, the last one, negative to tell it.
            let way = dot(u, u).sqrt() + lift.abs();
            let arrived = way * 0.125 - lift.abs();
            let better = i[16].select(i[16] - way, h.lift(1.0));
            let taken = arrived.select(better, -i[16] - TINY);
            best = choose(taken, n, [i[13], i[14], i[15]]);
            measure = taken.select(arrived.select(way, -way), i[16]);
        }
        let moved = minus(u, u_old);
        let turned = dot(moved, minus(n, n_old)) / dot(moved, moved).max(h.lift(TINY));
        let ratio = -(height * turned) + 1.0;
        let stretch = h.lift(1.0) / ratio.max(h.lift(0.125)).min(h.lift(64.0));
        // The tangential part of −u, and the way to the plane.
        let drop = dot(n, u);
        let next = along(times(u, -stretch + 1.0), n, stretch.mul_add(drop, lift));
        [next[0], next[1], next[2], n[0], n[1], n[2], best[0], best[1], best[2], measure]
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
