//! How long the stages of a recovery took.

use std::time::Instant;

/// How long the stages of the recovery of a part took, in seconds by the wall clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PartTimes {
    /// The mesh checked and indexed, and samples of its surface.
    pub sampling: f64,
    /// Planes, cylinders, cones, spheres and tori among the samples.
    pub detection: f64,
    /// Points in space and beside the surface, and whether they are inside.
    pub queries: f64,
    /// Leaves in question.
    pub proposals: f64,
    /// The search over trees.
    pub selection: f64,
    /// Leaves fitted to the samples.
    pub refinement: f64,
    /// Leaves laid through the vertices, and numbers made round.
    pub snapping: f64,
    /// Genus and shells.
    pub topology: f64,
    /// The volume in common, deviations, names.
    pub measures: f64,
}

impl PartTimes {
    /// All of them with their names, in the order of the stages.
    #[must_use]
    pub fn stages(&self) -> [(&'static str, f64); 9] {
        [
            ("sampling", self.sampling),
            ("detection", self.detection),
            ("queries", self.queries),
            ("proposals", self.proposals),
            ("selection", self.selection),
            ("refinement", self.refinement),
            ("snapping", self.snapping),
            ("topology", self.topology),
            ("measures", self.measures),
        ]
    }
}

/// A watch that tells how long it is since it was last asked.
pub(super) struct Clock(Instant);

impl Clock {
    pub(super) fn start() -> Clock {
        Clock(Instant::now())
    }

    pub(super) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        now.duration_since(std::mem::replace(&mut self.0, now)).as_secs_f64()
    }
}
