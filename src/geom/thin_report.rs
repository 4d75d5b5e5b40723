//! Where a solid is thinner than cells show: places and sizes.

use std::fmt;

use glam::DVec3;

use super::figures::{point, size};
use rvachev_num::figures;

/// Thin features of a solid: walls, gaps, needles and holes that cells of a size may not show.
///
/// It is what [`Solid::thin_features`](crate::Solid::thin_features) finds. The default is that of a
/// solid without any.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ThinReport {
    /// The side of the cells that were searched, in length units.
    pub cell: f64,
    /// How many cells may hold a thin feature, over all places.
    pub cells: usize,
    /// How many places there are; [`places`](ThinReport::places) lists the first.
    pub count: usize,
    /// The places of most cells, at most [`LISTED`](ThinReport::LISTED), in descending order of
    /// their numbers of cells.
    pub places: Vec<ThinPlace>,
}

/// A place where a solid, or what is around it, may be thinner than cells show: cells that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ThinPlace {
    /// A point on the feature if its thickness is known, or else in one of its cells.
    pub position: DVec3,
    /// The size of the box of its cells, in length units.
    pub size: DVec3,
    /// The estimated least thickness of a wall, or width of a gap, in length units; `None` if none
    /// was found, for ranges are wider than what they hold.
    pub thickness: Option<f64>,
    /// How many cells it is in.
    pub cells: usize,
}

impl ThinReport {
    /// The most places that are listed.
    pub const LISTED: usize = 64;

    /// Whether there is no place.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// As lines of text: a summary, then the places.
impl fmt::Display for ThinReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} thin places in {} cells of {}", self.count, self.cells, figures(self.cell, 5))?;
        for place in &self.places {
            write!(f, "\n{}, {}", point(place.position, self.cell), size(place.size))?;
            match place.thickness {
                Some(thickness) => write!(f, ", about {} thick", figures(thickness, 4))?,
                None => f.write_str(", thickness unknown")?,
            }
        }
        Ok(())
    }
}
