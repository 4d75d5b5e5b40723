//! Convex bodies with flat faces, about the origin.
//!
//! ```text
//!       .----.         Each face is a polygon in its plane. A plane that cuts them all leaves one more:
//!      /    /|         what all others leave of it.
//!     .----. |
//!     |    |/
//!     '----'
//! ```

use glam::DVec3;

use super::moments::Moments;

/// What is nearer to a plane than these parts of the size, and of the coordinates of the world, is
/// in it.
const OF_SIZE: f64 = 1e-13;
const OF_COORDINATES: f64 = 1e-14;

/// The points where `normal·p ≥ at`; the normal has length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: DVec3,
    at: f64,
}

impl Plane {
    /// Where a linear function is positive, by its slope and its value at a point; nothing if it is
    /// the same everywhere, or no number.
    pub(super) fn of(p: DVec3, value: f64, slope: DVec3) -> Option<Plane> {
        let length = slope.length();
        let normal = slope.try_normalize()?;
        let at = normal.dot(p) - value / length;
        (at.is_finite() && normal.is_finite()).then_some(Plane { normal, at })
    }

    /// A unit vector to the side that is above.
    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// How far a point is above it.
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.at
    }

    /// The same, farther along the normal.
    pub(super) fn raised(self, by: f64) -> Plane {
        Plane { at: self.at + by, ..self }
    }

    /// The other side of it.
    pub(super) fn turned(self) -> Plane {
        Plane { normal: -self.normal, at: -self.at }
    }
}

/// Where something is of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Above,
    Below,
    Within,
    Across,
}

/// A convex polygon.
#[derive(Clone, Debug)]
pub(super) struct Face {
    plane: Plane,
    corners: Vec<DVec3>,
    /// Whether it is a side of the box that the body is of.
    is_side: bool,
}

impl Face {
    /// A side of a box about the origin that is flat along an axis, by half its sides.
    pub(super) fn rectangle(half: DVec3, axis: usize) -> Face {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[u, v]: [f64; 2]| {
            let mut p = DVec3::ZERO;
            (p[next], p[last]) = (u * half[next], v * half[last]);
            p
        });
        Face { plane: Plane { normal: DVec3::AXES[axis], at: 0.0 }, corners: corners.to_vec(), is_side: true }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.len() < 3
    }

    pub(super) fn area(&self) -> f64 {
        let triangle = |n: usize| {
            let [a, b, c] = [self.corners[0], self.corners[n - 1], self.corners[n]];
            0.5 * (b - a).cross(c - a).length()
        };
        (2..self.corners.len()).map(triangle).sum()
    }

    /// Where it is of a plane, to within a distance.
    pub(super) fn place(&self, plane: &Plane, slack: f64) -> Place {
        place(self.corners.iter(), plane, slack)
    }

    /// Whether it looks where a plane does, more or less.
    pub(super) fn is_along(&self, plane: &Plane) -> bool {
        self.plane.normal.dot(plane.normal) > 0.0
    }

    /// The part above a plane.
    pub(super) fn above(&self, plane: &Plane) -> Face {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        let Some(mut from) = self.corners.last().copied() else { return self.clone() };
        let mut below = plane.height(from);
        for &to in &self.corners {
            let height = plane.height(to);
            if (below < 0.0) != (height < 0.0) {
                corners.push(from.lerp(to, below / (below - height)));
            }
            if height >= 0.0 {
                corners.push(to);
            }
            (from, below) = (to, height);
        }
        Face { corners, plane: self.plane, is_side: self.is_side }
    }
}

fn place<'a>(points: impl Iterator<Item = &'a DVec3>, plane: &Plane, slack: f64) -> Place {
    let heights = points.map(|p| plane.height(*p));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
    match (low >= -slack, high <= slack) {
        (true, true) => Place::Within,
        (true, false) => Place::Above,
        (false, true) => Place::Below,
        (false, false) => Place::Across,
    }
}

/// A body; without faces, nothing.
#[derive(Clone, Debug)]
pub(super) struct Polytope {
    faces: Vec<Face>,
    /// No corner is farther from the origin.
    reach: f64,
    /// What is nearer to a plane is in it.
    pub(super) slack: f64,
}

