//! Tables in place of powers: methods 4 and 6.

use super::series::BinomialSeries;
use super::{PointError, check_exponent};

/// Heights by tables of `a^n` and `a^(1/n)` (Franklin and Barr's method 6): three look-ups and
/// two subtractions.
///
/// ```text
/// z = T₂[ round(N·(1 − T₁[x] − T₁[y])) ]      T₁[i] = (i/N)^n,  T₂[i] = (i/N)^(1/n)
/// ```
///
/// On nodes x = i/N, y = j/N the error is at most `1/(2N)·1/n·v^(1/n − 1)` with
/// v = 1 − xⁿ − yⁿ, and v ≥ 1/3 where z is the largest coordinate. Elsewhere it fails: 0.22 of the
/// size for n = 5 and 0.85 for n = 50 as z goes to 0.
///
/// ```
/// use rvachev::points::PowerTables;
///
/// let tables = PowerTables::new(5.0, 1000)?;
/// let exact = (1.0 - 0.5f64.powi(5) - 0.7f64.powi(5)).powf(0.2);
/// assert!((tables.height(0.5, 0.7) - exact).abs() <= tables.error_bound());
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PowerTables {
    n: f64,
    size: u32,
    powers: Vec<f32>,
    roots: Vec<f32>,
}

fn check_size(size: u32) -> Result<(), PointError> {
    if (16..=1 << 22).contains(&size) {
        return Ok(());
    }
    Err(PointError::Parameter { parameter: "size", value: f64::from(size), allowed: "16 to 4194304" })
}

impl PowerTables {
    /// Tables of `size` intervals, 16 to 2²², for the exponent n, 0.2 to 10 000.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(n: f64, size: u32) -> Result<PowerTables, PointError> {
        check_exponent(n)?;
        check_size(size)?;
        let table = |p: f64| (0..=size).map(|i| (f64::from(i) / f64::from(size)).powf(p) as f32).collect();
        Ok(PowerTables { n, size, powers: table(n), roots: table(1.0 / n) })
    }

    /// The most by which a height on nodes of the table is off where it is the largest
    /// coordinate, single precision included.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        0.5 / f64::from(self.size) / self.n * (1.0f64 / 3.0).powf(1.0 / self.n - 1.0) + 2e-7
    }

    /// The height over the node next to (x, y), both from 0 to 1.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        f64::from(self.look_up(x as f32, y as f32))
    }

    #[inline(always)]
    fn look_up(&self, x: f32, y: f32) -> f32 {
        let n = self.size as f32;
        // A cast saturates, so that NaN and what is out of range find some entry.
        let node = |v: f32| ((v * n + 0.5) as usize).min(self.powers.len() - 1);
        let rest = 1.0 - self.powers[node(x)] - self.powers[node(y)];
        self.roots[node(rest)]
    }

    /// Heights over the nodes next to many points.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights(&self, x: &[f32], y: &[f32], z: &mut [f32]) {
        assert!(x.len() == y.len() && y.len() == z.len(), "slices of one length are needed");
        for ((&x, &y), z) in x.iter().zip(y).zip(z) {
            *z = self.look_up(x, y);
        }
    }
}

/// Heights by the binomial series of powers from a table of logarithms (method 4): two look-ups
/// and two `exp2`.
///
/// ```text
/// u = 2^(n·L[x]) + 2^(n·L[y]),  z = 1 − c₁u − c₂u² − …      L[i] = log₂(i/N)
/// ```
///
/// On nodes x = i/N, y = j/N the error is that of the [`BinomialSeries`].
///
/// ```
/// use rvachev::points::LogTable;
///
/// let table = LogTable::new(5.0, 1000, 1e-3)?;
/// let exact = (1.0 - 0.5f64.powi(5) - 0.7f64.powi(5)).powf(0.2);
/// assert!((table.height(0.5, 0.7) - exact).abs() <= table.error_bound());
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LogTable {
    n: f64,
    size: u32,
    logs: Vec<f32>,
    series: BinomialSeries,
}

impl LogTable {
    /// A table of `size` intervals, 16 to 2²², and the series for a tolerance where z is the
    /// largest coordinate; n above 1.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(n: f64, size: u32, tolerance: f64) -> Result<LogTable, PointError> {
        let series = BinomialSeries::for_tolerance(n, 2.0 / 3.0, tolerance)?;
        check_size(size)?;
        let log = |i: u32| if i == 0 { -1e4 } else { (f64::from(i) / f64::from(size)).log2() as f32 };
        Ok(LogTable { n, size, logs: (0..=size).map(log).collect(), series })
    }

    /// The most by which a height on nodes of the table is off where it is the largest
    /// coordinate, single precision included.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        // The logarithms' roundings, 6·10⁻⁸ of at most 1 where powers count, times n in the power
        // and 1/n in the height.
        self.series.error_bound(2.0 / 3.0) + 1e-6
    }

    /// The height over the node next to (x, y), both from 0 to 1.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        f64::from(self.look_up(x as f32, y as f32))
    }

    #[inline(always)]
    fn look_up(&self, x: f32, y: f32) -> f32 {
        let size = self.size as f32;
        let log = |v: f32| self.logs[((v * size + 0.5) as usize).min(self.logs.len() - 1)];
        let n = self.n as f32;
        let u = (n * log(x)).exp2() + (n * log(y)).exp2();
        let mut sum = 0.0f32;
        for &c in self.series.coefficients().iter().rev() {
            sum = (sum + c as f32) * u;
        }
        1.0 - sum
    }

    /// Heights over the nodes next to many points.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn heights(&self, x: &[f32], y: &[f32], z: &mut [f32]) {
        assert!(x.len() == y.len() && y.len() == z.len(), "slices of one length are needed");
        for ((&x, &y), z) in x.iter().zip(y).zip(z) {
            *z = self.look_up(x, y);
        }
    }
}
