//! From a solid to a picture.
//!
//! The space around the solid is divided into cells where the surface may cross; rays are taken
//! through them in packets and ask each for the first crossing. What it meets is shaded by three
//! lights that move with the camera. Pixels at outlines and creases are sampled more often.

mod cells;
mod gbuffer;
mod march;
mod picture;
mod scene;
mod settings;
mod shade;
mod solid;
mod tile;

pub use gbuffer::{GBuffer, Surface, Window};
pub use scene::Scene;
pub use settings::{Background, RenderError, RenderSettings};
