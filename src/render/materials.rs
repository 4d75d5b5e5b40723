//! The materials of a solid's parts.

use glam::DVec3;

use super::shade::{Material, Studio};
use crate::{Paint, Palette};

/// The materials of a solid in a picture, made once.
pub(super) struct Materials {
    /// Of what nobody painted.
    unpainted: Material,
    /// By leaf; none for leaves in a blend of various paints, where it depends on the point. Empty
    /// if nothing is painted.
    parts: Vec<Option<Material>>,
    palette: Palette,
    paint: Paint,
}

impl Materials {
    /// Those of a solid in a studio; `paint` is for what has none.
    pub(super) fn new(palette: &Palette, studio: &Studio, paint: Paint) -> Materials {
        let part = |leaf: u32| {
            let own = palette.of(leaf);
            (!palette.is_mixed(leaf)).then(|| studio.material(own.unwrap_or(paint), own.is_some()))
        };
        let leaves = if palette.is_painted() { palette.leaves() } else { 0 };
        Materials {
            unpainted: studio.material(paint, false),
            parts: (0..leaves).map(part).collect(),
            palette: palette.clone(),
            paint,
        }
    }

    /// That of the surface of a leaf at a point.
    #[inline]
    pub(super) fn at(&self, studio: &Studio, owner: u32, point: DVec3) -> Material {
        match self.parts.get(owner as usize) {
            None => self.unpainted,
            Some(Some(material)) => *material,
            Some(None) => match self.palette.mixture(owner, point, self.paint) {
                Some(paint) => studio.material(paint, true),
                None => self.unpainted,
            },
        }
    }
}
