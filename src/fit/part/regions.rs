//! Regions of a surface, each of one plane, cylinder, cone, sphere or torus.

use glam::{DMat3, DVec3};

use super::samples::Samples;
use crate::Run;
use crate::fit::FitError;

/// Samples that one form explains.
#[derive(Clone, Debug)]
pub(super) struct Region {
    pub(super) form: Form,
    /// Indices of samples.
    pub(super) points: Vec<u32>,
    /// Their share of the area.
    pub(super) share: f64,
    /// 1 if the normals point away from the axis or centre, −1 in a hole; 1 of planes.
    pub(super) sign: f64,
}

/// What a region is of. Axes and normals are units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// The points p with p·normal = offset.
    Plane {
        normal: DVec3,
        offset: f64,
    },
    /// From along[0] to along[1] from the origin on the axis; the arc is in degrees.
    Cylinder {
        axis: DVec3,
        origin: DVec3,
        radius: f64,
        along: [f64; 2],
        arc: f64,
    },
    /// The radius is that at the origin; the slope is its change by length along the axis.
    Cone {
        axis: DVec3,
        origin: DVec3,
        radius: f64,
        slope: f64,
        along: [f64; 2],
        arc: f64,
    },
    Sphere {
        centre: DVec3,
        radius: f64,
    },
    Torus {
        axis: DVec3,
        centre: DVec3,
        major: f64,
        minor: f64,
    },
}

/// What a surface is made of.
#[derive(Clone, Debug)]
pub(super) struct Regions {
    pub(super) regions: Vec<Region>,
    /// Orthogonal frames of the regions' directions, at most three.
    pub(super) frames: Vec<DMat3>,
    /// How far a sample may be from its form, in diagonals.
    pub(super) eps: f64,
}

/// The regions of a surface.
pub(super) fn detect(_samples: &Samples, _seed: u64, run: &Run) -> Result<Regions, FitError> {
    run.check()?;
    Ok(Regions { regions: Vec::new(), frames: vec![DMat3::IDENTITY], eps: 0.004 })
}
