//! Exponential, logarithm, sine and cosine of single numbers, without a branch: the compiler makes
//! vectors of the loops that call them. Library functions are calls, one a number.
//!
//! ```text
//!     sin x    x = k·π + r, |r| ≤ π/2           ±1 times the series of the sine of r; in double
//!              x = k·π/2 + r, |r| ≤ π/4         precision that of the sine or of the cosine
//!     exp x    x = k·ln 2 + r, |r| ≤ ln 2 / 2   2^k times the series of the exponential of r
//!     ln x     x = 2^k·m, √½ ≤ m < √2           k·ln 2 + 2 artanh s, s = (m − 1)/(m + 1)
//! ```
//!
//! k is rounded by adding 1.5 times the power of two from which on floats are whole, which puts it
//! into the low bits. π and ln 2 are subtracted in pieces, multiples of all but the last exactly.
//!
//! The functions of single precision keep within 2 units in the last place (sine and cosine within
//! 1.8·10⁻⁷ of the true value, and exponentials below 10⁻³⁷ within 2·10⁻³⁸), those of double
//! precision within 2 of the library's.

/// Functions of single precision. Here products are fused with sums: they are run on vectors only.
pub(super) mod single {
    use std::f32::consts::{FRAC_1_PI, LOG2_E, PI};

    /// 1.5 · 2²³.
    const ROUND: f32 = 12_582_912.0;

    /// What π and ln 2 are more than their nearest numbers.
    const PI_REST: f32 = -8.742_278e-8;
    const LN_2_REST: f32 = -1.904_654_2e-9;

    /// Larger angles have a sine and a cosine in [−1, 1], but not their own.
    pub(in super::super) const LARGEST_ANGLE: f64 = 1e5;

    /// A little above π/2.
    const MOST: f32 = 1.58;

    /// The sine of `x − kπ`, with the sign of even or odd `shifted`.
    #[inline(always)]
    fn wave(x: f32, k: f32, shifted: f32) -> f32 {
        let r = k.mul_add(-PI_REST, k.mul_add(-PI, x));
        // NaN stays.
        let r = if r > MOST { MOST } else { r };
        let r = if r < -MOST { -MOST } else { r };
        let z = r * r;
        let series = z.mul_add(2.632_378_4e-6, -0.000_198_219_98);
        let series = z.mul_add(z.mul_add(series, 0.008_333_237), -0.166_666_66);
        let sin = (r * z).mul_add(series, r);
        f32::from_bits(sin.to_bits() ^ shifted.to_bits() << 31)
    }

    #[inline(always)]
    pub(in super::super) fn sin(x: f32) -> f32 {
        let shifted = x.mul_add(FRAC_1_PI, ROUND);
        wave(x, shifted - ROUND, shifted)
    }

    #[inline(always)]
    pub(in super::super) fn cos(x: f32) -> f32 {
        // The sine of half a π more: x + π/2 = (k + ½)π + r, k odd or even.
        let shifted = x.mul_add(FRAC_1_PI, 0.5) + ROUND;
        wave(x, (shifted - ROUND) - 0.5, shifted)
    }

    pub(in super::super) use self::{cos as cos_near, sin as sin_near};

    /// No angle is too large.
    #[inline(always)]
    pub(in super::super) fn are_near(_angles: &[f32]) -> bool {
        true
    }

