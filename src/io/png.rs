//! PNG, through the `image` crate.

use std::io::{self, Write};

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::geom::Image;

/// Writes a picture as PNG, 8 bits a channel; without an alpha channel if every pixel is
/// opaque.
///
/// # Errors
///
/// Those of the writer.
pub fn write_png(image: &Image, out: impl Write) -> io::Result<()> {
    let opaque: Vec<u8>;
    let (bytes, color): (&[u8], _) = if image.is_opaque() {
        opaque = image.pixels().iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
        (&opaque, ExtendedColorType::Rgb8)
    } else {
        (image.pixels().as_flattened(), ExtendedColorType::Rgba8)
    };
    PngEncoder::new(out).write_image(bytes, image.width(), image.height(), color).map_err(|error| match error {
        image::ImageError::IoError(error) => error,
        other => io::Error::other(other),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(alpha: u8) -> Image {
        let pixels = (0..15u8).map(|i| [i, 2 * i, 255 - i, alpha]).collect();
        Image::new(5, 3, pixels).unwrap()
    }

    #[test]
    fn round_trip() {
        for (alpha, color) in [(255, image::ColorType::Rgb8), (7, image::ColorType::Rgba8)] {
            let picture = picture(alpha);
            let mut bytes = Vec::new();
            write_png(&picture, &mut bytes).unwrap();
            let read = image::load_from_memory(&bytes).unwrap();
            assert_eq!(read.color(), color);
            let read = read.into_rgba8();
            assert_eq!(read.dimensions(), (5, 3));
            assert_eq!(read.as_raw(), picture.pixels().as_flattened());
        }
    }

    #[test]
    fn errors_of_the_writer_arrive() {
        let mut too_small = [0u8; 20];
        assert!(write_png(&picture(255), &mut too_small[..]).is_err());
    }
}
