//! The transfer of sRGB: between radiance and what the bytes of a picture stand for.
//!
//! ```text
//!   c = 12.92·l                  where l ≤ 0.0031308
//!   c = 1.055·l^(1/2.4) − 0.055  elsewhere; a byte is 255·c, rounded
//! ```
//!
//! Pictures have millions of numbers to turn into bytes, and few to turn back: bytes come from a
//! table, powers do the rest. The table divides every octave of `l` into equal steps so small that
//! the byte changes at most once within each:
//!
//! ```text
//!   byte       |        .---       128 steps an octave: from ½ to 1, where bytes follow one
//!              |   .----'          another fastest for the width of a step, 0.66 bytes are
//!              |---'  |            passed within one
//!              +--+---|--+--- l
//!                 |  next|         within the step: code, and from `next` on code + 1
//! ```
//!
//! Source: IEC 61966-2-1.

use std::sync::LazyLock;

/// From sRGB to linear.
pub(crate) fn to_linear(c: f32) -> f32 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// From linear to sRGB.
pub(crate) fn from_linear(c: f32) -> f32 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// The byte that is nearest to the sRGB of a linear number: 0 for what is negative or not a number,
/// 255 for what is beyond 1.
#[inline]
pub(crate) fn to_byte(light: f32) -> u8 {
    if light.is_nan() || light < LEAST {
        return 0;
    }
    let light = light.min(1.0);
    let Step { code, next } = STEPS[((light.to_bits() - LEAST.to_bits()) >> STEP_BITS) as usize];
    code + u8::from(light >= next)
}

/// The first number of the table, 2⁻¹³: less is nearer to byte 0 than to 1.
const LEAST: f32 = 1.0 / 8192.0;

/// Bits of a number that are the same throughout a step: the sign, the exponent and 7 more.
const STEP_BITS: u32 = 16;

/// Part of an octave.
#[derive(Clone, Copy)]
struct Step {
    /// The byte of its first number.
    code: u8,
    /// The first number, here or later, that has the next byte.
    next: f32,
}

/// The steps from [`LEAST`] to 1, which has one of its own.
static STEPS: LazyLock<Vec<Step>> = LazyLock::new(|| {
    // The first numbers of bytes 1 to 255.
    let firsts: Vec<f32> = (1..=255u8).map(first).collect();
    let starts = (LEAST.to_bits()..=1.0f32.to_bits()).step_by(1 << STEP_BITS).map(f32::from_bits);
    let step = |start: f32| {
        let code = firsts.partition_point(|first| *first <= start);
        Step { code: code as u8, next: firsts.get(code).copied().unwrap_or(f32::INFINITY) }
    };
    starts.map(step).collect()
});

/// The least number of single precision whose nearest byte is `byte`, which is not 0.
fn first(byte: u8) -> f32 {
    let c = (f64::from(byte) - 0.5) / 255.0;
    let exact = if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let near = exact as f32;
    if f64::from(near) < exact { near.next_up() } else { near }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula in double precision.
    fn exact(light: f32) -> u8 {
        let l = f64::from(light).clamp(0.0, 1.0);
        let c = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
        (255.0 * c).round() as u8
    }

    #[test]
    fn bytes_are_the_formula_rounded() {
        // About every 1000th number, of all sizes.
        for bits in (0..1.01f32.to_bits()).step_by(997) {
            let light = f32::from_bits(bits);
            assert_eq!(to_byte(light), exact(light), "{light}");
        }
        // All numbers about those where bytes change.
        for byte in 1..=255 {
            let bits = first(byte).to_bits();
            for light in (bits - 300..bits + 300).map(f32::from_bits) {
                assert_eq!(to_byte(light), exact(light), "{light}");
                assert_eq!(to_byte(light), if light < first(byte) { byte - 1 } else { byte });
            }
        }
        // And about those where steps begin.
        for bits in (LEAST.to_bits()..=1.0f32.to_bits()).step_by(1 << STEP_BITS) {
            for light in [bits - 1, bits, bits + 1].map(f32::from_bits) {
                assert_eq!(to_byte(light), exact(light), "{light}");
            }
        }
    }

    #[test]
    fn bytes_of_what_is_no_light() {
        let odd = [f32::NAN, f32::NEG_INFINITY, -1.0, -0.0, 1.5, f32::INFINITY];
        assert_eq!(odd.map(to_byte), [0, 0, 0, 0, 255, 255]);
    }

    #[test]
    fn a_byte_changes_at_most_once_within_a_step() {
        let codes = STEPS.iter().map(|step| step.code);
        assert!(codes.clone().zip(codes.skip(1)).all(|(one, next)| next - one <= 1));
    }
}
