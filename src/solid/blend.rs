//! Stand-in for the blends of the core: sharp joins.

use super::Solid;
use crate::RFunction;

/// How an edge between two solids is taken off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Blend {
    /// Rounded with this radius.
    Fillet { radius: f64 },
    /// Bevelled with this width.
    Chamfer { width: f64 },
}

impl Solid {
    pub(crate) fn intersection_with(&self, other: &Solid, _blend: Blend) -> Solid {
        self.intersection(other, RFunction::MIN_MAX)
    }
}
