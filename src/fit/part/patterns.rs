//! Equal leaves on a line, a ring or a grid.
//!
//! ```text
//!     o  o  o  o           o           o   o   o
//!                       o     o        o   o   o
//!       line              o o          o   o   o
//! ```

use glam::DVec3;

use super::result::{PartFit, PartLeaf};

/// Equal leaves that are placed by a rule.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pattern {
    /// Their places in [`PartFit::leaves`], in the order of the rule.
    pub leaves: Vec<usize>,
    /// Where they are.
    pub layout: Layout,
}

/// Where the leaves of a pattern are, in length units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Layout {
    /// Two or more, each a step from the one before.
    Line {
        /// The centre of the first.
        first: DVec3,
        /// From one to the next.
        step: DVec3,
    },
    /// Two or more at equal angles all around an axis, and turned about it each from the one
    /// before.
    Ring {
        /// The middle.
        centre: DVec3,
        /// The unit axis.
        axis: DVec3,
        /// From the middle to the centre of the first.
        first: DVec3,
    },
    /// Rows of columns, two or more of each; the columns of a row follow each other.
    Grid {
        /// The centre of the first.
        first: DVec3,
        /// From one to the next in a row, and from one row to the next.
        steps: [DVec3; 2],
        /// Leaves of a row, and rows.
        counts: [usize; 2],
    },
}

impl Layout {
    /// How many numbers tell it, beside where its first leaf is: 4 of a line, its step and a count;
    /// 3 of a ring, where its axis is and a count; 8 of a grid.
    #[must_use]
    pub fn parameters(&self) -> usize {
        match self {
            Layout::Ring { .. } => 3,
            Layout::Line { .. } => 4,
            Layout::Grid { .. } => 8,
        }
    }
}

impl Pattern {
    /// What it is called: as the first of its leaves in the list, wherever the rule begins.
    pub(super) fn name<'a>(&self, leaves: &'a [PartLeaf]) -> &'a str {
        self.leaves.iter().min().map_or("", |first| &leaves[*first].name)
    }
}

impl PartFit {
    /// Leaves that are equal but for their places, which are on a line, a ring or a grid: of the
    /// leaves of the same kind and sizes that nothing of the other sign comes between, where a
    /// pattern takes fewer numbers than its leaves. A leaf is in one pattern at most. Those that
    /// save most come first. In the [solid](PartFit::solid) a pattern is its first leaf, repeated.
    ///
    /// ```
    /// use rvachev::fit::{Layout, PartSettings, part};
    /// use rvachev::{MeshSettings, Solid};
    ///
    /// let hole = |x: f64| Solid::cylinder(3.0, 20.0).translate([x, 0.0, 0.0]);
    /// let plate = Solid::cuboid([60.0, 20.0, 8.0]) - hole(-20.0) - hole(0.0) - hole(20.0);
    /// let found = part(&plate.mesh(&MeshSettings::default())?, &PartSettings::default())?;
    /// let patterns = found.patterns();
    /// let Layout::Line { step, .. } = patterns[0].layout else { panic!("a line") };
    /// assert!(patterns[0].leaves.len() == 3 && (step.x.abs() - 20.0).abs() < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn patterns(&self) -> &[Pattern] {
        &self.patterns
    }
}