impl Polytope {
    /// A box about the origin, by half its sides, where coordinates of the world are as large as
    /// `far`.
    pub(super) fn cuboid(half: DVec3, far: f64) -> Polytope {
        let mut faces = Vec::with_capacity(8);
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            for sign in [-1.0, 1.0] {
                let corner = |u: f64, v: f64| {
                    let mut p = DVec3::ZERO;
                    (p[axis], p[next], p[last]) = (sign * half[axis], u * half[next], v * half[last]);
                    p
                };
                let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                let plane = Plane { normal: -sign * DVec3::AXES[axis], at: -half[axis] };
                faces.push(Face { plane, corners, is_side: true });
            }
        }
        let reach = half.length();
        Polytope { faces, reach, slack: OF_SIZE * reach + OF_COORDINATES * far }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The part above a plane.
    pub(super) fn above(&self, plane: &Plane) -> Polytope {
        let mut faces = Vec::with_capacity(self.faces.len() + 1);
        match self.place(plane) {
            Place::Above => return self.clone(),
            Place::Below | Place::Within => {}
            Place::Across => {
                faces.extend(self.faces.iter().map(|face| face.above(plane)).filter(|face| !face.is_empty()));
                faces.extend(Some(self.section(plane)).filter(|face| !face.is_empty()));
            }
        }
        Polytope { faces, ..*self }
    }

    pub(super) fn place(&self, plane: &Plane) -> Place {
        place(self.faces.iter().flat_map(|face| &face.corners), plane, self.slack)
    }

    /// Whether a side of the box is in a plane.
    pub(super) fn has_side_in(&self, plane: &Plane) -> bool {
        self.faces.iter().any(|face| face.is_side && face.place(plane, self.slack) == Place::Within)
    }

    /// What it has of a plane.
    pub(super) fn section(&self, plane: &Plane) -> Face {
        let (u, v) = plane.normal.any_orthonormal_pair();
        let (centre, far) = (plane.at * plane.normal, 2.0 * self.reach);
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = square.map(|[a, b]| centre + far * (a * u + b * v)).to_vec();
        let whole = Face { plane: *plane, corners, is_side: false };
        self.faces.iter().fold(whole, |left, face| left.above(&face.plane))
    }

    /// The planes of its faces that are not of the box; of nothing, one that nothing is above.
    pub(super) fn cuts(&self) -> Vec<Plane> {
        if self.is_empty() {
            return vec![Plane { normal: DVec3::X, at: 2.0 * self.reach }];
        }
        self.faces.iter().filter(|face| !face.is_side).map(|face| face.plane).collect()
    }

    /// Its corners, each at least once.
    pub(super) fn corners(&self) -> Vec<DVec3> {
        let mut all: Vec<DVec3> = Vec::with_capacity(2 * self.faces.len());
        for p in self.faces.iter().flat_map(|face| &face.corners) {
            if all.iter().all(|known| known.distance_squared(*p) > self.slack * self.slack) {
                all.push(*p);
            }
        }
        all
    }

    pub(super) fn moments(&self) -> Moments {
        let mut all = Moments::default();
        for Face { plane, corners, .. } in &self.faces {
            for n in 2..corners.len() {
                let [a, b, c] = [corners[0], corners[n - 1], corners[n]];
                let area = 0.5 * (b - a).cross(c - a).length();
                all.add(&Moments::tetrahedron(-plane.at * area / 3.0, &[DVec3::ZERO, a, b, c]));
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_of_planes_make_up_the_whole() {
        let half = DVec3::new(1.0, 0.5, 2.0);
        let whole = Polytope::cuboid(half, 0.0);
        assert!((whole.moments().volume - 8.0).abs() < 1e-14 && whole.corners().len() == 8);
        let random = |k: u32| f64::from(k.wrapping_mul(2_654_435_769).rotate_left(11)) / 2f64.powi(32);
        for n in 0..200 {
            let vector = |k: u32| DVec3::new(random(k), random(k + 1), random(k + 2)) - 0.5;
            let mut parts = vec![whole.clone()];
            for k in 0..4 {
                let plane = Plane::of(half * vector(64 * n + 8 * k), 0.0, vector(64 * n + 8 * k + 4)).unwrap();
                parts = parts.iter().flat_map(|part| [part.above(&plane), part.above(&plane.turned())]).collect();
                // Once more, it takes nothing off.
                let [one, other] = [&parts[0], &parts[0].above(&plane)].map(|part| part.moments().volume);
                assert!((one - other).abs() < 1e-14);
            }
            let mut sum = Moments::default();
            parts.iter().for_each(|part| sum.add(&part.moments()));
            let left = sum.less(&whole.moments());
            assert!(left.volume.abs() < 1e-13 && left.first.length() < 1e-13, "{n}: {left:?}");
            assert!(left.second.to_cols_array().iter().all(|x| x.abs() < 1e-12), "{n}: {left:?}");
        }
        let beyond = Plane::of(DVec3::X, 0.0, DVec3::X).unwrap();
        assert!(whole.above(&beyond).is_empty() && Plane::of(DVec3::X, 1.0, DVec3::ZERO).is_none());
    }
}
