//! Numbers of one point or of several: what a search asks of them beyond arithmetic.

use fearless_simd::prelude::*;
use rvachev_num::Real;
use rvachev_num::lanes::{F32, F64, LogSpace, Twice};

/// One point's number, or those of a packet of points.
pub(super) trait Packet: Real {
    /// Whether any number is below its counterpart.
    fn any_below(self, other: Self) -> bool;

    /// The number of one of the points.
    fn one(self) -> f32;

    /// The numbers of some of the points, from the first to the last.
    fn few(self) -> [f32; 4];
}

impl Packet for f64 {
    #[inline(always)]
    fn any_below(self, other: f64) -> bool {
        self < other
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self as f32
    }

    #[inline(always)]
    fn few(self) -> [f32; 4] {
        [self as f32; 4]
    }
}

impl<S: Simd> Packet for F32<S> {
    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[S::f32s::LEN / 2]
    }

    #[inline(always)]
    fn few(self) -> [f32; 4] {
        let all = self.0.as_slice();
        let last = S::f32s::LEN - 1;
        [all[0], all[last / 3], all[2 * last / 3], all[last]]
    }
}

impl<S: Simd> Packet for F64<S> {
    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[S::f64s::LEN / 2] as f32
    }

    #[inline(always)]
    fn few(self) -> [f32; 4] {
        let all = self.0.as_slice();
        let last = S::f64s::LEN - 1;
        [all[0] as f32, all[last / 3] as f32, all[2 * last / 3] as f32, all[last] as f32]
    }
}

impl<T: Packet + LogSpace> Packet for Twice<T> {
    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.any_below(other.0) | self.1.any_below(other.1)
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.1.one()
    }

    #[inline(always)]
    fn few(self) -> [f32; 4] {
        let ([a, _, _, b], [c, _, _, d]) = (self.0.few(), self.1.few());
        [a, b, c, d]
    }
}
