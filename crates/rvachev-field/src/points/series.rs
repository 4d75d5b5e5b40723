//! The binomial series of a superquadric's height.
//!
//! ```text
//!     (1 − u)^(1/n) = 1 − c₁u − c₂u² − …      c₁ = 1/n,  c_k = c_(k−1)·((k − 1) − 1/n)/k
//!     what K terms leave out is above 0 and at most  c_(K+1)·u^(K+1)/(1 − u)          for n > 1
//! ```
//!
//! Where the height is the largest coordinate, u is at most 1/2 in the plane and 2/3 in space.
//!
//! Source: W. R. Franklin, A. H. Barr, *Faster calculation of superquadric shapes* (1981).

use super::PointError;
use crate::Real;

/// The most terms that are ever needed for double precision.
const MOST_TERMS: u32 = 100;

/// The binomial series of `(1 − u)^(1/n)`, n > 1.
///
/// ```
/// use rvachev::points::BinomialSeries;
///
/// // Terms for 10⁻⁶ wherever the height is the largest of three coordinates.
/// let series = BinomialSeries::for_tolerance(5.0, 2.0 / 3.0, 1e-6)?;
/// assert_eq!(series.terms(), 23);
/// let exact = (1.0f64 - 0.5).powf(0.2);
/// assert!((series.value(0.5) - exact).abs() < 1e-6);
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BinomialSeries {
    n: f64,
    coefficients: Vec<f64>,
    /// c_(K+1).
    next: f64,
}

impl BinomialSeries {
    /// The series with `terms` terms after the 1, 1 to 100, for an exponent n above 1.
    ///
    /// # Errors
    /// A parameter out of its range: for n < 1 the coefficients change sign and the bound fails.
    pub fn new(n: f64, terms: u32) -> Result<BinomialSeries, PointError> {
        if !(n > 1.0 && n <= 1e4) {
            return Err(PointError::Parameter { parameter: "n", value: n, allowed: "above 1, up to 10000" });
        }
        if !(1..=MOST_TERMS).contains(&terms) {
            let value = f64::from(terms);
            return Err(PointError::Parameter { parameter: "terms", value, allowed: "1 to 100" });
        }
        let mut coefficients = vec![1.0 / n];
        for k in 2..=terms + 1 {
            let k = f64::from(k);
            let last = coefficients[coefficients.len() - 1];
            coefficients.push(last * ((k - 1.0) - 1.0 / n) / k);
        }
        let next = coefficients.pop().unwrap_or(0.0);
        Ok(BinomialSeries { n, coefficients, next })
    }

    /// The series with as few terms as keep the error below `tolerance` (10⁻¹⁶ or more) for all
    /// u up to `largest` (below 1).
    ///
    /// # Errors
    /// A parameter out of its range, or a tolerance that takes more than 100 terms.
    pub fn for_tolerance(n: f64, largest: f64, tolerance: f64) -> Result<BinomialSeries, PointError> {
        if !(0.0..1.0).contains(&largest) {
            return Err(PointError::Parameter { parameter: "largest", value: largest, allowed: "0 to below 1" });
        }
        for terms in 1..=MOST_TERMS {
            let series = BinomialSeries::new(n, terms)?;
            if series.error_bound(largest) < tolerance {
                return Ok(series);
            }
        }
        Err(PointError::Parameter { parameter: "tolerance", value: tolerance, allowed: "what 100 terms reach" })
    }

    /// How many terms there are after the 1.
    #[must_use]
    pub fn terms(&self) -> u32 {
        self.coefficients.len() as u32
    }

    /// c₁, c₂, …
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The most by which the series is too large for any argument from 0 to u; it is never too
    /// small. +∞ for u from 1 on, where the series does not converge.
    #[must_use]
    pub fn error_bound(&self, u: f64) -> f64 {
        if u < 1.0 {
            let u = u.max(0.0);
            self.next * u.powi(self.coefficients.len() as i32 + 1) / (1.0 - u)
        } else {
            f64::INFINITY
        }
    }

    /// The value at u, from 0 to below 1.
    #[must_use]
    pub fn value(&self, u: f64) -> f64 {
        self.sum(u)
    }

    #[inline(always)]
    pub(super) fn sum<R: Real>(&self, u: R) -> R {
        let mut sum = u.lift(0.0);
        let mut k = self.coefficients.len();
        while k > 0 {
            k -= 1;
            sum = (sum + self.coefficients[k]) * u;
        }
        -sum + 1.0
    }
}
