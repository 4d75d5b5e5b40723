//! Euler's beta and gamma functions of positive numbers.
//!
//! By Stirling's series, from arguments that `Γ(x + 1) = x Γ(x)` makes large: right to some
//! 10⁻¹⁵ of the logarithm's size.

use std::f64::consts::PI;

/// From here on eight terms of the series are right to the last digits.
const LARGE: f64 = 12.0;

/// B₂ₖ / (2k (2k − 1)) of Bernoulli's numbers.
const SERIES: [f64; 8] = [
    1.0 / 12.0,
    -1.0 / 360.0,
    1.0 / 1260.0,
    -1.0 / 1680.0,
    1.0 / 1188.0,
    -691.0 / 360_360.0,
    1.0 / 156.0,
    -3617.0 / 122_400.0,
];

/// The logarithm of Γ(x), x > 0.
pub(super) fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut product) = (x, 1.0);
    while x < LARGE {
        product *= x;
        x += 1.0;
    }
    let square = 1.0 / (x * x);
    let rest = SERIES.iter().rev().fold(0.0, |sum, term| sum * square + term) / x;
    (x - 0.5) * x.ln() - x + 0.5 * (2.0 * PI).ln() + rest - f64::ln(product)
}

/// B(a, b) = Γ(a) Γ(b) / Γ(a + b).
pub(super) fn beta(a: f64, b: f64) -> f64 {
    (ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_is_right_at_whole_and_half_numbers() {
        let mut factorial = 1.0;
        for n in 1..20 {
            assert!((ln_gamma(f64::from(n)) - f64::ln(factorial)).abs() < 1e-14 * f64::ln(factorial).max(1.0), "{n}");
            factorial *= f64::from(n);
        }
        assert!((ln_gamma(0.5) - 0.5 * PI.ln()).abs() < 1e-14);
        assert!((ln_gamma(1e-3) - 6.907178885383853).abs() < 1e-14);
        // B(a, 1) = 1/a.
        for a in [0.005, 0.3, 1.0, 7.5, 30.0] {
            assert!((beta(a, 1.0) * a - 1.0).abs() < 1e-13, "{a}");
        }
    }
}
