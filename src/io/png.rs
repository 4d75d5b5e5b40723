//! PNG, through the `png` crate, row by row.

use std::io::{self, Write};

use glam::Vec3;
use png::{BitDepth, ColorType, Encoder, EncodingError};
use rvachev_num::Meter;

use crate::Run;
use crate::geom::{Image, grey};

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
    use super::{Coded, Image, io};

    pub trait Colors: Sized {
        /// What the pixels are in a file.
        fn coded(image: &Image<Self>) -> io::Result<Coded<Self>>;
    }
}

/// What pixels are in a file, and what appends the bytes of a row of them.
pub struct Coded<P> {
    color: ColorType,
    depth: BitDepth,
    row: Row<P>,
}

/// Appends the bytes of a row.
type Row<P> = Box<dyn Fn(&[P], &mut Vec<u8>)>;

impl<P> Coded<P> {
    /// Pixels of 8 bits a channel.
    fn bytes(color: ColorType, row: impl Fn(&[P], &mut Vec<u8>) + 'static) -> Coded<P> {
        Coded { color, depth: BitDepth::Eight, row: Box::new(row) }
    }

    /// Pixels of 16 bits a channel, each of `N` channels.
    fn words<const N: usize>(color: ColorType, pixel: impl Fn(&P) -> [u16; N] + 'static) -> Coded<P> {
        let row = move |pixels: &[P], out: &mut Vec<u8>| {
            out.extend(pixels.iter().flat_map(&pixel).flat_map(u16::to_be_bytes));
        };
        Coded { color, depth: BitDepth::Sixteen, row: Box::new(row) }
    }
}

/// Writes a picture as PNG: see [`Colors`] for what is written as what.
///
/// # Errors
///
/// Those of the writer; for normals, that there is a component beyond −1 to 1; for leaves, that
/// a number does not fit into 16 bits.
pub fn write_png<P: Colors>(image: &Image<P>, out: impl Write) -> io::Result<()> {
    write_png_on(image, &Run::default(), out)
}

/// [`write_png`] on a [`Run`], which is told how many rows are written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_png`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_png_on<P: Colors>(image: &Image<P>, run: &Run, out: impl Write) -> io::Result<()> {
    run.check().map_err(io::Error::other)?;
    let Coded { color, depth, row } = P::coded(image)?;
    let mut encoder = Encoder::new(out, image.width(), image.height());
    encoder.set_color(color);
    encoder.set_depth(depth);
    // What is looked at once is not worth the time of the smallest file.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let meter = Meter::new(run, image.height());
    let mut bytes = Vec::new();
    streamed(encoder, |stream| {
        for pixels in image.pixels().chunks_exact(image.width() as usize) {
            meter.step().map_err(io::Error::other)?;
            bytes.clear();
            row(pixels, &mut bytes);
            stream.write_all(&bytes)?;
        }
        Ok(())
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
    let mut encoder = Encoder::new(out, size[0], size[1]);
    encoder.set_color(if has_alpha { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    streamed(encoder, |stream| {
        rows(&mut |pixels| {
            if has_alpha {
                return stream.write_all(pixels.as_flattened());
            }
            let colors: Vec<u8> = pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
            stream.write_all(&colors)
        })
    })
}

/// Writes a file whose bytes come bit by bit.
fn streamed<W: Write>(
    encoder: Encoder<'_, W>,
    rows: impl FnOnce(&mut png::StreamWriter<'_, W>) -> io::Result<()>,
) -> io::Result<()> {
    let error = |error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    };
    let mut file = encoder.write_header().map_err(error)?;
    let mut stream = file.stream_writer().map_err(error)?;
    rows(&mut stream)?;
    // An incomplete picture is an error here.
    stream.finish().map_err(error)?;
    file.finish().map_err(error)
}

impl Colors for [u8; 4] {}
impl sealed::Colors for [u8; 4] {
    fn coded(image: &Image<Self>) -> io::Result<Coded<Self>> {
        Ok(if image.is_opaque() {
            Coded::bytes(ColorType::Rgb, |row: &[Self], out| out.extend(row.iter().flat_map(|p| [p[0], p[1], p[2]])))
        } else {
            Coded::bytes(ColorType::Rgba, |row, out| out.extend_from_slice(row.as_flattened()))
        })
    }
}

impl Colors for [u16; 4] {}
impl sealed::Colors for [u16; 4] {
    fn coded(image: &Image<Self>) -> io::Result<Coded<Self>> {
        Ok(if image.pixels().iter().all(|p| p[3] == u16::MAX) {
            Coded::words(ColorType::Rgb, |p: &Self| [p[0], p[1], p[2]])
        } else {
            Coded::words(ColorType::Rgba, |p| *p)
        })
    }
}

impl Colors for u8 {}
impl sealed::Colors for u8 {
    fn coded(_: &Image<Self>) -> io::Result<Coded<Self>> {
        Ok(Coded::bytes(ColorType::Grayscale, |row, out| out.extend_from_slice(row)))
    }
}

impl Colors for u16 {}
impl sealed::Colors for u16 {
    fn coded(_: &Image<Self>) -> io::Result<Coded<Self>> {
        Ok(Coded::words(ColorType::Grayscale, |grey| [*grey]))
    }
}

impl Colors for f64 {}
impl sealed::Colors for f64 {
    fn coded(image: &Image<Self>) -> io::Result<Coded<Self>> {
        let (low, high) = image.range().unwrap_or_default();
        Ok(Coded::words(ColorType::Grayscale, move |v| [grey(*v, low, high, f64::from(u16::MAX)) as u16]))
    }
}

impl Colors for bool {}
impl sealed::Colors for bool {
    fn coded(_: &Image<Self>) -> io::Result<Coded<Self>> {
        let level = |seen: &bool| if *seen { u8::MAX } else { 0 };
        Ok(Coded::bytes(ColorType::Grayscale, move |row, out| out.extend(row.iter().map(level))))
    }
}

impl Colors for Option<u32> {}
impl sealed::Colors for Option<u32> {
    fn coded(image: &Image<Self>) -> io::Result<Coded<Self>> {
        let most = image.pixels().iter().flatten().max();
        if let Some(most) = most.filter(|most| **most >= u32::from(u16::MAX)) {
            return Err(io::Error::other(format!("leaf {most} is beyond what 16 bits hold; allowed: up to 65534")));
        }
        Ok(Coded::words(ColorType::Grayscale, |owner: &Self| [owner.map_or(0, |owner| owner as u16 + 1)]))
    }
}

impl Colors for Vec3 {}
impl sealed::Colors for Vec3 {
    fn coded(image: &Image<Self>) -> io::Result<Coded<Self>> {
        if let Some(far) = image.pixels().iter().find(|n| !n.is_finite() || n.abs().max_element() > 1.0001) {
            return Err(io::Error::other(format!("a pixel is {far}; allowed in a PNG: −1 to 1")));
        }
        let level = |c: f32| ((0.5 + 0.5 * c).clamp(0.0, 1.0) * 65535.0).round() as u16;
        Ok(Coded::words(ColorType::Rgb, move |n: &Self| n.to_array().map(level)))
    }
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
