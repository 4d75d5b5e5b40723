//! PNG, through the `image` crate.

use std::io::{self, Write};

use glam::Vec3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::geom::Image;

/// A picture that can be written as PNG. This trait is closed.
///
/// | picture | PNG |
/// |---|---|
/// | colours, greys | as they are, 8 or 16 bits a channel; alpha only if a pixel needs it |
/// | `f64`: depths, values | 16-bit grey from the least, white, to the greatest; black where there is nothing |
/// | [`Vec3`]: normals | 16-bit colour, −1 to 1 as 0 to 65535 |
/// | `bool`: a mask | 8-bit grey, 0 or 255 |
/// | `Option<u32>`: leaves | 16-bit grey, the number plus 1; 0 where there is nothing |
pub trait Colors: sealed::Colors {}

mod sealed {
    use super::{ExtendedColorType, Image, io};

    pub trait Colors: Sized {
        /// The bytes of the pixels, in the machine's order, and what they are.
        fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)>;
    }
}

/// Writes a picture as PNG: see [`Colors`] for what is written as what.
///
/// # Errors
///
/// Those of the writer; for normals, that there is a component beyond −1 to 1; for leaves, that
/// a number does not fit into 16 bits.
pub fn write_png<P: Colors>(image: &Image<P>, out: impl Write) -> io::Result<()> {
    let (bytes, color) = P::encode(image)?;
    PngEncoder::new(out).write_image(&bytes, image.width(), image.height(), color).map_err(|error| match error {
        image::ImageError::IoError(error) => error,
        other => io::Error::other(other),
    })
}

/// Takes the rows of a picture, from the top, as many at a time as there are.
pub(crate) type Rows<'a> = dyn FnMut(&[[u8; 4]]) -> io::Result<()> + 'a;

/// Writes a picture of 8-bit colours whose rows come bit by bit, so that it never is in memory.
pub(super) fn write_png_rows(
    size: [u32; 2],
    has_alpha: bool,
    rows: impl FnOnce(&mut Rows<'_>) -> io::Result<()>,
    out: impl Write,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, size[0], size[1]);
    encoder.set_color(if has_alpha { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_depth(png::BitDepth::Eight);
    let mut file = encoder.write_header()?;
    let mut stream = file.stream_writer()?;
    rows(&mut |pixels| {
        if has_alpha {
            return stream.write_all(pixels.as_flattened());
        }
        let colors: Vec<u8> = pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
        stream.write_all(&colors)
    })?;
    // An incomplete picture is an error here.
    stream.finish()?;
    Ok(file.finish()?)
}

impl Colors for [u8; 4] {}
impl sealed::Colors for [u8; 4] {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        Ok(if image.is_opaque() {
            (image.pixels().iter().flat_map(|p| [p[0], p[1], p[2]]).collect(), ExtendedColorType::Rgb8)
        } else {
            (image.pixels().as_flattened().to_vec(), ExtendedColorType::Rgba8)
        })
    }
}

impl Colors for [u16; 4] {}
impl sealed::Colors for [u16; 4] {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        Ok(if image.pixels().iter().all(|p| p[3] == u16::MAX) {
            (bytes(image.pixels().iter().flat_map(|p| [p[0], p[1], p[2]])), ExtendedColorType::Rgb16)
        } else {
            (bytes(image.pixels().as_flattened().iter().copied()), ExtendedColorType::Rgba16)
        })
    }
}

impl Colors for u8 {}
impl sealed::Colors for u8 {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        Ok((image.pixels().to_vec(), ExtendedColorType::L8))
    }
}

impl Colors for u16 {}
impl sealed::Colors for u16 {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        Ok((bytes(image.pixels().iter().copied()), ExtendedColorType::L16))
    }
}

impl Colors for f64 {}
impl sealed::Colors for f64 {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        let (low, high) = image.range().unwrap_or_default();
        sealed::Colors::encode(&image.to_grey16(low, high))
    }
}

