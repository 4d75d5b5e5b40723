//! Numbers as people read them: by significant figures, whatever their size.

/// A number to so many significant figures, without trailing zeros; very large and very small ones
/// by a power of ten.
///
/// ```
/// use rvachev_num::figures;
///
/// assert_eq!(figures(2.0000000003, 6), "2");
/// assert_eq!(figures(-1234.5678, 6), "-1234.57");
/// assert_eq!(figures(4.18879e-18, 4), "4.189e-18");
/// ```
#[must_use]
pub fn figures(value: f64, count: usize) -> String {
    figures_beside(value, value, count)
}

/// The same, as many as a number as large as `size` would have: what is 0 but for rounding beside
/// that reads 0.
///
/// ```
/// use rvachev_num::figures_beside;
///
/// assert_eq!(figures_beside(3e-15, 20.0, 6), "0");
/// assert_eq!(figures_beside(1.23456, 200.0, 6), "1.235");
/// ```
#[must_use]
pub fn figures_beside(value: f64, size: f64, count: usize) -> String {
    /// From this power of ten on, and below that one, powers are written.
    const LARGE: i32 = 9;
    const SMALL: i32 = -5;
    if !value.is_finite() {
        return format!("{value}");
    }
    let size = size.abs().max(value.abs());
    if value == 0.0 || !size.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { figures(value, count) };
    }
    // The power of ten of the last figure, and how many figures the value has down to it.
    let last = power(size) - count.max(1) as i32 + 1;
    let own = power(value) - last;
    if own < -1 {
        return "0".to_owned();
    }
    let rounded = format!("{value:.*e}", own.max(0) as usize);
    let rounded: f64 = rounded.parse().unwrap_or(value);
    // One figure may be too many.
    let rounded = if own < 0 && 2.0 * value.abs() < 10f64.powi(last) { 0.0 } else { rounded };
    if rounded == 0.0 {
        return "0".to_owned();
    }
    if (SMALL..LARGE).contains(&power(rounded)) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// The power of ten of the first figure.
fn power(value: f64) -> i32 {
    // As it is written, without rounding to a power that is not reached.
    let text = format!("{value:e}");
    text.rsplit('e').next().and_then(|power| power.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_figures_at_any_size() {
        for power in -300..300 {
            let text = figures(1.2345678 * 10f64.powi(power), 6);
            let digits: String =
                text.split('e').next().unwrap_or_default().chars().filter(char::is_ascii_digit).collect();
            assert_eq!(digits.trim_matches('0'), "123457", "{power}: {text}");
            let read: f64 = text.parse().expect("it is a number");
            assert!((read / (1.23457 * 10f64.powi(power)) - 1.0).abs() < 1e-12, "{power}: {text}");
        }
    }

    #[test]
    fn what_is_no_ordinary_number() {
        assert_eq!([0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY].map(|v| figures(v, 6)), ["0", "0", "inf", "-inf"]);
        assert_eq!(figures(f64::NAN, 6), "NaN");
        assert_eq!(figures(5e-324, 6), "5e-324");
        assert_eq!(figures(9.999999, 6), "10");
        assert_eq!(figures(0.000012, 6), "0.000012");
        assert_eq!(figures(123_456_789.0, 6), "123457000");
        assert_eq!(figures(1e9, 6), "1e9");
        assert_eq!(figures_beside(-0.4e-5, 1.0, 6), "0");
        assert_eq!(figures_beside(-0.6e-5, 1.0, 6), "-6e-6");
        assert_eq!(figures_beside(1.0, f64::INFINITY, 6), "1");
    }
}
