//! Questions to a solid, answered in double precision.

use glam::DVec3;

use super::inside::{is_inside, joint};
use super::nearest::nearest;
use crate::distance::{compiled, surface_of};
use crate::eval::{Care, Hit, Owner, Program, Region, first_hit};
use crate::geom::unit;
use crate::{Bounds, Interval, Solid, SolidError};
use rvachev_field::check;

impl Solid {
    /// The program of true values.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn field_program(&self) -> Result<Program, SolidError> {
        Ok(compiled(self)?.field.clone())
    }

    /// The program for work on the surface: the same solid, surface and normals, with min and
    /// max in place of R-functions.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn surface_program(&self) -> Result<Program, SolidError> {
        Ok(compiled(self)?.surface.clone())
    }

    /// The field at a point, in length units, positive inside.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// assert_eq!(Solid::sphere(2.0).value(DVec3::X)?, 1.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn value(&self, p: impl Into<DVec3>) -> Result<f64, SolidError> {
        Ok(compiled(self)?.field.value(p))
    }

    /// Whether a point is inside: the value is positive, or inside is all around, as on a face that
    /// two parts share.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let brick = Solid::cuboid([20.0, 20.0, 10.0]);
    /// let tower = brick.clone() | brick.translate([0.0, 0.0, 10.0]);
    /// assert!(tower.contains([0.0, 0.0, 5.0])? && !tower.contains([10.0, 0.0, 5.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn contains(&self, p: impl Into<DVec3>) -> Result<bool, SolidError> {
        Ok(is_inside(&*compiled(self)?, p.into()))
    }

    /// The field's gradient at a point; it points inward. At kinks, that of one side; 0 at a point
    /// with a coordinate that is NaN.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn gradient(&self, p: impl Into<DVec3>) -> Result<DVec3, SolidError> {
        Ok(compiled(self)?.field.gradient(p).1)
    }

    /// A sound range of the field over a box: every value in it lies in the interval. The
    /// whole line for a box that is infinite.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn range(&self, region: &Bounds) -> Result<Interval, SolidError> {
        Ok(compiled(self)?.field.range(region))
    }

    /// What a box holds of the solid, soundly.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn region(&self, region: &Bounds) -> Result<Region, SolidError> {
        Ok(compiled(self)?.surface.narrow(region))
    }

    /// A box that holds the solid; infinite where the solid is unbounded, empty
    /// ([`Bounds::EMPTY`]) where it is known to hold nothing.
    ///
    /// Leaves under affine maps have their tightest box; joins combine those of their
    /// operands. So what offsets and roundings leave nothing of, and the intersection of operands
    /// that are apart, have an empty box; what a difference takes away whole still has that of
    /// its first operand.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn bounds(&self) -> Result<Bounds, SolidError> {
        Ok(compiled(self)?.bounds())
    }

    /// The box of the solid, for work that needs one.
    ///
    /// # Errors
    /// [`SolidError::Unbounded`], naming the node, if it is infinite.
    pub fn finite_bounds(&self) -> Result<Bounds, SolidError> {
        let programs = compiled(self)?;
        let bounds = programs.bounds();
        if bounds.is_empty() || bounds.is_finite() {
            return Ok(bounds);
        }
        Err(SolidError::Unbounded { path: programs.unbounded.clone() })
    }

    /// The first point of the surface on a ray, from outside or inside; `None` if the ray
    /// misses. `direction` need not be of unit length; distances are in length units.
    ///
    /// The first crossing is found with certainty: parts of the ray are discarded only where
    /// an interval shows that there is none. A face that two operands share is inside: a ray in
    /// it goes on to where the solid ends. A ray that touches the surface without crossing may
    /// miss it; so may one along which an unbounded deformed solid winds without end.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`]; [`SolidError::Argument`] if a coordinate
    /// of the ray is not finite, or its direction is zero.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let ball = Solid::superellipsoid(DVec3::ONE, 1.0, 1.0);
    /// let hit = ball.raycast(DVec3::X * 5.0, -DVec3::X)?.expect("aimed at the centre");
    /// assert!((hit.distance - 4.0).abs() < 1e-12);
    /// assert!((hit.normal - DVec3::X).length() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn raycast(&self, origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> Result<Option<Hit>, SolidError> {
        let programs = compiled(self)?;
        let (origin, direction) = (origin.into(), direction.into());
        check::point("origin", origin).map_err(SolidError::Argument)?;
        check::direction("direction", direction).map_err(SolidError::Argument)?;
        let direction = unit(direction);
        let whole = [joint(&programs, origin), f64::INFINITY];
        Ok(first_hit(&programs.surface, &programs.bounds(), (origin, direction), whole, Care::Full))
    }

    /// The point of the surface nearest to `p`, to about 10⁻⁹ of the solid's size where the surface
    /// is smooth there; `None` if the solid is empty or fills its bounds. A point that is more than
    /// a million sizes away counts as one at that distance, in the same direction.
    ///
    /// Where the solid's value is the [distance](crate::lengths#exact-or-measured) the point is
    /// found at once. Elsewhere the surface is measured at the first call, and kept.
    ///
    /// # Errors
    /// What is wrong with the solid; [`SolidError::Unbounded`] if it has no finite box,
    /// [`SolidError::Argument`] if a coordinate of the point is not finite.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let brick = Solid::cuboid(DVec3::new(2.0, 2.0, 2.0));
    /// let q = brick.closest_surface_point(DVec3::new(3.0, 0.5, 0.25))?.expect("it has a surface");
    /// assert!((q - DVec3::new(1.0, 0.5, 0.25)).length() < 1e-8);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn closest_surface_point(&self, p: impl Into<DVec3>) -> Result<Option<DVec3>, SolidError> {
        let p = p.into();
        let bounds = self.finite_bounds()?;
        let programs = compiled(self)?;
        check::point("p", p).map_err(SolidError::Argument)?;
        if bounds.is_empty() {
            return Ok(None);
        }
        if let Some(foot) = programs.foot(p) {
            return Ok(Some(foot));
        }
        Ok(nearest(&programs.surface, &surface_of(self)?.patches, p))
    }

    /// The leaf that decides at a point: the one whose value the point has after min and max.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let part = Solid::cuboid(DVec3::ONE * 2.0) - Solid::cylinder(0.5, 3.0);
    /// assert_eq!(part.owner(DVec3::new(0.5, 0.0, 0.0))?.path, "difference[1] / cylinder");
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn owner(&self, p: impl Into<DVec3>) -> Result<Owner, SolidError> {
        Ok(compiled(self)?.surface.owner(p))
    }
}
