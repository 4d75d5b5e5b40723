//! Which points of a surface are beside each other, and where it is creased inwards.

use glam::DVec3;
use rvachev_num::Meter;

use crate::fit::grid::{Grid, extent};
use crate::fit::linear::median;
use crate::{Cancelled, Run};

/// Neighbours of a point that are asked for.
const COUNT: usize = 8;

/// Faces that look away from each other, by the cosine, are the two sides of a wall.
const OPPOSITE: f64 = -0.3;

/// Each point's neighbours.
pub(super) struct Neighbours {
    of: Vec<Vec<u32>>,
    /// The median distance to the nearest neighbour.
    pub(super) spacing: f64,
}

impl Neighbours {
    /// Of a cloud of any size; points in one place are neighbours.
    pub(super) fn new(points: &[DVec3], run: &Run) -> Result<Neighbours, Cancelled> {
        if points.is_empty() {
            return Ok(Neighbours { of: Vec::new(), spacing: 0.0 });
        }
        let bounds = extent(points);
        let size = bounds[1] - bounds[0];
        let cell = (6.0 * size.length_squared() / points.len() as f64).sqrt();
        let grid = Grid::new(points, bounds, cell);
        let (mut found, mut nearest) = (Vec::new(), Vec::with_capacity(points.len()));
        let mut of = vec![Vec::new(); points.len()];
        let meter = Meter::new(run, points.len());
        for (i, p) in points.iter().enumerate() {
            meter.step()?;
            grid.nearest(*p, COUNT + 1, &mut found);
            let others = found.iter().filter(|f| f.1 as usize != i);
            nearest.push(others.clone().map(|f| f.0).next().unwrap_or(0.0).sqrt());
            of[i].extend(others.map(|f| f.1));
        }
        // Both ways: an outlier's neighbours know of it as well.
        for i in 0..of.len() {
            for at in 0..of[i].len().min(COUNT) {
                let j = of[i][at] as usize;
                if !of[j].contains(&(i as u32)) {
                    of[j].push(i as u32);
                }
            }
        }
        Ok(Neighbours { of, spacing: median(&mut nearest) })
    }

    pub(super) fn of(&self, i: usize) -> &[u32] {
        &self.of[i]
    }
}

/// How two points of a surface are beside each other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Link {
    /// The surface goes on.
    Open,
    /// It turns inwards between them by more than the crease's angle.
    Crease,
    /// They are on two sides of a wall.
    Apart,
}

/// By the points' normals; `crease` is the cosine of the angle.
pub(super) fn link([p, q]: [DVec3; 2], [m, n]: [DVec3; 2], crease: f64) -> Link {
    let along = m.dot(n);
    if along < crease && (m - n).dot(p - q) < 0.0 {
        return Link::Crease;
    }
    if along < OPPOSITE { Link::Apart } else { Link::Open }
}
