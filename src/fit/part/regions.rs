//! Regions of a surface, each of one plane, cylinder, cone, sphere or torus.
//!
//! Hypotheses of all kinds and all axes are made from two points each, and the one that explains
//! most of the area is adjusted and taken, then the one that explains most of the rest. So a sphere
//! is not taken for a ring of cones, nor a cylinder of many facets for planes: what explains more
//! comes first.
//!
//! Source of the idea: R. Schnabel, R. Wahl, R. Klein, *Efficient RANSAC for point-cloud shape
//! detection* (2007).

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::detector::Detector;
use super::samples::Samples;
use crate::Run;
use crate::fit::FitError;

/// Samples that one form explains.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Region {
    pub(super) form: Form,
    /// Indices of samples.
    pub(super) points: Vec<u32>,
    /// Their share of the area.
    pub(super) share: f64,
    /// 1 if the normals point away from the axis or centre, −1 in a hole; 1 of planes.
    pub(super) sign: f64,
    /// How much smaller, as a factor, the radius is that samples are about: facets are chords of
    /// what the form is.
    pub(super) chordal: f64,
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

impl Region {
    /// Where there are samples of it along an axis, from an origin: gaps that are longer than given
    /// divide it.
    pub(super) fn pieces(&self, samples: &Samples, axis: DVec3, origin: DVec3, gap: f64) -> Vec<[f64; 2]> {
        let mut along: Vec<f64> =
            self.points.iter().map(|i| (samples.points[*i as usize] - origin).dot(axis)).collect();
        order::numbers(&mut along);
        along.chunk_by(|a, b| b - a <= gap).map(|piece| [piece[0], piece[piece.len() - 1]]).collect()
    }
}

/// The regions of a surface, from the one that was found first on.
pub(super) fn detect(samples: &Samples, seed: u64, run: &Run) -> Result<Regions, FitError> {
    let run = run.stage(0.0, 1.0);
    let mut detector = Detector::new(samples, seed);
    detector.search(&run)?;
    Ok(detector.finished())
}
