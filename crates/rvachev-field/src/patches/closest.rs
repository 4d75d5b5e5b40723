//! The nearest point of a flat triangle.

use rvachev_num::Real;

use super::face::{Face, Sides};

/// A point of a patch and how far it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest<R> {
    /// The square of the distance.
    pub(super) square: R,
    /// From the point of the patch to the one that was asked about.
    pub(super) from: [R; 3],
    /// Where it is on the patch: s and t.
    pub(super) coordinates: [R; 2],
}

impl<R: Real> Closest<R> {
    #[inline(always)]
    pub(super) fn new(from: [R; 3], coordinates: [R; 2]) -> Closest<R> {
        Closest { square: dot(from, from), from, coordinates }
    }

    /// This one where `key ≥ 0`, else the other.
    #[inline(always)]
    pub(super) fn select(self, key: R, other: Closest<R>) -> Closest<R> {
        let [[x, y, z], [u, v, w]] = [self.from, other.from];
        let [[s, t], [q, r]] = [self.coordinates, other.coordinates];
        Closest {
            square: key.select(self.square, other.square),
            from: [key.select(x, u), key.select(y, v), key.select(z, w)],
            coordinates: [key.select(s, q), key.select(t, r)],
        }
    }

    /// The nearer of both, this one if they are equally near.
    #[inline(always)]
    pub(super) fn nearer(self, other: Closest<R>) -> Closest<R> {
        self.select(other.square - self.square, other)
    }
}

/// What is found of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat<R> {
    pub(super) closest: Closest<R>,
    /// From corner 0 to the point.
    pub(super) from_corner: [R; 3],
    /// Where the nearest points of the three sides are, 0 to 1 from one end to the other:
    /// corner 0 to 1, 1 to 2, 0 to 2.
    pub(super) sides: [R; 3],
}

/// Scalars of a triangle that do not depend on the point.
struct Metric {
    ee: f64,
    ef: f64,
    /// One over the squares of the sides' lengths, 0 for a side without length.
    per_side: [f64; 3],
    /// The inverse of the matrix of the dot products of e and f, 0 if there is none.
    inverse: [f64; 3],
    /// 1 if there is, else −1: then no point is inside.
    has_inside: f64,
}

impl Metric {
    #[inline(always)]
    fn of([e, f]: [[f64; 3]; 2]) -> Metric {
        let [ee, ef, ff] = [dot(e, e), dot(e, f), dot(f, f)];
        let det = ee * ff - ef * ef;
        // Slimmer than single precision tells, it has no inside.
        let (scale, has_inside) = if det > 1e-12 * ee * ff { (1.0 / det, 1.0) } else { (0.0, -1.0) };
        Metric {
            ee,
            ef,
            per_side: [reciprocal(ee), reciprocal(ee + ff - 2.0 * ef), reciprocal(ff)],
            inverse: [scale * ff, -scale * ef, scale * ee],
            has_inside,
        }
    }
}

/// One over the square of a length, 0 of none.
#[inline(always)]
fn reciprocal(square: f64) -> f64 {
    if square > 1e-30 { 1.0 / square } else { 0.0 }
}

/// The nearest point of a face: below the point if that is inside, else on one of the sides.
#[inline(always)]
pub(super) fn on_face<R: Real>(face: &Face, sides: &Sides, p: [R; 3]) -> Flat<R> {
    let [e, f] = [sides.e.map(f64::from), sides.f.map(f64::from)];
    let metric = Metric::of([e, f]);
    let r = [p[0] - f64::from(face.a[0]), p[1] - f64::from(face.a[1]), p[2] - f64::from(face.a[2])];
    let (re, rf) = (dot_stored(r, e), dot_stored(r, f));
    let sides = [
        within(re * metric.per_side[0]),
        within((rf - re + (metric.ee - metric.ef)) * metric.per_side[1]),
        within(rf * metric.per_side[2]),
    ];
    let s = re.scale_add(metric.inverse[0], rf * metric.inverse[1]);
    let t = re.scale_add(metric.inverse[1], rf * metric.inverse[2]);
    let zero = s.lift(0.0);
    let first = at([e, f], r, sides[0], zero);
    let second = at([e, f], r, -sides[1] + 1.0, sides[1]);
    let third = at([e, f], r, zero, sides[2]);
    let inside = s.min(t).min(-(s + t) + metric.has_inside);
    let closest = at([e, f], r, s, t).select(inside, first.nearer(second).nearer(third));
    Flat { closest, from_corner: r, sides }
}

/// The point of a face at coordinates; `r` is from corner 0 to the point that is asked about.
#[inline(always)]
fn at<R: Real>([e, f]: [[f64; 3]; 2], r: [R; 3], s: R, t: R) -> Closest<R> {
    Closest::new(minus(minus(r, s, e), t, f), [s, t])
}

/// `v − k w`.
#[inline(always)]
pub(super) fn minus<R: Real>(v: [R; 3], k: R, w: [f64; 3]) -> [R; 3] {
    plus(v, -k, w)
}

/// `v + k w`.
#[inline(always)]
pub(super) fn plus<R: Real>(v: [R; 3], k: R, w: [f64; 3]) -> [R; 3] {
    [k.scale_add(w[0], v[0]), k.scale_add(w[1], v[1]), k.scale_add(w[2], v[2])]
}

#[inline(always)]
pub(super) fn dot_stored<R: Real>(v: [R; 3], w: [f64; 3]) -> R {
    v[0].scale_add(w[0], v[1].scale_add(w[1], v[2] * w[2]))
}

#[inline(always)]
pub(super) fn dot<R: Real>(v: [R; 3], w: [R; 3]) -> R {
    v[0].mul_add(w[0], v[1].mul_add(w[1], v[2] * w[2]))
}

/// Held within 0 and 1.
#[inline(always)]
pub(super) fn within<R: Real>(x: R) -> R {
    x.max(x.lift(0.0)).min(x.lift(1.0))
}
