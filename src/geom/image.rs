//! A picture in memory.
//!
//! ```text
//!      (0, 0) +------------+ x → width
//!             |            |
//!             |            |     rows from the top, pixels of a row from the left
//!             +------------+
//!           y ↓ height
//! ```

/// A picture: 8-bit sRGB with (straight, linear) alpha, rows from top to bottom.
///
/// ```
/// use rvachev::Image;
///
/// let image = Image::new(2, 1, vec![[255, 0, 0, 255], [0, 0, 255, 255]])?;
/// assert_eq!(image.pixel(1, 0), Some([0, 0, 255, 255]));
/// assert_eq!(image.pixel(2, 0), None);
/// # Ok::<(), rvachev::ImageError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
}

/// Why a picture cannot be built from the given parts.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A picture needs at least one pixel.
    #[error("an image of {width} × {height} pixels; each side must be at least 1")]
    NoPixels {
        /// The width asked for.
        width: u32,
        /// The height asked for.
        height: u32,
    },
    /// The number of pixels is not width × height.
    #[error("{pixels} pixels given for an image of {width} × {height}")]
    Count {
        /// Number of pixels given.
        pixels: usize,
        /// The width asked for.
        width: u32,
        /// The height asked for.
        height: u32,
    },
}

impl Image {
    /// A picture from its pixels (red, green, blue, alpha), row by row from the top left.
    ///
    /// # Errors
    ///
    /// If a side is 0, or the number of pixels is not `width · height`.
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 4]>) -> Result<Image, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::NoPixels { width, height });
        }
        if pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(ImageError::Count { pixels: pixels.len(), width, height });
        }
        Ok(Image { width, height, pixels })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels (red, green, blue, alpha), row by row from the top left.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// The pixel in column `x` and row `y`; `None` beyond the picture.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let index = u64::from(y) * u64::from(self.width) + u64::from(x);
        self.pixels.get(usize::try_from(index).ok()?).copied()
    }

    /// Whether every pixel has alpha 255.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.pixels.iter().all(|p| p[3] == 255)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns() {
        let pixels = (0..6).map(|i| [i, 0, 0, 255]).collect();
        let image = Image::new(3, 2, pixels).unwrap();
        assert_eq!(image.pixel(2, 1), Some([5, 0, 0, 255]));
        assert_eq!(image.pixel(0, 1), Some([3, 0, 0, 255]));
        assert_eq!(image.pixel(3, 0), None);
        assert_eq!(image.pixel(0, 2), None);
        assert!(image.is_opaque());
    }

    #[test]
    fn bad_sizes() {
        assert_eq!(
            Image::new(0, 2, vec![]).unwrap_err().to_string(),
            "an image of 0 × 2 pixels; each side must be at least 1"
        );
        assert!(matches!(Image::new(u32::MAX, u32::MAX, vec![]), Err(ImageError::Count { pixels: 0, .. })));
    }
}
