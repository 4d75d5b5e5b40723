//! How far points are from a triangle, in its own plane.
//!
//! This is what most patches that a search looks at are asked, and it takes less than half of what
//! their nearest points do.

use rvachev_num::Real;

use super::closest::within;
use super::face::{Face, SLACK, wide};
use super::packet::Packet;
use super::search::SURE;

/// A triangle in its own plane: see [`Face`].
pub(super) struct Plane {
    a: [f64; 3],
    axes: [[f64; 3]; 3],
    length: f64,
    apex: [f64; 2],
    /// From corner 1 to 2.
    last: [f64; 2],
    /// The box about it in its plane, wider by what rounding does to a coordinate.
    low: [f64; 2],
    high: [f64; 2],
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
            low: [f64::from(x.min(0.0) - SLACK as f32), f64::from(-SLACK as f32)],
            high: [f64::from(x.max(length) + SLACK as f32), f64::from(y + SLACK as f32)],
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
        let q = -within(beyond.scale_add(wx, y * wy) * per_square(wx, wy));
        let second = [q.scale_add(wx, beyond), q.scale_add(wy, y)];
        let q = -within(x.scale_add(fx, y * fy) * per_square(fx, fy));
        let third = [q.scale_add(fx, x), q.scale_add(fy, y)];
        // On a side it is 0 and so is the way; a triangle without area has no inside.
        let inside = y.min(y.scale_add(wx, beyond * -wy)).min(x.scale_add(fy, y * -fx));
        ([first, second, third], inside)
    }

    /// The squares of how far points are from the box about the triangle in its plane, at least.
    #[inline(always)]
    pub(super) fn gap<R: Real>(&self, p: [R; 3]) -> R {
        let [x, y, z] = self.local(p);
        // The plane is in single precision.
        self.gap_of([x, y, (z.abs() - SLACK).max(z.lift(0.0))])
    }

    #[inline(always)]
    fn gap_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let x = beyond(x, self.low[0], self.high[0]);
        let y = beyond(y, self.low[1], self.high[1]);
        x.mul_add(x, y.mul_add(y, z * z)) * SURE
    }

    /// The squares of the distances; nothing if none is below `most`.
    #[inline(always)]
    pub(super) fn square_below<R: Packet>(&self, p: [R; 3], most: R) -> Option<R> {
        let local = self.local(p);
        if self.gap_of(local).any_below(most) { Some(self.square_of(local)) } else { None }
    }

    /// The squares of the distances.
    #[inline(always)]
    pub(super) fn square<R: Real>(&self, p: [R; 3]) -> R {
        self.square_of(self.local(p))
    }

    #[inline(always)]
    fn square_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
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
fn per_square(x: f64, y: f64) -> f64 {
    let (x, y) = (x as f32, y as f32);
    let square = x * x + y * y;
    if square > 1e-30 { f64::from(1.0 / square) } else { 0.0 }
}

/// How far numbers are from a range.
#[inline(always)]
fn beyond<R: Real>(x: R, low: f64, high: f64) -> R {
    x - x.max(x.lift(low)).min(x.lift(high))
}
