//! Reflections, and solids made symmetric.

use glam::{DAffine3, DMat3, DVec3};

use super::Solid;
use crate::RFunction;
use crate::geom::unit;

impl Solid {
    /// The reflection in the plane of all points p with `n·p = offset`, where n is the unit vector
    /// along `normal`: the mirror image alone. With its image beside it:
    /// [`mirrored`](Solid::mirrored).
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let ball = Solid::sphere(1.0).translate(DVec3::X * 3.0).reflect(DVec3::X, 1.0);
    /// assert!(ball.contains(DVec3::X * -1.0)?);
    /// assert!(!ball.contains(DVec3::X * 3.0)?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn reflect(&self, normal: impl Into<DVec3>, offset: f64) -> Solid {
        // One of no direction is NaN, which is told when the solid is compiled.
        let n = unit(normal.into());
        let matrix = DMat3::IDENTITY - 2.0 * DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        let forward = DAffine3::from_mat3_translation(matrix, 2.0 * offset * n);
        self.affine_as("reflect", forward)
    }

    /// The reflection in the plane x = 0: the mirror image alone.
    #[must_use]
    pub fn reflect_x(&self) -> Solid {
        self.reflect(DVec3::X, 0.0)
    }

    /// The reflection in the plane y = 0: the mirror image alone.
    #[must_use]
    pub fn reflect_y(&self) -> Solid {
        self.reflect(DVec3::Y, 0.0)
    }

    /// The reflection in the plane z = 0: the mirror image alone.
    #[must_use]
    pub fn reflect_z(&self) -> Solid {
        self.reflect(DVec3::Z, 0.0)
    }

    /// The solid together with its mirror image in the plane of all points p with
    /// `n·p = offset`, where n is the unit vector along `normal`: their union by the maximum. The
    /// image alone: [`reflect`](Solid::reflect).
    ///
    #[doc = picture!("mirrored" = "docs/gallery/mirrored.png")]
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let pair = Solid::sphere(1.0).translate(DVec3::X * 3.0).mirrored_x();
    /// assert!(pair.contains(DVec3::X * 3.0)? && pair.contains(DVec3::X * -3.0)?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn mirrored(&self, normal: impl Into<DVec3>, offset: f64) -> Solid {
        self.union(self.reflect(normal, offset), RFunction::MIN_MAX)
    }

    /// The solid together with its mirror image in the plane x = 0.
    #[must_use]
    pub fn mirrored_x(&self) -> Solid {
        self.mirrored(DVec3::X, 0.0)
    }

    /// The solid together with its mirror image in the plane y = 0.
    #[must_use]
    pub fn mirrored_y(&self) -> Solid {
        self.mirrored(DVec3::Y, 0.0)
    }

    /// The solid together with its mirror image in the plane z = 0.
    #[must_use]
    pub fn mirrored_z(&self) -> Solid {
        self.mirrored(DVec3::Z, 0.0)
    }
}
