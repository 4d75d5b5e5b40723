//! Signs of many numbers at once, as the bits of a word.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// Numbers that [`signs`] looks at together.
pub const STRIP: usize = 8;

/// Which of the first `count` numbers (up to 64) are above `doubt`, and which are within ±`doubt`;
/// NaN is neither. There must be room behind them for whole strips: what is there gives bits
/// beyond.
pub fn signs(numbers: &[f32], count: usize, doubt: f32) -> [u64; 2] {
    crate::on_level!(simd => signs_on(simd, numbers, count, doubt))
}

#[inline(always)]
fn signs_on<S: Simd>(simd: S, numbers: &[f32], count: usize, doubt: f32) -> [u64; 2] {
    let (mut above, mut within) = (0, 0);
    let (doubt, below) = (f32x8::splat(simd, doubt), f32x8::splat(simd, -doubt));
    let strips = numbers.chunks_exact(STRIP).take(count.min(64).div_ceil(STRIP));
    for (number, strip) in strips.enumerate() {
        let strip = f32x8::from_slice(simd, strip);
        let is_above = strip.simd_gt(doubt).to_bitmask();
        let is_within = strip.simd_le(doubt).to_bitmask() & strip.simd_ge(below).to_bitmask();
        above |= is_above << (number * STRIP);
        within |= is_within << (number * STRIP);
    }
    [above, within]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_those_of_the_numbers() {
        let mut numbers: Vec<f32> = (0..72).map(|i| ((i * 37 % 64) as f32 - 32.0) / 32.0).collect();
        numbers[5] = f32::NAN;
        for count in [1, 8, 17, 64] {
            let [above, within] = signs(&numbers, count, 0.25);
            for (i, v) in numbers[..count].iter().enumerate() {
                assert_eq!(above >> i & 1 == 1, *v > 0.25, "{i} {v}");
                assert_eq!(within >> i & 1 == 1, v.abs() <= 0.25, "{i} {v}");
            }
        }
    }
}
