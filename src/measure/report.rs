//! What is measured of a solid.

use std::fmt;

use glam::{DMat3, DVec3};

use rvachev_num::figures;

/// Volume, centroid, inertia and area of a solid, each with how far it may be off:
/// [`Solid::measure`](crate::Solid::measure).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasureReport {
    /// The volume, in cubic length units; 0 of an empty solid.
    pub volume: f64,
    /// The volume is within this of the true one. It is certain.
    pub volume_error: f64,
    /// The centroid; `None` if the volume is 0.
    pub centroid: Option<DVec3>,
    /// Each coordinate of the centroid is within this of the true one, in length units. It is
    /// certain; infinite if the volume may be 0.
    pub centroid_error: f64,
    /// The inertia tensor about the centroid, for density 1, in length units to the fifth power:
    /// ∫ (r²·1 − r rᵀ) dV with r from the centroid. `None` if the volume is 0.
    pub inertia: Option<DMat3>,
    /// Each entry of the inertia tensor is within this of the true one. It is certain; infinite if
    /// the volume may be 0.
    pub inertia_error: f64,
    /// The area of the surface, in square length units.
    pub area: f64,
    /// The area is within this of the true one, if that is certain; else this is an estimate. Of
    /// lengths that are measured it is that of what was measured.
    pub area_error: f64,
    /// Whether `area_error` is certain.
    pub is_area_certain: bool,
    /// Whether all of it is known in closed form, right to rounding.
    pub is_closed_form: bool,
}

impl MeasureReport {
    /// That of a solid with nothing in it.
    pub(super) fn empty() -> MeasureReport {
        MeasureReport {
            volume: 0.0,
            volume_error: 0.0,
            centroid: None,
            centroid_error: 0.0,
            inertia: None,
            inertia_error: 0.0,
            area: 0.0,
            area_error: 0.0,
            is_area_certain: true,
            is_closed_form: true,
        }
    }
}

impl fmt::Display for MeasureReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [volume, area] = [self.volume, self.area].map(|x| figures(x, 6));
        let [of_volume, of_area] = [self.volume_error, self.area_error].map(|x| figures(x, 2));
        write!(f, "volume {volume} ± {of_volume}, area {area} ± {of_area}")?;
        match self.centroid {
            Some(at) => {
                let [x, y, z] = at.to_array().map(|x| figures(x, 6));
                write!(f, ", centroid ({x}, {y}, {z})")
            }
            None => f.write_str(", empty"),
        }
    }
}
