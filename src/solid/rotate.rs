//! Rotations by an angle, in radians or in degrees.

use glam::{DAffine3, DMat3, DVec3};

use super::Solid;

impl Solid {
    /// Turned about the x axis by `angle` degrees; whole quarter turns are exact.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let rod = Solid::cylinder(1.0, 10.0).rotate_y_degrees(90.0);
    /// assert!((rod.bounds()?.max.x - 5.0).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_x_degrees(&self, angle: f64) -> Solid {
        let (sin, cos) = sin_cos_degrees(angle);
        self.turned("rotate_x_degrees", DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos))
    }

    /// Turned about the y axis by `angle` degrees; whole quarter turns are exact.
    #[must_use]
    pub fn rotate_y_degrees(&self, angle: f64) -> Solid {
        let (sin, cos) = sin_cos_degrees(angle);
        self.turned("rotate_y_degrees", DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos))
    }

    /// Turned about the z axis by `angle` degrees; whole quarter turns are exact.
    #[must_use]
    pub fn rotate_z_degrees(&self, angle: f64) -> Solid {
        let (sin, cos) = sin_cos_degrees(angle);
        self.turned("rotate_z_degrees", DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
    }

    /// Turned about `axis`, which passes through the origin and may be of any length but 0, by
    /// `angle` radians.
    #[must_use]
    pub fn rotate_about(&self, axis: impl Into<DVec3>, angle: f64) -> Solid {
        self.affine_as("rotate_about", about(axis.into(), angle))
    }

    /// Turned about `axis`, which passes through the origin and may be of any length but 0, by
    /// `angle` degrees.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // A third of a turn about the diagonal takes z to x.
    /// let rod = Solid::cylinder(1.0, 10.0).rotate_about_degrees([1.0, 1.0, 1.0], 120.0);
    /// assert!((rod.bounds()?.max.x - 5.0).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_about_degrees(&self, axis: impl Into<DVec3>, angle: f64) -> Solid {
        self.affine_as("rotate_about_degrees", about(axis.into(), (angle % 360.0).to_radians()))
    }

    fn turned(&self, label: &'static str, x: DVec3, y: DVec3, z: DVec3) -> Solid {
        self.affine_as(label, DAffine3::from_mat3(DMat3::from_cols(x, y, z)))
    }
}

/// A rotation; an axis without a direction makes it NaN, which is refused on first use.
fn about(axis: DVec3, angle: f64) -> DAffine3 {
    // Scaled first: the length of a huge axis overflows.
    let axis = axis / axis.abs().max_element();
    DAffine3::from_mat3(DMat3::from_axis_angle(axis / axis.length(), angle))
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90°.
fn sin_cos_degrees(angle: f64) -> (f64, f64) {
    let angle = angle % 360.0;
    let quarter = (angle / 90.0).round();
    let (sin, cos) = (angle - 90.0 * quarter).to_radians().sin_cos();
    // `quarter` is −4 to 4, or NaN, which leaves NaN in both.
    match (quarter as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for turns in -5i32..=5 {
            let (sin, cos) = sin_cos_degrees(90.0 * f64::from(turns));
            let want = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][turns.rem_euclid(4) as usize];
            assert_eq!((sin, cos), want, "{turns}");
        }
        for i in -1000..1000 {
            let angle = 0.731 * f64::from(i);
            let (sin, cos) = sin_cos_degrees(angle);
            let (s, c) = angle.to_radians().sin_cos();
            assert!((sin - s).abs() < 1e-14 && (cos - c).abs() < 1e-14, "{angle}");
        }
        assert!(sin_cos_degrees(f64::INFINITY).0.is_nan() && sin_cos_degrees(f64::NAN).1.is_nan());
    }
}
