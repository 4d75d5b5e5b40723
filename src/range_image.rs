//! Range images: depths as a sensor sees them, with its noise, and back to points.

pub use crate::geom::{Coordinates, Noise, RangeImage, RangeImageError};
