//! How a union is fitted.

use crate::fit::{Cost, FitError, FitSettings, Start};

/// How a union of supershapes is fitted. `..UnionSettings::default()` keeps what is not named.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct UnionSettings {
    /// How each supershape is fitted. Default: the published rational start
    /// ([`Start::Rational`] with a tolerance of 0.1), and otherwise [`FitSettings::default`].
    pub fit: FitSettings,
    /// Whether holes are looked for. Default: yes.
    pub holes: bool,
    /// Points are of a hole that are deeper inside of a body than this times its noise, and than
    /// 1.2 % of its half-length; 1 to 100. Default: 5.
    pub depth: f64,
    /// Steps of the joint refinement at most, each of all parameters of all supershapes; 0 for
    /// none, at most 1000. Where the points have noise, none is better: see
    /// [the tables](crate::fit#unions-of-supershapes). Default: 30.
    pub refinement: usize,
}

impl Default for UnionSettings {
    fn default() -> UnionSettings {
        let fit =
            FitSettings { start: Start::Rational { tolerance: 0.1 }, cost: Cost::Normal, ..FitSettings::default() };
        UnionSettings { fit, holes: true, depth: 5.0, refinement: 30 }
    }
}

impl UnionSettings {
    pub(super) fn check(&self) -> Result<(), FitError> {
        self.fit.check()?;
        if !(1.0..=100.0).contains(&self.depth) {
            return Err(FitError::Setting { setting: "depth", value: self.depth.to_string(), allowed: "1 to 100" });
        }
        if self.refinement > 1000 {
            let (setting, value) = ("refinement", self.refinement.to_string());
            return Err(FitError::Setting { setting, value, allowed: "0 to 1000" });
        }
        Ok(())
    }
}
