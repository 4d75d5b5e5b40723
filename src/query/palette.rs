//! The paint of a solid.

use glam::DVec3;

use crate::distance::compiled;
use crate::program::Palette;
use crate::{Paint, Solid, SolidError};

impl Solid {
    /// The paint of the solid's parts, by the numbers of their [owners](Solid::owner).
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn palette(&self) -> Result<Palette, SolidError> {
        Ok(compiled(self)?.palette.clone())
    }

    /// The [paint](Solid::paint) of the surface at a point of it; `None` where there is none.
    ///
    /// # Errors
    /// What is wrong with the solid: see [`SolidError`].
    pub fn paint_at(&self, p: impl Into<DVec3>) -> Result<Option<Paint>, SolidError> {
        let (palette, p) = (self.palette()?, p.into());
        Ok(palette.at(palette.program.deciding_leaf(p), p))
    }
}