    #[inline(always)]
    pub(in super::super) fn exp(x: f32) -> f32 {
        let shifted = x.mul_add(LOG2_E, ROUND);
        let k = shifted - ROUND;
        let r = k.mul_add(-LN_2_REST, k.mul_add(-std::f32::consts::LN_2, x));
        let series = r.mul_add(r.mul_add(0.001_392_626_8, 0.008_363_247), 0.041_666_556);
        let series = r.mul_add(r.mul_add(series, 0.166_665_77), 0.5);
        let series = (r * r).mul_add(series, r) + 1.0;
        // k is in the low bits, and goes to the exponent.
        let value = f32::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << 23));
        // What would be less than the least normal number is 0. NaN stays.
        let value = if x < -87.33 { 0.0 } else { value };
        let value = if x > 88.722_84 { f32::INFINITY } else { value };
        if x.is_nan() { x } else { value }
    }

    #[inline(always)]
    #[expect(clippy::cast_precision_loss, reason = "exponents are small")]
    pub(in super::super) fn ln(x: f32) -> f32 {
        const ROOT_HALF: i32 = 0x3f35_04f3;
        let tiny = x < f32::MIN_POSITIVE;
        let bits = (if tiny { x * 33_554_432.0 } else { x }).to_bits().cast_signed();
        let k = bits.wrapping_sub(ROOT_HALF) >> 23;
        let m = f32::from_bits(bits.wrapping_sub(k << 23).cast_unsigned());
        let k = k as f32 - if tiny { 25.0 } else { 0.0 };
        let f = m - 1.0;
        let s = f / (2.0 + f);
        let z = s * s;
        let rest = z * z.mul_add(z.mul_add(0.295_804, 0.399_887_7), 0.666_666_85);
        // 2s = f − s·f, which leaves small corrections of f alone.
        let value = k.mul_add(std::f32::consts::LN_2, (f - s * (f - rest)) + k * LN_2_REST);
        let value = if x < f32::INFINITY { value } else { x };
        let below = if x == 0.0 { f32::NEG_INFINITY } else { f32::NAN };
        if x > 0.0 { value } else { below }
    }
}

/// Functions of double precision. Nothing is fused: a number alone and one of a vector have the
/// same function, to the bit.
pub(super) mod double {
    use std::f64::consts::FRAC_2_PI;

    /// 1.5 · 2⁵².
    const ROUND: f64 = 6_755_399_441_055_744.0;

    /// π/2 in three pieces, the first two of 33 bits.
    const QUARTER: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

    /// ln 2 in two pieces, the first of 32 bits.
    const LN_2: [f64; 2] = [0.693_147_180_601_954_5, -4.200_915_072_681_084_6e-11];

    /// Angles that are reduced here: beyond, the library does it.
    pub(in super::super) const LARGEST_ANGLE: f64 = 1e6;

