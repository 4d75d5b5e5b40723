//! Angles with exact quarter turns, and signed powers of their sines and cosines.
//!
//! In double precision `cos(π/2)` is 6·10⁻¹⁷, and `(6·10⁻¹⁷)^0.1` is 0.024: a pole that ought to
//! be a point would be a hole. So an angle within a few units in the last place of a multiple of
//! π/2 counts as that multiple.

use std::f64::consts::FRAC_PI_2;

/// Sine and cosine, exactly 0 and ±1 at quarter turns; NaN of what is not finite.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    let quarters = (angle / FRAC_PI_2).round();
    let is_quarter = (angle - quarters * FRAC_PI_2).abs() <= 4.0 * f64::EPSILON * angle.abs();
    if !is_quarter {
        return angle.sin_cos();
    }
    match quarters.rem_euclid(4.0) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// `sign(w)·|w|^p`, 0 at 0 for every p ≥ 0.
pub fn signed_power(w: f64, p: f64) -> f64 {
    sign(w) * w.abs().powf(p)
}

/// −1, 0 or 1.
pub fn sign(w: f64) -> f64 {
    if w == 0.0 { 0.0 } else { w.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for quarter in -9..=9 {
            let (sin, cos) = sin_cos(f64::from(quarter) * FRAC_PI_2);
            assert!(sin * cos == 0.0 && sin.abs() + cos.abs() == 1.0, "{quarter}");
        }
        assert_eq!(sin_cos(1e-300), (1e-300, 1.0));
        assert_eq!(sin_cos(1.0), 1f64.sin_cos());
        for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(angle).0.is_nan() && sin_cos(angle).1.is_nan(), "{angle}");
        }
    }
}
