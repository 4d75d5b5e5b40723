//! What a fit found.

use glam::{DAffine3, DQuat, DVec3};

use super::covariance::Covariance;
use super::deformed::DeformedSuperellipsoid;
use super::deviations::Deviation;
use crate::{Solid, Superellipsoid, Supershape, rad};

/// The leaf that was found, in its local coordinates.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A superellipsoid.
    Superellipsoid(Superellipsoid),
    /// A supershape.
    Supershape(Supershape),
    /// A superellipsoid that is tapered, twisted and bent.
    Deformed(DeformedSuperellipsoid),
}

/// A solid that was found among points, and how well it explains them.
#[derive(Clone, Debug)]
pub struct Fit {
    pub(super) shape: Shape,
    pub(super) rotation: DQuat,
    pub(super) translation: DVec3,
    pub(super) weights: Vec<f32>,
    pub(super) inliers: f64,
    pub(super) noise: f64,
    pub(super) deviation: Deviation,
    pub(super) covariance: Covariance,
    pub(super) criterion: f64,
    pub(super) search: SearchReport,
}

/// What a fit tried on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SearchReport {
    /// How many models were descended from: starts, and switches between them.
    pub starts: usize,
    /// How often the residual of a point was evaluated, most often with its derivatives.
    pub evaluations: usize,
    /// The points are of one side of the object only: what is behind is a guess.
    pub one_sided: bool,
    /// Many points were found to be of a plane that the object stands on, and left out.
    pub table: bool,
    /// No axis was found that the radii of a supershape repeat about: its symmetry numbers are a
    /// guess.
    pub symmetry_unclear: bool,
}

impl Shape {
    /// The solid in its local coordinates.
    pub(super) fn solid(&self) -> Solid {
        match self {
            Shape::Superellipsoid(leaf) => Solid::from(*leaf),
            Shape::Supershape(leaf) => Solid::from(leaf.clone()),
            Shape::Deformed(DeformedSuperellipsoid { leaf, taper: [kx, ky], twist, bend }) => Solid::from(*leaf)
                .taper(*kx, *ky, 2.0 * leaf.semi_axes().z)
                .twist(rad(*twist))
                .bend(bend.length(), rad(bend.to_angle())),
        }
    }
}

impl Fit {
    /// The solid, where it was found.
    #[must_use]
    pub fn solid(&self) -> Solid {
        let leaf = self.shape.solid();
        leaf.affine(DAffine3::from_rotation_translation(self.rotation, self.translation))
    }

    /// The leaf, in its local coordinates.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// From local to world coordinates: world point = rotation · local point + translation.
    #[must_use]
    pub fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// The centre in world coordinates, in length units.
    #[must_use]
    pub fn translation(&self) -> DVec3 {
        self.translation
    }

    /// For each point of the cloud the chance that it is of the surface, 0 to 1.
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// The share of the points that are of the surface: the mean of the weights.
    #[must_use]
    pub fn inliers(&self) -> f64 {
        self.inliers
    }

    /// The standard deviation of the points of the surface from it, in length units.
    #[must_use]
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// How far the points are from the surface whose weight is above a half, to first order.
    #[must_use]
    pub fn deviation(&self) -> Deviation {
        self.deviation
    }

    /// How certain the parameters are.
    #[must_use]
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// How well the fit explains the points that were searched, each parameter at its price
    /// (Schwarz's criterion): ln L − p/2·ln n of n points and p parameters. Of several fits of one
    /// cloud with the same settings the largest is the best; alone it means nothing. Where a
    /// [table](SearchReport::table) was taken out it cannot be compared: other kinds know of none.
    #[must_use]
    pub fn criterion(&self) -> f64 {
        self.criterion
    }

    /// What was tried.
    #[must_use]
    pub fn search(&self) -> SearchReport {
        self.search
    }
}
