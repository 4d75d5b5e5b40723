//! What the programs of one solid share: leaves in place, and the frames of deformations.

use std::fmt;
use std::sync::Arc;

use glam::DAffine3;

use crate::Bounds;
use crate::field::{AnyField, AnyWarp, Placement};
use crate::solid::Trail;

/// Leaves and frames of a compiled solid.
///
/// Frame 0 is the world. Every deformation opens a frame: its points are the pre-images of
/// points of the parent frame. Parents come before their children.
#[derive(Default)]
pub(crate) struct Scene {
    pub(crate) frames: Vec<Frame>,
    pub(crate) leaves: Vec<Instance>,
    pub(crate) trail: Trail,
}

/// The frame behind a deformation.
pub(crate) struct Frame {
    pub(crate) parent: u32,
    /// From the parent frame to where the deformation acts.
    pub(crate) to_local: DAffine3,
    pub(crate) warp: Arc<dyn AnyWarp>,
}

/// A leaf in its place.
pub(crate) struct Instance {
    pub(crate) field: Arc<dyn AnyField>,
    pub(crate) frame: u32,
    /// From the frame to the leaf's own coordinates.
    pub(crate) to_local: DAffine3,
    pub(crate) scale: f64,
    pub(crate) placement: Placement,
    /// The leaf's box in its frame.
    pub(crate) bounds: Bounds,
    /// The step of the trail that leads to it.
    pub(crate) step: u32,
}

impl Scene {
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
