//! Where a fillet or chamfer rises along a direction, and how steeply.

use glam::DVec3;

use super::{EdgeBlend, Shape};
use crate::{Dual, Interval, Real};
use rvachev_field::{AnyField, Way, Zone};

impl EdgeBlend {
    /// The operands' gradients at a point, as they count in the blend.
    pub(in crate::eval) fn operand_slopes(&self, p: [Dual<f64>; 3]) -> [DVec3; 2] {
        [0, 1].map(|i| self.sign * self.signs[i] * DVec3::from_array(self.operands[i].evaluate(p, &mut Vec::new()).d))
    }

    /// With both operands, as far away as the nearest centre is, so does the distance to where neither a ball's centre
    /// may be. What is outside of it is a union of balls, and what a chamfer takes is a plane's: where the zone is small
    /// beside them nothing turns round in it but the operands.
    pub(super) fn rising(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let is_wide = self.size() > 2.0 * zone.radius();
        let far = match &self.shape {
            _ if is_wide => 0.0,
            Shape::Fillet(fillet, _) => self.value(zone.centre.to_array()).abs() + zone.radius() + fillet.radius,
            Shape::Chamfer(_) => return 0,
        };
        let about = zone.inflated(far);
        let turned =
            |i: usize| -> Vec<Way> { ways.iter().map(|way| way.flip_if(self.sign * self.signs[i] < 0.0)).collect() };
        self.operands[0].rises(&about, &turned(0)) & self.operands[1].rises(&about, &turned(1))
    }

    /// The most that the blend changes by per length unit over a zone; infinite where nothing is known.
    pub(super) fn steepest_in(&self, zone: &Zone) -> f64 {
        match &self.shape {
            Shape::Fillet(fillet, sides) => {
                let join = self.ranges(zone).into_iter().reduce(Interval::max).unwrap_or(Interval::ALL);
                self.fillet_range(*fillet, sides, join, zone).1
            }
            Shape::Chamfer(_) => f64::INFINITY,
        }
    }
}
