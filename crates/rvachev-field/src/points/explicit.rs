//! Heights by powers and by the series: methods 2 and 3, scalar and on SIMD lanes.
//!
//! A whole n is a product, by repeated squaring: exact to n roundings of a number whose share in
//! the height is 1/n, and a third of the work.

use super::series::BinomialSeries;
use super::{PointError, check_exponent};
use crate::Real;
use crate::kernel::{CHUNK, Element, Formula, Visit, run};

/// Heights `z = (1 − |x|ⁿ − |y|ⁿ)^(1/n)` (method 2): three powers in place of four and no sine.
///
/// ```
/// use rvachev::points::ExactExplicit;
///
/// let explicit = ExactExplicit::new(5.0)?;
/// assert!((explicit.height(0.5, 0.0) - 0.993670377332229).abs() < 1e-15);
/// # Ok::<(), rvachev::points::PointError>(())
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

    /// The height over (x, y); 0 outside the surface's shadow. Right to a few units in the last
    /// place where it is the largest coordinate.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let rest = 1.0 - x.abs().powf(self.n) - y.abs().powf(self.n);
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
        [root(x.pow(self.n) + y.pow(self.n), self.n)]
    }

    #[inline(always)]
    fn specialised<V: Visit<2, 1>>(&self, visit: V) {
        match whole(self.n) {
            Some(2) => visit.visit(&Circle),
            Some(n) => visit.visit(&Whole { n }),
            None => visit.visit(self),
        }
    }
}

/// `(1 − u)^(1/n)`, 0 for u above 1.
#[inline(always)]
fn root<R: Real>(u: R, n: f64) -> R {
    let rest = -u + 1.0;
    rest.max(rest.lift(0.0)).pow(1.0 / n)
}

/// The exponent if it is a whole number.
fn whole(n: f64) -> Option<u32> {
    (n == n.round()).then_some(n as u32).filter(|&n| n > 0)
}

/// n = 2.
struct Circle;

impl Formula<2, 1> for Circle {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> [R; 1] {
        let rest = -(x * x + y * y) + 1.0;
        [rest.max(rest.lift(0.0)).sqrt()]
    }
}

/// A whole exponent.
struct Whole {
    n: u32,
}

impl Formula<2, 1> for Whole {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> [R; 1] {
        [root(product(x, self.n) + product(y, self.n), f64::from(self.n))]
    }
}

/// |x|ⁿ by repeated squaring, n above 0.
#[inline(always)]
fn product<R: Real>(x: R, n: u32) -> R {
    let (mut square, mut n) = (x.abs(), n);
    while n & 1 == 0 {
        square = square * square;
        n >>= 1;
    }
    let mut all = square;
    n >>= 1;
    while n > 0 {
        square = square * square;
        if n & 1 == 1 {
            all = all * square;
        }
        n >>= 1;
    }
    all
}

/// Heights by the binomial series (method 3): two powers and a polynomial.
///
/// ```
/// use rvachev::points::SeriesExplicit;
///
/// let series = SeriesExplicit::new(5.0, 1e-3)?;
/// assert_eq!(series.series().terms(), 8);
/// let exact = (1.0 - 0.5f64.powi(5) - 0.7f64.powi(5)).powf(0.2);
/// assert!((series.height(0.5, 0.7) - exact).abs() < 1e-3);
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
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

    /// The height over (x, y), both from 0 to 1; beyond the wedge the error grows, and outside
    /// the surface's shadow the value means nothing.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.series.value(x.abs().powf(self.n) + y.abs().powf(self.n))
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

    #[inline(always)]
    fn specialised<V: Visit<2, 1>>(&self, visit: V) {
        match whole(self.n) {
            Some(n) => visit.visit(&WholeSeries { n, series: &self.series }),
            None => visit.visit(self),
        }
    }
}

/// The series for a whole exponent.
struct WholeSeries<'a> {
    n: u32,
    series: &'a BinomialSeries,
}

impl Formula<2, 1> for WholeSeries<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> [R; 1] {
        [self.series.sum(product(x, self.n) + product(y, self.n))]
    }
}

/// Runs a formula over slices of any length: whole chunks as they are, the rest padded.
pub(super) fn over_slices<E: Element, const O: usize>(
    formula: &impl Formula<2, O>,
    from: [&[E]; 2],
    mut to: [&mut [E]; O],
) {
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
