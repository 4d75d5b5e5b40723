//! The edges of the end faces of extruded and swept solids.

use crate::{Blend, ParamError, check};

/// How the edges of an end face are.
///
/// Lengths are 10⁻⁹ to 10⁹, and meant to be below half the height and half the section's width.
///
/// ```
/// use rvachev::{Caps, Extrusion, Profile};
///
/// let bar = |caps| Profile::rectangle([10.0, 6.0]).extrude_with(&Extrusion { caps, ..Extrusion::new(4.0) });
/// let near_the_edge = [4.9, 0.0, 1.9];
/// assert!(bar(Caps::Flat).contains(near_the_edge)?);
/// assert!(!bar(Caps::Rounded(1.0)).contains(near_the_edge)?);
/// assert!(!bar(Caps::Chamfered(1.0)).contains(near_the_edge)?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Caps {
    /// Sharp.
    #[default]
    Flat,
    /// Chamfered; the number is the leg, a length: how far from the edge the bevel begins, on the
    /// end face and on the sides.
    Chamfered(f64),
    /// Rounded; the number is the radius, a length.
    Rounded(f64),
}

impl Caps {
    /// The blend of the end face with the sides; none of sharp edges.
    #[doc(hidden)]
    #[must_use]
    pub fn blend(self) -> Option<Blend> {
        match self {
            Caps::Flat => None,
            Caps::Chamfered(leg) => Some(Blend::Chamfer { leg }),
            Caps::Rounded(radius) => Some(Blend::Fillet { radius }),
        }
    }

    /// Whether the length is in its range.
    #[doc(hidden)]
    pub fn check(self, name: &str) -> Result<(), ParamError> {
        match self {
            Caps::Flat => Ok(()),
            Caps::Chamfered(leg) => check::length(&format!("{name} (leg)"), leg),
            Caps::Rounded(radius) => check::length(&format!("{name} (radius)"), radius),
        }
    }
}
