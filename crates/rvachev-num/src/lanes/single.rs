//! Lanes of `f32`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::prelude::*;

use super::ops::{native_methods, norm_methods, operators, polynomial, polynomial_of};
use super::{Lanes, LogSpace, angle, norms};
use crate::{Norm, NormKind, Real};

/// A native vector of `f32` on the SIMD level `S`.
#[derive(Clone, Copy, Debug)]
pub struct F32<S: Simd>(pub S::f32s);

/// The bits of 1.
const ONE: u32 = 0x3f80_0000;

/// The bits of √½: mantissas are taken from [√½, √2).
const SQRT_HALF: u32 = 0x3f35_04f3;

/// The exponent field.
const EXPONENT: u32 = 0x7f80_0000;

/// 1.5 · 2²³: adding it rounds to an integer, which the low bits of the sum then hold.
const ROUND: f64 = 12_582_912.0;

/// Where a weight stops falling, a little above the smallest normal number's logarithm.
const LOWEST: f64 = -125.0;

operators!(F32, f32);

impl<S: Simd> Real for F32<S> {
    native_methods!(F32, f32);
    norm_methods!();

    /// Absolute error 1.4·10⁻⁷ on [½, 2], elsewhere that and half a unit in the last place;
    /// exact at powers of 2. −16384 at 0 and for subnormal numbers.
    #[inline(always)]
    fn log2(self) -> Self {
        let one = F32(S::f32s::splat(self.0.token(), 1.0));
        self.log2_over(one).log_vanish_with(self)
    }

    /// Relative error 1.2·10⁻⁷; 0 below −126, `f32::MAX` from 128 on.
    #[inline(always)]
    fn exp2(self) -> Self {
        let simd = self.0.token();
        let x = self.0.max(-126.0).min(127.999_99);
        let value = F32::<S>(x).exp2_within().0;
        let value = self.0.simd_lt(-126.0).select(S::f32s::splat(simd, 0.0), value);
        F32(self.0.simd_ge(128.0).select(S::f32s::splat(simd, f32::MAX), value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = angle::sin_cos_f32::<S>(self.0);
        (F32(sin), F32(cos))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        F32(angle::atan2_f32::<S>(self.0, x.0))
    }
}

impl<S: Simd> LogSpace for F32<S> {
    const LOG2_OF_ZERO: f64 = -16384.0;

    #[inline(always)]
    fn power_below(self) -> Self {
        let bits: S::u32s = self.0.bitcast();
        F32((bits & EXPONENT).bitcast())
    }

    #[inline(always)]
    fn power_recip(self) -> Self {
        let bits: S::u32s = self.0.bitcast();
        let recip: S::f32s = (S::u32s::splat(self.0.token(), 2 * ONE) - bits).bitcast();
        F32(recip.max(f32::MIN_POSITIVE))
    }

    /// Absolute error 5·10⁻⁸ and one rounding.
    #[inline(always)]
    fn log2_over(self, power: Self) -> Self {
        let bits: S::u32s = self.0.bitcast();
        let power: S::u32s = power.0.bitcast();
        let above = bits - SQRT_HALF;
        let exponent: S::i32s = (above - (power - ONE)).bitcast();
        let exponent: S::f32s = (exponent >> 23).to_float();
        let mantissa: S::f32s = (bits - (above & !0x007f_ffff)).bitcast();
        let f = mantissa - 1.0;
        let series = polynomial!(
            f,
            1.442_694_8,
            -0.721_357_1,
            0.480_938_88,
            -0.360_088_2,
            0.286_717_1,
            -0.250_068_04,
            0.236_836_27,
            -0.145_689_19
        );
        F32(f.mul_add(series, exponent))
    }

    /// Relative error 1·10⁻⁷, nearly all of it rounding; exact at integers.
    #[inline(always)]
    fn exp2_within(self) -> Self {
        let rounded = self + ROUND;
        let r = (self - (rounded - ROUND)).0;
        let mantissa = polynomial!(
            r,
            1.0,
            std::f32::consts::LN_2,
            0.240_226_48,
            0.055_503_6,
            0.009_618_506,
            0.001_339_080_6,
            0.000_153_264_63
        );
        F32::<S>(mantissa).times_power(rounded)
    }

    /// Relative error 2·10⁻⁷.
    #[inline(always)]
    fn exp2_weight(self) -> Self {
        let x = self.max(self.lift(LOWEST));
        let rounded = x + ROUND;
        weight(x - (rounded - ROUND), rounded)
    }

    #[inline(always)]
    fn times_power(self, rounded: Self) -> Self {
        let bits: S::u32s = self.0.bitcast();
        let n: S::u32s = rounded.0.bitcast();
        F32((bits + (n << 23)).bitcast())
    }

    /// Absolute error 2·10⁻⁷/p and one rounding.
    #[inline(always)]
    fn join<T: LogSpace>(a: T, b: T, p: f64, inv: f64) -> T {
        let distance = (a - b).abs().min(a.lift(-LOWEST * inv));
        let rounded = distance.scale_add(-p, a.lift(ROUND));
        let t = weight(distance.scale_add(-p, -rounded + ROUND), rounded);
        let series = polynomial_of!(
            t,
            1.442_689_9,
            -0.721_166_07,
            0.478_685_53,
            -0.347_307_23,
            0.241_876_07,
            -0.137_532_84,
            0.052_065_078,
            -0.009_310_459
        );
        (t * inv).mul_add(series, a.max(b))
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        F32(self.0.copysign(sign.0))
    }

    #[inline(always)]
    fn vanish_with(self, key: Self) -> Self {
        let zero = S::f32s::splat(self.0.token(), 0.0);
        F32(key.0.simd_lt(f32::MIN_POSITIVE).select(zero, self.0))
    }

    #[inline(always)]
    fn log_vanish_with(self, key: Self) -> Self {
        let log = S::f32s::splat(self.0.token(), Self::LOG2_OF_ZERO as f32);
        F32(key.0.simd_lt(f32::MIN_POSITIVE).select(log, self.0))
    }

    #[inline(always)]
    fn above(self, other: Self) -> Self {
        let simd = self.0.token();
        let tie = S::f32s::splat(simd, 0.5);
        let not_below = self.0.simd_gt(other.0).select(S::f32s::splat(simd, 1.0), tie);
        F32(self.0.simd_lt(other.0).select(S::f32s::splat(simd, 0.0), not_below))
    }

    #[inline(always)]
    fn finite(self) -> Self {
        F32(self.0.min(f32::MAX))
    }
}

/// `2^(r + n)` for |r| ≤ ½, n being in the low bits of `rounded`.
#[inline(always)]
fn weight<T: LogSpace>(r: T, rounded: T) -> T {
    let mantissa = polynomial_of!(r, 1.0, 0.693_147_003_65, 0.240_222_47, 0.055_507_11, 0.009_671_292, 0.001_326_953_5);
    mantissa.times_power(rounded)
}

impl<S: Simd> Lanes for F32<S> {
    type Element = f32;
    type Token = S;
    const WIDTH: usize = S::f32s::LEN;

    #[inline(always)]
    fn splat(simd: S, c: f64) -> Self {
        F32(S::f32s::splat(simd, c as f32))
    }

    #[inline(always)]
    fn load(simd: S, from: &[f32]) -> Self {
        F32(S::f32s::from_slice(simd, from))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        self.0.store_slice(to);
    }
}
