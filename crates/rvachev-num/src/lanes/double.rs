//! Lanes of `f64`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::prelude::*;

use super::ops::{native_methods, norm_methods, operators, polynomial, polynomial_of};
use super::{Lanes, LogSpace, angle, norms};
use crate::{Norm, NormKind, Real};

/// A native vector of `f64` on the SIMD level `S`.
#[derive(Clone, Copy, Debug)]
pub struct F64<S: Simd>(pub S::f64s);

/// The bits of 1.
const ONE: u64 = 0x3ff0_0000_0000_0000;

/// The bits of √½: mantissas are taken from [√½, √2).
const SQRT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// The exponent field.
const EXPONENT: u64 = 0x7ff0_0000_0000_0000;

/// The largest exponent field of a finite number.
const LARGEST: u64 = 0x7fe0_0000_0000_0000;

/// 2⁵²: an integer below it that is or-ed into its bits makes their sum. (Below AVX-512
/// there is no conversion of 64-bit integers.)
const INTEGER: f64 = 4_503_599_627_370_496.0;

/// 1.5 · 2⁵²: adding it rounds to an integer, which the low bits of the sum then hold.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Where a weight stops falling, a little above the smallest normal number's logarithm.
const LOWEST: f64 = -1000.0;

operators!(F64, f64);

impl<S: Simd> Real for F64<S> {
    native_methods!(F64, f64);
    norm_methods!();

    /// Absolute error 3·10⁻¹⁶ on [½, 2], elsewhere that and half a unit in the last place;
    /// exact at powers of 2. −10⁵ at 0 and for subnormal numbers.
    #[inline(always)]
    fn log2(self) -> Self {
        let one = F64(S::f64s::splat(self.0.token(), 1.0));
        self.log2_over(one).log_vanish_with(self)
    }

