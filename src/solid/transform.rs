//! Maps: affine ones, taper, twist and bend. (Rotations are in `rotate`, maps by laws in `deform`,
//! reflections in `mirror`, repetition, which asks for boxes, in `eval`.)

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{Node, Solid};
use crate::Angle;
use rvachev_field::{AnyWarp, Bend, BendBetween, Erase, Taper, Twist};

impl Solid {
    pub(crate) fn affine_as(&self, label: &'static str, forward: DAffine3) -> Solid {
        Solid::from_node(Node::Affine { operand: self.clone(), forward, label })
    }

    /// Moved by `offset`, ±10⁹ length units along each axis. Values go along unchanged, as they
    /// do with rotations.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let ball = Solid::sphere(1.0).translate([5.0, 0.0, 0.0]);
    /// assert_eq!(ball.value([5.5, 0.0, 0.0])?, 0.5);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn translate(&self, offset: impl Into<DVec3>) -> Solid {
        self.affine_as("translate", DAffine3::from_translation(offset.into()))
    }

    /// Scaled about the origin by the same `factor` along all axes (not 0; a negative one
    /// mirrors). Values are scaled with it: true distances stay true.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// assert_eq!(Solid::sphere(1.0).scale(3.0).value([0.0, 0.0, 0.0])?, 3.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn scale(&self, factor: f64) -> Solid {
        self.affine_as("scale", DAffine3::from_scale(DVec3::splat(factor)))
    }

    /// Scaled about the origin by a factor along each axis (none 0). Values are multiplied by the
    /// smallest one: see [`affine`](Solid::affine).
    #[must_use]
    pub fn scale_axes(&self, factors: impl Into<DVec3>) -> Solid {
        self.affine_as("scale_axes", DAffine3::from_scale(factors.into()))
    }

    /// Mapped by any invertible affine map. Values are multiplied by the map's smallest
    /// stretch, so that they stay 1-Lipschitz; true distances stay true if the map stretches
    /// alike in all directions, and become bounds else.
    ///
    #[doc = picture!("affine" = "docs/gallery/affine.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | entries of the matrix | none | ±10⁹; its smallest stretch at least 10⁻⁹, and at least 10⁻⁹ of the largest |
    /// | translation | length | ±10⁹ |
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::{DAffine3, DVec3};
    ///
    /// let egg = Solid::sphere(1.0).affine(DAffine3::from_scale(DVec3::new(1.0, 1.0, 2.0)));
    /// assert!(egg.contains(DVec3::Z * 1.9)?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn affine(&self, forward: DAffine3) -> Solid {
        self.affine_as("affine", forward)
    }

    /// Tapered along z: sections are scaled by `1 + kx·t` along x and `1 + ky·t` along y,
    /// `t = 2z/height` held to [−1, 1]: from z = −height/2 to height/2. By any other law of z:
    /// [`taper_by`](Solid::taper_by).
    ///
    #[doc = picture!("taper" = "docs/gallery/taper.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `kx`, `ky` | none | −0.999 to 0.999 |
    /// | `height` | length | 10⁻⁹ to 10⁹ |
    ///
    /// The field is the operand's at the pre-image, not rescaled: not Lipschitz in general.
    ///
    /// Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // 3 wide at the bottom, 1 at the top.
    /// let post = Solid::cuboid([2.0, 2.0, 4.0]).taper(-0.5, -0.5, 4.0);
    /// assert!(post.contains([1.4, 0.0, -1.9])?);
    /// assert!(!post.contains([0.6, 0.0, 1.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn taper(&self, kx: f64, ky: f64, height: f64) -> Solid {
        self.warp(Taper { kx, ky, height })
    }

    /// Twisted about the z axis: the section at z is turned by `rate·z`, from x towards y. By any
    /// other law of z: [`twist_by`](Solid::twist_by).
    ///
    #[doc = picture!("twist" = "docs/gallery/twist.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `rate` | [`Angle`] per unit of length | ±10⁹ degrees |
    ///
    /// The field is the operand's at the pre-image, not rescaled: its slope grows with
    /// `rate` times the distance from the axis.
    ///
    /// Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    ///
    /// // A quarter turn between the middle and the top.
    /// let bar = Solid::cuboid([2.0, 0.5, 8.0]).twist(deg(90.0) / 4.0);
    /// assert!(bar.contains([0.9, 0.0, 0.0])? && !bar.contains([0.9, 0.0, 3.9])?);
    /// assert!(bar.contains([0.0, 0.9, 3.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn twist(&self, rate: impl Into<Angle>) -> Solid {
        self.warp(Twist { rate: rate.into() })
    }

    /// Bent so that the z axis becomes a circle of radius `1/curvature` through the origin,
    /// with its centre in the direction `angle`, counted from the x axis towards y.
    ///
    #[doc = picture!("bend" = "docs/gallery/bend.png")]
    ///
    /// With κ the curvature and, for an angle of 0, in the plane of x and z:
    ///
    /// ```text
    /// (x, z) ↦ ((1 − (1 − κx)·cos κz)/κ, (1 − κx)·sin κz/κ)
    /// ```
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `curvature` | 1 / length | within ±π/h and ±1/r for a solid that reaches h from the plane z = 0 and r towards the centre |
    /// | `angle` | [`Angle`] | ±10⁹ degrees |
    ///
    /// The solid must stay on this side of the centre of curvature and within half a turn to
    /// each side; both are checked on the operand's box, which is conservative.
    ///
    /// The field is the operand's at the pre-image, not rescaled; its slope grows towards the
    /// centre of curvature.
    ///
    /// Sources: A. H. Barr, *Global and local deformations of solid primitives* (1984); F. Solina
    /// and R. Bajcsy, *Recovery of parametric models from range images* (1990), their bend put
    /// right for negative, strong and vanishing curvatures.
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    ///
    /// // A rod 10 long becomes two radians of a circle of radius 5.
    /// let hook = Solid::cylinder(0.5, 10.0).bend(0.2, deg(0.0));
    /// let (sin, cos) = 0.98f64.sin_cos();
    /// assert!(hook.contains([5.0 - 5.0 * cos, 0.0, 5.0 * sin])?);
    /// assert!(!hook.contains([0.0, 0.0, 4.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn bend(&self, curvature: f64, angle: impl Into<Angle>) -> Solid {
        self.warp(Bend { curvature, angle: angle.into() })
    }

    /// Bent between two heights only: what is between `from` and `to` along z becomes an arc that
    /// turns by `turn` towards `angle`, counted from the x axis towards y. What is below `from`
    /// stays where it is; what is above `to` is moved rigidly and goes on straight from the arc.
    ///
    #[doc = picture!("bend_between" = "docs/gallery/bend_between.png")]
    ///
    /// Lengths along the z axis are kept: the arc's radius is (to − from)/turn, with the turn in
    /// radians. A pipe that shall turn by 90° on a radius of 30 is bent over a length of 30·π/2.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `from`, `to` | length | ±10⁹, `from` below `to` |
    /// | `turn` | [`Angle`] | within ±360°; the solid stays on this side of the arc's centre, and its straight ends do not meet |
    /// | `angle` | [`Angle`] | ±10⁹ degrees |
    ///
    /// What the solid allows is checked on its box, which is conservative; a turn below 180° leaves
    /// room for ends of any length. The field is the operand's at the pre-image, not rescaled; on
    /// the arc its slope grows towards the centre, so a surface that leans against the z axis has
    /// an edge where the arc begins.
    ///
    /// Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).
    ///
    /// ```
    /// use rvachev::{Solid, deg};
    ///
    /// // A rod along z, 100 long: 20 straight, a quarter of a circle of radius 30, the rest straight.
    /// let arc = 30.0 * std::f64::consts::FRAC_PI_2;
    /// let elbow = Solid::cylinder(4.0, 100.0).translate([0.0, 0.0, 50.0]).bend_between(20.0, 20.0 + arc, deg(90.0), deg(0.0));
    /// assert!(elbow.contains([0.0, 0.0, 1.0])? && elbow.contains([33.9, 0.0, 50.0])?);
    /// let end = 30.0 + 80.0 - arc;
    /// assert!((elbow.bounds()?.max.x - end).abs() < 1e-9 && elbow.contains([end - 0.1, 0.0, 53.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn bend_between(&self, from: f64, to: f64, turn: impl Into<Angle>, angle: impl Into<Angle>) -> Solid {
        self.warp(BendBetween { from, to, turn: turn.into(), angle: angle.into() })
    }

    pub(crate) fn warp(&self, warp: impl Erase<dyn AnyWarp>) -> Solid {
        self.warped(warp.erase())
    }

    pub(crate) fn warped(&self, warp: Arc<dyn AnyWarp>) -> Solid {
        Solid::from_node(Node::Warp { operand: self.clone(), warp })
    }
}
