//! A distance that counts on one side of a surface.

use std::sync::Arc;

use glam::DVec3;

use crate::{Dual, Interval};
use rvachev_field::{AnyField, Zone};

/// A value that is a distance, on one side.
#[derive(Clone, Debug)]
pub(super) struct Signed {
    pub(super) field: Arc<dyn AnyField>,
    /// 1 where its value counts as it is, −1 where its negative does.
    pub(super) sign: f64,
}

impl Signed {
    pub(super) fn value(&self, p: DVec3) -> f64 {
        self.sign * self.field.value(p.to_array())
    }

    pub(super) fn range(&self, zone: &Zone) -> Interval {
        self.field.range(zone) * Interval::point(self.sign)
    }

    pub(super) fn slope(&self, p: DVec3) -> DVec3 {
        self.sign * DVec3::from_array(self.field.dual(Dual::point(p.to_array())).gradient())
    }
}