    /// Relative error 3·10⁻¹⁶; 0 below −1022, `f64::MAX` from 1024 on.
    #[inline(always)]
    fn exp2(self) -> Self {
        let simd = self.0.token();
        let x = self.0.max(-1022.0).min(1_023.999_999_999);
        let value = F64::<S>(x).exp2_within().0;
        let value = self.0.simd_lt(-1022.0).select(S::f64s::splat(simd, 0.0), value);
        F64(self.0.simd_ge(1024.0).select(S::f64s::splat(simd, f64::MAX), value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = angle::sin_cos_f64::<S>(self.0);
        (F64(sin), F64(cos))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        F64(angle::atan2_f64::<S>(self.0, x.0))
    }
}

impl<S: Simd> LogSpace for F64<S> {
    const LOG2_OF_ZERO: f64 = crate::float::LOG2_OF_ZERO;

    #[inline(always)]
    fn power_below(self) -> Self {
        let bits: S::u64s = self.0.bitcast();
        F64((bits & EXPONENT).bitcast())
    }

    #[inline(always)]
    fn power_recip(self) -> Self {
        let bits: S::u64s = self.0.bitcast();
        let recip: S::f64s = (S::u64s::splat(self.0.token(), 2 * ONE) - bits).bitcast();
        F64(recip.max(f64::MIN_POSITIVE))
    }

    /// Absolute error 2·10⁻¹⁶ and one rounding. With `s = (m − 1)/(m + 1)` the logarithm of
    /// the mantissa is `2 artanh(s) / ln 2`, an odd series.
    #[inline(always)]
    fn log2_over(self, power: Self) -> Self {
        let bits: S::u64s = self.0.bitcast();
        let power: S::u64s = power.0.bitcast();
        let above = bits + (ONE - SQRT_HALF);
        // A bias keeps the exponent's difference positive, as an unsigned shift wants it.
        let biased = (above + LARGEST - power) >> 52;
        let exponent: S::f64s = (biased | INTEGER.to_bits()).bitcast();
        let exponent = exponent - (INTEGER + (LARGEST >> 52) as f64);
        let mantissa: S::f64s = ((above & !EXPONENT & (u64::MAX >> 1)) + SQRT_HALF).bitcast();
        let s = (mantissa - 1.0) / (mantissa + 1.0);
        let z = s * s;
        let series = polynomial!(
            z,
            2.885_390_081_777_926_8,
            0.961_796_693_925_985_3,
            0.577_078_016_347_141_1,
            0.412_198_585_577_535_8,
            0.320_598_556_793_123_05,
            0.262_333_380_728_162_1,
            0.220_935_049_357_348_45,
            0.213_460_418_455_359_4
        );
        F64(s.mul_add(series, exponent))
    }

    /// Relative error 3·10⁻¹⁶; exact at integers.
    #[inline(always)]
    fn exp2_within(self) -> Self {
        let rounded = self + ROUND;
        let r = (self - (rounded - ROUND)).0;
        let mantissa = polynomial!(
            r,
            1.0,
            std::f64::consts::LN_2,
            0.240_226_506_959_100_97,
            0.055_504_108_664_821_66,
            0.009_618_129_107_606_887,
            0.001_333_355_814_639_599_5,
            0.000_154_035_304_417_387_98,
            1.525_273_385_328_140_8e-5,
            1.321_544_258_640_742_7e-6,
            1.017_805_173_050_61e-7,
            7.072_586_223_078_746e-9,
            4.456_674_751_252_341_6e-10
        );
        F64::<S>(mantissa).times_power(rounded)
    }

    #[inline(always)]
    fn exp2_weight(self) -> Self {
        self.max(self.lift(LOWEST)).exp2_within()
    }

    #[inline(always)]
    fn times_power(self, rounded: Self) -> Self {
        let bits: S::u64s = self.0.bitcast();
        let n: S::u64s = rounded.0.bitcast();
        F64((bits + (n << 52)).bitcast())
    }

    /// Absolute error 3·10⁻¹⁶/p and one rounding: the series of the logarithm in
    /// `s = t/(2 + t)`.
    #[inline(always)]
    fn join<T: LogSpace>(a: T, b: T, p: f64, inv: f64) -> T {
        let t = ((a - b).abs() * -p).exp2_weight();
        let s = t / (t + 2.0);
        let z = s * s;
        let series = polynomial_of!(
            z,
            2.885_390_081_777_926_8,
            0.961_796_693_925_970_3,
            0.577_078_016_357_853_8,
            0.412_198_582_771_022_9,
            0.320_598_923_186_475,
            0.262_307_117_954_269_9,
            0.221_981_136_936_944_85,
            0.191_892_486_641_247_4,
            0.174_653_904_654_705_65,
            0.120_322_232_147_556_58,
            0.245_526_147_435_741_7
        );
        (s * inv).mul_add(series, a.max(b))
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        F64(self.0.copysign(sign.0))
    }

    #[inline(always)]
    fn vanish_with(self, key: Self) -> Self {
        let zero = S::f64s::splat(self.0.token(), 0.0);
        F64(key.0.simd_lt(f64::MIN_POSITIVE).select(zero, self.0))
    }

    #[inline(always)]
    fn log_vanish_with(self, key: Self) -> Self {
        let log = S::f64s::splat(self.0.token(), Self::LOG2_OF_ZERO);
        F64(key.0.simd_lt(f64::MIN_POSITIVE).select(log, self.0))
    }

    #[inline(always)]
    fn above(self, other: Self) -> Self {
        let simd = self.0.token();
        let tie = S::f64s::splat(simd, 0.5);
        let not_below = self.0.simd_gt(other.0).select(S::f64s::splat(simd, 1.0), tie);
        F64(self.0.simd_lt(other.0).select(S::f64s::splat(simd, 0.0), not_below))
    }

    #[inline(always)]
    fn finite(self) -> Self {
        F64(self.0.min(f64::MAX))
    }
}

impl<S: Simd> Lanes for F64<S> {
    type Element = f64;
    type Token = S;
    const WIDTH: usize = S::f64s::LEN;

    #[inline(always)]
    fn splat(simd: S, c: f64) -> Self {
        F64(S::f64s::splat(simd, c))
    }

    #[inline(always)]
    fn load(simd: S, from: &[f64]) -> Self {
        F64(S::f64s::from_slice(simd, from))
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.0.store_slice(to);
    }
}
