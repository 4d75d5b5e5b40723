//! Oriented samples of a surface, in diagonals of its box about the box's centre.
//!
//! ```text
//!     mesh     5000 points by area, and the centroid of each triangle that none of them hit
//!     cloud    4000 of its points
//! ```
//!
//! A sample's weight is its share of the area: that of its triangle, over the samples there.

use glam::DVec3;
use rvachev_num::order;

use super::corners::{Corner, Facets};
use super::orient;
use super::smooth::smooth;
use crate::fit::grid::{Grid, extent};
use crate::fit::linear::{Principal, quantile};
use crate::fit::random::Random;
use crate::geom::{Mesh, PointCloud};
use crate::{Cancelled, Run};

/// Samples by area of a mesh, and centroids besides.
const BY_AREA: usize = 5000;
const CENTROIDS: usize = 3500;

/// Points of a cloud that are searched.
const OF_CLOUD: usize = 4000;

/// Corners that are kept.
const CORNERS: usize = 6000;

/// A mesh of so many triangles whose longest sides are below this share of the diagonal, on nine
/// tenths of the area, is one of small facets.
const MANY: usize = 1000;
const SMALL: f64 = 0.05;

/// Points that are asked for the noise, their neighbours, and how many of these must face the same
/// way: so much, as a cosine.
const ASKED: usize = 200;
const NEIGHBOURS: usize = 16;
const FEWEST: f64 = 7.0;
const SAME_SIDE: f64 = 0.5;

/// What a surface was given as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A mesh of large flat facets.
    Cad,
    /// A mesh of many small facets, as of marching cubes.
    Voxels,
    /// Points.
    Scan,
}

/// Points of a surface with the normals there.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub(super) points: Vec<DVec3>,
    pub(super) normals: Vec<DVec3>,
    /// Shares of the area; their sum is 1.
    pub(super) weights: Vec<f64>,
    /// Vertices of a mesh where it is curved, with smooth normals: where facets are chords, these
    /// are on the surface.
    pub(super) corners: Vec<Corner>,
    /// The mesh; none of a cloud.
    pub(super) facets: Facets,
    /// The centre of the input's box, in length units.
    pub(super) centre: DVec3,
    /// The diagonal of the input's box, in length units.
    pub(super) size: f64,
    pub(super) kind: Kind,
    /// The standard deviation of the points' distances from the surface, in diagonals.
    pub(super) noise: f64,
}

impl Samples {
    pub(super) fn of_mesh(mesh: &Mesh, seed: u64, run: &Run) -> Result<Samples, Cancelled> {
        let all: Vec<DVec3> = mesh.positions().iter().map(|p| p.as_dvec3()).collect();
        let [low, high] = extent(&all);
        let (centre, size) = (0.5 * (low + high), (high - low).length());
        let points: Vec<DVec3> = all.iter().map(|p| (p - centre) / size).collect();
        let facets = Facets::of(points, mesh.triangles(), run)?;
        let kind = if facets.is_fine(MANY, SMALL) { Kind::Voxels } else { Kind::Cad };
        let mut random = Random::new(seed);
        let mut samples = Samples {
            points: Vec::new(),
            normals: Vec::new(),
            weights: Vec::new(),
            corners: Vec::new(),
            facets: Facets::default(),
            centre,
            size,
            kind,
            noise: 0.0,
        };
        samples.strew(&facets, &mut random);
        let corners = facets.corners(run)?;
        let mut kept = random.chosen(corners.len(), CORNERS);
        kept.sort_unstable();
        samples.corners = kept.into_iter().map(|i| corners[i]).collect();
        samples.facets = facets;
        Ok(samples)
    }

