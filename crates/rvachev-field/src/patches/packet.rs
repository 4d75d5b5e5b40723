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
}

impl<S: Simd> Packet for F32<S> {
    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[0]
    }
}

impl<S: Simd> Packet for F64<S> {
    #[inline(always)]
    fn any_below(self, other: Self) -> bool {
        self.0.simd_lt(other.0).any_true()
    }

    #[inline(always)]
    fn one(self) -> f32 {
        self.0.as_slice()[0] as f32
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
}
