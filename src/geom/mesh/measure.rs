//! Area, and volume, centroid and inertia of what a mesh encloses.
//!
//! By the divergence theorem each triangle [a, b, c] stands for the tetrahedron between it and
//! an origin. With d = a·(b × c) and s = a + b + c:
//!
//! ```text
//!   ∫ dV = d/6      ∫ x dV = d/24 · s      ∫ x xᵀ dV = d/120 · (s sᵀ + a aᵀ + b bᵀ + c cᵀ)
//! ```
//!
//! The origin is the centre of the bounds: from one far away the large volumes would cancel.

use glam::{DMat3, DVec3};

use super::Mesh;
use crate::{Cancelled, Run};

/// Triangles that are added before it is asked whether to go on.
const AT_ONCE: usize = 1 << 16;

/// What the triangles add up to.
#[derive(Default)]
pub(crate) struct Measure {
    pub area: f64,
    pub volume: f64,
    pub centroid: Option<DVec3>,
    pub inertia: Option<DMat3>,
}

impl Mesh {
    /// The enclosed volume by the divergence theorem, in cubic length units: Σ a·(b × c) / 6
    /// over the triangles. Positive if they face outward. Without meaning for an open mesh.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.measure().volume
    }

    /// The centroid of the enclosed volume; `None` if that volume is 0.
    #[must_use]
    pub fn centroid(&self) -> Option<DVec3> {
        self.measure().centroid
    }

    /// The inertia tensor of the enclosed volume about its centroid, for density 1, in length
    /// units to the fifth power: ∫ (r²·1 − r rᵀ) dV with r from the centroid. `None` if the
    /// volume is 0.
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    ///
    /// // The corner of a cube that an axis-aligned tetrahedron cuts off.
    /// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let inertia = Mesh::new(positions, triangles)?.inertia().unwrap();
    /// assert!((inertia.x_axis.x - 1.0 / 80.0).abs() < 1e-15);
    /// assert!((inertia.x_axis.y - 1.0 / 480.0).abs() < 1e-15);
    /// # Ok::<(), rvachev::error::MeshError>(())
    /// ```
    #[must_use]
    pub fn inertia(&self) -> Option<DMat3> {
        self.measure().inertia
    }

    /// The total area of the triangles, in square length units.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.measure().area
    }

    /// All of them at once.
    fn measure(&self) -> Measure {
        // A run that nobody else holds is not cancelled.
        self.measure_with(&Run::default()).unwrap_or_default()
    }

    /// The same; it can be stopped.
    pub(crate) fn measure_with(&self, run: &Run) -> Result<Measure, Cancelled> {
        let mut sums = Sums::new(self.bounds().center());
        for triangles in self.triangles().chunks(AT_ONCE) {
            run.check()?;
            triangles.iter().for_each(|&triangle| sums.add(self.corners(triangle)));
        }
        Ok(sums.measure())
    }
}

/// The sums over triangles of a mesh.
struct Sums {
    origin: DVec3,
    area: f64,
    volume: f64,
    first: DVec3,
    /// xx, yy, zz and yz, zx, xy.
    squares: DVec3,
    products: DVec3,
}

impl Sums {
    fn new(origin: DVec3) -> Sums {
        let (first, squares, products) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        Sums { origin, area: 0.0, volume: 0.0, first, squares, products }
    }

    #[inline]
    fn add(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners.map(|p| p - self.origin);
        self.area += (b - a).cross(c - a).length();
        let six = a.dot(b.cross(c));
        let sum = a + b + c;
        self.volume += six;
        self.first += sum * six;
        for v in [a, b, c, sum] {
            self.squares += v * v * six;
            self.products += DVec3::new(v.y * v.z, v.z * v.x, v.x * v.y) * six;
        }
    }

    fn measure(self) -> Measure {
        let Sums { origin, first, squares, products, .. } = self;
        let (area, volume) = (self.area / 2.0, self.volume / 6.0);
        if volume == 0.0 {
            return Measure { area, volume, centroid: None, inertia: None };
        }
        let c = first / (24.0 * volume);
        let squares = squares / 120.0 - c * c * volume;
        let products = products / 120.0 - DVec3::new(c.y * c.z, c.z * c.x, c.x * c.y) * volume;
        let turning = DVec3::splat(squares.element_sum()) - squares;
        let inertia = DMat3::from_cols(
            DVec3::new(turning.x, -products.z, -products.y),
            DVec3::new(-products.z, turning.y, -products.x),
            DVec3::new(-products.y, -products.x, turning.z),
        );
        Measure { area, volume, centroid: Some(origin + c), inertia: Some(inertia) }
    }
}
