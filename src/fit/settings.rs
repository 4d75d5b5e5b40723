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
    /// With which radii supershapes are searched. Default: [`Start::Exact`].
    pub start: Start,
    /// How the symmetry numbers of supershapes are found. Default: [`Symmetry::Harmonics`].
    pub symmetry: Symmetry,
    /// Of a larger cloud so many points are searched, chosen at random; all are then weighed once
    /// by the result. 100 to 100 000. Default: 2500.
    pub search_points: usize,
}

/// With which radii the search for a supershape begins.
///
/// The published order is to begin with rational radii, and to take the exact ones when they differ
/// by more than a tolerance or an exponent is above 4. Fits come out no better and evaluate as many
/// points ([the tables](super)), so the exact radii are the default.
///
/// Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Start {
    /// Exact radii from the start.
    #[default]
    Exact,
    /// Rational radii first.
    Rational {
        /// The largest difference of the logarithms of the radii, above 0: 0.1 takes nearly all
        /// starts.
        tolerance: f64,
    },
}

/// How the symmetry numbers of supershapes are found.
///
/// Source of `Sections`: Y. D. Fougerolle et al., *Rational supershapes for surface
/// reconstruction*.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Symmetry {
    /// By harmonics of the radii about several axes, and by fits with other numbers beside them.
    #[default]
    Harmonics,
    /// As published: a plane is swept along the axis and one about it; the maxima of the radius in
    /// each section are counted, angles without points left out, and the sections vote. Where they
    /// do not agree, m = M = 4, which [`SearchReport::symmetry_unclear`](super::SearchReport)
    /// tells. For comparisons: [the tables](super).
    Sections,
}

impl Default for FitSettings {
    fn default() -> FitSettings {
        FitSettings {
            seed: 0,
            cost: Cost::default(),
            start: Start::default(),
            symmetry: Symmetry::default(),
            search_points: 2500,
        }
    }
}

impl FitSettings {
    pub(super) fn check(&self) -> Result<(), FitError> {
        if !(100..=100_000).contains(&self.search_points) {
            let value = self.search_points.to_string();
            return Err(FitError::Setting { setting: "search_points", value, allowed: "100 to 100000" });
        }
        if let Start::Rational { tolerance } = self.start
            && !(tolerance > 0.0 && tolerance.is_finite())
        {
            let (setting, value) = ("start: the tolerance", tolerance.to_string());
            return Err(FitError::Setting { setting, value, allowed: "finite and above 0" });
        }
        Ok(())
    }
}
