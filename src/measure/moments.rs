//! Volume and moments of bodies: what they add up to, and how maps change them.

use glam::{DAffine3, DMat3, DVec3};

/// The integrals of 1, of x and of x xᵀ over a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) volume: f64,
    pub(super) first: DVec3,
    pub(super) second: DMat3,
}

/// Of nothing.
impl Default for Moments {
    fn default() -> Moments {
        Moments { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO }
    }
}

impl Moments {
    /// A body of which the axes are axes of symmetry, by the integrals of x², y² and z².
    pub(super) fn symmetric(volume: f64, squares: DVec3) -> Moments {
        Moments { volume, first: DVec3::ZERO, second: DMat3::from_diagonal(squares) }
    }

    /// A box.
    pub(super) fn cuboid(centre: DVec3, size: DVec3) -> Moments {
        let volume = size.element_product();
        Moments::symmetric(volume, volume / 12.0 * size * size).moved(centre)
    }

    /// A tetrahedron of a volume, by its corners.
    pub(super) fn tetrahedron(volume: f64, corners: &[DVec3; 4]) -> Moments {
        let sum: DVec3 = corners.iter().sum();
        let squares = corners.iter().fold(square(sum), |all, p| all + square(*p));
        Moments { volume, first: 0.25 * volume * sum, second: squares * (volume / 20.0) }
    }

    pub(super) fn add(&mut self, other: &Moments) {
        self.volume += other.volume;
        self.first += other.first;
        self.second += other.second;
    }

    pub(super) fn less(mut self, other: &Moments) -> Moments {
        self.add(&other.times(-1.0));
        self
    }

    pub(super) fn times(&self, by: f64) -> Moments {
        Moments { volume: by * self.volume, first: by * self.first, second: self.second * by }
    }

    pub(super) fn moved(&self, by: DVec3) -> Moments {
        self.mapped(&DAffine3::from_translation(by))
    }

    /// Those of the body after an affine map.
    pub(super) fn mapped(&self, map: &DAffine3) -> Moments {
        let (linear, by) = (map.matrix3, map.translation);
        let scale = linear.determinant().abs();
        let volume = scale * self.volume;
        let turned = scale * (linear * self.first);
        let second = linear * self.second * linear.transpose() * scale;
        let mixed = outer(turned, by);
        Moments {
            volume,
            first: turned + volume * by,
            second: second + mixed + mixed.transpose() + square(by) * volume,
        }
    }

    /// The centroid of what has a volume.
    pub(super) fn centroid(&self) -> Option<DVec3> {
        (self.volume > 0.0).then(|| self.first / self.volume)
    }

    /// The inertia about the origin for density 1: ∫ (r²·1 − r rᵀ) dV.
    pub(super) fn inertia(&self) -> DMat3 {
        let Moments { second, .. } = self;
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - *second
    }
}

/// `a bᵀ`.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn square(a: DVec3) -> DMat3 {
    outer(a, a)
}
