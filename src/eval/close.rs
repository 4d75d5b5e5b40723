//! Ranges that tell how far from 0 a value stays, not only its sign.
//!
//! ```text
//!     +-----------+     Of a convex leaf the value is concave: it is least at a corner of a zone, and below the
//!     |     c     |     plane that touches its graph over the middle c. A distance d from a surface has a
//!     +-----------+     square that is concave when |x|² is taken from it: where the corners are that far
//!      ~~~~~~~~~~~      from the surface, the zone is less near by the square of its size only.
//! ```

use glam::DVec3;

use super::program::Program;
use super::scene::Instance;
use crate::Interval;
use rvachev_field::Zone;
use rvachev_num::Dual;

/// What values may be off by rounding, as a part of the coordinates.
const ROUNDING: f64 = 1e-13;

impl Program {
    /// A range over a zone, as close as values at its corners and in its middle make it, of leaves
    /// that are not deformed.
    pub(crate) fn close_range(&self, zone: &Zone) -> Interval {
        self.range_of_leaves(|leaf| {
            let instance = self.instance(leaf);
            instance.placed(close(instance, &zone.mapped(&instance.to_local)))
        })
    }
}

/// The range of a leaf's own values over a zone of its own coordinates.
fn close(instance: &Instance, zone: &Zone) -> Interval {
    let field = &instance.field;
    let coarse = field.range(zone);
    if !zone.is_finite() || !(field.convex() || field.exact()) {
        return coarse;
    }
    let axes = [zone.axes.x_axis, zone.axes.y_axis, zone.axes.z_axis];
    let slack = zone.slack.length() + ROUNDING * zone.reach();
    let corners = (0..8u32).filter(|n| *n < 4 || axes[2] != DVec3::ZERO).map(|n| {
        let along = |k: usize| if n >> k & 1 == 0 { -axes[k] } else { axes[k] };
        zone.centre + along(0) + along(1) + along(2)
    });
    let values = corners.map(|corner| field.value(corner.to_array()));
    if field.convex() {
        let low = values.fold(f64::INFINITY, f64::min) - slack;
        let along = |axis: usize| Dual::new(zone.centre[axis], [0, 1, 2].map(|k| f64::from(u8::from(k == axis))));
        let middle = field.dual([0, 1, 2].map(along));
        let slope = DVec3::from_array(middle.gradient());
        let rise: f64 = axes.iter().map(|axis| slope.dot(*axis).abs()).sum();
        let high = middle.value() + rise * (1.0 + 1e-9) + slack;
        return if low <= high { coarse.narrowed_by(Interval::new(low, high)) } else { coarse };
    }
    let spread: f64 = axes.iter().map(|axis| axis.length_squared()).sum();
    let (mut least, mut inside) = (f64::INFINITY, false);
    for value in values {
        (least, inside) = (least.min(value.abs()), value > 0.0);
    }
    // No surface is that near, so that all of the zone is on one side of it.
    let near = (least * least - spread).max(0.0).sqrt() - slack;
    if near <= 0.0 {
        return coarse;
    }
    let side = if inside { Interval::new(near, f64::INFINITY) } else { Interval::new(f64::NEG_INFINITY, -near) };
    coarse.narrowed_by(side)
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::distance::compiled;
    use crate::{Profile, Solid};

    /// Numbers from -1 to 1.
    struct Random(u64);

    impl Random {
        fn number(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn vector(&mut self) -> DVec3 {
            DVec3::new(self.number(), self.number(), self.number())
        }
    }

    #[test]
    fn values_are_in_close_ranges_over_oblique_zones() {
        let star: Vec<[f64; 2]> = (0..10)
            .map(|k| {
                let (angle, radius) = (f64::from(k) * std::f64::consts::PI / 5.0, if k % 2 == 0 { 2.0 } else { 0.8 });
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let solids = [
            Solid::cuboid([2.0, 3.0, 1.0]),
            Solid::torus(2.0, 0.5),
            Solid::superellipsoid([1.0, 1.5, 2.0], 0.6, 0.8),
            Profile::polygon(star).extrude(1.5),
        ];
        let mut random = Random(7);
        for solid in solids {
            let turned = solid.rotate_x(crate::deg(20.0)).translate([0.3, -0.2, 0.1]);
            let program = &compiled(&turned).unwrap().surface;
            let mut closer = 0;
            for number in 0..600 {
                let size = 0.5f64.powi(number % 8);
                let axes = DMat3::from_cols(random.vector(), random.vector(), random.vector()) * size;
                // Every third is a parallelogram, as patches have them.
                let flat = DMat3::from_cols(axes.x_axis, axes.y_axis, DVec3::ZERO);
                let zone = Zone::of_frame(3.0 * random.vector(), if number % 3 == 0 { flat } else { axes });
                let (close, coarse) = (program.close_range(&zone), program.range_zone(&zone));
                closer += u32::from(close.hi() < coarse.hi() || close.lo() > coarse.lo());
                for sample in 0..20 {
                    // Half of them at corners.
                    let at = random.vector();
                    let at = if sample % 2 == 0 { at } else { at.signum() };
                    let value = program.value(zone.centre + zone.axes * at);
                    assert!(
                        close.lo() - 1e-12 <= value && value <= close.hi() + 1e-12,
                        "{value} is not in {close:?} of {zone:?}"
                    );
                }
            }
            assert!(closer > 100, "{closer}");
        }
    }
}
