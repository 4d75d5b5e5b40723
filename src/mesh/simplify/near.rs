//! How far a point is from a triangle.

use glam::DVec3;

/// The square of the distance of a point from a triangle.
pub(super) fn distance_squared(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    if square > 0.0 {
        // The shares of the corners in the foot on the plane.
        let at_c = ab.cross(ap).dot(normal);
        let at_b = ap.cross(ac).dot(normal);
        if at_b >= 0.0 && at_c >= 0.0 && at_b + at_c <= square {
            let height = ap.dot(normal);
            return height * height / square;
        }
    }
    from_side(p, a, b).min(from_side(p, b, c)).min(from_side(p, c, a))
}

fn from_side(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (side, to) = (b - a, p - a);
    let t = (to.dot(side) / side.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (to - t * side).length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_face_side_and_corner() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let cases = [
            (DVec3::new(0.2, 0.2, 3.0), 9.0),
            (DVec3::new(0.5, -2.0, 0.0), 4.0),
            (DVec3::new(1.0, 1.0, 0.0), 0.5),
            (DVec3::new(-3.0, -4.0, 0.0), 25.0),
            (DVec3::new(3.0, 0.0, 1.0), 5.0),
        ];
        for (p, square) in cases {
            assert!((distance_squared(p, triangle) - square).abs() < 1e-12, "{p}");
        }
        assert_eq!(distance_squared(DVec3::Y, [DVec3::ZERO; 3]), 1.0);
    }
}
