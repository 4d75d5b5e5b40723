//! Regions as the leaves of a program see them: where their points are, and how far rounding moves
//! these.

use glam::DAffine3;

use rvachev_field::{AnyField, AnyWarp, Zone};

/// How a region looks in a frame, and how far its points may be off in single precision.
pub(super) struct Seen {
    zone: Zone,
    error: f64,
}

impl Seen {
    /// The region itself, whose points are exact.
    pub(super) fn world(zone: Zone) -> Seen {
        Seen { zone, error: 0.0 }
    }

    /// How it looks behind a map and a deformation.
    pub(super) fn through(&self, to_local: &DAffine3, warp: &dyn AnyWarp) -> Seen {
        let local = self.zone.mapped(to_local);
        let stretch = warp.stretch(local.hull());
        let error = self.coordinate_error(to_local, &local) * stretch + warp.roundoff_over(local.hull());
        Seen { zone: local.warped(warp), error }
    }

    /// By how much coordinates after an affine map may be off.
    fn coordinate_error(&self, to_local: &DAffine3, local: &Zone) -> f64 {
        let m = to_local.matrix3;
        self.error * m.abs().row(0).element_sum().max(m.abs().row(1).element_sum()).max(m.abs().row(2).element_sum())
            + 3e-7 * local.reach()
    }

    /// How far a leaf's values may be off, before they are scaled.
    pub(super) fn leaf_error(&self, to_local: &DAffine3, field: &dyn AnyField) -> f64 {
        let local = self.zone.mapped(to_local);
        let reach = local.reach();
        let own = field.roundoff_over(local.hull());
        // A leaf's bound allows for coordinates that are off by some rounding errors of
        // their own; more than that counts in proportion.
        let error = self.coordinate_error(to_local, &local);
        let factor = if reach > 0.0 { (error / (1e-6 * reach)).max(1.0) } else { 1.0 };
        let error = own * factor;
        if error.is_nan() { f64::INFINITY } else { error }
    }
}
