//! Oriented samples of a surface, in diagonals of its box about the box's centre.

use glam::DVec3;

use crate::geom::{Mesh, PointCloud};

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
    /// The centre of the input's box, in length units.
    pub(super) centre: DVec3,
    /// The diagonal of the input's box, in length units.
    pub(super) size: f64,
    pub(super) kind: Kind,
    /// The standard deviation of the points' distances from the surface, in diagonals.
    pub(super) noise: f64,
}

impl Samples {
    pub(super) fn of_mesh(_mesh: &Mesh, _seed: u64) -> Samples {
        todo!()
    }

    /// The samples of a cloud with normals.
    pub(super) fn of_cloud(_cloud: &PointCloud, _normals: &[DVec3], _seed: u64) -> Samples {
        todo!()
    }
}
