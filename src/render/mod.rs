//! From a solid to a picture.
//!
//! A grid of blocks is laid over the solid; each ray walks through it and asks, in the blocks
//! that the surface may cross, for the first crossing. What it meets is shaded by three
//! lights that move with the camera. Pixels at outlines and creases are sampled more often.

mod blocks;
mod gbuffer;
mod picture;
mod scene;
mod settings;
mod shade;
mod solid;
mod walk;

pub use gbuffer::{GBuffer, Surface, Window};
pub use scene::Scene;
pub use settings::{Background, RenderError, RenderSettings};
