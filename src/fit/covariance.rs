//! How certain the parameters of a fit are.

use super::linear::solved;

/// Covariance of the parameters of a fit: the inverse of JᵀWJ/σ².
///
/// Sizes are told by their natural logarithms, that is in proportion; turns in radians about the
/// local axes, shifts in length units along them. Where the points leave a direction free, such
/// as the depth of an object that is seen along one of its axes, the standard deviations of what
/// moves along it are large.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Covariance {
    names: Vec<&'static str>,
    matrix: Vec<f64>,
}

impl Covariance {
    /// The parameters, in the order of rows and columns.
    #[must_use]
    pub fn names(&self) -> &[&'static str] {
        &self.names
    }

    /// The covariance of two parameters by their numbers; 0 beyond the last.
    #[must_use]
    pub fn value(&self, row: usize, column: usize) -> f64 {
        let n = self.names.len();
        if row < n && column < n { self.matrix[row * n + column] } else { 0.0 }
    }

    /// The standard deviation of the parameter of that name.
    #[must_use]
    pub fn deviation(&self, name: &str) -> Option<f64> {
        let at = self.names.iter().position(|n| *n == name)?;
        Some(self.value(at, at).max(0.0).sqrt())
    }

    /// The inverse of JᵀWJ (its lower triangle) of a sample, where the whole cloud has `share`
    /// times as many points; each parameter in units of its own.
    pub(super) fn from_normal<const N: usize>(
        names: [&'static str; N],
        normal: &[[f64; N]; N],
        noise: f64,
        share: f64,
        units: [f64; N],
    ) -> Covariance {
        // Parameters have unlike units: the matrix is scaled to a unit diagonal.
        let scale: [f64; N] = std::array::from_fn(|i| 1.0 / normal[i][i].max(1e-12).sqrt());
        let mut matrix = *normal;
        for i in 0..N {
            for j in 0..=i {
                matrix[i][j] *= scale[i] * scale[j];
            }
            // Free directions get a large variance, not an infinite one.
            matrix[i][i] += 1e-9;
        }
        let mut out = vec![0.0; N * N];
        for j in 0..N {
            let right: [f64; N] = std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
            let Some(column) = solved(&matrix, &right, &[true; N]) else { continue };
            for i in 0..N {
                let value = column[i] * scale[i] * scale[j] * noise * noise / share;
                out[i * N + j] = value * units[i] * units[j];
            }
        }
        for i in 0..N {
            for j in 0..i {
                let mean = 0.5 * (out[i * N + j] + out[j * N + i]);
                (out[i * N + j], out[j * N + i]) = (mean, mean);
            }
        }
        Covariance { names: names.to_vec(), matrix: out }
    }
}
