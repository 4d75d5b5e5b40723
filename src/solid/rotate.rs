//! Rotations.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::Solid;
use crate::Angle;

impl Solid {
    /// Turned about the origin by a quaternion.
    #[must_use]
    pub fn rotate(&self, rotation: DQuat) -> Solid {
        self.affine_as("rotate", DAffine3::from_quat(rotation))
    }

    /// Turned about the x axis by `angle`, from y towards z. Quarter turns are exact, as they are
    /// about the other axes.
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    ///
    /// let rod = Solid::cylinder(1.0, 10.0).rotate_x(deg(90.0));
    /// assert!((rod.bounds()?.max.y - 5.0).abs() < 1e-9);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_x(&self, angle: impl Into<Angle>) -> Solid {
        let (sin, cos) = angle.into().sin_cos();
        self.turned("rotate_x", DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos))
    }

    /// Turned about the y axis by `angle`, from z towards x.
    #[must_use]
    pub fn rotate_y(&self, angle: impl Into<Angle>) -> Solid {
        let (sin, cos) = angle.into().sin_cos();
        self.turned("rotate_y", DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos))
    }

    /// Turned about the z axis by `angle`, from x towards y.
    #[must_use]
    pub fn rotate_z(&self, angle: impl Into<Angle>) -> Solid {
        let (sin, cos) = angle.into().sin_cos();
        self.turned("rotate_z", DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
    }

    /// Turned by `angle` about `axis`, which passes through the origin and may be of any length
    /// but 0; anticlockwise seen from where it points.
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    ///
    /// // A third of a turn about the diagonal takes z to x.
    /// let rod = Solid::cylinder(1.0, 10.0).rotate_about([1.0, 1.0, 1.0], deg(120.0));
    /// assert!((rod.bounds()?.max.x - 5.0).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_about(&self, axis: impl Into<DVec3>, angle: impl Into<Angle>) -> Solid {
        let [x, y, z] = about(axis.into(), angle.into());
        self.turned("rotate_about", x, y, z)
    }

    fn turned(&self, label: &'static str, x: DVec3, y: DVec3, z: DVec3) -> Solid {
        self.affine_as(label, DAffine3::from_mat3(DMat3::from_cols(x, y, z)))
    }
}

/// The images of the axes (Rodrigues' formula); an axis without a direction makes them NaN, which
/// is refused on first use.
fn about(axis: DVec3, angle: Angle) -> [DVec3; 3] {
    // Scaled first: the length of a huge axis overflows.
    let axis = axis / axis.abs().max_element();
    let axis = axis / axis.length();
    let (sin, cos) = angle.sin_cos();
    DVec3::AXES.map(|v| cos * v + sin * axis.cross(v) + (1.0 - cos) * axis.dot(v) * axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deg;

    #[test]
    fn quarter_turns_are_exact() {
        for quarter in -5i32..=5 {
            let angle = deg(90.0 * f64::from(quarter));
            let turned = |v: DVec3, across: DVec3| match quarter.rem_euclid(4) {
                0 => v,
                1 => across,
                2 => -v,
                _ => -across,
            };
            for (axis, [x, y, z]) in [
                (DVec3::X, [DVec3::X, turned(DVec3::Y, DVec3::Z), turned(DVec3::Z, -DVec3::Y)]),
                (DVec3::Y, [turned(DVec3::X, -DVec3::Z), DVec3::Y, turned(DVec3::Z, DVec3::X)]),
                (DVec3::Z, [turned(DVec3::X, DVec3::Y), turned(DVec3::Y, -DVec3::X), DVec3::Z]),
            ] {
                assert_eq!(about(axis, angle), [x, y, z], "{quarter} {axis}");
            }
        }
    }

    #[test]
    fn agrees_with_quaternions() {
        let axis = DVec3::new(0.3, -0.8, 0.5);
        for i in -20..=20 {
            let angle = deg(17.3 * f64::from(i));
            let want = DQuat::from_axis_angle(axis.normalize(), angle.radians());
            for (image, v) in about(axis, angle).into_iter().zip(DVec3::AXES) {
                assert!((image - want * v).length() < 1e-14, "{angle}");
            }
        }
    }
}
