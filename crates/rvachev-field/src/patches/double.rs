//! How far packets of points are from a triangle, in double precision.
//!
//! The frames of [`Plane`](super::plane::Plane) are stored in single precision; what the sides tell
//! takes fewer operations than such a frame in double precision.

use rvachev_num::Real;

use super::closest::within;
use super::face::{Face, Sides, wide};

/// The squares of the distances from a face.
#[inline(always)]
pub(super) fn square<R: Real>(face: &Face, sides: &Sides, p: [R; 3], slim: f64) -> R {
    let [e, f] = sides.wide();
    let [ee, ef, ff] = [stored(e, e), stored(e, f), stored(f, f)];
    let det = ee * ff - ef * ef;
    // Slimmer than the numbers tell, it has no inside.
    let (scale, most) = if det > slim * ee * ff { (1.0 / det, 1.0) } else { (0.0, -1.0) };
    let a = wide(face.a);
    let r = [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (re, rf) = (dot(r, e), dot(r, f));
    let s = re.scale_add(scale * ff, rf * (-scale * ef));
    let t = re.scale_add(-scale * ef, rf * (scale * ee));
    let inside = s.min(t).min(-(s + t) + most);
    let zero = s.lift(0.0);
    let first = away(r, within(re * reciprocal(ee)), e);
    let third = away(r, within(rf * reciprocal(ff)), f);
    let last = [f[0] - e[0], f[1] - e[1], f[2] - e[2]];
    let q = within((rf - re + (ee - ef)) * reciprocal(ee + ff - 2.0 * ef));
    let second = away([r[0] - e[0], r[1] - e[1], r[2] - e[2]], q, last);
    let aside = first.min(second).min(third);
    let below = minus(minus(r, inside.select(s, zero), e), inside.select(t, zero), f);
    inside.select(square_of(below), aside)
}

/// The squares of the distances from a part of a side.
#[inline(always)]
fn away<R: Real>(r: [R; 3], q: R, side: [f64; 3]) -> R {
    square_of(minus(r, q, side))
}

#[inline(always)]
fn square_of<R: Real>([x, y, z]: [R; 3]) -> R {
    x.mul_add(x, y.mul_add(y, z * z))
}

#[inline(always)]
fn minus<R: Real>(v: [R; 3], k: R, w: [f64; 3]) -> [R; 3] {
    let k = -k;
    [k.scale_add(w[0], v[0]), k.scale_add(w[1], v[1]), k.scale_add(w[2], v[2])]
}

#[inline(always)]
fn dot<R: Real>(v: [R; 3], w: [f64; 3]) -> R {
    v[0].scale_add(w[0], v[1].scale_add(w[1], v[2] * w[2]))
}

#[inline(always)]
fn stored(v: [f64; 3], w: [f64; 3]) -> f64 {
    v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
}

/// One over the square of a length, 0 of none.
#[inline(always)]
fn reciprocal(square: f64) -> f64 {
    if square > 1e-30 { 1.0 / square } else { 0.0 }
}
