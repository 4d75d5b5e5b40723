//! Directions.

use glam::DVec3;

/// A vector at length 1, without overflow or underflow on the way; NaN for one of length 0.
pub(crate) fn unit(v: DVec3) -> DVec3 {
    let v = v / v.abs().max_element();
    v / v.length()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::Solid;

    #[test]
    fn vectors_of_any_length_tell_directions() {
        let ball = Solid::sphere(1.0).translate([3.0, 0.0, 0.0]);
        for length in [1e-200, 1e-3, 1.0, 1e200] {
            let along = DVec3::X * length;
            assert_eq!(ball.raycast([0.0; 3], along).unwrap().map(|hit| hit.distance), Some(2.0), "{length}");
            assert!(ball.reflect(along, 0.0).contains([-3.0, 0.0, 0.0]).unwrap(), "{length}");
            assert!(ball.mirrored(along, 0.0).contains([-3.0, 0.0, 0.0]).unwrap(), "{length}");
        }
    }
}
