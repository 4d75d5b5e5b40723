//! What a ray of a picture meets: the solid, the ground it stands on, or nothing.

use glam::DVec3;

use super::gbuffer::Surface;

/// The owner of the ground.
const GROUND: u32 = u32::MAX - 1;

/// Neighbours whose normals are further apart (cosine of 14°) show an edge.
const SAME_NORMAL: f64 = 0.97;

/// Neighbours that are further from the other's tangent plane, in pixels, are a step.
const STEP: f64 = 1.5;

/// What a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) point: DVec3,
    /// Towards the viewer.
    pub(super) normal: DVec3,
    /// Unit vector to the eye.
    pub(super) viewer: DVec3,
    /// Out of the solid.
    pub(super) outward: DVec3,
    pub(super) distance: f64,
    /// The leaf, the ground, or nobody.
    pub(super) owner: u32,
}

impl Spot {
    /// What the ray from `origin` along `direction` meets, given the solid's surface along it
    /// and the height of the ground, if there is one.
    pub(super) fn new(origin: DVec3, direction: DVec3, surface: &Surface, ground: Option<f64>) -> Spot {
        let viewer = -direction;
        if surface.is_hit() {
            let outward = surface.normal.as_dvec3();
            // Where the gradient vanishes there is no normal; facing the viewer is as good as any.
            let outward = if outward == DVec3::ZERO { viewer } else { outward };
            let normal = if outward.dot(viewer) >= 0.0 { outward } else { -outward };
            let distance = surface.distance;
            let point = origin + distance * direction;
            return Spot { point, normal, viewer, outward, distance, owner: surface.owner };
        }
        let distance = match ground {
            Some(height) if direction.z < 0.0 && origin.z > height => (height - origin.z) / direction.z,
            _ => f64::INFINITY,
        };
        if distance.is_finite() {
            let point = origin + distance * direction;
            return Spot { point, normal: DVec3::Z, viewer, outward: DVec3::Z, distance, owner: GROUND };
        }
        let nowhere = DVec3::ZERO;
        Spot { point: nowhere, normal: nowhere, viewer, outward: nowhere, distance, owner: Surface::NONE.owner }
    }

    /// Whether it is on the solid.
    pub(super) fn is_solid(&self) -> bool {
        self.owner < GROUND
    }

    pub(super) fn is_ground(&self) -> bool {
        self.owner == GROUND
    }

    /// Whether the solid is seen from outside.
    pub(super) fn is_front(&self) -> bool {
        self.outward.dot(self.viewer) >= 0.0
    }

    /// Whether the two are of one piece: of the solid, or of the ground.
    pub(super) fn same_piece(&self, other: &Spot) -> bool {
        self.is_solid() == other.is_solid() && self.is_ground() == other.is_ground()
    }

    /// Whether an edge of the solid may pass between two neighbours; a pixel spans `pixel`.
    pub(super) fn differs(&self, other: &Spot, pixel: f64) -> bool {
        match (self.is_solid(), other.is_solid()) {
            (true, true) => {
                self.owner != other.owner
                    || self.normal.dot(other.normal) < SAME_NORMAL
                    || self.steps(other) > STEP * pixel
            }
            (solid, other) => solid != other,
        }
    }

    /// How far the two are from each other's tangent planes.
    pub(super) fn steps(&self, other: &Spot) -> f64 {
        let between = other.point - self.point;
        between.dot(self.normal).abs().max(between.dot(other.normal).abs())
    }
}