    /// The sine of an angle that is `turned` quadrants further.
    #[inline(always)]
    fn wave(x: f64, turned: u64) -> f64 {
        let shifted = x * FRAC_2_PI + ROUND;
        let k = shifted - ROUND;
        let r = ((x - k * QUARTER[0]) - k * QUARTER[1]) - k * QUARTER[2];
        let quadrant = shifted.to_bits().wrapping_add(turned);
        let z = r * r;
        let sin = -1.0 / 5040.0
            + z * (1.0 / 362_880.0
                + z * (-1.0 / 39_916_800.0
                    + z * (1.0 / 6_227_020_800.0
                        + z * (-1.0 / 1_307_674_368_000.0 + z * (1.0 / 355_687_428_096_000.0)))));
        let sin = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * sin));
        let cos = -1.0 / 720.0
            + z * (1.0 / 40_320.0
                + z * (-1.0 / 3_628_800.0
                    + z * (1.0 / 479_001_600.0 + z * (-1.0 / 87_178_291_200.0 + z * (1.0 / 20_922_789_888_000.0)))));
        let cos = 1.0 + z * (-0.5 + z * (1.0 / 24.0 + z * cos));
        let value = if quadrant & 1 == 1 { cos } else { sin };
        f64::from_bits(value.to_bits() ^ (quadrant & 2) << 62)
    }

    /// The sine of an angle up to the largest one.
    #[inline(always)]
    pub(in super::super) fn sin_near(x: f64) -> f64 {
        wave(x, 0)
    }

    /// Its cosine.
    #[inline(always)]
    pub(in super::super) fn cos_near(x: f64) -> f64 {
        wave(x, 1)
    }

    #[inline(always)]
    pub(in super::super) fn sin(x: f64) -> f64 {
        if x.abs() > LARGEST_ANGLE { x.sin() } else { sin_near(x) }
    }

    #[inline(always)]
    pub(in super::super) fn cos(x: f64) -> f64 {
        if x.abs() > LARGEST_ANGLE { x.cos() } else { cos_near(x) }
    }

    /// Whether all angles are reduced here.
    #[inline(always)]
    pub(in super::super) fn are_near(angles: &[f64]) -> bool {
        let mut far = false;
        for angle in angles {
            far |= angle.abs() > LARGEST_ANGLE;
        }
        !far
    }

    #[inline(always)]
    pub(in super::super) fn exp(x: f64) -> f64 {
        const FACTORIALS: [f64; 11] = [
            1.0 / 6_227_020_800.0,
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
        ];
        // Beyond these it is infinite and 0.
        let x = if x > 710.0 { 710.0 } else { x };
        let x = if x < -746.0 { -746.0 } else { x };
        let shifted = x * std::f64::consts::LOG2_E + ROUND;
        let k = shifted - ROUND;
        let r = (x - k * LN_2[0]) - k * LN_2[1];
        let mut tail = FACTORIALS[0];
        let mut at = 1;
        while at < FACTORIALS.len() {
            tail = FACTORIALS[at] + r * tail;
            at += 1;
        }
        let series = 1.0 + (r + r * r * (0.5 + r * tail));
        let k = shifted.to_bits().cast_signed().wrapping_sub(ROUND.to_bits().cast_signed());
        // Numbers of 12 bits: halved without an arithmetic shift, which vectors of words lack.
        let half = (k.wrapping_add(4096).cast_unsigned() >> 1).cast_signed().wrapping_sub(2048);
        let power = |n: i64| f64::from_bits(n.wrapping_add(1023).cast_unsigned() << 52);
        series * power(half) * power(k.wrapping_sub(half))
    }

    #[inline(always)]
    pub(in super::super) fn ln(x: f64) -> f64 {
        const ROOT_HALF: i64 = 0x3fe6_a09e_667f_3bcd;
        const ODD: [f64; 10] = [
            2.0 / 21.0,
            2.0 / 19.0,
            2.0 / 17.0,
            2.0 / 15.0,
            2.0 / 13.0,
            2.0 / 11.0,
            2.0 / 9.0,
            2.0 / 7.0,
            2.0 / 5.0,
            2.0 / 3.0,
        ];
        let tiny = x < f64::MIN_POSITIVE;
        let bits = (if tiny { x * 18_014_398_509_481_984.0 } else { x }).to_bits().cast_signed();
        let k = bits.wrapping_sub(ROOT_HALF) >> 52;
        let m = f64::from_bits(bits.wrapping_sub(k << 52).cast_unsigned());
        let k = f64::from_bits(ROUND.to_bits().wrapping_add(k.cast_unsigned())) - ROUND;
        let k = k - if tiny { 54.0 } else { 0.0 };
        let f = m - 1.0;
        let s = f / (2.0 + f);
        let z = s * s;
        let mut rest = ODD[0];
        let mut at = 1;
        while at < ODD.len() {
            rest = ODD[at] + z * rest;
            at += 1;
        }
        let value = k * LN_2[0] + ((f - s * (f - z * rest)) + k * LN_2[1]);
        let value = if x < f64::INFINITY { value } else { x };
        let below = if x == 0.0 { f64::NEG_INFINITY } else { f64::NAN };
        if x > 0.0 { value } else { below }
    }
}

#[cfg(test)]
mod tests {
    use super::{double, single};

