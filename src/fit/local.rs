//! What the neighbourhoods of a few points tell: the roughness of the surface, and whether it is
//! seen from one side.

use glam::DVec3;

use super::grid::{Grid, extent};
use super::linear::{Principal, median};
use super::random::Random;

/// Points that are asked, and their neighbours.
const ASKED: usize = 100;
const NEIGHBOURS: usize = 10;

/// Mean normals longer than this are of one-sided views: complete surfaces have at most 0.22, views
/// 0.43 or more.
const ONE_SIDED: f64 = 0.35;

pub(super) struct Local {
    /// The standard deviation from local planes: noise, and curvature.
    pub(super) rough: f64,
    /// The mean direction that a surface faces that is seen from one side.
    pub(super) view: Option<DVec3>,
}

/// Of dense points, with their normals if they are known.
pub(super) fn local(points: &[DVec3], normals: Option<&[DVec3]>, random: &mut Random) -> Local {
    let bounds = extent(points);
    let size = bounds[1] - bounds[0];
    // Of a surface in a box of this size, a cell this large holds a few points.
    let cell = (3.0 * size.length_squared() / points.len() as f64).sqrt();
    let grid = Grid::new(points, bounds, cell);
    let centroid = points.iter().sum::<DVec3>() / points.len() as f64;
    let (mut found, mut least, mut mean) = (Vec::new(), Vec::new(), DVec3::ZERO);
    let asked = random.chosen(points.len(), ASKED);
    for &i in &asked {
        grid.nearest(points[i], NEIGHBOURS, &mut found);
        let plane = Principal::of(found.iter().map(|f| points[f.1 as usize]));
        least.push(plane.variances[0]);
        let normal = normals.map_or(plane.axes.x_axis, |normals| normals[i]);
        let out = if normals.is_some() || normal.dot(points[i] - centroid) >= 0.0 { normal } else { -normal };
        mean += out / asked.len() as f64;
    }
    let free = NEIGHBOURS as f64 / (NEIGHBOURS as f64 - 3.0);
    Local { rough: (median(&mut least) * free).sqrt(), view: (mean.length() > ONE_SIDED).then(|| mean.normalize()) }
}
