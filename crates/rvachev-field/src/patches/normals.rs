//! Which way a distance rises over a zone: against the normals of the patches that feet may be on,
//! and away from the feet, or towards them.
//!
//! ```text
//!          zone    q       The gradient at a point p is along p − q, whatever q on the patch is the foot of p. If the
//!           p .----+--     foot is on the inside of the patch, it is also along the normal there; on a crease it is
//!             ' .  |       between the normals of the patches that meet there, all of which are near.
//!                 '|
//! ```
//!
//! So a direction is a rise if it is one by the positions or by the normals of each patch: a foot on
//! a crease of patches none of which is one by its positions is between normals that all are.

use glam::DVec3;
use rvachev_num::Interval;

use super::feet::{Feet, Part, middle};
use super::{Patches, SurfaceDistance};
use crate::{Way, Zone, bits};

/// So often a patch is halved where it turns too much.
const DEEPEST: u32 = 4;

/// Between these places normals turn farther by this part of what they turn among them.
const BETWEEN: f64 = 0.25;

impl SurfaceDistance {
    /// The directions along which the value rises all over a zone, or where it is a level at least.
    pub(super) fn rising(&self, zone: &Zone, ways: &[Way], level: Option<f64>) -> u8 {
        if !self.is_whole(zone) {
            return 0;
        }
        let foot = self.patches.nearest(self.flattened(zone.centre));
        let feet = foot.and_then(|foot| self.feet(zone, foot, ways, level));
        feet.map_or(0, |(feet, patches)| self.patches.rising_from(&feet, &patches))
    }

    /// The middle of those against the normals of all patches that feet may be on.
    pub(super) fn inward_over(&self, zone: &Zone) -> Option<DVec3> {
        let foot = self.patches.nearest(self.flattened(zone.centre))?;
        let (_, patches) = self.feet(zone, foot, &[], None)?;
        let all = patches.iter().map(|part| self.patches.slopes_of(part, self.flat));
        all.reduce(|all, own| [0, 1, 2].map(|axis| all[axis].hull(own[axis])))
            .and_then(|slopes| DVec3::from_array(slopes.map(Interval::mid)).try_normalize())
    }
}

impl Patches {
    /// The directions along which the distance rises, on the feet's side, wherever these are.
    fn rising_from(&self, feet: &Feet<'_>, patches: &[Part]) -> u8 {
        let (mut left, mut count) = (bits(feet.ways, |_| true), 0);
        for patch in patches {
            let Some(found) = self.rising_by(patch, feet, left) else { continue };
            (left, count) = (left & found, count + 1);
            if left == 0 {
                return 0;
            }
        }
        if count > 0 { left } else { 0 }
    }

    /// The same by a part of a patch, of some of the ways; nothing if no foot is there.
    fn rising_by(&self, part: &Part, feet: &Feet<'_>, asked: u8) -> Option<u8> {
        let cut = feet.cut(part)?;
        let by_place = asked & bits(feet.ways, |way| feet.lead(&cut, part.off, way));
        if by_place == asked {
            return Some(asked);
        }
        let slopes = self.slopes_of(part, feet.flat);
        let found = by_place | asked & bits(feet.ways, |way| way.is_rise(slopes));
        if found == asked || self.faces[part.patch].is_flat() || part.depth == DEEPEST {
            return Some(found);
        }
        let quarters = part.quarters().map(|corners| self.part(part.patch, corners, part.depth + 1, feet.centre));
        let parts = quarters.iter().filter_map(|quarter| self.rising_by(quarter, feet, asked & !found));
        Some(found | parts.reduce(|all, own| all & own)?)
    }

    /// A box of the vectors against the normals of a part of a patch.
    pub(super) fn slopes_of(&self, part: &Part, flat: Option<usize>) -> [Interval; 3] {
        let [a, b, c] = part.corners;
        let all = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
        let places = if self.quadratics.is_empty() { &all[..1] } else { &all[..] };
        let normals = places.iter().map(|[s, t]| -self.point_and_normal(part.patch, *s, *t).1);
        let (low, high) =
            normals.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), n| (low.min(n), high.max(n)));
        let more = BETWEEN * (high - low);
        let mut slopes = [0, 1, 2].map(|axis| Interval::new(low[axis] - more[axis], high[axis] + more[axis]));
        if let Some(axis) = flat {
            slopes[axis] = Interval::point(0.0);
        }
        slopes
    }
}
