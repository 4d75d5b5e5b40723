//! Colours of parts.

use super::{Node, Solid};
use crate::ParamError;

/// What a surface looks like: its colour, and how rough it is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Paint {
    /// Red, green, blue in sRGB.
    pub color: [u8; 3],
    /// How blurred reflections are, from 0 (polished) to 1 (matt). Default: 0.5.
    pub roughness: f64,
}

impl Default for Paint {
    /// A warm grey.
    fn default() -> Paint {
        Paint::from([186, 178, 168])
    }
}

impl From<[u8; 3]> for Paint {
    fn from(color: [u8; 3]) -> Paint {
        Paint { color, roughness: 0.5 }
    }
}

impl Paint {
    pub(crate) fn check(&self) -> Result<(), ParamError> {
        if (0.0..=1.0).contains(&self.roughness) {
            return Ok(());
        }
        Err(ParamError::new("roughness", self.roughness, "0 to 1"))
    }
}

impl Solid {
    /// The same solid, painted all over: pictures and meshes show it. Nothing else changes.
    ///
    /// Paint stays on what a part contributes to joins: a face that a solid cuts has the colour
    /// of the solid that cut it, and the transition of a blend mixes the colours of both as it
    /// mixes their normals. What is painted again has the outermost paint. What is not painted
    /// has the colour that the picture's or the mesh's settings say.
    ///
    /// A point of an [offset](Solid::offset), or of the inner face of a [shell](Solid::shell), has
    /// the paint of the nearest point of the solid that it was made from. So has an edge that was
    /// [rounded](Solid::rounded) or [filleted](Solid::filleted). A fillet or a chamfer between
    /// solids mixes their paints by the distances to them: each is pure where the fillet meets its
    /// solid.
    ///
    /// ```
    /// use rvachev::{Paint, Solid};
    ///
    /// let body = Solid::cuboid([4.0, 4.0, 2.0]).paint([40, 90, 160]);
    /// let bore = Solid::cylinder(1.0, 3.0).paint(Paint { color: [230, 140, 30], roughness: 0.3 });
    /// let part = body - bore;
    /// assert_eq!(part.paint_at([1.5, 0.0, 1.0])?.map(|p| p.color), Some([40, 90, 160]));
    /// assert_eq!(part.paint_at([1.0, 0.0, 0.0])?.map(|p| p.color), Some([230, 140, 30]));
    /// let hollow = part.shell(0.2);
    /// assert_eq!(hollow.paint_at([1.2, 0.0, 0.0])?.map(|p| p.color), Some([230, 140, 30]));
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn paint(&self, paint: impl Into<Paint>) -> Solid {
        Solid::from_node(Node::Painted { operand: self.clone(), paint: paint.into() })
    }
}
