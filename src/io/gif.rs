//! Animated GIF, through the `image` crate.

use std::io::{self, Write};
use std::time::Duration;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};
use rvachev_num::Meter;

use crate::Run;
use crate::geom::Image;

/// Writes pictures as an animated GIF without end, each shown for `pause` (a GIF counts in
/// hundredths of a second). Every picture has the 256 colours that suit it best.
///
/// # Errors
///
/// Those of the writer; that there is no picture; that a side is beyond 65535.
pub fn write_gif(pictures: &[Image], pause: Duration, out: impl Write) -> io::Result<()> {
    write_gif_on(pictures, pause, &Run::default(), out)
}

/// [`write_gif`] on a [`Run`], which is told how many pictures are written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_gif`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_gif_on(pictures: &[Image], pause: Duration, run: &Run, out: impl Write) -> io::Result<()> {
    if pictures.is_empty() {
        return Err(io::Error::other("no picture to write"));
    }
    let error = |error| match error {
        image::ImageError::IoError(error) => error,
        other => io::Error::other(other),
    };
    // Of the speeds from 1 to 30, one that is fast and not yet seen.
    let mut encoder = GifEncoder::new_with_speed(out, 10);
    encoder.set_repeat(Repeat::Infinite).map_err(error)?;
    let meter = Meter::new(run, pictures.len());
    for picture in pictures {
        meter.step().map_err(io::Error::other)?;
        let bytes = picture.pixels().as_flattened().to_vec();
        let Some(buffer) = RgbaImage::from_raw(picture.width(), picture.height(), bytes) else {
            return Err(io::Error::other("the pixels do not make a picture"));
        };
        let delay = Delay::from_saturating_duration(pause);
        encoder.encode_frame(Frame::from_parts(buffer, 0, 0, delay)).map_err(error)?;
    }
    Ok(())
}
