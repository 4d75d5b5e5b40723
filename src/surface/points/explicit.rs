//! Heights by powers, by the series, and points by angles: methods 1, 2 and 3, scalar and on
//! SIMD lanes.

use super::series::BinomialSeries;
use super::{PointError, check_exponent};
use crate::Real;
use crate::num::kernel::{CHUNK, Element, Formula, run};
use crate::surface::angle::{signed_power, sin_cos};

/// The point of a superellipsoid of unit size by its angles (method 1): four sines and cosines,
/// four signed powers. Exact zeros at quarter turns.
///
/// ```
/// let [x, y, z] = rvachev::raw_parametric(0.5, 0.5, 0.3, 0.4);
/// assert!((x.powi(4) + y.powi(4) + z.powi(4) - 1.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn raw_parametric(e1: f64, e2: f64, eta: f64, omega: f64) -> [f64; 3] {
    let ((sin_h, cos_h), (sin_w, cos_w)) = (sin_cos(eta), sin_cos(omega));
    let across = signed_power(cos_h, e1);
    [across * signed_power(cos_w, e2), across * signed_power(sin_w, e2), signed_power(sin_h, e1)]
}

/// [`raw_parametric`] on SIMD lanes of `f32`: `[x, y, z]` of each pair of angles. Signs of x and y
/// are those of the first octant: angles from 0 to π/2.
///
/// # Panics
/// If the slices differ in length.
pub fn raw_parametric_octant(e1: f64, e2: f64, eta: &[f32], omega: &[f32], out: [&mut [f32]; 3]) {
    over_slices(&Raw { e1, e2 }, [eta, omega], out);
}

struct Raw {
    e1: f64,
    e2: f64,
}

impl Formula<2, 3> for Raw {
    #[inline(always)]
    fn run<R: Real>(&self, [eta, omega]: [R; 2]) -> [R; 3] {
        let ((sin_h, cos_h), (sin_w, cos_w)) = (eta.sin_cos(), omega.sin_cos());
        let across = cos_h.pow(self.e1);
        [across * cos_w.pow(self.e2), across * sin_w.pow(self.e2), sin_h.pow(self.e1)]
    }
}

/// Heights `z = (1 − xⁿ − yⁿ)^(1/n)` (method 2): three powers in place of four and no sine.
///
/// ```
/// use rvachev::ExactExplicit;
///
/// let explicit = ExactExplicit::new(5.0)?;
/// assert!((explicit.height(0.5, 0.0) - 0.993670377332229).abs() < 1e-15);
/// # Ok::<(), rvachev::PointError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactExplicit {
    n: f64,
}

impl ExactExplicit {
    /// Heights for the exponent n, 0.2 to 10 000.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(n: f64) -> Result<ExactExplicit, PointError> {
        check_exponent(n)?;
        Ok(ExactExplicit { n })
    }

    /// The height over (x, y), both from 0 to 1; 0 outside the surface's shadow. Right to a few
    /// units in the last place where it is the largest coordinate.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let rest = 1.0 - x.powf(self.n) - y.powf(self.n);
        if rest > 0.0 { rest.powf(1.0 / self.n) } else { 0.0 }
    }

    /// Heights over many points on SIMD lanes of `f64`, to 10⁻¹⁴ where they are the largest
    /// coordinate.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) {
        over_slices(self, [x, y], [z]);
    }

    /// The same on lanes of `f32`, to 10⁻⁶.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights_single(&self, x: &[f32], y: &[f32], z: &mut [f32]) {
        over_slices(self, [x, y], [z]);
    }
}

impl Formula<2, 1> for ExactExplicit {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> [R; 1] {
        let rest = -(x.pow(self.n) + y.pow(self.n)) + 1.0;
        [rest.max(rest.lift(0.0)).pow(1.0 / self.n)]
    }
}

/// Heights by the binomial series (method 3): two powers and a polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesExplicit {
    n: f64,
    series: BinomialSeries,
}

impl SeriesExplicit {
    /// Heights for the exponent n > 1, within `tolerance` where they are the largest coordinate.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(n: f64, tolerance: f64) -> Result<SeriesExplicit, PointError> {
        Ok(SeriesExplicit { n, series: BinomialSeries::for_tolerance(n, 2.0 / 3.0, tolerance)? })
    }

    /// The same with a number of terms.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn with_terms(n: f64, terms: u32) -> Result<SeriesExplicit, PointError> {
        Ok(SeriesExplicit { n, series: BinomialSeries::new(n, terms)? })
    }

    /// The series.
    #[must_use]
    pub fn series(&self) -> &BinomialSeries {
        &self.series
    }

    /// The most by which a height is too large where it is the largest coordinate.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.series.error_bound(2.0 / 3.0)
    }

    /// The height over (x, y), both from 0 to 1.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.series.value(x.powf(self.n) + y.powf(self.n))
    }

    /// Heights over many points on SIMD lanes of `f64`.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) {
        over_slices(self, [x, y], [z]);
    }

    /// Heights over many points on SIMD lanes of `f32`.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights_single(&self, x: &[f32], y: &[f32], z: &mut [f32]) {
        over_slices(self, [x, y], [z]);
    }
}

impl Formula<2, 1> for SeriesExplicit {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> [R; 1] {
        [self.series.sum(x.pow(self.n) + y.pow(self.n))]
    }
}

/// Runs a formula over slices of any length: whole chunks as they are, the rest padded.
fn over_slices<E: Element, const O: usize>(formula: &impl Formula<2, O>, from: [&[E]; 2], mut to: [&mut [E]; O]) {
    let len = from[0].len();
    assert!(from[1].len() == len && to.iter().all(|o| o.len() == len), "slices of one length are needed");
    let whole = len - len % CHUNK;
    run(formula, from.map(|s| &s[..whole]), to.each_mut().map(|s| &mut s[..whole]));
    if whole == len {
        return;
    }
    let padded = from.map(|s| {
        let mut chunk = [E::default(); CHUNK];
        chunk[..len - whole].copy_from_slice(&s[whole..]);
        chunk
    });
    let mut result = [[E::default(); CHUNK]; O];
    run(formula, padded.each_ref().map(|s| s.as_slice()), result.each_mut().map(|s| s.as_mut_slice()));
    for (to, result) in to.iter_mut().zip(&result) {
        to[whole..].copy_from_slice(&result[..len - whole]);
    }
}
