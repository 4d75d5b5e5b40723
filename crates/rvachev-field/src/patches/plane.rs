//! How far points are from a triangle, in its own plane.
//!
//! This is what most patches that a search looks at are asked, and it takes less than half of what
//! their nearest points do.

use rvachev_num::Real;

use super::closest::within;
use super::face::{Face, wide};

/// A triangle in its own plane: see [`Face`].
pub(super) struct Plane {
    a: [f64; 3],
    axes: [[f64; 3]; 3],
    length: f64,
    apex: [f64; 2],
    /// From corner 1 to 2.
    last: [f64; 2],
    /// One over the squares of the lengths of the sides from corner 1 to 2 and from 0 to 2; 0 for
    /// a side without length.
    per_side: [f64; 2],
}

impl Plane {
    /// As it is stored, in single precision.
    #[inline(always)]
    pub(super) fn single(face: &Face) -> Plane {
        let Face { a, u, v, n, length, apex: [x, y], .. } = *face;
        Plane {
            a: wide(a),
            axes: [wide(u), wide(v), wide(n)],
            length: f64::from(length),
            apex: [f64::from(x), f64::from(y)],
            last: [f64::from(x - length), f64::from(y)],
            per_side: [f64::from(per_square(x - length, y)), f64::from(per_square(x, y))],
        }
    }

    /// A point in the triangle's frame.
    #[inline(always)]
    fn local<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        let r = [p[0] - self.a[0], p[1] - self.a[1], p[2] - self.a[2]];
        let [u, v, n] = self.axes;
        [stored_dot(r, u), stored_dot(r, v), stored_dot(r, n)]
    }

    /// The ways to a point from the nearest ones of the three sides, within the plane, and a number
    /// that is positive inside.
    #[inline(always)]
    fn aside<R: Real>(&self, x: R, y: R) -> ([[R; 2]; 3], R) {
        let ([wx, wy], [fx, fy]) = (self.last, self.apex);
        let beyond = x - self.length;
        let first = [beyond.max(x.min(x.lift(0.0))), y];
        let q = -within(beyond.scale_add(wx, y * wy) * self.per_side[0]);
        let second = [q.scale_add(wx, beyond), q.scale_add(wy, y)];
        let q = -within(x.scale_add(fx, y * fy) * self.per_side[1]);
        let third = [q.scale_add(fx, x), q.scale_add(fy, y)];
        // On a side it is 0 and so is the way; a triangle without area has no inside.
        let inside = y.min(y.scale_add(wx, beyond * -wy)).min(x.scale_add(fy, y * -fx));
        ([first, second, third], inside)
    }

    /// The squares of the distances.
    #[inline(always)]
    pub(super) fn square<R: Real>(&self, p: [R; 3]) -> R {
        let [x, y, z] = self.local(p);
        let ([first, second, third], inside) = self.aside(x, y);
        let aside = norm(first).min(norm(second)).min(norm(third));
        z.mul_add(z, (-inside).select(aside, z.lift(0.0)))
    }

    /// The ways from the nearest points.
    #[inline(always)]
    pub(super) fn way<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        let [x, y, z] = self.local(p);
        let ([first, second, third], inside) = self.aside(x, y);
        let aside = nearer(nearer(first, second), third);
        let zero = z.lift(0.0);
        let way = [(-inside).select(aside[0], zero), (-inside).select(aside[1], zero), z];
        let [u, v, n] = self.axes;
        [stored_dot(way, [u[0], v[0], n[0]]), stored_dot(way, [u[1], v[1], n[1]]), stored_dot(way, [u[2], v[2], n[2]])]
    }
}

#[inline(always)]
fn norm<R: Real>([x, y]: [R; 2]) -> R {
    x.mul_add(x, y * y)
}

/// The shorter of both.
#[inline(always)]
fn nearer<R: Real>(a: [R; 2], b: [R; 2]) -> [R; 2] {
    let key = norm(b) - norm(a);
    [key.select(a[0], b[0]), key.select(a[1], b[1])]
}

#[inline(always)]
fn stored_dot<R: Real>(v: [R; 3], w: [f64; 3]) -> R {
    v[0].scale_add(w[0], v[1].scale_add(w[1], v[2] * w[2]))
}

/// One over the square of a side's length, 0 of none.
#[inline(always)]
fn per_square(x: f32, y: f32) -> f32 {
    let square = x * x + y * y;
    if square > 1e-30 { 1.0 / square } else { 0.0 }
}
