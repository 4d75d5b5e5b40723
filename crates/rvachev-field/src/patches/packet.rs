//! Numbers of one point or of several: what a search asks of them beyond arithmetic.

use fearless_simd::prelude::*;
use rvachev_num::Real;
use rvachev_num::lanes::{F32, F64, Lanes, Twice};

use super::closest::on_face;
use super::double;
use super::face::{Face, Sides};
use super::plane::Plane;

/// The most points of a packet.
pub(super) const WIDEST: usize = 32;

/// One point's number, or those of a packet of points.
pub(super) trait Packet: Real {
    /// Whether it is one point: the order of boxes then tells more than the seeds do.
    const ALONE: bool = false;

    /// The last of Newton's steps is at most this long, in coordinates of a patch: the error that
    /// is left goes with its square, and that of the distance with its fourth power.
    const STILL: f64;

    /// A triangle whose sides from a corner have a sine whose square is less has no inside.
    const SLIM: f64;

    /// How far off 1 rounding may be.
    const EPSILON: f64;

    /// Which numbers are below their counterparts, as bits.
    fn below(self, other: Self) -> u64;

    /// Whether any number is below its counterpart.
    fn any_below(self, other: Self) -> bool;

    /// The number of one of the points.
    fn one(self) -> f32;

    /// The numbers of all points, and how many they are.
    fn all(self) -> ([f32; WIDEST], usize);

    /// The squares of the distances from a face.
    fn from_face(p: [Self; 3], face: &Face, sides: &Sides) -> Self;

    /// The same; nothing where it is easily told that none is below `most`.
    #[inline(always)]
    fn from_near_face(p: [Self; 3], face: &Face, sides: &Sides, most: Self) -> Option<Self> {
        if Plane::single(face).gap(p).any_below(most) { Some(Self::from_face(p, face, sides)) } else { None }
    }
}

impl Packet for f64 {
    const ALONE: bool = true;
    const STILL: f64 = 1e-4;
    const SLIM: f64 = 1e-12;
    const EPSILON: f64 = f64::EPSILON;

    #[inline(always)]
    fn below(self, other: f64) -> u64 {
        u64::from(self < other)
    }

    #[inline(always)]
    fn any_below(self, other: f64) -> bool {
        self < other
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self as f32
    }

    #[inline(always)]
    fn all(self) -> ([f32; WIDEST], usize) {
        ([self as f32; WIDEST], 1)
    }

    #[inline(always)]
    fn from_face(p: [f64; 3], face: &Face, sides: &Sides) -> f64 {
        on_face(sides.wide(), face.seen_from(p)).closest.square
    }
}

impl<S: Simd> Packet for F32<S> {
    const STILL: f64 = 2e-3;
    const SLIM: f64 = 1e-6;
    const EPSILON: f64 = f32::EPSILON as f64;

    #[inline(always)]
    fn below(self, other: Self) -> u64 {
        self.0.simd_lt(other.0).to_bitmask()
    }

    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[S::f32s::LEN / 2]
    }

    #[inline(always)]
    fn all(self) -> ([f32; WIDEST], usize) {
        let mut all = [0.0; WIDEST];
        self.0.store_slice(&mut all[..S::f32s::LEN]);
        (all, S::f32s::LEN)
    }

    #[inline(always)]
    fn from_face(p: [Self; 3], face: &Face, _: &Sides) -> Self {
        Plane::single(face).square(p)
    }

    #[inline(always)]
    fn from_near_face(p: [Self; 3], face: &Face, _: &Sides, most: Self) -> Option<Self> {
        Plane::single(face).square_below(p, most)
    }
}

impl<S: Simd> Packet for F64<S> {
    const STILL: f64 = 1e-4;
    const SLIM: f64 = 1e-12;
    const EPSILON: f64 = f64::EPSILON;

    #[inline(always)]
    fn below(self, other: Self) -> u64 {
        self.0.simd_lt(other.0).to_bitmask()
    }

    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[S::f64s::LEN / 2] as f32
    }

    #[inline(always)]
    fn all(self) -> ([f32; WIDEST], usize) {
        let mut all = [0.0; WIDEST];
        for (to, from) in all.iter_mut().zip(self.0.as_slice()) {
            *to = *from as f32;
        }
        (all, S::f64s::LEN)
    }

    #[inline(always)]
    fn from_face(p: [Self; 3], face: &Face, sides: &Sides) -> Self {
        double::square(face, sides, p, Self::SLIM)
    }
}

/// Two vectors of points go through the hierarchy together: boxes are read once for both.
impl<T: Packet + Lanes> Packet for Twice<T> {
    const STILL: f64 = T::STILL;
    const SLIM: f64 = T::SLIM;
    const EPSILON: f64 = T::EPSILON;

    #[inline(always)]
    fn below(self, other: Self) -> u64 {
        self.0.below(other.0) | self.1.below(other.1) << T::WIDTH
    }

    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.any_below(other.0) | self.1.any_below(other.1)
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.1.one()
    }

    #[inline(always)]
    fn all(self) -> ([f32; WIDEST], usize) {
        let (mut all, count) = self.0.all();
        let (others, more) = self.1.all();
        all[count..count + more].copy_from_slice(&others[..more]);
        (all, count + more)
    }

    #[inline(always)]
    fn from_face([x, y, z]: [Self; 3], face: &Face, sides: &Sides) -> Self {
        Twice(T::from_face([x.0, y.0, z.0], face, sides), T::from_face([x.1, y.1, z.1], face, sides))
    }

    #[inline(always)]
    fn from_near_face([x, y, z]: [Self; 3], face: &Face, sides: &Sides, most: Self) -> Option<Self> {
        let first = T::from_near_face([x.0, y.0, z.0], face, sides, most.0);
        let second = T::from_near_face([x.1, y.1, z.1], face, sides, most.1);
        let far = x.0.lift(f64::from(f32::MAX));
        match (first, second) {
            (None, None) => None,
            (first, second) => Some(Twice(first.unwrap_or(far), second.unwrap_or(far))),
        }
    }
}
