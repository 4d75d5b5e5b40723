//! Deformations that follow a user's law, and elongation.

use glam::DVec3;

use super::Solid;
use crate::{Angle, BuiltInLaw, Law};
use rvachev_field::{Elongate, TaperBy, TwistBy, catalogue};

impl Solid {
    /// Tapered along z by any [laws](crate::law::Law) of z: sections are scaled by `x_law` along x
    /// and by `y_law` along y.
    ///
    #[doc = picture!("taper_by" = "docs/gallery/taper_by.png", "taper_by_wave" = "docs/gallery/taper_by_wave.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `x_law`, `y_law` | none | 0.001 to 1000 over the heights of the solid's box, which is checked; beyond these heights they are held in that range |
    ///
    /// The field is the operand's at the pre-image, not rescaled: not Lipschitz in general.
    ///
    /// ```
    /// use rvachev::law::SmoothStep;
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// // Half as wide along x at the top, as deep along y as ever.
    /// let narrower = SmoothStep { from: (-1.0, 1.0), to: (1.0, 0.5) };
    /// let chisel = Solid::cuboid(DVec3::new(2.0, 2.0, 4.0)).taper_by(narrower, 1.0);
    /// assert!(chisel.contains(DVec3::new(0.4, 0.9, 1.9))?);
    /// assert!(!chisel.contains(DVec3::new(0.6, 0.0, 1.9))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn taper_by(&self, x_law: impl Law, y_law: impl Law) -> Solid {
        // The laws that are built in share their kernels.
        match (BuiltInLaw::of(&x_law), BuiltInLaw::of(&y_law)) {
            (Some(x), Some(y)) => self.warped(catalogue::taper_by(x, y)),
            _ => self.warp(TaperBy { x: x_law, y: y_law }),
        }
    }

    /// Twisted about the z axis by any [law](crate::law::Law) of z: the section at z is turned by
    /// `angle` times the law's value there, from x towards y. In proportion to z:
    /// [`twist`](Solid::twist).
    ///
    #[doc = picture!("twist_by" = "docs/gallery/twist_by.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `angle` | [`Angle`] | ±10⁹ degrees |
    /// | `law` | none | `angle` times it is ±576 000 degrees over the heights of the solid's box, which is checked; beyond these heights it is held in that range |
    ///
    /// The field is the operand's at the pre-image, not rescaled: its slope grows with that of
    /// the law times the distance from the axis.
    ///
    /// ```
    /// use rvachev::law::SineWave;
    /// use rvachev::{Solid, deg};
    /// use glam::DVec3;
    ///
    /// // To and fro by 30 degrees.
    /// let swing = SineWave { mean: 0.0, amplitude: 1.0, wavelength: 4.0, phase: deg(0.0) };
    /// let bar = Solid::cuboid(DVec3::new(2.0, 0.5, 8.0)).twist_by(deg(30.0), swing);
    /// let (sin, cos) = deg(30.0).sin_cos();
    /// assert!(bar.contains(DVec3::new(0.9 * cos, 0.9 * sin, 1.0))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn twist_by(&self, angle: impl Into<Angle>, law: impl Law) -> Solid {
        let angle = angle.into();
        match BuiltInLaw::of(&law) {
            Some(law) => self.warped(catalogue::twist_by(angle, law)),
            None => self.warp(TwistBy { angle, law }),
        }
    }

    /// Elongated by straight pieces of these `lengths`: the parts on either side of each
    /// coordinate plane move apart by the length across it, and the section in the plane is drawn
    /// out between them: `f(p) = solid(p − clamp(p, −lengths/2, lengths/2))`.
    ///
    #[doc = picture!("elongate" = "docs/gallery/elongate.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `lengths` | length | 0 to 10⁹ along each axis: by how much the solid grows |
    ///
    /// 1-Lipschitz if the operand is, and outside the true distance if the operand has it.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let capsule = Solid::sphere(1.0).elongate(DVec3::new(0.0, 0.0, 4.0));
    /// assert!((capsule.bounds()?.size() - DVec3::new(2.0, 2.0, 6.0)).length() < 1e-12);
    /// assert_eq!(capsule.value(DVec3::new(3.0, 0.0, 1.5))?, -2.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn elongate(&self, lengths: impl Into<DVec3>) -> Solid {
        self.warp(Elongate { lengths: lengths.into() })
    }
}
