//! The published residuals.

/// What is minimised in a fit: the residual of a point, G being the gauge of the solid there and
/// r the distance from its centre.
///
/// | cost | residual | source |
/// |---|---|---|
/// | `Normal` | the radial one over r·\|∇ ln G\|: to first order the distance to the surface | this crate |
/// | `Radial` | r(1 − 1/G) | Gross and Boult (1988) |
/// | `SolinaBajcsy` | √(a₁a₂a₃)·(G² − 1) | Solina and Bajcsy (1990) |
/// | `Gauge` | √(a₁a₂a₃)·(G − 1) | Fougerolle et al., equation 4 |
/// | `Eq15` | the R_p union (p = 2) of the parts' √(a₁a₂a₃)·(1 − G) | Fougerolle et al., equation 15 |
///
/// Of a single shape `Eq15` is `Gauge`. Of a solid of several parts it is what
/// [`register`](super::register()) may minimise, and what [`ErrorOfFit`](super::ErrorOfFit) is the
/// sum of the squares of.
///
/// The radial residual is longer than the distance where rays graze the surface, which makes
/// noise large there: of one-sided views of superellipsoids fewer come out right by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Cost {
    /// Radial in the search, to first order the distance to the surface after it.
    #[default]
    Normal,
    /// The distance along the ray from the centre.
    Radial,
    /// The square of the gauge, times the root of the volume.
    SolinaBajcsy,
    /// The gauge, times the root of the volume.
    Gauge,
    /// The union of weighted gauges.
    Eq15,
}
