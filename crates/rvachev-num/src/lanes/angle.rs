//! Sine, cosine and arc tangent of lanes.

use fearless_simd::prelude::*;

use super::ops::polynomial;

/// 1.5 · 2²³ (see [`single`](super::single)).
const ROUND_F32: f32 = 12_582_912.0;

/// 1.5 · 2⁵².
const ROUND_F64: f64 = 6_755_399_441_055_744.0;

/// The largest remainder of an angle by π/2, a little above π/4. Angles that are too large
/// to be reduced are cut to it, which keeps sine and cosine in [−1, 1].
const REMAINDER: f64 = 0.79;

/// tan(π/8): tangents up to this one go into the series as they are.
const TAN_EIGHTH: f64 = 0.414_213_562_373_095_03;

/// Sine and cosine, absolute error 1·10⁻⁷ for |x| ≤ 12 000.
///
/// π/2 is subtracted in three pieces, the first two of 11 bits: a multiple of them by up to
/// 2¹³ is exact whether the product is fused or not.
#[inline(always)]
pub(super) fn sin_cos_f32<S: Simd>(x: S::f32s) -> (S::f32s, S::f32s) {
    let shifted = x.mul_add(std::f32::consts::FRAC_2_PI, ROUND_F32);
    let k = shifted - ROUND_F32;
    let r = k.mul_add(-1.570_312_5, x);
    let r = k.mul_add(-0.000_483_751_3, r);
    let r = k.mul_add(-7.549_79e-8, r);
    let r = r.max(-REMAINDER as f32).min(REMAINDER as f32);
    let z = r * r;
    let sin = polynomial!(z, -0.166_666_51, 0.008_331_981_5, -0.000_194_957_6);
    let sin = (r * z).mul_add(sin, r);
    let cos = polynomial!(z, 1.0, -0.5, 0.041_666_646, -0.001_388_730_1, 2.443_067e-5);
    let quadrant: S::u32s = shifted.bitcast();
    let odd = (quadrant & 1).simd_eq(1);
    let sin_bits: S::u32s = odd.select(cos, sin).bitcast();
    let cos_bits: S::u32s = odd.select(sin, cos).bitcast();
    let sin_sign = (quadrant & 2) << 30;
    let cos_sign = ((quadrant + 1) & 2) << 30;
    ((sin_bits ^ sin_sign).bitcast(), (cos_bits ^ cos_sign).bitcast())
}

/// Sine and cosine, absolute error 2·10⁻¹⁶ for |x| ≤ 10⁶ (pieces of 33 bits times 2²⁰).
#[inline(always)]
pub(super) fn sin_cos_f64<S: Simd>(x: S::f64s) -> (S::f64s, S::f64s) {
    let shifted = x.mul_add(std::f64::consts::FRAC_2_PI, ROUND_F64);
    let k = shifted - ROUND_F64;
    let r = k.mul_add(-1.570_796_326_734_125_6, x);
    let r = k.mul_add(-6.077_100_506_303_966e-11, r);
    let r = k.mul_add(-2.022_266_248_795_950_6e-21, r);
    let r = r.max(-REMAINDER).min(REMAINDER);
    let z = r * r;
    let sin = polynomial!(
        z,
        -0.166_666_666_666_666_32,
        0.008_333_333_333_322_444,
        -0.000_198_412_698_298_003_67,
        2.755_731_368_193_788e-6,
        -2.505_075_570_149_317_4e-8,
        1.589_661_705_575_148_2e-10
    );
    let sin = (r * z).mul_add(sin, r);
    let cos = polynomial!(
        z,
        1.0,
        -0.5,
        0.041_666_666_666_666_6,
        -0.001_388_888_888_887_443,
        2.480_158_728_962_483_5e-5,
        -2.755_731_438_312_370_4e-7,
        2.087_572_635_585_186_8e-9,
        -1.135_976_120_296_129_8e-11
    );
    let quadrant: S::u64s = shifted.bitcast();
    let odd = (quadrant & 1).simd_eq(1);
    let sin_bits: S::u64s = odd.select(cos, sin).bitcast();
    let cos_bits: S::u64s = odd.select(sin, cos).bitcast();
    let sin_sign = (quadrant & 2) << 62;
    let cos_sign = ((quadrant + 1) & 2) << 62;
    ((sin_bits ^ sin_sign).bitcast(), (cos_bits ^ cos_sign).bitcast())
}

/// The angle of (x, y): relative error 3·10⁻⁷, also of small angles.
#[inline(always)]
pub(super) fn atan2_f32<S: Simd>(y: S::f32s, x: S::f32s) -> S::f32s {
    use std::f32::consts::{FRAC_PI_2, PI};
    let simd = x.token();
    let (a, b) = (x.abs(), y.abs());
    let (hi, lo) = (a.max(b), a.min(b));
    let hi = hi.simd_eq(0.0).select(S::f32s::splat(simd, 1.0), hi);
    let t = lo / hi;
    let z = t * t;
    let series = polynomial!(
        z,
        -0.333_331_67,
        0.199_941_47,
        -0.142_142_85,
        0.106_792_23,
        -0.075_811_54,
        0.043_560_09,
        -0.016_585_084,
        0.002_975_537
    );
    let angle = (t * z).mul_add(series, t);
    let angle = b.simd_gt(a).select(-angle + FRAC_PI_2, angle);
    let angle = x.simd_lt(0.0).select(-angle + PI, angle);
    // Adding 0 turns −0 into 0: the negative x axis is at π from either side.
    angle.copysign(y + 0.0)
}

/// The angle of (x, y): relative error 6·10⁻¹⁶, also of small angles.
#[inline(always)]
pub(super) fn atan2_f64<S: Simd>(y: S::f64s, x: S::f64s) -> S::f64s {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let simd = x.token();
    let (a, b) = (x.abs(), y.abs());
    let (hi, lo) = (a.max(b), a.min(b));
    let hi = hi.simd_eq(0.0).select(S::f64s::splat(simd, 1.0), hi);
    // Above π/8 the angle is π/4 and that of the vector turned back by π/4.
    let steep = lo.simd_gt(hi * TAN_EIGHTH);
    let t = steep.select(lo - hi, lo) / steep.select(lo + hi, hi);
    let base = steep.select(S::f64s::splat(simd, FRAC_PI_4), S::f64s::splat(simd, 0.0));
    let z = t * t;
    let series = polynomial!(
        z,
        -0.333_333_333_333_302_2,
        0.199_999_999_991_045_34,
        -0.142_857_141_965_157_42,
        0.111_111_067_030_847_29,
        -0.090_907_835_169_706_1,
        0.076_900_831_823_170_63,
        -0.066_412_446_886_424_56,
        0.056_931_563_747_449_8,
        -0.043_608_003_687_299_515,
        0.021_279_828_549_776_156
    );
    let angle = base + (t * z).mul_add(series, t);
    let angle = b.simd_gt(a).select(-angle + FRAC_PI_2, angle);
    let angle = x.simd_lt(0.0).select(-angle + PI, angle);
    angle.copysign(y + 0.0)
}
