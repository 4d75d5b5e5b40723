//! What a ray of a picture meets: the solid, the ground it stands on, or nothing.

use glam::{DVec3, Vec3};

use super::gbuffer::Surface;

/// The owner of the ground.
const GROUND: u32 = u32::MAX - 1;

/// Neighbours whose normals are further apart (cosine of 14°) show an edge.
const SAME_NORMAL: f32 = 0.97;

/// Those whose normals are closer (cosine of half a degree) have one light.
const SAME_LIGHT: f32 = 0.999_96;

/// Neighbours that are further from the other's tangent plane, in pixels, are a step.
const STEP: f64 = 1.5;

/// What a ray meets: 64 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) point: DVec3,
    pub(super) distance: f64,
    /// Towards the viewer.
    pub(super) normal: Vec3,
    /// Unit vector to the eye.
    pub(super) viewer: Vec3,
    /// The leaf, the ground, or nobody.
    pub(super) owner: u32,
    /// Whether the solid is seen from outside.
    is_front: bool,
}

impl Spot {
    /// Of a ray that meets nothing.
    pub(super) const NOTHING: Spot = Spot {
        point: DVec3::ZERO,
        distance: f64::INFINITY,
        normal: Vec3::ZERO,
        viewer: Vec3::ZERO,
        owner: Surface::NONE.owner,
        is_front: true,
    };

    /// What the ray from `origin` along `direction` meets, given the solid's surface along it
    /// and the height of the ground, if there is one.
    #[inline]
    pub(super) fn new(origin: DVec3, direction: DVec3, surface: &Surface, ground: Option<f64>) -> Spot {
        let viewer = -direction;
        let to = |distance: f64| origin + distance * direction;
        if surface.is_hit() {
            let outward = surface.normal;
            let is_front = outward.as_dvec3().dot(viewer) >= 0.0;
            let viewer = viewer.as_vec3();
            // Where the gradient vanishes there is no normal; facing the viewer is as good as any.
            let outward = if outward == Vec3::ZERO { viewer } else { outward };
            let normal = if is_front { outward } else { -outward };
            let distance = surface.distance;
            return Spot { point: to(distance), distance, normal, viewer, owner: surface.owner, is_front };
        }
        let viewer = viewer.as_vec3();
        let distance = match ground {
            Some(height) if direction.z < 0.0 && origin.z > height => (height - origin.z) / direction.z,
            _ => f64::INFINITY,
        };
        if distance.is_finite() {
            return Spot { point: to(distance), distance, normal: Vec3::Z, viewer, owner: GROUND, is_front: true };
        }
        Spot::NOTHING
    }

    /// Whether it is on the solid.
    #[inline]
    pub(super) fn is_solid(&self) -> bool {
        self.owner < GROUND
    }

    #[inline]
    pub(super) fn is_ground(&self) -> bool {
        self.owner == GROUND
    }

    /// Whether the solid is seen from outside.
    pub(super) fn is_front(&self) -> bool {
        self.is_front
    }

    /// The normal out of the solid.
    pub(super) fn outward(&self) -> Vec3 {
        if self.is_front { self.normal } else { -self.normal }
    }

    /// Whether the two are of one piece: of the solid, or of the ground.
    #[inline]
    pub(super) fn same_piece(&self, other: &Spot) -> bool {
        self.is_solid() == other.is_solid() && self.is_ground() == other.is_ground()
    }

    /// Whether two of the solid in one pixel have about the same light.
    #[inline]
    pub(super) fn looks_like(&self, other: &Spot) -> bool {
        self.is_solid()
            && self.owner == other.owner
            && self.is_front == other.is_front
            && self.normal.dot(other.normal) > SAME_LIGHT
    }

    /// Whether an edge of the solid may pass between two neighbours; `pixel` tells how
    /// wide a pixel is at a distance.
    #[inline]
    pub(super) fn differs(&self, other: &Spot, pixel: impl Fn(f64) -> f64) -> bool {
        match (self.is_solid(), other.is_solid()) {
            (true, true) => {
                self.owner != other.owner
                    || self.normal.dot(other.normal) < SAME_NORMAL
                    || self.steps(other) > STEP * pixel(self.distance.min(other.distance))
            }
            (solid, other) => solid != other,
        }
    }

    /// How far the two are from each other's tangent planes.
    #[inline]
    pub(super) fn steps(&self, other: &Spot) -> f64 {
        let between = (other.point - self.point).as_vec3();
        f64::from(between.dot(self.normal).abs().max(between.dot(other.normal).abs()))
    }
}