impl Colors for bool {}
impl sealed::Colors for bool {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        sealed::Colors::encode(&image.map(|seen| if *seen { u8::MAX } else { 0 }))
    }
}

impl Colors for Option<u32> {}
impl sealed::Colors for Option<u32> {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        let most = image.pixels().iter().flatten().max();
        if let Some(most) = most.filter(|most| **most >= u32::from(u16::MAX)) {
            return Err(io::Error::other(format!("leaf {most} is beyond what 16 bits hold; allowed: up to 65534")));
        }
        sealed::Colors::encode(&image.map(|owner| owner.map_or(0, |owner| owner as u16 + 1)))
    }
}

impl Colors for Vec3 {}
impl sealed::Colors for Vec3 {
    fn encode(image: &Image<Self>) -> io::Result<(Vec<u8>, ExtendedColorType)> {
        if let Some(far) = image.pixels().iter().find(|n| !n.is_finite() || n.abs().max_element() > 1.0001) {
            return Err(io::Error::other(format!("a pixel is {far}; allowed in a PNG: −1 to 1")));
        }
        let level = |c: f32| ((0.5 + 0.5 * c).clamp(0.0, 1.0) * 65535.0).round() as u16;
        Ok((bytes(image.pixels().iter().flat_map(|n| n.to_array().map(level))), ExtendedColorType::Rgb16))
    }
}

/// Numbers of 16 bits as the encoder takes them.
fn bytes(numbers: impl Iterator<Item = u16>) -> Vec<u8> {
    numbers.flat_map(u16::to_ne_bytes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(alpha: u8) -> Image {
        let pixels = (0..15u8).map(|i| [i, 2 * i, 255 - i, alpha]).collect();
        Image::new(5, 3, pixels).unwrap()
    }

    fn read<P: Colors>(image: &Image<P>) -> image::DynamicImage {
        let mut bytes = Vec::new();
        write_png(image, &mut bytes).unwrap();
        image::load_from_memory(&bytes).unwrap()
    }

    #[test]
    fn round_trip() {
        for (alpha, color) in [(255, image::ColorType::Rgb8), (7, image::ColorType::Rgba8)] {
            let picture = picture(alpha);
            let read = read(&picture);
            assert_eq!(read.color(), color);
            let read = read.into_rgba8();
            assert_eq!(read.dimensions(), (5, 3));
            assert_eq!(read.as_raw(), picture.pixels().as_flattened());
        }
    }

    #[test]
    fn round_trip_of_16_bits() {
        let deep = Image::new(2, 1, vec![[1u16, 256, 65535, 65535], [7, 8, 9, 65535]]).unwrap();
        assert_eq!(read(&deep).into_rgba16().as_raw(), deep.pixels().as_flattened());
        let leaves = Image::new(3, 1, vec![None, Some(0), Some(65534)]).unwrap();
        assert!(write_png(&Image::new(1, 1, vec![Some(65535u32)]).unwrap(), Vec::new()).is_err());
        assert_eq!(read(&leaves).into_luma16().as_raw(), &[0, 1, 65535]);
        let normals = Image::new(2, 1, vec![Vec3::Z, Vec3::new(-1.0, 0.0, 0.5)]).unwrap();
        assert_eq!(read(&normals).into_rgb16().as_raw(), &[32768, 32768, 65535, 0, 32768, 49151]);
        assert!(write_png(&Image::new(1, 1, vec![Vec3::splat(3.0)]).unwrap(), Vec::new()).is_err());
        let mask = Image::new(2, 1, vec![true, false]).unwrap();
        assert_eq!(read(&mask).into_luma8().as_raw(), &[255, 0]);
        let depth = Image::new(3, 1, vec![1.0, f64::INFINITY, 3.0]).unwrap();
        assert_eq!(read(&depth).into_luma16().as_raw(), &[65535, 0, 6553]);
    }

    #[test]
    fn errors_of_the_writer_arrive() {
        let mut too_small = [0u8; 20];
        assert!(write_png(&picture(255), &mut too_small[..]).is_err());
    }
}
