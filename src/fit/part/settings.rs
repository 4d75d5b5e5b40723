//! How a part is recovered.

use super::super::FitError;

/// How a part is recovered. `..PartSettings::default()` keeps what is not named.
///
/// ```
/// use rvachev::fit::{PartKinds, PartSettings};
///
/// // Blocks and bores only, and no leaf that does not explain much.
/// let kinds = PartKinds { cones: false, spheres: false, tori: false, ..PartKinds::default() };
/// let settings = PartSettings { kinds, parameter_cost: 0.001, ..PartSettings::default() };
/// assert_eq!(settings.seed, 0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct PartSettings {
    /// What random choices are made from: the same seed gives the same part. Default: 0.
    pub seed: u64,
    /// Which leaves may be used.
    pub kinds: PartKinds,
    /// What a parameter of a leaf costs, as a share of the part's volume: a leaf is used that mends
    /// more than its parameters cost. 10⁻⁶ to 0.1. Default: 0.00015, which is some 0.1 % for a
    /// cylinder.
    pub parameter_cost: f64,
    /// How far the vertices are off the true surface, as a standard deviation, in length units: 0
    /// to 10⁹. Default: 0.
    pub noise: f64,
    /// Whether leaves are laid through the vertices of the mesh where these tell them exactly. The
    /// radius of a cylinder of facets is then that of its corners, as it was meant, though a
    /// smaller one has more volume in common with the facets. Then axes are settled, numbers made
    /// round, and cuts go through: see [`PartFit::snaps`](super::PartFit::snaps). Of points nothing
    /// is made round, but axes are settled, and cuts that leave a skin no thicker than noise go
    /// through. If `false`, axes are left as vertices and samples tell them. Default: `true`.
    pub snap: bool,
}

/// Which leaves a part may be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct PartKinds {
    /// Boxes between planes at right angles. Default: `true`, as of all.
    pub boxes: bool,
    /// Half-spaces, which are cut off.
    pub half_spaces: bool,
    /// Cylinders.
    pub cylinders: bool,
    /// Cones and truncated cones.
    pub cones: bool,
    /// Spheres.
    pub spheres: bool,
    /// Tori.
    pub tori: bool,
    /// Superellipsoids, for what is round and nothing of the above.
    pub superellipsoids: bool,
    /// Extruded outlines of up to 32 corners, with straight sides and arcs, and rectangles with
    /// rounded corners.
    pub profiles: bool,
    /// Regular prisms of 3 to 8 sides.
    pub prisms: bool,
    /// Supershapes: extruded ones as stars, flowers, cams, and three-dimensional ones for what is
    /// round and no superellipsoid.
    pub supershapes: bool,
}

impl Default for PartKinds {
    fn default() -> PartKinds {
        PartKinds {
            boxes: true,
            half_spaces: true,
            cylinders: true,
            cones: true,
            spheres: true,
            tori: true,
            superellipsoids: true,
            profiles: true,
            prisms: true,
            supershapes: true,
        }
    }
}

impl Default for PartSettings {
    fn default() -> PartSettings {
        PartSettings { seed: 0, kinds: PartKinds::default(), parameter_cost: 1.5e-4, noise: 0.0, snap: true }
    }
}

impl PartSettings {
    pub(super) fn check(&self) -> Result<(), FitError> {
        if !(1e-6..=0.1).contains(&self.parameter_cost) {
            let value = self.parameter_cost.to_string();
            return Err(FitError::Setting { setting: "parameter_cost", value, allowed: "0.000001 to 0.1" });
        }
        if !(0.0..=1e9).contains(&self.noise) {
            let value = self.noise.to_string();
            return Err(FitError::Setting { setting: "noise", value, allowed: "0 to 1000000000" });
        }
        Ok(())
    }
}
