//! From a solid to a picture.
//!
//! The space around the solid is divided into cells where the surface may cross; rays are taken
//! through them in packets and ask each for the first crossing. What they meet are the layers of a
//! picture, or it is shaded: lights that move with the camera, shadows and hollows by rays through
//! a coarser copy of the surface, and more rays of its own at outlines and creases. Drafts show a
//! mesh by the rasteriser instead. A scene may be cut by a plane. Slices show the field on a plane.

mod beside;
mod cells;
mod contour;
mod draft;
mod draft_mesh;
mod empty_space;
mod exact;
mod extent;
mod facet_block;
mod facet_crease;
mod facets;
mod fillets;
mod gbuffer;
mod held;
mod job;
mod layers;
mod lines;
mod list;
mod march;
mod materials;
mod occlusion;
mod picture;
mod pixels;
mod roll;
mod scene;
mod search;
mod section;
mod settings;
mod shade;
mod slice;
mod slopes;
mod solid;
mod spot;
mod still;
mod tile;

pub use contour::{ContourSettings, Side};
pub use gbuffer::{GBuffer, Surface, Window};
pub use layers::Layers;
pub use scene::Scene;
pub use settings::{Background, Lights, Quality, RenderError, RenderSettings, Style, Transfer};
pub use slice::{Isolines, Slice, SliceSettings};