    /// Samples of the facets by area, then of those that none of them hit.
    fn strew(&mut self, facets: &Facets, random: &mut Random) {
        let total: f64 = facets.areas.iter().sum();
        let step = total / BY_AREA as f64;
        let mut hits = vec![0u32; facets.areas.len()];
        let mut homes = Vec::with_capacity(BY_AREA + CENTROIDS);
        let (mut reached, mut at) = (0.0, 0);
        for i in 0..BY_AREA {
            let target = step * (i as f64 + random.unit());
            while reached + facets.areas[at] < target && at + 1 < facets.areas.len() {
                reached += facets.areas[at];
                at += 1;
            }
            if facets.areas[at] == 0.0 {
                continue;
            }
            let [a, b, c] = facets.points(at);
            let root = random.unit().sqrt();
            let share = random.unit();
            self.points.push(a * (1.0 - root) + b * (root * (1.0 - share)) + c * (root * share));
            homes.push(at);
            hits[at] += 1;
        }
        if self.kind == Kind::Cad {
            let mut missed: Vec<usize> = (0..hits.len()).filter(|i| hits[*i] == 0 && facets.areas[*i] > 0.0).collect();
            order::falling(&mut missed, |i| facets.areas[*i]);
            missed.truncate(CENTROIDS);
            for i in missed {
                let [a, b, c] = facets.points(i);
                self.points.push((a + b + c) / 3.0);
                homes.push(i);
                hits[i] += 1;
            }
        }
        self.normals = homes.iter().map(|i| facets.normals[*i]).collect();
        self.weights = match self.kind {
            Kind::Cad => homes.iter().map(|i| facets.areas[*i] / f64::from(hits[*i])).collect(),
            _ => vec![1.0; homes.len()],
        };
        let sum: f64 = self.weights.iter().sum();
        for weight in &mut self.weights {
            *weight /= sum;
        }
    }

    /// The samples of a cloud: points with the normals that they have, or that their neighbours
    /// tell, brought nearer to the surface. Their noise is so much at least, in length units,
    /// before that.
    pub(super) fn of_cloud(cloud: &PointCloud, least_noise: f64, seed: u64, run: &Run) -> Result<Samples, Cancelled> {
        let all = cloud.positions();
        let [low, high] = extent(all);
        let (centre, size) = (0.5 * (low + high), (high - low).length());
        let mut random = Random::new(seed);
        let mut kept = random.chosen(all.len(), OF_CLOUD);
        kept.sort_unstable();
        let mut points: Vec<DVec3> = kept.iter().map(|i| (all[*i] - centre) / size).collect();
        let normals: Vec<DVec3> = match cloud.normals() {
            Some(normals) => kept.iter().map(|i| normals[*i].as_dvec3().normalize_or(DVec3::Z)).collect(),
            None => orient::normals(&points, &mut random, run)?,
        };
        let weights = vec![1.0 / points.len().max(1) as f64; points.len()];
        let noise = noise(&points, &normals, &mut random).max(least_noise / size);
        let noise = smooth(&mut points, &normals, noise);
        Ok(Samples {
            points,
            normals,
            weights,
            corners: Vec::new(),
            facets: Facets::default(),
            centre,
            size,
            kind: Kind::Scan,
            noise,
        })
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }
}

/// The noise of points: how far they are from planes through their neighbours on the same side,
/// where it is flattest.
fn noise(points: &[DVec3], normals: &[DVec3], random: &mut Random) -> f64 {
    if points.len() < NEIGHBOURS {
        return 0.0;
    }
    let grid = Grid::new(points, extent(points), (3.0 / points.len() as f64).sqrt());
    let mut found = Vec::new();
    let mut least = Vec::with_capacity(ASKED);
    for i in random.chosen(points.len(), ASKED) {
        grid.nearest(points[i], NEIGHBOURS, &mut found);
        found.retain(|f| normals[f.1 as usize].dot(normals[i]) > SAME_SIDE);
        let count = found.len() as f64;
        if count >= FEWEST {
            let plane = Principal::of(found.iter().map(|f| points[f.1 as usize]));
            least.push(plane.variances[0] * count / (count - 3.0));
        }
    }
    quantile(&mut least, 0.35).sqrt()
}
