//! Unit vectors of any length that numbers can hold.

pub(crate) use rvachev_field::unit;

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::Solid;

    #[test]
    fn vectors_of_any_length_tell_directions() {
        let ball = Solid::sphere(1.0).translate([3.0, 0.0, 0.0]);
        for length in [1e-200, 1e-161, 1e-155, 1e-3, 1.0, 1e154, 1e200] {
            let along = DVec3::X * length;
            assert_eq!(ball.raycast([0.0; 3], along).unwrap().map(|hit| hit.distance), Some(2.0), "{length}");
            for other in [ball.reflect(along, 0.0), ball.mirrored(along, 0.0)] {
                assert!((other.value([-3.0, 0.0, 0.0]).unwrap() - 1.0).abs() < 1e-12, "{length}");
                assert!(other.value([-4.0, 0.0, 0.0]).unwrap().abs() < 1e-12, "{length}");
            }
        }
    }
}
