//! How a fit is made.

use super::{Cost, FitError};

/// How a fit is made. `..FitSettings::default()` keeps what is not named.
///
/// ```
/// use rvachev::fit::{Cost, FitSettings};
///
/// let settings = FitSettings { seed: 7, cost: Cost::Radial, ..FitSettings::default() };
/// assert_eq!(settings.search_points, 2500);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct FitSettings {
    /// What random choices are made from: the same seed gives the same fit. Default: 0.
    pub seed: u64,
    /// What is minimised. Default: [`Cost::Normal`].
    pub cost: Cost,
    /// Of a larger cloud so many points are searched, chosen at random; all are then weighed once
    /// by the result. 100 to 100 000. Default: 2500.
    pub search_points: usize,
}

impl Default for FitSettings {
    fn default() -> FitSettings {
        FitSettings { seed: 0, cost: Cost::default(), search_points: 2500 }
    }
}

impl FitSettings {
    pub(super) fn check(&self) -> Result<(), FitError> {
        if !(100..=100_000).contains(&self.search_points) {
            let value = self.search_points.to_string();
            return Err(FitError::Setting { setting: "search_points", value, allowed: "100 to 100000" });
        }
        Ok(())
    }
}
