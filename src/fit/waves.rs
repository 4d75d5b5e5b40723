//! Sums over points of three harmonics of a repetition: of their products with each other, with
//! other terms, and with values. On SIMD lanes, as there are many repetitions to try.

use fearless_simd::Simd;
use rvachev_num::Real;
use rvachev_num::lanes::{F64, Lanes};

/// Cosine and sine of three harmonics.
pub(super) const WAVES: usize = 6;

/// Whole vectors of any SIMD level.
const WIDTH: usize = 8;

/// Sums of products over the points.
pub(super) struct Sums<const N: usize> {
    /// Of waves and other terms.
    pub(super) terms: [[f64; N]; WAVES],
    /// Of waves; the lower triangle.
    pub(super) waves: [[f64; WAVES]; WAVES],
    /// Of waves and values.
    pub(super) values: [f64; WAVES],
}

/// A column of numbers, 0 beyond the last up to whole vectors.
pub(super) fn column(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut column: Vec<f64> = numbers.collect();
    column.resize(column.len().next_multiple_of(WIDTH), 0.0);
    column
}

/// The sums of columns of terms and values; `turns` has the cosines and sines of the first
/// harmonic.
pub(super) fn sums<const N: usize>(terms: &[Vec<f64>; N], values: &[f64], turns: &[Vec<f64>; 2]) -> Sums<N> {
    rvachev_num::on_level!(simd => sums_on::<_, N>(simd, terms, values, turns))
}

#[inline(always)]
fn sums_on<S: Simd, const N: usize>(simd: S, terms: &[Vec<f64>; N], values: &[f64], turns: &[Vec<f64>; 2]) -> Sums<N> {
    let width = <F64<S> as Lanes>::WIDTH;
    let zero = <F64<S> as Lanes>::splat(simd, 0.0);
    let mut by_terms = [[zero; N]; WAVES];
    let mut by_waves = [[zero; WAVES]; WAVES];
    let mut by_values = [zero; WAVES];
    for start in (0..values.len()).step_by(width) {
        let at = start..start + width;
        let load = |from: &[f64]| <F64<S> as Lanes>::load(simd, &from[at.clone()]);
        let (c, s) = (load(&turns[0]), load(&turns[1]));
        let (c2, s2) = (c * c - s * s, c * s + s * c);
        let (c3, s3) = (c2 * c - s2 * s, c2 * s + s2 * c);
        let waves = [c, s, c2, s2, c3, s3];
        let value = load(values);
        for i in 0..WAVES {
            by_values[i] = waves[i].mul_add(value, by_values[i]);
            for j in 0..N {
                by_terms[i][j] = waves[i].mul_add(load(&terms[j]), by_terms[i][j]);
            }
            for j in 0..=i {
                by_waves[i][j] = waves[i].mul_add(waves[j], by_waves[i][j]);
            }
        }
    }
    let mut buffer = [0.0; WIDTH];
    let mut sum = |v: F64<S>| -> f64 {
        v.store(&mut buffer[..width]);
        buffer[..width].iter().sum()
    };
    Sums {
        terms: by_terms.map(|row| row.map(&mut sum)),
        waves: by_waves.map(|row| row.map(&mut sum)),
        values: by_values.map(&mut sum),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_products() {
        let angles: Vec<f64> = (0..21).map(|i| 0.37 * f64::from(i)).collect();
        let of = |f: fn(f64) -> f64| column(angles.iter().map(|a| f(*a)));
        let terms = [of(|a| 1.0 + 0.1 * a), of(|a| a * a)];
        let found = sums(&terms, &of(|a| 2.0 - a), &[of(f64::cos), of(f64::sin)]);
        let wave = |i: usize, a: f64| {
            let h = (i / 2 + 1) as f64;
            if i.is_multiple_of(2) { (h * a).cos() } else { (h * a).sin() }
        };
        let sum = |f: &dyn Fn(f64) -> f64| angles.iter().map(|a| f(*a)).sum::<f64>();
        for i in 0..WAVES {
            assert!((found.values[i] - sum(&|a| wave(i, a) * (2.0 - a))).abs() < 1e-10);
            assert!((found.terms[i][1] - sum(&|a| wave(i, a) * a * a)).abs() < 1e-9);
            for j in 0..=i {
                assert!((found.waves[i][j] - sum(&|a| wave(i, a) * wave(j, a))).abs() < 1e-10);
            }
        }
    }
}
