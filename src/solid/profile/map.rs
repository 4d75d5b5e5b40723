//! Maps of the plane, repetition, levels, offsets and shells of profiles.

use glam::{DAffine2, DAffine3, DMat3, DVec2, DVec3};

use super::Profile;
use crate::Angle;

impl Profile {
    /// Moved by `offset`, ±10⁹ length units along each axis.
    #[must_use]
    pub fn translate(&self, offset: impl Into<DVec2>) -> Profile {
        Profile(self.0.translate(offset.into().extend(0.0)))
    }

    /// Turned about the origin by `angle`, from x towards y; quarter turns are exact.
    ///
    /// ```
    /// use rvachev::{deg, Profile};
    ///
    /// let upright = Profile::rectangle([6.0, 2.0]).rotate(deg(90.0));
    /// assert_eq!(upright.value([0.0, 2.5])?, 0.5);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate(&self, angle: impl Into<Angle>) -> Profile {
        let (sin, cos) = angle.into().sin_cos();
        let matrix = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
        Profile(self.0.affine_as("rotate", DAffine3::from_mat3(matrix)))
    }

    /// Scaled about the origin by `factor` (not 0; a negative one turns by half a turn).
    #[must_use]
    pub fn scale(&self, factor: f64) -> Profile {
        let factors = DVec3::new(factor, factor, factor.abs());
        Profile(self.0.affine_as("scale", DAffine3::from_scale(factors)))
    }

    /// Scaled about the origin by a factor along each axis (neither 0).
    #[must_use]
    pub fn scale_axes(&self, factors: impl Into<DVec2>) -> Profile {
        let factors = factors.into();
        // Along z nothing depends on the factor; values keep to the smallest one.
        Profile(self.0.scale_axes(factors.extend(factors.x.abs())))
    }

    /// Mapped by any invertible affine map of the plane. Values are multiplied by its smallest
    /// stretch: see [`Solid::affine`](crate::Solid::affine).
    #[must_use]
    pub fn affine(&self, forward: DAffine2) -> Profile {
        let m = forward.matrix2;
        // Along z a stretch between the smallest and the largest, which changes neither.
        let along = m.determinant().abs().sqrt();
        let matrix = DMat3::from_cols(m.x_axis.extend(0.0), m.y_axis.extend(0.0), DVec3::Z * along);
        self.affine_in_space(DAffine3::from_mat3_translation(matrix, forward.translation.extend(0.0)))
    }

    /// Mapped by an affine map of space that keeps to the plane: as [`affine`](Profile::affine),
    /// with the stretch along z chosen. It changes no shape; values are multiplied by the smallest
    /// stretch of the whole map.
    ///
    /// For maps that come from elsewhere: of a [`Form`](crate::form::Form), of
    /// [`simplified`](Profile::simplified) profiles. Invertible, numbers within ±10⁹; a map that
    /// mixes z with x and y makes a solid that is no column.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use rvachev::Profile;
    ///
    /// let disc = Profile::circle(1.0).affine_in_space(DAffine3::from_scale(DVec3::new(2.0, 3.0, 1.0)));
    /// assert!(disc.contains([0.0, 2.9])? && !disc.contains([0.0, 3.1])?);
    /// assert!((disc.value([0.0, 0.0])? - 1.0).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn affine_in_space(&self, forward: DAffine3) -> Profile {
        Profile(self.0.affine(forward))
    }

    /// The reflection in the line of all points p with `normal·p = offset`, for a unit normal:
    /// the mirror image alone. With its image beside it: [`mirrored`](Profile::mirrored).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let arrow = Profile::polygon([[0.0, -1.0], [3.0, 0.0], [0.0, 1.0]]).reflect([1.0, 0.0], 0.5);
    /// assert!(arrow.contains([-1.5, 0.0])? && !arrow.contains([2.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn reflect(&self, normal: impl Into<DVec2>, offset: f64) -> Profile {
        Profile(self.0.reflect(normal.into().extend(0.0), offset))
    }

    /// The reflection in the line x = 0: the mirror image alone.
    #[must_use]
    pub fn reflect_x(&self) -> Profile {
        Profile(self.0.reflect_x())
    }

    /// The reflection in the line y = 0: the mirror image alone.
    #[must_use]
    pub fn reflect_y(&self) -> Profile {
        Profile(self.0.reflect_y())
    }

    /// The profile together with its mirror image in the line of all points p with
    /// `normal·p = offset`, for a unit normal: their union by the maximum.
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let eyes = Profile::circle(1.0).translate([3.0, 0.0]).mirrored([1.0, 0.0], 0.0);
    /// assert!(eyes.contains([3.0, 0.0])? && eyes.contains([-3.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn mirrored(&self, normal: impl Into<DVec2>, offset: f64) -> Profile {
        Profile(self.0.mirrored(normal.into().extend(0.0), offset))
    }

    /// The profile together with its mirror image in the line x = 0.
    #[must_use]
    pub fn mirrored_x(&self) -> Profile {
        Profile(self.0.mirrored_x())
    }

    /// The profile together with its mirror image in the line y = 0.
    #[must_use]
    pub fn mirrored_y(&self) -> Profile {
        Profile(self.0.mirrored_y())
    }

    /// A grid of copies along the axes: `counts` of them, `spacing` apart, the first one the
    /// profile where it is. Values, ranges and what it costs:
    /// [`Solid::repeat`](crate::Solid::repeat).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let holes = Profile::circle(0.3).repeat([20, 10], [1.0, 1.0]);
    /// let sieve = Profile::rectangle([20.0, 10.0]).translate([9.5, 4.5]) - holes;
    /// assert!(!sieve.contains([12.0, 7.2])? && sieve.contains([12.5, 7.5])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat(&self, counts: [u32; 2], spacing: impl Into<DVec2>) -> Profile {
        let [x, y] = counts;
        Profile(self.0.repeat([x, y, 1], spacing.into().extend(0.0)))
    }

    /// A row of `count` copies, each `step` from the one before; the first one is the profile
    /// where it is: see [`Solid::repeat_linear`](crate::Solid::repeat_linear).
    #[must_use]
    pub fn repeat_linear(&self, count: u32, step: impl Into<DVec2>) -> Profile {
        Profile(self.0.repeat_linear(count, step.into().extend(0.0)))
    }

    /// A ring of `count` copies about the origin, at equal angles of a whole turn; the first one
    /// is the profile where it is: see [`Solid::repeat_polar`](crate::Solid::repeat_polar).
    ///
    /// ```
    /// use rvachev::{deg, Profile};
    ///
    /// let holes = Profile::circle(1.0).translate([12.0, 0.0]).repeat_polar(5);
    /// let flange = Profile::circle(16.0) - holes;
    /// let (sin, cos) = deg(72.0).sin_cos();
    /// assert!(!flange.contains([12.0 * cos, 12.0 * sin])? && flange.contains([-12.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat_polar(&self, count: u32) -> Profile {
        Profile(self.0.repeat_polar(count))
    }

    /// Elongated by straight pieces of these lengths along x and y: see
    /// [`Solid::elongate`](crate::Solid::elongate).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// // A slot 10 long and 2 wide.
    /// let slot = Profile::circle(1.0).elongate([8.0, 0.0]);
    /// assert_eq!(slot.value([0.0, 0.0])?, 1.0);
    /// assert!((slot.bounds()?.max.x - 5.0).abs() < 1e-9);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn elongate(&self, lengths: impl Into<DVec2>) -> Profile {
        Profile(self.0.elongate(lengths.into().extend(0.0)))
    }

    /// The shape whose value is this one's plus `value`: see
    /// [`Solid::level`](crate::Solid::level).
    #[must_use]
    pub fn level(&self, value: f64) -> Profile {
        Profile(self.0.level(value))
    }

    /// The shape with its border moved outwards by `distance` (inwards if negative): see
    /// [`Solid::offset`](crate::Solid::offset).
    ///
    #[doc = picture!(
        "profile_offset" = "docs/gallery/profile_offset.png",
    )]
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let triangle = Profile::polygon([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]);
    /// assert!((triangle.offset(0.5).value([2.0, -0.25])? - 0.25).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn offset(&self, distance: f64) -> Profile {
        Profile(self.0.offset(distance))
    }

    /// The band of this shape, `thickness` wide, measured inwards from its border: see
    /// [`Solid::shell`](crate::Solid::shell).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let tube = Profile::rectangle([20.0, 10.0]).shell(1.5);
    /// assert!((tube.value([0.0, 4.0])? - 0.5).abs() < 1e-12);
    /// assert!(tube.contains([9.0, 0.0])? && !tube.contains([0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn shell(&self, thickness: f64) -> Profile {
        Profile(self.0.shell(thickness))
    }

    /// The shape with its convex corners rounded: see [`Solid::rounded`](crate::Solid::rounded).
    ///
    #[doc = picture!("profile_rounded" = "docs/gallery/profile_rounded.png")]
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let plate = Profile::rectangle([20.0, 10.0]).rounded(2.0);
    /// assert!(plate.contains([9.3, 4.3])? && !plate.contains([9.6, 4.6])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rounded(&self, radius: f64) -> Profile {
        Profile(self.0.rounded(radius))
    }

    /// The shape with its concave corners filled: see [`Solid::filleted`](crate::Solid::filleted).
    ///
    #[doc = picture!("profile_filleted" = "docs/gallery/profile_filleted.png")]
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]];
    /// let filled = Profile::polygon(corner).filleted(2.0);
    /// assert!(filled.contains([4.5, 4.5])? && !filled.contains([4.7, 4.7])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn filleted(&self, radius: f64) -> Profile {
        Profile(self.0.filleted(radius))
    }

    /// The same shape, its border measured to `tolerance` (10⁻⁹ to 10⁹, in length units): right
    /// behind `offset`, `shell`, `rounded`, `filleted`, or a blend by fillet or chamfer. See
    /// [`Solid::with_tolerance`](crate::Solid::with_tolerance).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let egg = Profile::superellipse([3.0, 2.0], 0.8).offset(0.5).with_tolerance(1e-5);
    /// assert!(egg.accuracy()?.tolerance <= 1e-5);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn with_tolerance(&self, tolerance: f64) -> Profile {
        Profile(self.0.with_tolerance(tolerance))
    }
}
