//! The nearest point of a flat triangle.

use rvachev_num::Real;

use super::packet::Packet;

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
    /// Where the nearest points of the three sides are, 0 to 1 from one end to the other:
    /// corner 0 to 1, 1 to 2, 0 to 2.
    pub(super) sides: [R; 3],
}

/// The nearest point of a triangle: below the point if that is inside, else on one of the sides.
/// e and f are the sides from corner 0, and r is from there to the point.
#[inline(always)]
pub(super) fn on_face<R: Packet>([e, f]: [[R; 3]; 2], r: [R; 3]) -> Flat<R> {
    let [ee, ef, ff] = [dot(e, e), dot(e, f), dot(f, f)];
    let (re, rf) = (dot(r, e), dot(r, f));
    let sides = [
        within(re * reciprocal(ee)),
        within((rf - re + (ee - ef)) * reciprocal(ee + ff - (ef + ef))),
        within(rf * reciprocal(ff)),
    ];
    let zero = re.lift(0.0);
    let one = re.lift(1.0);
    let det = ee * ff - ef * ef;
    // Slimmer than the numbers tell, it has no inside.
    let slim = ee * ff * R::SLIM - det;
    let scale = one / slim.select(one, det);
    let s = (re * ff - rf * ef) * scale;
    let t = (rf * ee - re * ef) * scale;
    let inside = slim.select(-one, s.min(t).min(-(s + t) + 1.0));
    let first = at([e, f], r, sides[0], zero);
    let second = at([e, f], r, -sides[1] + 1.0, sides[1]);
    let third = at([e, f], r, zero, sides[2]);
    let closest = at([e, f], r, s, t).select(inside, first.nearer(second).nearer(third));
    Flat { closest, sides }
}

/// One over the square of a length, 0 of none.
#[inline(always)]
fn reciprocal<R: Real>(square: R) -> R {
    (square - 1e-30).select(square.lift(1.0) / square, square.lift(0.0))
}

/// The point of a face at coordinates.
#[inline(always)]
fn at<R: Real>([e, f]: [[R; 3]; 2], r: [R; 3], s: R, t: R) -> Closest<R> {
    Closest::new(plus(plus(r, -s, e), -t, f), [s, t])
}

/// `v + k w`.
#[inline(always)]
pub(super) fn plus<R: Real>(v: [R; 3], k: R, w: [R; 3]) -> [R; 3] {
    [k.mul_add(w[0], v[0]), k.mul_add(w[1], v[1]), k.mul_add(w[2], v[2])]
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
