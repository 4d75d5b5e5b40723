//! The spatial index: a box divided into what is inside, what is outside, and blocks that
//! the surface may cross, each with the program narrowed to it.

mod tree;

pub(crate) use tree::{Block, Grid, SurfaceBlocks, surface_blocks};
