//! What the pixels of a picture see, before it is shaded.
//!
//! ```text
//!     eye *-----------------*)  surface      distance along the ray, outward normal,
//!          direction (unit)  |               number of the leaf
//! ```

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::Rays;

/// What a ray meets: 24 bytes, so that a picture of them stays small. The point is
/// `origin + distance · direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Distance from the ray's origin, in length units; infinite if the ray meets nothing.
    pub distance: f64,
    /// Unit normal, out of the solid; 0 where the field has no gradient or nothing is met.
    pub normal: Vec3,
    /// The number of the leaf whose surface it is ([`Owner::index`](crate::Owner::index), which
    /// tells of imported meshes also which of their owners; this does not); `u32::MAX` if nothing
    /// is met.
    pub owner: u32,
}

impl Surface {
    /// Of a ray that meets nothing.
    pub const NONE: Surface = Surface { distance: f64::INFINITY, normal: Vec3::ZERO, owner: u32::MAX };

    /// Whether the ray meets something.
    #[must_use]
    #[inline]
    pub fn is_hit(&self) -> bool {
        self.distance < f64::INFINITY
    }
}

impl Default for Surface {
    fn default() -> Surface {
        Surface::NONE
    }
}

/// A rectangle of pixels of a picture, and where in each pixel the ray passes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Window {
    /// The first column.
    pub left: u32,
    /// The first row, from the top.
    pub top: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Where in a pixel its ray passes, from its top left corner: (0.5, 0.5) is its middle.
    pub within: (f64, f64),
}

impl Window {
    /// All of a picture, through the middles of its pixels.
    #[must_use]
    pub fn whole(width: u32, height: u32) -> Window {
        Window { left: 0, top: 0, width, height, within: (0.5, 0.5) }
    }

    /// Its number of pixels.
    pub(super) fn count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The ray of the pixel in column `x` and row `y` of the window.
    #[inline(always)]
    pub(super) fn ray(&self, rays: &Rays, x: u32, y: u32) -> (DVec3, DVec3) {
        let (left, top) = (f64::from(self.left) + f64::from(x), f64::from(self.top) + f64::from(y));
        rays.ray(left + self.within.0, top + self.within.1)
    }
}

/// What each pixel of a window sees, row by row from the top. Clones share one list.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    window: Window,
    surfaces: Arc<Vec<Surface>>,
}

impl GBuffer {
    pub(super) fn new(window: Window, surfaces: Vec<Surface>) -> GBuffer {
        GBuffer { window, surfaces: Arc::new(surfaces) }
    }

    /// The pixels that it holds.
    #[must_use]
    pub fn window(&self) -> Window {
        self.window
    }

    /// All of them, row by row from the top.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    pub(super) fn into_surfaces(self) -> Arc<Vec<Surface>> {
        self.surfaces
    }

    /// What the pixel in column `x` and row `y` of the window sees; nothing beyond it.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Surface {
        if x >= self.window.width || y >= self.window.height {
            return Surface::NONE;
        }
        self.surfaces[y as usize * self.window.width as usize + x as usize]
    }
}
