//! Planes about points, each on one side of the edges near it.
//!
//! ```text
//!        .   . o | .         the neighbours of o are on both sides of the edge, and their plane is askew;
//!     . . [ . .] +----       the plane about a neighbour farther in is flat and o is on it: o takes that one
//!                | . .
//! ```
//!
//! Source of the idea: M. Kuwahara and others, *Processing of RI-angiocardiographic images* (1976).

use glam::DVec3;

use crate::fit::grid::{Grid, extent};
use crate::fit::linear::Principal;

/// Neighbours that a plane is of.
const NEIGHBOURS: usize = 14;

/// A neighbour's plane is taken that leaves less than this share of the squares that the own one
/// does.
const FLATTER: f64 = 0.3;

/// Points with planes and neighbours.
pub(super) struct Planes {
    /// Units, of either sign.
    pub(super) normals: Vec<DVec3>,
    /// From the nearest on, the point itself first.
    pub(super) neighbours: Vec<Vec<u32>>,
    /// The area that each point stands for.
    pub(super) areas: Vec<f64>,
}

impl Planes {
    pub(super) fn of(points: &[DVec3]) -> Planes {
        let bounds = extent(points);
        let diagonal = bounds[0].distance(bounds[1]);
        let grid = Grid::new(points, bounds, diagonal * (3.0 / points.len().max(1) as f64).sqrt());
        let mut found = Vec::new();
        let (mut own, mut neighbours, mut areas) = (Vec::new(), Vec::new(), Vec::new());
        for p in points {
            grid.nearest(*p, NEIGHBOURS, &mut found);
            areas.push(std::f64::consts::PI * found.last().map_or(0.0, |f| f.0) / found.len().max(1) as f64);
            let near: Vec<u32> = found.iter().map(|f| f.1).collect();
            own.push(Principal::of(near.iter().map(|i| points[*i as usize])));
            neighbours.push(near);
        }
        let normal = |i: usize| {
            let squares = |k: u32| {
                let plane = &own[k as usize];
                plane.variances[0] + plane.axes.x_axis.dot(points[i] - plane.mean).powi(2)
            };
            let best = neighbours[i].iter().copied().min_by(|a, b| squares(*a).total_cmp(&squares(*b)));
            let is_flatter = |k: &u32| squares(*k) < FLATTER * squares(i as u32);
            own[best.filter(is_flatter).map_or(i, |k| k as usize)].axes.x_axis
        };
        let normals = (0..points.len()).map(normal).collect();
        Planes { normals, neighbours, areas }
    }
}
