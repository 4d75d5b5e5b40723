//! How far points are from a surface, in numbers.

use super::linear::quantile;

/// Distances of points to a surface, in length units, without their signs.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Deviation {
    /// How many points were asked.
    pub points: usize,
    /// The mean of the distances.
    pub mean: f64,
    /// The root of the mean of their squares.
    pub rms: f64,
    /// Half of the points are nearer.
    pub median: f64,
    /// Of 100 points 95 are nearer.
    pub percentile_95: f64,
    /// The largest one.
    pub largest: f64,
}

impl Deviation {
    /// Of distances of any sign. All are 0 of none.
    pub(super) fn of(distances: impl Iterator<Item = f64>) -> Deviation {
        let mut sizes: Vec<f64> = distances.map(f64::abs).collect();
        let points = sizes.len();
        let count = points.max(1) as f64;
        Deviation {
            points,
            mean: sizes.iter().sum::<f64>() / count,
            rms: (sizes.iter().map(|d| d * d).sum::<f64>() / count).sqrt(),
            median: quantile(&mut sizes, 0.5),
            percentile_95: quantile(&mut sizes, 0.95),
            largest: sizes.iter().copied().fold(0.0, f64::max),
        }
    }
}
