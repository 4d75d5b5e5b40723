//! What the programs of one solid share: leaves in place, and the frames of deformations.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::solid::Trail;
use crate::{Bounds, Interval, Real};
use rvachev_field::{AnyField, AnyWarp, Placement, Zone};

/// Leaves and frames of a compiled solid.
///
/// Frame 0 is the world. Every deformation opens a frame: its points are the pre-images of
/// points of the parent frame. Parents come before their children.
#[derive(Default)]
pub(crate) struct Scene {
    pub(crate) frames: Vec<Frame>,
    pub(crate) leaves: Vec<Instance>,
    /// The leaves that have more than one part, in their order.
    pub(crate) parted: Vec<Parted>,
    pub(crate) trail: Trail,
}

/// A leaf of several parts, whose owners are told apart.
pub(crate) struct Parted {
    pub(crate) leaf: u32,
    /// How many parts of leaves before are told apart from the first of their leaf.
    pub(crate) before: usize,
    /// How many it has.
    pub(crate) count: usize,
}

/// The frame behind a deformation.
pub(crate) struct Frame {
    pub(crate) parent: u32,
    /// From the parent frame to where the deformation acts.
    pub(crate) to_local: DAffine3,
    pub(crate) warp: Arc<dyn AnyWarp>,
}

/// A leaf in its place.
#[derive(Clone)]
pub(crate) struct Instance {
    /// Its number in the scene.
    pub(crate) number: u32,
    pub(crate) field: Arc<dyn AnyField>,
    pub(crate) frame: u32,
    /// From the frame to the leaf's own coordinates.
    pub(crate) to_local: DAffine3,
    /// With the factor and the shift of its value.
    pub(crate) placement: Placement,
    /// The leaf's box in its frame.
    pub(crate) bounds: Bounds,
    /// The step of the trail that leads to it.
    pub(crate) step: u32,
}

impl Instance {
    /// A sound range over a zone of the leaf's own coordinates, as it counts outside of them.
    pub(crate) fn placed_range(&self, zone: &Zone) -> Interval {
        self.placed(self.field.range(zone))
    }

    /// Whether two points show that a zone of its frame holds inside and outside: the farthest from
    /// the leaf's middle, and the nearest. What they do not show is open.
    ///
    /// ```text
    ///     +-------*     Most leaves that cross a zone are inside at the corner that is nearest to their
    ///     |  _    |     middle, and outside at the farthest one. That costs two values, a range some
    ///     *-' \   |     ten.
    /// ```
    pub(crate) fn is_crossed(&self, zone: &Zone) -> bool {
        if !self.bounds.is_finite() || !self.field.is_steady() {
            return false;
        }
        let from = zone.centre - self.bounds.center();
        let (mut near, mut far) = (zone.centre, zone.centre);
        for axis in [zone.axes.x_axis, zone.axes.y_axis, zone.axes.z_axis] {
            let along = axis.dot(from);
            far += axis * along.signum();
            near -= axis * (along / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
        }
        let is_inside = |p: DVec3| self.placement.finish(self.field.value(self.placement.apply(p.to_array()))) > 0.0;
        // Beyond the box there is no need of a value.
        is_inside(near) && !(self.bounds.contains(far) && is_inside(far))
    }

    /// A range over a zone of its frame by one value, of leaves whose values change by no more than
    /// lengths do.
    pub(crate) fn range_about(&self, zone: &Zone) -> Interval {
        if !(self.field.convex() || self.field.exact()) || !self.field.is_steady() {
            return Interval::ALL;
        }
        let zone = zone.mapped(&self.to_local);
        let reach = zone.radius();
        let rounding = 1e-14 * (zone.centre.abs().max_element() + reach);
        self.placed(Interval::around(self.field.value(zone.centre.to_array()), reach + rounding))
    }

    /// A range of the leaf's own values, as it counts outside of it.
    pub(crate) fn placed(&self, own: Interval) -> Interval {
        own.scale_add(self.placement.scale, Interval::point(self.placement.shift))
    }
}

impl Scene {
    /// Adds a leaf.
    pub(crate) fn add(&mut self, leaf: Instance) {
        let count = leaf.field.parts().len();
        if count > 1 {
            let before = self.parted.last().map_or(0, |last| last.before + last.count - 1);
            self.parted.push(Parted { leaf: leaf.number, before, count });
        }
        self.leaves.push(leaf);
    }

    /// The frame with this number; the world is no [`Frame`].
    pub(crate) fn frame(&self, number: u32) -> Option<&Frame> {
        number.checked_sub(1).map(|index| &self.frames[index as usize])
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Scene({} leaves, {} frames)", self.leaves.len(), self.frames.len())
    }
}
