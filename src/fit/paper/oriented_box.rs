//! Boxes that segments are truncated by.
//!
//! ```text
//!     y = Rᵀ(p − c)     B = 1 − max |yₖ|/hₖ     positive inside
//! ```

use glam::{DMat3, DVec3};

use crate::fit::linear::Principal;

/// What it takes to tell a box: half-widths, a rotation and a centre.
pub(super) const PARAMETERS: usize = 9;

/// A box anywhere: half-widths along the columns of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OrientedBox {
    pub(super) rotation: DMat3,
    pub(super) center: DVec3,
    pub(super) half: DVec3,
}

impl OrientedBox {
    /// The smallest of the boxes of points along their principal axes and along other ones.
    pub(super) fn smallest(points: &[DVec3], others: &[DMat3]) -> OrientedBox {
        let principal = Principal::of(points.iter().copied()).axes;
        let mut best = OrientedBox::along(points, principal);
        for axes in others {
            let other = OrientedBox::along(points, *axes);
            if other.half.element_product() < best.half.element_product() {
                best = other;
            }
        }
        best
    }

    fn along(points: &[DVec3], rotation: DMat3) -> OrientedBox {
        let to = rotation.transpose();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in points {
            let y = to * *p;
            (low, high) = (low.min(y), high.max(y));
        }
        let half = 0.5 * (high - low);
        let half = half.max(DVec3::splat(1e-6 * half.max_element().max(f64::MIN_POSITIVE)));
        OrientedBox { rotation, center: rotation * (0.5 * (low + high)), half }
    }

    pub(super) fn local(&self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * (p - self.center)
    }

    /// B at a point.
    pub(super) fn value(&self, p: DVec3) -> f64 {
        1.0 - (self.local(p).abs() / self.half).max_element()
    }

    /// How deep a point is inside, negative outside, in length units.
    pub(super) fn depth(&self, p: DVec3) -> f64 {
        (self.half - self.local(p).abs()).min_element()
    }

    /// How far the box reaches in a direction from a point.
    pub(super) fn end_along(&self, direction: DVec3, from: DVec3) -> f64 {
        let reach = (self.rotation.transpose() * direction).abs().dot(self.half);
        direction.dot(self.center - from) + reach
    }

    /// With every side moved outwards.
    pub(super) fn grown(&self, by: f64) -> OrientedBox {
        OrientedBox { half: self.half + by, ..*self }
    }

    /// With one side moved outwards.
    pub(super) fn extended(&self, side: Side, by: f64) -> OrientedBox {
        let mut other = *self;
        other.half[side.axis] += 0.5 * by;
        other.center += side.direction(self) * (0.5 * by);
        other
    }
}

/// A side of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Side {
    pub(super) axis: usize,
    pub(super) is_high: bool,
}

impl Side {
    pub(super) const ALL: [Side; 6] = [
        Side { axis: 0, is_high: false },
        Side { axis: 0, is_high: true },
        Side { axis: 1, is_high: false },
        Side { axis: 1, is_high: true },
        Side { axis: 2, is_high: false },
        Side { axis: 2, is_high: true },
    ];

    /// Outwards.
    pub(super) fn direction(self, of: &OrientedBox) -> DVec3 {
        of.rotation.col(self.axis) * if self.is_high { 1.0 } else { -1.0 }
    }

    /// How far a point inside of a box is from this side of it.
    pub(super) fn away(self, of: &OrientedBox, p: DVec3) -> f64 {
        of.half[self.axis] - self.direction(of).dot(p - of.center)
    }
}
