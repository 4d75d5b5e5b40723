//! Maps: affine ones, taper, twist and bend. (Those by laws are in `deform`, reflections in `mirror`,
//! repetition, which asks for boxes, in `eval`.)

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};

use super::{Node, Solid};
use crate::field::{Bend, Taper, Twist};

impl Solid {
    pub(crate) fn affine_as(&self, label: &'static str, forward: DAffine3) -> Solid {
        Solid::from_node(Node::Affine { operand: self.clone(), forward, label })
    }

    /// Moved by `offset`.
    #[must_use]
    pub fn translate(&self, offset: impl Into<DVec3>) -> Solid {
        self.affine_as("translate", DAffine3::from_translation(offset.into()))
    }

    /// Turned about the origin.
    #[must_use]
    pub fn rotate(&self, rotation: DQuat) -> Solid {
        self.affine_as("rotate", DAffine3::from_quat(rotation))
    }

    /// Turned about the x axis by `angle` radians.
    #[must_use]
    pub fn rotate_x(&self, angle: f64) -> Solid {
        self.affine_as("rotate_x", DAffine3::from_rotation_x(angle))
    }

    /// Turned about the y axis by `angle` radians.
    #[must_use]
    pub fn rotate_y(&self, angle: f64) -> Solid {
        self.affine_as("rotate_y", DAffine3::from_rotation_y(angle))
    }

    /// Turned about the z axis by `angle` radians.
    #[must_use]
    pub fn rotate_z(&self, angle: f64) -> Solid {
        self.affine_as("rotate_z", DAffine3::from_rotation_z(angle))
    }

    /// Scaled about the origin by the same `factor` along all axes (not 0; a negative one
    /// mirrors).
    #[must_use]
    pub fn scale(&self, factor: f64) -> Solid {
        self.affine_as("scale", DAffine3::from_scale(DVec3::splat(factor)))
    }

    /// Scaled about the origin by a factor along each axis (none 0).
    #[must_use]
    pub fn scale_axes(&self, factors: impl Into<DVec3>) -> Solid {
        self.affine_as("scale_axes", DAffine3::from_scale(factors.into()))
    }

    /// Mapped by any invertible affine map. Values are multiplied by the map's smallest
    /// stretch, so that they stay 1-Lipschitz.
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
    /// `t = z/half_height` held to [−1, 1]. `kx` and `ky` are within ±0.999.
    ///
    /// The field is the operand's at the pre-image, not rescaled: not Lipschitz in general.
    #[must_use]
    pub fn taper(&self, kx: f64, ky: f64, half_height: f64) -> Solid {
        self.warp(Taper { kx, ky, half_height })
    }

    /// Twisted about the z axis by `rate` radians per length unit.
    ///
    /// The field is the operand's at the pre-image, not rescaled: its slope grows with
    /// `rate` times the distance from the axis.
    #[must_use]
    pub fn twist(&self, rate: f64) -> Solid {
        self.warp(Twist { rate })
    }

    /// Bent so that the z axis becomes a circle of radius `1/curvature` through the origin,
    /// with its centre in the direction `angle` (radians from the x axis, in the xy plane).
    ///
    /// The solid must stay on this side of the centre of curvature and within half a turn;
    /// both are checked on the operand's box, which is conservative.
    ///
    /// The field is the operand's at the pre-image, not rescaled; its slope grows towards the
    /// centre of curvature.
    #[must_use]
    pub fn bend(&self, curvature: f64, angle: f64) -> Solid {
        self.warp(Bend { curvature, angle })
    }

    pub(crate) fn warp(&self, warp: impl crate::field::AnyWarp + 'static) -> Solid {
        Solid::from_node(Node::Warp { operand: self.clone(), warp: Arc::new(warp) })
    }
}
