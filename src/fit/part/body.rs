//! What is inside of what was given: of a mesh by its winding number, of points by that of a dipole
//! each.

use glam::{DMat3, DVec2, DVec3};
use rvachev_field::MeshLeaf;

use super::contours::Squares;
use super::dipoles::Dipoles;
use super::result::Topology;
use super::samples::Samples;
use super::sections::Ring;
use super::topology;
use crate::fit::FitError;
use crate::geom::Mesh;
use crate::{Bounds, Run};

/// The side of squares that sections of points are found in, in diagonals: about as far as points
/// are apart.
const SIDE: f64 = 0.0125;

/// What was given.
pub(super) struct Body {
    /// In length units.
    pub(super) bounds: Bounds,
    /// Genus and shells; none of points.
    pub(super) topology: Topology,
    inside: Inside,
}

enum Inside {
    Mesh(MeshLeaf),
    Points { dipoles: Dipoles, centre: DVec3, size: f64 },
}

impl Body {
    pub(super) fn of_mesh(mesh: &Mesh, run: &Run) -> Result<Body, FitError> {
        let [to_index, to_check] = run.stages([0.5, 0.5]);
        let leaf = MeshLeaf::new(mesh.positions(), mesh.triangles(), None, None, &to_index)?;
        Ok(Body { bounds: mesh.bounds(), topology: topology::of_mesh(mesh, &to_check)?, inside: Inside::Mesh(leaf) })
    }

    /// Of the points that samples of a cloud are; nothing if they face inwards.
    pub(super) fn of_points(samples: &Samples, bounds: Bounds) -> Option<Body> {
        let Samples { centre, size, .. } = *samples;
        let dipoles = Dipoles::of(&samples.points, &samples.normals);
        let encloses = dipoles.enclose();
        let inside = Inside::Points { dipoles, centre, size };
        encloses.then_some(Body { bounds, topology: Topology::default(), inside })
    }

    /// The rings in which a plane across the z axis of a frame meets the surface, in diagonals.
    pub(super) fn section(&self, samples: &Samples, frame: &DMat3, height: f64) -> Vec<Ring> {
        let Inside::Points { dipoles, .. } = &self.inside else {
            return samples.facets.rings(frame, height);
        };
        let to = frame.transpose();
        let flat: Vec<DVec2> = samples.points.iter().map(|p| (to * *p).truncate()).collect();
        let low = flat.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)) - 2.0 * SIDE;
        let high = flat.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p)) + 2.0 * SIDE;
        Squares::over([low, high], SIDE).rings(|p| dipoles.winding_number(*frame * p.extend(height)))
    }

    /// Whether a point in length units is inside.
    pub(super) fn contains(&self, p: DVec3) -> bool {
        self.winding_number(p) > 0.5
    }

    /// 1 inside and 0 outside; about that, of points.
    pub(super) fn winding_number(&self, p: DVec3) -> f64 {
        match &self.inside {
            Inside::Mesh(leaf) => leaf.winding_number(p),
            Inside::Points { dipoles, centre, size } => dipoles.winding_number((p - *centre) / *size),
        }
    }
}
