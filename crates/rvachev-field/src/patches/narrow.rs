//! The leaf over a zone.
//!
//! Where the surface is out of reach, so is a change of the sign, if the patches are all of it
//! there: the sign field need not be asked at all. The search is left as it is: started at the
//! lowest boxes that hold what can be nearest it takes some hundredths less, which is what finding
//! these boxes takes.

use super::SurfaceDistance;
use crate::{AnyField, Zone};

impl SurfaceDistance {
    /// The leaf with a simpler sign that has the same values over a zone, if there is one.
    pub(super) fn narrowed_to(&self, zone: &Zone) -> Option<SurfaceDistance> {
        if self.side.is_some() || !zone.is_finite() {
            return None;
        }
        // Lanes round their points.
        let [near, _] = self.distances(zone, 4.0 * self.roundoff(zone.reach()))?;
        let mut narrowed = self.clone();
        let is_certain = || {
            let side = self.side(zone);
            side.lo() >= 0.0 || side.hi() <= 0.0
        };
        if near > 0.0 && (self.is_whole(zone) || is_certain()) {
            let sign = self.sign.value(zone.centre.to_array());
            narrowed.side = Some(sign.signum());
            return (sign != 0.0).then_some(narrowed);
        }
        narrowed.sign = self.sign.narrowed(zone)?;
        Some(narrowed)
    }
}
