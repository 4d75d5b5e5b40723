//! How far a surface may be off that was measured.

/// How near the surface of a solid is to what its lengths ask for: see
/// [`Solid::accuracy`](crate::Solid::accuracy).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Accuracy {
    /// All but a few points of the surface are off by no more than this, in length units.
    pub tolerance: f64,
    /// The farthest that was found, in length units: where creases meet it may be more than the
    /// tolerance. 0 of operands without end, which are measured piece by piece later on.
    pub error: f64,
}

impl Accuracy {
    /// That of what is measured from something that may be off itself.
    pub(crate) fn plus(self, other: Accuracy) -> Accuracy {
        Accuracy { tolerance: self.tolerance + other.tolerance, error: self.error + other.error }
    }

    /// That of several parts.
    pub(crate) fn max(self, other: Accuracy) -> Accuracy {
        Accuracy { tolerance: self.tolerance.max(other.tolerance), error: self.error.max(other.error) }
    }

    /// The same where lengths are so many times as long.
    pub(crate) fn times(self, stretch: f64) -> Accuracy {
        Accuracy { tolerance: stretch * self.tolerance, error: stretch * self.error }
    }
}
