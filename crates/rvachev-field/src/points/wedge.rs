//! Reflection of a symmetric wedge: every image once, those on borders too.
//!
//! ```text
//!     plane    0 ≤ y ≤ x          8 images: 4 pairs of signs × 2 orders of coordinates
//!     space    0 ≤ x ≤ y ≤ z     48 images: 8 triples of signs × 6 orders      equal exponents
//!              0 ≤ x ≤ y         16 images: 8 × 2                              two equal
//!              0 ≤ x, y, z        8 images                                     all different
//! ```
//!
//! A coordinate of 0 has one sign, equal coordinates have one order: a point on a border is
//! emitted as often as it has different images. Unit size only: scale afterwards.

use glam::{DVec2, DVec3};

/// Under what a plane figure is symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneSymmetry {
    /// Signs: the wedge is a quarter.
    Rectangle,
    /// Signs and the order of coordinates: the wedge is an eighth.
    Square,
}

/// Under what a solid is symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Signs: the wedge is an octant.
    Cuboid,
    /// Signs, and x with y: the wedge is a 16th.
    SquarePrism,
    /// Signs and all orders: the wedge is a 48th.
    Cube,
}

/// All images of points of a wedge, each once.
///
/// ```
/// use glam::DVec2;
/// use rvachev::points::{PlaneSymmetry, reflect_plane};
///
/// assert_eq!(reflect_plane(&[DVec2::new(0.9, 0.2)], PlaneSymmetry::Square).len(), 8);
/// assert_eq!(reflect_plane(&[DVec2::new(1.0, 0.0)], PlaneSymmetry::Square).len(), 4);
/// assert_eq!(reflect_plane(&[DVec2::new(0.7, 0.7)], PlaneSymmetry::Square).len(), 4);
/// ```
#[must_use]
pub fn reflect_plane(wedge: &[DVec2], symmetry: PlaneSymmetry) -> Vec<DVec2> {
    let mut all = Vec::with_capacity(8 * wedge.len());
    for &p in wedge {
        let swapped = symmetry == PlaneSymmetry::Square && p.x != p.y;
        for p in std::iter::once(p).chain(swapped.then_some(DVec2::new(p.y, p.x))) {
            for x in signs(p.x) {
                all.extend(signs(p.y).map(|y| DVec2::new(x, y)));
            }
        }
    }
    all
}

/// All images of points of a wedge, each once.
///
/// ```
/// use glam::DVec3;
/// use rvachev::points::{Symmetry, reflect};
///
/// let inside = DVec3::new(0.2, 0.5, 0.9);
/// assert_eq!(reflect(&[inside], Symmetry::Cube).len(), 48);
/// assert_eq!(reflect(&[inside], Symmetry::SquarePrism).len(), 16);
/// assert_eq!(reflect(&[inside], Symmetry::Cuboid).len(), 8);
/// assert_eq!(reflect(&[DVec3::Z], Symmetry::Cube).len(), 6);
/// ```
#[must_use]
pub fn reflect(wedge: &[DVec3], symmetry: Symmetry) -> Vec<DVec3> {
    let images = match symmetry {
        Symmetry::Cuboid => 8,
        Symmetry::SquarePrism => 16,
        Symmetry::Cube => 48,
    };
    let mut all = Vec::with_capacity(images * wedge.len());
    for &p in wedge {
        let [x, y, z] = p.to_array();
        let orders: &[[f64; 3]] = match symmetry {
            Symmetry::Cuboid => &[[x, y, z]],
            Symmetry::SquarePrism => &[[x, y, z], [y, x, z]],
            Symmetry::Cube => &[[x, y, z], [y, x, z], [x, z, y], [z, x, y], [y, z, x], [z, y, x]],
        };
        for (i, order) in orders.iter().enumerate() {
            if orders[..i].contains(order) {
                continue;
            }
            for x in signs(order[0]) {
                for y in signs(order[1]) {
                    all.extend(signs(order[2]).map(|z| DVec3::new(x, y, z)));
                }
            }
        }
    }
    all
}

/// A coordinate with both signs; 0 once.
fn signs(c: f64) -> impl Iterator<Item = f64> {
    std::iter::once(c).chain((c != 0.0).then_some(-c))
}
