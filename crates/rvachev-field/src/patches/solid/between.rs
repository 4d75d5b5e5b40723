//! A triangle between a point and others.

use rvachev_num::Real;

use super::super::face::{Face, Sides, wide};
use super::super::packet::Packet;

/// Stored corners of neighbouring triangles differ by less, in units of the frame.
pub(super) const CORNERS: f64 = 4.0 * f32::EPSILON as f64;

/// Products of three factors are off by less than so many units in the last place.
const PRODUCTS: f64 = 16.0;

/// No larger than this is what makes no difference.
const NOTHING: f64 = 1e-30;

/// What the triangles between a point and a packet tell.
pub(super) struct Crossed<R> {
    /// How much more the numbers of the packet are.
    pub(super) more: R,
    /// Positive where rounding may have told.
    pub(super) doubt: R,
}

/// A triangle as seen from a point.
pub(super) struct Between {
    /// From the point to the corners.
    a: [f64; 3],
    b: [f64; 3],
    c: [f64; 3],
    /// Twice the area vector.
    n: [f64; 3],
}

impl Between {
    #[inline(always)]
    pub(super) fn new(from: [f64; 3], face: &Face, sides: &Sides) -> Between {
        let (a, [e, f]) = (wide(face.a), sides.wide());
        let mut triangle = Between { a: [0.0; 3], b: [0.0; 3], c: [0.0; 3], n: cross(e, f) };
        for axis in 0..3 {
            triangle.a[axis] = a[axis] - from[axis];
            triangle.b[axis] = triangle.a[axis] + e[axis];
            triangle.c[axis] = triangle.a[axis] + f[axis];
        }
        triangle
    }

    /// Adds whether it is crossed on the ways `d`, none of them longer than `reach`.
    ///
    /// The way from the point along d passes the triangle if d·(A × B), d·(B × C) and d·(C × A)
    /// have the sign of d·N, and ends beyond its plane. Each of them is divided by what rounding
    /// may do to it.
    #[inline(always)]
    pub(super) fn add<R: Packet>(&self, d: [R; 3], reach: f64, to: &mut Crossed<R>) {
        let Between { a, b, c, n, .. } = *self;
        let area = length(n);
        if area <= 0.0 {
            return;
        }
        let start = -dot(n, a);
        // The plane is that of the triangle as it is stored.
        let per_height = 1.0 / (area * reach * PRODUCTS * R::EPSILON + NOTHING);
        // To the front it is crossed from behind only.
        let side = if start < 0.0 { 1.0 } else { -1.0 };
        let k = side * per_height;
        let beyond = along(d, [k * n[0], k * n[1], k * n[2]]) + k * start;
        let is_in_plane = start.abs() * per_height <= 1.0;
        if !is_in_plane && !beyond.lift(-1.0).any_below(beyond) {
            // No way reaches the plane.
            return;
        }
        let [la, lb, lc] = [length(a), length(b), length(c)];
        let u = along(d, edge::<R>(a, b, la + lb, reach, side));
        let v = along(d, edge::<R>(b, c, lb + lc, reach, side));
        let w = along(d, edge::<R>(c, a, lc + la, reach, side));
        let within = u.min(v).min(w);
        if is_in_plane {
            // It begins in the plane: nothing is certain but that it passes aside.
            let other = -u.max(v).max(w);
            to.doubt = to.doubt.max(within.max(other) + 1.0);
            return;
        }
        let passed = within.min(beyond);
        to.doubt = to.doubt.max(-passed.abs() + 1.0);
        to.more = to.more + passed.select(passed.lift(-side), passed.lift(0.0));
    }
}

/// Across the plane of a point and a side, as long as it takes for ways up to `reach` to have
/// products of 1 where rounding may tell; `far` is how far both ends are.
#[inline(always)]
fn edge<R: Packet>(v: [f64; 3], w: [f64; 3], far: f64, reach: f64, side: f64) -> [f64; 3] {
    let across = cross(v, w);
    let k = side / (reach * (far * CORNERS + length(across) * PRODUCTS * R::EPSILON) + NOTHING);
    [k * across[0], k * across[1], k * across[2]]
}

#[inline(always)]
fn along<R: Real>(d: [R; 3], v: [f64; 3]) -> R {
    d[0].scale_add(v[0], d[1].scale_add(v[1], d[2] * v[2]))
}

#[inline(always)]
fn cross(v: [f64; 3], w: [f64; 3]) -> [f64; 3] {
    [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]]
}

#[inline(always)]
fn dot(v: [f64; 3], w: [f64; 3]) -> f64 {
    v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
}

#[inline(always)]
fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}
