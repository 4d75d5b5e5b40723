//! Which points are of a surface, and which are strewn about it: by their density.
//!
//! A cell is so large that 27 of them hold three points if all were spread evenly over the box. A
//! share w of strewn points makes 3w of them on average; what has many more neighbours is of a
//! surface. The share follows from the count, again and again.

use glam::DVec3;

use super::grid::{Grid, extent, volume};
use super::lonely::lonely;

/// What is found of a cloud.
pub(super) struct Dense {
    /// The points of the surface.
    pub(super) kept: Vec<usize>,
    /// The share of the strewn ones.
    pub(super) strewn: f64,
}

/// Fewer points are no surface to begin with.
const FEWEST: usize = 24;

pub(super) fn dense(points: &[DVec3]) -> Dense {
    let count = points.len();
    let bounds = extent(points);
    let cell = (volume(bounds) / (9.0 * count as f64)).cbrt();
    let crowds = Grid::new(points, bounds, cell).crowds();
    let mut strewn = 1.0;
    let mut limit = 0.0;
    for _ in 0..6 {
        let expected = 3.0 * strewn;
        limit = 1.0 + expected + 2.5 * f64::sqrt(expected);
        let few = crowds.iter().filter(|crowd| f64::from(**crowd) < limit).count();
        strewn = few as f64 / count as f64;
    }
    let mut kept: Vec<usize> = (0..count).filter(|i| f64::from(crowds[*i]) >= limit).collect();
    if kept.len() < (count / 5).max(FEWEST) {
        return Dense { kept: (0..count).collect(), strewn };
    }
    if strewn > 0.01 {
        purify(points, &mut kept, cell);
    }
    Dense { kept, strewn }
}

/// Takes out what is far from its neighbours compared with them.
fn purify(points: &[DVec3], kept: &mut Vec<usize>, cell: f64) {
    let some: Vec<DVec3> = kept.iter().map(|i| points[*i]).collect();
    // So large that the block about a point holds its neighbours most often.
    let lonely = lonely(&Grid::new(&some, extent(&some), 1.7 * cell));
    let before = kept.clone();
    let mut lonely = lonely.iter();
    kept.retain(|_| lonely.next() != Some(&true));
    if kept.len() < FEWEST {
        *kept = before;
    }
}
