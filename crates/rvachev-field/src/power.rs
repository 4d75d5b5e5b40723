//! Signed powers of sines and cosines.
//!
//! In double precision `cos(π/2)` is 6·10⁻¹⁷, and `(6·10⁻¹⁷)^0.1` is 0.024: a pole that ought to
//! be a point would be a hole. So what is raised to a power here comes from
//! [`Angle::sin_cos`](crate::Angle::sin_cos), which is exact at quarter turns.

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
    use rvachev_num::turns;

    #[test]
    fn powers_of_quarter_turns_are_exact() {
        for quarter in -9i32..=9 {
            let (sin, cos) = turns(0.25 * f64::from(quarter)).sin_cos();
            for p in [0.05, 0.3, 1.0, 2.5] {
                let (a, b) = (signed_power(sin, p), signed_power(cos, p));
                assert!(a * b == 0.0 && a.abs() + b.abs() == 1.0, "{quarter} {p}");
                assert_eq!((sign(a), sign(b)), (sign(sin), sign(cos)));
            }
        }
        assert_eq!([signed_power(-4.0, 0.5), signed_power(-0.0, 0.3)], [-2.0, 0.0]);
    }
}
