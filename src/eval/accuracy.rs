//! How far a surface may be off that was measured.

/// How near the surface of a solid is to what its lengths ask for: see
/// [`Solid::accuracy`](crate::Solid::accuracy).
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Accuracy {
    /// All but a few points of the surface are off by no more than this, in length units.
    pub tolerance: f64,
    /// The farthest that was found, in length units: where creases meet it may be more than the
    /// tolerance. 0 of operands without end, which are measured piece by piece later on.
    pub error: f64,
    /// The coarsest tolerance that one of the surfaces was measured to that it is made of: no
    /// surface that stands on it is smoother. Unlike errors, these do not add up.
    #[cfg_attr(feature = "serde", serde(skip))]
    grain: f64,
}

impl PartialEq for Accuracy {
    fn eq(&self, other: &Accuracy) -> bool {
        (self.tolerance, self.error) == (other.tolerance, other.error)
    }
}

impl Accuracy {
    /// That of a surface that was measured by itself.
    pub(crate) fn of_surface(tolerance: f64, error: f64) -> Accuracy {
        Accuracy { tolerance, error, grain: tolerance }
    }

    /// The coarsest tolerance that one of its surfaces was measured to.
    pub(crate) fn grain(self) -> f64 {
        self.grain
    }

    /// That of what is measured from something that may be off itself.
    pub(crate) fn plus(self, other: Accuracy) -> Accuracy {
        let (tolerance, error) = (self.tolerance + other.tolerance, self.error + other.error);
        Accuracy { tolerance, error, grain: self.grain.max(other.grain) }
    }

    /// That of several parts.
    pub(crate) fn max(self, other: Accuracy) -> Accuracy {
        let (tolerance, error) = (self.tolerance.max(other.tolerance), self.error.max(other.error));
        Accuracy { tolerance, error, grain: self.grain.max(other.grain) }
    }

    /// The same where lengths are so many times as long.
    pub(crate) fn times(self, stretch: f64) -> Accuracy {
        let [tolerance, error, grain] = [self.tolerance, self.error, self.grain].map(|length| stretch * length);
        Accuracy { tolerance, error, grain }
    }
}