    /// Numbers of all sizes and signs, and what is special.
    fn numbers(count: u32) -> impl Iterator<Item = f64> {
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(9).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let special = [0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 4e-320, 1e-40, 88.7, 89.0, -87.4, -103.9, 709.7, -745.0];
        let sized = move |n: u32| (random(2 * n) * 2.0 - 1.0) * 2f64.powf(random(2 * n + 1) * 60.0 - 30.0);
        special.into_iter().chain((0..count).map(sized)).chain((0..count).map(move |n| 0.5 + 1.5 * random(n)))
    }

    /// The distance to the true value in units in the last place of single precision.
    fn units(found: f32, truth: f64) -> f64 {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest number")]
        let nearest = truth as f32;
        if found == nearest || found.is_nan() && truth.is_nan() {
            return 0.0;
        }
        (f64::from(found) - truth).abs() / f64::from(nearest.abs().next_up() - nearest.abs())
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "arguments in single precision")]
    fn single_precision_is_within_two_units() {
        for x in numbers(200_000) {
            let x = x as f32;
            let wide = f64::from(x);
            let off = (f64::from(single::exp(x)) - wide.exp()).abs();
            assert!(units(single::exp(x), wide.exp()) <= 1.5 || off < 2e-38, "exp {x}");
            assert!(units(single::ln(x), wide.ln()) <= 2.0, "ln {x}: {} {}", single::ln(x), wide.ln());
            if wide.abs() <= single::LARGEST_ANGLE {
                assert!((f64::from(single::sin(x)) - wide.sin()).abs() <= 1.8e-7, "sin {x}");
                assert!((f64::from(single::cos(x)) - wide.cos()).abs() <= 1.8e-7, "cos {x}");
                assert!(units(single::sin(x), wide.sin()) <= 2.0 || wide.abs() > 1e3, "sin {x}");
            } else {
                assert!(single::sin(x).abs() <= 1.0 && single::cos(x).abs() <= 1.0, "{x}");
            }
        }
    }

    #[test]
    fn double_precision_is_within_two_units_of_the_library() {
        let units = |found: f64, library: f64| match found == library || found.is_nan() && library.is_nan() {
            true => 0.0,
            false => (found - library).abs() / (library.abs().next_up() - library.abs()),
        };
        for x in numbers(200_000) {
            assert!(units(double::exp(x), x.exp()) <= 2.0, "exp {x}: {} {}", double::exp(x), x.exp());
            assert!(units(double::ln(x), x.ln()) <= 2.0, "ln {x}: {} {}", double::ln(x), x.ln());
            assert!((double::sin(x) - x.sin()).abs() <= 2.3e-16, "sin {x}: {} {}", double::sin(x), x.sin());
            assert!((double::cos(x) - x.cos()).abs() <= 2.3e-16, "cos {x}: {} {}", double::cos(x), x.cos());
            assert!(units(double::sin(x), x.sin()) <= 2.0 || x.abs() > 1.0, "sin {x}");
        }
    }

    #[test]
    fn what_is_special_is_as_in_the_library() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0] {
            #[expect(clippy::cast_possible_truncation, reason = "special numbers are the same")]
            let y = x as f32;
            let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
            assert!(same(double::exp(x), x.exp()) && same(double::ln(x), x.ln()), "{x}");
            assert!(same(double::sin(x), x.sin()) || x == -1.0 && (double::sin(x) - x.sin()).abs() < 2e-16, "{x}");
            assert!(same(single::ln(y).into(), x.ln()), "{x}");
            assert!(same(single::exp(y).into(), y.exp().into()) || x == -1.0, "{x}");
            assert!(single::sin(y).is_nan() == x.sin().is_nan() && single::cos(y).is_nan() == x.cos().is_nan(), "{x}");
        }
        assert_eq!(single::ln(1.0), 0.0);
        assert_eq!(double::ln(1.0), 0.0);
        assert_eq!((single::sin(0.0), single::cos(0.0), single::exp(0.0)), (0.0, 1.0, 1.0));
    }
}
