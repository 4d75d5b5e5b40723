//! The edges of the end faces of extruded and swept solids.

use crate::{ParamError, Rule, check};

/// How the edges of the end faces of an extrusion or of a helix are.
///
/// ```text
///     d    distance from the profile's outline, inwards
///     t    distance from the nearer end face, inwards
///
///     Rounded(r)      (r − min(d, r))² + (r − min(t, r))² ≤ r²
///     Chamfered(l)    d + t ≥ l
///
///      t|   ______            t|   ______
///       |  ´                   |  /
///       | /                  l | /
///       ||                     |/
///       +--------- d           +--------- d
///          r                      l
/// ```
///
/// | parameter | unit | range |
/// |---|---|---|
/// | radius of `Rounded`, leg of `Chamfered` | length | 10⁻⁹ to 10⁹; at most half the height (of a helix, half its length); below the radius of the largest circle within the section |
///
/// What does not fit is an error when the solid is first used: it names the parameter, its value,
/// and the largest that is allowed. Of the end face something is always left. The largest circle is
/// known to a ten-thousandth; a section without end has none.
///
/// Distances are true ones: those of circles, rectangles and polygons, and of what is cut out of
/// them or common to them, are known; of every other profile (unions, gauges such as superellipses,
/// stretched ones, blends) the outline is measured when the solid is compiled, to a thousandth of
/// the size or a millionth of the section's width. At a corner of the outline the edges meet in a
/// mitre, at an inner corner they go round it.
///
/// In a twisted extrusion d is measured in the section, in a scaled one in the section as it is at
/// that end; where sides slope, an edge is rounded by an arc of an ellipse, or cut off at an angle
/// other than 45°. In a scaled extrusion the size must fit into the smaller end. Along a helix t is
/// measured at its radius.
///
/// The value is that of the formula: `r − √((r − min(d, r))² + (r − min(t, r))²)`, or `min(d, t)`
/// where both are above r, and `min(d, t, (d + t − l)/√2)`. It is 1-Lipschitz if the extrusion is
/// straight.
///
/// ```
/// use rvachev::{Caps, Extrusion, Profile};
///
/// let bar = |caps| Profile::rectangle([10.0, 6.0]).extrude_with(&Extrusion { caps, ..Extrusion::new(4.0) });
/// let near_the_edge = [4.9, 0.0, 1.9];
/// assert!(bar(Caps::Flat).contains(near_the_edge)?);
/// assert!(!bar(Caps::Rounded(1.0)).contains(near_the_edge)?);
/// assert!(!bar(Caps::Chamfered(1.0)).contains(near_the_edge)?);
/// // Nothing would be left of the end face.
/// let error = bar(Caps::Rounded(3.0)).contains([0.0, 0.0, 0.0]).unwrap_err().to_string();
/// assert_eq!(error, "extrude: caps (radius) is 3, allowed: up to 2, half the height");
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Caps {
    /// Sharp.
    #[default]
    Flat,
    /// Chamfered at 45°; the number is the leg, a length: how far from the edge the bevel begins,
    /// on the end face and on the sides.
    Chamfered(f64),
    /// Rounded; the number is the radius, a length.
    Rounded(f64),
}

impl Caps {
    /// The radius or leg; none of sharp edges.
    #[doc(hidden)]
    #[must_use]
    pub fn size(self) -> Option<f64> {
        match self {
            Caps::Flat => None,
            Caps::Chamfered(size) | Caps::Rounded(size) => Some(size),
        }
    }

    /// The same, where lengths are so many times as long.
    #[doc(hidden)]
    #[must_use]
    pub fn times(self, factor: f64) -> Caps {
        match self {
            Caps::Flat => Caps::Flat,
            Caps::Chamfered(leg) => Caps::Chamfered(factor * leg),
            Caps::Rounded(radius) => Caps::Rounded(factor * radius),
        }
    }

    /// How the distances to the end face and to the sides are joined.
    #[doc(hidden)]
    #[must_use]
    pub fn rule(self) -> Rule {
        match self {
            Caps::Flat => Rule::Distance,
            Caps::Chamfered(leg) => Rule::Chamfered(leg),
            Caps::Rounded(radius) => Rule::Rounded(radius),
        }
    }

    /// What errors call the size.
    fn parameter(self, name: &str) -> String {
        match self {
            Caps::Flat => name.to_string(),
            Caps::Chamfered(_) => format!("{name} (leg)"),
            Caps::Rounded(_) => format!("{name} (radius)"),
        }
    }

    /// Whether the size is in its range, and no more than `half` of `what`.
    #[doc(hidden)]
    pub fn check(self, name: &str, half: f64, what: &str) -> Result<(), ParamError> {
        let Some(size) = self.size() else { return Ok(()) };
        check::length(&self.parameter(name), size)?;
        if size > half {
            let allowed = format_args!("up to {half}, half the {what}");
            return Err(ParamError::new(self.parameter(name), size, allowed));
        }
        Ok(())
    }

    /// That the size leaves nothing of the section: circles within it have a radius of at most
    /// `most`.
    #[doc(hidden)]
    #[must_use]
    pub fn too_large(self, name: &str, most: f64) -> ParamError {
        // Four digits, rounded down.
        let digits = 10f64.powf(3.0 - most.max(f64::MIN_POSITIVE).log10().floor());
        let most = if digits.is_finite() { (most * digits).floor() / digits } else { most };
        let allowed = format_args!("below {most}, the radius of the largest circle within the section");
        ParamError::new(self.parameter(name), self.size().unwrap_or_default(), allowed)
    }
}
