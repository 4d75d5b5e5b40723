//! What samples must keep to, by what they come from.

use super::columns::{Shape, Tolerance};
use super::guesses::Slack;
use super::samples::{Kind, Samples};

/// Tolerances and least sizes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) kind: Kind,
    /// How far samples may be from a shape, in diagonals.
    pub(super) eps: f64,
    /// The least share of the area of a region.
    pub(super) share: f64,
    /// The least share of a cone, and of a sphere or torus.
    pub(super) cone_share: f64,
    pub(super) round_share: f64,
    /// The largest root mean squares of curved shapes: of angles between normals, in degrees, and
    /// of distances.
    pub(super) spread: [f64; 2],
    /// How much normals may differ from those of curved shapes, and of planes, in degrees.
    curved: f64,
    flat: f64,
    flat_eps: f64,
}

impl Limits {
    pub(super) fn of(samples: &Samples) -> Limits {
        let kind = samples.kind;
        match kind {
            Kind::Cad => Limits {
                kind,
                eps: 0.004,
                share: 0.0006,
                cone_share: 0.0006,
                round_share: 0.002,
                spread: [8.0, 1.0],
                curved: 14.0,
                flat: 4.0,
                flat_eps: 0.001,
            },
            Kind::Voxels => Limits {
                kind,
                eps: 0.005,
                share: 0.003,
                cone_share: 0.008,
                round_share: 0.02,
                spread: [8.0, 0.0015],
                curved: 18.0,
                flat: 8.0,
                flat_eps: 0.003,
            },
            Kind::Scan => {
                let eps = f64::max(0.005, 2.5 * samples.noise);
                Limits {
                    kind,
                    eps,
                    share: 0.003,
                    cone_share: 0.008,
                    round_share: 0.02,
                    spread: [90.0, 0.0007 + 1.35 * samples.noise],
                    curved: 25.0,
                    flat: 12.0,
                    flat_eps: eps,
                }
            }
        }
    }

    /// The same, for what is only roughly of a shape.
    pub(super) fn lenient(&self) -> Limits {
        Limits { spread: [90.0, 1.0], ..*self }
    }

    /// The tolerance of a region.
    pub(super) fn fine(&self, shape: &Shape) -> Tolerance {
        self.tolerance(shape, 1.2)
    }

    /// The tolerance of a hypothesis.
    pub(super) fn coarse(&self, shape: &Shape) -> Tolerance {
        self.tolerance(shape, 1.5)
    }

    fn tolerance(&self, shape: &Shape, factor: f64) -> Tolerance {
        let radius = match *shape {
            Shape::Plane { .. } => {
                return Tolerance { distance: factor * self.flat_eps, cosine: self.flat.to_radians().cos() };
            }
            Shape::Sphere { radius, .. } => radius,
            Shape::Cone { radius, slope: 0.0, .. } => radius,
            // The radius changes from end to end.
            Shape::Cone { .. } => 0.1,
            Shape::Torus { minor, .. } => minor,
        };
        let mut distance = f64::min(self.eps, 0.09 * radius);
        if self.kind == Kind::Cad {
            distance = distance.min(f64::max(0.0012, 0.012 * radius));
        }
        Tolerance { distance: factor * distance, cosine: self.curved.to_radians().cos() }
    }

    /// How much the two points of a hypothesis may contradict each other.
    pub(super) fn slack(&self, exact: bool) -> Slack {
        if exact {
            Slack { radius: 0.03, angle: 0.05, slope: 0.02 }
        } else {
            Slack { radius: 0.12, angle: self.curved.to_radians(), slope: 0.09 }
        }
    }

    /// The cosine within which most normals of a plane are.
    pub(super) fn flat_half(&self) -> f64 {
        (0.4 * self.flat).to_radians().cos()
    }

    /// Slopes of cones below this are 0.
    pub(super) fn least_slope(&self) -> f64 {
        if self.kind == Kind::Cad { 0.01 } else { 0.04 }
    }
}
