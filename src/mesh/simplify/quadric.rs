//! The mean square distance of a point from planes.
//!
//! Source: M. Garland and P. S. Heckbert, Surface simplification using quadric error metrics
//! (1997).

use glam::{DMat3, DVec3};

/// The sum of squared distances from planes, each with a weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadric {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    weight: f64,
}

impl Quadric {
    /// No planes.
    pub(super) const NONE: Quadric = Quadric { square: DMat3::ZERO, linear: DVec3::ZERO, constant: 0.0, weight: 0.0 };

    /// That of the plane through a point with a unit normal.
    pub(super) fn plane(normal: DVec3, point: DVec3, weight: f64) -> Quadric {
        let d = normal.dot(point);
        let column = weight * normal;
        Quadric {
            square: DMat3::from_cols(column * normal.x, column * normal.y, column * normal.z),
            linear: -d * column,
            constant: weight * d * d,
            weight,
        }
    }

    pub(super) fn add(&mut self, other: &Quadric) {
        self.square += other.square;
        self.linear += other.linear;
        self.constant += other.constant;
        self.weight += other.weight;
    }

    /// The mean square of the distances of a point.
    pub(super) fn mean(&self, p: DVec3) -> f64 {
        let sum = p.dot(self.square * p) + 2.0 * self.linear.dot(p) + self.constant;
        if self.weight > 0.0 { (sum / self.weight).max(0.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_that_of_squares_from_planes() {
        let mut both = Quadric::plane(DVec3::X, DVec3::X, 1.0);
        both.add(&Quadric::plane(DVec3::Z, DVec3::ZERO, 3.0));
        assert!((both.mean(DVec3::new(3.0, 7.0, 1.0)) - (4.0 + 3.0) / 4.0).abs() < 1e-12);
        let mut none = Quadric::NONE;
        assert_eq!(none.mean(DVec3::ONE), 0.0);
        none.add(&both);
        assert_eq!(none.mean(DVec3::ONE), both.mean(DVec3::ONE));
    }
}
